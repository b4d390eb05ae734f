// D: depth precision, bias, clamp.
#include "conformance/hardcases/depth_input.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/judges.h"
#include "conformance/oracle/depth_exact.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget = kDepthExtent;
constexpr float kInf = std::numeric_limits<float>::infinity();

std::string writes(const char* color) {
    return std::string("#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = ") + color + "; }\n";
}

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

constexpr VkFormat kDepthFormats[] = {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32,
                                      VK_FORMAT_D24_UNORM_S8_UINT};

// A constant depth is stored as one of its two codes, the same everywhere.
void constantDepth(CaseInput& input, std::string_view name, float z) {
    for (const VkFormat format : kDepthFormats) {
        DepthDraw how;
        how.format = format;
        const size_t scene = input.scene(depthScene(name, depthPlane(z, z, z), how));
        const exact::CodeSet codes = exact::encodeDepth(format, exact::rational(z));
        judgePixels(input, scene, 0, kTarget, [codes](const PixelReader& pixels, const Declared&) -> Verdict {
            const uint64_t first = pixels.code(0, 0, 0);
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    const uint64_t code = pixels.code(x, y, 0);
                    if (code == first && codes.permits(code)) continue;
                    return Verdict::wrong(pixelText(x, y) + " has depth code " + std::to_string(code) + ", permitted " +
                                          std::to_string(codes.below) + " or " + std::to_string(codes.above) +
                                          ", elsewhere " + std::to_string(first));
                }
            }
            return first == codes.nearest ? Verdict{} : Verdict::allowed("code " + std::to_string(first));
        });
    }
}

void d01(CaseInput& input) {
    for (const float z : {0.25f, 0.7f, 1.0f / 3}) constantDepth(input, "D01", z);
}
void d02(CaseInput& input) {
    for (const float z : {0.0f, 1.0f}) constantDepth(input, "D02", z);
}

// Steep triangles with all kinds of depths and w, far beyond the target and across the near plane.
std::vector<ClipPosition> steepTriangles() {
    std::vector<ClipPosition> result;
    size_t i = 0;
    for (const WindowTriangle& t : jitteredTiling(6, 10.5, 4, 0x1p12, 3)) {
        for (const WindowPoint& p : t) {
            const float w = 0.5f + static_cast<float>(i * 7 % 11) * 0.3f;
            const float z = static_cast<float>(i * 5 % 13) / 13.0f * 0.99f + 0.003f;
            result.push_back(clipAt(p, viewportOf(kTarget), z, w));
            ++i;
        }
    }
    result.push_back({-9, -7, -2, 1.5f});
    result.push_back({11, -3, 4, 5});
    result.push_back({0.5f, 12, 3, 6});
    return result;
}

// Red where only the first of two sets of triangles was drawn, green where the second one passed its depth test.
Result<Scene> twoDraws(std::string_view name, VkFormat format, const std::vector<ClipPosition>& first,
                       const std::vector<ClipPosition>& second, VkCompareOp firstOp, VkCompareOp secondOp,
                       float clear) {
    SceneRecorder record(name, "Two draws with depth tests.");
    const uint32_t color = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const uint32_t depth = record.depthTarget("depth", format, kTarget);
    const uint32_t vertex = record.vertex(kPositionVertexGlsl);
    record.pass(kTarget).color(color, {0, 0, 0, 1}).depthStencil(depth, clear);
    const auto draw = [&](const std::vector<ClipPosition>& positions, const char* written, VkCompareOp op) {
        const uint32_t pipeline = record.pipeline(vertex, record.fragment(writes(written)))
                                      .binding(sizeof(ClipPosition))
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                      .depth(op);
        record.draw(pipeline, static_cast<uint32_t>(positions.size()))
            .vertices(record.vertexBuffer("positions", positions));
    };
    draw(first, "vec4(1.0, 0.0, 0.0, 1.0)", firstOp);
    draw(second, "vec4(0.0, 1.0, 0.0, 1.0)", secondOp);
    record.output(color);
    return record.finish();
}

// No pixel is left red, and at least `least` are green.
void judgeSecondPasses(CaseInput& input, size_t scene, size_t least, std::string why) {
    judgePixels(input, scene, 0, kTarget, [=](const PixelReader& pixels, const Declared&) -> Verdict {
        size_t passed = 0;
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                passed += pixels.code(x, y, 1) == 255;
                if (pixels.code(x, y, 0) != 0) return Verdict::wrong(pixelText(x, y) + ": " + why);
            }
        }
        return passed < least ? Verdict::wrong("only " + std::to_string(passed) + " pixels are covered") : Verdict{};
    });
}

void d03(CaseInput& input) {
    for (const VkFormat format : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM}) {
        const std::vector<ClipPosition> data = steepTriangles();
        const size_t scene =
            input.scene(twoDraws("D03", format, data, data, VK_COMPARE_OP_LESS, VK_COMPARE_OP_EQUAL, 1));
        judgeSecondPasses(input, scene, 2000, "the second draw of the same triangles failed EQUAL against the first");
    }
}

// Reversed depth: z = near / distance. Two parallel surfaces at 10 km, the nearer one drawn second.
void d04(CaseInput& input) {
    constexpr float kNear = 0.01f;
    // Eight ULP of the depth apart where they face the eye, and more where they lean.
    const auto surface = [](float distance, float lean) {
        std::vector<ClipPosition> result;
        for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {3.0f, -1.0f}, {-1.0f, 3.0f}}) {
            const float w = distance + lean * x;
            result.push_back({x * w, y * w, kNear, w});
        }
        return result;
    };
    for (const auto& [lean, gap] : {std::pair{0.0f, 0.0078125f}, {100.0f, 0.0625f}, {900.0f, 0.0625f}}) {
        const size_t scene =
            input.scene(twoDraws("D04", VK_FORMAT_D32_SFLOAT, surface(10000 + gap, lean), surface(10000, lean),
                                 VK_COMPARE_OP_GREATER, VK_COMPARE_OP_GREATER, 0));
        judgeSecondPasses(input, scene, 4096, "the nearer surface, " + number(gap) + " m nearer at 10 km, is hidden");
    }
}

void d05(CaseInput& input) {
    for (const VkFormat format : kDepthFormats) {
        for (const float constant : {1.0f, 100.0f, -37.0f}) {
            const exact::Rational half = exact::fraction(1, 2);
            const exact::BiasUnit r = exact::biasUnit(format, {half, half, half});
            const auto [low, high] = std::minmax({r.low.get_d() * constant, r.high.get_d() * constant});
            DepthDraw how;
            how.format = format;
            how.biasConstant = constant;
            // The stored codes are one rounding each away.
            judgeBias(input, "D05", depthPlane(0.5f, 0.5f, 0.5f), how, low, high, r.low.get_d(),
                      "r is 2^-n to 2 * 2^-n for fixed point, 2^(e-23) for float");
        }
    }
}

void d06(CaseInput& input) {
    for (size_t first = 0; first < 3; ++first) {
        std::array<float, 3> z{0.6f, 0.6f, 0.6f};
        z[first] = 0.3f;
        std::vector<ClipPosition> positions{{-1, -1, z[0], 1}, {3, -1, z[1], 1}, {-1, 3, z[2], 1}};
        DepthDraw how;
        how.biasConstant = 4096;
        // The largest depth is 0.6: e = -1 and r = 2^-24.
        judgeBias(input, "D06", positions, how, 0x1p-12, 0x1p-12, 4 * 0x1p-24,
                  "r follows the largest exponent in the primitive, whichever vertex has it");
    }
}

void d07(CaseInput& input) {
    for (const auto& [zx, zy] : {std::pair{0.3f, 0.0f}, {0.2f, 0.2f}, {-0.15f, 0.25f}, {0.05f, -0.3f}}) {
        DepthDraw how;
        how.biasSlope = 8;
        // A plane whose depth changes by zx over the width and zy over the height of the target.
        const std::vector<ClipPosition> positions = depthPlane(0.4f, 0.4f + 2 * zx, 0.4f + 2 * zy);
        const double x = std::abs(zx) / 64.0, y = std::abs(zy) / 64.0;
        judgeBias(input, "D07", positions, how, 8 * std::max(x, y), 8 * std::hypot(x, y), 0x1p-18,
                  "m is max(|dz/dx|, |dz/dy|) to the root of the sum of squares");
    }
}

void d08(CaseInput& input) {
    struct Clamp {
        float constant, clamp;
        double expected;
    };
    // 1e6 times r = 2^-24 is 0.0596.
    for (const Clamp& each : {Clamp{1e6f, 0.01f, 0.01},
                              {1e6f, 0.5f, 1e6 * 0x1p-24},
                              {1e6f, -0.01f, 1e6 * 0x1p-24},
                              {-1e6f, -0.01f, -0.01},
                              {-1e6f, 0.01f, -1e6 * 0x1p-24},
                              {1e6f, 0, 1e6 * 0x1p-24}}) {
        DepthDraw how;
        how.biasConstant = each.constant;
        how.biasClamp = each.clamp;
        judgeBias(input, "D08", depthPlane(0.6f, 0.6f, 0.6f), how, each.expected, each.expected, 1e-6,
                  "a positive clamp is an upper bound, a negative one a lower bound, 0 none");
    }
}

// A bias that leaves [0, 1]: fixed-point depths stay at the end of their range, they do not wrap around.
void d09(CaseInput& input) {
    for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32}) {
        const uint64_t most = format == VK_FORMAT_D16_UNORM ? 0xffff : 0xffffff;
        for (const bool up : {true, false}) {
            DepthDraw how;
            how.format = format;
            how.bias = true;
            how.biasConstant = up ? 1e7f : -1e7f;
            const size_t scene = input.scene(depthScene("D09", depthPlane(0.5f, 0.5f, 0.5f), how));
            judgeCodes(input, scene, 0, kTarget, {up ? most : 0}, "conversion to fixed point clamps to [0, 1]");
        }
    }
}

// A triangle almost seen edge-on: a sub-unit wide, through the whole depth range.
void d10(CaseInput& input) {
    for (const float clamp : {0.0f, 0.125f}) {
        DepthDraw how;
        how.bias = true;
        how.biasSlope = 1e30f;
        how.biasConstant = 1;
        how.biasClamp = clamp;
        const std::vector<ClipPosition> positions{clipAt({32.5 - 1.0 / 256, 4}, viewportOf(kTarget), 0.1f),
                                                  clipAt({32.5 + 1.0 / 256, 32}, viewportOf(kTarget), 0.9f),
                                                  clipAt({32.5 - 1.0 / 256, 60}, viewportOf(kTarget), 0.2f)};
        const size_t scene = input.scene(depthScene("D10", positions, how));
        judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    if (std::isnan(pixels.number(x, y, 0))) return Verdict::wrong(pixelText(x, y) + " has depth NaN");
                }
            }
            return {};
        });
    }
}

void d11(CaseInput& input) {
    for (const auto& [nearest, farthest] : {std::pair{1.0f, 0.0f}, {0.75f, 0.125f}, {0.375f, 0.375f}, {0.0f, 0.0f}}) {
        for (const VkFormat format : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM}) {
            DepthDraw how;
            how.format = format;
            how.minDepth = nearest;
            how.maxDepth = farthest;
            addForOracle(input, depthScene("D11", depthPlane(0.1f, 1.7f, 0.9f), how));
        }
    }
}

// With depth clamping every number ends in [0, 1]; NaN and, without clamping, numbers outside are the implementation's
// choice, the same in every pixel.
void d12(CaseInput& input) {
    for (const VkFormat format : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM}) {
        for (const float value : {-0.0f, std::nextafter(1.0f, 2.0f), -0x1p-126f, kInf, -kInf, 2.0f,
                                  std::numeric_limits<float>::quiet_NaN()}) {
            const size_t scene = input.scene(
                fragDepthScene("D12", format, std::bit_cast<uint32_t>(value), 0.5f, VK_COMPARE_OP_ALWAYS, true));
            judgePixels(input, scene, 0, kTarget, [=](const PixelReader& pixels, const Declared&) -> Verdict {
                const double clamped = std::clamp(static_cast<double>(value), 0.0, 1.0);
                const uint64_t first = pixels.code(0, 0, 0);
                const bool isFloat = format == VK_FORMAT_D32_SFLOAT;
                const double stored =
                    isFloat ? static_cast<double>(pixels.number(0, 0, 0)) : static_cast<double>(first) / 65535.0;
                if (!std::isnan(value) && stored != clamped) {
                    return Verdict::wrong("depth " + number(value) + " is stored as " + number(stored) + ", exactly " +
                                          number(clamped) + " after clamping");
                }
                for (uint32_t y = 0; y < kTarget.height; ++y) {
                    for (uint32_t x = 0; x < kTarget.width; ++x) {
                        if (pixels.code(x, y, 0) != first)
                            return Verdict::wrong(pixelText(x, y) + " differs from pixel (0, 0)");
                    }
                }
                return {};
            });
        }
    }
}

// -0 equals +0; a denormal is more than 0 where the implementation keeps denormals.
void d13(CaseInput& input) {
    const size_t zero =
        input.scene(fragDepthScene("D13_zero", VK_FORMAT_D32_SFLOAT, 0x80000000u, 0, VK_COMPARE_OP_NOT_EQUAL, false));
    judgeCodes(input, zero, 0, kTarget, {0}, "-0 equals +0: the test fails");
    const size_t denormal = input.scene(fragDepthScene(
        "D13_denormal", VK_FORMAT_D32_SFLOAT, std::bit_cast<uint32_t>(1e-40f), 0, VK_COMPARE_OP_GREATER, false));
    judgePixels(input, denormal, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
        const uint64_t code = pixels.code(20, 20, 0);
        if (code == std::bit_cast<uint32_t>(1e-40f)) return {};
        return code == 0 ? Verdict::allowed("the denormal is flushed to 0")
                         : Verdict::wrong("1e-40 is stored as " + std::to_string(code));
    });
}

// Codes of D24 through a float: nearest floats of the codes, near 0, in the middle and near 1.
void d14(CaseInput& input) {
    for (const uint32_t first : {0u, 8388608u - 2048, 12000000u, 16777216u - 4096}) {
        SceneRecorder record("D14", "Codes of 24 bits written through FragDepth.");
        const uint32_t depth = record.depthTarget("depth", VK_FORMAT_X8_D24_UNORM_PACK32, kTarget);
        std::vector<float> values(4096);
        for (uint32_t i = 0; i < 4096; ++i) values[i] = static_cast<float>((first + i) / 16777215.0);
        const uint32_t texture = record.texture("values", VK_FORMAT_R32_SFLOAT, kTarget, {bytesOf(values)});
        const uint32_t pipeline = record
                                      .pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D values;
void main() { gl_FragDepth = texelFetch(values, ivec2(gl_FragCoord.xy), 0).r; }
)"))
                                      .targets(0)
                                      .depth(VK_COMPARE_OP_ALWAYS);
        record.pass(kTarget).depthStencil(depth, 0.5f);
        record.draw(pipeline, 3).texture(0, texture, record.sampler(VK_FILTER_NEAREST));
        record.output(depth);
        const size_t scene = input.scene(record.finish());
        judgePixels(input, scene, 0, kTarget, [=](const PixelReader& pixels, const Declared&) -> Verdict {
            Verdict worst;
            for (uint32_t i = 0; i < 4096; ++i) {
                const uint64_t code = pixels.code(i % 64, i / 64, 0) & 0xffffff;
                const exact::CodeSet codes =
                    exact::encodeDepth(VK_FORMAT_X8_D24_UNORM_PACK32, exact::rational(values[i]));
                if (code == codes.nearest) continue;
                const std::string text = "depth " + number(values[i]) + " is stored as " + std::to_string(code) +
                                         ", nearest " + std::to_string(codes.nearest);
                worst = worst.worse(Verdict::inexact(codes.permits(code), text));
            }
            return worst;
        });
    }
}

// Two steep planes that cross, with four samples: which one is in front is decided per sample.
void d15(CaseInput& input) {
    for (const uint32_t samples : {2u, 4u, 8u}) {
        SceneRecorder record("D15", "Steep planes that cross, multisampled.");
        const auto count = static_cast<VkSampleCountFlagBits>(samples);
        const uint32_t color = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget, count);
        const uint32_t resolved = record.colorTarget("resolved", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
        const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kTarget, count);
        const uint32_t vertex = record.vertex(kPositionVertexGlsl);
        record.pass(kTarget).color(color, {0, 0, 0, 1}, resolved).depthStencil(depth);
        const auto draw = [&](const std::vector<ClipPosition>& positions, const char* written) {
            const uint32_t pipeline = record.pipeline(vertex, record.fragment(writes(written)))
                                          .binding(sizeof(ClipPosition))
                                          .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                          .samples(count)
                                          .depth(VK_COMPARE_OP_LESS);
            record.draw(pipeline, 3).vertices(record.vertexBuffer("positions", positions));
        };
        draw({{-1.3f, -0.9f, 0.02f, 1}, {1.1f, -0.7f, 0.97f, 1}, {0.1f, 0.95f, 0.31f, 1}}, "vec4(1.0, 0.0, 0.0, 1.0)");
        draw({{-0.9f, -0.95f, 0.83f, 1}, {0.95f, 0.2f, 0.04f, 1}, {-0.7f, 0.9f, 0.77f, 1}}, "vec4(0.0, 1.0, 0.0, 1.0)");
        record.output(resolved);
        addForOracle(input, record.finish());
    }
}

// The same depths tested early, and late because the shader writes them itself or may discard.
void d16(CaseInput& input) {
    const auto scene = [](const char* body) {
        SceneRecorder record("D16", "Early and late depth tests.");
        const uint32_t color = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
        const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kTarget);
        const std::vector<ClipPosition> data = steepTriangles();
        const std::string glsl =
            std::string("#version 450\nlayout(location = 0) out vec4 color;\nvoid main() {\n") + body +
            "    color = vec4(float(gl_PrimitiveID % 8) / 7.0, float(gl_PrimitiveID / 8) / 15.0, 0.0, 1.0);\n}\n";
        const uint32_t pipeline = record.pipeline(record.vertex(kPositionVertexGlsl), record.fragment(glsl))
                                      .binding(sizeof(ClipPosition))
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                      .depth(VK_COMPARE_OP_LESS);
        record.pass(kTarget).color(color, {0, 0, 0, 1}).depthStencil(depth);
        for (int copy = 0; copy < 2; ++copy) {
            record.draw(pipeline, static_cast<uint32_t>(data.size())).vertices(record.vertexBuffer("positions", data));
        }
        record.output(color);
        record.output(depth);
        return record.finish();
    };
    const size_t early = input.scene(scene(""));
    const size_t written = input.scene(scene("    gl_FragDepth = gl_FragCoord.z;\n"));
    const size_t discarding = input.scene(scene("    if (gl_FragCoord.x < -1.0) discard;\n"));
    judgeSame(input, written, early, "a depth copied from FragCoord.z is the depth that is tested early");
    judgeSame(input, discarding, early, "a test after the shader passes the same fragments as one before it");
}

constexpr std::string_view kBias = "Vulkan, Depth Bias";

const std::vector<HardCase> kCases{
    {"D01", "Constant depths 0.25, 0.7 and 1/3 in all depth formats",
     "One of the two codes around the value, the same everywhere.", "Vulkan, Depth Test; Conversion to Fixed-Point",
     d01},
    {"D02", "Depth 0 and 1 in all depth formats", "Codes 0 and the largest, exactly.",
     "Vulkan, Conversion to Fixed-Point", d02},
    {"D03",
     "The same triangles drawn again with an EQUAL depth test, D32 and D16",
     "Same vertices in the same order have the same depths: every fragment passes.",
     "Vulkan, Invariance",
     d03,
     {},
     {{"lavapipe", "z may differ for the same primitive when its origin rotation triggers"}}},
    {"D04", "Reversed depth: surfaces 8 mm and 6 cm apart at 10 km", "The order is kept: float resolves 1 mm there.",
     "Vulkan, Basic Polygon Rasterization: depth is linear in the window", d04},
    {"D05", "Constant depth bias in all depth formats", "A shift of r to 2r for fixed point, of 2^(e-23) for float.",
     kBias, d05},
    {"D06",
     "Constant bias with depths 0.3, 0.6, 0.6 in D32",
     "r follows the largest depth of the primitive: 2^-24.",
     kBias,
     d06,
     {},
     {{"swiftshader", "takes the exponents of z0, z1-z0, z2-z0: half the bias when the vertex with 0.3 is the base"}}},
    {"D07", "Slope bias on planes in four directions",
     "m between the larger derivative and the length of the gradient.", kBias, d07},
    {"D08", "Bias clamps above, below, of both signs and 0", "Upper bound, lower bound, none.", kBias, d08},
    {"D09", "A bias that leaves [0, 1] in fixed-point formats", "The end of the range, never around it.",
     "Vulkan, Conversion to Fixed-Point", d09},
    {"D10", "A slope bias on a triangle a sub-unit wide", "No NaN.", kBias, d10},
    {"D11", "Depth ranges reversed, narrowed and empty", "The order flips exactly; all depths lie in the range.",
     "Vulkan, Controlling the Viewport", d11},
    {"D12", "FragDepth of -0, 1 + ULP, denormal below 0, infinities, NaN, with depth clamping",
     "Clamped to [0, 1]; NaN anything, the same everywhere.", "Vulkan, Depth Clamping", d12},
    {"D13",
     "Depth comparison of -0 with 0, and of a denormal with 0",
     "Equal; more, where denormals are kept.",
     "IEEE 754 comparison",
     d13,
     {},
     {{"lavapipe", "runs with denormals flushed to zero: they compare equal to 0", Outcome::allowed}}},
    {"D14", "16384 codes of D24 written through a float", "The code nearest to the float.",
     "Vulkan, Conversion to Fixed-Point", d14},
    {"D15", "Steep planes that cross, with 2, 4 and 8 samples", "Depth is evaluated at every sample.",
     "Vulkan, Multisampling; Depth Test", d15},
    {"D16", "The same depths tested early and late", "The same image and the same depths.",
     "Vulkan, Invariance; Early Fragment Test", d16},
};

}  // namespace

std::span<const HardCase> depthCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
