// M: multisampling.
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/judges.h"
#include "conformance/oracle/encode.h"
#include "conformance/oracle/quantise.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{32, 32};
constexpr uint32_t kCounts[] = {2, 4, 8, 16};

VkSampleCountFlagBits flag(uint32_t samples) {
    return static_cast<VkSampleCountFlagBits>(samples);
}

std::string fragmentOf(const std::string& declarations, const std::string& body) {
    return "#version 450\n" + declarations + "layout(location = 0) out vec4 color;\nvoid main() { " + body + " }\n";
}

// A tiling whose edges run through samples: vertices on multiples of 1/16 pixel.
WindowTriangles sampleTiling(uint32_t seed) {
    return jitteredTiling(7, 4.25, 1.4, 16, seed);
}

void m01(CaseInput& input) {
    for (const uint32_t samples : kCounts) {
        for (uint32_t sample = 0; sample < samples; ++sample) {
            CoverageOptions options;
            options.extent = kTarget;
            options.tiling = true;
            options.samples = samples;
            options.sample = sample;
            addCoverage(input, "M01", sampleTiling(samples), options);
        }
    }
}

struct MovedVertex {
    ClipPosition position;
    float value;
};

// Where each fragment's centroid is, a ramp is inside its triangle: it is 0 at one edge, 1 at the opposite vertex.
Result<Scene> centroidScene(uint32_t samples) {
    SceneRecorder record("M02", "A ramp at centroids, per triangle within 0 and 1.");
    const uint32_t drawn = record.colorTarget("drawn", VK_FORMAT_R8G8B8A8_UNORM, kTarget, flag(samples));
    const uint32_t resolved = record.colorTarget("resolved", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    std::vector<MovedVertex> vertices;
    for (const WindowTriangle& t : sampleTiling(40 + samples)) {
        for (size_t i = 0; i < 3; ++i) vertices.push_back({clipAt(t[i], viewportOf(kTarget)), i == 0 ? 1.0f : 0.0f});
    }
    const uint32_t vertex = record.vertex(R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in float value;
layout(location = 0) out float vValue;
void main() {
    gl_Position = position;
    vValue = value;
}
)");
    // Rounding of weights may leave the triangle by a trace.
    const uint32_t fragment = record.fragment(
        fragmentOf("layout(location = 0) centroid in float vValue;\n",
                   "color = vec4(vValue >= -1e-4 && vValue <= 1.0 + 1e-4 ? 1.0 : 0.0, 1.0, 0.0, 1.0);"));
    const uint32_t pipeline = record.pipeline(vertex, fragment)
                                  .binding(sizeof(MovedVertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32_SFLOAT, sizeof(ClipPosition))
                                  .samples(flag(samples));
    record.pass(kTarget).color(drawn, {0, 0, 0, 0}, resolved);
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("vertices", vertices));
    record.output(resolved);
    return record.finish();
}

void m02(CaseInput& input) {
    for (const uint32_t samples : kCounts) {
        const size_t scene = input.scene(centroidScene(samples));
        judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared& declared) -> Verdict {
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    if (pixels.code(x, y, 0) == pixels.code(x, y, 1)) continue;
                    // Snapping moves an edge by up to a sub-unit off the ramp's zero: not so on this grid of 1/16.
                    if (declared.subPixelBits < 4) continue;
                    return Verdict::wrong(pixelText(x, y) + ": a centroid lies outside its triangle");
                }
            }
            return {};
        });
    }
}

// The same tiling counted with the shader run once per pixel and once per sample.
Result<Scene> shadedCounts(uint32_t samples, bool perSample) {
    SceneRecorder record("M03", "Coverage counts with and without sample shading.");
    const uint32_t drawn = record.colorTarget("drawn", VK_FORMAT_R8G8B8A8_UNORM, kTarget, flag(samples));
    const uint32_t resolved = record.colorTarget("resolved", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    WindowTriangles triangles = sampleTiling(50 + samples);
    triangles.push_back({{{1.25, 3}, {30, 7.5}, {12, 31}}});
    const std::vector<ClipPosition> positions = clipAt(triangles, viewportOf(kTarget));
    const uint32_t pipeline =
        record
            .pipeline(record.vertex(kPositionVertexGlsl),
                      record.fragment(fragmentOf(
                          "", perSample ? "color = vec4(gl_SampleID >= 0 ? 16.0 / 255.0 : 0.0, 0.0, 0.0, 0.0);"
                                        : "color = vec4(16.0 / 255.0, 0.0, 0.0, 0.0);")))
            .binding(sizeof(ClipPosition))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
            .samples(flag(samples))
            .blend(countingBlend());
    record.pass(kTarget).color(drawn, {0, 0, 0, 0}, resolved);
    record.draw(pipeline, static_cast<uint32_t>(positions.size()))
        .vertices(record.vertexBuffer("positions", positions));
    record.output(resolved);
    return record.finish();
}

void m03(CaseInput& input) {
    for (const uint32_t samples : kCounts) {
        const size_t perPixel = input.scene(shadedCounts(samples, false));
        judgeSame(input, input.scene(shadedCounts(samples, true)), perPixel,
                  "sample shading changes how often the shader runs, not what is covered");
    }
}

// Alpha rises from pixel to pixel; what is left of white after resolving is the share of samples.
Result<Scene> alphaScene(uint32_t samples) {
    constexpr VkExtent2D kRamp{65, 8};
    SceneRecorder record("M04", "Alpha to coverage.");
    const uint32_t drawn = record.colorTarget("drawn", VK_FORMAT_R8G8B8A8_UNORM, kRamp, flag(samples));
    const uint32_t resolved = record.colorTarget("resolved", VK_FORMAT_R8G8B8A8_UNORM, kRamp);
    const uint32_t pipeline =
        record
            .pipeline(record.vertex(kCoverVertexGlsl),
                      record.fragment(fragmentOf("", "color = vec4(1.0, 1.0, 1.0, floor(gl_FragCoord.x) / 64.0);")))
            .samples(flag(samples))
            .alphaToCoverage();
    record.pass(kRamp).color(drawn, {0, 0, 0, 0}, resolved);
    record.draw(pipeline, 3);
    record.output(resolved);
    return record.finish();
}

void m04(CaseInput& input) {
    for (const uint32_t samples : kCounts) {
        const size_t scene = input.scene(alphaScene(samples));
        judgePixels(input, scene, 0, {65, 8}, [](const PixelReader& pixels, const Declared&) -> Verdict {
            for (uint32_t y = 0; y < 8; ++y) {
                if (pixels.code(0, y, 0) != 0) return Verdict::wrong(pixelText(0, y) + ": alpha 0 covers something");
                if (pixels.code(64, y, 0) != 255)
                    return Verdict::wrong(pixelText(64, y) + ": alpha 1 does not cover all samples");
            }
            // The pattern may depend on the place: rows of pixels a dither's width apart are compared.
            uint64_t before = 0;
            for (uint32_t x = 0; x < 65; ++x) {
                uint64_t covered = 0;
                for (uint32_t y = 0; y < 8; ++y) covered += pixels.code(x, y, 0);
                if (covered + 8 * 64 < before) {
                    return Verdict::wrong("column " + std::to_string(x) + ": more alpha covers less");
                }
                before = std::max(before, covered);
            }
            return {};
        });
    }
}

// Writes one value into each sample, by sample masks, and resolves.
Result<Scene> sampleValues(std::string_view name, VkFormat format, const std::vector<std::string>& values,
                           const char* type = "vec4") {
    const auto samples = static_cast<uint32_t>(values.size());
    SceneRecorder record(name, "One value per sample, resolved.");
    const uint32_t drawn = record.colorTarget("drawn", format, {4, 4}, flag(samples));
    const uint32_t resolved = record.colorTarget("resolved", format, {4, 4});
    const uint32_t cover = record.vertex(kCoverVertexGlsl);
    record.pass({4, 4}).color(drawn, {0, 0, 0, 0}, resolved);
    for (uint32_t s = 0; s < samples; ++s) {
        const std::string glsl = std::string("#version 450\nlayout(location = 0) out ") + type +
                                 " color;\nvoid main() { color = " + type + "(" + values[s] + "); }\n";
        record.draw(record.pipeline(cover, record.fragment(glsl)).samples(flag(samples)).sampleMask(1u << s), 3);
    }
    record.output(resolved);
    return record.finish();
}

using Codes = std::vector<uint32_t>;

std::vector<std::string> asFractions(const Codes& codes) {
    std::vector<std::string> values;
    for (const uint32_t code : codes) values.push_back(std::to_string(code) + ".0 / 255.0");
    return values;
}

// All pixels have the same red code, one of `legal`; `best` is exact.
void judgeRed(CaseInput& input, size_t scene, std::vector<uint64_t> legal, std::vector<uint64_t> best,
              std::string rule) {
    judgePixels(input, scene, 0, {4, 4}, [=](const PixelReader& pixels, const Declared&) -> Verdict {
        const uint64_t code = pixels.code(0, 0, 0);
        for (uint32_t i = 1; i < 16; ++i) {
            if (pixels.code(i % 4, i / 4, 0) != code)
                return Verdict::wrong(pixelText(i % 4, i / 4) + " differs from pixel (0, 0)");
        }
        if (std::ranges::count(best, code) != 0) return {};
        const std::string text =
            "resolved to code " + std::to_string(code) + ", exactly " + std::to_string(best[0]) + "; " + rule;
        return std::ranges::count(legal, code) != 0 ? Verdict::allowed(text) : Verdict::wrong(text);
    });
}

void m05(CaseInput& input) {
    for (const Codes& codes : {Codes{0, 1},
                               {0, 0, 0, 1},
                               {255, 254, 255, 254},
                               {3, 4, 4, 4},
                               {10, 200, 33, 77},
                               {128, 128, 128, 128},
                               {1, 2, 3, 4, 5, 6, 7, 9}}) {
        uint32_t sum = 0;
        for (const uint32_t code : codes) sum += code;
        const auto n = static_cast<uint32_t>(codes.size());
        const uint64_t below = sum / n, above = (sum + n - 1) / n;
        const uint32_t rest = sum % n;
        std::vector<uint64_t> best{rest * 2 < n ? below : above};
        if (rest * 2 == n) best.push_back(below);
        judgeRed(input, input.scene(sampleValues("M05", VK_FORMAT_R8G8B8A8_UNORM, asFractions(codes))), {below, above},
                 best, "the average of the samples, rounded to a neighbour");
    }
}

void m06(CaseInput& input) {
    for (const Codes& codes : {Codes{0, 0, 255, 255}, {20, 20, 20, 20}, {0, 64, 128, 255}, {13, 13, 13, 200}}) {
        double linear = 0, encoded = 0;
        std::vector<std::string> values;
        for (const uint32_t code : codes) {
            const double value = exact::srgbDecode(code / 255.0);
            linear += value / 4;
            encoded += code / 4.0;
            values.push_back(std::to_string(static_cast<float>(value)));
        }
        const double inLinear = exact::srgbEncode(linear) * 255;
        const auto around = [](double x) {
            return std::pair{static_cast<uint64_t>(std::floor(x)), static_cast<uint64_t>(std::ceil(x))};
        };
        const auto [lowLinear, highLinear] = around(inLinear);
        const auto [lowEncoded, highEncoded] = around(encoded);
        judgeRed(input, input.scene(sampleValues("M06", VK_FORMAT_R8G8B8A8_SRGB, values)),
                 {lowLinear, highLinear, lowEncoded, highEncoded}, {static_cast<uint64_t>(std::nearbyint(inLinear))},
                 "averaged in linear light, or as codes");
    }
}

std::vector<std::string> fourFloats(const std::array<float, 4>& values) {
    std::vector<std::string> result;
    for (const float v : values)
        result.push_back("uintBitsToFloat(" + std::to_string(std::bit_cast<uint32_t>(v)) + "u)");
    return result;
}

void m07(CaseInput& input) {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kMax = std::numeric_limits<float>::max();
    struct Values {
        std::array<float, 4> samples;
        double average;
        bool mayOverflow;
    };
    for (const Values& v : {Values{{1, 2, 3, 4}, 2.5, false},
                            {{kMax, kMax, kMax, kMax}, kMax, true},
                            {{kInf, 1, 1, 1}, static_cast<double>(kInf), false},
                            {{kInf, -kInf, 1, 1}, std::nan(""), false},
                            {{0x1p-140f, 0x1p-140f, 0x1p-140f, 0x1p-140f}, 0x1p-140, true}}) {
        const size_t scene = input.scene(sampleValues("M07", VK_FORMAT_R32G32B32A32_SFLOAT, fourFloats(v.samples)));
        judgePixels(input, scene, 0, {4, 4}, [v](const PixelReader& pixels, const Declared&) -> Verdict {
            const float got = pixels.number(1, 1, 0);
            if (static_cast<double>(got) == v.average || (std::isnan(got) && std::isnan(v.average))) return {};
            const std::string text = "resolved to " + std::to_string(got) + ", exactly " + std::to_string(v.average);
            return v.mayOverflow && (std::isinf(got) || got == 0)
                       ? Verdict::allowed(text + "; sums may overflow, denormals may be flushed")
                       : Verdict::wrong(text);
        });
    }
}

void m08(CaseInput& input) {
    const size_t scene =
        input.scene(sampleValues("M08", VK_FORMAT_R32_UINT, {"7u", "100u", "4000000000u", "1u"}, "uint"));
    judgeRed(input, scene, {7, 100, 4000000000u, 1}, {7}, "integers are not averaged: one sample's value");
}

// Mask of the pipeline, mask of the shader, coverage of a triangle: what is written is their intersection.
void m09(CaseInput& input) {
    const WindowTriangle triangle{{{3, 2.5}, {29.75, 9}, {11.5, 30}}};
    for (const uint32_t pipelineMask : {0xfu, 0x5u, 0x8u}) {
        for (const uint32_t shaderMask : {0xfu, 0x6u, 0x1u}) {
            SceneRecorder record("M09", "Sample masks of pipeline and shader.");
            const uint32_t drawn = record.colorTarget("drawn", VK_FORMAT_R8G8B8A8_UNORM, kTarget, flag(4));
            const uint32_t resolved = record.colorTarget("resolved", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
            const std::vector<ClipPosition> positions = clipAt({triangle}, viewportOf(kTarget));
            const uint32_t pipeline =
                record
                    .pipeline(record.vertex(kPositionVertexGlsl),
                              record.fragment(fragmentOf("", "gl_SampleMask[0] = " + std::to_string(shaderMask) +
                                                                 "; color = vec4(16.0 / 255.0, 0.0, 0.0, 0.0);")))
                    .binding(sizeof(ClipPosition))
                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                    .samples(flag(4))
                    .sampleMask(pipelineMask)
                    .blend(countingBlend());
            record.pass(kTarget).color(drawn, {0, 0, 0, 0}, resolved);
            record.draw(pipeline, 3).vertices(record.vertexBuffer("positions", positions));
            record.output(resolved);
            const size_t scene = input.scene(record.finish());
            const uint32_t mask = pipelineMask & shaderMask;
            judgePixels(input, scene, 0, kTarget, [=](const PixelReader& pixels, const Declared& declared) -> Verdict {
                const exact::GridTriangle grid = snapped({triangle}, declared.subPixelBits)[0];
                const int64_t unit = (int64_t{1} << declared.subPixelBits) / 16;
                Verdict worst;
                for (uint32_t y = 0; y < kTarget.height; ++y) {
                    for (uint32_t x = 0; x < kTarget.width; ++x) {
                        uint64_t low = 0, high = 0, exactly = 0;
                        for (uint32_t s = 0; s < 4; ++s) {
                            if ((mask >> s & 1) == 0) continue;
                            const exact::GridPoint at = standardSample(4, s);
                            const exact::GridPoint p{(int64_t{x} * 16 + at.x) * unit, (int64_t{y} * 16 + at.y) * unit};
                            const exact::Coverage coverage = exact::classify(grid, p);
                            low += coverage == exact::Coverage::must;
                            high += coverage != exact::Coverage::mustNot;
                            exactly += exact::covers(grid, p);
                        }
                        const uint64_t covered = pixels.code(x, y, 0) / 4;
                        if (covered == exactly) continue;
                        const std::string text = pixelText(x, y) + " has " + std::to_string(covered) +
                                                 " samples, exactly " + std::to_string(exactly) +
                                                 "; the AND of coverage and masks";
                        worst = worst.worse(Verdict::inexact(covered >= low && covered <= high, text));
                    }
                }
                return worst;
            });
        }
    }
}

// Every sample of N against a single-sampled image whose centres are where the samples are.
void m10(CaseInput& input) {
    const WindowTriangles triangles = jitteredTiling(5, 6.1, 2.3, 256, 10);
    for (const uint32_t samples : kCounts) {
        for (uint32_t sample = 0; sample < samples; ++sample) {
            CountOptions options;
            options.extent = kTarget;
            const exact::GridPoint at = standardSample(samples, sample);
            const double dx = (8 - static_cast<double>(at.x)) / 16, dy = (8 - static_cast<double>(at.y)) / 16;
            WindowTriangles moved = triangles;
            for (WindowTriangle& t : moved) {
                for (WindowPoint& p : t) p = {p.x + dx, p.y + dy};
            }
            const size_t single = input.scene(countScene("M10_single", clipAt(moved, viewportOf(kTarget)), options));
            options.samples = samples;
            options.sample = sample;
            const size_t multi = input.scene(countScene("M10", clipAt(triangles, viewportOf(kTarget)), options));
            input.judge({multi, single}, [samples](std::span<const Drawn* const> images, const Declared&) -> Verdict {
                const auto a = readCounts(*images[0], kTarget, samples), b = readCounts(*images[1], kTarget);
                if (!a || !b) return Verdict::wrong((a ? b : a).error().message);
                for (uint32_t i = 0; i < a->size(); ++i) {
                    if ((*a)[i] == (*b)[i]) continue;
                    return Verdict::wrong(pixelText(i % kTarget.width, i / kTarget.width) + " is covered " +
                                          std::to_string((*a)[i]) + " times, at the same place single-sampled " +
                                          std::to_string((*b)[i]) + " times");
                }
                return {};
            });
        }
    }
}

constexpr std::string_view kSamples = "Vulkan, Multisampling: standard sample locations";
constexpr std::string_view kResolve = "Vulkan, Multisample Resolve Operations";

const std::vector<HardCase> kCases{
    {"M01", "Tilings with vertices on 1/16 pixel, every sample of 2, 4, 8 and 16 by itself", "A partition per sample.",
     kSamples, m01},
    {"M02",
     "Centroids in partly covered pixels, 2 to 16 samples",
     "They lie inside the triangle.",
     "Vulkan, Interpolation Decorations: Centroid",
     m02,
     {},
     {{"lavapipe", "its CI lists failures of centroids at edges for 2 to 8 samples"}}},
    {"M03",
     "The same coverage with the shader run per pixel and per sample",
     "Only the number of invocations changes.",
     "Vulkan, Sample Shading",
     m03,
     {},
     {{"lavapipe", "its CI lists sample shading with 4 samples that differs at times"}}},
    {"M04", "Alpha to coverage for alpha 0 to 1 in steps of 1/64", "0 covers nothing, 1 all, more alpha never less.",
     "Vulkan, Multisample Coverage", m04},
    {"M05", "Resolving UNORM8 samples with odd sums", "The average, either neighbour.", kResolve, m05},
    {"M06", "Resolving sRGB samples", "Averaged in linear light or as codes. Declared: in linear light.", kResolve,
     m06},
    {"M07", "Resolving floats: largest finite, infinities of both signs, denormals",
     "The average: infinite, NaN; finite where sums are scaled first.", kResolve, m07},
    {"M08", "Resolving integers", "The value of one sample. Declared: sample 0.", kResolve, m08},
    {"M09", "Sample masks of pipeline and shader", "The AND of coverage and both masks.",
     "Vulkan, Sample Mask Test; Multisample Coverage", m09},
    {"M10", "Every sample against a single-sampled image shifted to it", "The same coverage.", kSamples, m10},
};

}  // namespace

std::span<const HardCase> multisampleCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
