// Beginning and ending render passes and subpasses.
#include <algorithm>

#include "api/vulkan/chain.h"
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {
namespace {

/// The part of the area that lies inside the framebuffer.
VkRect2D clipArea(const VkRect2D& area, const VkExtent2D& extent) {
    const auto clip = [](int32_t offset, uint32_t size, uint32_t limit, int32_t& start, uint32_t& length) {
        const int64_t first = std::clamp<int64_t>(offset, 0, limit);
        const int64_t last = std::clamp<int64_t>(int64_t{offset} + size, first, limit);
        start = static_cast<int32_t>(first);
        length = static_cast<uint32_t>(last - first);
    };
    VkRect2D result{};
    clip(area.offset.x, area.extent.width, extent.width, result.offset.x, result.extent.width);
    clip(area.offset.y, area.extent.height, extent.height, result.offset.y, result.extent.height);
    return result;
}

/// Those of the framebuffer, or, if it is imageless, those that the beginning gives.
std::vector<const ImageView*> viewsOf(const Framebuffer& framebuffer, const VkRenderPassBeginInfo& begin) {
    std::vector<const ImageView*> views = framebuffer.views;
    const auto* given = findInChain<VkRenderPassAttachmentBeginInfo>(begin.pNext);
    if (views.empty() && given != nullptr) {
        for (uint32_t i = 0; i < given->attachmentCount; ++i) views.push_back(object(given->pAttachments[i]));
    }
    return views;
}

void beginSubpass(CommandBuffer& buffer, uint32_t subpass) {
    CommandBuffer::Pass& pass = buffer.pass;
    pass.subpass = subpass;
    pass.formats = pass.pass->formats(subpass);
    buffer.stream.record(renderingOf(*pass.pass, pass.views, pass.layers, subpass, pass.area, pass.clears));
    buffer.checkPipeline();
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdBeginRenderPass(VkCommandBuffer commandBuffer,
                                              const VkRenderPassBeginInfo* pRenderPassBegin, VkSubpassContents) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const RenderPassObject* pass = object(pRenderPassBegin->renderPass);
        const Framebuffer* framebuffer = object(pRenderPassBegin->framebuffer);
        if (buffer.level != VK_COMMAND_BUFFER_LEVEL_PRIMARY || buffer.pass.pass != nullptr) {
            return buffer.fail("vkCmdBeginRenderPass", "needs a primary command buffer outside a render pass");
        }
        std::vector<const ImageView*> views = viewsOf(*framebuffer, *pRenderPassBegin);
        if (const Status status = checkViews(*pass, views, framebuffer->extent, framebuffer->layers);
            !status || pass->subpasses.empty()) {
            return buffer.fail("vkCmdBeginRenderPass",
                               status ? "the render pass has no subpass" : status.error().message);
        }
        buffer.pass.pass = pass;
        buffer.pass.views = std::move(views);
        buffer.pass.layers = framebuffer->layers;
        buffer.pass.area = clipArea(pRenderPassBegin->renderArea, framebuffer->extent);
        buffer.pass.clears.assign(pass->attachments.size(), VkClearValue{});
        const size_t given = std::min<size_t>(pRenderPassBegin->clearValueCount, buffer.pass.clears.size());
        std::copy_n(pRenderPassBegin->pClearValues, given, buffer.pass.clears.begin());
        beginSubpass(buffer, 0);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdNextSubpass(VkCommandBuffer commandBuffer, VkSubpassContents) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (buffer.pass.layers == 0 || buffer.pass.subpass + 1 >= buffer.pass.pass->subpasses.size()) {
            return buffer.fail("vkCmdNextSubpass", "there is no next subpass");
        }
        buffer.stream.record(command::EndRendering{});
        beginSubpass(buffer, buffer.pass.subpass + 1);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdEndRenderPass(VkCommandBuffer commandBuffer) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (buffer.pass.layers == 0) {
            return buffer.fail("vkCmdEndRenderPass", "no render pass was begun");
        }
        buffer.stream.record(command::EndRendering{});
        buffer.pass = {};
        buffer.checkPipeline();
    });
}

VKAPI_ATTR void VKAPI_CALL CmdBeginRenderPass2(VkCommandBuffer commandBuffer,
                                               const VkRenderPassBeginInfo* pRenderPassBegin,
                                               const VkSubpassBeginInfo* pSubpassBeginInfo) {
    CmdBeginRenderPass(commandBuffer, pRenderPassBegin, pSubpassBeginInfo->contents);
}

VKAPI_ATTR void VKAPI_CALL CmdNextSubpass2(VkCommandBuffer commandBuffer, const VkSubpassBeginInfo* pSubpassBeginInfo,
                                           const VkSubpassEndInfo*) {
    CmdNextSubpass(commandBuffer, pSubpassBeginInfo->contents);
}

VKAPI_ATTR void VKAPI_CALL CmdEndRenderPass2(VkCommandBuffer commandBuffer, const VkSubpassEndInfo*) {
    CmdEndRenderPass(commandBuffer);
}

}  // namespace vernier::vulkan
