// Extended dynamic state: a pipeline that takes a state from a command draws what a pipeline made with that state does.
#include <array>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{64, 64};
constexpr VkSampleCountFlagBits kSamples = VK_SAMPLE_COUNT_4_BIT;
using Texels = std::vector<uint8_t>;

class DynamicStateTest : public DrawTest {
  protected:
    using Change = std::function<void(const PipelineStates&)>;
    using Set = std::function<void(VkCommandBuffer)>;

    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_EXTENDED_DYNAMIC_STATE_EXTENSION_NAME,   VK_EXT_EXTENDED_DYNAMIC_STATE_2_EXTENSION_NAME,
                VK_EXT_EXTENDED_DYNAMIC_STATE_3_EXTENSION_NAME, VK_EXT_VERTEX_INPUT_DYNAMIC_STATE_EXTENSION_NAME,
                VK_EXT_PROVOKING_VERTEX_EXTENSION_NAME,         VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME,
                VK_EXT_DEPTH_CLIP_ENABLE_EXTENSION_NAME,        VK_EXT_DEPTH_CLIP_CONTROL_EXTENSION_NAME,
                VK_EXT_SAMPLE_LOCATIONS_EXTENSION_NAME,         VK_EXT_VERTEX_ATTRIBUTE_DIVISOR_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        one_.extendedDynamicState = two_.extendedDynamicState2 = two_.extendedDynamicState2LogicOp = VK_TRUE;
        three_.pNext = nullptr;
        auto query = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &three_);
        const auto ask = reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2KHR>(
            vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceFeatures2KHR"));
        ask(physicalDevice, &query);
        input_.vertexInputDynamicState = provoking_.provokingVertexLast = clip_.depthClipEnable = VK_TRUE;
        control_.depthClipControl = lines_.rectangularLines = lines_.bresenhamLines = VK_TRUE;
        lines_.smoothLines = lines_.stippledSmoothLines = lines_.stippledRectangularLines = VK_TRUE;
        divisors_.vertexAttributeInstanceRateDivisor = VK_TRUE;
        one_.pNext = &two_;
        two_.pNext = &three_;
        three_.pNext = &input_;
        input_.pNext = &provoking_;
        provoking_.pNext = &clip_;
        clip_.pNext = &control_;
        control_.pNext = &lines_;
        lines_.pNext = &divisors_;
        return &one_;
    }
    void SetUp() override {
        DrawTest::SetUp();
        samples = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, kSamples);
        auto depthInfo = flatImage(VK_FORMAT_D32_SFLOAT_S8_UINT, kExtent,
                                   VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        depthInfo.flags = VK_IMAGE_CREATE_SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_BIT_EXT;
        depthInfo.samples = kSamples;
        depth = makeImage(depthInfo);
        depth.view = makeView(depth.image, VK_IMAGE_VIEW_TYPE_2D, depth.format,
                              {VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT, 0, 1, 0, 1});
        color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        pass = makePass(samples, &depth, &color, kSamples);
        indices = makeBuffer(64, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
        const std::array<uint16_t, 13> values{0, 1, 2, 3, 4, 5, 0xFFFF, 6, 7, 8, 9, 10, 11};
        std::memcpy(indices.data, values.data(), sizeof values);
        places = makeBuffer(256, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
        for (uint32_t i = 0; i < 64; ++i) static_cast<float*>(places.data)[i] = 0.25f * static_cast<float>(i % 7);
        // The left half nearer, with another stencil.
        ground_ = {groundOf("0.3", 1, {{0, 0}, {32, 64}}), groundOf("0.7", 2, {{32, 0}, {32, 64}})};
        scene_.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) in float shift;
layout(location = 0) flat out vec4 code;
void main() {
    // Triangles all over the picture, of both windings, at depths from before the near plane to behind the far one.
    int n = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
    vec2 p = vec2(n % 2, n / 2) * vec2(0.9, 0.8) - 0.95 + vec2(corner == 1 ? 1.0 : 0.0, corner == 2 ? 0.9 : 0.0);
    if (n == 2) p = p.yx;
    gl_Position = vec4(p.x, p.y + shift * 0.1, float(n % 3) * 0.4 - 0.1 + 0.1 * float(corner), 1);
    gl_PointSize = 3;
    code = vec4(corner == 0 ? 1 : 0.5, 0.25 * n, corner == 2 ? 1 : 0, 0.4);
})");
        scene_.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) flat in vec4 code;
layout(location = 0) out vec4 color;
void main() { color = code * (gl_FrontFacing ? 1.0 : 0.7); })");
        scene_.extent = kExtent;
        scene_.samples = kSamples;
        scene_.depthTest = true;
        scene_.bindings = {{0, 4, VK_VERTEX_INPUT_RATE_VERTEX}};
        scene_.attributes = {{0, 0, VK_FORMAT_R32_SFLOAT, 0}};
    }
    /// The scene's pipeline with a change to it and some states dynamic.
    VkPipeline pipelineWith(const Change& common, const Change& change, const std::vector<VkDynamicState>& dynamic) {
        PipelineDesc desc = scene_;
        desc.dynamic = dynamic;
        desc.change = [&](const PipelineStates& states) {
            states.depth.front.compareMask = states.depth.back.compareMask = 0xFF;
            states.depth.front.writeMask = states.depth.back.writeMask = 0xFF;
            states.depth.front.reference = states.depth.back.reference = 1;
            states.depth.front.compareOp = states.depth.back.compareOp = VK_COMPARE_OP_EQUAL;
            states.depth.minDepthBounds = 0.2f;
            states.depth.maxDepthBounds = 0.5f;
            states.raster.depthBiasConstantFactor = 8e6f;
            states.blends[0].srcColorBlendFactor = states.blends[0].dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
            states.blends[0].srcAlphaBlendFactor = states.blends[0].dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
            states.colors.logicOp = VK_LOGIC_OP_XOR;
            if (common) common(states);
            if (change) change(states);
        };
        return makePipeline(pass.pass, desc);
    }
    Texels render(VkPipeline pipeline, const Set& set) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        const VkDeviceSize zero = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &places.buffer, &zero);
        vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
        for (const VkPipeline each : ground_) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, each);
            vkCmdDraw(commands, 3, 1, 0, 0);
        }
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        if (set) set(commands);
        vkCmdDrawIndexed(commands, 13, 1, 0, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    }
    /// `change` is what `set` does; `common` changes both pipelines. Without either the picture must be another one.
    void expectSame(const char* name, const std::vector<VkDynamicState>& dynamic, const Change& change, const Set& set,
                    const Change& common = {}) {
        SCOPED_TRACE(name);
        const Texels plain = render(pipelineWith(common, {}, {}), {});
        const Texels fixed = render(pipelineWith(common, change, {}), {});
        const Texels dynamicState = render(pipelineWith(common, {}, dynamic), set);
        EXPECT_NE(plain, fixed) << "the state makes no difference";
        EXPECT_EQ(dynamicState, fixed);
    }
    template <class Function, class... Values>
    Set call(const char* name, Values... values) {
        const auto function = command<Function>(name);
        EXPECT_NE(function, nullptr) << name;
        return [=](VkCommandBuffer commands) { function(commands, values...); };
    }

    TestImage samples, depth, color;
    TestBuffer indices, places;
    Pass pass;

  private:
    VkPipeline groundOf(const std::string& z, uint32_t stencil, const VkRect2D& scissor) {
        PipelineDesc desc;
        desc.vertex = fullScreen(z);
        desc.fragment = constantColor("0.2, 0.3, 0.4, 0.5");
        desc.extent = kExtent;
        desc.samples = kSamples;
        desc.depthTest = true;
        desc.change = [&](const PipelineStates& states) {
            states.viewport.pScissors = &scissor;
            states.depth.stencilTestEnable = VK_TRUE;
            states.depth.front = states.depth.back = {VK_STENCIL_OP_REPLACE,
                                                      VK_STENCIL_OP_REPLACE,
                                                      VK_STENCIL_OP_REPLACE,
                                                      VK_COMPARE_OP_ALWAYS,
                                                      0xFF,
                                                      0xFF,
                                                      stencil};
        };
        return makePipeline(pass.pass, desc);
    }

    std::array<VkPipeline, 2> ground_{};
    PipelineDesc scene_;
    VkPhysicalDeviceExtendedDynamicStateFeaturesEXT one_ = make<VkPhysicalDeviceExtendedDynamicStateFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_FEATURES_EXT);
    VkPhysicalDeviceExtendedDynamicState2FeaturesEXT two_ = make<VkPhysicalDeviceExtendedDynamicState2FeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_2_FEATURES_EXT);
    VkPhysicalDeviceExtendedDynamicState3FeaturesEXT three_ = make<VkPhysicalDeviceExtendedDynamicState3FeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_3_FEATURES_EXT);
    VkPhysicalDeviceVertexInputDynamicStateFeaturesEXT input_ =
        make<VkPhysicalDeviceVertexInputDynamicStateFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VERTEX_INPUT_DYNAMIC_STATE_FEATURES_EXT);
    VkPhysicalDeviceProvokingVertexFeaturesEXT provoking_ = make<VkPhysicalDeviceProvokingVertexFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT);
    VkPhysicalDeviceDepthClipEnableFeaturesEXT clip_ = make<VkPhysicalDeviceDepthClipEnableFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_ENABLE_FEATURES_EXT);
    VkPhysicalDeviceDepthClipControlFeaturesEXT control_ = make<VkPhysicalDeviceDepthClipControlFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_CONTROL_FEATURES_EXT);
    VkPhysicalDeviceLineRasterizationFeaturesEXT lines_ = make<VkPhysicalDeviceLineRasterizationFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_LINE_RASTERIZATION_FEATURES_EXT);
    VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT divisors_ =
        make<VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VERTEX_ATTRIBUTE_DIVISOR_FEATURES_EXT);
};

TEST_F(DynamicStateTest, rasterization) {
    using S = const PipelineStates&;
    expectSame(
        "cull mode", {VK_DYNAMIC_STATE_CULL_MODE}, [](S s) { s.raster.cullMode = VK_CULL_MODE_BACK_BIT; },
        call<PFN_vkCmdSetCullModeEXT>("vkCmdSetCullModeEXT", VK_CULL_MODE_BACK_BIT));
    expectSame(
        "front face", {VK_DYNAMIC_STATE_FRONT_FACE}, [](S s) { s.raster.frontFace = VK_FRONT_FACE_CLOCKWISE; },
        call<PFN_vkCmdSetFrontFaceEXT>("vkCmdSetFrontFaceEXT", VK_FRONT_FACE_CLOCKWISE));
    for (const VkPrimitiveTopology topology :
         {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_POINT_LIST}) {
        expectSame(
            "topology", {VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY}, [=](S s) { s.assembly.topology = topology; },
            call<PFN_vkCmdSetPrimitiveTopologyEXT>("vkCmdSetPrimitiveTopologyEXT", topology));
    }
    expectSame(
        "restart", {VK_DYNAMIC_STATE_PRIMITIVE_RESTART_ENABLE},
        [](S s) { s.assembly.primitiveRestartEnable = VK_TRUE; },
        call<PFN_vkCmdSetPrimitiveRestartEnableEXT>("vkCmdSetPrimitiveRestartEnableEXT", VK_TRUE),
        [](S s) { s.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP; });
    expectSame(
        "discard", {VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE},
        [](S s) { s.raster.rasterizerDiscardEnable = VK_TRUE; },
        call<PFN_vkCmdSetRasterizerDiscardEnableEXT>("vkCmdSetRasterizerDiscardEnableEXT", VK_TRUE));
    expectSame(
        "bias", {VK_DYNAMIC_STATE_DEPTH_BIAS_ENABLE}, [](S s) { s.raster.depthBiasEnable = VK_TRUE; },
        call<PFN_vkCmdSetDepthBiasEnableEXT>("vkCmdSetDepthBiasEnableEXT", VK_TRUE));
    expectSame(
        "clamp", {VK_DYNAMIC_STATE_DEPTH_CLAMP_ENABLE_EXT}, [](S s) { s.raster.depthClampEnable = VK_TRUE; },
        call<PFN_vkCmdSetDepthClampEnableEXT>("vkCmdSetDepthClampEnableEXT", VK_TRUE));
    expectSame(
        "polygon mode", {VK_DYNAMIC_STATE_POLYGON_MODE_EXT}, [](S s) { s.raster.polygonMode = VK_POLYGON_MODE_LINE; },
        call<PFN_vkCmdSetPolygonModeEXT>("vkCmdSetPolygonModeEXT", VK_POLYGON_MODE_LINE));
    auto clip = make<VkPipelineRasterizationDepthClipStateCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT);
    auto clipping = clip;
    clipping.depthClipEnable = VK_TRUE;
    expectSame(
        "clip", {VK_DYNAMIC_STATE_DEPTH_CLIP_ENABLE_EXT}, [&](S s) { s.raster.pNext = &clip; },
        call<PFN_vkCmdSetDepthClipEnableEXT>("vkCmdSetDepthClipEnableEXT", VK_FALSE),
        [&](S s) { s.raster.pNext = &clipping; });
    auto last = make<VkPipelineRasterizationProvokingVertexStateCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT);
    last.provokingVertexMode = VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
    expectSame(
        "provoking vertex", {VK_DYNAMIC_STATE_PROVOKING_VERTEX_MODE_EXT}, [&](S s) { s.raster.pNext = &last; },
        call<PFN_vkCmdSetProvokingVertexModeEXT>("vkCmdSetProvokingVertexModeEXT",
                                                 VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT));
    auto control = make<VkPipelineViewportDepthClipControlCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT);
    control.negativeOneToOne = VK_TRUE;
    expectSame(
        "clip control", {VK_DYNAMIC_STATE_DEPTH_CLIP_NEGATIVE_ONE_TO_ONE_EXT},
        [&](S s) { s.viewport.pNext = &control; },
        call<PFN_vkCmdSetDepthClipNegativeOneToOneEXT>("vkCmdSetDepthClipNegativeOneToOneEXT", VK_TRUE));
}

TEST_F(DynamicStateTest, lines) {
    using S = const PipelineStates&;
    auto line = make<VkPipelineRasterizationLineStateCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT);
    line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
    line.lineStippleFactor = 2;
    line.lineStipplePattern = 0x5555;
    const auto common = [&](S s) {
        s.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        s.raster.pNext = &line;
    };
    auto bresenham = line;
    bresenham.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    expectSame(
        "line mode", {VK_DYNAMIC_STATE_LINE_RASTERIZATION_MODE_EXT}, [&](S s) { s.raster.pNext = &bresenham; },
        call<PFN_vkCmdSetLineRasterizationModeEXT>("vkCmdSetLineRasterizationModeEXT",
                                                   VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT),
        common);
    auto stippled = line;
    stippled.stippledLineEnable = VK_TRUE;
    expectSame(
        "stipple", {VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT}, [&](S s) { s.raster.pNext = &stippled; },
        call<PFN_vkCmdSetLineStippleEnableEXT>("vkCmdSetLineStippleEnableEXT", VK_TRUE), common);
    auto smooth = line, smoothStippled = stippled;
    smooth.lineRasterizationMode = smoothStippled.lineRasterizationMode =
        VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
    expectSame(
        "stipple of smooth lines", {VK_DYNAMIC_STATE_LINE_STIPPLE_ENABLE_EXT},
        [&](S s) { s.raster.pNext = &smoothStippled; },
        call<PFN_vkCmdSetLineStippleEnableEXT>("vkCmdSetLineStippleEnableEXT", VK_TRUE),
        [&](S s) {
            s.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
            s.raster.pNext = &smooth;
        });
}

TEST_F(DynamicStateTest, depthAndStencil) {
    using S = const PipelineStates&;
    expectSame(
        "depth test", {VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE}, [](S s) { s.depth.depthTestEnable = VK_FALSE; },
        call<PFN_vkCmdSetDepthTestEnableEXT>("vkCmdSetDepthTestEnableEXT", VK_FALSE));
    expectSame(
        "depth write", {VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE}, [](S s) { s.depth.depthWriteEnable = VK_FALSE; },
        call<PFN_vkCmdSetDepthWriteEnableEXT>("vkCmdSetDepthWriteEnableEXT", VK_FALSE));
    expectSame(
        "depth compare", {VK_DYNAMIC_STATE_DEPTH_COMPARE_OP},
        [](S s) { s.depth.depthCompareOp = VK_COMPARE_OP_GREATER; },
        call<PFN_vkCmdSetDepthCompareOpEXT>("vkCmdSetDepthCompareOpEXT", VK_COMPARE_OP_GREATER));
    expectSame(
        "depth bounds", {VK_DYNAMIC_STATE_DEPTH_BOUNDS_TEST_ENABLE},
        [](S s) { s.depth.depthBoundsTestEnable = VK_TRUE; },
        call<PFN_vkCmdSetDepthBoundsTestEnableEXT>("vkCmdSetDepthBoundsTestEnableEXT", VK_TRUE));
    expectSame(
        "stencil test", {VK_DYNAMIC_STATE_STENCIL_TEST_ENABLE}, [](S s) { s.depth.stencilTestEnable = VK_TRUE; },
        call<PFN_vkCmdSetStencilTestEnableEXT>("vkCmdSetStencilTestEnableEXT", VK_TRUE));
    expectSame(
        "stencil operations", {VK_DYNAMIC_STATE_STENCIL_OP},
        [](S s) {
            s.depth.front.compareOp = s.depth.back.compareOp = VK_COMPARE_OP_NOT_EQUAL;
            s.depth.front.passOp = s.depth.back.passOp = VK_STENCIL_OP_REPLACE;
        },
        call<PFN_vkCmdSetStencilOpEXT>("vkCmdSetStencilOpEXT", VK_STENCIL_FACE_FRONT_AND_BACK, VK_STENCIL_OP_KEEP,
                                       VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_NOT_EQUAL),
        [](S s) { s.depth.stencilTestEnable = VK_TRUE; });
}

TEST_F(DynamicStateTest, samples) {
    using S = const PipelineStates&;
    static constexpr VkSampleMask kTwo = 5;
    expectSame(
        "sample mask", {VK_DYNAMIC_STATE_SAMPLE_MASK_EXT}, [](S s) { s.multisample.pSampleMask = &kTwo; },
        call<PFN_vkCmdSetSampleMaskEXT>("vkCmdSetSampleMaskEXT", kSamples, &kTwo));
    expectSame(
        "alpha to coverage", {VK_DYNAMIC_STATE_ALPHA_TO_COVERAGE_ENABLE_EXT},
        [](S s) { s.multisample.alphaToCoverageEnable = VK_TRUE; },
        call<PFN_vkCmdSetAlphaToCoverageEnableEXT>("vkCmdSetAlphaToCoverageEnableEXT", VK_TRUE));
    expectSame(
        "alpha to one", {VK_DYNAMIC_STATE_ALPHA_TO_ONE_ENABLE_EXT},
        [](S s) { s.multisample.alphaToOneEnable = VK_TRUE; },
        call<PFN_vkCmdSetAlphaToOneEnableEXT>("vkCmdSetAlphaToOneEnableEXT", VK_TRUE));
    EXPECT_EQ(render(pipelineWith({}, {}, {VK_DYNAMIC_STATE_RASTERIZATION_SAMPLES_EXT}),
                     call<PFN_vkCmdSetRasterizationSamplesEXT>("vkCmdSetRasterizationSamplesEXT", kSamples)),
              render(pipelineWith({}, {}, {}), {}));
    std::array<VkSampleLocationEXT, 4> corner;
    corner.fill({0.0625f, 0.0625f});
    auto locations = make<VkPipelineSampleLocationsStateCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT);
    locations.sampleLocationsInfo = make<VkSampleLocationsInfoEXT>(VK_STRUCTURE_TYPE_SAMPLE_LOCATIONS_INFO_EXT);
    locations.sampleLocationsInfo.sampleLocationsPerPixel = kSamples;
    locations.sampleLocationsInfo.sampleLocationGridSize = {1, 1};
    locations.sampleLocationsInfo.sampleLocationsCount = 4;
    locations.sampleLocationsInfo.pSampleLocations = corner.data();
    auto enabled = locations;
    enabled.sampleLocationsEnable = VK_TRUE;
    const auto setLocations = command<PFN_vkCmdSetSampleLocationsEXT>("vkCmdSetSampleLocationsEXT");
    const auto enable = command<PFN_vkCmdSetSampleLocationsEnableEXT>("vkCmdSetSampleLocationsEnableEXT");
    expectSame(
        "sample locations", {VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_ENABLE_EXT, VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT},
        [&](S s) { s.multisample.pNext = &enabled; },
        [&](VkCommandBuffer commands) {
            enable(commands, VK_TRUE);
            setLocations(commands, &locations.sampleLocationsInfo);
        },
        [&](S s) { s.multisample.pNext = &locations; });
}

TEST_F(DynamicStateTest, sampleCountsFollowThePass) {
    if (validated()) GTEST_SKIP() << "the layer compares the count that is not used";
    const VkPipeline dynamic =
        pipelineWith({}, [](const PipelineStates& s) { s.multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT; },
                     {VK_DYNAMIC_STATE_RASTERIZATION_SAMPLES_EXT});
    EXPECT_EQ(render(dynamic, call<PFN_vkCmdSetRasterizationSamplesEXT>("vkCmdSetRasterizationSamplesEXT", kSamples)),
              render(pipelineWith({}, {}, {}), {}));
}

TEST_F(DynamicStateTest, blending) {
    using S = const PipelineStates&;
    static constexpr VkBool32 kTrue = VK_TRUE;
    expectSame(
        "logic", {VK_DYNAMIC_STATE_LOGIC_OP_ENABLE_EXT}, [](S s) { s.colors.logicOpEnable = VK_TRUE; },
        call<PFN_vkCmdSetLogicOpEnableEXT>("vkCmdSetLogicOpEnableEXT", VK_TRUE));
    expectSame(
        "logic operation", {VK_DYNAMIC_STATE_LOGIC_OP_EXT}, [](S s) { s.colors.logicOp = VK_LOGIC_OP_INVERT; },
        call<PFN_vkCmdSetLogicOpEXT>("vkCmdSetLogicOpEXT", VK_LOGIC_OP_INVERT),
        [](S s) { s.colors.logicOpEnable = VK_TRUE; });
    expectSame(
        "blend", {VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT}, [](S s) { s.blends[0].blendEnable = VK_TRUE; },
        call<PFN_vkCmdSetColorBlendEnableEXT>("vkCmdSetColorBlendEnableEXT", 0u, 1u, &kTrue));
    static constexpr VkColorBlendEquationEXT kEquation{VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_DST_COLOR,
                                                       VK_BLEND_OP_SUBTRACT,      VK_BLEND_FACTOR_ONE,
                                                       VK_BLEND_FACTOR_DST_ALPHA, VK_BLEND_OP_MAX};
    expectSame(
        "blend equation", {VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT},
        [](S s) {
            s.blends[0].srcColorBlendFactor = kEquation.srcColorBlendFactor;
            s.blends[0].dstColorBlendFactor = kEquation.dstColorBlendFactor;
            s.blends[0].colorBlendOp = kEquation.colorBlendOp;
            s.blends[0].srcAlphaBlendFactor = kEquation.srcAlphaBlendFactor;
            s.blends[0].dstAlphaBlendFactor = kEquation.dstAlphaBlendFactor;
            s.blends[0].alphaBlendOp = kEquation.alphaBlendOp;
        },
        call<PFN_vkCmdSetColorBlendEquationEXT>("vkCmdSetColorBlendEquationEXT", 0u, 1u, &kEquation),
        [](S s) { s.blends[0].blendEnable = VK_TRUE; });
    static constexpr VkColorComponentFlags kMask = VK_COLOR_COMPONENT_G_BIT;
    expectSame(
        "write mask", {VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT}, [](S s) { s.blends[0].colorWriteMask = kMask; },
        call<PFN_vkCmdSetColorWriteMaskEXT>("vkCmdSetColorWriteMaskEXT", 0u, 1u, &kMask));
    // A pipeline whose own mask would have left the fragment program nothing to do.
    static constexpr VkColorComponentFlags kAll = 0xF;
    expectSame(
        "write mask of a pipeline without colours", {VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT},
        [](S s) { s.blends[0].colorWriteMask = kAll; },
        call<PFN_vkCmdSetColorWriteMaskEXT>("vkCmdSetColorWriteMaskEXT", 0u, 1u, &kAll),
        [](S s) { s.blends[0].colorWriteMask = 0; });
}

TEST_F(DynamicStateTest, viewportsWithTheirCount) {
    using S = const PipelineStates&;
    const VkViewport part{8, 4, 40, 50, 0, 1};
    const VkRect2D scissor{{10, 10}, {30, 30}};
    const auto setViewports = command<PFN_vkCmdSetViewportWithCountEXT>("vkCmdSetViewportWithCountEXT");
    const auto setScissors = command<PFN_vkCmdSetScissorWithCountEXT>("vkCmdSetScissorWithCountEXT");
    const VkPipeline fixed = pipelineWith({},
                                          [&](S s) {
                                              s.viewport.pViewports = &part;
                                              s.viewport.pScissors = &scissor;
                                          },
                                          {});
    const VkPipeline dynamic =
        pipelineWith({}, [](S s) { s.viewport.viewportCount = s.viewport.scissorCount = 0; },
                     {VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT, VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT});
    EXPECT_EQ(render(dynamic,
                     [&](VkCommandBuffer commands) {
                         setViewports(commands, 1, &part);
                         setScissors(commands, 1, &scissor);
                     }),
              render(fixed, {}));
}

TEST_F(DynamicStateTest, vertexInput) {
    using S = const PipelineStates&;
    const auto bind = command<PFN_vkCmdBindVertexBuffers2EXT>("vkCmdBindVertexBuffers2EXT");
    const VkVertexInputBindingDescription wide{0, 12, VK_VERTEX_INPUT_RATE_VERTEX};
    const VkDeviceSize offset = 4, stride = 12, size = 100;
    const auto bindAt = [&](VkCommandBuffer commands) {
        vkCmdBindVertexBuffers(commands, 0, 1, &places.buffer, &offset);
    };
    const Texels fixed = render(pipelineWith({}, [&](S s) { s.input.pVertexBindingDescriptions = &wide; }, {}), bindAt);
    EXPECT_NE(fixed, render(pipelineWith({}, {}, {}), bindAt));
    EXPECT_EQ(
        render(pipelineWith({}, {}, {VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE}),
               [&](VkCommandBuffer commands) { bind(commands, 0, 1, &places.buffer, &offset, nullptr, &stride); }),
        fixed);
    // What lies behind the given size reads as zero.
    EXPECT_NE(render(pipelineWith({}, {}, {VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE}),
                     [&](VkCommandBuffer commands) { bind(commands, 0, 1, &places.buffer, &offset, &size, &stride); }),
              fixed);
    auto binding = make<VkVertexInputBindingDescription2EXT>(VK_STRUCTURE_TYPE_VERTEX_INPUT_BINDING_DESCRIPTION_2_EXT);
    binding.stride = 12;
    binding.divisor = 1;
    auto attribute =
        make<VkVertexInputAttributeDescription2EXT>(VK_STRUCTURE_TYPE_VERTEX_INPUT_ATTRIBUTE_DESCRIPTION_2_EXT);
    attribute.format = VK_FORMAT_R32_SFLOAT;
    const auto setInput = command<PFN_vkCmdSetVertexInputEXT>("vkCmdSetVertexInputEXT");
    const VkPipeline free = pipelineWith({}, {}, {VK_DYNAMIC_STATE_VERTEX_INPUT_EXT});
    EXPECT_EQ(render(free,
                     [&](VkCommandBuffer commands) {
                         setInput(commands, 1, &binding, 1, &attribute);
                         bindAt(commands);
                     }),
              fixed);
    binding.inputRate = VK_VERTEX_INPUT_RATE_INSTANCE;
    EXPECT_NE(render(free,
                     [&](VkCommandBuffer commands) {
                         setInput(commands, 1, &binding, 1, &attribute);
                         bindAt(commands);
                     }),
              fixed);
}

// State stays set while pipelines change, and every draw sees what was set last.
TEST_F(DynamicStateTest, stateOutlivesPipelines) {
    const auto cull = command<PFN_vkCmdSetCullModeEXT>("vkCmdSetCullModeEXT");
    const VkPipeline fixed =
        pipelineWith({}, [](const PipelineStates& s) { s.raster.cullMode = VK_CULL_MODE_BACK_BIT; }, {});
    const VkPipeline all =
        pipelineWith({}, [](const PipelineStates& s) { s.raster.cullMode = VK_CULL_MODE_FRONT_AND_BACK; }, {});
    const VkPipeline dynamic = pipelineWith({}, {}, {VK_DYNAMIC_STATE_CULL_MODE});
    EXPECT_EQ(render(dynamic,
                     [&](VkCommandBuffer commands) {
                         cull(commands, VK_CULL_MODE_FRONT_AND_BACK);
                         vkCmdDrawIndexed(commands, 13, 1, 0, 0, 0);
                         cull(commands, VK_CULL_MODE_BACK_BIT);
                         vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, all);
                         vkCmdDrawIndexed(commands, 13, 1, 0, 0, 0);
                         vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, dynamic);
                     }),
              render(fixed, {}));
}

}  // namespace
}  // namespace vernier::test
