// Tessellation through vernier.h: programs with control and evaluation shaders, their resources, counts, errors.
#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

constexpr uint32_t kSide = 64;

const char* const kCorners = R"(#version 450
void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0, 0.5, 1.0); })";

const char* const kControl = R"(#version 450
layout(vertices = 4) out;
layout(push_constant) uniform Push { float level; float radius; } push;
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[gl_InvocationID] = push.level;
    if (gl_InvocationID < 2) gl_TessLevelInner[gl_InvocationID] = push.level;
})";

/// The square becomes a disc: rings of it become circles.
const char* const kEvaluation = R"(#version 450
layout(quads, equal_spacing, cw) in;
layout(push_constant) uniform Push { float level; float radius; } push;
layout(set = 0, binding = 0) uniform Colors { vec4 color; } colors;
layout(location = 0) out vec4 color;
void main() {
    vec2 p = gl_TessCoord.xy * 2.0 - 1.0;
    float longest = max(abs(p.x), abs(p.y)), length = length(p);
    gl_Position = vec4(length > 0.0 ? p * (longest / length) * push.radius : p, 0.5, 1.0);
    color = colors.color;
})";

const char* const kColor = R"(#version 450
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = color; })";

class Tessellation : public ApiTest {
  protected:
    VnProgramDesc disc() {
        VnProgramDesc desc{};
        desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, kCorners);
        desc.control = shader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, kControl);
        desc.evaluation = shader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, kEvaluation);
        desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, kColor);
        return desc;
    }
    VnProgram made(const VnProgramDesc& desc) {
        VnProgram program{};
        EXPECT_EQ(vnCreateProgram(device_, &desc, &program), VN_SUCCESS) << lastError();
        return program;
    }
    VnImage record(VnProgram program, float level, float radius, uint32_t instances = 1) {
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide);
        const float color[4] = {0, 1, 0, 1};
        const float push[2] = {level, radius};
        const VnPassDesc pass = passOn(target);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindProgram(context_, program), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindBuffer(context_, 0, 0, 0, buffer(color, sizeof color), 0, 0), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnPushConstants(context_, 0, push, sizeof push), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnSetTopology(context_, VK_PRIMITIVE_TOPOLOGY_PATCH_LIST, 0), VN_SUCCESS);
        EXPECT_EQ(vnSetPatchVertices(context_, 4), VN_SUCCESS);
        EXPECT_EQ(vnDraw(context_, 4, instances, 0, 0), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS) << lastError();
        return target;
    }
    std::vector<uint32_t> draw(VnProgram program, float level, float radius) {
        return read(record(program, level, radius), kSide, kSide);
    }
    static double areaOf(const std::vector<uint32_t>& pixels) {
        double count = 0;
        for (const uint32_t pixel : pixels) count += pixel == 0xFF00FF00 ? 1 : 0;
        return count;
    }
};

TEST_F(Tessellation, ASquareBecomesADisc) {
    const VnProgram program = made(disc());
    const double exact = 3.14159265 * 28 * 28;
    // Few segments leave a part of the disc out: with n of them along a side, the polygon has 4n corners.
    EXPECT_NEAR(areaOf(draw(program, 1, 28.0f / 32)), 2.0 * 28 * 28, 60);
    EXPECT_NEAR(areaOf(draw(program, 2, 28.0f / 32)), 2.828 * 28 * 28, 60);
    EXPECT_NEAR(areaOf(draw(program, 32, 28.0f / 32)), exact, 25);
    EXPECT_EQ(areaOf(draw(program, 0, 28.0f / 32)), 0);
}

TEST_F(Tessellation, WindingIsSeenFromTheOriginOfTheDomain) {
    const VnProgram program = made(disc());
    for (const int lowerLeft : {0, 1}) {
        VnRasterStateDesc desc{};
        desc.cullMode = VK_CULL_MODE_BACK_BIT;
        desc.domainLowerLeft = lowerLeft;
        VnRasterState state{};
        ASSERT_EQ(vnCreateRasterState(device_, &desc, &state), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnBindRasterState(context_, state), VN_SUCCESS) << lastError();
        // Clockwise with v downwards, as on the screen, is the back.
        EXPECT_EQ(areaOf(draw(program, 4, 0.5f)) > 0, lowerLeft != 0);
    }
}

TEST_F(Tessellation, CountsOfPatchesAndPoints) {
    const VnProgram program = made(disc());
    VnStatistics statistics{};
    EXPECT_EQ(vnResetStatistics(context_), VN_SUCCESS);
    record(program, 5, 0.5f, 3);
    EXPECT_EQ(vnGetStatistics(context_, &statistics), VN_SUCCESS);
    EXPECT_EQ(statistics.controlPatches, 3u);
    EXPECT_EQ(statistics.evaluationInvocations, 3u * 36);
    VnQuery query{};
    ASSERT_EQ(vnCreateQuery(device_, VN_QUERY_STATISTICS, &query), VN_SUCCESS);
    ASSERT_EQ(vnBeginQuery(context_, query), VN_SUCCESS);
    record(program, 4, 0.5f, 2);
    ASSERT_EQ(vnEndQuery(context_, query), VN_SUCCESS);
    VnQueryResult result{};
    ASSERT_EQ(vnGetQueryResult(context_, query, &result), VN_SUCCESS);
    EXPECT_EQ(result.controlPatches, 2u);
    EXPECT_EQ(result.evaluationInvocations, 2u * 25);
    EXPECT_EQ(result.clippingInvocations, 2u * 32);
    EXPECT_EQ(result.geometryInvocations, 0u);
}

TEST_F(Tessellation, WhatIsMissingIsNamed) {
    VnProgram program{};
    VnProgramDesc desc = disc();
    desc.evaluation = {};
    EXPECT_NE(vnCreateProgram(device_, &desc, &program), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("evaluation"));
    desc = disc();
    desc.control = desc.evaluation;
    EXPECT_NE(vnCreateProgram(device_, &desc, &program), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("control shader"));
    for (const uint32_t vertices : {0u, 33u}) EXPECT_NE(vnSetPatchVertices(context_, vertices), VN_SUCCESS);
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, made(disc())), VN_SUCCESS);
    ASSERT_EQ(vnSetTopology(context_, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0), VN_SUCCESS);
    EXPECT_NE(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("patches"));
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
