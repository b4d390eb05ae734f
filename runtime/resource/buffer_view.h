// Texel buffers: a range of a buffer seen as a row of texels.
#pragma once

#include <vulkan/vulkan_core.h>

#include "base/result.h"
#include "base/simd.h"
#include "runtime/resource/memory.h"
#include "runtime/texture/texture.h"

namespace vernier {

inline constexpr uint32_t kMaxTexelBufferElements = 1u << 27;
inline constexpr VkDeviceSize kTexelBufferAlignment = 16;

struct BufferViewInfo {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkDeviceSize offset = 0;  // bytes; whole texels or, if less is enough, a multiple of kTexelBufferAlignment
    VkDeviceSize range = 0;   // bytes, whole texels; VK_WHOLE_SIZE: as many texels as there are up to the buffer's end
};

class BufferView {
  public:
    /// Checks the view against the buffer, which must be bound and outlive the view. `isa` chooses the conversion
    /// routines.
    static Result<BufferView> create(const Buffer& buffer, const BufferViewInfo& info, Isa isa);

    const BufferViewInfo& info() const { return info_; }
    /// The texels as the texture units see them: one level of one dimension, wider than images can be.
    const TextureView& texture() const { return texture_; }

  private:
    BufferViewInfo info_;
    TextureView texture_;
};

}  // namespace vernier
