#include "runtime/resource/buffer_view.h"

#include <algorithm>
#include <string>

namespace vernier {
namespace {

/// That of a texel, of texels of three components that of one ("VkPhysicalDeviceTexelBufferAlignmentProperties").
VkDeviceSize texelAlignment(const FormatInfo& format) {
    const uint32_t bytes = format.bytesPerTexel;
    return std::min<VkDeviceSize>(bytes % 3 == 0 ? bytes / 3 : bytes, kTexelBufferAlignment);
}

}  // namespace

Result<BufferView> BufferView::create(const Buffer& buffer, const BufferViewInfo& info, Isa isa) {
    const auto wrong = [](const std::string& what) { return invalidArgument("buffer view: " + what); };
    constexpr VkFormatFeatureFlags kTexelBuffer =
        VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT | VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT;
    const FormatInfo* format = findFormat(info.format);
    if (!format || (format->bufferFeatures & kTexelBuffer) == 0)
        return unsupported("buffer view: format " + (format ? format->name : std::to_string(info.format)) +
                           " cannot be that of a texel buffer");
    if (!buffer.data()) return wrong("the buffer has no memory bound");
    const VkDeviceSize alignment = texelAlignment(*format);
    if (info.offset >= buffer.size() || info.offset % alignment != 0)
        return wrong("offset " + std::to_string(info.offset) + " is outside the buffer's " +
                     std::to_string(buffer.size()) + " bytes or no multiple of " + std::to_string(alignment));
    const VkDeviceSize left = buffer.size() - info.offset;
    if (info.range != VK_WHOLE_SIZE && (info.range > left || info.range % format->bytesPerTexel != 0))
        return wrong("range " + std::to_string(info.range) + " leaves the buffer or is not whole texels of " +
                     std::to_string(format->bytesPerTexel) + " bytes");
    const VkDeviceSize texels = std::min(info.range, left) / format->bytesPerTexel;
    if (texels < 1 || texels > kMaxTexelBufferElements)
        return wrong(std::to_string(texels) + " texels; there may be from 1 to " +
                     std::to_string(kMaxTexelBufferElements));

    BufferView view;
    view.info_ = info;
    TextureView& texture = view.texture_;
    texture.type = VK_IMAGE_VIEW_TYPE_1D;
    texture.format = info.format;
    texture.texelPitch = format->bytesPerTexel;
    texture.ops = formatOps(info.format, VK_IMAGE_ASPECT_COLOR_BIT, isa);
    texture.levels[0].data = buffer.data() + info.offset;
    texture.levels[0].width = static_cast<uint32_t>(texels);
    // One row; its pitch says how many bytes the view reaches, to whoever keeps work on the same bytes in order.
    texture.levels[0].rowPitch = static_cast<uint32_t>(texels) * format->bytesPerTexel;
    return view;
}

}  // namespace vernier
