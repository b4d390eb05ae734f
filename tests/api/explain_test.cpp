// A draw runs what the scene calls for and nothing else: explain() says what is left out, and the counters show that it
// cost nothing.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

class Explain : public ApiTest {
  protected:
    using ExplainFunction = VnResult (*)(VnContext, VnExplainFormat, char*, size_t, size_t*);
    std::string explain(VnExplainFormat format = VN_EXPLAIN_TEXT, ExplainFunction function = vnExplain) {
        size_t length = 0;
        EXPECT_EQ(function(context_, format, nullptr, 0, &length), VN_SUCCESS) << lastError();
        std::string text(length, '\0');
        EXPECT_EQ(function(context_, format, text.data(), length + 1, nullptr), VN_SUCCESS);
        return text;
    }
    /// Draws one full-screen triangle and returns what it took.
    VnStatistics run(VnProgram with, VnBlendState blend = {}, VnDepthStencilState depth = {},
                     std::string* text = nullptr) {
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
        VnPassDesc pass = passOn(target);
        pass.depthStencil.view = view(image(VK_FORMAT_D32_SFLOAT, kSize, kSize));
        pass.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        pass.depthStencil.clear.depthStencil.depth = 1;
        EXPECT_EQ(vnResetStatistics(context_), VN_SUCCESS);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindProgram(context_, with), VN_SUCCESS);
        EXPECT_EQ(vnBindBlendState(context_, blend), VN_SUCCESS);
        EXPECT_EQ(vnBindDepthStencilState(context_, depth), VN_SUCCESS);
        if (text) *text = explain();
        EXPECT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
        VnStatistics statistics{};
        EXPECT_EQ(vnGetStatistics(context_, &statistics), VN_SUCCESS);
        return statistics;
    }

    // A triangle whose borders cut 2x2 quads.
    static constexpr const char* kOddVertex = R"(#version 450
layout(location = 0) out vec2 uv;
void main() { uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1); gl_Position = vec4(uv * 1.3 - 0.9, 0.5, 1.0); })";
    static constexpr uint32_t kSize = 64, kPixels = kSize * kSize;
};

TEST_F(Explain, NoBlendingReadsNoDestination) {
    VnBlendStateDesc desc{};
    desc.attachments[0].enable = 1;
    VnBlendState blend{};
    ASSERT_EQ(vnCreateBlendState(device_, &desc, &blend), VN_SUCCESS);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    std::string without, with;
    EXPECT_EQ(run(white, {}, {}, &without).destinationReads, 0u);
    EXPECT_EQ(run(white, blend, {}, &with).destinationReads, kPixels);
    EXPECT_NE(with, without);
    EXPECT_THAT(without, HasSubstr("left out  reading colour 0"));
}

TEST_F(Explain, NoDepthTestReadsNoDepth) {
    VnDepthStencilStateDesc desc{};
    desc.depthTest = 1;
    // Not decided by what is known of the cleared depths.
    desc.depthCompare = VK_COMPARE_OP_NOT_EQUAL;
    VnDepthStencilState depth{};
    ASSERT_EQ(vnCreateDepthStencilState(device_, &desc, &depth), VN_SUCCESS);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    std::string without, with;
    EXPECT_EQ(run(white, {}, {}, &without).depthReads, 0u);
    EXPECT_GT(run(white, {}, depth, &with).depthReads, 0u);
    EXPECT_THAT(without, HasSubstr("left out  depth and stencil tests"));
    EXPECT_NE(with, without);
}

TEST_F(Explain, HelperLanesRunOnlyForDerivatives) {
    const VnProgram plain = program(kOddVertex, R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0, 1); })");
    const VnProgram derivatives = program(kOddVertex, R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(fwidth(uv), 0, 1); })");
    std::string without, with;
    EXPECT_EQ(run(plain, {}, {}, &without).helperInvocations, 0u);
    EXPECT_GT(run(derivatives, {}, {}, &with).helperInvocations, 0u);
    EXPECT_THAT(without, HasSubstr("left out  helper invocations: nothing in the program depends on"));
    EXPECT_THAT(with, HasSubstr("runs      helper invocations, where 2x2 pixels are covered in part: the program takes "
                                "derivatives"));
}

TEST_F(Explain, ImagesOfOneLevelNeedNoHelperLanes) {
    const auto helpers = [&](uint32_t levels, VkFilter minFilter, const char* body, std::vector<uint32_t>& pixels) {
        VnImageDesc desc{};
        desc.width = desc.height = 4;
        desc.mipLevels = levels;
        VnImage checkers{};
        EXPECT_EQ(vnCreateImage(device_, &desc, &checkers), VN_SUCCESS) << lastError();
        std::vector<uint32_t> texels(16);
        for (uint32_t k = 0; k < 16; ++k) texels[k] = k * 0x0F050301u;
        EXPECT_EQ(vnUpdateImage(context_, checkers, nullptr, texels.data(), 64), VN_SUCCESS) << lastError();
        VnSamplerDesc samplerDesc{};
        samplerDesc.magFilter = VK_FILTER_LINEAR;
        samplerDesc.minFilter = minFilter;
        VnSampler sampler{};
        EXPECT_EQ(vnCreateSampler(device_, &samplerDesc, &sampler), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindTexture(context_, 0, 0, 0, view(checkers), sampler), VN_SUCCESS) << lastError();
        const VnProgram shading = program(kOddVertex, std::string(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D tex;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(tex, uv * 0.1))") + body + "; }");
        const uint64_t count = run(shading).helperInvocations;
        pixels = drawFullScreen(image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize), kSize, kSize, shading);
        return count;
    };
    // Magnified all over: the picture is the same.
    std::vector<uint32_t> without, with;
    EXPECT_EQ(helpers(1, VK_FILTER_LINEAR, "", without), 0u);
    EXPECT_GT(helpers(2, VK_FILTER_LINEAR, "", with), 0u);
    EXPECT_EQ(without, with);
    EXPECT_GT(helpers(1, VK_FILTER_NEAREST, "", with), 0u);
    EXPECT_EQ(without, with);
    EXPECT_GT(helpers(1, VK_FILTER_LINEAR, " + fwidth(uv.x) * 0.0", with), 0u);
    EXPECT_EQ(without, with);
}

TEST_F(Explain, EqualWNeedsNoPerspectiveDivide) {
    const auto withW = [](const char* w) {
        return std::string(R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    float w = )") +
               w + R"(;
    gl_Position = vec4((uv * 4.0 - 1.0) * w, 0.5 * w, w);
})";
    };
    const char* reads = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0, 1); })";
    EXPECT_EQ(run(program(withW("2.0"), reads)).perspectiveDivides, 0u);
    EXPECT_EQ(run(program(withW("float(gl_VertexIndex + 1)"), reads)).perspectiveDivides, kPixels);
}

TEST_F(Explain, WithoutAFragmentStageNoneRuns) {
    std::string text;
    EXPECT_EQ(run(program(kFullScreenVertex, ""), {}, {}, &text).fragmentInvocations, 0u);
    EXPECT_THAT(text, HasSubstr("fragment"));
}

TEST_F(Explain, UnreadVaryingsAreNotComputed) {
    std::string text;
    run(program(R"(#version 450
layout(location = 0) out vec4 unread;
void main() {
    unread = vec4(sin(float(gl_VertexIndex)));
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0);
})",
                kWhiteFragment),
        {}, {}, &text);
    EXPECT_THAT(text, HasSubstr("4")) << "four scalar outputs are left out:\n" << text;
}

TEST_F(Explain, WhatALaterOpaquePrimitiveHidesIsNotRun) {
    const char* pushed = R"(#version 450
layout(push_constant) uniform Push { vec4 value; };
layout(location = 0) out vec4 color;
void main() { color = value; })";
    const char* discards = R"(#version 450
layout(push_constant) uniform Push { vec4 value; };
layout(location = 0) out vec4 color;
void main() { if (gl_FragCoord.x < 8.0) discard; color = value; })";
    VnBlendStateDesc blendDesc{};
    blendDesc.attachments[0] = {1,
                                VK_BLEND_FACTOR_ONE,
                                VK_BLEND_FACTOR_ONE,
                                VK_BLEND_OP_ADD,
                                VK_BLEND_FACTOR_ONE,
                                VK_BLEND_FACTOR_ONE,
                                VK_BLEND_OP_ADD,
                                0};
    VnBlendState add{};
    ASSERT_EQ(vnCreateBlendState(device_, &blendDesc, &add), VN_SUCCESS);
    const struct {
        const char* fragment;  // of the second draw
        VnBlendState blend;
        uint64_t invocations;
        uint32_t left, right;  // pixels on the left border and elsewhere
    } cases[] = {{pushed, {}, kPixels, 0xFF00FF00u, 0xFF00FF00u},
                 {pushed, add, 2 * kPixels, 0xFF00FFFFu, 0xFF00FFFFu},
                 {discards, {}, 2 * kPixels - 8 * kSize, 0xFF0000FFu, 0xFF00FF00u}};
    for (const auto& item : cases) {
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
        VnPassDesc pass = passOn(target);
        ASSERT_EQ(vnResetStatistics(context_), VN_SUCCESS);
        ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
        const float red[] = {1, 0, 0, 1}, green[] = {0, 1, 0, 1};
        ASSERT_EQ(vnBindBlendState(context_, {}), VN_SUCCESS);
        ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, pushed)), VN_SUCCESS);
        ASSERT_EQ(vnPushConstants(context_, 0, red, sizeof red), VN_SUCCESS);
        ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
        ASSERT_EQ(vnBindBlendState(context_, item.blend), VN_SUCCESS);
        ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, item.fragment)), VN_SUCCESS);
        ASSERT_EQ(vnPushConstants(context_, 0, green, sizeof green), VN_SUCCESS);
        ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
        VnStatistics statistics{};
        ASSERT_EQ(vnGetStatistics(context_, &statistics), VN_SUCCESS);
        EXPECT_GE(statistics.fragmentInvocations, item.invocations);
        EXPECT_LE(statistics.fragmentInvocations, item.invocations + 8 * kSize);
        const std::vector<uint32_t> pixels = read(target, kSize, kSize);
        for (uint32_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i], i % kSize < 8 ? item.left : item.right) << i;
    }
}

// Work is done as often as its values change: the draw's once, what follows from flat inputs at the vertices.
TEST_F(Explain, TellsRates) {
    const VnProgram flat = program(R"(#version 450
layout(location = 0) flat out uint id;
layout(location = 1) out float x;
void main() {
    id = gl_VertexIndex * 16 + 9;
    x = float(gl_VertexIndex & 1);
    gl_Position = vec4((gl_VertexIndex & 1) * 4.0 - 1.0, (gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0);
})",
                                   R"(#version 450
layout(location = 0) flat in uint id;
layout(location = 1) in float x;
layout(push_constant) uniform Push { vec4 scale; };
layout(location = 0) out vec4 color;
void main() {
    float root = sqrt(float(id));
    bool small = id * id % 7u < 5u;
    color = vec4(root / 3.0, small ? 1.0 : 0.5, sqrt(scale.z * scale.w) * x * 0.0, 1.0);
})");
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, flat), VN_SUCCESS);
    const float scale[] = {1, 1, 1, 1};
    ASSERT_EQ(vnPushConstants(context_, 0, scale, sizeof scale), VN_SUCCESS);
    const std::string text = explain();
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_THAT(text,
                HasSubstr("operations of the fragment program, once per vertex: they depend on flat inputs alone"));
    EXPECT_THAT(text, HasSubstr("of the fragment program, once per draw and thread"));
    EXPECT_THAT(text, HasSubstr("operations of the fragment program by rate, draw "));
    EXPECT_THAT(text, HasSubstr("operations of the vertex program by rate, "));
    EXPECT_THAT(text, HasSubstr(" (cost "));
    // The first vertex provokes: its id is 9, root 3, and 81 % 7 < 5.
    EXPECT_THAT(read(target, kSize, kSize), testing::Each(0xFF00FFFFu));
}

TEST_F(Explain, JsonTellsTheSameFacts) {
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    std::string lines;
    const nlohmann::json facts = nlohmann::json::parse(explain(VN_EXPLAIN_JSON));
    for (const auto& fact : facts) {
        EXPECT_EQ(fact["what"].get<std::string>().find(": "), std::string::npos) << "a line is cut there";
        lines += (fact["runs"] ? "runs      " : "left out  ") + fact["what"].get<std::string>() + ": " +
                 fact["why"].get<std::string>() + "\n";
    }
    EXPECT_EQ(lines, explain());
    const bool rated = std::any_of(facts.begin(), facts.end(), [](const nlohmann::json& fact) {
        return fact.contains("rates") && fact["rates"].contains("invocation") &&
               fact["rates"]["invocation"]["cost"].get<int>() > 0 && fact["lanes"].get<int>() > 0;
    });
    EXPECT_TRUE(rated) << "what a program costs per invocation";
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
}

TEST_F(Explain, ColorsThatStayTellWhy) {
    VnPassDesc pass = passOn(image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize));
    for (VnAttachment* more : {&pass.colors[1], &pass.colors[3]}) {
        *more = pass.colors[0];
        more->view = view(image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize));
    }
    VnBlendStateDesc desc{};
    desc.independent = 1;
    desc.attachments[1].writeMaskOff = 0xF;
    VnBlendState masked{};
    ASSERT_EQ(vnCreateBlendState(device_, &desc, &masked), VN_SUCCESS);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kWhiteFragment)), VN_SUCCESS);
    ASSERT_EQ(vnBindBlendState(context_, masked), VN_SUCCESS);
    const std::string text = explain();
    EXPECT_THAT(text, HasSubstr("left out  writes to colour 1: its write mask is empty\n"));
    EXPECT_THAT(text, HasSubstr("left out  writes to colour 2: there is no attachment\n"));
    EXPECT_THAT(text, HasSubstr("left out  writes to colour 3: the program does not write it\n"));
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
}

TEST_F(Explain, DepthBiasByItsFactors) {
    const VnPassDesc pass = passOn(image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize));
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kWhiteFragment)), VN_SUCCESS);
    EXPECT_THAT(explain(), HasSubstr("left out  depth bias: it is off\n"));
    for (const float slope : {0.0f, 2.0f}) {
        VnRasterStateDesc desc{};
        desc.depthBias = 1;
        desc.depthBiasSlope = slope;
        VnRasterState biased{};
        ASSERT_EQ(vnCreateRasterState(device_, &desc, &biased), VN_SUCCESS);
        ASSERT_EQ(vnBindRasterState(context_, biased), VN_SUCCESS);
        EXPECT_THAT(explain(), HasSubstr(slope != 0 ? "runs      depth bias: it is on\n"
                                                    : "left out  depth bias: both factors are zero\n"));
    }
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
}

TEST_F(Explain, AFrameTellsWhatItCounted) {
    const VnStatistics statistics = run(program(kFullScreenVertex, kWhiteFragment));
    const nlohmann::json facts = nlohmann::json::parse(explain(VN_EXPLAIN_JSON, vnExplainFrame));
    const auto countOf = [&](const std::string& what) -> int64_t {
        for (const auto& fact : facts)
            if (fact["what"].get<std::string>().starts_with(what))
                return fact["runs"] ? fact["count"].get<int64_t>() : 0;
        ADD_FAILURE() << "nothing is said of " << what;
        return -1;
    };
    EXPECT_EQ(countOf("draws"), 1);
    EXPECT_EQ(countOf("dispatches"), 0);
    EXPECT_EQ(countOf("fragment programs"), static_cast<int64_t>(statistics.fragmentInvocations));
    EXPECT_EQ(countOf("helper invocations"), 0);
    EXPECT_EQ(countOf("reading colours back"), 0);
    EXPECT_THAT(explain(VN_EXPLAIN_TEXT, vnExplainFrame), HasSubstr("left out  perspective division: "));
}

TEST_F(Explain, UnknownFormatsAreRefused) {
    EXPECT_EQ(vnExplainFrame(context_, static_cast<VnExplainFormat>(2), nullptr, 0, nullptr),
              VN_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(lastError(), HasSubstr("format is 2"));
}

TEST_F(Explain, RulesOfLeavingOutCanBeSwitchedOff) {
    VnDeviceDesc desc{};
    desc.skips = "helper_invocations=off, idle_state=off";
    VnDevice device = nullptr;
    ASSERT_EQ(vnCreateDevice(&desc, &device), VN_SUCCESS);
    std::swap(device, device_);
    VnContext context = context_;
    ASSERT_EQ(vnCreateContext(device_, nullptr, &context_), VN_SUCCESS);
    VnBlendStateDesc replace{};
    replace.attachments[0] = {1,
                              VK_BLEND_FACTOR_ONE,
                              VK_BLEND_FACTOR_ZERO,
                              VK_BLEND_OP_ADD,
                              VK_BLEND_FACTOR_ONE,
                              VK_BLEND_FACTOR_ZERO,
                              VK_BLEND_OP_ADD,
                              0};
    VnBlendState blend{};
    ASSERT_EQ(vnCreateBlendState(device_, &replace, &blend), VN_SUCCESS);
    std::string text;
    const VnStatistics statistics = run(program(kOddVertex, kWhiteFragment), blend, {}, &text);
    EXPECT_GT(statistics.helperInvocations, 0u);
    EXPECT_GT(statistics.destinationReads, 0u);
    EXPECT_THAT(text, HasSubstr("covered in part: rule helper_invocations is off"));
    EXPECT_THAT(text,
                HasSubstr("runs      tests, blending and logic operations that change nothing: rule idle_state is "
                          "off"));
    vnDestroyDevice(device_);
    device_ = device;
    context_ = context;

    std::string message;
    desc.skips = "hidden_works=off";
    desc.messageUser = &message;
    desc.message = [](void* user, VnSeverity, const char* error) { *static_cast<std::string*>(user) = error; };
    EXPECT_EQ(vnCreateDevice(&desc, &device), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(message, HasSubstr("\"hidden_works\" is no rule of what is left out; there are: unread_outputs, "));
}

TEST_F(Explain, ACombinationIsPlannedOnce) {
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    EXPECT_EQ(run(white).plans, 1u);
    EXPECT_EQ(run(white).plans, 0u);
}

TEST_F(Explain, NeedsAPassAndAProgram) {
    EXPECT_EQ(vnExplain(context_, VN_EXPLAIN_TEXT, nullptr, 0, nullptr), VN_ERROR_INVALID_STATE);
    EXPECT_THAT(lastError(), HasSubstr("no pass is open"));
}

}  // namespace
}  // namespace vernier::test
