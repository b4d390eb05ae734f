// L: derivatives and level of detail.
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/image_kind_cases.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/texture_input.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

Result<Scene> derivativeScene(std::string_view name, const std::vector<ColorVertex>& vertices) {
    SceneRecorder record(name, "Derivatives of an attribute.");
    const uint32_t target = record.colorTarget("derivatives", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(kColorVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(dFdx(vColor.x), dFdy(vColor.x), vColor.x, 1.0); }
)"))
                                  .binding(sizeof(ColorVertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition));
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("vertices", vertices));
    record.output(target);
    return record.finish();
}

double rampAt(double x, double y) {
    return 3 * x - 2 * y;
}

ColorVertex ramp(double x, double y) {
    return {clipAt({x, y}, viewportOf(kTarget)), {static_cast<float>(rampAt(x, y)), 0, 0, 1}};
}

// The derivatives of the ramp over a triangle whose vertices are snapped with their values: its plane tilts.
std::array<double, 2> snappedSlope(const WindowTriangle& triangle, const exact::GridTriangle& grid, int bits) {
    std::array<double, 3> x, y, value;
    for (size_t i = 0; i < 3; ++i) {
        x[i] = std::ldexp(static_cast<double>(grid[i].x), -bits);
        y[i] = std::ldexp(static_cast<double>(grid[i].y), -bits);
        value[i] = rampAt(triangle[i].x, triangle[i].y);
    }
    const double x1 = x[1] - x[0], y1 = y[1] - y[0], v1 = value[1] - value[0];
    const double x2 = x[2] - x[0], y2 = y[2] - y[0], v2 = value[2] - value[0];
    const double area = x1 * y2 - x2 * y1;
    return {(v1 * y2 - v2 * y1) / area, (v2 * x1 - v1 * x2) / area};
}

// The ramp over triangles: its derivatives are 3 and -2 at every covered pixel, with helpers at edges; by a driver's
// own bounds those of the snapped triangle at the pixel.
void judgeRamp(CaseInput& input, size_t scene, const WindowTriangles& triangles) {
    judgePixels(input, scene, 0, kTarget, [triangles](const PixelReader& pixels, const Declared& declared) -> Verdict {
        Verdict worst;
        const int bits = declared.subPixelBits;
        const std::vector<exact::GridTriangle> grid = snapped(triangles, bits);
        const exact::SampleGrid samples{kTarget, bits, {int64_t{1} << (bits - 1), int64_t{1} << (bits - 1)}};
        // Snapped vertices tilt the plane of a small triangle.
        const double snapping = 4 * std::ldexp(1.0, -bits);
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                if (pixels.number(x, y, 3) != 1.0f) continue;
                const auto errorTo = [&](const std::array<double, 2>& slope) {
                    return std::max(std::abs(pixels.number(x, y, 0) - slope[0]),
                                    std::abs(pixels.number(x, y, 1) - slope[1]));
                };
                // Two values of up to 320, each a few roundings off.
                constexpr double kRoundings = 320 * 8 * 0x1p-23;
                const double error = errorTo({3, -2});
                if (error <= kRoundings) continue;
                char text[100];
                std::snprintf(text, sizeof text, ": the derivatives of 3 x - 2 y are (%.9g, %.9g)",
                              static_cast<double>(pixels.number(x, y, 0)), static_cast<double>(pixels.number(x, y, 1)));
                const std::string where = pixelText(x, y) + text;
                const auto covers = [&](const auto& t) { return exact::covers(t, samples.sample(x, y)); };
                // Snapping may turn a triangle over onto its neighbour: the last one is seen.
                const auto at = std::find_if(grid.rbegin(), grid.rend(), covers);
                const auto index = static_cast<size_t>(grid.rend() - at) - 1;
                const bool own = declared.own && at != grid.rend() &&
                                 errorTo(snappedSlope(triangles[index], *at, bits)) <= kRoundings;
                worst = worst.worse(own ? Verdict::declared(where)
                                        : Verdict::inexact(error <= 320 * 2e-5 + snapping, where));
            }
        }
        return worst;
    });
}

// Of the ramp over these triangles.
void derivativesOf(CaseInput& input, std::string_view name, const WindowTriangles& triangles) {
    std::vector<ColorVertex> vertices;
    for (const WindowTriangle& t : triangles) {
        for (const WindowPoint& p : t) vertices.push_back(ramp(p.x, p.y));
    }
    judgeRamp(input, input.scene(derivativeScene(name, vertices)), triangles);
}

void l01(CaseInput& input) {
    derivativesOf(input, "L01", {{{{-64, -64}, {192, -64}, {-64, 192}}}});
}

void l02(CaseInput& input) {
    derivativesOf(input, "L02", jitteredTiling(11, 5.25, 2.1, 256, 2));
}

// A plane to the horizon: quads whose upper pixels lie beyond it.
void l03(CaseInput& input) {
    const std::vector<ColorVertex> vertices{
        {{-1, 1, 0.5f, 1}, {0, 0, 0, 1}},        {{1, 1, 0.5f, 1}, {1, 0, 0, 1}},
        {{300, -3, 500, 1000}, {1000, 0, 0, 1}}, {{-1, 1, 0.5f, 1}, {0, 0, 0, 1}},
        {{300, -3, 500, 1000}, {1000, 0, 0, 1}}, {{-300, -3, 500, 1000}, {999, 0, 0, 1}}};
    const size_t scene = input.scene(derivativeScene("L03", vertices));
    judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                for (uint8_t c = 0; c < 3; ++c) {
                    if (!std::isfinite(pixels.number(x, y, c)))
                        return Verdict::wrong(pixelText(x, y) + " is not finite though it is covered");
                }
            }
        }
        return {};
    });
}

// Levels of one colour each: level l of seven has red l / 8.
TextureTable levels(VkSamplerMipmapMode mode, VkFilter mag, VkFilter min) {
    TextureTable table;
    table.format = VK_FORMAT_R8G8B8A8_UNORM;
    table.extent = {64, 64};
    for (uint32_t level = 0; level < 7; ++level) {
        const uint32_t side = 64 >> level;
        Bytes texels;
        for (uint32_t i = 0; i < side * side; ++i) {
            for (const uint32_t code : {level * 32, i % 256, 0u, 255u}) texels.push_back(static_cast<std::byte>(code));
        }
        table.levels.push_back(texels);
    }
    table.sampler = filtered(min);
    table.sampler.magFilter = mag;
    table.sampler.mipmapMode = mode;
    return table;
}

double levelOf(float red) {
    return static_cast<double>(red) * 255 / 32;
}

void l04(CaseInput& input) {
    TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_FILTER_NEAREST, VK_FILTER_NEAREST);
    for (const float lod : {0.5f, 1.5f, 2.5f, 3.5f, 4.5f}) table.coordinates.push_back({0.3f, 0.3f, lod, 0});
    const size_t scene = input.scene(textureScene("L04", table));
    judgePixels(input, scene, 0, {5, 1}, [](const PixelReader& pixels, const Declared&) -> Verdict {
        size_t up = 0;
        for (uint32_t k = 0; k < 5; ++k) {
            const double level = levelOf(pixels.number(k, 0, 0));
            if (std::abs(level - k) > 0.01 && std::abs(level - k - 1) > 0.01)
                return Verdict::wrong("level of detail " + std::to_string(k) + ".5 reads level " +
                                      std::to_string(level));
            up += level > k + 0.5;
        }
        if (up == 0) return {};
        return up == 5 ? Verdict::allowed("the upper level, floor(d + 1/2)")
                       : Verdict::wrong("half-integers go up " + std::to_string(up) +
                                        " times of 5: neither of the two rules");
    });
}

void l05(CaseInput& input) {
    for (const auto& [mag, min] :
         {std::pair{VK_FILTER_NEAREST, VK_FILTER_LINEAR}, {VK_FILTER_LINEAR, VK_FILTER_NEAREST}}) {
        TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_NEAREST, mag, min);
        for (const float lod : {-1.0f, -0x1p-149f, 0.0f, 0x1p-10f, 0.25f})
            table.coordinates.push_back({0.314f, 0.271f, lod, 0});
        addForOracle(input, textureScene("L05", table));
    }
}

// A quad with a rotated map, whose level of detail is 1.5 by the ideal footprint.
void l06(CaseInput& input) {
    for (const double angle : {0.0, 0.7853981633974483, 0.3}) {
        TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_FILTER_LINEAR, VK_FILTER_LINEAR);
        SceneRecorder record("L06", "A rotated map.");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R32G32B32A32_SFLOAT, {16, 16});
        const uint32_t picture = record.texture("levels", table.format, table.extent, table.levels);
        table.sampler.addressModeU = table.sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
        char glsl[500];
        const double scale = std::exp2(1.5) / 64;
        std::snprintf(glsl, sizeof glsl, R"(#version 450
layout(binding = 0) uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() {
    vec2 p = gl_FragCoord.xy;
    color = texture(picture, vec2(%.9f * p.x - %.9f * p.y, %.9f * p.x + %.9f * p.y));
}
)",
                      std::cos(angle) * scale, std::sin(angle) * scale, std::sin(angle) * scale,
                      std::cos(angle) * scale);
        record.pass({16, 16}).color(target, {0, 0, 0, 0});
        record
            .draw(record.pipeline(record.vertex("#version 450\nvoid main() { gl_Position = vec4(float((gl_VertexIndex "
                                                "& 1) * 4 - 1), float((gl_VertexIndex >> 1) * 4 - 1), 0.0, 1.0); }\n"),
                                  record.fragment(glsl)),
                  3)
            .texture(0, picture, record.sampler(table.sampler));
        record.output(target);
        const size_t scene = input.scene(record.finish());
        judgePixels(input, scene, 0, {16, 16}, [](const PixelReader& pixels, const Declared&) -> Verdict {
            Verdict worst;
            for (uint32_t i = 0; i < 256; ++i) {
                // max of the derivatives to sqrt 2 times their sum: 1.5 less a half to 1.5 and one more; quantised to
                // 1/16.
                const double level = levelOf(pixels.number(i % 16, i / 16, 0));
                if (std::abs(level - 1.5) <= 1.0 / 64) continue;
                const std::string text = "a footprint of level 1.5 reads level " + std::to_string(level);
                const bool legal = level >= 1.5 - 0.5 - 0.07 && level <= 1.5 + 1 + 0.07;
                worst = worst.worse(Verdict::inexact(legal, text));
            }
            return worst;
        });
    }
}

// Footprints given outright: none at all, tiny, huge, infinite, NaN.
void l07(CaseInput& input) {
    TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_FILTER_LINEAR, VK_FILTER_LINEAR);
    table.coordinates = {{0.3f, 0.6f, 0, 0}};
    table.expression = "textureGrad(picture, c.xy, vec2(c.z), vec2(c.w))";
    const size_t scene = input.scene(textureScene("L07", table));
    judgePixels(input, scene, 0, {1, 1}, [](const PixelReader& pixels, const Declared&) -> Verdict {
        const double level = levelOf(pixels.number(0, 0, 0));
        return level == 0 ? Verdict{} : Verdict::wrong("a footprint of 0 reads level " + std::to_string(level));
    });
}

void l08(CaseInput& input) {
    TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_FILTER_LINEAR, VK_FILTER_LINEAR);
    table.expression = "textureGrad(picture, c.xy, vec2(c.z, 0.0), vec2(0.0, c.w))";
    constexpr float kInf = std::numeric_limits<float>::infinity();
    for (const float d :
         {0x1p-100f, 0x1p100f, 0x1p-149f, 3e38f, kInf, -kInf, std::numeric_limits<float>::quiet_NaN()}) {
        table.coordinates.push_back({0.3f, 0.3f, d, d});
        table.coordinates.push_back({0.3f, 0.3f, d, 0.01f});
    }
    const size_t scene = input.scene(textureScene("L08", table));
    judgePixels(input, scene, 0, extentOf(table), [table](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t x = 0; x < table.coordinates.size(); ++x) {
            const double level = levelOf(pixels.number(x, 0, 0));
            const float d = table.coordinates[x][2];
            if (!(level >= 0 && level <= 6.01))
                return Verdict::wrong("lookup " + std::to_string(x) + " reads level " + std::to_string(level));
            const bool largest = d >= 0x1p100f && std::isfinite(d);
            if (largest && std::abs(level - 6) > 0.01)
                return Verdict::wrong("a huge footprint reads level " + std::to_string(level) + ", exactly 6");
        }
        return {};
    });
}

void l09(CaseInput& input) {
    for (const auto& [bias, least, most] :
         {std::tuple{0.0f, 1.25f, 3.0f}, {1.5f, 0.0f, 1000.0f}, {-1.0f, 0.0f, 2.5f}, {15.0f, 0.0f, 1000.0f}}) {
        TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_FILTER_LINEAR, VK_FILTER_LINEAR);
        table.sampler.mipLodBias = std::min(bias, 2.0f);
        table.sampler.minLod = least;
        table.sampler.maxLod = most;
        for (const float lod : {0.0f, 0.5f, 2.75f, 9.0f, -3.0f}) table.coordinates.push_back({0.3f, 0.6f, lod, 0});
        addForOracle(input, textureScene("L09", table));
    }
}

void l10(CaseInput& input) {
    TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_FILTER_NEAREST, VK_FILTER_NEAREST);
    for (int k = 0; k <= 128; ++k) {
        for (const float lod : {static_cast<float>(k) / 64, std::nextafter(static_cast<float>(k) / 64, 9.0f)})
            table.coordinates.push_back({0.3f, 0.3f, lod, 0});
    }
    const size_t scene = input.scene(textureScene("L10", table));
    judgePixels(input, scene, 0, extentOf(table), [table](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t x = 0; x < table.coordinates.size(); ++x) {
            const double lod = static_cast<double>(table.coordinates[x][2]), level = levelOf(pixels.number(x, 0, 0));
            // Exact levels, up to roundings of the mix; one quantum of at least four bits is permitted.
            if (std::abs(level - lod) <= 1e-5) continue;
            const std::string text = "level of detail " + std::to_string(lod) + " mixes as " + std::to_string(level);
            worst = worst.worse(Verdict::inexact(std::abs(level - lod) <= 1.0 / 16 + 1e-3, text));
        }
        return worst;
    });
}

void l11(CaseInput& input) {
    TextureTable table = levels(VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_FILTER_LINEAR, VK_FILTER_LINEAR);
    for (int i = 0; i < 64; ++i)
        table.coordinates.push_back(
            {0.3f, 0.3f, 0.013f * static_cast<float>(i + 1) * static_cast<float>(i + 1) / 64, 0});
    table.expression =
        "vec4(texture(picture, vec2(c.z) * gl_FragCoord.x * 0.1).r * 255.0 / 32.0, textureQueryLod(picture, vec2(c.z) "
        "* gl_FragCoord.x * 0.1).x, 0.0, 1.0)";
    table.sampler.addressModeU = table.sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    const size_t scene = input.scene(textureScene("L11", table));
    judgePixels(input, scene, 0, extentOf(table), [](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t x = 0; x < pixels.extent().width; ++x) {
            const double sampled = pixels.number(x, 0, 0), queried = pixels.number(x, 0, 1);
            const double difference = std::abs(sampled - std::clamp(queried, 0.0, 6.0));
            if (difference <= 1.0 / 256) continue;
            const std::string text = "lookup " + std::to_string(x) + " mixes level " + std::to_string(sampled) +
                                     ", the query says " + std::to_string(queried);
            worst = worst.worse(Verdict::inexact(difference <= 1.0 / 8, text));
        }
        return worst;
    });
}

// Footprints from 1:1 to 1:1000 of a texture of one colour, and the isotropic one against no anisotropy.
void l12(CaseInput& input) {
    const auto scene = [](float anisotropy, bool constant, float stretch) {
        TextureTable table;
        table.extent = {64, 64};
        for (uint32_t side = 64; side > 0; side /= 2) {
            table.levels.push_back(constant ? Bytes(size_t{side} * side * 4, std::byte{77})
                                            : someTexels({side, side}, side));
        }
        table.sampler = filtered(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
        table.sampler.maxAnisotropy = anisotropy;
        for (int i = 0; i < 16; ++i)
            table.coordinates.push_back({0.06f * static_cast<float>(i), 0.3f, 0.02f, 0.02f * stretch});
        table.expression = "textureGrad(picture, c.xy, vec2(c.z, 0.0), vec2(0.0, c.w))";
        return textureScene("L12", table);
    };
    for (const float stretch : {1.0f, 3.7f, 16.0f, 1000.0f, 0.0f}) {
        const size_t drawn = input.scene(scene(16, true, stretch));
        judgePixels(input, drawn, 0, {16, 1}, [](const PixelReader& pixels, const Declared&) -> Verdict {
            Verdict worst;
            for (uint32_t x = 0; x < 16; ++x) {
                const double error = std::abs(pixels.number(x, 0, 0) - 77.0 / 255);
                if (error <= 1e-7) continue;
                const std::string text =
                    "a texture of one colour is filtered " + std::to_string(error) + " off that colour";
                worst = worst.worse(Verdict::inexact(error <= 1e-4, text));
            }
            return worst;
        });
    }
    const size_t isotropic = input.scene(scene(0, false, 1));
    input.judge({input.scene(scene(16, false, 1)), isotropic},
                [](std::span<const Drawn* const> images, const Declared&) -> Verdict {
                    const PixelReader a(images[0]->at(0)), b(images[1]->at(0));
                    if (!a.valid() || !b.valid())
                        return Verdict::wrong("an image has the wrong format, extent or size");
                    Verdict worst;
                    for (uint32_t x = 0; x < 16; ++x) {
                        if (a.number(x, 0, 0) == b.number(x, 0, 0)) continue;
                        worst = worst.worse(Verdict::allowed(
                            "lookup " + std::to_string(x) +
                            ": a round footprint differs from the isotropic one; the scheme is the implementation's"));
                    }
                    return worst;
                });
}

constexpr std::string_view kDerivatives = "Vulkan, Derivative Operations";
constexpr std::string_view kLod = "Vulkan, Image Level(s) Selection; Level-of-Detail Operation";

const std::vector<HardCase> kCases{
    {"L01", "Derivatives of a ramp on whole quads", "The constant difference.", kDerivatives, l01},
    {"L02", "Derivatives of a ramp at the edges of small triangles", "Helper invocations evaluate the plane outside.",
     kDerivatives, l02},
    {"L03", "Derivatives where the horizon runs through quads", "Finite for covered pixels.", kDerivatives, l03},
    {"L04",
     "Levels of detail exactly between two levels, nearest",
     "ceil(d + 1/2) - 1 preferred, floor(d + 1/2) permitted; one of them.",
     kLod,
     l04,
     {},
     {{"swiftshader", "rounds to nearest even: a mixture of the two rules"}}},
    {"L05", "Level of detail around 0 with different filters", "At most 0 magnifies.", "Vulkan, Texel Filtering", l05},
    {"L06", "A map rotated by 0, 17 and 45 degrees", "Between the larger derivative and sqrt 2 times their sum.",
     "Vulkan, Scale Factor Operation", l06},
    {"L07", "A footprint of 0", "Minus infinity, clamped to level 0.", kLod, l07},
    {"L08", "Footprints of 2^+-100, infinite, NaN", "Clamped to the levels there are.", kLod, l08},
    {"L09", "Bias, least and largest level of detail", "The sum is clamped.", kLod, l09},
    {"L10", "Mip fractions at k/64 and an ULP beside", "The exact mix, or a quantum of the declared bits off.", kLod,
     l10},
    {"L11", "textureQueryLod beside what is sampled", "The same level.", "Vulkan, Image Query Instructions", l11},
    {"L12", "Anisotropy 16 on footprints of 1:1 to 1:1000",
     "One colour stays that colour; a round footprint is isotropic.", "Vulkan, Texel Anisotropic Filtering", l12},
    {"L13", "Directions across the edge between two faces of a cube",
     "Projected onto the chosen face: no seam of another level.", "Vulkan, Cube Map Derivative Transformation", l13},
};

}  // namespace

std::span<const HardCase> levelCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
