#include <array>
#include <cstring>

#include "runtime/transfer/region.h"

namespace vernier {
namespace {

constexpr uint32_t kMaxTexelBytes = 16;
constexpr uint64_t kFillStep = 1 << 20;  // bytes a thread fills at a time

/// Fills `size` bytes with copies of the first `unit`, which are there already: each memcpy takes as much as there is,
/// up to what a first-level cache holds.
void repeat(std::byte* bytes, size_t unit, size_t size) {
    constexpr size_t kMost = 8192;
    for (size_t done = unit; done < size;) {
        const size_t most = std::min(done, kMost / unit * unit);
        const size_t n = std::min(most, size - done);
        std::memcpy(bytes + done, bytes, n);
        done += n;
    }
}

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
                std::memcpy(row, texel.data(), bytes);
                repeat(row, bytes, size_t{box.width} * bytes);
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

void fillBuffer(const TransferContext& context, const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size,
                uint32_t value) {
    if (offset >= buffer.size()) return;
    // vkCmdFillBuffer: VK_WHOLE_SIZE is rounded down to a multiple of 4.
    const VkDeviceSize bytes = std::min(size, buffer.size() - offset) / 4 * 4;
    std::byte* target = buffer.data() + offset;
    const auto fill = [&](uint64_t begin, uint64_t end) {
        if (begin >= end) return;
        std::memcpy(target + begin, &value, sizeof value);
        repeat(target + begin, sizeof value, end - begin);
    };
    if (bytes < 2 * kFillStep) return fill(0, bytes);
    context.pool.parallelFor(static_cast<uint32_t>((bytes + kFillStep - 1) / kFillStep), [&](uint32_t step, uint32_t) {
        fill(step * kFillStep, std::min(bytes, (step + 1) * kFillStep));
    });
}

void updateBuffer(const Buffer& buffer, VkDeviceSize offset, std::span<const std::byte> bytes) {
    if (offset >= buffer.size()) return;
    std::memcpy(buffer.data() + offset, bytes.data(), std::min<VkDeviceSize>(bytes.size(), buffer.size() - offset));
}

}  // namespace vernier
