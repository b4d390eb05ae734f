// What a pipeline of a scene asks of a device.
#include "conformance/drivers/vulkan_passes.h"
#include "conformance/drivers/vulkan_pipeline_state.h"

#include <algorithm>
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

Status need(bool wanted, VkBool32 feature, const char* name) {
    if (wanted && feature == VK_FALSE) return unsupported(std::string("the device lacks feature ") + name);
    return {};
}

Status checkFixedFunctions(const VulkanContext& context, const ScenePipeline& scene) {
    const VkPhysicalDeviceFeatures& features = context.features();
    const VulkanExtensions& extensions = context.extensions();
    VERNIER_TRY(need(scene.depthClamp, features.depthClamp, "depthClamp"));
    VERNIER_TRY(need(scene.depthBias && scene.depthBiasClamp != 0, features.depthBiasClamp, "depthBiasClamp"));
    VERNIER_TRY(need(scene.polygonMode != VK_POLYGON_MODE_FILL, features.fillModeNonSolid, "fillModeNonSolid"));
    VERNIER_TRY(need(scene.lineWidth != 1, features.wideLines, "wideLines"));
    VERNIER_TRY(need(scene.depthBoundsTest, features.depthBounds, "depthBounds"));
    VERNIER_TRY(need(scene.alphaToOne, features.alphaToOne, "alphaToOne"));
    VERNIER_TRY(need(scene.sampleShading, features.sampleRateShading, "sampleRateShading"));
    VERNIER_TRY(need(scene.provokingVertexLast, extensions.provokingVertex.provokingVertexLast, "provokingVertexLast"));
    VERNIER_TRY(need(scene.depthNegativeOneToOne, extensions.clipControl.depthClipControl, "depthClipControl"));
    VERNIER_TRY(need(!scene.sampleLocations.empty(), extensions.sampleLocations ? VK_TRUE : VK_FALSE,
                     "VK_EXT_sample_locations"));
    VERNIER_TRY(need(saysDepthClip(scene), extensions.depthClip.depthClipEnable, "depthClipEnable"));
    return need(scene.topology >= VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY &&
                    scene.topology <= VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY,
                features.geometryShader, "geometryShader");
}

Status checkLines(const VkPhysicalDeviceLineRasterizationFeaturesEXT& lines, const ScenePipeline& scene) {
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
    return needLines(VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT, VK_TRUE, lines.stippledRectangularLines,
                     "stippledRectangularLines");
}

Status checkOutput(const VkPhysicalDeviceFeatures& features, const ScenePipeline& scene) {
    VERNIER_TRY(need(scene.logicOpEnable, features.logicOp, "logicOp"));
    VERNIER_TRY(need(std::any_of(scene.blend.begin(), scene.blend.end(), readsSecondSource), features.dualSrcBlend,
                     "dualSrcBlend"));
    const auto differs = [&](const VkPipelineColorBlendAttachmentState& each) {
        return std::memcmp(&each, &scene.blend[0], sizeof each) != 0;
    };
    return need(std::any_of(scene.blend.begin(), scene.blend.end(), differs), features.independentBlend,
                "independentBlend");
}

/// What a shader's text names, and what it takes.
Status checkText(const VulkanContext& context, const ScenePipeline& scene, const std::string& glsl) {
    const VkPhysicalDeviceFeatures& features = context.features();
    const VulkanExtensions& extensions = context.extensions();
    const auto groups = [&](VkSubgroupFeatureFlagBits operations) -> VkBool32 {
        return (context.fragmentSubgroups() & operations) != 0 ? VK_TRUE : VK_FALSE;
    };
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
    for (const auto& use : uses) {
        // What geometry shaders choose comes with their feature, and so does what is read behind them.
        if (scene.geometryShader != kNone && use.feature == extensions.viewportIndexLayer) continue;
        VERNIER_TRY(need(glsl.find(use.text) != std::string::npos, use.feature, use.name));
    }
    return {};
}

}  // namespace

Status VulkanPassBuilder::checkStages(const ScenePipeline& scene) const {
    const VkPhysicalDeviceFeatures& features = context_.features();
    VERNIER_TRY(need(scene.geometryShader != kNone, features.geometryShader, "geometryShader"));
    VERNIER_TRY(need(scene.controlShader != kNone, features.tessellationShader, "tessellationShader"));
    const bool choosesOrigin = context_.extensions().maintenance2 || context_.apiVersion() >= VK_API_VERSION_1_1;
    VERNIER_TRY(need(scene.domainLowerLeft, choosesOrigin ? VK_TRUE : VK_FALSE, "VK_KHR_maintenance2"));
    for (const uint32_t shader : {scene.controlShader, scene.evaluationShader, scene.geometryShader}) {
        const bool sizes = shader != kNone && scene_.shaders[shader].glsl.find("gl_PointSize") != std::string::npos;
        VERNIER_TRY(
            need(sizes, features.shaderTessellationAndGeometryPointSize, "shaderTessellationAndGeometryPointSize"));
    }
    for (const uint32_t shader : stagesOf(scene)) {
        if (shader == kNone) continue;
        VERNIER_TRY(checkText(context_, scene, scene_.shaders[shader].glsl));
        // Version 1.0 of SPIR-V came with Vulkan 1.0, 1.3 with Vulkan 1.1.
        if (scene_.shaders[shader].spirv[1] > 0x10000 && context_.apiVersion() < VK_API_VERSION_1_1) {
            return unsupported("SPIR-V beyond version 1.0: the device has Vulkan 1.0");
        }
    }
    return {};
}

Status VulkanPassBuilder::checkFeatures(const ScenePipeline& scene, const SceneDraw& draw) const {
    VERNIER_TRY(checkFixedFunctions(context_, scene));
    VERNIER_TRY(need(!draw.moreViews.empty(), context_.features().multiViewport, "multiViewport"));
    VERNIER_TRY(checkStages(scene));
    VERNIER_TRY(checkLines(context_.extensions().lines, scene));
    return checkOutput(context_.features(), scene);
}

}  // namespace vernier::conformance
