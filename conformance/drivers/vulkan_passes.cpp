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
    Attachments attachments;
    VERNIER_TRY(createAttachments(scenePass, pass, attachments));
    VERNIER_TRY(createRenderPass(scenePass, attachments, pass));
    VERNIER_TRY(createFramebuffer(scenePass, attachments, pass));
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

Status VulkanPassBuilder::attach(const SceneAttachment& attachment, VkImageLayout layout, VulkanPass& pass,
                                 Attachments& all, VkAttachmentReference& reference, VkAttachmentReference& resolve) {
    const auto add = [&](uint32_t image, uint32_t level, uint32_t layer, VkAttachmentLoadOp loadOp,
                         VkAttachmentReference& where) -> Status {
        const Result<VkImageView> view = resources_.attachmentView(image, level, layer, attachment.layerCount);
        if (!view) return view.error();
        where = {static_cast<uint32_t>(all.views.size()), layout};
        all.views.push_back(*view);
        all.descriptions.push_back(attachmentDescription(scene_.images[image], loadOp, layout));
        pass.clears.push_back(attachment.clear);
        return {};
    };
    VERNIER_TRY(add(attachment.image, attachment.mipLevel, attachment.layer, attachment.loadOp, reference));
    if (attachment.resolveImage == kNone) return {};
    return add(attachment.resolveImage, 0, 0, VK_ATTACHMENT_LOAD_OP_DONT_CARE, resolve);
}

Status VulkanPassBuilder::createAttachments(const ScenePass& scene, VulkanPass& pass, Attachments& all) {
    const VkAttachmentReference none{VK_ATTACHMENT_UNUSED, VK_IMAGE_LAYOUT_UNDEFINED};
    all.colors.assign(scene.colors.size(), none);
    all.resolves.assign(scene.colors.size(), none);
    for (size_t i = 0; i < scene.colors.size(); ++i) {
        VERNIER_TRY(attach(scene.colors[i], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, pass, all, all.colors[i],
                           all.resolves[i]));
    }
    if (scene.depthStencil.image == kNone) return {};
    return attach(scene.depthStencil, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, pass, all, all.depth,
                  all.depthResolve);
}

Status VulkanPassBuilder::createRenderPass(const ScenePass& scene, const Attachments& all, VulkanPass& pass) {
    const VkDevice device = context_.device();
    const bool resolving = std::any_of(all.resolves.begin(), all.resolves.end(),
                                       [](const auto& each) { return each.attachment != VK_ATTACHMENT_UNUSED; });
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = static_cast<uint32_t>(all.colors.size());
    subpass.pColorAttachments = all.colors.data();
    subpass.pResolveAttachments = resolving ? all.resolves.data() : nullptr;
    subpass.pDepthStencilAttachment = &all.depth;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = static_cast<uint32_t>(all.descriptions.size());
    info.pAttachments = all.descriptions.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VkRenderPassMultiviewCreateInfo multiview{};
    multiview.sType = VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO;
    multiview.subpassCount = 1;
    multiview.pViewMasks = &scene.viewMask;
    if (scene.viewMask != 0) {
        if (context_.extensions().multiview.multiview == VK_FALSE) return unsupported("the device lacks multiview");
        info.pNext = &multiview;
    }
    if (all.depthResolve.attachment != VK_ATTACHMENT_UNUSED) {
        const Result<VkRenderPass> made =
            createResolvingRenderPass(info, scene.viewMask, scene.depthStencil, all.depthResolve.attachment);
        if (!made) return made.error();
        pass.renderPass = *made;
    } else {
        VERNIER_TRY_VK(vkCreateRenderPass(device, &info, nullptr, &pass.renderPass));
    }
    resources_.cleanup().add([device, handle = pass.renderPass] { vkDestroyRenderPass(device, handle, nullptr); });
    return {};
}

Status VulkanPassBuilder::createFramebuffer(const ScenePass& scene, const Attachments& all, VulkanPass& pass) {
    const VkDevice device = context_.device();
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pass.renderPass;
    info.attachmentCount = static_cast<uint32_t>(all.views.size());
    info.pAttachments = all.views.data();
    info.width = scene.extent.width;
    info.height = scene.extent.height;
    info.layers = scene.viewMask != 0    ? 1
                  : scene.colors.empty() ? scene.depthStencil.layerCount
                                         : scene.colors[0].layerCount;
    VERNIER_TRY_VK(vkCreateFramebuffer(device, &info, nullptr, &pass.framebuffer));
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
