#include "conformance/drivers/vulkan_passes.h"

#include "conformance/drivers/stopwatch.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace vernier::conformance {
namespace {

VkAttachmentDescription attachmentDescription(const SceneImage& image, VkAttachmentLoadOp loadOp,
                                              VkImageLayout layout) {
    VkAttachmentDescription description{};
    description.format = image.format;
    description.samples = image.samples;
    description.loadOp = description.stencilLoadOp = loadOp;
    description.storeOp = description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
    description.initialLayout = description.finalLayout = layout;  // the barriers in between are explicit
    return description;
}

/// Draws that share a pipeline: same state, as many viewports, same bindings.
using PipelineKey = std::tuple<uint32_t, size_t, std::vector<std::tuple<uint32_t, uint32_t, VkDescriptorType>>>;

PipelineKey pipelineKey(const SceneDraw& draw) {
    PipelineKey key{draw.pipeline, draw.moreViews.size(), {}};
    for (const SceneBinding& each : draw.bindings) std::get<2>(key).emplace_back(each.set, each.binding, each.type);
    return key;
}

}  // namespace

Result<VulkanPass> VulkanPassBuilder::build(const ScenePass& scenePass) {
    modules_.resize(scene_.shaders.size());
    VulkanPass pass;
    VERNIER_TRY(createRenderPass(scenePass, pass));
    std::map<PipelineKey, size_t> known;
    for (const SceneDraw& draw : scenePass.draws) {
        const auto [entry, isNew] = known.try_emplace(pipelineKey(draw), pass.pipelines.size());
        if (isNew) {
            const Stopwatch watch;
            const double modulesBefore = moduleTime_;
            Result<VulkanPipeline> pipeline = createPipeline(draw, pass.renderPass);
            if (!pipeline) return pipeline.error();
            pipelineTime_ += watch.milliseconds() - (moduleTime_ - modulesBefore);
            pass.pipelines.push_back(std::move(*pipeline));
        }
        Result<std::vector<VkDescriptorSet>> sets = createSets(draw, pass.pipelines[entry->second]);
        if (!sets) return sets.error();
        pass.draws.push_back({entry->second, std::move(*sets)});
    }
    return pass;
}

Status VulkanPassBuilder::createRenderPass(const ScenePass& scenePass, VulkanPass& pass) {
    const VkDevice device = context_.device();
    std::vector<VkAttachmentDescription> attachments;
    std::vector<VkImageView> views;
    std::vector<VkAttachmentReference> colors, resolves;
    VkAttachmentReference depth{VK_ATTACHMENT_UNUSED, VK_IMAGE_LAYOUT_UNDEFINED};
    bool resolving = false;
    uint32_t depthResolve = VK_ATTACHMENT_UNUSED;
    const auto attach = [&](const SceneAttachment& attachment, uint32_t image, VkAttachmentLoadOp loadOp,
                            VkImageLayout layout) -> Result<VkAttachmentReference> {
        const bool resolve = image == attachment.resolveImage;
        const Result<VkImageView> view = resources_.attachmentView(
            image, resolve ? 0 : attachment.mipLevel, resolve ? 0 : attachment.layer, attachment.layerCount);
        if (!view) return view.error();
        views.push_back(*view);
        attachments.push_back(attachmentDescription(scene_.images[image], loadOp, layout));
        pass.clears.push_back(attachment.clear);
        return VkAttachmentReference{static_cast<uint32_t>(attachments.size() - 1), layout};
    };
    for (const SceneAttachment& color : scenePass.colors) {
        const auto reference = attach(color, color.image, color.loadOp, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        if (!reference) return reference.error();
        colors.push_back(*reference);
        VkAttachmentReference resolve{VK_ATTACHMENT_UNUSED, VK_IMAGE_LAYOUT_UNDEFINED};
        if (color.resolveImage != kNone) {
            const auto resolved = attach(color, color.resolveImage, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                         VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
            if (!resolved) return resolved.error();
            resolve = *resolved;
            resolving = true;
        }
        resolves.push_back(resolve);
    }
    if (scenePass.depthStencil.image != kNone) {
        const auto reference = attach(scenePass.depthStencil, scenePass.depthStencil.image,
                                      scenePass.depthStencil.loadOp, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        if (!reference) return reference.error();
        depth = *reference;
        if (scenePass.depthStencil.resolveImage != kNone) {
            const auto resolved =
                attach(scenePass.depthStencil, scenePass.depthStencil.resolveImage, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                       VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
            if (!resolved) return resolved.error();
            depthResolve = resolved->attachment;
        }
    }
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = static_cast<uint32_t>(colors.size());
    subpass.pColorAttachments = colors.data();
    subpass.pResolveAttachments = resolving ? resolves.data() : nullptr;
    subpass.pDepthStencilAttachment = &depth;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = static_cast<uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VkRenderPassMultiviewCreateInfo multiview{};
    multiview.sType = VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO;
    multiview.subpassCount = 1;
    multiview.pViewMasks = &scenePass.viewMask;
    if (scenePass.viewMask != 0) {
        if (context_.extensions().multiview.multiview == VK_FALSE) return unsupported("the device lacks multiview");
        info.pNext = &multiview;
    }
    if (depthResolve != VK_ATTACHMENT_UNUSED) {
        const Result<VkRenderPass> made =
            createResolvingRenderPass(info, scenePass.viewMask, scenePass.depthStencil, depthResolve);
        if (!made) return made.error();
        pass.renderPass = *made;
    } else {
        VERNIER_TRY_VK(vkCreateRenderPass(device, &info, nullptr, &pass.renderPass));
    }
    resources_.cleanup().add([device, handle = pass.renderPass] { vkDestroyRenderPass(device, handle, nullptr); });
    VkFramebufferCreateInfo framebuffer{};
    framebuffer.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    framebuffer.renderPass = pass.renderPass;
    framebuffer.attachmentCount = static_cast<uint32_t>(views.size());
    framebuffer.pAttachments = views.data();
    framebuffer.width = scenePass.extent.width;
    framebuffer.height = scenePass.extent.height;
    framebuffer.layers = scenePass.viewMask != 0    ? 1
                         : scenePass.colors.empty() ? scenePass.depthStencil.layerCount
                                                    : scenePass.colors[0].layerCount;
    VERNIER_TRY_VK(vkCreateFramebuffer(device, &framebuffer, nullptr, &pass.framebuffer));
    resources_.cleanup().add([device, handle = pass.framebuffer] { vkDestroyFramebuffer(device, handle, nullptr); });
    return {};
}

Status VulkanPassBuilder::createLayouts(const SceneDraw& draw, VulkanPipeline& pipeline) {
    const VkDevice device = context_.device();
    uint32_t setCount = 0;
    for (const SceneBinding& each : draw.bindings) setCount = std::max(setCount, each.set + 1);
    for (uint32_t set = 0; set < setCount; ++set) {
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (const SceneBinding& each : draw.bindings) {
            if (each.set == set) bindings.push_back({each.binding, each.type, 1, kDrawStages, nullptr});
        }
        VkDescriptorSetLayoutCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        info.bindingCount = static_cast<uint32_t>(bindings.size());
        info.pBindings = bindings.data();
        VkDescriptorSetLayout layout = VK_NULL_HANDLE;
        VERNIER_TRY_VK(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout));
        resources_.cleanup().add([device, layout] { vkDestroyDescriptorSetLayout(device, layout, nullptr); });
        pipeline.setLayouts.push_back(layout);
    }
    const VkPushConstantRange range{kDrawStages, 0, scene_.pipelines[draw.pipeline].pushConstantBytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<uint32_t>(pipeline.setLayouts.size());
    info.pSetLayouts = pipeline.setLayouts.data();
    info.pushConstantRangeCount = range.size != 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VERNIER_TRY_VK(vkCreatePipelineLayout(device, &info, nullptr, &pipeline.layout));
    resources_.cleanup().add([device, handle = pipeline.layout] { vkDestroyPipelineLayout(device, handle, nullptr); });
    return {};
}

Result<std::vector<VkDescriptorSet>> VulkanPassBuilder::createSets(const SceneDraw& draw,
                                                                   const VulkanPipeline& pipeline) {
    if (draw.bindings.empty()) return std::vector<VkDescriptorSet>{};
    const VkDevice device = context_.device();
    std::vector<VkDescriptorPoolSize> sizes;
    for (const SceneBinding& each : draw.bindings) sizes.push_back({each.type, 1});
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.maxSets = static_cast<uint32_t>(pipeline.setLayouts.size());
    poolInfo.poolSizeCount = static_cast<uint32_t>(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool));
    resources_.cleanup().add([device, pool] { vkDestroyDescriptorPool(device, pool, nullptr); });
    VkDescriptorSetAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = static_cast<uint32_t>(pipeline.setLayouts.size());
    allocation.pSetLayouts = pipeline.setLayouts.data();
    std::vector<VkDescriptorSet> sets(pipeline.setLayouts.size());
    VERNIER_TRY_VK(vkAllocateDescriptorSets(device, &allocation, sets.data()));
    for (const SceneBinding& each : draw.bindings) {
        VkDescriptorBufferInfo buffer{};
        VkDescriptorImageInfo image{};
        VkBufferView texels = VK_NULL_HANDLE;
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = sets[each.set];
        write.dstBinding = each.binding;
        write.descriptorCount = 1;
        write.descriptorType = each.type;
        write.pImageInfo = &image;
        write.pBufferInfo = &buffer;
        write.pTexelBufferView = &texels;
        switch (each.type) {
            case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER: {
                const bool color = (scene_.images[each.image].usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) == 0;
                image = {
                    resources_.sampler(each.sampler), resources_.sampledView(each.image),
                    color ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
                break;
            }
            case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
                image = {VK_NULL_HANDLE, resources_.sampledView(each.image), VK_IMAGE_LAYOUT_GENERAL};
                break;
            case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
            case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER: {
                const Result<VkBufferView> view = resources_.texelView(each);
                if (!view) return view.error();
                texels = *view;
                break;
            }
            default:
                buffer = {resources_.buffer(each.buffer), each.offset, each.range};
                break;
        }
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    return sets;
}

}  // namespace vernier::conformance
