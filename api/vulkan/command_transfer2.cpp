// Transfer commands in the form of VK_KHR_copy_commands2: their regions are those of the plain commands behind sType
// and pNext.
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {
namespace {

constexpr VkBufferCopy plain(const VkBufferCopy2& r) {
    return {r.srcOffset, r.dstOffset, r.size};
}
constexpr VkImageCopy plain(const VkImageCopy2& r) {
    return {r.srcSubresource, r.srcOffset, r.dstSubresource, r.dstOffset, r.extent};
}
constexpr VkImageBlit plain(const VkImageBlit2& r) {
    return {r.srcSubresource, {r.srcOffsets[0], r.srcOffsets[1]}, r.dstSubresource, {r.dstOffsets[0], r.dstOffsets[1]}};
}
constexpr VkBufferImageCopy plain(const VkBufferImageCopy2& r) {
    return {r.bufferOffset, r.bufferRowLength, r.bufferImageHeight, r.imageSubresource, r.imageOffset, r.imageExtent};
}
constexpr VkImageResolve plain(const VkImageResolve2& r) {
    return {r.srcSubresource, r.srcOffset, r.dstSubresource, r.dstOffset, r.extent};
}

/// Calls record(count, regions) with the plain regions of `info`.
template <class Info, class Record>
void withPlainRegions(VkCommandBuffer commandBuffer, const Info& info, Record record) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const auto regions = buffer.stream.arena().array<decltype(plain(*info.pRegions))>(info.regionCount);
        for (uint32_t i = 0; i < info.regionCount; ++i) regions[i] = plain(info.pRegions[i]);
        record(info.regionCount, regions.data());
    });
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdCopyBuffer2(VkCommandBuffer commandBuffer, const VkCopyBufferInfo2* pCopyBufferInfo) {
    const VkCopyBufferInfo2& info = *pCopyBufferInfo;
    withPlainRegions(commandBuffer, info, [&](uint32_t count, const auto* regions) {
        CmdCopyBuffer(commandBuffer, info.srcBuffer, info.dstBuffer, count, regions);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImage2(VkCommandBuffer commandBuffer, const VkCopyImageInfo2* pCopyImageInfo) {
    const VkCopyImageInfo2& info = *pCopyImageInfo;
    withPlainRegions(commandBuffer, info, [&](uint32_t count, const auto* regions) {
        CmdCopyImage(commandBuffer, info.srcImage, info.srcImageLayout, info.dstImage, info.dstImageLayout, count,
                     regions);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdBlitImage2(VkCommandBuffer commandBuffer, const VkBlitImageInfo2* pBlitImageInfo) {
    const VkBlitImageInfo2& info = *pBlitImageInfo;
    withPlainRegions(commandBuffer, info, [&](uint32_t count, const auto* regions) {
        CmdBlitImage(commandBuffer, info.srcImage, info.srcImageLayout, info.dstImage, info.dstImageLayout, count,
                     regions, info.filter);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdCopyBufferToImage2(VkCommandBuffer commandBuffer,
                                                 const VkCopyBufferToImageInfo2* pCopyBufferToImageInfo) {
    const VkCopyBufferToImageInfo2& info = *pCopyBufferToImageInfo;
    withPlainRegions(commandBuffer, info, [&](uint32_t count, const auto* regions) {
        CmdCopyBufferToImage(commandBuffer, info.srcBuffer, info.dstImage, info.dstImageLayout, count, regions);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdCopyImageToBuffer2(VkCommandBuffer commandBuffer,
                                                 const VkCopyImageToBufferInfo2* pCopyImageToBufferInfo) {
    const VkCopyImageToBufferInfo2& info = *pCopyImageToBufferInfo;
    withPlainRegions(commandBuffer, info, [&](uint32_t count, const auto* regions) {
        CmdCopyImageToBuffer(commandBuffer, info.srcImage, info.srcImageLayout, info.dstBuffer, count, regions);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdResolveImage2(VkCommandBuffer commandBuffer,
                                            const VkResolveImageInfo2* pResolveImageInfo) {
    const VkResolveImageInfo2& info = *pResolveImageInfo;
    withPlainRegions(commandBuffer, info, [&](uint32_t count, const auto* regions) {
        CmdResolveImage(commandBuffer, info.srcImage, info.srcImageLayout, info.dstImage, info.dstImageLayout, count,
                        regions);
    });
}

}  // namespace vernier::vulkan
