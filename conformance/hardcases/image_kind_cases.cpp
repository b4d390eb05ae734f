#include "conformance/hardcases/image_kind_cases.h"

#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/texture_input.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vernier::conformance::hardcases {
namespace {

/// Texels of one colour, whose red is code `step` * 32.
Bytes plain(uint32_t side, uint32_t step) {
    Bytes texels;
    for (uint32_t i = 0; i < side * side; ++i) {
        for (const uint32_t code : {step * 32, 255 - step * 16, 7u, 255u})
            texels.push_back(static_cast<std::byte>(code));
    }
    return texels;
}

double stepOf(float red) {
    return static_cast<double>(red) * 255 / 32;
}

// ---- Cubes ----

/// Six faces in Vulkan's order, +x -x +y -y +z -z, each of one colour.
TextureTable cube(VkFilter filter) {
    TextureTable table;
    table.extent = {4, 4};
    table.layers = 6;
    table.viewType = VK_IMAGE_VIEW_TYPE_CUBE;
    for (uint32_t face = 0; face < 6; ++face) table.levels.push_back(plain(4, face));
    table.sampler = filtered(filter);
    table.type = "samplerCube";
    table.expression = "textureLod(picture, c.xyz, 0.0)";
    return table;
}

uint32_t faceOf(uint32_t axis, float value) {
    return axis * 2 + (value < 0 ? 1 : 0);
}

/// Axes that share the largest magnitude.
std::vector<uint32_t> largestAxes(const std::array<float, 4>& v) {
    const float most = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    std::vector<uint32_t> axes;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        if (std::abs(v[axis]) == most) axes.push_back(axis);
    }
    return axes;
}

/// All signs of vectors with two or three components of the same magnitude.
std::vector<std::array<float, 4>> tiedVectors() {
    std::vector<std::array<float, 4>> result;
    for (const std::array<float, 3>& v :
         {std::array<float, 3>{1, 1, 1}, {1, 1, 0.25f}, {1, 0.25f, 1}, {0.25f, 1, 1}, {1, 1, 0}}) {
        for (uint32_t signs = 0; signs < 8; ++signs) {
            const auto at = [&](uint32_t k) { return (signs >> k & 1) != 0 ? -v[k] : v[k]; };
            result.push_back({at(0), at(1), at(2), 0});
        }
    }
    return result;
}

std::string vectorText(const std::array<float, 4>& v) {
    char text[80];
    std::snprintf(text, sizeof text, "(%g, %g, %g)", static_cast<double>(v[0]), static_cast<double>(v[1]),
                  static_cast<double>(v[2]));
    return text;
}

// ---- Level of detail across an edge of a cube ----

constexpr VkExtent2D kStrip{60, 8};
constexpr double kStepX = 0.03, kStepY = 0.02;
constexpr uint32_t kSide = 64;

/// The range of levels of detail for the direction (1 + a x, b y, 1 - a x) at a pixel: the larger of x and z is the
/// major axis, and derivatives are those of the projection on its face (Vulkan, Cube Map Derivative Transformation).
struct LevelRange {
    double ideal, low, high;
};
LevelRange levelAt(double x, double y) {
    const std::array<double, 3> r{1 + kStepX * x, kStepY * y, 1 - kStepX * x}, dx{kStepX, 0, -kStepX}, dy{0, kStepY, 0};
    const size_t major = r[2] >= r[0] ? 2 : 0, other = 2 - major;
    const auto along = [&](size_t component, const std::array<double, 3>& d) {
        return 0.5 * kSide * (d[component] * r[major] - r[component] * d[major]) / (r[major] * r[major]);
    };
    const double ux = along(other, dx), vx = along(1, dx), uy = along(other, dy), vy = along(1, dy);
    const double u = std::max(std::abs(ux), std::abs(uy)), v = std::max(std::abs(vx), std::abs(vy));
    return {std::log2(std::max(std::hypot(ux, vx), std::hypot(uy, vy))), std::log2(std::max(u, v)), std::log2(u + v)};
}

}  // namespace

void l13(CaseInput& input) {
    SceneRecorder record("L13", "Directions that cross the edge between two faces of a cube.");
    SceneImage image;
    image.name = "cube";
    image.extent = {kSide, kSide};
    image.arrayLayers = 6;
    image.mipLevels = 7;
    image.viewType = VK_IMAGE_VIEW_TYPE_CUBE;
    for (uint32_t level = 0; level < 7; ++level) {
        for (uint32_t face = 0; face < 6; ++face) image.data.push_back(plain(kSide >> level, level));
    }
    char glsl[400];
    std::snprintf(glsl, sizeof glsl, R"(#version 450
layout(binding = 0) uniform samplerCube cube;
layout(location = 0) out vec4 color;
void main() {
    vec2 p = gl_FragCoord.xy - vec2(%u.0, %u.0);
    color = texture(cube, vec3(1.0 + %.3f * p.x, %.3f * p.y, 1.0 - %.3f * p.x));
}
)",
                  kStrip.width / 2, kStrip.height / 2, kStepX, kStepY, kStepX);
    const uint32_t cubeImage = record.texture(std::move(image));
    const uint32_t target = record.colorTarget("levels", VK_FORMAT_R32G32B32A32_SFLOAT, kStrip);
    record.pass(kStrip).color(target, {0, 0, 0, 0});
    record.draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(glsl)), 3)
        .texture(0, cubeImage, record.sampler(filtered(VK_FILTER_LINEAR)));
    record.output(target);
    judgePixels(input, input.scene(record.finish()), 0, kStrip,
                [](const PixelReader& pixels, const Declared&) -> Verdict {
                    Verdict worst;
                    for (uint32_t y = 0; y < kStrip.height; ++y) {
                        for (uint32_t x = 0; x < kStrip.width; ++x) {
                            const double px = x + 0.5 - kStrip.width / 2.0, py = y + 0.5 - kStrip.height / 2.0;
                            const LevelRange range = levelAt(px, py);
                            const double level = stepOf(pixels.number(x, y, 0));
                            // Differences between pixels of a quad instead of derivatives at the pixel, and 1/16 of a
                            // level.
                            const double slack = 0.15;
                            if (std::abs(level - std::max(0.0, range.ideal)) <= 1.0 / 16) continue;
                            const std::string text = pixelText(x, y) + " reads level " + std::to_string(level) +
                                                     ", by the projection on its face " + std::to_string(range.ideal);
                            const bool legal =
                                level >= std::max(0.0, range.low) - slack && level <= std::max(0.0, range.high) + slack;
                            worst = worst.worse(Verdict::inexact(legal, text));
                        }
                    }
                    return worst;
                });
}

void t14(CaseInput& input) {
    TextureTable table;
    table.extent = {4, 4};
    table.layers = 4;
    table.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    for (uint32_t layer = 0; layer < 4; ++layer) table.levels.push_back(plain(4, layer));
    table.sampler = filtered(VK_FILTER_NEAREST);
    table.type = "sampler2DArray";
    table.expression = "textureLod(picture, c.xyz, 0.0)";
    for (const float layer : {0.5f, 1.5f, 2.5f, -0.5f, -7.0f, 0.0f, 0.49999997f, 0.50000006f, 1.0f, 2.4999998f,
                              2.5000002f, 3.0f, 3.5f, 4.0f, 1e10f})
        table.coordinates.push_back({0.3f, 0.6f, layer, 0});
    const size_t scene = input.scene(textureScene("T14", table));
    judgePixels(input, scene, 0, extentOf(table), [table](const PixelReader& pixels, const Declared&) -> Verdict {
        bool toEven = true, up = true;
        std::string text;
        for (uint32_t x = 0; x < table.coordinates.size(); ++x) {
            const double layer = static_cast<double>(table.coordinates[x][2]), seen = stepOf(pixels.number(x, 0, 0));
            const double even = std::clamp(std::nearbyint(layer), 0.0, 3.0),
                         upper = std::clamp(std::floor(layer + 0.5), 0.0, 3.0);
            if (std::abs(seen - even) > 0.01 && std::abs(seen - upper) > 0.01) {
                return Verdict::wrong("layer " + std::to_string(layer) + " reads layer " + std::to_string(seen));
            }
            if (std::abs(seen - even) > 0.01) {
                toEven = false;
                text = "layer " + std::to_string(layer) + " reads layer " + std::to_string(seen);
            }
            up = up && std::abs(seen - upper) <= 0.01;
        }
        if (toEven) return {};
        return up ? Verdict::allowed(text + ": floor(a + 1/2)")
                  : Verdict::wrong(text + ", others are rounded to even: neither of the two rules");
    });
}

void t15(CaseInput& input) {
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
        for (const VkSamplerAddressMode address :
             {VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER}) {
            TextureTable table;
            table.extent = {8, 4};
            table.levels = {someTexels(table.extent, 15)};
            table.sampler = filtered(filter, address);
            table.sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
            table.sampler.maxLod = 0;
            table.expression = "textureLod(picture, c.xy, 0.0)";
            for (const float u : {-3.0f, -0.5f, 0.0f, 0.5f, 1.25f, 2.0f, 3.9999998f, 7.5f, 8.0f, 100.0f}) {
                for (const float v : {-0.25f, 0.5f, 2.75f, 4.0f}) table.coordinates.push_back({u, v, 0, 0});
            }
            TextureTable normalised = table;
            table.sampler.unnormalized = true;
            for (auto& c : normalised.coordinates) {
                c[0] /= 8;
                c[1] /= 4;
            }
            const size_t reference = addForOracle(input, textureScene("T15_normalised", normalised));
            const size_t scene = addForOracle(input, textureScene("T15", table));
            input.judge({scene, reference}, [](std::span<const Drawn* const> images, const Declared&) -> Verdict {
                const RenderedImage &ours = images[0]->at(0), &other = images[1]->at(0);
                return ours.texels == other.texels
                           ? Verdict{}
                           : Verdict::allowed("differs from normalised coordinates of a power of two");
            });
        }
    }
}

void t16(CaseInput& input) {
    TextureTable table = cube(VK_FILTER_NEAREST);
    const std::vector<std::array<float, 4>> vectors = tiedVectors();
    for (const float scale : {1.0f, 0x1p-20f, 0x1p20f}) {
        for (const auto& v : vectors) table.coordinates.push_back({v[0] * scale, v[1] * scale, v[2] * scale, 0});
    }
    const size_t scene = input.scene(textureScene("T16", table));
    judgePixels(
        input, scene, 0, extentOf(table), [vectors, table](const PixelReader& pixels, const Declared&) -> Verdict {
            Verdict worst;
            for (uint32_t x = 0; x < table.coordinates.size(); ++x) {
                const std::array<float, 4>& v = table.coordinates[x];
                const auto seen = static_cast<uint32_t>(std::lround(stepOf(pixels.number(x, 0, 0))));
                const auto first = static_cast<uint32_t>(std::lround(stepOf(pixels.number(x % vectors.size(), 0, 0))));
                if (seen != first)
                    return Verdict::wrong(vectorText(v) + " reads another face than the same vector, scaled");
                const std::vector<uint32_t> axes = largestAxes(v);
                if (seen == faceOf(axes.back(), v[axes.back()])) continue;  // z before y before x
                const std::string text = vectorText(v) + " reads face " + std::to_string(seen);
                const bool legal =
                    std::ranges::any_of(axes, [&](uint32_t axis) { return seen == faceOf(axis, v[axis]); });
                worst = worst.worse(legal ? Verdict::allowed(text + "; z before y before x is recommended")
                                          : Verdict::wrong(text + ", which is not one of its largest components"));
            }
            return worst;
        });
}

void t17(CaseInput& input) {
    TextureTable table = cube(VK_FILTER_LINEAR);
    table.coordinates = tiedVectors();
    const size_t scene = input.scene(textureScene("T17", table));
    judgePixels(input, scene, 0, extentOf(table), [table](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t x = 0; x < table.coordinates.size(); ++x) {
            const std::array<float, 4>& v = table.coordinates[x];
            double sum = 0, low = 6, high = 0;
            const std::vector<uint32_t> axes = largestAxes(v);
            for (const uint32_t axis : axes) {
                const double face = faceOf(axis, v[axis]);
                sum += face;
                low = std::min(low, face);
                high = std::max(high, face);
            }
            const double seen = stepOf(pixels.number(x, 0, 0)), average = sum / static_cast<double>(axes.size());
            if (std::abs(seen - average) <= 1e-5) continue;
            const std::string text = vectorText(v) + " mixes " + std::to_string(seen) + ", the average of its " +
                                     std::to_string(axes.size()) + " texels is " + std::to_string(average);
            worst = worst.worse(Verdict::inexact(seen >= low - 1e-4 && seen <= high + 1e-4, text));
        }
        return worst;
    });
    // Equal texels: that value, whatever the weights.
    TextureTable constant = table;
    for (Bytes& face : constant.levels) face = plain(4, 5);
    const size_t same = input.scene(textureScene("T17_constant", constant));
    judgePixels(input, same, 0, extentOf(table), [](const PixelReader& pixels, const Declared&) -> Verdict {
        const float expected = 160.0f / 255.0f;
        Verdict worst;
        for (uint32_t x = 0; x < pixels.extent().width; ++x) {
            const float seen = pixels.number(x, 0, 0);
            if (seen == expected) continue;
            const std::string text =
                "lookup " + std::to_string(x) + " of a constant cube gives " + std::to_string(seen);
            worst = worst.worse(Verdict::inexact(std::abs(seen - expected) <= 1e-5f, text));
        }
        return worst;
    });
}

}  // namespace vernier::conformance::hardcases
