// W: w near zero, huge and tiny coordinates, NaN and infinities in positions.
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"

#include <cmath>
#include <limits>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

std::vector<ColorVertex> scaledVertices(int exponent) {
    std::vector<ColorVertex> vertices{
        {{-0.8f, -0.9f, 0.2f, 1}, {1, 0, 0, 1}},        {{2.7f, -1.9f, 1.1f, 3}, {0, 1, 0, 1}},
        {{-0.9f, 1.55f, 0.9f, 1.75f}, {0, 0, 1, 1}},    {{0.9f, 0.85f, 0.1f, 1}, {1, 1, 0, 1}},
        {{-0.6f, 0.97f, 0.5f, 1}, {0, 1, 1, 1}},        {{1.9f, -1.3f, 1.5f, 2.5f}, {1, 0, 1, 1}},
        {{0.05f, 0.4f, -0.25f, 0.5f}, {1, 0.5f, 0, 1}}, {{3.5f, 3.9f, 2, 4}, {0.25f, 0.5f, 1, 1}},
        {{-0.2f, 1.9f, 1, 2}, {0, 0.75f, 0.25f, 1}},
    };
    for (ColorVertex& v : vertices) {
        for (float& c : v.position) c = std::ldexp(c, exponent);
    }
    return vertices;
}

// The same picture for every scale; the plain one is judged by the oracle.
void scales(CaseInput& input, std::string_view name, std::initializer_list<int> exponents) {
    const size_t plain = addForOracle(input, colorScene(name, scaledVertices(0), kTarget));
    for (const int exponent : exponents) {
        judgeSame(input, input.scene(colorScene(name, scaledVertices(exponent), kTarget)), plain,
                  "scaling clip coordinates by 2^" + std::to_string(exponent) + " changes no exact result");
    }
}

// Products of two coordinates overflow.
void w06(CaseInput& input) {
    scales(input, "W06", {20, 63, 100, 120, 125});
}
// Products of two coordinates are denormal or 0.
void w07(CaseInput& input) {
    scales(input, "W07", {-30, -63, -100});
}

CountOptions plainCount() {
    CountOptions options;
    options.extent = kTarget;
    return options;
}

// Counts of triangles in clip coordinates against their homogeneous edge functions. With `pairs`, triangles come in
// twos that share the edge between their first two vertices: of a sample that only this edge leaves open, exactly one
// of the two has it.
size_t countsOf(CaseInput& input, std::string_view name, const std::vector<ClipTriangle>& triangles) {
    const size_t scene = input.scene(countScene(name, flatten(triangles), plainCount()));
    judgeSides(input, scene, triangles, kTarget);
    return scene;
}

// One vertex with w = 0, at infinity, beside triangles that share its edges.
void w01(CaseInput& input) {
    const ClipPosition a{-0.8f, -0.7f, 0.5f, 1}, b{0.1f, 0.85f, 0.25f, 1};
    for (const ClipPosition far : {ClipPosition{3, 0.5f, 0.25f, 0},
                                   {2, -1, 0, 0},
                                   {0.001f, 0.0003f, -0.0001f, 0},
                                   {1e20f, 3e19f, 1e19f, 0},
                                   {-0.5f, -4, 0.125f, -0.0f}}) {
        const ClipPosition c{0.9f, 0.95f, 0.5f, 1};
        countsOf(input, "W01", {{a, b, far}, {b, far, c}});
        countsOf(input, "W01_turned", {{far, a, b}, {far, c, b}});
    }
    judgeEmpty(input,
               input.scene(countScene("W01_all", flatten({{ClipPosition{1, 0, 0, 0}, {0, 1, 0, 0}, {-1, -1, 0, 0}}}),
                                      plainCount())),
               plainCount(), "all vertices are at infinity");
}

// w of +-2^-126 and of denormals.
void w02(CaseInput& input) {
    const ClipPosition a{-0.8f, -0.7f, 0.5f, 1}, b{0.1f, 0.85f, 0.25f, 1}, c{0.9f, 0.95f, 0.5f, 1};
    for (const float w : {0x1p-126f, -0x1p-126f, 0x1p-149f, -0x1p-149f, 0x1p-130f}) {
        for (const float x : {2.0f, 0x1p-120f, 0x1p-127f}) {
            const ClipPosition far{x, x * 0.375f, w * 0.5f, w};
            countsOf(input, "W02", {{a, b, far}, {b, far, c}});
        }
    }
}

void w03(CaseInput& input) {
    for (const float scale : {-1.0f, -0.001f, -1000.0f}) {
        std::vector<ClipPosition> positions;
        for (const auto& [x, y] : {std::pair{-0.9f, -0.8f}, {0.9f, -0.7f}, {0.1f, 0.9f}})
            positions.push_back({x * scale, y * scale, 0.5f * scale, scale});
        for (const bool clamp : {false, true}) {
            CountOptions options = plainCount();
            options.depthClamp = clamp;
            judgeEmpty(input, input.scene(countScene("W03", positions, options)), options,
                       "all of it is behind the eye");
        }
    }
}

// Triangles with vertices on both sides of the eye: what is in front is drawn, and faces as the homogeneous determinant
// says.
void w04(CaseInput& input) {
    const std::vector<ClipTriangle> triangles{
        {ClipPosition{-0.7f, -0.8f, 0.4f, 1}, {0.9f, -0.3f, 0.5f, 1}, {0.3f, -2.1f, 0.2f, -1.5f}},
        {ClipPosition{-0.4f, 0.6f, 0.3f, 0.8f}, {-1.2f, 0.7f, 0.1f, -0.9f}, {0.6f, -1.3f, -0.2f, -2}},
        {ClipPosition{0.2f, 0.1f, 0.6f, 1.2f}, {2.5f, -1.5f, 1, -3}, {-3, 2.75f, 2, 4}},
    };
    for (const ClipTriangle& t : triangles) {
        countsOf(input, "W04", {t});
        const bool front = TriangleSides(t, viewportOf(kTarget), 8).orientation() < 0;  // counter-clockwise
        for (const VkCullModeFlags cull : {VK_CULL_MODE_FRONT_BIT, VK_CULL_MODE_BACK_BIT}) {
            CountOptions options = plainCount();
            options.cull = cull;
            const size_t scene = input.scene(countScene("W04_culled", flatten({t}), options));
            if ((cull == VK_CULL_MODE_FRONT_BIT) == front) {
                judgeEmpty(input, scene, options, "the triangle faces the way that is culled");
            } else {
                judgeSides(input, scene, {t}, kTarget);
            }
        }
    }
}

// Edges through the target that end a sub-unit before and behind bounds that guard bands are commonly put at.
void w05(CaseInput& input) {
    constexpr double kUnit = 1.0 / 256;
    for (const double bound : {2048.0, 4096.0, 8192.0, 16384.0, 24575.0, 32767.0, 32768.0}) {
        for (const double step : {-kUnit, 0.0, kUnit}) {
            const double far = bound + step;
            CoverageOptions options;
            options.extent = kTarget;
            addCoverage(input, "W05",
                        {{{{far, 20.5}, {3.25, 60}, {7.5, 1.25}}}, {{{-far, 40}, {60, 3.5}, {50.25, 61}}}}, options);
            addCoverage(input, "W05_tall", {{{{10.5, far}, {60.25, 3}, {2.5, 7}}}}, options);
        }
    }
}

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

// A broken triangle between two whole ones, in one draw. The first whole one lies where no triangle with two of the
// broken one's good vertices can come; the second is drawn over everything.
void undisturbed(CaseInput& input, std::string_view name, const ClipPosition& broken) {
    const WindowTriangle over{{{8.25, 30}, {56, 33.5}, {30, 61.75}}};
    for (size_t place = 0; place < 3; ++place) {
        std::vector<ColorVertex> vertices;
        std::array<ClipPosition, 3> bad{{{-0.5f, -0.9f, 0.5f, 1}, {0.6f, -0.8f, 0.5f, 1}, {0.1f, 0.7f, 0.5f, 1}}};
        bad[place] = broken;
        for (const ClipPosition& p : bad) vertices.push_back({p, {1, 0, 0, 1}});
        for (const WindowPoint& p : over) vertices.push_back({clipAt(p, viewportOf(kTarget)), {0, 1, 0, 1}});
        const size_t scene = input.scene(colorScene(name, vertices, kTarget));
        judgePixels(input, scene, 0, kTarget, [over](const PixelReader& pixels, const Declared& declared) -> Verdict {
            const exact::GridTriangle grid = snapped({over}, declared.subPixelBits)[0];
            const int64_t half = int64_t{1} << (declared.subPixelBits - 1);
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    const exact::GridPoint p{2 * half * x + half, 2 * half * y + half};
                    const exact::Coverage coverage = exact::classify(grid, p);
                    const bool green = pixels.code(x, y, 1) == 255 && pixels.code(x, y, 0) == 0;
                    if (coverage == exact::Coverage::must && !green)
                        return Verdict::wrong(pixelText(x, y) +
                                              " inside the triangle behind the broken one is disturbed");
                    if (coverage == exact::Coverage::mustNot && pixels.code(x, y, 1) != 0)
                        return Verdict::wrong(pixelText(x, y) +
                                              " outside the triangle behind the broken one has its colour");
                }
            }
            return {};
        });
    }
}

void w08(CaseInput& input) {
    undisturbed(input, "W08", {0.25f, 0.5f, 0.5f, kInf});
    undisturbed(input, "W08", {0.25f, 0.5f, 0.5f, -kInf});
    undisturbed(input, "W08", {kInf, 0.5f, 0.5f, 1});
    undisturbed(input, "W08", {kInf, -kInf, kInf, kInf});
}

void w09(CaseInput& input) {
    for (size_t c = 0; c < 4; ++c) {
        ClipPosition broken{0.25f, 0.5f, 0.5f, 1};
        broken[c] = kNan;
        undisturbed(input, "W09", broken);
    }
    undisturbed(input, "W09", {kNan, kNan, kNan, kNan});
}

// Window coordinates beyond any integer.
void w10(CaseInput& input) {
    for (const float far : {1e6f, 1e8f, 3e9f, 1e12f, 1e30f}) {
        countsOf(input, "W10",
                 {{ClipPosition{far, 0.25f, 0.5f, 1}, {-0.75f, -0.5f, 0.5f, 1}, {-0.25f, 0.75f, 0.5f, 1}},
                  {ClipPosition{-far, -far, 0.5f, 1}, {0.75f, -0.5f, 0.5f, 1}, {0.25f, far, 0.5f, 1}}});
    }
    countsOf(input, "W10_tiny_w",
             {{ClipPosition{0.5f, 0.25f, 0, 1e-30f}, {-0.75f, -0.5f, 0.5f, 1}, {-0.25f, 0.75f, 0.5f, 1}}});
}

constexpr std::string_view kTransform = "Vulkan, Coordinate Transformations; the ratio is what counts";
constexpr std::string_view kVolume = "Vulkan, Primitive Clipping: the view volume";

const std::vector<HardCase> kCases{
    {"W01",
     "A vertex with w = 0, the others in front",
     "The triangle extends to infinity; the view volume cuts it to a finite polygon, shared edges stay closed.",
     kVolume,
     w01,
     {},
     {{"swiftshader", "substitutes 1 for 1/w when w = 0"}}},
    {"W02", "w of 2^-126 and of denormals, of both signs", "As exact rationals, though 1/w overflows float.", kVolume,
     w02},
    {"W03", "All w negative", "Nothing is drawn.", kVolume, w03},
    {"W04", "Vertices on both sides of the eye, without culling and with",
     "Only the part with w > 0; it faces as the sign of the homogeneous determinant says.",
     "Vulkan, Primitive Clipping; Basic Polygon Rasterization", w04},
    {"W05", "Edges that end a sub-unit before and behind common guard bands", "No visible difference.", kVolume, w05},
    {"W06", "Clip coordinates scaled by up to 2^125: products overflow float",
     "A power of two changes no exact result: the same bits.", kTransform, w06},
    {"W07", "Clip coordinates scaled by down to 2^-100: products are denormal",
     "A power of two changes no exact result: the same bits.", kTransform, w07},
    {"W08", "Infinite coordinates", "No crash; primitives before and behind are as they would be.",
     "Vulkan, Floating-Point Computation: undefined values must not lead to termination", w08},
    {"W09",
     "NaN in x, y, z or w",
     "No crash; primitives before and behind are as they would be.",
     "Vulkan, Floating-Point Computation: undefined values must not lead to termination",
     w09,
     {},
     {{"swiftshader", "tests x, y, z only: a NaN in w slips through"}}},
    {"W10", "Window coordinates beyond any integer", "Clipped or saturated: the homogeneous edge functions decide.",
     kVolume, w10},
};

}  // namespace

std::span<const HardCase> homogeneousCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
