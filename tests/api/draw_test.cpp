// Drawing through the public API: what each kind of command and state does to pixels.
#include <array>
#include <cstring>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

constexpr uint32_t kRed = 0xFF0000FF, kGreen = 0xFF00FF00, kBlack = 0;

constexpr const char* kPushColor = R"(#version 450
layout(push_constant) uniform Push { vec4 value; };
layout(location = 0) out vec4 color;
void main() { color = value; })";

class Draw : public ApiTest {
  protected:
    void begin(VnImage target) {
        VnPassDesc pass = passOn(target);
        ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    }
    void push(float r, float g, float b, float a) {
        const float value[] = {r, g, b, a};
        ASSERT_EQ(vnPushConstants(context_, 0, value, sizeof value), VN_SUCCESS);
    }
    void draw() { ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError(); }
};

TEST_F(Draw, StateChangesBetweenDrawsTakeEffectInOrder) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 16, 8);
    begin(target);
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kPushColor)), VN_SUCCESS);
    push(1, 0, 0, 1);
    draw();
    const VkRect2D right{{8, 0}, {8, 8}};
    ASSERT_EQ(vnSetScissor(context_, &right), VN_SUCCESS);
    push(0, 1, 0, 1);
    draw();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    const std::vector<uint32_t> pixels = read(target, 16, 8);
    for (uint32_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i], i % 16 < 8 ? kRed : kGreen) << i;
}

TEST_F(Draw, BindingsSurviveAFlush) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kPushColor)), VN_SUCCESS);
    push(0, 1, 0, 1);
    for (int frame = 0; frame < 3; ++frame) {
        begin(target);
        draw();
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
        ASSERT_EQ(vnFlush(context_), VN_SUCCESS);
    }
    EXPECT_THAT(read(target, 4, 4), testing::Each(kGreen));
}

TEST_F(Draw, UniformBuffersChangeBetweenDrawsAndUpdatesAreOrdered) {
    const VnProgram reads = program(kFullScreenVertex, R"(#version 450
layout(set = 0, binding = 0) uniform Block { vec4 value; };
layout(location = 0) out vec4 color;
void main() { color = value; })");
    const float red[] = {1, 0, 0, 1}, green[] = {0, 1, 0, 1};
    const VnBuffer first = buffer(red, sizeof red), second = buffer(red, sizeof red);
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 2);
    ASSERT_EQ(vnUpdateBuffer(context_, second, 0, green, sizeof green), VN_SUCCESS);
    begin(target);
    ASSERT_EQ(vnBindProgram(context_, reads), VN_SUCCESS);
    ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, first, 0, 0), VN_SUCCESS);
    draw();
    const VkRect2D right{{4, 0}, {4, 2}};
    ASSERT_EQ(vnSetScissor(context_, &right), VN_SUCCESS);
    ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, second, 0, 0), VN_SUCCESS);
    draw();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    ASSERT_EQ(vnUpdateBuffer(context_, first, 0, green, sizeof green),
              VN_SUCCESS);  // after the draws: no effect on them
    const std::vector<uint32_t> pixels = read(target, 8, 2);
    for (uint32_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i], i % 8 < 4 ? kRed : kGreen) << i;
}

TEST_F(Draw, SpecialisationConstantsReplaceDefaults) {
    const VnShader fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(constant_id = 3) const float green = 0.0;
layout(location = 0) out vec4 color;
void main() { color = vec4(0, green, 0, 1); })",
                                     {{3, 0x3F800000u}});
    VnProgramDesc desc{};
    desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, kFullScreenVertex);
    desc.fragment = fragment;
    VnProgram specialised{};
    ASSERT_EQ(vnCreateProgram(device_, &desc, &specialised), VN_SUCCESS) << lastError();
    EXPECT_THAT(drawFullScreen(image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4), 4, 4, specialised), testing::Each(kGreen));
}

TEST_F(Draw, IndexedInstancedAndIndirectDrawsAgree) {
    // Each instance fills one column of four, told by the per-instance attribute.
    const VnProgram columns = program(R"(#version 450
layout(location = 0) in vec2 corner;
layout(location = 1) in float column;
void main() { gl_Position = vec4((column + corner.x) * 0.5 - 1.0, corner.y * 2.0 - 1.0, 0.0, 1.0); })",
                                      kWhiteFragment);
    const float corners[] = {9, 9, 0, 0, 1, 0, 0, 1, 1, 1};  // the first vertex is skipped by vertexOffset
    const float instanceColumns[] = {7, 1, 3};               // the first instance is skipped by firstInstance
    const uint16_t indices[] = {99, 0, 1, 2, 2, 1, 3};
    const VnVertexAttribute attributes[] = {{0, 0, VK_FORMAT_R32G32_SFLOAT, 0}, {1, 1, VK_FORMAT_R32_SFLOAT, 0}};
    const VnVertexBinding bindings[] = {{8, 0}, {4, 1}};
    VnVertexLayoutDesc layoutDesc{};
    layoutDesc.attributes = attributes;
    layoutDesc.attributeCount = 2;
    layoutDesc.bindings = bindings;
    layoutDesc.bindingCount = 2;
    VnVertexLayout layout{};
    ASSERT_EQ(vnCreateVertexLayout(device_, &layoutDesc, &layout), VN_SUCCESS);
    const VkDrawIndexedIndirectCommand arguments{6, 2, 1, 1, 1};
    const VnBuffer vertexBuffer = buffer(corners, sizeof corners),
                   instanceBuffer = buffer(instanceColumns, sizeof instanceColumns);
    const VnBuffer indexBuffer = buffer(indices, sizeof indices), indirect = buffer(&arguments, sizeof arguments);
    for (const bool viaBuffer : {false, true}) {
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 3);
        begin(target);
        ASSERT_EQ(vnBindProgram(context_, columns), VN_SUCCESS);
        ASSERT_EQ(vnBindVertexLayout(context_, layout), VN_SUCCESS);
        ASSERT_EQ(vnBindVertexBuffer(context_, 0, vertexBuffer, 0), VN_SUCCESS);
        ASSERT_EQ(vnBindVertexBuffer(context_, 1, instanceBuffer, 0), VN_SUCCESS);
        ASSERT_EQ(vnBindIndexBuffer(context_, indexBuffer, 0, VK_INDEX_TYPE_UINT16), VN_SUCCESS);
        if (viaBuffer)
            ASSERT_EQ(vnDrawIndexedIndirect(context_, indirect, 0, 1, 0), VN_SUCCESS) << lastError();
        else
            ASSERT_EQ(vnDrawIndexed(context_, 6, 2, 1, 1, 1), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
        const std::vector<uint32_t> pixels = read(target, 4, 3);
        for (uint32_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i], i % 2 ? 0xFFFFFFFFu : kBlack) << i;
    }
}

TEST_F(Draw, DepthTestAndBlending) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4), depthImage = image(VK_FORMAT_D24_UNORM_S8_UINT, 4, 4);
    const VnProgram atDepth = program(R"(#version 450
layout(push_constant) uniform Push { vec4 value; float depth; };
void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, depth, 1.0); })",
                                      kPushColor);
    VnDepthStencilStateDesc depthDesc{};
    depthDesc.depthTest = depthDesc.depthWrite = 1;
    VnDepthStencilState depth{};
    ASSERT_EQ(vnCreateDepthStencilState(device_, &depthDesc, &depth), VN_SUCCESS);
    VnBlendStateDesc blendDesc{};
    blendDesc.attachments[0].enable = 1;
    VnBlendState blend{};
    ASSERT_EQ(vnCreateBlendState(device_, &blendDesc, &blend), VN_SUCCESS);
    VnPassDesc pass = passOn(target);
    pass.depthStencil.view = view(depthImage);
    pass.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    pass.depthStencil.clear.depthStencil.depth = 1;
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, atDepth), VN_SUCCESS);
    ASSERT_EQ(vnBindDepthStencilState(context_, depth), VN_SUCCESS);
    const auto drawAt = [&](std::array<float, 5> values) {
        ASSERT_EQ(vnPushConstants(context_, 0, values.data(), sizeof values), VN_SUCCESS);
        draw();
    };
    drawAt({1, 0, 0, 1, 0.5f});
    drawAt({0, 1, 0, 1, 0.75f});  // behind
    ASSERT_EQ(vnBindBlendState(context_, blend), VN_SUCCESS);
    drawAt({0, 1, 0, 0.5f, 0.25f});  // in front, half transparent
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    // 0.5 * 255 = 127.5: half green over half red, either neighbour is nearest
    for (const uint32_t pixel : read(target, 4, 4)) {
        EXPECT_THAT(pixel & 0xFF, testing::AnyOf(127u, 128u));
        EXPECT_THAT(pixel >> 8 & 0xFF, testing::AnyOf(127u, 128u));
        EXPECT_EQ(pixel >> 24, 255u);
    }
    uint32_t depthTexels[16];
    ASSERT_EQ(vnReadImage(context_, depthImage, nullptr, depthTexels, sizeof depthTexels), VN_SUCCESS) << lastError();
    EXPECT_THAT(depthTexels, testing::Each(testing::AnyOf(0x3FFFFFu, 0x400000u)));
}

TEST_F(Draw, MultisampledTriangleResolvesToCoverage) {
    const VnImage samples = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8, 1, 4),
                  resolved = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    const VnProgram diagonal = program(R"(#version 450
const vec2 corners[3] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1));
void main() { gl_Position = vec4(corners[gl_VertexIndex], 0, 1); })",
                                       kWhiteFragment);
    VnPassDesc pass = passOn(samples);
    pass.colors[0].resolve = view(resolved);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, diagonal), VN_SUCCESS);
    draw();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    const std::vector<uint32_t> pixels = read(resolved, 8, 8);
    EXPECT_EQ(pixels[0], 0xFFFFFFFFu);
    EXPECT_EQ(pixels[63], kBlack);
    for (uint32_t i = 0; i < 8; ++i) EXPECT_EQ(pixels[i * 8 + 7 - i], 0x80808080u) << "two of four samples";
}

TEST_F(Draw, RenderToTextureWithMipmaps) {
    const VnImage texture = image(VK_FORMAT_R8G8B8A8_UNORM, 16, 16, VN_ALL_MIPS),
                  target = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
    VnViewDesc baseDesc{};
    baseDesc.image = texture;
    baseDesc.mipCount = 1;
    VnView base{};
    ASSERT_EQ(vnCreateView(device_, &baseDesc, &base), VN_SUCCESS);
    VnPassDesc pass{};
    pass.colors[0].view = base;
    pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kPushColor)), VN_SUCCESS);
    push(0, 1, 0, 1);
    draw();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    ASSERT_EQ(vnGenerateMips(context_, texture), VN_SUCCESS) << lastError();
    VnSamplerDesc samplerDesc{};
    VnSampler sampler{};
    ASSERT_EQ(vnCreateSampler(device_, &samplerDesc, &sampler), VN_SUCCESS);
    ASSERT_EQ(vnBindTexture(context_, 0, 0, 0, view(texture), sampler), VN_SUCCESS) << lastError();
    const VnProgram sample = program(kFullScreenVertex, R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 color;
void main() { color = textureLod(image, gl_FragCoord.xy / 4.0, 4.0); })");
    EXPECT_THAT(drawFullScreen(target, 4, 4, sample), testing::Each(kGreen));
}

TEST_F(Draw, ClearsInsideAPassAreOrderedWithDraws) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    begin(target);
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kWhiteFragment)), VN_SUCCESS);
    draw();
    const VkClearColorValue green{{0, 1, 0, 1}};
    const VkRect2D left{{0, 0}, {3, 8}};
    ASSERT_EQ(vnClearColor(context_, 0, &green, &left), VN_SUCCESS);
    const VkRect2D top{{0, 0}, {8, 2}};
    ASSERT_EQ(vnSetScissor(context_, &top), VN_SUCCESS);
    draw();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    const std::vector<uint32_t> pixels = read(target, 8, 8);
    for (uint32_t i = 0; i < 64; ++i) ASSERT_EQ(pixels[i], i / 8 >= 2 && i % 8 < 3 ? kGreen : 0xFFFFFFFFu) << i;
}

TEST_F(Draw, ClipDistancesCutAndCanBeReadBack) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 4);
    const VnProgram cut = program(R"(#version 450
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
    gl_Position = vec4(corner, 0.5, 1.0);
    gl_ClipDistance[0] = corner.x;  // the left half is cut away
})",
                                  R"(#version 450
in float gl_ClipDistance[1];
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_ClipDistance[0], 1.0, 0.0, 1.0); })");
    const std::vector<uint32_t> pixels = drawFullScreen(target, 8, 4, cut);
    for (uint32_t i = 0; i < pixels.size(); ++i) {
        const uint32_t x = i % 8;
        if (x < 4) {
            ASSERT_EQ(pixels[i], kBlack) << i;
            continue;
        }
        const double red = 255 * (static_cast<double>(x) - 3.5) / 4;  // the distance at the pixel's centre
        ASSERT_NEAR(pixels[i] & 0xFF, red, 0.51) << i;
        ASSERT_EQ(pixels[i] >> 8, 0xFF00FFu) << i;
    }
}

TEST_F(Draw, StorageBuffersAndImagesAreWritten) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8), storage = image(VK_FORMAT_R32_UINT, 8, 8);
    const uint32_t zeros[64] = {};
    const VnBuffer counts = buffer(zeros, sizeof zeros);
    const VnProgram writes = program(kFullScreenVertex, R"(#version 450
layout(set = 0, binding = 0) buffer Counts { uint counts[]; };
layout(set = 0, binding = 1, r32ui) uniform uimage2D stored;
layout(location = 0) out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    atomicAdd(counts[at.y], 1u);
    imageStore(stored, at, uvec4(at.x * 100 + at.y));
    imageAtomicAdd(stored, ivec2(0, 0), 1u);
    color = vec4(1.0);
})");
    ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, counts, 0, 0), VN_SUCCESS);
    ASSERT_EQ(vnBindTexture(context_, 0, 1, 0, view(storage), VnSampler{}), VN_SUCCESS) << lastError();
    EXPECT_THAT(drawFullScreen(target, 8, 8, writes), testing::Each(0xFFFFFFFFu));
    uint32_t read8[8];
    ASSERT_EQ(vnReadBuffer(context_, counts, 0, read8, sizeof read8), VN_SUCCESS);
    EXPECT_THAT(read8, testing::Each(8u)) << "each pixel counted once";
    const std::vector<uint32_t> stored = read(storage, 8, 8);
    for (uint32_t i = 1; i < stored.size(); ++i) ASSERT_EQ(stored[i], i % 8 * 100 + i / 8) << i;
}

TEST_F(Draw, ManyTinyDrawsKeepTheirOrder) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
    begin(target);
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kPushColor)), VN_SUCCESS);
    for (int i = 0; i <= 3000; ++i) {
        push(static_cast<float>(i % 256) / 255, static_cast<float>(i / 256) / 255, 0, 1);
        draw();
    }
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_THAT(read(target, 4, 4), testing::Each(0xFF000000u | 3000 / 256 << 8 | 3000 % 256));
}

TEST_F(Draw, SeveralContextsAndDevicesWorkSideBySide) {
    VnDevice other = nullptr;
    ASSERT_EQ(vnCreateDevice(nullptr, &other), VN_SUCCESS);
    VnContext second = nullptr;
    ASSERT_EQ(vnCreateContext(device_, nullptr, &second), VN_SUCCESS);
    const VnImage a = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4), b = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
    const VnProgram color = program(kFullScreenVertex, kPushColor);
    const VnContext contexts[] = {context_, second};
    const VnImage targets[] = {a, b};
    for (int i = 0; i < 2; ++i) {
        VnPassDesc pass = passOn(targets[i]);
        ASSERT_EQ(vnBeginPass(contexts[i], &pass), VN_SUCCESS);
        ASSERT_EQ(vnBindProgram(contexts[i], color), VN_SUCCESS);
        const float value[] = {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, 0, 1};
        ASSERT_EQ(vnPushConstants(contexts[i], 0, value, sizeof value), VN_SUCCESS);
    }
    for (const VnContext context : contexts) {
        ASSERT_EQ(vnDraw(context, 3, 1, 0, 0), VN_SUCCESS);
        ASSERT_EQ(vnEndPass(context), VN_SUCCESS);
    }
    EXPECT_THAT(read(a, 4, 4), testing::Each(kRed));
    uint32_t pixels[16];
    ASSERT_EQ(vnReadImage(second, b, nullptr, pixels, sizeof pixels), VN_SUCCESS);
    EXPECT_THAT(pixels, testing::Each(kGreen));
    vnDestroyContext(second);
    vnDestroyDevice(other);
}

}  // namespace
}  // namespace vernier::test
