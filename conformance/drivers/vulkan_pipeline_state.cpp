#include "conformance/drivers/vulkan_pipeline_state.h"

#include <algorithm>

namespace vernier::conformance {
namespace {

constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};

VkBool32 toVulkan(bool value) {
    return value ? VK_TRUE : VK_FALSE;
}

/// Puts `link` at the beginning of the chain of `state`.
template <class State, class Link>
void chain(State& state, Link& link) {
    link.pNext = state.pNext;
    state.pNext = &link;
}

}  // namespace

std::array<uint32_t, 5> stagesOf(const ScenePipeline& scene) {
    return {scene.vertexShader, scene.controlShader, scene.evaluationShader, scene.geometryShader,
            scene.fragmentShader};
}

bool saysDepthClip(const ScenePipeline& scene) {
    return scene.depthClip && *scene.depthClip == scene.depthClamp;
}

VulkanPipelineState::VulkanPipelineState(const ScenePipeline& scene, uint32_t viewports) : scene_(scene) {
    setVertices();
    setViewport(viewports);
    setRasterization();
    setLines();
    setSamples();
    setDepthStencil();
    setBlend();
    dynamic_.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic_.dynamicStateCount = kDynamic.size();
    dynamic_.pDynamicStates = kDynamic.data();
}

void VulkanPipelineState::setVertices() {
    vertexInput_.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    vertexInput_.vertexBindingDescriptionCount = static_cast<uint32_t>(scene_.vertexBindings.size());
    vertexInput_.pVertexBindingDescriptions = scene_.vertexBindings.data();
    vertexInput_.vertexAttributeDescriptionCount = static_cast<uint32_t>(scene_.vertexAttributes.size());
    vertexInput_.pVertexAttributeDescriptions = scene_.vertexAttributes.data();
    assembly_.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly_.topology = scene_.topology;
    assembly_.primitiveRestartEnable = toVulkan(scene_.primitiveRestart);
    tessellation_.sType = VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO;
    tessellation_.patchControlPoints = scene_.patchVertices;
    origin_.sType = VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO;
    origin_.domainOrigin = VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT;
    if (scene_.domainLowerLeft) chain(tessellation_, origin_);
}

void VulkanPipelineState::setViewport(uint32_t viewports) {
    viewport_.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport_.viewportCount = viewport_.scissorCount = viewports;
    clipControl_.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT;
    clipControl_.negativeOneToOne = VK_TRUE;
    if (scene_.depthNegativeOneToOne) chain(viewport_, clipControl_);
}

void VulkanPipelineState::setRasterization() {
    raster_.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster_.depthClampEnable = toVulkan(scene_.depthClamp);
    raster_.polygonMode = scene_.polygonMode;
    raster_.cullMode = scene_.cullMode;
    raster_.frontFace = scene_.frontFace;
    raster_.depthBiasEnable = toVulkan(scene_.depthBias);
    raster_.depthBiasConstantFactor = scene_.depthBiasConstant;
    raster_.depthBiasClamp = scene_.depthBiasClamp;
    raster_.depthBiasSlopeFactor = scene_.depthBiasSlope;
    raster_.lineWidth = scene_.lineWidth;
    depthClip_.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT;
    depthClip_.depthClipEnable = toVulkan(scene_.depthClip.value_or(false));
    if (saysDepthClip(scene_)) chain(raster_, depthClip_);
    provoking_.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT;
    provoking_.provokingVertexMode = VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
    if (scene_.provokingVertexLast) chain(raster_, provoking_);
}

void VulkanPipelineState::setLines() {
    lines_.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT;
    lines_.lineRasterizationMode = scene_.lineMode;
    lines_.stippledLineEnable = toVulkan(scene_.stippleFactor != 0);
    lines_.lineStippleFactor = std::max(1u, scene_.stippleFactor);
    lines_.lineStipplePattern = scene_.stipplePattern;
    if (scene_.lineMode != VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT || scene_.stippleFactor != 0) chain(raster_, lines_);
}

void VulkanPipelineState::setSamples() {
    multisample_.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample_.rasterizationSamples = scene_.samples;
    multisample_.pSampleMask = &scene_.sampleMask;
    multisample_.alphaToCoverageEnable = toVulkan(scene_.alphaToCoverage);
    multisample_.alphaToOneEnable = toVulkan(scene_.alphaToOne);
    multisample_.sampleShadingEnable = toVulkan(scene_.sampleShading);
    multisample_.minSampleShading = scene_.minSampleShading;
    for (const auto& [x, y] : scene_.sampleLocations) {
        locations_.push_back({static_cast<float>(x) / 16, static_cast<float>(y) / 16});
    }
    sampleLocations_.sType = VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT;
    sampleLocations_.sampleLocationsEnable = VK_TRUE;
    VkSampleLocationsInfoEXT& info = sampleLocations_.sampleLocationsInfo;
    info.sType = VK_STRUCTURE_TYPE_SAMPLE_LOCATIONS_INFO_EXT;
    info.sampleLocationsPerPixel = scene_.samples;
    info.sampleLocationGridSize = {1, 1};
    info.sampleLocationsCount = static_cast<uint32_t>(locations_.size());
    info.pSampleLocations = locations_.data();
    if (!locations_.empty()) chain(multisample_, sampleLocations_);
}

void VulkanPipelineState::setDepthStencil() {
    depth_.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth_.depthTestEnable = toVulkan(scene_.depthTest);
    depth_.depthWriteEnable = toVulkan(scene_.depthWrite);
    depth_.depthCompareOp = scene_.depthCompare;
    depth_.depthBoundsTestEnable = toVulkan(scene_.depthBoundsTest);
    depth_.minDepthBounds = scene_.minDepthBounds;
    depth_.maxDepthBounds = scene_.maxDepthBounds;
    depth_.stencilTestEnable = toVulkan(scene_.stencilTest);
    depth_.front = scene_.front;
    depth_.back = scene_.back;
}

void VulkanPipelineState::setBlend() {
    blend_.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend_.logicOpEnable = toVulkan(scene_.logicOpEnable);
    blend_.logicOp = scene_.logicOp;
    blend_.attachmentCount = static_cast<uint32_t>(scene_.blend.size());
    blend_.pAttachments = scene_.blend.data();
    std::copy(scene_.blendConstants.begin(), scene_.blendConstants.end(), blend_.blendConstants);
}

VkGraphicsPipelineCreateInfo VulkanPipelineState::info() const {
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pVertexInputState = &vertexInput_;
    info.pInputAssemblyState = &assembly_;
    if (scene_.controlShader != kNone) info.pTessellationState = &tessellation_;
    info.pViewportState = &viewport_;
    info.pRasterizationState = &raster_;
    info.pMultisampleState = &multisample_;
    info.pDepthStencilState = &depth_;
    info.pColorBlendState = &blend_;
    info.pDynamicState = &dynamic_;
    return info;
}

}  // namespace vernier::conformance
