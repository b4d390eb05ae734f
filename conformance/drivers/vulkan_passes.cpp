#include "conformance/drivers/vulkan_passes.h"

#include "conformance/drivers/stopwatch.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <tuple>

namespace vernier::conformance {
namespace {

constexpr VkShaderStageFlags kBothStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

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

/// Draws that share a pipeline: same state, same bindings.
using PipelineKey = std::tuple<uint32_t, std::vector<std::tuple<uint32_t, uint32_t, VkDescriptorType>>>;

PipelineKey pipelineKey(const SceneDraw& draw) {
    PipelineKey key{draw.pipeline, {}};
    for (const SceneBinding& each : draw.bindings) std::get<1>(key).emplace_back(each.set, each.binding, each.type);
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
    const auto attach = [&](const SceneAttachment& attachment, uint32_t image, VkAttachmentLoadOp loadOp,
                            VkImageLayout layout) -> Result<VkAttachmentReference> {
        const bool resolve = image == attachment.resolveImage;
        const Result<VkImageView> view =
            resources_.attachmentView(image, resolve ? 0 : attachment.mipLevel, resolve ? 0 : attachment.layer);
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
    VERNIER_TRY_VK(vkCreateRenderPass(device, &info, nullptr, &pass.renderPass));
    resources_.cleanup().add([device, handle = pass.renderPass] { vkDestroyRenderPass(device, handle, nullptr); });
    VkFramebufferCreateInfo framebuffer{};
    framebuffer.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    framebuffer.renderPass = pass.renderPass;
    framebuffer.attachmentCount = static_cast<uint32_t>(views.size());
    framebuffer.pAttachments = views.data();
    framebuffer.width = scenePass.extent.width;
    framebuffer.height = scenePass.extent.height;
    framebuffer.layers = 1;
    VERNIER_TRY_VK(vkCreateFramebuffer(device, &framebuffer, nullptr, &pass.framebuffer));
    resources_.cleanup().add([device, handle = pass.framebuffer] { vkDestroyFramebuffer(device, handle, nullptr); });
    return {};
}

Status VulkanPassBuilder::checkFeatures(const ScenePipeline& scene) const {
    const VkPhysicalDeviceFeatures& features = context_.features();
    const auto need = [](bool wanted, VkBool32 feature, const char* name) -> Status {
        if (wanted && feature == VK_FALSE) return unsupported(std::string("the device lacks feature ") + name);
        return {};
    };
    VERNIER_TRY(need(scene.depthClamp, features.depthClamp, "depthClamp"));
    VERNIER_TRY(need(scene.depthBias && scene.depthBiasClamp != 0, features.depthBiasClamp, "depthBiasClamp"));
    VERNIER_TRY(need(scene.polygonMode != VK_POLYGON_MODE_FILL, features.fillModeNonSolid, "fillModeNonSolid"));
    VERNIER_TRY(need(scene.lineWidth != 1, features.wideLines, "wideLines"));
    VERNIER_TRY(need(scene.depthBoundsTest, features.depthBounds, "depthBounds"));
    VERNIER_TRY(need(scene.logicOpEnable, features.logicOp, "logicOp"));
    VERNIER_TRY(need(scene.alphaToOne, features.alphaToOne, "alphaToOne"));
    VERNIER_TRY(need(scene.sampleShading, features.sampleRateShading, "sampleRateShading"));
    const auto differs = [&](const VkPipelineColorBlendAttachmentState& each) {
        return std::memcmp(&each, &scene.blend[0], sizeof each) != 0;
    };
    VERNIER_TRY(need(std::any_of(scene.blend.begin(), scene.blend.end(), differs), features.independentBlend,
                     "independentBlend"));
    return {};
}

Status VulkanPassBuilder::createLayouts(const SceneDraw& draw, VulkanPipeline& pipeline) {
    const VkDevice device = context_.device();
    uint32_t setCount = 0;
    for (const SceneBinding& each : draw.bindings) setCount = std::max(setCount, each.set + 1);
    for (uint32_t set = 0; set < setCount; ++set) {
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (const SceneBinding& each : draw.bindings) {
            if (each.set == set) bindings.push_back({each.binding, each.type, 1, kBothStages, nullptr});
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
    const VkPushConstantRange range{kBothStages, 0, scene_.pipelines[draw.pipeline].pushConstantBytes};
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

Result<VkShaderModule> VulkanPassBuilder::shaderModule(uint32_t index) {
    if (modules_[index] != VK_NULL_HANDLE) return modules_[index];
    const VkDevice device = context_.device();
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = scene_.shaders[index].spirv.size() * sizeof(uint32_t);
    info.pCode = scene_.shaders[index].spirv.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    const Stopwatch watch;
    VERNIER_TRY_VK(vkCreateShaderModule(device, &info, nullptr, &shader));
    moduleTime_ += watch.milliseconds();
    resources_.cleanup().add([device, shader] { vkDestroyShaderModule(device, shader, nullptr); });
    modules_[index] = shader;
    return shader;
}

Result<VulkanPipeline> VulkanPassBuilder::createPipeline(const SceneDraw& draw, VkRenderPass renderPass) {
    const VkDevice device = context_.device();
    const ScenePipeline& scene = scene_.pipelines[draw.pipeline];
    VERNIER_TRY(checkFeatures(scene));
    VulkanPipeline pipeline;
    VERNIER_TRY(createLayouts(draw, pipeline));

    std::vector<VkPipelineShaderStageCreateInfo> stages;
    std::array<VkSpecializationInfo, 2> specializations{};
    for (const uint32_t index : {scene.vertexShader, scene.fragmentShader}) {
        if (index == kNone) continue;
        const Result<VkShaderModule> shader = shaderModule(index);
        if (!shader) return shader.error();
        const SceneShader& source = scene_.shaders[index];
        VkSpecializationInfo& specialization = specializations[stages.size()];
        specialization = {static_cast<uint32_t>(source.specialization.size()), source.specialization.data(),
                          source.specializationData.size(), source.specializationData.data()};
        VkPipelineShaderStageCreateInfo stage{};
        stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stage.stage = source.stage;
        stage.module = *shader;
        stage.pName = "main";
        stage.pSpecializationInfo = source.specialization.empty() ? nullptr : &specialization;
        stages.push_back(stage);
    }
    VkPipelineVertexInputStateCreateInfo vertexInput{};
    vertexInput.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    vertexInput.vertexBindingDescriptionCount = static_cast<uint32_t>(scene.vertexBindings.size());
    vertexInput.pVertexBindingDescriptions = scene.vertexBindings.data();
    vertexInput.vertexAttributeDescriptionCount = static_cast<uint32_t>(scene.vertexAttributes.size());
    vertexInput.pVertexAttributeDescriptions = scene.vertexAttributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = scene.topology;
    assembly.primitiveRestartEnable = scene.primitiveRestart ? VK_TRUE : VK_FALSE;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.depthClampEnable = scene.depthClamp ? VK_TRUE : VK_FALSE;
    raster.polygonMode = scene.polygonMode;
    raster.cullMode = scene.cullMode;
    raster.frontFace = scene.frontFace;
    raster.depthBiasEnable = scene.depthBias ? VK_TRUE : VK_FALSE;
    raster.depthBiasConstantFactor = scene.depthBiasConstant;
    raster.depthBiasClamp = scene.depthBiasClamp;
    raster.depthBiasSlopeFactor = scene.depthBiasSlope;
    raster.lineWidth = scene.lineWidth;
    VkPipelineMultisampleStateCreateInfo multisample{};
    multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample.rasterizationSamples = scene.samples;
    multisample.pSampleMask = &scene.sampleMask;
    multisample.alphaToCoverageEnable = scene.alphaToCoverage ? VK_TRUE : VK_FALSE;
    multisample.alphaToOneEnable = scene.alphaToOne ? VK_TRUE : VK_FALSE;
    multisample.sampleShadingEnable = scene.sampleShading ? VK_TRUE : VK_FALSE;
    multisample.minSampleShading = scene.minSampleShading;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = scene.depthTest ? VK_TRUE : VK_FALSE;
    depth.depthWriteEnable = scene.depthWrite ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = scene.depthCompare;
    depth.depthBoundsTestEnable = scene.depthBoundsTest ? VK_TRUE : VK_FALSE;
    depth.minDepthBounds = scene.minDepthBounds;
    depth.maxDepthBounds = scene.maxDepthBounds;
    depth.stencilTestEnable = scene.stencilTest ? VK_TRUE : VK_FALSE;
    depth.front = scene.front;
    depth.back = scene.back;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.logicOpEnable = scene.logicOpEnable ? VK_TRUE : VK_FALSE;
    blend.logicOp = scene.logicOp;
    blend.attachmentCount = static_cast<uint32_t>(scene.blend.size());
    blend.pAttachments = scene.blend.data();
    std::copy(scene.blendConstants.begin(), scene.blendConstants.end(), blend.blendConstants);
    constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = kDynamic.size();
    dynamic.pDynamicStates = kDynamic.data();

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.stageCount = static_cast<uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &vertexInput;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = pipeline.layout;
    info.renderPass = renderPass;
    VERNIER_TRY_VK(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle));
    resources_.cleanup().add([device, handle = pipeline.handle] { vkDestroyPipeline(device, handle, nullptr); });
    return pipeline;
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
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = sets[each.set];
        write.dstBinding = each.binding;
        write.descriptorCount = 1;
        write.descriptorType = each.type;
        if (each.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) {
            const bool color = (scene_.images[each.image].usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) == 0;
            image = {
                resources_.sampler(each.sampler), resources_.sampledView(each.image),
                color ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
            write.pImageInfo = &image;
        } else {
            buffer = {resources_.buffer(each.buffer), each.offset, each.range};
            write.pBufferInfo = &buffer;
        }
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    return sets;
}

}  // namespace vernier::conformance
