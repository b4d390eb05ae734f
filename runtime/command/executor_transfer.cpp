// The commands that move data.
#include "runtime/command/executor.h"
#include "runtime/transfer/transfer.h"

namespace vernier {
namespace {

using Bytes = std::span<const std::byte>;

Bytes bytesOf(const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size) {
    if (buffer.data() == nullptr || offset >= buffer.size()) return {};
    return {buffer.data() + offset, static_cast<size_t>(std::min(size, buffer.size() - offset))};
}

/// All layers and slices that a region may reach, whole.
Bytes bytesOf(const Image& whole, const VkImageSubresourceLayers& layers, uint32_t depth) {
    const Image& image = whole.ofAspect(layers.aspectMask);
    if (image.info().type == VK_IMAGE_TYPE_3D) return layersOf(image, layers.mipLevel, 0, image.info().extent.depth);
    return layersOf(image, layers.mipLevel, layers.baseArrayLayer, std::max(layers.layerCount, depth));
}
Bytes bytesOf(const Image& image, const VkImageSubresourceRange& range) {
    if (!image.bound() || range.baseMipLevel >= image.info().mipLevels ||
        range.baseArrayLayer >= image.info().arrayLayers)
        return {};
    const bool volume = image.info().type == VK_IMAGE_TYPE_3D;
    const uint32_t first = volume ? 0 : range.baseArrayLayer;
    const uint32_t layers = std::min(range.layerCount, image.info().arrayLayers - range.baseArrayLayer);
    const std::byte* begin = image.address(range.baseMipLevel, first);
    return {begin, image.address(0, volume ? 1 : first + layers)};
}

struct Touched {
    Bytes read, written;
};

Touched touched(const command::CopyBuffer& c, const VkBufferCopy& region) {
    return {bytesOf(*c.source, region.srcOffset, region.size), bytesOf(*c.destination, region.dstOffset, region.size)};
}
template <class Command, class Region>
Touched touchedImages(const Command& c, const Region& region, uint32_t fromDepth, uint32_t toDepth) {
    return {bytesOf(*c.source, region.srcSubresource, fromDepth),
            bytesOf(*c.destination, region.dstSubresource, toDepth)};
}
Touched touched(const command::CopyImage& c, const VkImageCopy& region) {
    // Slices of a volume are layers of an array.
    const uint32_t slices =
        std::max({region.extent.depth, region.srcSubresource.layerCount, region.dstSubresource.layerCount});
    return touchedImages(c, region, slices, slices);
}
Touched touched(const command::BlitImage& c, const VkImageBlit& region) {
    return touchedImages(c, region, 1, 1);
}
Touched touched(const command::ResolveImage& c, const VkImageResolve& region) {
    return touchedImages(c, region, 1, 1);
}
Touched touched(const command::CopyBufferToImage& c, const VkBufferImageCopy& region) {
    return {bytesOf(*c.buffer, region.bufferOffset, VK_WHOLE_SIZE),
            bytesOf(*c.image, region.imageSubresource, region.imageExtent.depth)};
}
Touched touched(const command::CopyImageToBuffer& c, const VkBufferImageCopy& region) {
    return {bytesOf(*c.image, region.imageSubresource, region.imageExtent.depth),
            bytesOf(*c.buffer, region.bufferOffset, VK_WHOLE_SIZE)};
}
Touched touched(const command::ClearColorImage& c, const VkImageSubresourceRange& range) {
    return {{}, bytesOf(*c.image, range)};
}
Touched touched(const command::ClearDepthStencilImage& c, const VkImageSubresourceRange& range) {
    return {{}, bytesOf(*c.image, range)};
}

void add(const Touched& touched, AccessSet& accesses) {
    accesses.read(touched.read.data(), touched.read.size());
    accesses.write(touched.written.data(), touched.written.size());
}

}  // namespace

/// One call per region.
#define VERNIER_PER_REGION(Name, items, call)                                         \
    void Executor::run(const command::Name& command) {                                \
        AccessSet& accesses = scheduler_.nextAccesses();                              \
        for (const auto& item : command.items) add(touched(command, item), accesses); \
        scheduler_.submit([this, &command] {                                          \
            const TransferContext context{device_.pool(), device_.isa()};             \
            for (const auto& item : command.items) call;                              \
        });                                                                           \
    }
VERNIER_PER_REGION(CopyBuffer, regions, copyBuffer(context, *command.source, *command.destination, item))
VERNIER_PER_REGION(CopyImage, regions, copyImage(context, *command.source, *command.destination, item))
VERNIER_PER_REGION(CopyBufferToImage, regions, copyBufferToImage(context, *command.buffer, *command.image, item))
VERNIER_PER_REGION(CopyImageToBuffer, regions, copyImageToBuffer(context, *command.image, *command.buffer, item))
VERNIER_PER_REGION(BlitImage, regions, blitImage(context, *command.source, *command.destination, item, command.filter))
VERNIER_PER_REGION(ResolveImage, regions, resolveImage(context, *command.source, *command.destination, item))
VERNIER_PER_REGION(ClearColorImage, ranges, clearColorImage(context, *command.image, command.value, item))
VERNIER_PER_REGION(ClearDepthStencilImage, ranges, clearDepthStencilImage(context, *command.image, command.value, item))
#undef VERNIER_PER_REGION

void Executor::run(const command::FillBuffer& command) {
    const Bytes bytes = bytesOf(*command.buffer, command.offset, command.size);
    scheduler_.nextAccesses().write(bytes.data(), bytes.size());
    scheduler_.submit([this, &command] {
        fillBuffer({device_.pool(), device_.isa()}, *command.buffer, command.offset, command.size, command.value);
    });
}

void Executor::run(const command::UpdateBuffer& command) {
    const Bytes bytes = bytesOf(*command.buffer, command.offset, command.bytes.size());
    scheduler_.nextAccesses().write(bytes.data(), bytes.size());
    scheduler_.submit([&command] { updateBuffer(*command.buffer, command.offset, command.bytes); });
}

}  // namespace vernier
