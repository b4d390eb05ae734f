// Stencil references that fragment programs write (GL_ARB_shader_stencil_export, SPV_EXT_shader_stencil_export).
#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

constexpr uint32_t kWidth = 70, kHeight = 20;

class StencilExport : public ApiTest {
  protected:
    static std::string fragment(const std::string& reference) {
        return R"(#version 450
#extension GL_ARB_shader_stencil_export : require
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); gl_FragStencilRefARB = )" +
               reference + "; }";
    }
    void bindState(VkCompareOp compare) {
        VnDepthStencilStateDesc desc{};
        desc.stencilTest = 1;
        desc.front.passOp = desc.back.passOp = VK_STENCIL_OP_REPLACE;
        desc.front.compareOp = desc.back.compareOp = compare;
        VnDepthStencilState state{};
        ASSERT_EQ(vnCreateDepthStencilState(device_, &desc, &state), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnBindDepthStencilState(context_, state), VN_SUCCESS);
        ASSERT_EQ(vnSetStencilReference(context_, 99, 99), VN_SUCCESS);
    }
    VnPassDesc passOn(VnImage color, VnImage stencil) {
        VnPassDesc pass = ApiTest::passOn(color);
        pass.depthStencil.view = view(stencil);
        pass.depthStencil.loadOp = pass.depthStencil.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        pass.depthStencil.clear.depthStencil = {1, 7};
        return pass;
    }
    void draw(VnProgram with) {
        ASSERT_EQ(vnBindProgram(context_, with), VN_SUCCESS);
        ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    }
    std::vector<uint8_t> stencilOf(VnImage of) {
        std::vector<uint8_t> codes(kWidth * kHeight);
        VnRegion region{};
        region.aspect = VK_IMAGE_ASPECT_STENCIL_BIT;
        EXPECT_EQ(vnReadImage(context_, of, &region, codes.data(), codes.size()), VN_SUCCESS) << lastError();
        return codes;
    }
};

TEST_F(StencilExport, ReplacesAndComparesByPixel) {
    for (const VkFormat format : {VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        const VnImage color = image(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight),
                      stencil = image(format, kWidth, kHeight);
        const VnPassDesc pass = passOn(color, stencil);
        ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        bindState(VK_COMPARE_OP_ALWAYS);
        draw(program(kFullScreenVertex, fragment("int(gl_FragCoord.x) * 3 + int(gl_FragCoord.y) * 5 + 256")));
        bindState(VK_COMPARE_OP_EQUAL);
        const VkClearColorValue black{};
        ASSERT_EQ(vnClearColor(context_, 0, &black, nullptr), VN_SUCCESS);
        draw(program(kFullScreenVertex, fragment("int(gl_FragCoord.x) * 3 + 20")));
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
        const std::vector<uint8_t> codes = stencilOf(stencil);
        const std::vector<uint32_t> texels = read(color, kWidth, kHeight);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                ASSERT_EQ(codes[y * kWidth + x], (x * 3 + y * 5) % 256) << x << ", " << y;
                ASSERT_EQ(texels[y * kWidth + x], y == 4 ? ~0u : 0u) << x << ", " << y;
            }
    }
}

TEST_F(StencilExport, WritesEverySampleItsOwn) {
    const VnImage color = image(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight, 1, 4);
    const VnImage stencil = image(VK_FORMAT_D32_SFLOAT_S8_UINT, kWidth, kHeight, 1, 4);
    const VnImage resolved = image(VK_FORMAT_D32_SFLOAT_S8_UINT, kWidth, kHeight);
    const VnProgram perPixel = program(kFullScreenVertex, fragment("int(gl_FragCoord.x) + 300"));
    const VnProgram perSample = program(kFullScreenVertex, fragment("int(gl_FragCoord.x) + gl_SampleID * 40"));
    for (const bool samples : {false, true})
        for (const VkResolveModeFlagBits mode : {VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MAX_BIT}) {
            VnPassDesc pass = passOn(color, stencil);
            pass.depthStencil.resolve = view(resolved);
            pass.depthStencil.stencilResolve = mode;
            ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
            bindState(VK_COMPARE_OP_ALWAYS);
            draw(samples ? perSample : perPixel);
            ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
            const std::vector<uint8_t> codes = stencilOf(resolved);
            for (uint32_t x = 0; x < kWidth; ++x) {
                const uint32_t most = samples && mode == VK_RESOLVE_MODE_MAX_BIT ? 120 : 0;
                ASSERT_EQ(codes[x], (x + (samples ? most : 300)) % 256) << x;
            }
        }
}

}  // namespace
}  // namespace vernier::test
