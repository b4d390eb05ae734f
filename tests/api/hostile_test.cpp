// What a careless or hostile caller can hand over that has the right types: each call is refused with a text that names
// what was wrong, or does something defined.
#include <array>
#include <cstring>
#include <limits>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::Each;
using testing::HasSubstr;

class Hostile : public ApiTest {
  protected:
    void expect(VnResult actual, VnResult expected, const std::string& text) {
        EXPECT_EQ(actual, expected) << lastError();
        EXPECT_THAT(lastError(), HasSubstr(text));
    }
    VnSampler sampler(const VnSamplerDesc& desc = {}) {
        VnSampler result{};
        EXPECT_EQ(vnCreateSampler(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
    VnImage layered(uint32_t size, uint32_t layers, bool cube) {
        VnImageDesc desc{};
        desc.width = desc.height = size;
        desc.layers = layers;
        desc.cube = cube;
        VnImage result{};
        EXPECT_EQ(vnCreateImage(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
    /// A full-screen draw that samples `with` at set 0, binding 0; the result of the draw.
    VnResult drawWith(const std::string& declaration, const std::string& expression, VnView view, VnSampler with) {
        const VnProgram made = program(kFullScreenVertex,
                                       "#version 450\n#extension GL_EXT_samplerless_texture_functions : "
                                       "require\nlayout(set = 0, binding = 0) uniform " +
                                           declaration +
                                           ";\nlayout(location = 0) out vec4 color;\n"
                                           "void main() { color = " +
                                           expression + "; }");
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
        const VnPassDesc pass = passOn(target);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindProgram(context_, made), VN_SUCCESS);
        EXPECT_EQ(vnBindTexture(context_, 0, 0, 0, view, with), VN_SUCCESS) << lastError();
        const VnResult result = vnDraw(context_, 3, 1, 0, 0);
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
        EXPECT_EQ(vnFinish(context_), VN_SUCCESS);
        return result;
    }
};

TEST_F(Hostile, SamplerFieldsAreChecked) {
    VnSampler made{};
    const auto wrong = [&](void (*change)(VnSamplerDesc&, float), const char* text) {
        VnSamplerDesc desc{};
        change(desc, std::numeric_limits<float>::quiet_NaN());
        expect(vnCreateSampler(device_, &desc, &made), VN_ERROR_INVALID_ARGUMENT, text);
        EXPECT_EQ(made.id, 0u);
    };
    wrong([](VnSamplerDesc& d, float) { d.magFilter = static_cast<VkFilter>(77); }, "magFilter is 77");
    wrong([](VnSamplerDesc& d, float) { d.minFilter = static_cast<VkFilter>(2); }, "minFilter is 2");
    wrong([](VnSamplerDesc& d, float) { d.minFilter = VK_FILTER_CUBIC_EXT, d.maxAnisotropy = 2; },
          "minFilter is cubic, which maxAnisotropy excludes");
    wrong([](VnSamplerDesc& d, float) { d.mipmapMode = static_cast<VkSamplerMipmapMode>(2); }, "mipmapMode is 2");
    wrong([](VnSamplerDesc& d, float) { d.addressW = static_cast<VkSamplerAddressMode>(-1); },
          "addressW is 4294967295");
    wrong([](VnSamplerDesc& d, float) { d.compareOp = static_cast<VkCompareOp>(8); }, "compareOp is 8");
    wrong([](VnSamplerDesc& d, float) { d.borderColor = static_cast<VkBorderColor>(6); }, "borderColor is 6");
    wrong([](VnSamplerDesc& d, float n) { d.lodBias = n; }, "lodBias is nan");
    wrong([](VnSamplerDesc& d, float n) { d.minLod = n; }, "minLod is nan");
    wrong([](VnSamplerDesc& d, float n) { d.maxLod = n; }, "maxLod is nan");
    wrong([](VnSamplerDesc& d, float) { d.minLod = 3, d.maxLod = 2; }, "minLod 3.000000 is above maxLod 2.000000");
}

TEST_F(Hostile, ViewsOfAnotherDimensionAreRefused) {
    const VnImage flat = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4), cube = layered(4, 6, true),
                  array = layered(4, 3, false);
    const VnImage deep = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4, 1, 4);
    const struct {
        const char *declaration, *expression;
        VnImage image;
        VnResult result;
    } cases[] = {
        {"sampler2D t", "textureLod(t, vec2(0.5), 0.0)", flat, VN_SUCCESS},
        {"sampler2D t", "textureLod(t, vec2(0.5), 0.0)", cube, VN_ERROR_INVALID_STATE},
        {"sampler2D t", "textureGrad(t, vec2(0.5), vec2(0.1), vec2(0.1))", cube, VN_ERROR_INVALID_STATE},
        {"sampler2D t", "texelFetch(t, ivec2(0), 0)", array, VN_ERROR_INVALID_STATE},
        {"sampler1D t", "textureLod(t, 0.5, 0.0)", flat, VN_ERROR_INVALID_STATE},
        {"sampler3D t", "textureGrad(t, vec3(0.5), vec3(0.1), vec3(0.1))", flat, VN_ERROR_INVALID_STATE},
        {"samplerCube t", "texture(t, vec3(1.0))", flat, VN_ERROR_INVALID_STATE},
        {"samplerCube t", "texture(t, vec3(1.0))", cube, VN_SUCCESS},
        {"sampler2DArray t", "texture(t, vec3(1.0))", array, VN_SUCCESS},
        {"sampler2DArray t", "texture(t, vec3(1.0))", flat, VN_ERROR_INVALID_STATE},
    };
    for (const auto& one : cases) {
        SCOPED_TRACE(std::string(one.declaration) + " " + one.expression);
        EXPECT_EQ(drawWith(one.declaration, one.expression, view(one.image), sampler()), one.result) << lastError();
        if (one.result != VN_SUCCESS) {
            EXPECT_THAT(lastError(), HasSubstr("set 0, binding 0"));
        }
    }
    EXPECT_EQ(drawWith("texture2DMS t", "vec4(textureSize(t), 0, 0)", view(flat), VnSampler{}), VN_ERROR_INVALID_STATE);
    EXPECT_EQ(drawWith("texture2DMS t", "vec4(textureSize(t), 0, 0)", view(deep), VnSampler{}), VN_SUCCESS);
    EXPECT_EQ(drawWith("texture2D t", "vec4(textureSize(t, 0), 0, 0)", view(deep), VnSampler{}),
              VN_ERROR_INVALID_STATE);
}

TEST_F(Hostile, PassFieldsAreChecked) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    VnPassDesc pass = passOn(target);
    pass.colors[0].loadOp = static_cast<VkAttachmentLoadOp>(9);
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT, "colors[0] loadOp is 9");
    pass = passOn(target);
    pass.colors[0].storeOp = static_cast<VkAttachmentStoreOp>(-2);
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT, "colors[0] storeOp is 4294967294");
    pass = passOn(target);
    pass.colors[3] = pass.colors[0];
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT, "colors[3] is the same image as colors[0]");
    pass = passOn(target);
    pass.depthStencil.view = view(image(VK_FORMAT_D32_SFLOAT, 8, 8));
    pass.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    pass.depthStencil.clear.depthStencil.depth = 2;
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT, "depthStencil clear depth is 2");
    for (const VkRect2D area : {VkRect2D{{0, 0}, {0, 4}}, VkRect2D{{-1, 0}, {4, 4}}, VkRect2D{{0, 0}, {8, 0xFFFFFFFF}},
                                VkRect2D{{0x7FFFFFFF, 0}, {0x7FFFFFFF, 1}}}) {
        pass = passOn(target);
        pass.renderArea = area;
        expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT, "renderArea");
    }
}

TEST_F(Hostile, ClearsInsideAPassAreCutToTheRenderArea) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 20, 12);
    VnPassDesc pass = passOn(target);
    pass.renderArea = {{3, 2}, {9, 7}};
    const VkClearColorValue white{{1, 1, 1, 1}};
    constexpr int32_t kLow = std::numeric_limits<int32_t>::min(), kHigh = std::numeric_limits<int32_t>::max();
    for (const VkRect2D rect : {VkRect2D{{kLow, kLow}, {0xFFFFFFFF, 0xFFFFFFFF}}, VkRect2D{{-5, -5}, {4000, 4000}},
                                VkRect2D{{kHigh, 0}, {0xFFFFFFFF, 1}}, VkRect2D{{0, 0}, {0, 0}}}) {
        ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnClearColor(context_, 0, &white, &rect), VN_SUCCESS);
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
        const std::vector<uint32_t> pixels = read(target, 20, 12);
        const bool covers = rect.offset.x < 0;
        for (uint32_t i = 0; i < pixels.size(); ++i) {
            const bool inside = i % 20 >= 3 && i % 20 < 12 && i / 20 >= 2 && i / 20 < 9;
            ASSERT_EQ(pixels[i], inside && covers ? 0xFFFFFFFFu : 0u) << i % 20 << ", " << i / 20;
        }
    }
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    expect(vnClearColor(context_, 1, &white, nullptr), VN_ERROR_INVALID_ARGUMENT, "attachment 1 is not in the pass");
    expect(vnClearColor(context_, 0xFFFFFFFF, &white, nullptr), VN_ERROR_INVALID_ARGUMENT, "attachment 4294967295");
    expect(vnClearDepthStencil(context_, VK_IMAGE_ASPECT_DEPTH_BIT, 1, 0, nullptr), VN_ERROR_INVALID_ARGUMENT,
           "no depth");
    EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
}

TEST_F(Hostile, CopiesOntoThemselvesAndBetweenAspectsAreRefused) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8, 2);
    VnRegion from{}, to{};
    from.width = from.height = to.width = to.height = 4;
    to.x = to.y = 3;
    expect(vnCopyImage(context_, target, &from, target, &to), VN_ERROR_INVALID_ARGUMENT, "overlap");
    expect(vnBlitImage(context_, target, &from, target, &to, VK_FILTER_NEAREST), VN_ERROR_INVALID_ARGUMENT, "overlap");
    to.x = 4;
    EXPECT_EQ(vnCopyImage(context_, target, &from, target, &to), VN_SUCCESS) << lastError();
    to = {};
    to.mip = 1;
    EXPECT_EQ(vnCopyImage(context_, target, &from, target, &to), VN_SUCCESS) << lastError();
    const VnImage depth = image(VK_FORMAT_D32_SFLOAT, 8, 8);
    expect(vnCopyImage(context_, target, nullptr, depth, nullptr), VN_ERROR_INVALID_ARGUMENT, "aspect");
    const VnBuffer buffer = this->buffer(nullptr, 64);
    expect(vnCopyBuffer(context_, buffer, 0, buffer, 8, 16), VN_ERROR_INVALID_ARGUMENT, "overlap");
    EXPECT_EQ(vnCopyBuffer(context_, buffer, 0, buffer, 16, 16), VN_SUCCESS);
    EXPECT_EQ(vnCopyBuffer(context_, buffer, 64, buffer, 0, 0), VN_SUCCESS);
    expect(vnCopyBuffer(context_, buffer, 0, buffer, 16, std::numeric_limits<uint64_t>::max()),
           VN_ERROR_INVALID_ARGUMENT, "is not inside the buffer's 64 bytes");
    EXPECT_EQ(vnFinish(context_), VN_SUCCESS);
}

TEST_F(Hostile, SizesThatNoMemoryHasAreRefused) {
    for (const uint64_t less : {0, 1, 63, 64, 65, 127, 128, 4096}) {
        VnBufferDesc desc{};
        desc.size = std::numeric_limits<uint64_t>::max() - less;
        VnBuffer made{};
        expect(vnCreateBuffer(device_, &desc, &made), VN_ERROR_OUT_OF_MEMORY, std::to_string(desc.size) + " bytes");
    }
}

TEST_F(Hostile, OldHandlesAreNeverValidAgain) {
    const VnSampler old = sampler();
    ASSERT_EQ(vnDestroySampler(device_, old), VN_SUCCESS);
    // More than a handle's generation can count.
    for (uint32_t i = 0; i < 70000; ++i) {
        const VnSampler next = sampler();
        ASSERT_NE(next.id, old.id) << i;
        ASSERT_EQ(vnDestroySampler(device_, next), VN_SUCCESS);
    }
    expect(vnDestroySampler(device_, old), VN_ERROR_INVALID_HANDLE, "sampler is null, destroyed");
}

TEST_F(Hostile, DestroyedStateStaysBoundAndLeavesNoPlan) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
    VnBlendStateDesc desc{};
    desc.attachments[0].writeMaskOff = VK_COLOR_COMPONENT_R_BIT;
    VnBlendState blend{};
    ASSERT_EQ(vnCreateBlendState(device_, &desc, &blend), VN_SUCCESS);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    ASSERT_EQ(vnBindBlendState(context_, blend), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    ASSERT_EQ(vnDestroyBlendState(device_, blend), VN_SUCCESS);
    ASSERT_EQ(vnDestroyProgram(device_, white), VN_SUCCESS);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    EXPECT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_THAT(read(target, 4, 4), Each(0xFFFFFF00u));
}

TEST_F(Hostile, SpecialisationsOfAnyKind) {
    // Constants that the shader does not have are ignored; the widths of those it has are the shader's.
    const std::string source = R"(#version 450
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(constant_id = 0) const bool truth = false;
layout(constant_id = 1) const int64_t wide = 5l;
layout(constant_id = 2) const int16_t narrow = 7s;
layout(constant_id = 3) const double real = 1.0lf;
layout(location = 0) out uvec4 color;
void main() { color = uvec4(truth, uint(wide), uint(narrow), uint(real)); })";
    const std::vector<uint32_t> words = compileGlsl(VK_SHADER_STAGE_FRAGMENT_BIT, source);
    const VnSpecialization all[] = {{0, 77}, {2, 0x10009}, {0xFFFFFFFF, 3}, {0, 1}};
    for (uint32_t count = 0; count <= 4; ++count) {
        VnShaderDesc desc{};
        desc.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
        desc.words = words.data();
        desc.wordCount = words.size();
        desc.specializations = all;
        desc.specializationCount = count;
        VnShader made{};
        EXPECT_THAT(vnCreateShader(device_, &desc, &made), testing::AnyOf(VN_SUCCESS, VN_ERROR_SHADER)) << lastError();
    }
    const VnSpecialization tooNarrow[] = {{1, 1}};
    VnShaderDesc desc{};
    desc.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    desc.words = words.data();
    desc.wordCount = words.size();
    desc.specializations = tooNarrow;
    desc.specializationCount = 1;
    VnShader made{};
    expect(vnCreateShader(device_, &desc, &made), VN_ERROR_SHADER, "constant 1");
}

}  // namespace
}  // namespace vernier::test
