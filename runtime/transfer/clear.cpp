#include <array>
#include <cstring>

#include "runtime/transfer/region.h"

namespace vernier {
namespace {

constexpr uint32_t kMaxTexelBytes = 16;

/// Writes n copies of a texel; `keep` has the bits that must stay as they are.
void fillRow(std::byte* row, uint32_t n, uint32_t texelBytes, const std::byte* texel, const std::byte* keep) {
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t b = 0; b < texelBytes; ++b) {
            std::byte& byte = row[size_t{i} * texelBytes + b];
            byte = (byte & keep[b]) | (texel[b] & ~keep[b]);
        }
}

/// All texels of the range get the clear value's aspects.
void clearRange(const TransferContext& context, const Image& image, VkImageAspectFlags aspects,
                const VkClearValue& value, const VkImageSubresourceRange& range) {
    const FormatInfo& format = image.format();
    aspects &= format.aspects;
    if (aspects == 0 || format.block != nullptr) return;  // nothing encodes blocks
    if (range.baseMipLevel >= image.info().mipLevels) return;
    // Where packing over all zeros and over all ones gives different bits, the clear does not reach.
    std::array<std::byte, kMaxTexelBytes> texel{}, keep;
    keep.fill(std::byte{0xFF});
    packClear(format, aspects, value, texel.data());
    packClear(format, aspects, value, keep.data());
    bool whole = true;
    for (uint32_t b = 0; b < format.bytesPerTexel; ++b) {
        keep[b] ^= texel[b];
        whole = whole && keep[b] == std::byte{0};
    }
    const uint32_t bytes = format.bytesPerTexel;
    const uint32_t levels = std::min(range.levelCount, image.info().mipLevels - range.baseMipLevel);
    for (uint32_t i = 0; i < levels; ++i) {
        const uint32_t mip = range.baseMipLevel + i;
        const VkExtent3D& extent = image.level(mip).extent;
        const VkImageSubresourceLayers layers{aspects, mip, range.baseArrayLayer, range.layerCount};
        const TexelBox box =
            clipBox(image, layers, {0, 0, 0},
                    {extent.width, extent.height, image.info().type == VK_IMAGE_TYPE_3D ? extent.depth : 1});
        for (uint32_t sample = 0; sample < image.info().samples; ++sample) {
            forEachRow(context, box, [&](uint32_t y, uint32_t z) {
                std::byte* row = rowAddress(image, mip, y, box.z + z, sample);
                if (!whole) return fillRow(row, box.width, bytes, texel.data(), keep.data());
                // Doubling copies: each memcpy fills as much as is there already.
                std::memcpy(row, texel.data(), bytes);
                for (size_t done = bytes, all = size_t{box.width} * bytes; done < all; done *= 2)
                    std::memcpy(row + done, row, std::min(done, all - done));
            });
        }
    }
}

}  // namespace

void clearColorImage(const TransferContext& context, const Image& image, const VkClearColorValue& value,
                     const VkImageSubresourceRange& range) {
    VkClearValue clear;
    clear.color = value;
    clearRange(context, image, VK_IMAGE_ASPECT_COLOR_BIT, clear, range);
}

void clearDepthStencilImage(const TransferContext& context, const Image& image, const VkClearDepthStencilValue& value,
                            const VkImageSubresourceRange& range) {
    VkClearValue clear;
    clear.depthStencil = value;
    clearRange(context, image, range.aspectMask & (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT), clear,
               range);
}

void fillBuffer(const TransferContext&, const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size, uint32_t value) {
    if (offset >= buffer.size()) return;
    // vkCmdFillBuffer: VK_WHOLE_SIZE is rounded down to a multiple of 4.
    const VkDeviceSize words = std::min(size, buffer.size() - offset) / 4;
    std::byte* target = buffer.data() + offset;
    for (VkDeviceSize i = 0; i < words; ++i) std::memcpy(target + i * 4, &value, 4);
}

void updateBuffer(const Buffer& buffer, VkDeviceSize offset, std::span<const std::byte> bytes) {
    if (offset >= buffer.size()) return;
    std::memcpy(buffer.data() + offset, bytes.data(), std::min<VkDeviceSize>(bytes.size(), buffer.size() - offset));
}

}  // namespace vernier
