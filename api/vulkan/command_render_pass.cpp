// Beginning and ending render passes and subpasses.
#include <algorithm>

#include "api/vulkan/chain.h"
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/single_sampled.h"

namespace vernier::vulkan {
namespace {

/// Those of the framebuffer, or, if it is imageless, those that the beginning gives.
std::vector<const ImageView*> viewsOf(const Framebuffer& framebuffer, const VkRenderPassBeginInfo& begin) {
    std::vector<const ImageView*> views = framebuffer.views;
    const auto* given = findInChain<VkRenderPassAttachmentBeginInfo>(begin.pNext);
    if (views.empty() && given != nullptr) {
        for (uint32_t i = 0; i < given->attachmentCount; ++i) views.push_back(object(given->pAttachments[i]));
    }
    return views;
}

void beginSubpass(CommandBuffer& buffer, const char* command, uint32_t subpass) {
    CommandBuffer::Pass& pass = buffer.pass;
    pass.subpass = subpass;
    pass.formats = pass.pass->formats(subpass);
    command::BeginRendering rendering =
        renderingOf(*pass.pass, pass.views, pass.layers, subpass, pass.area, pass.clears);
    const Subpass& description = pass.pass->subpasses[subpass];
    std::vector<const ImageView*> inputs;
    for (const uint32_t index : description.inputs)
        if (description.samplesForSingle != 0 && index != VK_ATTACHMENT_UNUSED) inputs.push_back(pass.views[index]);
    if (const Status status = drawToSamples(buffer, rendering, 0, inputs); !status)
        buffer.fail(command, status.error().message);
    buffer.stream.record(rendering);
    buffer.checkPipeline();
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdBeginRenderPass(VkCommandBuffer commandBuffer,
                                              const VkRenderPassBeginInfo* pRenderPassBegin, VkSubpassContents) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const RenderPassObject* pass = object(pRenderPassBegin->renderPass);
        const Framebuffer* framebuffer = object(pRenderPassBegin->framebuffer);
        if (buffer.level != VK_COMMAND_BUFFER_LEVEL_PRIMARY || buffer.pass.inside) {
            return buffer.fail("vkCmdBeginRenderPass", "needs a primary command buffer outside a render pass");
        }
        std::vector<const ImageView*> views = viewsOf(*framebuffer, *pRenderPassBegin);
        if (const Status status = checkViews(*pass, views, framebuffer->extent, framebuffer->layers);
            !status || pass->subpasses.empty()) {
            return buffer.fail("vkCmdBeginRenderPass",
                               status ? "the render pass has no subpass" : status.error().message);
        }
        buffer.pass.inside = true;
        buffer.pass.pass = pass;
        buffer.pass.views = std::move(views);
        buffer.pass.layers = framebuffer->layers;
        buffer.pass.area = clipArea(pRenderPassBegin->renderArea, framebuffer->extent);
        buffer.pass.clears.assign(pass->attachments.size(), VkClearValue{});
        const size_t given = std::min<size_t>(pRenderPassBegin->clearValueCount, buffer.pass.clears.size());
        std::copy_n(pRenderPassBegin->pClearValues, given, buffer.pass.clears.begin());
        beginSubpass(buffer, "vkCmdBeginRenderPass", 0);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdNextSubpass(VkCommandBuffer commandBuffer, VkSubpassContents) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (!buffer.pass.begunHere() || buffer.pass.pass == nullptr ||
            buffer.pass.subpass + 1 >= buffer.pass.pass->subpasses.size()) {
            return buffer.fail("vkCmdNextSubpass", "there is no next subpass");
        }
        buffer.stream.record(command::EndRendering{});
        beginSubpass(buffer, "vkCmdNextSubpass", buffer.pass.subpass + 1);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdEndRenderPass(VkCommandBuffer commandBuffer) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (!buffer.pass.begunHere() || buffer.pass.pass == nullptr) {
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
