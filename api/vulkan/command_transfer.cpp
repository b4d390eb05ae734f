// Copies, blits, resolves, clears, fills and updates outside render passes.
#include <algorithm>
#include <vector>

#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "runtime/resource/image.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {
namespace {

bool hasMemory(const Buffer& buffer) {
    return buffer.data() != nullptr;
}
bool hasMemory(const Image& image) {
    return image.bound();
}

/// What a command outside render passes needs of the resources it touches; false after an error.
template <class... Resources>
bool check(CommandBuffer& buffer, const char* name, const Resources&... resources) {
    if (buffer.pass.inside) {
        buffer.fail(name, "not allowed inside a render pass");
    } else if (!(hasMemory(resources) && ...)) {
        buffer.fail(name, "a buffer or image has no memory bound");
    } else {
        return true;
    }
    return false;
}

/// Records Command{source, destination, regions}.
template <class Command, class Source, class Destination, class Region, class... More>
void recordRegions(VkCommandBuffer handle, const char* name, const Source* source, const Destination* destination,
                   uint32_t count, const Region* regions, More... more) {
    recording(handle, [&](CommandBuffer& buffer) {
        if (!check(buffer, name, *source, *destination)) return;
        buffer.stream.record(Command{source, destination, copyArray(buffer, count, regions), more...});
    });
}

/// The ranges with VK_REMAINING_* counts made numbers and cut to the image; empty ones are left out.
std::vector<VkImageSubresourceRange> resolveRanges(const Image& image, uint32_t count,
                                                   const VkImageSubresourceRange* ranges) {
    std::vector<VkImageSubresourceRange> result;
    const ImageInfo& info = image.info();
    for (uint32_t i = 0; i < count; ++i) {
        VkImageSubresourceRange range = ranges[i];
        range.aspectMask &= image.format().aspects;
        if (range.baseMipLevel >= info.mipLevels || range.baseArrayLayer >= info.arrayLayers) continue;
        range.levelCount = std::min(range.levelCount, info.mipLevels - range.baseMipLevel);
        range.layerCount = std::min(range.layerCount, info.arrayLayers - range.baseArrayLayer);
        if (range.aspectMask != 0) result.push_back(range);
    }
    return result;
}

template <class Command, class Value>
void recordClear(VkCommandBuffer handle, const char* name, const Image& image, const Value& value, uint32_t count,
                 const VkImageSubresourceRange* ranges) {
    recording(handle, [&](CommandBuffer& buffer) {
        if (!check(buffer, name, image)) return;
        const auto resolved = resolveRanges(image, count, ranges);
        buffer.stream.record(
            Command{&image, value, buffer.stream.copy(std::span<const VkImageSubresourceRange>(resolved))});
    });
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdCopyBuffer(VkCommandBuffer commandBuffer, VkBuffer srcBuffer, VkBuffer dstBuffer,
                                         uint32_t regionCount, const VkBufferCopy* pRegions) {
    recordRegions<command::CopyBuffer>(commandBuffer, "vkCmdCopyBuffer", object(srcBuffer), object(dstBuffer),
                                       regionCount, pRegions);
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImage(VkCommandBuffer commandBuffer, VkImage srcImage, VkImageLayout,
                                        VkImage dstImage, VkImageLayout, uint32_t regionCount,
                                        const VkImageCopy* pRegions) {
    recordRegions<command::CopyImage>(commandBuffer, "vkCmdCopyImage", object(srcImage), object(dstImage), regionCount,
                                      pRegions);
}

VKAPI_ATTR void VKAPI_CALL CmdBlitImage(VkCommandBuffer commandBuffer, VkImage srcImage, VkImageLayout,
                                        VkImage dstImage, VkImageLayout, uint32_t regionCount,
                                        const VkImageBlit* pRegions, VkFilter filter) {
    recordRegions<command::BlitImage>(commandBuffer, "vkCmdBlitImage", object(srcImage), object(dstImage), regionCount,
                                      pRegions, filter);
}

VKAPI_ATTR void VKAPI_CALL CmdCopyBufferToImage(VkCommandBuffer commandBuffer, VkBuffer srcBuffer, VkImage dstImage,
                                                VkImageLayout, uint32_t regionCount,
                                                const VkBufferImageCopy* pRegions) {
    recordRegions<command::CopyBufferToImage>(commandBuffer, "vkCmdCopyBufferToImage", object(srcBuffer),
                                              object(dstImage), regionCount, pRegions);
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImageToBuffer(VkCommandBuffer commandBuffer, VkImage srcImage, VkImageLayout,
                                                VkBuffer dstBuffer, uint32_t regionCount,
                                                const VkBufferImageCopy* pRegions) {
    recordRegions<command::CopyImageToBuffer>(commandBuffer, "vkCmdCopyImageToBuffer", object(srcImage),
                                              object(dstBuffer), regionCount, pRegions);
}

VKAPI_ATTR void VKAPI_CALL CmdResolveImage(VkCommandBuffer commandBuffer, VkImage srcImage, VkImageLayout,
                                           VkImage dstImage, VkImageLayout, uint32_t regionCount,
                                           const VkImageResolve* pRegions) {
    recordRegions<command::ResolveImage>(commandBuffer, "vkCmdResolveImage", object(srcImage), object(dstImage),
                                         regionCount, pRegions);
}

VKAPI_ATTR void VKAPI_CALL CmdClearColorImage(VkCommandBuffer commandBuffer, VkImage image, VkImageLayout,
                                              const VkClearColorValue* pColor, uint32_t rangeCount,
                                              const VkImageSubresourceRange* pRanges) {
    recordClear<command::ClearColorImage>(commandBuffer, "vkCmdClearColorImage", *object(image), *pColor, rangeCount,
                                          pRanges);
}

VKAPI_ATTR void VKAPI_CALL CmdClearDepthStencilImage(VkCommandBuffer commandBuffer, VkImage image, VkImageLayout,
                                                     const VkClearDepthStencilValue* pDepthStencil, uint32_t rangeCount,
                                                     const VkImageSubresourceRange* pRanges) {
    recordClear<command::ClearDepthStencilImage>(commandBuffer, "vkCmdClearDepthStencilImage", *object(image),
                                                 *pDepthStencil, rangeCount, pRanges);
}

VKAPI_ATTR void VKAPI_CALL CmdFillBuffer(VkCommandBuffer commandBuffer, VkBuffer dstBuffer, VkDeviceSize dstOffset,
                                         VkDeviceSize size, uint32_t data) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (!check(buffer, "vkCmdFillBuffer", *object(dstBuffer))) return;
        buffer.stream.record(command::FillBuffer{object(dstBuffer), dstOffset, size, data});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdUpdateBuffer(VkCommandBuffer commandBuffer, VkBuffer dstBuffer, VkDeviceSize dstOffset,
                                           VkDeviceSize dataSize, const void* pData) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (!check(buffer, "vkCmdUpdateBuffer", *object(dstBuffer))) return;
        constexpr VkDeviceSize kLargestUpdate = 65536;
        if (dataSize > kLargestUpdate) return buffer.fail("vkCmdUpdateBuffer", "dataSize is above 65536");
        const std::span bytes(static_cast<const std::byte*>(pData), dataSize);
        buffer.stream.record(command::UpdateBuffer{object(dstBuffer), dstOffset, buffer.stream.copy(bytes)});
    });
}

}  // namespace vernier::vulkan
