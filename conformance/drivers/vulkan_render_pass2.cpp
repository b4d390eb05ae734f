// The part of VulkanPassBuilder that says render passes by VK_KHR_create_renderpass2: those that resolve depth and
// stencil (VK_KHR_depth_stencil_resolve).
#include "conformance/drivers/vulkan_passes.h"

namespace vernier::conformance {
namespace {

VkAttachmentReference2 referenceOf(const VkAttachmentReference& from, VkImageAspectFlags aspects) {
    VkAttachmentReference2 to{};
    to.sType = VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2;
    to.attachment = from.attachment;
    to.layout = from.layout;
    to.aspectMask = aspects;
    return to;
}

std::vector<VkAttachmentReference2> referencesOf(const VkAttachmentReference* from, uint32_t count) {
    std::vector<VkAttachmentReference2> to;
    for (uint32_t i = 0; from != nullptr && i < count; ++i) {
        to.push_back(referenceOf(from[i], VK_IMAGE_ASPECT_COLOR_BIT));
    }
    return to;
}

VkAttachmentDescription2 descriptionOf(const VkAttachmentDescription& from) {
    VkAttachmentDescription2 to{};
    to.sType = VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2;
    to.format = from.format;
    to.samples = from.samples;
    to.loadOp = from.loadOp;
    to.storeOp = from.storeOp;
    to.stencilLoadOp = from.stencilLoadOp;
    to.stencilStoreOp = from.stencilStoreOp;
    to.initialLayout = from.initialLayout;
    to.finalLayout = from.finalLayout;
    return to;
}

}  // namespace

Result<VkRenderPass> VulkanPassBuilder::createResolvingRenderPass(const VkRenderPassCreateInfo& info, uint32_t viewMask,
                                                                  const SceneAttachment& depth, uint32_t target) {
    const VkDevice device = context_.device();
    const auto create =
        reinterpret_cast<PFN_vkCreateRenderPass2KHR>(vkGetDeviceProcAddr(device, "vkCreateRenderPass2KHR"));
    const VkPhysicalDeviceDepthStencilResolveProperties& modes = context_.depthStencilResolve();
    if (create == nullptr || !context_.extensions().depthStencilResolve) {
        return unsupported("the device lacks VK_KHR_depth_stencil_resolve");
    }
    const auto lacks = [](VkResolveModeFlagBits wanted, VkResolveModeFlags present) {
        return wanted != VK_RESOLVE_MODE_NONE && (present & wanted) == 0;
    };
    if (lacks(depth.depthResolve, modes.supportedDepthResolveModes) ||
        lacks(depth.stencilResolve, modes.supportedStencilResolveModes)) {
        return unsupported("the device lacks depth resolve mode " + std::to_string(depth.depthResolve) +
                           " or stencil resolve mode " + std::to_string(depth.stencilResolve));
    }
    const bool none = depth.depthResolve == VK_RESOLVE_MODE_NONE || depth.stencilResolve == VK_RESOLVE_MODE_NONE;
    if (depth.depthResolve != depth.stencilResolve &&
        (none ? modes.independentResolveNone : modes.independentResolve) == VK_FALSE) {
        return unsupported("the device resolves depth and stencil by the same mode only");
    }
    std::vector<VkAttachmentDescription2> attachments;
    for (uint32_t i = 0; i < info.attachmentCount; ++i) attachments.push_back(descriptionOf(info.pAttachments[i]));
    const VkSubpassDescription& from = info.pSubpasses[0];
    const std::vector<VkAttachmentReference2> colors = referencesOf(from.pColorAttachments, from.colorAttachmentCount),
                                              resolves =
                                                  referencesOf(from.pResolveAttachments, from.colorAttachmentCount);
    constexpr VkImageAspectFlags kBoth = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    const VkAttachmentReference2 source = referenceOf(*from.pDepthStencilAttachment, kBoth);
    VkAttachmentReference2 destination = source;
    destination.attachment = target;
    VkSubpassDescriptionDepthStencilResolve resolve{};
    resolve.sType = VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE;
    resolve.depthResolveMode = depth.depthResolve;
    resolve.stencilResolveMode = depth.stencilResolve;
    resolve.pDepthStencilResolveAttachment = &destination;
    VkSubpassDescription2 subpass{};
    subpass.sType = VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2;
    subpass.pNext = &resolve;
    subpass.pipelineBindPoint = from.pipelineBindPoint;
    subpass.viewMask = viewMask;
    subpass.colorAttachmentCount = from.colorAttachmentCount;
    subpass.pColorAttachments = colors.data();
    subpass.pResolveAttachments = resolves.empty() ? nullptr : resolves.data();
    subpass.pDepthStencilAttachment = &source;
    VkRenderPassCreateInfo2 info2{};
    info2.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2;
    info2.attachmentCount = info.attachmentCount;
    info2.pAttachments = attachments.data();
    info2.subpassCount = 1;
    info2.pSubpasses = &subpass;
    VkRenderPass renderPass = VK_NULL_HANDLE;
    VERNIER_TRY_VK(create(device, &info2, nullptr, &renderPass));
    return renderPass;
}

}  // namespace vernier::conformance
