#include "conformance/oracle/memory.h"

#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace vernier::conformance::exact {
namespace {

bool isInside(const ImageStore& image, const std::array<int32_t, 3>& at) {
    const VkExtent2D extent = image.level(0, 0).extent;
    const int64_t layers = int64_t{image.arrayLayers()} * image.depth(0);
    return at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < int64_t{extent.width} && at[1] < int64_t{extent.height} &&
           at[2] < layers;
}

/// Where a write goes; nothing when it is outside.
Result<StoredTexel*> placeOf(const Scene& scene, const TexelWrite& write, Memory& memory, const PixelFormat*& format) {
    const SceneBinding& binding = *write.binding;
    if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) {
        ImageStore& image = memory.images[binding.image];
        format = &image.format();
        if (!isInside(image, write.at)) return static_cast<StoredTexel*>(nullptr);
        return &image.level(0, static_cast<uint32_t>(write.at[2]))
                    .at(static_cast<uint32_t>(write.at[0]), static_cast<uint32_t>(write.at[1]));
    }
    const auto [entry, fresh] = memory.texelBuffers.try_emplace(binding.buffer);
    TexelBuffer& buffer = entry->second;
    if (fresh) buffer = TexelBuffer::of(binding, scene.buffers[binding.buffer].data);
    if (buffer.format == nullptr || !buffer.isSeenBy(binding))
        return unsupported("oracle: texels stored into a buffer in several formats or at several offsets");
    format = buffer.format;
    const auto at = static_cast<size_t>(write.at[0]);
    return write.at[0] >= 0 && at < buffer.texels.size() ? &buffer.texels[at] : static_cast<StoredTexel*>(nullptr);
}

}  // namespace

uint32_t wordOf(WordKind kind, double number) {
    if (kind == WordKind::floating) return std::bit_cast<uint32_t>(static_cast<float>(number));
    if (std::isnan(number)) return 0;
    if (kind == WordKind::signedInteger)
        return static_cast<uint32_t>(static_cast<int32_t>(std::clamp(std::nearbyint(number), -0x1p31, 0x1p31 - 1)));
    return static_cast<uint32_t>(std::clamp(std::nearbyint(number), 0.0, 0x1p32 - 1));
}

double numberOf(WordKind kind, uint32_t word) {
    return kind == WordKind::floating        ? static_cast<double>(std::bit_cast<float>(word))
           : kind == WordKind::signedInteger ? static_cast<double>(static_cast<int32_t>(word))
                                             : static_cast<double>(word);
}

TexelBuffer TexelBuffer::of(const SceneBinding& binding, const Bytes& bytes) {
    TexelBuffer buffer{findPixelFormat(binding.texelFormat), binding.offset, {}};
    if (buffer.format == nullptr || binding.offset > bytes.size()) return buffer;
    const size_t length = std::min<size_t>(binding.range, bytes.size() - binding.offset);
    buffer.texels.resize(length / buffer.format->bytes);
    for (size_t i = 0; i < buffer.texels.size(); ++i) {
        const std::array<double, 4> numbers =
            decodeTexel(*buffer.format, bytes.data() + binding.offset + i * buffer.format->bytes);
        for (size_t c = 0; c < 4; ++c) buffer.texels[i].channels[c] = numbers[c];
    }
    return buffer;
}

bool TexelBuffer::isSeenBy(const SceneBinding& binding) const {
    return format == findPixelFormat(binding.texelFormat) && offset == binding.offset;
}

Status applyWrites(const Scene& scene, const std::vector<TexelWrite>& writes, Memory& memory) {
    std::set<const StoredTexel*> written;
    for (const TexelWrite& write : writes) {
        const PixelFormat* format = nullptr;
        const Result<StoredTexel*> place = placeOf(scene, write, memory, format);
        if (!place) return place.error();
        if (*place == nullptr) continue;
        StoredTexel& texel = **place;
        const StoredTexel fresh{quantiseColor(*format, write.color), write.flags};
        const bool again = !written.insert(&texel).second;
        const bool same = again && texel.channels == fresh.channels;
        if ((!again && !write.open) || same) {
            texel = {fresh.channels, static_cast<OracleFlags>(fresh.flags | (same ? texel.flags : 0))};
            continue;
        }
        texel.flags |= fresh.flags | kOracleEdge | (again ? kOracleSequence : kOracleSnap);
        for (size_t c = 0; c < 4; ++c) {
            const Interval united = fresh.channels[c].united(texel.channels[c]);
            texel.channels[c] = united;
        }
    }
    return {};
}

}  // namespace vernier::conformance::exact
