// Programs with a geometry shader through vernier.h.
#include <algorithm>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

constexpr uint32_t kSide = 32;

constexpr const char* kPoints = R"(#version 450
void main() { gl_Position = vec4(float(gl_VertexIndex) - 0.5, 0.0, 0.5, 1.0); })";

// A square of half the target around each point, as large as a constant and a buffer say.
constexpr const char* kSquares = R"(#version 450
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(constant_id = 1) const float kScale = 1.0;
layout(set = 0, binding = 2) uniform Sizes { vec4 size; };
void main() {
    for (int v = 0; v < 4; ++v) {
        gl_Position = gl_in[0].gl_Position + vec4(vec2(v & 1, v >> 1) * 2.0 - 1.0, 0.0, 0.0) * size * kScale;
        EmitVertex();
    }
})";

class GeometryProgram : public ApiTest {
  protected:
    VnProgramDesc squares() {
        VnProgramDesc desc{};
        desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, kPoints);
        desc.geometry = shader(VK_SHADER_STAGE_GEOMETRY_BIT, kSquares, {{1, 0x3F000000}});  // 0.5
        desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, kWhiteFragment);
        return desc;
    }
    VnProgram made(const VnProgramDesc& desc) {
        VnProgram result{};
        EXPECT_EQ(vnCreateProgram(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
};

TEST_F(GeometryProgram, DrawsCountsAndExplains) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide);
    const float size[4] = {0.5f, 1.0f, 0, 0};
    const VnBuffer sizes = buffer(size, sizeof size);
    VnQuery query{};
    ASSERT_EQ(vnCreateQuery(device_, VN_QUERY_STATISTICS, &query), VN_SUCCESS);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, made(squares())), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnSetTopology(context_, VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 0), VN_SUCCESS);
    ASSERT_EQ(vnBeginQuery(context_, query), VN_SUCCESS);
    // What the stage reads must be bound like anything else.
    EXPECT_EQ(vnDraw(context_, 2, 1, 0, 0), VN_ERROR_INVALID_STATE);
    EXPECT_THAT(lastError(), HasSubstr("set 0, binding 2"));
    ASSERT_EQ(vnBindBuffer(context_, 0, 2, 0, sizes, 0, 0), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 2, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndQuery(context_, query), VN_SUCCESS);
    std::string text(1 << 14, '\0');
    size_t length = 0;
    ASSERT_EQ(vnExplain(context_, VN_EXPLAIN_TEXT, text.data(), text.size(), &length), VN_SUCCESS);
    EXPECT_THAT(text, HasSubstr("geometry program, once per primitive: points in, triangleStrip out, at most 4"));
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS) << lastError();
    const std::vector<uint32_t> texels = read(target, kSide, kSide);
    // Squares of a quarter of the width and half of the height.
    EXPECT_EQ(std::count(texels.begin(), texels.end(), ~0u), static_cast<ptrdiff_t>(2 * kSide / 4 * kSide / 2));
    EXPECT_EQ(texels[16 * kSide + 8], ~0u);
    EXPECT_EQ(texels[16 * kSide + 24], ~0u);
    VnQueryResult counts{};
    ASSERT_EQ(vnGetQueryResult(context_, query, &counts), VN_SUCCESS);
    EXPECT_EQ(counts.inputPrimitives, 2u);
    EXPECT_EQ(counts.geometryInvocations, 2u);
    EXPECT_EQ(counts.geometryPrimitives, 4u);
    EXPECT_EQ(counts.clippingInvocations, 4u);
    VnStatistics statistics{};
    ASSERT_EQ(vnGetStatistics(context_, &statistics), VN_SUCCESS);
    EXPECT_EQ(statistics.geometryInvocations, 2u);
}

TEST_F(GeometryProgram, WhatDoesNotFitIsRefused) {
    VnProgram result{};
    VnProgramDesc desc = squares();
    desc.geometry = desc.fragment;
    EXPECT_EQ(vnCreateProgram(device_, &desc, &result), VN_ERROR_INVALID_HANDLE);
    EXPECT_THAT(lastError(), HasSubstr("geometry shader"));
    desc = squares();
    desc.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, "#version 450\nvoid main() {}");
    EXPECT_EQ(vnCreateProgram(device_, &desc, &result), VN_ERROR_INVALID_ARGUMENT);
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, made(squares())), VN_SUCCESS) << lastError();
    EXPECT_NE(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("it takes points, the topology is of triangles"));
    EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
