// Layers, viewports, views, lines, samples and depth resolves through vernier.h.
#include <gmock/gmock.h>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

constexpr uint32_t kSize = 16;
const char* const kInstanceColor = R"(#version 450
layout(location = 0) flat in int instance;
layout(location = 0) out vec4 color;
void main() { color = vec4((instance + 1) / 255.0); })";

class Primitives : public ApiTest {
  protected:
    VnImage layered(uint32_t layers) {
        VnImageDesc desc{};
        desc.width = desc.height = kSize;
        desc.layers = layers;
        VnImage result{};
        EXPECT_EQ(vnCreateImage(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
    /// Red of every pixel of a layer.
    std::vector<uint32_t> reds(VnImage of, uint32_t layer = 0) {
        VnRegion region{};
        region.layer = layer;
        std::vector<uint32_t> pixels(kSize * kSize);
        EXPECT_EQ(vnReadImage(context_, of, &region, pixels.data(), pixels.size() * 4), VN_SUCCESS) << lastError();
        for (uint32_t& pixel : pixels) pixel &= 0xFF;
        return pixels;
    }
    void draw(const VnPassDesc& pass, VnProgram with, uint32_t vertices, uint32_t instances) {
        ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnBindProgram(context_, with), VN_SUCCESS);
        ASSERT_EQ(vnDraw(context_, vertices, instances, 0, 0), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    }
};

TEST_F(Primitives, ShadersChooseLayersAndViewports) {
    const VnImage target = layered(3);
    const VnProgram routed = program(R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : require
layout(location = 0) flat out int instance;
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0.5, 1);
    gl_Layer = 2 * gl_InstanceIndex;
    gl_ViewportIndex = 15 * gl_InstanceIndex;
    instance = gl_InstanceIndex;
})",
                                     kInstanceColor);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    const VkViewport quarter{8, 8, 8, 8, 0, 1};
    ASSERT_EQ(vnSetViewports(context_, 15, 1, &quarter), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, routed), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 3, 2, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_THAT(reds(target, 0), testing::Each(1u));
    EXPECT_THAT(reds(target, 1), testing::Each(0u));
    const auto last = reds(target, 2);
    for (uint32_t i = 0; i < last.size(); ++i) EXPECT_EQ(last[i], i % kSize >= 8 && i / kSize >= 8 ? 2u : 0u) << i;
    const VkViewport many[2] = {quarter, quarter};
    EXPECT_EQ(vnSetViewports(context_, 15, 2, many), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastError().find("15 + 2"), std::string::npos) << lastError();
}

TEST_F(Primitives, ViewsAreDrawnAtOnce) {
    const VnImage target = layered(2);
    VnPassDesc pass = passOn(target);
    pass.viewMask = 0b11;
    draw(pass,
         program(R"(#version 450
#extension GL_EXT_multiview : require
layout(location = 0) flat out int instance;
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0.5, 1);
    instance = 10 * gl_ViewIndex;
})",
                 kInstanceColor),
         3, 1);
    EXPECT_THAT(reds(target, 0), testing::Each(1u));
    EXPECT_THAT(reds(target, 1), testing::Each(11u));
    pass.viewMask = 0b100;
    EXPECT_EQ(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT);
}

TEST_F(Primitives, LinesAreStippled) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
    VnRasterStateDesc desc{};
    desc.lineMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    desc.lineStippleFactor = 2;
    desc.lineStipplePattern = 0b101;
    VnRasterState state{};
    ASSERT_EQ(vnCreateRasterState(device_, &desc, &state), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindRasterState(context_, state), VN_SUCCESS);
    ASSERT_EQ(vnSetTopology(context_, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 0), VN_SUCCESS);
    draw(passOn(target),
         program(R"(#version 450
layout(location = 0) flat out int instance;
void main() {
    gl_Position = vec4((gl_VertexIndex == 0 ? 2.5 : 14.5) / 8 - 1, 5.5 / 8 - 1, 0.5, 1);
    instance = 0;
})",
                 kInstanceColor),
         2, 1);
    const auto pixels = reds(target);
    for (uint32_t x = 0; x < kSize; ++x)
        EXPECT_EQ(pixels[5 * kSize + x], x == 2 || x == 3 || x == 6 || x == 7 ? 1u : 0u) << x;
    desc.lineStippleFactor = 257;
    EXPECT_EQ(vnCreateRasterState(device_, &desc, &state), VN_ERROR_INVALID_ARGUMENT);
}

TEST_F(Primitives, SixteenSamplesAndDepthResolve) {
    const VnImage color = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize, 1, 16);
    const VnImage depth = image(VK_FORMAT_D32_SFLOAT, kSize, kSize, 1, 16);
    const VnImage resolved = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
    const VnImage depthResolved = image(VK_FORMAT_D32_SFLOAT, kSize, kSize);
    VnRasterStateDesc raster{};
    raster.sampleMaskOff = 0xFFF0;  // a quarter of the samples is drawn to
    raster.alphaToOne = 1;
    VnRasterState rasterState{};
    ASSERT_EQ(vnCreateRasterState(device_, &raster, &rasterState), VN_SUCCESS) << lastError();
    VnDepthStencilStateDesc test{};
    test.depthTest = test.depthWrite = 1;
    VnDepthStencilState testState{};
    ASSERT_EQ(vnCreateDepthStencilState(device_, &test, &testState), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindRasterState(context_, rasterState), VN_SUCCESS);
    ASSERT_EQ(vnBindDepthStencilState(context_, testState), VN_SUCCESS);
    VnPassDesc pass = passOn(color);
    pass.colors[0].resolve = view(resolved);
    pass.depthStencil.view = view(depth);
    pass.depthStencil.resolve = view(depthResolved);
    pass.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    pass.depthStencil.clear.depthStencil.depth = 1;
    const VnProgram half = program(R"(#version 450
void main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0.5, 1); })",
                                   R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1, 1, 1, 0); })");
    for (const auto& [mode, expected] : {std::pair{VK_RESOLVE_MODE_NONE, 0.5f},
                                         {VK_RESOLVE_MODE_MAX_BIT, 1.0f},
                                         {VK_RESOLVE_MODE_AVERAGE_BIT, 0.875f}}) {
        pass.depthStencil.depthResolve = mode;
        draw(pass, half, 3, 1);
        std::vector<float> depths(kSize * kSize);
        ASSERT_EQ(vnReadImage(context_, depthResolved, nullptr, depths.data(), depths.size() * 4), VN_SUCCESS);
        EXPECT_THAT(depths, testing::Each(expected));
    }
    EXPECT_THAT(read(resolved, kSize, kSize), testing::Each(0x40404040u));
    pass.depthStencil.stencilResolve = VK_RESOLVE_MODE_AVERAGE_BIT;
    EXPECT_EQ(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace vernier::test
