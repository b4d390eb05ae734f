// Barycentric coordinates and values of single vertices as inputs (GL_EXT_fragment_shader_barycentric): weights by
// hand, the order of vertices in every topology, clipped triangles, lines and points.
#include <array>
#include <cmath>
#include <cstring>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

constexpr uint32_t kSide = 16;
using Texels = std::vector<std::array<float, 4>>;

/// Corners in clip space, by number; what vertices are told apart by is their number.
std::string vertices(const std::string& corners) {
    return R"(#version 450
layout(location = 0) out vec2 number;
const vec4 kCorners[] = vec4[]()" +
           corners + R"();
void main() {
    gl_Position = kCorners[gl_VertexIndex];
    gl_PointSize = 5.0;
    number = vec2(float(gl_VertexIndex) + 10.0, 0.1);
})";
}

std::string fragments(const std::string& value) {
    return R"(#version 450
#extension GL_EXT_fragment_shader_barycentric : require
layout(location = 0) pervertexEXT in vec2 number[];
layout(location = 0) out vec4 color;
void main() { color = )" +
           value + "; }";
}

const char* const kNumbers = "vec4(number[0].x, number[1].x, number[2].x, number[1].y)";
const char* const kWeights = "vec4(gl_BaryCoordEXT, 1.0)";

class Barycentric : public ApiTest {
  protected:
    Texels drawn(const std::string& corners, uint32_t count, const std::string& value,
                 VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, bool provokingLast = false) {
        const VnImage target = image(VK_FORMAT_R32G32B32A32_SFLOAT, kSide, kSide);
        VnRasterStateDesc raster{};
        raster.provokingVertexLast = provokingLast ? 1 : 0;
        VnRasterState state{};
        EXPECT_EQ(vnCreateRasterState(device_, &raster, &state), VN_SUCCESS) << lastError();
        const VnPassDesc pass = passOn(target);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindProgram(context_, program(vertices(corners), fragments(value))), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindRasterState(context_, state), VN_SUCCESS);
        EXPECT_EQ(vnSetTopology(context_, topology, 0), VN_SUCCESS);
        EXPECT_EQ(vnDraw(context_, count, 1, 0, 0), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS) << lastError();
        Texels texels(kSide * kSide);
        EXPECT_EQ(vnReadImage(context_, target, nullptr, texels.data(), texels.size() * 16), VN_SUCCESS) << lastError();
        return texels;
    }
    static const std::array<float, 4>& at(const Texels& texels, uint32_t x, uint32_t y) {
        return texels[y * kSide + x];
    }
};

// A triangle that covers the target: its corners are 32 pixels apart.
const char* const kWhole = "vec4(-1, -1, 0.5, 1), vec4(3, -1, 0.5, 1), vec4(-1, 3, 0.5, 1)";

TEST_F(Barycentric, WeightsByHand) {
    for (const char* value : {kWeights, "vec4(gl_BaryCoordNoPerspEXT, 1.0)"}) {
        const Texels texels = drawn(kWhole, 3, value);
        for (uint32_t y = 0; y < kSide; ++y) {
            for (uint32_t x = 0; x < kSide; ++x) {
                const float right = (x + 0.5f) / 32, down = (y + 0.5f) / 32;
                EXPECT_EQ(at(texels, x, y), (std::array{1 - right - down, right, down, 1.0f})) << x << ", " << y;
            }
        }
    }
}

TEST_F(Barycentric, PerspectiveAndItsAbsence) {
    // The second vertex is three times as far away: b1 = (l1 / 3) / (l0 + l1 / 3 + l2).
    const std::string corners = "vec4(-1, -1, 0.5, 1), vec4(9, -3, 1.5, 3), vec4(-1, 3, 0.5, 1)";
    const Texels smooth = drawn(corners, 3, kWeights), linear = drawn(corners, 3, "vec4(gl_BaryCoordNoPerspEXT, 1.0)");
    for (uint32_t i = 0; i < kSide; ++i) {
        const float l1 = at(linear, i, 3)[1], b1 = at(smooth, i, 3)[1];
        EXPECT_NEAR(l1, (static_cast<float>(i) + 0.5f) / 32, 1e-6);
        EXPECT_NEAR(b1, l1 / 3 / (1 - l1 + l1 / 3), 1e-6);
        const std::array<float, 4>& b = at(smooth, i, 3);
        EXPECT_NEAR(b[0] + b[1] + b[2], 1, 0x1p-22);
    }
}

TEST_F(Barycentric, VerticesInTheOrderOfTheProvokingOne) {
    // Bands from left to right, a square in pixels 4n to 4n + 3 of two triangles; the second one is right and below.
    const std::string strip =
        "vec4(-1, -1, 0.5, 1), vec4(-1, 1, 0.5, 1), vec4(0, -1, 0.5, 1), vec4(0, 1, 0.5, 1), vec4(1, -1, 0.5, 1)";
    const auto strips = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, fans = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
    Texels texels = drawn(strip, 5, kNumbers, strips);
    EXPECT_EQ(at(texels, 1, 1), (std::array{10.0f, 11.0f, 12.0f, 0.1f}));
    EXPECT_EQ(at(texels, 6, 14), (std::array{11.0f, 13.0f, 12.0f, 0.1f})) << "odd";
    EXPECT_EQ(at(texels, 9, 1), (std::array{12.0f, 13.0f, 14.0f, 0.1f}));
    texels = drawn(strip, 5, kNumbers, strips, true);
    EXPECT_EQ(at(texels, 1, 1), (std::array{10.0f, 11.0f, 12.0f, 0.1f}));
    EXPECT_EQ(at(texels, 6, 14), (std::array{12.0f, 11.0f, 13.0f, 0.1f})) << "odd, the provoking vertex last";
    const std::string fan = "vec4(-1, -1, 0.5, 1), vec4(1, -1, 0.5, 1), vec4(1, 1, 0.5, 1), vec4(-1, 1, 0.5, 1)";
    texels = drawn(fan, 4, kNumbers, fans);
    EXPECT_EQ(at(texels, 13, 2), (std::array{11.0f, 12.0f, 10.0f, 0.1f}));
    EXPECT_EQ(at(texels, 2, 13), (std::array{12.0f, 13.0f, 10.0f, 0.1f}));
    texels = drawn(fan, 4, kNumbers, fans, true);
    EXPECT_EQ(at(texels, 2, 13), (std::array{10.0f, 12.0f, 13.0f, 0.1f}));
}

TEST_F(Barycentric, OfTheWholeTriangleBehindACut) {
    // The third vertex is behind the near plane: z = -0.5 there.
    const std::string cut = "vec4(-1, -1, 0.5, 1), vec4(3, -1, 0.5, 1), vec4(-1, 3, -0.5, 1)";
    const Texels whole = drawn(kWhole, 3, kWeights), weights = drawn(cut, 3, kWeights),
                 numbers = drawn(cut, 3, kNumbers);
    for (uint32_t x = 0; x < kSide; ++x) {
        for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(at(weights, x, 2)[c], at(whole, x, 2)[c], 1e-6) << x;
        EXPECT_EQ(at(numbers, x, 2), (std::array{10.0f, 11.0f, 12.0f, 0.1f}));
    }
}

TEST_F(Barycentric, MixValuesAsInterpolationDoes) {
    const Texels mixed =
        drawn(kWhole, 3, "vec4(dot(gl_BaryCoordEXT, vec3(number[0].x, number[1].x, number[2].x)), 0.0, 0.0, 1.0)");
    for (uint32_t i = 0; i < kSide; ++i) {
        const float along = (static_cast<float>(i) + 0.5f) / 32;
        EXPECT_NEAR(at(mixed, i, i)[0], 10 + along + 2 * along, 1e-5);
    }
}

TEST_F(Barycentric, LinesAndPoints) {
    const std::string ends = "vec4(-1, 0.0625, 0.5, 1), vec4(1, 0.0625, 0.5, 1)";
    const Texels line = drawn(ends, 2, kWeights, VK_PRIMITIVE_TOPOLOGY_LINE_LIST);
    for (const uint32_t x : {1u, 8u, 14u}) {
        EXPECT_NEAR(at(line, x, 8)[1], (static_cast<float>(x) + 0.5f) / 16, 1e-6);
        EXPECT_NEAR(at(line, x, 8)[0], 1 - (static_cast<float>(x) + 0.5f) / 16, 1e-6);
        EXPECT_EQ(at(line, x, 8)[2], 0);
    }
    const Texels point = drawn("vec4(0, 0, 0.5, 1)", 1, kWeights, VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
    EXPECT_EQ(at(point, 8, 8), (std::array{1.0f, 0.0f, 0.0f, 1.0f}));
}

}  // namespace
}  // namespace vernier::test
