// I: interpolation and perspective.
#include "conformance/hardcases/barycentric_case.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

#include <cmath>
#include <cstdio>
#include <limits>
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

// At the centre; with vertices snapped to the nearest places of `bits` sub-pixel bits.
Rational exactAttribute(const FarTriangle& t, int bits) {
    const GridPoint p{t.centre.x * 256 + 128, t.centre.y * 256 + 128};
    const auto snap = [bits](int64_t coordinate) {
        if (bits >= 8) return coordinate;
        return exact::toInt64(exact::snapNearestEven(exact::fraction(coordinate, 256), bits)) << (8 - bits);
    };
    exact::GridTriangle points = t.points;
    for (GridPoint& point : points) point = {snap(point.x), snap(point.y)};
    Rational sum, value;
    for (size_t i = 0; i < 3; ++i) {
        const auto e = exact::edgeFunction(points[(i + 1) % 3], points[(i + 2) % 3], p);
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
                const double expected = exactAttribute(t, 8).get_d(), observed = pixels.number(x, y, 0);
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
                const double own = exactAttribute(t, declared.subPixelBits).get_d();
                const std::string where = pixelText(x, y) + text;
                worst = worst.worse(declared.own && std::abs(observed - own) <= 8 * 0x1p-24
                                        ? Verdict::declared(where)
                                        : Verdict::inexact(legal, where));
            }
            return worst;
        });
    }
}

// The same triangles with their vertices rotated.
void i03(CaseInput& input) {
    const std::vector<ColorVertex> base{
        {{-0.9f, -0.7f, 0.2f, 1}, {0, 1, 0.3f, 1}},       {{2.3f, -1.1f, 0.7f, 2.7f}, {1, 0.25f, 0.9f, 1}},
        {{-0.3f, 1.7f, 0.4f, 1.9f}, {0.5f, 0, 7, 1}},     {{0.1f, 0.2f, 0.1f, 1}, {1e6f, 0, 0.1f, 1}},
        {{0.95f, 0.3f, 0.1f, 1}, {1e6f + 1, 1, 0.2f, 1}}, {{0.6f, 0.9f, 0.1f, 1}, {1e6f, 1, 0.9f, 1}}};
    std::array<size_t, 3> scenes{};
    for (size_t turn = 0; turn < 3; ++turn) {
        std::vector<ColorVertex> turned;
        for (size_t first = 0; first < base.size(); first += 3) {
            for (size_t i = 0; i < 3; ++i) turned.push_back(base[first + (i + turn) % 3]);
        }
        scenes[turn] = input.scene(colorScene("I03", turned, kTarget, VK_FORMAT_R32G32B32A32_SFLOAT));
        if (turn == 0) continue;
        input.judge({scenes[turn], scenes[0]}, [](std::span<const Drawn* const> images, const Declared&) -> Verdict {
            const PixelReader a(images[0]->at(0)), b(images[1]->at(0));
            if (!a.valid() || !b.valid()) return Verdict::wrong("an image has the wrong format, extent or size");
            Verdict worst;
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    for (uint8_t c = 0; c < 4; ++c) {
                        const double v = a.number(x, y, c), w = b.number(x, y, c);
                        if (v == w) continue;
                        char text[120];
                        std::snprintf(text, sizeof text, " is %.9g and, with the vertices rotated, %.9g", w, v);
                        const bool legal = std::abs(v - w) <= 1e-4 * std::max(1.0, std::abs(w));
                        worst = worst.worse(Verdict::inexact(legal, pixelText(x, y) + text));
                    }
                }
            }
            return worst;
        });
    }
}

// A quad of two triangles in one plane: an attribute that is linear on it has no seam.
void i04(CaseInput& input) {
    const auto at = [](double x, double y) {
        return ColorVertex{clipAt({x, y}, viewportOf(kTarget)),
                           {static_cast<float>(x), static_cast<float>(y), static_cast<float>(3 * x - 2 * y), 1}};
    };
    const ColorVertex a = at(2, 3), b = at(61, 3), c = at(2, 59), d = at(61, 59);
    const size_t scene = input.scene(colorScene("I04", {a, b, c, d, c, b}, kTarget, VK_FORMAT_R32G32B32A32_SFLOAT));
    judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t y = 3; y < 59; ++y) {
            for (uint32_t x = 2; x < 61; ++x) {
                const std::array<double, 3> expected{x + 0.5, y + 0.5, 3 * (x + 0.5) - 2 * (y + 0.5)};
                for (uint8_t k = 0; k < 3; ++k) {
                    const double error = std::abs(pixels.number(x, y, k) - expected[k]);
                    if (error <= 64 * 4 * 0x1p-23) continue;
                    char text[80];
                    std::snprintf(text, sizeof text, " is off the plane by %.3g", error);
                    worst = worst.worse(Verdict::inexact(error <= 64 * 1e-4, pixelText(x, y) + text));
                }
            }
        }
        return worst;
    });
}

// w from 1 to 10^6 over the target.
void i05(CaseInput& input) {
    const std::vector<ColorVertex> vertices{{{-1, -1, 0.5f, 1}, {0, 0, 1, 1}},
                                            {{1e6f, -1e6f, 5e5f, 1e6f}, {1, 0, 0.5f, 1}},
                                            {{-1e3f, 1e3f, 5e2f, 1e3f}, {0, 1, 0, 1}}};
    addForOracle(input, interpolationScene("I05", vertices, kTarget));
}

void i06(CaseInput& input) {
    const std::vector<ColorVertex> vertices{{{-0.9f, -0.8f, 0.1f, 1}, {1, 0, 0.25f, 1}},
                                            {{2.7f, -2.1f, 1.3f, 3}, {0, 1, 0.5f, 0}},
                                            {{-0.4f, 1.8f, 1.1f, 2}, {0.25f, 0.5f, 1, 0.5f}}};
    addForOracle(input, interpolationScene("I06", vertices, kTarget));
}

// Slivers whose centres lie inside by snapping alone: values stay near those of the vertices.
void i07(CaseInput& input) {
    std::vector<ColorVertex> vertices;
    for (int i = 0; i < 20; ++i) {
        const double y = 3.5 + 3 * i, off = 0.4 / 256;
        vertices.push_back({clipAt({2, y - off}, viewportOf(kTarget)), {0, 0, 0, 1}});
        vertices.push_back({clipAt({62, y - off}, viewportOf(kTarget)), {1, 0, 0, 1}});
        vertices.push_back({clipAt({30, y - 0.5}, viewportOf(kTarget)), {0.5f, 1, 0, 1}});
    }
    const size_t scene = input.scene(colorScene("I07", vertices, kTarget, VK_FORMAT_R32G32B32A32_SFLOAT));
    judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared& declared) -> Verdict {
        // The second attribute changes by 2 per pixel across the sliver; extrapolation is no more than snapping.
        const double reach = 3 * std::ldexp(1.0, -declared.subPixelBits) * 2;
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                for (uint8_t c = 0; c < 2; ++c) {
                    const double v = pixels.number(x, y, c);
                    if (v < -reach || v > 1 + reach)
                        return Verdict::wrong(pixelText(x, y) + " is " + std::to_string(v) +
                                              ", outside what the vertices have");
                }
            }
        }
        return {};
    });
}

void i08(CaseInput& input) {
    const std::vector<uint32_t> patterns{0x7fc00001u, 0x80000000u, 0x7f800001u, 0xffffffffu, 1u, 0x12345678u};
    for (const uint32_t bits : patterns) {
        SceneRecorder record("I08", "Flat integers.");
        const uint32_t target = record.colorTarget("bits", VK_FORMAT_R32_UINT, {8, 8});
        const std::vector<uint32_t> data{bits, bits ^ 1u, bits ^ 2u};
        const uint32_t pipeline = record
                                      .pipeline(record.vertex(R"(#version 450
layout(location = 0) in uint value;
layout(location = 0) flat out uint vValue;
layout(location = 1) flat out float vFloat;
void main() {
    gl_Position = vec4(float((gl_VertexIndex & 1) * 4 - 1), float((gl_VertexIndex >> 1) * 4 - 1), 0.0, 1.0);
    vValue = value;
    vFloat = uintBitsToFloat(value);
}
)"),
                                                record.fragment(R"(#version 450
layout(location = 0) flat in uint vValue;
layout(location = 0) out uint color;
void main() { color = vValue; }
)"))
                                      .binding(4)
                                      .attribute(VK_FORMAT_R32_UINT, 0);
        record.pass({8, 8}).color(target, {0, 0, 0, 0});
        record.draw(pipeline, 3).vertices(record.vertexBuffer("values", data));
        record.output(target);
        judgeCodes(input, input.scene(record.finish()), 0, {8, 8}, {bits},
                   "a flat integer is the provoking vertex's, bit for bit");
    }
}

void i09(CaseInput& input) {
    SceneRecorder record("I09", "FragCoord.");
    const uint32_t target = record.colorTarget("coord", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
    const std::vector<ClipPosition> data{{-2, -2, 0.25f, 2}, {12, -4, 3, 4}, {-1, 3, 0.5f, 1}};
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(kPositionVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = gl_FragCoord; }
)"))
                                  .binding(sizeof(ClipPosition))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, 3).vertices(record.vertexBuffer("positions", data));
    record.output(target);
    const size_t scene = addForOracle(input, record.finish());
    judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                const float fx = pixels.number(x, y, 0), fy = pixels.number(x, y, 1);
                if ((fx == 0 && fy == 0) || (fx == static_cast<float>(x) + 0.5f && fy == static_cast<float>(y) + 0.5f))
                    continue;
                return Verdict::wrong(pixelText(x, y) + ": FragCoord.xy is not the centre");
            }
        }
        return {};
    });
}

// An affine attribute at offsets of 1/16: exact where it is asked for.
void i11(CaseInput& input) {
    for (const auto& [dx, dy] : {std::pair{0.0f, 0.0f}, {-0.5f, -0.5f}, {0.4375f, 0.4375f}, {0.0625f, -0.25f}}) {
        SceneRecorder record("I11", "interpolateAtOffset.");
        const uint32_t target = record.colorTarget("value", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
        char glsl[400];
        std::snprintf(glsl, sizeof glsl, R"(#version 450
layout(location = 0) in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(interpolateAtOffset(vColor.xy, vec2(%.4f, %.4f)), vColor.zw); }
)",
                      static_cast<double>(dx), static_cast<double>(dy));
        const std::vector<ColorVertex> data{
            {{-1, -1, 0.5f, 1}, {0, 0, 0, 1}}, {{3, -1, 0.5f, 1}, {128, 0, 0, 1}}, {{-1, 3, 0.5f, 1}, {0, 128, 0, 1}}};
        const uint32_t pipeline = record.pipeline(record.vertex(kColorVertexGlsl), record.fragment(glsl))
                                      .binding(sizeof(ColorVertex))
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition));
        record.pass(kTarget).color(target, {0, 0, 0, 0});
        record.draw(pipeline, 3).vertices(record.vertexBuffer("vertices", data));
        record.output(target);
        const size_t scene = input.scene(record.finish());
        judgePixels(
            input, scene, 0, kTarget, [dx = dx, dy = dy](const PixelReader& pixels, const Declared&) -> Verdict {
                Verdict worst;
                for (uint32_t y = 0; y < kTarget.height; ++y) {
                    for (uint32_t x = 0; x < kTarget.width; ++x) {
                        const double ex = pixels.number(x, y, 0) - (x + 0.5 + static_cast<double>(dx)),
                                     ey = pixels.number(x, y, 1) - (y + 0.5 + static_cast<double>(dy));
                        const double error = std::max(std::abs(ex), std::abs(ey));
                        if (error <= 128 * 0x1p-22) continue;
                        char text[80];
                        std::snprintf(text, sizeof text, ": at an offset of (%.4f, %.4f) the ramp is off by %.3g",
                                      static_cast<double>(dx), static_cast<double>(dy), error);
                        // Offsets have at least four fraction bits, which these do.
                        worst = worst.worse(Verdict::inexact(error <= 128e-5, pixelText(x, y) + text));
                    }
                }
                return worst;
            });
    }
}

// One attribute holds infinities, NaN and the largest floats: the others are as they are without it.
void i12(CaseInput& input) {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kMax = std::numeric_limits<float>::max();
    const auto scene = [&](std::array<float, 3> wild) {
        std::vector<ColorVertex> vertices{{{-0.9f, -0.8f, 0.1f, 1}, {wild[0], 0, 1, 1}},
                                          {{2.7f, -2.1f, 1.3f, 3}, {wild[1], 1, 0.5f, 1}},
                                          {{-0.4f, 1.8f, 1.1f, 2}, {wild[2], 0.5f, 0, 1}}};
        return input.scene(colorScene("I12", vertices, kTarget, VK_FORMAT_R32G32B32A32_SFLOAT));
    };
    const size_t tame = scene({0, 0, 0});
    for (const std::array<float, 3> wild : {std::array{kInf, 0.0f, 1.0f},
                                            {kMax, -kMax, kMax},
                                            {std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f},
                                            {kInf, -kInf, 0.0f}}) {
        input.judge({scene(wild), tame}, [](std::span<const Drawn* const> images, const Declared&) -> Verdict {
            const PixelReader a(images[0]->at(0)), b(images[1]->at(0));
            if (!a.valid() || !b.valid()) return Verdict::wrong("an image has the wrong format, extent or size");
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    for (uint8_t c = 1; c < 4; ++c) {
                        if (a.code(x, y, c) != b.code(x, y, c))
                            return Verdict::wrong(pixelText(x, y) + ": an attribute beside the wild one is disturbed");
                    }
                }
            }
            return {};
        });
    }
}

// 10^6 to 10^6 + 1: the error is that of the value, not of partial sums.
void i13(CaseInput& input) {
    const std::vector<ColorVertex> vertices{{{-1, -1, 0.5f, 1}, {1e6f, 1e6f, 0, 1}},
                                            {{3, -1, 0.5f, 1}, {1e6f + 2, 1e6f, 0, 1}},
                                            {{-1, 3, 0.5f, 1}, {1e6f, 1e6f + 2, 0, 1}}};
    const size_t scene = input.scene(colorScene("I13", vertices, kTarget, VK_FORMAT_R32G32B32A32_SFLOAT));
    judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                const double error = std::max(std::abs(pixels.number(x, y, 0) - (1e6 + (x + 0.5) / 64)),
                                              std::abs(pixels.number(x, y, 1) - (1e6 + (y + 0.5) / 64)));
                if (error <= 0.0625) continue;  // one ULP of 10^6
                worst =
                    worst.worse(Verdict::inexact(error <= 10, pixelText(x, y) + " is off by " + std::to_string(error)));
            }
        }
        return worst;
    });
}

constexpr std::string_view kPolygons = "Vulkan, Basic Polygon Rasterization";

const std::vector<HardCase> kCases{
    {"I01", "Attributes equal at all vertices, in strong perspective", "The weights sum to 1: constant to the bit.",
     kPolygons, i01},
    {"I02",
     "One-pixel triangles 4000 pixels from the origin",
     "The error does not grow with the distance.",
     kPolygons,
     i02,
     {},
     {{"lavapipe", "anchors plane equations at the framebuffer's origin: errors beyond half a code"}}},
    {"I03",
     "Triangles with their vertices rotated",
     "The same values to the bit; a rounding apart is permitted.",
     kPolygons,
     i03,
     {},
     {{"lavapipe", "rotating the vertices of a triangle changes its values", Outcome::allowed}}},
    {"I04", "A quad of two triangles with an attribute linear on it", "No seam: the plane's values.", kPolygons, i04},
    {"I05", "w from 1 to 10^6 across the target", "The ratio of sums of a_i f_i / w_i.", kPolygons, i05},
    {"I06", "smooth and noperspective on the same primitive", "Each by its own formula.",
     "Vulkan, Interpolation Decorations", i06},
    {"I07", "Slivers that cover centres by snapping alone", "Values near those of the vertices.", kPolygons, i07},
    {"I08", "Flat integers of all kinds of bit patterns", "The provoking vertex's bits.", "Vulkan, Flat Shading", i08},
    {"I09", "FragCoord in perspective", "x.5 and y.5 exactly; the interpolated depth and 1/w.", "Vulkan, FragCoord",
     i09},
    {.id = "I10",
     .title = "Barycentric coordinates as inputs, through near plane and eye",
     .rule = "The primitive's weights, in the order of the provoking vertex; they sum to 1.",
     .source = "Vulkan, Barycentric Interpolation",
     .build = barycentricCase},
    {"I11", "interpolateAtOffset at the ends of its range and between", "The attribute's value there.",
     "Vulkan, Interpolation Decorations; SPIR-V InterpolateAtOffset", i11},
    {"I12", "One attribute infinite, NaN or the largest float", "The other attributes are unaffected.",
     "Vulkan, Floating-Point Computation", i12},
    {"I13", "An attribute from 10^6 to 10^6 + 2", "An error of an ULP of the value.", kPolygons, i13},
};

}  // namespace

std::span<const HardCase> interpolationCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
