#include "conformance/hardcases/coverage_input.h"

#include "conformance/oracle/sample_locations.h"
#include "conformance/scenes/recorder.h"

#include <cmath>
#include <random>

namespace vernier::conformance::hardcases {
namespace {

using exact::GridPoint;
using exact::GridTriangle;

exact::SampleGrid gridOf(const CoverageOptions& options, int bits) {
    const GridPoint at = standardSample(options.samples, options.sample);
    const int64_t unit = (int64_t{1} << bits) / 16;
    return {options.extent, bits, {(options.windowX << bits) + at.x * unit, (options.windowY << bits) + at.y * unit}};
}

}  // namespace

const char* const kPositionVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
void main() {
    gl_Position = position;
    gl_PointSize = 1.0;
}
)";

const char* const kCountFragmentGlsl = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(16.0 / 255.0, 0.0, 0.0, 0.0); }
)";

VkPipelineColorBlendAttachmentState countingBlend() {
    VkPipelineColorBlendAttachmentState add{};
    add.blendEnable = VK_TRUE;
    add.srcColorBlendFactor = add.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    add.srcAlphaBlendFactor = add.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    add.colorWriteMask = 0xf;
    return add;
}

VkViewport viewportOf(VkExtent2D extent) {
    return {0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
}

ClipPosition clipAt(const WindowPoint& p, const VkViewport& viewport, float z, float w) {
    const double x = (p.x - viewport.x) * 2 / viewport.width - 1, y = (p.y - viewport.y) * 2 / viewport.height - 1;
    return {static_cast<float>(x * w), static_cast<float>(y * w), z * w, w};
}

std::vector<ClipPosition> clipAt(const WindowTriangles& triangles, const VkViewport& viewport) {
    std::vector<ClipPosition> result;
    for (const WindowTriangle& t : triangles) {
        for (const WindowPoint& p : t) result.push_back(clipAt(p, viewport));
    }
    return result;
}

Result<Scene> countScene(std::string_view name, const std::vector<ClipPosition>& positions,
                         const CountOptions& options) {
    SceneRecorder record(name, "Additive coverage counts.");
    const auto samples = static_cast<VkSampleCountFlagBits>(options.samples);
    const uint32_t drawn = record.colorTarget("counts", VK_FORMAT_R8G8B8A8_UNORM, options.extent, samples);
    const uint32_t resolved =
        options.samples > 1 ? record.colorTarget("resolved", VK_FORMAT_R8G8B8A8_UNORM, options.extent) : kNone;
    const uint32_t vertices = record.vertexBuffer("positions", positions);
    auto pipeline = record.pipeline(record.vertex(kPositionVertexGlsl), record.fragment(kCountFragmentGlsl))
                        .binding(sizeof(ClipPosition))
                        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                        .topology(options.topology)
                        .cull(options.cull, VK_FRONT_FACE_COUNTER_CLOCKWISE)
                        .samples(samples)
                        .blend(countingBlend());
    if (options.samples > 1) pipeline.sampleMask(1u << options.sample);
    if (options.depthClamp) pipeline.depthClamp();
    if (options.lineWidth != 1) pipeline.lineWidth(options.lineWidth);
    if (options.stippleFactor != 0) pipeline.stipple(options.stippleFactor, options.stipplePattern);
    pipeline.lineMode(options.lineMode).polygonMode(options.polygonMode);
    record.pass(options.extent).color(drawn, {0, 0, 0, 0}, resolved);
    const VkViewport viewport = options.viewport.value_or(viewportOf(options.extent));
    const auto count = static_cast<uint32_t>(positions.size());
    const uint32_t step = options.drawEach ? 3 : count;
    for (uint32_t first = 0; first < count; first += step) {
        auto draw = record.draw(pipeline, step)
                        .vertices(vertices)
                        .first(first)
                        .viewport(viewport.x, viewport.y, viewport.width, viewport.height);
        if (options.scissor) {
            draw.scissor(options.scissor->offset.x, options.scissor->offset.y, options.scissor->extent.width,
                         options.scissor->extent.height);
        }
    }
    record.output(options.samples > 1 ? resolved : drawn);
    return record.finish();
}

Result<std::vector<uint32_t>> readCounts(const Drawn& drawn, VkExtent2D extent, uint32_t samples) {
    const RenderedImage& image = drawn.at(0);
    if (image.format != VK_FORMAT_R8G8B8A8_UNORM || image.extent.width != extent.width ||
        image.extent.height != extent.height || image.texels.size() != size_t{extent.width} * extent.height * 4) {
        return invalidArgument("coverage image has the wrong format or extent");
    }
    const uint32_t step = kCountStep / samples;
    std::vector<uint32_t> counts;
    for (size_t i = 0; i < image.texels.size(); i += 4) {
        const auto red = std::to_integer<uint32_t>(image.texels[i]);
        const bool clean = image.texels[i + 1] == std::byte{0} && image.texels[i + 2] == std::byte{0};
        if (red % step != 0 || !clean) {
            const auto pixel = static_cast<uint32_t>(i / 4);
            return invalidArgument(pixelText(pixel % extent.width, pixel / extent.width) + ": red code " +
                                   std::to_string(red) + " is no sum of exact additions of " +
                                   std::to_string(kCountStep) + "/255");
        }
        counts.push_back(red / step);
    }
    return counts;
}

std::vector<GridTriangle> snapped(const WindowTriangles& triangles, int bits) {
    std::vector<GridTriangle> result;
    for (const WindowTriangle& t : triangles) {
        GridTriangle grid;
        for (size_t i = 0; i < 3; ++i) {
            grid[i] = {exact::toInt64(exact::snapNearestEven(exact::rational(t[i].x), bits)),
                       exact::toInt64(exact::snapNearestEven(exact::rational(t[i].y), bits))};
        }
        result.push_back(grid);
    }
    return result;
}

GridPoint standardSample(uint32_t samples, uint32_t sample) {
    return exact::standardSampleLocations(samples)[sample];
}

void judgeCoverage(CaseInput& input, size_t scene, const WindowTriangles& triangles, const CoverageOptions& options) {
    input.judge({scene}, [=](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        const auto counts = readCounts(*images[0], options.extent, options.samples);
        if (!counts) return Verdict::wrong(counts.error().message);
        const std::vector<GridTriangle> grid = snapped(triangles, declared.subPixelBits);
        const exact::SampleGrid samples = gridOf(options, declared.subPixelBits);
        const VkRect2D everything{{0, 0}, options.extent};
        const VkRect2D scissor = options.visible.value_or(options.scissor.value_or(everything));
        // Scissor and clip volume decide which pixels are written: the laws hold inside, outside nothing is drawn.
        std::string wrong = exact::checkScissor(samples, scissor, *counts);
        if (wrong.empty()) wrong = exact::checkLegalCoverage(grid, samples, scissor, *counts);
        if (wrong.empty() && options.tiling) wrong = exact::checkPartition(grid, samples, scissor, *counts);
        if (!wrong.empty()) return Verdict::wrong(wrong);
        wrong = exact::checkDeclaredCoverage(grid, samples, scissor, *counts);
        return wrong.empty() ? Verdict{} : Verdict::allowed(wrong);
    });
}

size_t addCoverage(CaseInput& input, std::string_view name, const WindowTriangles& triangles,
                   const CoverageOptions& options) {
    VkViewport viewport = options.viewport.value_or(viewportOf(options.extent));
    const std::vector<ClipPosition> positions = clipAt(triangles, viewport);
    CountOptions drawn = options;
    viewport.x -= static_cast<float>(options.windowX);
    viewport.y -= static_cast<float>(options.windowY);
    drawn.viewport = viewport;
    const size_t scene = input.scene(countScene(name, positions, drawn));
    judgeCoverage(input, scene, triangles, options);
    return scene;
}

void judgeEmpty(CaseInput& input, size_t scene, const CountOptions& options, std::string why) {
    input.judge({scene}, [=](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        const auto counts = readCounts(*images[0], options.extent, options.samples);
        if (!counts) return Verdict::wrong(counts.error().message);
        for (uint32_t i = 0; i < counts->size(); ++i) {
            if ((*counts)[i] == 0) continue;
            return Verdict::wrong(pixelText(i % options.extent.width, i / options.extent.width) + " is covered " +
                                  std::to_string((*counts)[i]) + " times, exactly 0; " + why);
        }
        return {};
    });
}

WindowTriangles jitteredTiling(uint32_t cells, double cellPixels, double jitterPixels, double resolution,
                               uint32_t seed) {
    std::mt19937 random(seed);
    const auto jitter = [&] {
        const double unit = static_cast<double>(random()) / 4294967296.0;
        return std::floor((unit * 2 - 1) * jitterPixels * resolution) / resolution;
    };
    std::vector<WindowPoint> points;
    for (uint32_t y = 0; y <= cells; ++y) {
        for (uint32_t x = 0; x <= cells; ++x) {
            const double dx = jitter(), dy = jitter();
            points.push_back({(x + 0.5) * cellPixels + dx, (y + 0.5) * cellPixels + dy});
        }
    }
    WindowTriangles triangles;
    const size_t row = cells + 1;
    for (size_t y = 0; y < cells; ++y) {
        for (size_t x = 0; x < cells; ++x) {
            const WindowPoint &a = points[y * row + x], &b = points[y * row + x + 1];
            const WindowPoint &c = points[(y + 1) * row + x], &d = points[(y + 1) * row + x + 1];
            if (random() & 1) {
                triangles.push_back({a, b, c});
                triangles.push_back({d, c, b});
            } else {
                triangles.push_back({a, b, d});
                triangles.push_back({c, a, d});
            }
        }
    }
    return triangles;
}

std::string pixelText(uint32_t x, uint32_t y) {
    return std::string("pixel (").append(std::to_string(x)).append(", ").append(std::to_string(y)).append(")");
}

}  // namespace vernier::conformance::hardcases
