#include <cstring>

#include "runtime/transfer/region.h"

namespace vernier {
namespace {

constexpr uint64_t kCopyStep = 1 << 20;  // bytes a thread copies at a time

/// Copies one row of n texels between images, of the named aspects.
void copyTexelRow(const FormatInfo& source, const FormatInfo& destination, VkImageAspectFlags aspects,
                  const std::byte* from, std::byte* to, uint32_t n) {
    if ((aspects & destination.aspects) == destination.aspects)
        return static_cast<void>(std::memmove(to, from, size_t{n} * destination.bytesPerTexel));
    // One aspect of a combined format, through the packing of buffer copies; a chunk at a time on the stack.
    constexpr uint32_t kChunk = 256;
    uint32_t packed[kChunk];
    for (uint32_t done = 0; done < n; done += kChunk) {
        const uint32_t count = std::min(kChunk, n - done);
        copyTexelsToBuffer(source, aspects, from + size_t{done} * source.bytesPerTexel, count, packed);
        copyTexelsFromBuffer(destination, aspects, packed, count, to + size_t{done} * destination.bytesPerTexel);
    }
}

/// The image that the aspect of a region names; a plane has its one aspect, colour.
const Image& takePlane(const Image& image, VkImageSubresourceLayers& layers) {
    const Image& plane = image.ofAspect(layers.aspectMask);
    if (&plane != &image) layers.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    return plane;
}

/// The rows of a buffer-image copy in both directions: copyRow(image or plane, aspect, texels, bytes, count).
template <class CopyRow>
void forEachBufferRow(const TransferContext& context, const Image& whole, const Buffer& buffer,
                      VkBufferImageCopy region, CopyRow copyRow) {
    VkImageSubresourceLayers& sub = region.imageSubresource;
    const Image& image = takePlane(whole, sub);
    if (!checkBufferImageCopy(image, buffer.size(), region)) return;
    const TexelBox box = clipBox(image, sub, region.imageOffset, region.imageExtent);
    const uint64_t texel = bufferTexelBytes(image.format(), sub.aspectMask);
    const FormatInfo& format = image.format();
    const uint64_t rowPitch = (region.bufferRowLength ? format.columns(region.bufferRowLength) : box.width) * texel;
    const uint64_t slicePitch =
        (region.bufferImageHeight ? format.rows(region.bufferImageHeight) : box.height) * rowPitch;
    forEachRow(context, box, [&](uint32_t y, uint32_t z) {
        std::byte* texels =
            rowAddress(image, sub.mipLevel, box.y + y, box.z + z, 0) + uint64_t{box.x} * image.format().bytesPerTexel;
        std::byte* bytes = buffer.data() + region.bufferOffset + z * slicePitch + y * rowPitch;
        copyRow(format, sub.aspectMask, texels, bytes, box.width);
    });
}

}  // namespace

void copyBuffer(const TransferContext& context, const Buffer& source, const Buffer& destination,
                const VkBufferCopy& region) {
    if (region.srcOffset >= source.size() || region.dstOffset >= destination.size()) return;
    const uint64_t size =
        std::min({region.size, source.size() - region.srcOffset, destination.size() - region.dstOffset});
    const std::byte* from = source.data() + region.srcOffset;
    std::byte* to = destination.data() + region.dstOffset;
    const bool overlap = from < to + size && to < from + size;
    if (size < 2 * kCopyStep || overlap) return static_cast<void>(std::memmove(to, from, size));
    context.pool.parallelFor(static_cast<uint32_t>((size + kCopyStep - 1) / kCopyStep), [&](uint32_t step, uint32_t) {
        const uint64_t begin = step * kCopyStep;
        std::memcpy(to + begin, from + begin, std::min(kCopyStep, size - begin));
    });
}

void copyImage(const TransferContext& context, const Image& wholeSource, const Image& wholeDestination,
               const VkImageCopy& asked) {
    VkImageCopy region = asked;
    const Image& source = takePlane(wholeSource, region.srcSubresource);
    const Image& destination = takePlane(wholeDestination, region.dstSubresource);
    TexelBox from = clipBox(source, region.srcSubresource, region.srcOffset, region.extent);
    // The extent is in texels of the source; a block of a compressed image corresponds to a texel of another one.
    const FormatInfo& target = destination.format();
    const VkExtent3D extent{source.format().columns(region.extent.width) * target.blockWidth(),
                            source.format().rows(region.extent.height) * target.blockHeight(), region.extent.depth};
    TexelBox to = clipBox(destination, region.dstSubresource, region.dstOffset, extent);
    const bool spreads = source.info().samples == 1;
    if (source.format().bytesPerTexel != destination.format().bytesPerTexel ||
        (source.info().samples != destination.info().samples && !spreads))
        return;
    from.width = to.width = std::min(from.width, to.width);
    from.height = to.height = std::min(from.height, to.height);
    from.depth = to.depth = std::min(from.depth, to.depth);
    const uint32_t texel = destination.format().bytesPerTexel;
    for (uint32_t sample = 0; sample < destination.info().samples; ++sample) {
        forEachRow(context, to, [&](uint32_t y, uint32_t z) {
            copyTexelRow(
                source.format(), destination.format(), region.dstSubresource.aspectMask,
                rowAddress(source, region.srcSubresource.mipLevel, from.y + y, from.z + z, spreads ? 0 : sample) +
                    uint64_t{from.x} * texel,
                rowAddress(destination, region.dstSubresource.mipLevel, to.y + y, to.z + z, sample) +
                    uint64_t{to.x} * texel,
                to.width);
        });
    }
}

void copyBufferToImage(const TransferContext& context, const Buffer& buffer, const Image& image,
                       const VkBufferImageCopy& region) {
    forEachBufferRow(context, image, buffer, region,
                     [](const FormatInfo& format, VkImageAspectFlags aspect, std::byte* texels, const std::byte* bytes,
                        uint32_t n) { copyTexelsFromBuffer(format, aspect, bytes, n, texels); });
}

void copyImageToBuffer(const TransferContext& context, const Image& image, const Buffer& buffer,
                       const VkBufferImageCopy& region) {
    forEachBufferRow(context, image, buffer, region,
                     [](const FormatInfo& format, VkImageAspectFlags aspect, const std::byte* texels, std::byte* bytes,
                        uint32_t n) { copyTexelsToBuffer(format, aspect, texels, n, bytes); });
}

}  // namespace vernier
