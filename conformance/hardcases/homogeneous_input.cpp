#include "conformance/hardcases/homogeneous_input.h"

#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::hardcases {
namespace {

using exact::Rational;

const char* const kColorFragmentGlsl = R"(#version 450
layout(location = 0) in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vColor; }
)";

const char* const kBothVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 vSmooth;
layout(location = 1) noperspective out vec4 vLinear;
void main() {
    gl_Position = position;
    vSmooth = color;
    vLinear = color;
}
)";
const char* const kBothFragmentGlsl = R"(#version 450
layout(location = 0) in vec4 vSmooth;
layout(location = 1) noperspective in vec4 vLinear;
layout(location = 0) out vec4 perspective;
layout(location = 1) out vec4 linear;
void main() {
    perspective = vSmooth;
    linear = vLinear;
}
)";

}  // namespace

const char* const kColorVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 vColor;
void main() {
    gl_Position = position;
    vColor = color;
}
)";

exact::HomogeneousTriangle<Rational> exactTriangle(const ClipTriangle& triangle, const VkViewport& viewport) {
    std::array<exact::WindowVertex<Rational>, 3> v;
    for (size_t i = 0; i < 3; ++i) {
        exact::Clip<Rational> p;
        for (size_t c = 0; c < 4; ++c) p[c] = exact::rational(triangle[i][c]);
        v[i] = exact::toWindow(p, viewport);
    }
    return exact::HomogeneousTriangle<Rational>(v);
}

TriangleSides::TriangleSides(const ClipTriangle& clip, const VkViewport& viewport, int subPixelBits)
    : subUnit_(std::ldexp(1.0, -subPixelBits)) {
    const exact::HomogeneousTriangle<Rational> shape = exactTriangle(clip, viewport);
    orientation_ = sgn(shape.determinant);
    std::array<std::array<Rational, 3>, 2> cuts;
    for (size_t i = 0; i < 3; ++i) {
        std::array<Rational, 3> line;
        for (size_t c = 0; c < 3; ++c) {
            line[c] = shape.edge[i][c] * orientation_;
            cuts[0][c] += line[c] * exact::rational(clip[i][2]);
            cuts[1][c] += line[c] * (exact::rational(clip[i][3]) - exact::rational(clip[i][2]));
        }
        edges_[i] = lineOf(line);
    }
    for (size_t i = 0; i < 2; ++i) cuts_[i] = lineOf(cuts[i]);
}

TriangleSides::Line TriangleSides::lineOf(const std::array<Rational, 3>& coefficients) {
    Line line{coefficients, {}};
    for (size_t i = 0; i < 3; ++i) line.nearly[i] = coefficients[i].get_d();
    return line;
}

Side TriangleSides::sideOf(const Line& line, uint32_t x, uint32_t y) const {
    const double px = x + 0.5, py = y + 0.5;
    const auto& [a, b, c] = line.nearly;
    const double value = a * px + b * py + c, reach = (std::abs(a) + std::abs(b)) * subUnit_;
    const double noise = 0x1p-48 * (std::abs(a * px) + std::abs(b * py) + std::abs(c));
    if (std::abs(value) > reach + noise) return value > 0 ? Side::inside : Side::outside;
    if (std::abs(value) < reach - noise) return Side::open;
    const Rational exactly =
        line.exactly[0] * exact::rational(px) + line.exactly[1] * exact::rational(py) + line.exactly[2];
    if (abs(exactly) <= (abs(line.exactly[0]) + abs(line.exactly[1])) * exact::rational(subUnit_)) return Side::open;
    return exactly > 0 ? Side::inside : Side::outside;
}

SampleSides TriangleSides::at(uint32_t x, uint32_t y) const {
    SampleSides sides;
    for (size_t i = 0; i < 3; ++i) sides.edge[i] = sideOf(edges_[i], x, y);
    for (const Line& cut : cuts_) sides.clip = std::max(sides.clip, sideOf(cut, x, y));
    return sides;
}

void judgeSides(CaseInput& input, size_t scene, const std::vector<ClipTriangle>& triangles, VkExtent2D extent) {
    input.judge({scene}, [=](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        const auto counts = readCounts(*images[0], extent);
        if (!counts) return Verdict::wrong(counts.error().message);
        std::vector<TriangleSides> sides;
        for (const ClipTriangle& t : triangles) sides.emplace_back(t, viewportOf(extent), declared.subPixelBits);
        for (uint32_t y = 0; y < extent.height; ++y) {
            for (uint32_t x = 0; x < extent.width; ++x) {
                uint32_t low = 0, high = 0;
                for (const TriangleSides& each : sides) {
                    if (each.orientation() == 0) continue;
                    const Side side = each.at(x, y).worst();
                    low += side == Side::inside;
                    high += side != Side::outside;
                }
                const uint32_t count = (*counts)[size_t{y} * extent.width + x];
                if (count >= low && count <= high) continue;
                return Verdict::wrong(pixelText(x, y) + " is covered " + std::to_string(count) + " times, exactly " +
                                      std::to_string(low) + ".." + std::to_string(high) +
                                      " by the homogeneous edge functions");
            }
        }
        return {};
    });
}

std::vector<ClipPosition> flatten(const std::vector<ClipTriangle>& triangles) {
    std::vector<ClipPosition> result;
    for (const ClipTriangle& t : triangles) result.insert(result.end(), t.begin(), t.end());
    return result;
}

Result<Scene> colorScene(std::string_view name, const std::vector<ColorVertex>& vertices, VkExtent2D extent,
                         VkFormat format, VkPrimitiveTopology topology, std::string_view geometryGlsl) {
    SceneRecorder record(name, "Colours interpolated in perspective.");
    const uint32_t target = record.colorTarget("color", format, extent);
    const uint32_t buffer = record.vertexBuffer("vertices", vertices);
    PipelineRecorder pipeline = record.pipeline(record.vertex(kColorVertexGlsl), record.fragment(kColorFragmentGlsl))
                                    .binding(sizeof(ColorVertex))
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
                                    .topology(topology);
    if (!geometryGlsl.empty()) pipeline.geometry(record.geometry(geometryGlsl));
    record.pass(extent).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(buffer);
    record.output(target);
    return record.finish();
}

Result<Scene> interpolationScene(std::string_view name, const std::vector<ColorVertex>& vertices, VkExtent2D extent) {
    SceneRecorder record(name, "An attribute interpolated in perspective and linearly on the screen.");
    const uint32_t perspective = record.colorTarget("perspective", VK_FORMAT_R32G32B32A32_SFLOAT, extent);
    const uint32_t linear = record.colorTarget("linear", VK_FORMAT_R32G32B32A32_SFLOAT, extent);
    const uint32_t buffer = record.vertexBuffer("vertices", vertices);
    const uint32_t pipeline = record.pipeline(record.vertex(kBothVertexGlsl), record.fragment(kBothFragmentGlsl))
                                  .binding(sizeof(ColorVertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
                                  .targets(2);
    record.pass(extent).color(perspective, {0, 0, 0, 0}).color(linear, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(buffer);
    record.output(perspective);
    record.output(linear);
    return record.finish();
}

}  // namespace vernier::conformance::hardcases
