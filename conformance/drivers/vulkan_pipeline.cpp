// The part of VulkanPassBuilder that makes pipelines.
#include "conformance/drivers/stopwatch.h"
#include "conformance/drivers/vulkan_passes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

namespace vernier::conformance {
namespace {

bool readsSecondSource(const VkPipelineColorBlendAttachmentState& state) {
    const auto second = [](VkBlendFactor factor) {
        return factor >= VK_BLEND_FACTOR_SRC1_COLOR && factor <= VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA;
    };
    return second(state.srcColorBlendFactor) || second(state.dstColorBlendFactor) ||
           second(state.srcAlphaBlendFactor) || second(state.dstAlphaBlendFactor);
}

/// The shaders of a pipeline, in the order of its stages; kNone where there is no such stage.
std::array<uint32_t, 5> stagesOf(const ScenePipeline& scene) {
    return {scene.vertexShader, scene.controlShader, scene.evaluationShader, scene.geometryShader,
            scene.fragmentShader};
}

bool saysLines(const ScenePipeline& scene) {
    return scene.lineMode != VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT || scene.stippleFactor != 0;
}

}  // namespace

Status VulkanPassBuilder::checkFeatures(const ScenePipeline& scene, const SceneDraw& draw) const {
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
    VERNIER_TRY(need(!draw.moreViews.empty(), features.multiViewport, "multiViewport"));
    VERNIER_TRY(need(std::any_of(scene.blend.begin(), scene.blend.end(), readsSecondSource), features.dualSrcBlend,
                     "dualSrcBlend"));
    const VulkanExtensions& extensions = context_.extensions();
    VERNIER_TRY(need(scene.provokingVertexLast, extensions.provokingVertex.provokingVertexLast, "provokingVertexLast"));
    VERNIER_TRY(need(scene.depthNegativeOneToOne, extensions.clipControl.depthClipControl, "depthClipControl"));
    VERNIER_TRY(need(!scene.sampleLocations.empty(), extensions.sampleLocations ? VK_TRUE : VK_FALSE,
                     "VK_EXT_sample_locations"));
    const bool saysDepthClip = scene.depthClip && *scene.depthClip == scene.depthClamp;
    VERNIER_TRY(need(saysDepthClip, extensions.depthClip.depthClipEnable, "depthClipEnable"));
    VERNIER_TRY(need(scene.topology >= VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY &&
                         scene.topology <= VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY,
                     features.geometryShader, "geometryShader"));
    const auto groups = [&](VkSubgroupFeatureFlagBits operations) -> VkBool32 {
        return (context_.fragmentSubgroups() & operations) != 0 ? VK_TRUE : VK_FALSE;
    };
    // What a shader's text names, and what it takes.
    const struct {
        const char* text;
        VkBool32 feature;
        const char* name;
    } uses[] = {
        {"gl_ViewportIndex", extensions.viewportIndexLayer, "VK_EXT_shader_viewport_index_layer"},
        {"gl_Layer", extensions.viewportIndexLayer, "VK_EXT_shader_viewport_index_layer"},
        {"gl_FragStencilRefARB", extensions.stencilExport, "VK_EXT_shader_stencil_export"},
        {"GL_EXT_fragment_shader_barycentric", extensions.barycentric.fragmentShaderBarycentric,
         "fragmentShaderBarycentric"},
        {"gl_PrimitiveID", features.geometryShader, "geometryShader"},
        {"GL_KHR_shader_subgroup_vote", groups(VK_SUBGROUP_FEATURE_VOTE_BIT), "subgroup votes"},
        {"GL_KHR_shader_subgroup_ballot", groups(VK_SUBGROUP_FEATURE_BALLOT_BIT), "subgroup ballots"},
        {"GL_KHR_shader_subgroup_arithmetic", groups(VK_SUBGROUP_FEATURE_ARITHMETIC_BIT), "subgroup arithmetic"},
        {"GL_KHR_shader_subgroup_quad", groups(VK_SUBGROUP_FEATURE_QUAD_BIT), "subgroup quads"},
        {"float16_t", extensions.float16.shaderFloat16, "shaderFloat16"},
        {"GL_EXT_shader_atomic_float ", extensions.floatAtomics.shaderBufferFloat32AtomicAdd,
         "shaderBufferFloat32AtomicAdd"},
        {"GL_EXT_shader_atomic_float2", extensions.floatAtomics2.shaderBufferFloat32AtomicMinMax,
         "shaderBufferFloat32AtomicMinMax"}};
    VERNIER_TRY(need(scene.geometryShader != kNone, features.geometryShader, "geometryShader"));
    VERNIER_TRY(need(scene.controlShader != kNone, features.tessellationShader, "tessellationShader"));
    const bool choosesOrigin = extensions.maintenance2 || context_.apiVersion() >= VK_API_VERSION_1_1;
    VERNIER_TRY(need(scene.domainLowerLeft, choosesOrigin ? VK_TRUE : VK_FALSE, "VK_KHR_maintenance2"));
    for (const uint32_t shader : {scene.controlShader, scene.evaluationShader, scene.geometryShader}) {
        const bool sizes = shader != kNone && scene_.shaders[shader].glsl.find("gl_PointSize") != std::string::npos;
        VERNIER_TRY(
            need(sizes, features.shaderTessellationAndGeometryPointSize, "shaderTessellationAndGeometryPointSize"));
    }
    for (const uint32_t shader : stagesOf(scene)) {
        if (shader == kNone) continue;
        for (const auto& use : uses) {
            // What geometry shaders choose comes with their feature, and so does what is read behind them.
            if (scene.geometryShader != kNone && use.feature == extensions.viewportIndexLayer) continue;
            VERNIER_TRY(need(scene_.shaders[shader].glsl.find(use.text) != std::string::npos, use.feature, use.name));
        }
        // Version 1.0 of SPIR-V came with Vulkan 1.0, 1.3 with Vulkan 1.1.
        if (scene_.shaders[shader].spirv[1] > 0x10000 && context_.apiVersion() < VK_API_VERSION_1_1) {
            return unsupported("SPIR-V beyond version 1.0: the device has Vulkan 1.0");
        }
    }
    const VkPhysicalDeviceLineRasterizationFeaturesEXT& lines = extensions.lines;
    const bool stippled = scene.stippleFactor != 0;
    const auto needLines = [&](VkLineRasterizationModeEXT mode, VkBool32 drawn, VkBool32 stipple, const char* name) {
        return scene.lineMode != mode ? Status{} : need(true, stippled ? drawn & stipple : drawn, name);
    };
    VERNIER_TRY(needLines(VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, lines.bresenhamLines, lines.stippledBresenhamLines,
                          "(stippled) bresenhamLines"));
    VERNIER_TRY(needLines(VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT, lines.rectangularLines,
                          lines.stippledRectangularLines, "(stippled) rectangularLines"));
    VERNIER_TRY(needLines(VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT, lines.smoothLines,
                          lines.stippledSmoothLines, "(stippled) smoothLines"));
    VERNIER_TRY(needLines(VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT, VK_TRUE, lines.stippledRectangularLines,
                          "stippledRectangularLines"));
    const auto differs = [&](const VkPipelineColorBlendAttachmentState& each) {
        return std::memcmp(&each, &scene.blend[0], sizeof each) != 0;
    };
    VERNIER_TRY(need(std::any_of(scene.blend.begin(), scene.blend.end(), differs), features.independentBlend,
                     "independentBlend"));
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
    VERNIER_TRY(checkFeatures(scene, draw));
    VulkanPipeline pipeline;
    VERNIER_TRY(createLayouts(draw, pipeline));

    std::vector<VkPipelineShaderStageCreateInfo> stages;
    std::array<VkSpecializationInfo, 5> specializations{};
    for (const uint32_t index : stagesOf(scene)) {
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
    VkPipelineTessellationDomainOriginStateCreateInfo origin{};
    origin.sType = VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO;
    origin.domainOrigin = VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT;
    VkPipelineTessellationStateCreateInfo tessellation{};
    tessellation.sType = VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO;
    tessellation.patchControlPoints = scene.patchVertices;
    if (scene.domainLowerLeft) tessellation.pNext = &origin;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = static_cast<uint32_t>(1 + draw.moreViews.size());
    VkPipelineViewportDepthClipControlCreateInfoEXT clipControl{};
    clipControl.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT;
    clipControl.negativeOneToOne = VK_TRUE;
    if (scene.depthNegativeOneToOne) viewport.pNext = &clipControl;
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
    VkPipelineRasterizationLineStateCreateInfoEXT lines{};
    lines.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT;
    lines.lineRasterizationMode = scene.lineMode;
    lines.stippledLineEnable = scene.stippleFactor != 0 ? VK_TRUE : VK_FALSE;
    lines.lineStippleFactor = std::max(1u, scene.stippleFactor);
    lines.lineStipplePattern = scene.stipplePattern;
    if (saysLines(scene)) {
        lines.pNext = raster.pNext;
        raster.pNext = &lines;
    }
    VkPipelineRasterizationDepthClipStateCreateInfoEXT depthClip{};
    depthClip.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT;
    depthClip.depthClipEnable = scene.depthClip.value_or(false) ? VK_TRUE : VK_FALSE;
    // Where it is the opposite of clamping it need not be said.
    if (scene.depthClip && *scene.depthClip == scene.depthClamp) {
        depthClip.pNext = raster.pNext;
        raster.pNext = &depthClip;
    }
    VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking{};
    provoking.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT;
    provoking.provokingVertexMode = VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
    if (scene.provokingVertexLast) {
        provoking.pNext = raster.pNext;
        raster.pNext = &provoking;
    }
    VkPipelineMultisampleStateCreateInfo multisample{};
    multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample.rasterizationSamples = scene.samples;
    multisample.pSampleMask = &scene.sampleMask;
    multisample.alphaToCoverageEnable = scene.alphaToCoverage ? VK_TRUE : VK_FALSE;
    multisample.alphaToOneEnable = scene.alphaToOne ? VK_TRUE : VK_FALSE;
    multisample.sampleShadingEnable = scene.sampleShading ? VK_TRUE : VK_FALSE;
    multisample.minSampleShading = scene.minSampleShading;
    std::vector<VkSampleLocationEXT> locations;
    for (const auto& [x, y] : scene.sampleLocations) {
        locations.push_back({static_cast<float>(x) / 16, static_cast<float>(y) / 16});
    }
    VkPipelineSampleLocationsStateCreateInfoEXT sampleLocations{};
    sampleLocations.sType = VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT;
    sampleLocations.sampleLocationsEnable = VK_TRUE;
    sampleLocations.sampleLocationsInfo.sType = VK_STRUCTURE_TYPE_SAMPLE_LOCATIONS_INFO_EXT;
    sampleLocations.sampleLocationsInfo.sampleLocationsPerPixel = scene.samples;
    sampleLocations.sampleLocationsInfo.sampleLocationGridSize = {1, 1};
    sampleLocations.sampleLocationsInfo.sampleLocationsCount = static_cast<uint32_t>(locations.size());
    sampleLocations.sampleLocationsInfo.pSampleLocations = locations.data();
    if (!locations.empty()) multisample.pNext = &sampleLocations;
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
    if (scene.controlShader != kNone) info.pTessellationState = &tessellation;
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

}  // namespace vernier::conformance
