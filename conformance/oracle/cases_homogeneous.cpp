// Homogeneous coordinates and interpolation: C02, W06, I01, I02.
#include "conformance/oracle/case_list.h"
#include "conformance/oracle/case_support.h"
#include "conformance/oracle/coverage_checks.h"
#include "conformance/oracle/exact.h"
#include "conformance/oracle/homogeneous.h"

#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

namespace vernier::conformance::cases {

namespace {

using exact::Rational;

constexpr VkExtent2D kTarget{64, 64};
constexpr VkViewport kViewport{0, 0, 64, 64, 0, 1};

using ClipTriangle = std::array<ClipPosition, 3>;

exact::HomogeneousTriangle<Rational> exactTriangle(const ClipTriangle& t, const VkViewport& viewport) {
    std::array<exact::WindowVertex<Rational>, 3> v;
    for (size_t i = 0; i < 3; ++i) {
        exact::Clip<Rational> p;
        for (size_t c = 0; c < 4; ++c) p[c] = exact::rational(t[i][c]);
        v[i] = exact::toWindow(p, viewport);
    }
    return exact::HomogeneousTriangle<Rational>(v);
}

enum class Side : uint8_t { inside, open, outside };

// A linear function of the sample: inside where positive, open where moving the sample by one sub-unit can
// change its sign.
Side sideOf(const std::array<Rational, 3>& line, const Rational& x, const Rational& y) {
    const Rational value = line[0] * x + line[1] * y + line[2];
    const Rational reach = (abs(line[0]) + abs(line[1])) * exact::fraction(1, 256);
    if (abs(value) <= reach) return Side::open;
    return value > 0 ? Side::inside : Side::outside;
}

// What is known of a sample: on each edge's side, and of near and far together.
struct SampleSides {
    std::array<Side, 3> edge;  // opposite each vertex
    Side clip = Side::inside;
};

SampleSides sidesOf(const ClipTriangle& clip, const exact::HomogeneousTriangle<Rational>& t, const Rational& x,
                    const Rational& y) {
    SampleSides sides;
    const int orientation = sgn(t.determinant);
    std::array<Rational, 3> nearLine, farLine;
    for (size_t i = 0; i < 3; ++i) {
        std::array<Rational, 3> line;
        for (size_t c = 0; c < 3; ++c) {
            line[c] = t.edge[i][c] * orientation;
            nearLine[c] += line[c] * exact::rational(clip[i][2]);
            farLine[c] += line[c] * (exact::rational(clip[i][3]) - exact::rational(clip[i][2]));
        }
        sides.edge[i] = sideOf(line, x, y);
    }
    for (const auto& line : {nearLine, farLine}) sides.clip = std::max(sides.clip, sideOf(line, x, y));
    return sides;
}

std::vector<ClipPosition> flatten(const std::vector<ClipTriangle>& triangles) {
    std::vector<ClipPosition> result;
    for (const ClipTriangle& t : triangles) result.insert(result.end(), t.begin(), t.end());
    return result;
}

// Pairs of triangles (a, b, c) and (b, a, d): the shared edge is opposite vertex 2 in both. Near, far, or the
// eye plane cuts the shared edge.
std::vector<std::vector<ClipTriangle>> clippedPairs() {
    const auto pair = [](ClipPosition a, ClipPosition b, ClipPosition c, ClipPosition d) {
        return std::vector<ClipTriangle>{{a, b, c}, {b, a, d}};
    };
    return {
        pair({-0.7f, -0.8f, -0.3f, 1}, {0.6f, 0.9f, 0.7f, 1}, {0.8f, -0.6f, 0.4f, 1}, {-0.9f, 0.5f, 0.2f, 1}),
        pair({-0.1f, 0.9f, -0.5f, 0.3f}, {0.3f, -1.5f, 1.9f, 2}, {1.7f, 0.2f, 0.9f, 1.9f}, {-1.8f, 0.1f, 0.6f, 1.9f}),
        pair({0.13f, 1.1f, -0.9f, -0.6f}, {0.4f, -3.1f, 3.5f, 4}, {3.3f, 1.2f, 2.1f, 3.7f}, {-3.6f, 1.4f, 2.6f, 3.9f}),
        pair({-0.4f, -0.9f, 0.4f, 1}, {0.35f, 0.95f, 1.6f, 1.1f}, {0.9f, -0.4f, 0.9f, 1}, {-0.8f, 0.7f, 0.3f, 1}),
    };
}

}  // namespace

Result<std::vector<Scene>> buildC02() {
    std::vector<Scene> scenes;
    for (const auto& pair : clippedPairs()) {
        auto scene = coverageScene("C02", flatten(pair), kTarget, kViewport);
        if (!scene) return scene.error();
        scenes.push_back(std::move(*scene));
    }
    return scenes;
}

Status checkC02(const CaseImages& images, Strictness) {
    const auto pairs = clippedPairs();
    if (Status s = checkShape(images, pairs.size(), 1, kTarget); !s) return s;
    for (size_t i = 0; i < pairs.size(); ++i) {
        const auto counts = coverageCounts(images[i][0], kTarget);
        if (!counts) return verdict("C02", counts.error().message);
        const auto first = exactTriangle(pairs[i][0], kViewport), second = exactTriangle(pairs[i][1], kViewport);
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                const Rational px = x + exact::fraction(1, 2), py = y + exact::fraction(1, 2);
                const SampleSides a = sidesOf(pairs[i][0], first, px, py), b = sidesOf(pairs[i][1], second, px, py);
                const auto others = [](const SampleSides& s) { return std::max({s.edge[0], s.edge[1], s.clip}); };
                const bool sharedOpen = a.edge[2] == Side::open || b.edge[2] == Side::open;
                const Side inA = std::max(others(a), sharedOpen ? Side::inside : a.edge[2]);
                const Side inB = std::max(others(b), sharedOpen ? Side::inside : b.edge[2]);
                uint32_t low, high;
                if (sharedOpen && others(a) == Side::inside && others(b) == Side::inside) {
                    low = high = 1;  // the cut shared edge: exactly one of the two
                } else {
                    low = (inA == Side::inside && !sharedOpen) + (inB == Side::inside && !sharedOpen);
                    high = (inA != Side::outside) + (inB != Side::outside);
                }
                const uint32_t count = (*counts)[y * kTarget.width + x];
                if (count >= low && count <= high) continue;
                return verdict("C02",
                               "pair " + std::to_string(i) + ", " + pixelText(x, y) + " is covered " +
                                   std::to_string(count) + " times, exactly " + std::to_string(low) + ".." +
                                   std::to_string(high) +
                                   (sharedOpen ? " (on the clipped shared edge)" : " (clear of the shared edge)"));
            }
        }
    }
    return {};
}

namespace {

struct ScaledVertex {
    ClipPosition position;
    std::array<float, 4> color;
};

// 0 first: the plain image. 2^126 times 3 overflows as soon as two coordinates are multiplied; 2^-100 makes
// denormal products.
constexpr std::array<int, 7> kScales{0, 20, 63, 120, -30, -63, -100};

std::vector<ScaledVertex> scaledVertices(int exponent) {
    std::vector<ScaledVertex> vertices{
        {{-0.8f, -0.9f, 0.2f, 1}, {1, 0, 0, 1}},        {{2.7f, -1.9f, 1.1f, 3}, {0, 1, 0, 1}},
        {{-0.9f, 1.55f, 0.9f, 1.75f}, {0, 0, 1, 1}},    {{0.9f, 0.85f, 0.1f, 1}, {1, 1, 0, 1}},
        {{-0.6f, 0.97f, 0.5f, 1}, {0, 1, 1, 1}},        {{1.9f, -1.3f, 1.5f, 2.5f}, {1, 0, 1, 1}},
        {{0.05f, 0.4f, -0.25f, 0.5f}, {1, 0.5f, 0, 1}}, {{3.5f, 3.9f, 2, 4}, {0.25f, 0.5f, 1, 1}},
        {{-0.2f, 1.9f, 1, 2}, {0, 0.75f, 0.25f, 1}},
    };
    for (ScaledVertex& v : vertices) {
        for (float& c : v.position) c = std::ldexp(c, exponent);
    }
    return vertices;
}

const char* const kColorVertex = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 vColor;
void main() {
    gl_Position = position;
    vColor = color;
}
)";
const char* const kColorFragment = R"(#version 450
layout(location = 0) in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vColor; }
)";

}  // namespace

Result<std::vector<Scene>> buildW06() {
    std::vector<Scene> scenes;
    for (const int exponent : kScales) {
        SceneRecorder record("W06", "Clip coordinates scaled by 2^" + std::to_string(exponent) + ".");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
        const uint32_t vertices = record.vertexBuffer("vertices", scaledVertices(exponent));
        const uint32_t pipeline = record.pipeline(record.vertex(kColorVertex), record.fragment(kColorFragment))
                                      .binding(sizeof(ScaledVertex))
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition));
        record.pass(kTarget).color(target, {0, 0, 0, 1});
        record.draw(pipeline, 9).vertices(vertices);
        record.output(target);
        auto scene = record.finish();
        if (!scene) return scene.error();
        scenes.push_back(std::move(*scene));
    }
    return scenes;
}

Status checkW06(const CaseImages& images, Strictness) {
    if (Status s = checkShape(images, kScales.size(), 1, kTarget); !s) return s;
    const std::vector<ScaledVertex> vertices = scaledVertices(0);
    const Bytes& plain = images[0][0].texels;
    // The plain image has to show something: samples inside the first triangle by a sub-unit and outside the
    // later ones.
    const ClipTriangle first{vertices[0].position, vertices[1].position, vertices[2].position};
    const auto shape = exactTriangle(first, kViewport);
    for (uint32_t y = 0; y < kTarget.height; ++y) {
        for (uint32_t x = 0; x < kTarget.width; ++x) {
            const SampleSides s = sidesOf(first, shape, x + exact::fraction(1, 2), y + exact::fraction(1, 2));
            const bool inside = std::max({s.edge[0], s.edge[1], s.edge[2], s.clip}) == Side::inside;
            const std::byte* texel = plain.data() + (size_t{y} * kTarget.width + x) * 4;
            if (inside && texel[0] == std::byte{0} && texel[1] == std::byte{0} && texel[2] == std::byte{0}) {
                return verdict("W06", pixelText(x, y) + " is black although a triangle covers it");
            }
        }
    }
    for (size_t i = 1; i < kScales.size(); ++i) {
        const Bytes& scaled = images[i][0].texels;
        const auto different = std::ranges::mismatch(plain, scaled);
        if (different.in1 == plain.end()) continue;
        const auto at = static_cast<uint32_t>(different.in1 - plain.begin());
        return verdict("W06", "scaled by 2^" + std::to_string(kScales[i]) + ", " +
                                  pixelText(at / 4 % kTarget.width, at / 4 / kTarget.width) + " channel " +
                                  "RGBA"[at % 4] + " has code " + std::to_string(std::to_integer<int>(*different.in2)) +
                                  ", unscaled " + std::to_string(std::to_integer<int>(*different.in1)) +
                                  "; a power of two changes no exact result");
    }
    return {};
}

namespace {

constexpr std::array<float, 4> kConstants{1.0f, 0.1f, 1.0f / 3.0f, 16777213.0f};

const char* const kConstantVertex = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 constants;
layout(location = 0) out vec4 vConstants;
layout(location = 1) noperspective out vec4 vLinear;
void main() {
    gl_Position = position;
    vConstants = constants;
    vLinear = constants;
}
)";
const char* const kConstantFragment = R"(#version 450
layout(location = 0) in vec4 vConstants;
layout(location = 1) noperspective in vec4 vLinear;
layout(location = 0) out vec4 perspective;
layout(location = 1) out vec4 linear;
void main() {
    perspective = vConstants;
    linear = vLinear;
}
)";

std::vector<ScaledVertex> constantVertices() {
    const std::array<float, 4> c = kConstants;
    return {{{-0.97f, -0.83f, 0.1f, 1}, c},    {{6.3f, -6.1f, 5.9f, 7}, c},         {{-2.7f, 2.9f, 1.9f, 3}, c},
            {{0.9f, 0.93f, 0.1f, 1}, c},       {{-33.0f, 34.1f, 20.5f, 37.0f}, c},  {{0.33f, -0.31f, 0.02f, 0.41f}, c},
            {{-0.05f, -0.9f, -0.4f, 0.2f}, c}, {{100.1f, 99.7f, 90.0f, 101.3f}, c}, {{-90.5f, 87.25f, 50, 101}, c}};
}

}  // namespace

Result<std::vector<Scene>> buildI01() {
    SceneRecorder record("I01", "Attributes equal at all vertices.");
    const uint32_t perspective = record.colorTarget("perspective", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
    const uint32_t linear = record.colorTarget("linear", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
    const uint32_t vertices = record.vertexBuffer("vertices", constantVertices());
    const uint32_t pipeline = record.pipeline(record.vertex(kConstantVertex), record.fragment(kConstantFragment))
                                  .binding(sizeof(ScaledVertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
                                  .targets(2);
    record.pass(kTarget).color(perspective, {0, 0, 0, 0}).color(linear, {0, 0, 0, 0});
    record.draw(pipeline, 9).vertices(vertices);
    record.output(perspective);
    record.output(linear);
    auto scene = record.finish();
    if (!scene) return scene.error();
    return std::vector<Scene>{std::move(*scene)};
}

Status checkI01(const CaseImages& images, Strictness) {
    if (Status s = checkShape(images, 1, 2, kTarget); !s) return s;
    size_t covered = 0;
    for (size_t output = 0; output < 2; ++output) {
        const RenderedImage& image = images[0][output];
        const exact::PixelFormat& format = *exact::findPixelFormat(image.format);
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                std::array<float, 4> v;
                for (uint8_t c = 0; c < 4; ++c)
                    v[c] = std::bit_cast<float>(static_cast<uint32_t>(codeAt(image, format, x, y, c)));
                if (v == std::array<float, 4>{0, 0, 0, 0}) continue;
                ++covered;
                for (size_t c = 0; c < 4; ++c) {
                    if (v[c] == kConstants[c]) continue;
                    char text[96];
                    std::snprintf(text, sizeof(text), " component %zu is %.9g, exactly %.9g", c, v[c], kConstants[c]);
                    return verdict("I01", (output ? "noperspective, " : "smooth, ") + pixelText(x, y) + text +
                                              "; the weights sum to 1, a constant stays constant");
                }
            }
        }
    }
    return verdict("I01", covered < 1000 ? "only " + std::to_string(covered) + " pixels are covered" : "");
}

namespace {

// One triangle of about a pixel around every second centre of a strip far from the origin, vertices on the
// sub-pixel grid.
constexpr VkExtent2D kWide{4096, 8}, kTall{8, 4096};
constexpr int64_t kFirstFar = 3968;  // pixels

struct FarTriangle {
    std::array<GridPoint, 3> points;
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
            const GridPoint centre{along * 256 + 128, across * 256 + 128};
            FarTriangle t;
            const std::array<GridPoint, 3> spokes{GridPoint{between(-200, -60), between(-200, -40)},
                                                  GridPoint{between(60, 200), between(-200, 0)},
                                                  GridPoint{between(-60, 60), between(80, 200)}};
            for (size_t i = 0; i < 3; ++i) {
                t.points[i] = {centre.x + spokes[i].x, centre.y + spokes[i].y};
                if (tall) std::swap(t.points[i].x, t.points[i].y);
                t.attribute[i] = static_cast<float>(random() % 2);
            }
            if (t.attribute[0] == t.attribute[1] && t.attribute[1] == t.attribute[2])
                t.attribute[0] = 1 - t.attribute[0];
            result.push_back(t);
        }
    }
    return result;
}

VkViewport farViewport(bool tall) {
    return {0,
            0,
            static_cast<float>(tall ? kTall.width : kWide.width),
            static_cast<float>(tall ? kTall.height : kWide.height),
            0,
            1};
}

}  // namespace

Result<std::vector<Scene>> buildI02() {
    std::vector<Scene> scenes;
    for (const bool tall : {false, true}) {
        SceneRecorder record(tall ? "I02_tall" : "I02_wide", "One-pixel triangles far from the origin.");
        const VkExtent2D extent = tall ? kTall : kWide;
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R32G32B32A32_SFLOAT, extent);
        std::vector<ScaledVertex> data;
        for (const FarTriangle& t : farTriangles(tall)) {
            for (size_t i = 0; i < 3; ++i) {
                data.push_back({clipOnGrid(t.points[i], farViewport(tall)), {t.attribute[i], 0, 0, 1}});
            }
        }
        const uint32_t vertices = record.vertexBuffer("vertices", data);
        const uint32_t pipeline = record.pipeline(record.vertex(kColorVertex), record.fragment(kColorFragment))
                                      .binding(sizeof(ScaledVertex))
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition));
        record.pass(extent).color(target, {0, 0, 0, 0});
        record.draw(pipeline, static_cast<uint32_t>(data.size())).vertices(vertices);
        record.output(target);
        auto scene = record.finish();
        if (!scene) return scene.error();
        scenes.push_back(std::move(*scene));
    }
    return scenes;
}

Status checkI02(const CaseImages& images, Strictness strictness) {
    if (images.size() != 2) return invalidArgument("I02 has two scenes");
    // Half a code of RGBA8 is what a plane equation anchored at the origin exceeds; the declared bound is 8
    // float roundings of weights that sum to 1.
    const double tolerance = strictness == Strictness::declared ? 8 * 0x1p-24 : 0.5 / 255;
    for (const bool tall : {false, true}) {
        if (Status s = checkShape({images[tall]}, 1, 1, tall ? kTall : kWide); !s) return s;
        const RenderedImage& image = images[tall][0];
        const exact::PixelFormat& format = *exact::findPixelFormat(image.format);
        for (const FarTriangle& t : farTriangles(tall)) {
            // The centre that the triangle was built around.
            const auto x = static_cast<uint32_t>((t.points[0].x + t.points[1].x + t.points[2].x) / 768);
            const auto y = static_cast<uint32_t>((t.points[0].y + t.points[1].y + t.points[2].y) / 768);
            const GridPoint p{int64_t{x} * 256 + 128, int64_t{y} * 256 + 128};
            if (exact::classify(t.points, p) != exact::Coverage::must) continue;
            std::array<Rational, 3> weight;
            Rational sum;
            for (size_t i = 0; i < 3; ++i) {
                const auto e = exact::edgeFunction(t.points[(i + 1) % 3], t.points[(i + 2) % 3], p);
                weight[i] = exact::fraction(static_cast<int64_t>(e), 1);
                sum += weight[i];
            }
            Rational expected;
            for (size_t i = 0; i < 3; ++i) expected += weight[i] / sum * exact::rational(t.attribute[i]);
            const double observed = std::bit_cast<float>(static_cast<uint32_t>(codeAt(image, format, x, y, 0)));
            const double error = std::abs(observed - expected.get_d());
            if (error <= tolerance) continue;
            char text[128];
            std::snprintf(text, sizeof(text),
                          " is %.9g, exactly %.9g: error %.3g of the attribute's range, allowed %.3g", observed,
                          expected.get_d(), error, tolerance);
            return verdict("I02", pixelText(x, y) + text);
        }
    }
    return {};
}

}  // namespace vernier::conformance::cases
