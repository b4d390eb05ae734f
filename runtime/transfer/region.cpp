#include "runtime/transfer/region.h"

#include <string>

namespace vernier {
namespace {

/// Below this many texels the hand-over to other threads costs more than the work.
constexpr uint64_t kParallelTexels = 64 * 1024;
constexpr uint32_t kRowsPerStep = 16;

uint32_t clipSpan(uint32_t begin, uint32_t count, uint32_t limit) {
    return begin >= limit ? 0 : std::min(count, limit - begin);
}

}  // namespace

TexelBox clipBox(const Image& image, const VkImageSubresourceLayers& subresource, const VkOffset3D& offset,
                 const VkExtent3D& extent) {
    if (subresource.mipLevel >= image.info().mipLevels || offset.x < 0 || offset.y < 0 || offset.z < 0) return {};
    const VkExtent3D& size = image.level(subresource.mipLevel).extent;
    const bool volume = image.info().type == VK_IMAGE_TYPE_3D;
    TexelBox box;
    box.x = static_cast<uint32_t>(offset.x);
    box.y = static_cast<uint32_t>(offset.y);
    box.z = volume ? static_cast<uint32_t>(offset.z) : subresource.baseArrayLayer;
    box.width = clipSpan(box.x, extent.width, size.width);
    box.height = clipSpan(box.y, extent.height, size.height);
    if (const BlockCodec* block = image.format().block) {
        box.x /= block->width;
        box.y /= block->height;
        box.width = image.format().columns(box.width);
        box.height = image.format().rows(box.height);
    }
    const uint32_t slices =
        volume ? std::max(extent.depth, subresource.layerCount) : std::max(subresource.layerCount, extent.depth);
    box.depth = clipSpan(box.z, slices, volume ? size.depth : image.info().arrayLayers);
    return box;
}

std::byte* rowAddress(const Image& image, uint32_t mip, uint32_t y, uint32_t z, uint32_t sample) {
    const bool volume = image.info().type == VK_IMAGE_TYPE_3D;
    return image.address(mip, volume ? 0 : z, volume ? z : 0, sample) + uint64_t{y} * image.level(mip).rowPitch;
}

void forEachRun(const TransferContext& context, const TexelBox& box,
                const std::function<void(uint64_t begin, uint64_t end)>& run) {
    if (box.empty()) return;
    const uint64_t rows = uint64_t{box.height} * box.depth;
    if (rows * box.width < kParallelTexels) return run(0, rows);
    const auto steps = static_cast<uint32_t>((rows + kRowsPerStep - 1) / kRowsPerStep);
    context.pool.parallelFor(steps, [&](uint32_t step, uint32_t) {
        const uint64_t begin = uint64_t{step} * kRowsPerStep;
        run(begin, std::min(rows, begin + kRowsPerStep));
    });
}

void forEachRow(const TransferContext& context, const TexelBox& box,
                const std::function<void(uint32_t y, uint32_t z)>& row) {
    forEachRun(context, box, [&](uint64_t begin, uint64_t end) {
        for (uint64_t i = begin; i < end; ++i)
            row(static_cast<uint32_t>(i % box.height), static_cast<uint32_t>(i / box.height));
    });
}

Status checkBufferImageCopy(const Image& image, VkDeviceSize bufferSize, const VkBufferImageCopy& region) {
    const auto wrong = [](const std::string& text) -> Status { return invalidArgument("buffer-image copy: " + text); };
    const VkImageSubresourceLayers& sub = region.imageSubresource;
    if (sub.mipLevel >= image.info().mipLevels)
        return wrong("mip level " + std::to_string(sub.mipLevel) + " of " + std::to_string(image.info().mipLevels));
    const TexelBox box = clipBox(image, sub, region.imageOffset, region.imageExtent);
    const FormatInfo& format = image.format();
    const VkExtent3D& size = image.level(sub.mipLevel).extent;
    const auto inside = [](int32_t offset, uint32_t count, uint32_t limit) {
        return offset >= 0 && static_cast<uint32_t>(offset) <= limit && count <= limit - static_cast<uint32_t>(offset);
    };
    if (!inside(region.imageOffset.x, region.imageExtent.width, size.width) ||
        !inside(region.imageOffset.y, region.imageExtent.height, size.height) || box.empty() ||
        box.depth < std::max(sub.layerCount, region.imageExtent.depth))
        return wrong("the region reaches outside the image");
    const auto wholeBlocks = [](int32_t offset, uint32_t count, uint32_t limit, uint32_t block) {
        const auto first = static_cast<uint32_t>(offset);
        return first % block == 0 && (count % block == 0 || first + count == limit);
    };
    if (!wholeBlocks(region.imageOffset.x, region.imageExtent.width, size.width, format.blockWidth()) ||
        !wholeBlocks(region.imageOffset.y, region.imageExtent.height, size.height, format.blockHeight()))
        return wrong("the region cuts blocks of " + std::to_string(format.blockWidth()) + " x " +
                     std::to_string(format.blockHeight()) + " texels");
    const bool oneAspect = sub.aspectMask != 0 && (sub.aspectMask & (sub.aspectMask - 1)) == 0;
    if (!oneAspect || (sub.aspectMask & format.aspects) == 0)
        return wrong("aspect mask " + std::to_string(sub.aspectMask) + " is not one aspect of the image");
    const uint64_t texel = bufferTexelBytes(format, sub.aspectMask);
    const uint64_t rowTexels = region.bufferRowLength ? format.columns(region.bufferRowLength) : box.width;
    const uint64_t sliceRows = region.bufferImageHeight ? format.rows(region.bufferImageHeight) : box.height;
    // Below 2^12 slices of 2^32 rows of 2^32 texels of 2^4 bytes: too many for 64 bits.
    __extension__ using Wide = unsigned __int128;
    const Wide last = ((Wide{box.depth} - 1) * sliceRows + box.height - 1) * rowTexels + box.width;
    if (region.bufferOffset > bufferSize || last * texel > bufferSize - region.bufferOffset)
        return wrong("the region needs more bytes from offset " + std::to_string(region.bufferOffset) +
                     " on than the buffer's " + std::to_string(bufferSize));
    return {};
}

}  // namespace vernier
