// Tessellation through the driver: pictures, dynamic state, queries, limits.
#include <cmath>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{64, 64};

/// A patch of one vertex that becomes a square over the middle half of the picture, or what `levels` sets.
class TessellationTest : public DrawTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_EXTENDED_DYNAMIC_STATE_EXTENSION_NAME, VK_EXT_EXTENDED_DYNAMIC_STATE_2_EXTENSION_NAME,
                VK_EXT_EXTENDED_DYNAMIC_STATE_3_EXTENSION_NAME, VK_EXT_PRIMITIVE_TOPOLOGY_LIST_RESTART_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        one_.extendedDynamicState = two_.extendedDynamicState2 = two_.extendedDynamicState2PatchControlPoints = VK_TRUE;
        three_.extendedDynamicState3TessellationDomainOrigin = VK_TRUE;
        restart_.primitiveTopologyListRestart = restart_.primitiveTopologyPatchListRestart = VK_TRUE;
        multiview_.multiview = multiview_.multiviewTessellationShader = VK_TRUE;
        one_.pNext = &two_;
        two_.pNext = &three_;
        three_.pNext = &restart_;
        restart_.pNext = &multiview_;
        return &one_;
    }

    VkShaderModule vertex() {
        return makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) out float number;
void main() { gl_Position = vec4(gl_VertexIndex & 1, gl_VertexIndex >> 1 & 1, 0.5, 1); number = gl_VertexIndex; })");
    }
    VkShaderModule control(const std::string& body, uint32_t vertices = 1) {
        return makeShader(
            VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
            "#version 450\n#extension GL_EXT_multiview : enable\nlayout(vertices = " + std::to_string(vertices) +
                ") out;\nlayout(location = 0) in float number[];\nlayout(location = 0) patch out vec4 color;\n"
                "void main() {\ngl_TessLevelOuter = float[4](1, 1, 1, 1);\ngl_TessLevelInner = float[2](1, 1);\n"
                "color = vec4(0, 1, 0, 1);\n" +
                body + "\n}");
    }
    VkShaderModule evaluation(const std::string& modes = "quads, ccw",
                              const std::string& body = "gl_Position = vec4(gl_TessCoord.xy - 0.5, 0.5, 1);") {
        return makeShader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, "#version 450\nlayout(" + modes + R"() in;
layout(location = 0) patch in vec4 color;
layout(location = 0) out vec4 outColor;
void main() { outColor = color;
)" + body + "\n}");
    }
    VkShaderModule fragment() {
        return makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = color; })");
    }
    PipelineDesc plain(uint32_t patchControlPoints = 1) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = vertex();
        desc.control = control("");
        desc.evaluation = evaluation();
        desc.fragment = fragment();
        desc.patchControlPoints = patchControlPoints;
        desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST; };
        return desc;
    }
    /// The pixels that are green.
    uint32_t drawn(const PipelineDesc& desc, uint32_t vertices,
                   const std::function<void(VkCommandBuffer)>& record = {}) {
        const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent,
                                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        const Pass pass = makePass(color);
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        if (record) {
            record(commands);
        } else {
            vkCmdDraw(commands, vertices, 1, 0, 0);
        }
        vkCmdEndRenderPass(commands);
        submit(commands);
        texels_ = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        uint32_t count = 0;
        for (size_t n = 1; n < texels_.size(); n += 4) count += texels_[n] == 255 ? 1 : 0;
        return count;
    }

    std::vector<uint8_t> texels_;

  private:
    VkPhysicalDeviceExtendedDynamicStateFeaturesEXT one_ = make<VkPhysicalDeviceExtendedDynamicStateFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_FEATURES_EXT);
    VkPhysicalDeviceExtendedDynamicState2FeaturesEXT two_ = make<VkPhysicalDeviceExtendedDynamicState2FeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_2_FEATURES_EXT);
    VkPhysicalDeviceExtendedDynamicState3FeaturesEXT three_ = make<VkPhysicalDeviceExtendedDynamicState3FeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_3_FEATURES_EXT);
    VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT restart_ =
        make<VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PRIMITIVE_TOPOLOGY_LIST_RESTART_FEATURES_EXT);
    VkPhysicalDeviceMultiviewFeatures multiview_ =
        make<VkPhysicalDeviceMultiviewFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES);
};

TEST_F(TessellationTest, aSquare) {
    EXPECT_EQ(drawn(plain(), 1), 32u * 32);
    EXPECT_EQ(drawn(plain(3), 2), 0u);  // no whole patch
    // Whatever the levels, the same square.
    PipelineDesc desc = plain();
    desc.control = control("gl_TessLevelOuter = float[4](5, 2.5, 1, 64); gl_TessLevelInner = float[2](7, 3);");
    for (const char* spacing : {"equal_spacing", "fractional_even_spacing", "fractional_odd_spacing"}) {
        desc.evaluation = evaluation(std::string("quads, ") + spacing);
        EXPECT_EQ(drawn(desc, 1), 32u * 32) << spacing;
    }
    // The discarded patch.
    desc.control = control("gl_TessLevelOuter[2] = 0;");
    EXPECT_EQ(drawn(desc, 1), 0u);
}

TEST_F(TessellationTest, windingByOrderAndOrigin) {
    for (const bool clockwise : {false, true}) {
        for (const bool lowerLeft : {false, true}) {
            PipelineDesc desc = plain();
            desc.evaluation = evaluation(clockwise ? "quads, cw" : "quads, ccw");
            desc.domainLowerLeft = lowerLeft;
            desc.change = [](const PipelineStates& states) {
                states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
                states.raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
                states.raster.cullMode = VK_CULL_MODE_BACK_BIT;
            };
            // u to the right and v downwards, as the picture: what is counter-clockwise in the domain's own picture is
            // so on the screen, unless that picture has v upwards.
            EXPECT_EQ(drawn(desc, 1), clockwise == lowerLeft ? 32u * 32 : 0u) << clockwise << lowerLeft;
            // And by command.
            desc.dynamic = {VK_DYNAMIC_STATE_TESSELLATION_DOMAIN_ORIGIN_EXT};
            desc.domainLowerLeft = !lowerLeft;
            const auto set = command<PFN_vkCmdSetTessellationDomainOriginEXT>("vkCmdSetTessellationDomainOriginEXT");
            EXPECT_EQ(drawn(desc, 1,
                            [&](VkCommandBuffer commands) {
                                set(commands, lowerLeft ? VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT
                                                        : VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT);
                                vkCmdDraw(commands, 1, 1, 0, 0);
                            }),
                      clockwise == lowerLeft ? 32u * 32 : 0u);
        }
    }
}

TEST_F(TessellationTest, patchControlPointsByCommand) {
    PipelineDesc desc = plain(1);
    desc.dynamic = {VK_DYNAMIC_STATE_PATCH_CONTROL_POINTS_EXT};
    // The square is as wide as there are vertices in the patch, and starts with the last one's number.
    desc.control = control("color = vec4(gl_PatchVerticesIn / 255.0, 1, number[gl_PatchVerticesIn - 1] / 255.0, 1);");
    const auto set = command<PFN_vkCmdSetPatchControlPointsEXT>("vkCmdSetPatchControlPointsEXT");
    for (const uint32_t points : {1u, 2u, 7u, 32u}) {
        EXPECT_EQ(drawn(desc, 0,
                        [&](VkCommandBuffer commands) {
                            set(commands, points);
                            vkCmdDraw(commands, 2 * points - 1, 1, 0, 0);
                        }),
                  32u * 32);
        const size_t middle = 4 * (32 * 64 + 32);
        EXPECT_EQ(texels_[middle], points);
        EXPECT_EQ(texels_[middle + 2], points - 1);
    }
}

TEST_F(TessellationTest, patchListsRestart) {
    PipelineDesc desc = plain(2);
    desc.change = [](const PipelineStates& states) {
        states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
        states.assembly.primitiveRestartEnable = VK_TRUE;
    };
    desc.control = control("color = vec4(number[0] / 255.0, 1, number[1] / 255.0, 1);");
    const TestBuffer indices = makeBuffer(12, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const uint16_t list[] = {3, 4, 9, 0xFFFF, 6, 7};
    std::memcpy(indices.data, list, sizeof list);
    drawn(desc, 0, [&](VkCommandBuffer commands) {
        vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
        vkCmdDrawIndexed(commands, 6, 1, 0, 0, 0);
    });
    const size_t middle = 4 * (32 * 64 + 32);
    EXPECT_EQ(texels_[middle], 6);
    EXPECT_EQ(texels_[middle + 2], 7);
}

TEST_F(TessellationTest, pointsOfTheirOwnSize) {
    PipelineDesc desc = plain();
    desc.evaluation = evaluation("quads, point_mode", R"(gl_Position = vec4(gl_TessCoord.xy - 0.5 + 1.0 / 64, 0.5, 1);
gl_PointSize = 3;)");
    EXPECT_EQ(drawn(desc, 1), 4u * 9);
}

TEST_F(TessellationTest, viewsInBothStages) {
    const TestImage color =
        makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent,
                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_SAMPLE_COUNT_1_BIT, 3);
    const Pass pass = makePass(color, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, 3, 0b110);
    PipelineDesc desc = plain();
    desc.evaluation = makeShader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, R"(#version 450
#extension GL_EXT_multiview : require
layout(quads) in;
layout(location = 0) out vec4 outColor;
void main() { outColor = vec4(0, gl_ViewIndex / 255.0, 0, 1); gl_Position = vec4(gl_TessCoord.xy - 0.5, 0.5, 1); })");
    desc.control = control("gl_TessLevelOuter[0] = gl_ViewIndex;");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 1, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    for (const uint32_t layer : {1u, 2u})
        EXPECT_EQ(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4, layer)[4 * (32 * 64 + 32) + 1], layer);
}

TEST_F(TessellationTest, statistics) {
    const VkQueryPool queries =
        makeQueries(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1,
                    VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_CONTROL_SHADER_PATCHES_BIT |
                        VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_EVALUATION_SHADER_INVOCATIONS_BIT |
                        VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT);
    PipelineDesc desc = plain(3);
    desc.control = control("gl_TessLevelOuter = float[4](2, 3, 4, 5); gl_TessLevelInner = float[2](4, 6);");
    const VkCommandBuffer reset = begin();
    vkCmdResetQueryPool(reset, queries, 0, 1);
    submit(reset);
    drawn(desc, 0, [&](VkCommandBuffer commands) {
        vkCmdBeginQuery(commands, queries, 0, 0);
        vkCmdDraw(commands, 7, 3, 0, 0);
        vkCmdEndQuery(commands, queries, 0);
    });
    uint64_t values[3]{};
    ASSERT_EQ(vkGetQueryPoolResults(device, queries, 0, 1, sizeof values, values, sizeof values,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              VK_SUCCESS);
    const uint64_t points = 2 + 3 + 4 + 5 + 3 * 5, triangles = 2 * points - (2 + 3 + 4 + 5) - 2;
    EXPECT_EQ(values[0], 6 * triangles);
    EXPECT_EQ(values[1], 6u);
    EXPECT_EQ(values[2], 6 * points);
}

TEST_F(TessellationTest, limits) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physicalDevice, &properties);
    const VkPhysicalDeviceLimits& limits = properties.limits;
    EXPECT_GE(limits.maxTessellationGenerationLevel, 64u);
    EXPECT_GE(limits.maxTessellationPatchSize, 32u);
    EXPECT_GE(limits.maxTessellationControlPerVertexInputComponents, 64u);
    EXPECT_GE(limits.maxTessellationControlPerVertexOutputComponents, 64u);
    EXPECT_GE(limits.maxTessellationControlPerPatchOutputComponents, 120u);
    EXPECT_GE(limits.maxTessellationControlTotalOutputComponents, 2048u);
    EXPECT_GE(limits.maxTessellationEvaluationInputComponents, 64u);
    EXPECT_GE(limits.maxTessellationEvaluationOutputComponents, 64u);
    VERNIER_SKIP_WHEN_VALIDATED();  // the layer counts outputs of the patch among those of vertices
    // All of them at once: 32 vertices with 128 components, and 120 of the patch.
    PipelineDesc desc = plain(32);
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) out vec4 values[31];
void main() { gl_Position = vec4(gl_VertexIndex); for (int n = 0; n < 31; ++n) values[n] = vec4(gl_VertexIndex, n, 1, 2); })");
    desc.control = makeShader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(#version 450
layout(vertices = 32) out;
layout(location = 0) in vec4 values[][31];
layout(location = 0) out vec4 made[][31];
layout(location = 31) patch out vec4 whole[30];
void main() {
    for (int n = 0; n < 31; ++n) made[gl_InvocationID][n] = values[31 - gl_InvocationID][n];
    whole[gl_InvocationID % 30] = vec4(gl_InvocationID % 30);
    gl_TessLevelOuter = float[4](64, 64, 64, 64);
    gl_TessLevelInner = float[2](64, 64);
})");
    desc.evaluation = makeShader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, R"(#version 450
layout(quads) in;
layout(location = 0) in vec4 made[][31];
layout(location = 31) patch in vec4 whole[30];
layout(location = 0) out vec4 outColor;
void main() {
    bool right = true;
    for (int v = 0; v < 32; ++v)
        for (int n = 0; n < 31; ++n) right = right && made[v][n] == vec4(31 - v, n, 1, 2);
    for (int n = 0; n < 30; ++n) right = right && whole[n] == vec4(n);
    outColor = right ? vec4(0, 1, 0, 1) : vec4(1, 0, 0, 1);
    gl_Position = vec4(gl_TessCoord.xy - 0.5, 0.5, 1);
})");
    EXPECT_EQ(drawn(desc, 32), 32u * 32);
}

}  // namespace
}  // namespace vernier::test
