// I: interpolation and perspective.
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"

#include <cmath>
#include <cstdio>
#include <random>

namespace vernier::conformance::hardcases {
namespace {

using exact::GridPoint;
using exact::Rational;

constexpr VkExtent2D kTarget{64, 64};

constexpr std::array<float, 4> kConstants{1.0f, 0.1f, 1.0f / 3.0f, 16777213.0f};

std::vector<ColorVertex> constantVertices() {
    const std::array<float, 4> c = kConstants;
    return {{{-0.97f, -0.83f, 0.1f, 1}, c},    {{6.3f, -6.1f, 5.9f, 7}, c},         {{-2.7f, 2.9f, 1.9f, 3}, c},
            {{0.9f, 0.93f, 0.1f, 1}, c},       {{-33.0f, 34.1f, 20.5f, 37.0f}, c},  {{0.33f, -0.31f, 0.02f, 0.41f}, c},
            {{-0.05f, -0.9f, -0.4f, 0.2f}, c}, {{100.1f, 99.7f, 90.0f, 101.3f}, c}, {{-90.5f, 87.25f, 50, 101}, c}};
}

void i01(CaseInput& input) {
    const size_t scene = input.scene(interpolationScene("I01", constantVertices(), kTarget));
    for (const size_t output : {0, 1}) {
        judgePixels(input, scene, output, kTarget, [output](const PixelReader& pixels, const Declared&) -> Verdict {
            size_t covered = 0;
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    std::array<float, 4> v;
                    for (uint8_t c = 0; c < 4; ++c) v[c] = pixels.number(x, y, c);
                    if (v == std::array<float, 4>{0, 0, 0, 0}) continue;
                    ++covered;
                    for (size_t c = 0; c < 4; ++c) {
                        if (v[c] == kConstants[c]) continue;
                        char text[96];
                        std::snprintf(text, sizeof text, " component %zu is %.9g, exactly %.9g", c,
                                      static_cast<double>(v[c]), static_cast<double>(kConstants[c]));
                        return Verdict::wrong((output != 0 ? "noperspective, " : "smooth, ") + pixelText(x, y) + text +
                                              "; the weights sum to 1, a constant stays constant");
                    }
                }
            }
            return covered < 1000 ? Verdict::wrong("only " + std::to_string(covered) + " pixels are covered")
                                  : Verdict{};
        });
    }
}

// One triangle of about a pixel around every second centre of a strip far from the origin, vertices on the sub-pixel
// grid.
constexpr VkExtent2D kWide{4096, 8}, kTall{8, 4096};
constexpr int64_t kFirstFar = 3968;  // pixels

struct FarTriangle {
    exact::GridTriangle points;  // of 8 sub-pixel bits
    GridPoint centre;            // pixel
    std::array<float, 3> attribute;
};

std::vector<FarTriangle> farTriangles(bool tall) {
    std::mt19937 random(2);
    const auto between = [&random](int64_t low, int64_t high) {
        return low + static_cast<int64_t>(random() % static_cast<uint32_t>(high - low + 1));
    };
    std::vector<FarTriangle> result;
    for (int64_t along = kFirstFar; along < 4094; along += 2) {
        for (int64_t across = 1; across < 7; across += 2) {
            FarTriangle t;
            t.centre = tall ? GridPoint{across, along} : GridPoint{along, across};
            const std::array<GridPoint, 3> spokes{GridPoint{between(-200, -60), between(-200, -40)},
                                                  GridPoint{between(60, 200), between(-200, 0)},
                                                  GridPoint{between(-60, 60), between(80, 200)}};
            for (size_t i = 0; i < 3; ++i) {
                GridPoint spoke = spokes[i];
                if (tall) std::swap(spoke.x, spoke.y);
                t.points[i] = {t.centre.x * 256 + 128 + spoke.x, t.centre.y * 256 + 128 + spoke.y};
                t.attribute[i] = static_cast<float>(random() % 2);
            }
            if (t.attribute[0] == t.attribute[1] && t.attribute[1] == t.attribute[2])
                t.attribute[0] = 1 - t.attribute[0];
            result.push_back(t);
        }
    }
    return result;
}

Rational exactAttribute(const FarTriangle& t) {
    const GridPoint p{t.centre.x * 256 + 128, t.centre.y * 256 + 128};
    Rational sum, value;
    for (size_t i = 0; i < 3; ++i) {
        const auto e = exact::edgeFunction(t.points[(i + 1) % 3], t.points[(i + 2) % 3], p);
        const Rational weight = exact::fraction(static_cast<int64_t>(e), 1);
        sum += weight;
        value += weight * exact::rational(t.attribute[i]);
    }
    return value / sum;
}

void i02(CaseInput& input) {
    for (const bool tall : {false, true}) {
        const VkExtent2D extent = tall ? kTall : kWide;
        std::vector<ColorVertex> data;
        for (const FarTriangle& t : farTriangles(tall)) {
            for (size_t i = 0; i < 3; ++i) {
                const WindowPoint p{static_cast<double>(t.points[i].x) / 256, static_cast<double>(t.points[i].y) / 256};
                data.push_back({clipAt(p, viewportOf(extent)), {t.attribute[i], 0, 0, 1}});
            }
        }
        const size_t scene = input.scene(colorScene("I02", data, extent, VK_FORMAT_R32G32B32A32_SFLOAT));
        judgePixels(input, scene, 0, extent, [tall](const PixelReader& pixels, const Declared& declared) -> Verdict {
            Verdict worst;
            for (const FarTriangle& t : farTriangles(tall)) {
                const GridPoint p{t.centre.x * 256 + 128, t.centre.y * 256 + 128};
                if (exact::classify(t.points, p, 256 >> std::min(declared.subPixelBits, 8)) != exact::Coverage::must)
                    continue;
                const auto x = static_cast<uint32_t>(t.centre.x), y = static_cast<uint32_t>(t.centre.y);
                const double expected = exactAttribute(t).get_d(), observed = pixels.number(x, y, 0);
                const double error = std::abs(observed - expected);
                // 8 roundings of weights that sum to 1 are what a careful float evaluation makes. Half a code of RGBA8
                // is what a plane equation anchored at the framebuffer's origin exceeds. A coarser grid moves the
                // vertices of a triangle of one pixel by a sub-unit each way.
                const double snapping = declared.subPixelBits >= 8 ? 0 : 4 * std::ldexp(1.0, -declared.subPixelBits);
                if (error <= 8 * 0x1p-24) continue;
                char text[128];
                std::snprintf(text, sizeof text, " is %.9g, exactly %.9g: error %.3g of the attribute's range",
                              observed, expected, error);
                const bool legal = error <= 0.5 / 255 + snapping;
                worst = worst.worse(legal ? Verdict::allowed(pixelText(x, y) + text)
                                          : Verdict::wrong(pixelText(x, y) + text));
            }
            return worst;
        });
    }
}

const std::vector<HardCase> kCases{
    {"I01", "Attributes equal at all vertices, in strong perspective", "The weights sum to 1: constant to the bit.",
     "Vulkan, Basic Polygon Rasterization", i01},
    {"I02",
     "One-pixel triangles 4000 pixels from the origin",
     "The error does not grow with the distance.",
     "Vulkan, Basic Polygon Rasterization",
     i02,
     {},
     {{"lavapipe", "anchors plane equations at the framebuffer's origin: errors beyond half a code"}}},
};

}  // namespace

std::span<const HardCase> interpolationCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
