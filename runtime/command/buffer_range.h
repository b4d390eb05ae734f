// The bytes of a buffer range that commands read from the host's side.
#pragma once

#include <algorithm>
#include <cstring>
#include <optional>

#include "runtime/command/commands.h"
#include "runtime/geometry/draw_call.h"

namespace vernier {

/// What of the range lies inside its buffer; none where there is no memory.
inline VertexStream streamOf(const command::BufferRange& range) {
    if (!range.buffer || !range.buffer->data() || range.offset > range.buffer->size()) return {};
    return {range.buffer->data() + range.offset, std::min(range.size, range.buffer->size() - range.offset)};
}

/// What `count` arguments `stride` bytes apart take up of the range.
template <class Arguments>
VertexStream argumentBytes(const command::BufferRange& range, uint32_t count = 1, uint32_t stride = 0) {
    VertexStream stream = streamOf(range);
    const VkDeviceSize bytes = count == 0 ? 0 : VkDeviceSize{count - 1} * stride + sizeof(Arguments);
    stream.size = std::min(stream.size, bytes);
    return stream;
}

/// The indirect arguments as Vulkan lays them out, wherever they lie; nothing if they reach outside the range.
template <class Arguments>
std::optional<Arguments> argumentsAt(const command::BufferRange& range, VkDeviceSize offset = 0) {
    const VertexStream stream = streamOf(range);
    if (!stream.data || offset > stream.size || stream.size - offset < sizeof(Arguments)) return std::nullopt;
    Arguments arguments;
    std::memcpy(&arguments, stream.data + offset, sizeof arguments);
    return arguments;
}

}  // namespace vernier
