// B: blending, rounding, formats.
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/format_cases.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/oracle/encode.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

std::string quoted(uint64_t code) {
    return std::to_string(code);
}

// One scene clears to the value, the other writes it from a shader.
Result<Scene> storeScene(std::string_view name, const char* glslValue, float value, bool drawn) {
    SceneRecorder record(name, drawn ? "Written by a fragment shader." : "Cleared.");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const float background = drawn ? 1.0f : value;
    record.pass(kTarget).color(target, {background, background, background, background});
    if (drawn) {
        const std::string glsl = std::string("#version 450\nlayout(location = 0) out vec4 color;\n") +
                                 "void main() { color = vec4(" + glslValue + "); }\n";
        record.draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(glsl)), 3);
    }
    record.output(target);
    return record.finish();
}

// One of the two codes around the value, the same in both scenes and everywhere.
void storedValue(CaseInput& input, std::string_view name, const char* glslValue, float value) {
    const size_t cleared = input.scene(storeScene(name, glslValue, value, false));
    const size_t drawn = input.scene(storeScene(name, glslValue, value, true));
    const exact::CodeSet codes = exact::encode({0, 0, 8, exact::Encoding::unorm}, exact::rational(value));
    for (const size_t scene : {cleared, drawn}) {
        judgePixels(input, scene, 0, kTarget, [codes](const PixelReader& pixels, const Declared&) -> Verdict {
            const uint64_t first = pixels.code(0, 0, 0);
            const std::string permitted = "permitted " + quoted(codes.below) + " or " + quoted(codes.above) +
                                          ", nearest " + quoted(codes.nearest);
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    for (uint8_t c = 0; c < 4; ++c) {
                        const uint64_t code = pixels.code(x, y, c);
                        if (code == first && codes.permits(code)) continue;
                        return Verdict::wrong(pixelText(x, y) + " channel " + "RGBA"[c] + " has code " + quoted(code) +
                                              ", " + permitted + ", and elsewhere " + quoted(first));
                    }
                }
            }
            return first == codes.nearest ? Verdict{} : Verdict::allowed("code " + quoted(first) + ", " + permitted);
        });
    }
    judgeSame(input, drawn, cleared, "a clear and a write of the same value store the same code");
}

void b01(CaseInput& input) {
    storedValue(input, "B01", "0.25", 0.25f);
}
void b02(CaseInput& input) {
    storedValue(input, "B02", "0.5", 0.5f);
}

constexpr VkExtent2D kCodes{1024, 1};

const char* const kCopyFragmentGlsl = R"(#version 450
layout(binding = 0) uniform sampler2D codes;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(codes, ivec2(gl_FragCoord.xy), 0); }
)";

// Texel i holds code i in every channel, modulo the channel's range and different from channel to channel.
Bytes allCodes(const exact::PixelFormat& format) {
    Bytes bytes(size_t{kCodes.width} * format.bytes);
    for (uint32_t i = 0; i < kCodes.width; ++i) {
        for (const exact::Component& c : format.all()) {
            exact::insertBits(bytes.data() + size_t{i} * format.bytes, c.offset, c.bits,
                              (i + c.channel * 37u) & ((uint64_t{1} << c.bits) - 1));
        }
    }
    return bytes;
}

// Every code fetched from a texture and written to a target of the same format.
void identity(CaseInput& input, std::string_view name, VkFormat format) {
    const Bytes codes = allCodes(*exact::findPixelFormat(format));
    SceneRecorder record(name, "Every code fetched from a texture and written to a target of the same format.");
    const uint32_t texture = record.texture("codes", format, kCodes, {codes});
    const uint32_t target = record.colorTarget("copy", format, kCodes);
    record.pass(kCodes).color(target, {0, 0, 0, 0});
    record.draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(kCopyFragmentGlsl)), 3)
        .texture(0, texture, record.sampler(VK_FILTER_NEAREST));
    record.output(target);
    const size_t scene = input.scene(record.finish());
    const RenderedImage expected{format, kCodes, codes};
    judgePixels(input, scene, 0, kCodes, [expected](const PixelReader& pixels, const Declared&) -> Verdict {
        const PixelReader written(expected);
        for (uint32_t x = 0; x < kCodes.width; ++x) {
            for (const exact::Component& c : pixels.format().all()) {
                const uint64_t before = written.code(x, 0, c.channel), after = pixels.code(x, 0, c.channel);
                if (before == after) continue;
                return Verdict::wrong("format " + std::to_string(expected.format) + ", channel " + "RGBA"[c.channel] +
                                      ": code " + quoted(before) + " came back as " + quoted(after) +
                                      "; a value that is exactly a code maps to that code");
            }
        }
        return {};
    });
}

void b03(CaseInput& input) {
    // Formats that every Vulkan implementation samples and renders to.
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM,
                                  VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_R5G6B5_UNORM_PACK16}) {
        identity(input, "B03", format);
    }
}
void b04(CaseInput& input) {
    identity(input, "B04", VK_FORMAT_R8G8B8A8_SRGB);
}

constexpr VkExtent2D kPairs{256, 256};

VkPipelineColorBlendAttachmentState blending(VkBlendFactor source, VkBlendFactor destination,
                                             VkBlendOp op = VK_BLEND_OP_ADD) {
    VkPipelineColorBlendAttachmentState state{};
    state.blendEnable = VK_TRUE;
    state.srcColorBlendFactor = state.srcAlphaBlendFactor = source;
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = destination;
    state.colorBlendOp = state.alphaBlendOp = op;
    state.colorWriteMask = 0xf;
    return state;
}

std::string writes(const std::string& color) {
    return "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = " + color + "; }\n";
}

// Two covering draws over a clear: the first writes `destination`, the second blends `source`.
Result<Scene> blendScene(std::string_view name, VkFormat format, VkExtent2D extent, const std::string& destination,
                         const std::string& source, const VkPipelineColorBlendAttachmentState& state,
                         const std::array<float, 4>& constants = {}) {
    SceneRecorder record(name, "A blend over a destination.");
    const uint32_t target = record.colorTarget("color", format, extent);
    const uint32_t cover = record.vertex(kCoverVertexGlsl);
    record.pass(extent).color(target, {0, 0, 0, 0});
    record.draw(record.pipeline(cover, record.fragment(writes(destination))), 3);
    record.draw(record.pipeline(cover, record.fragment(writes(source))).blend(state).blendConstants(constants), 3);
    record.output(target);
    return record.finish();
}

// Columns are source codes, rows destination codes.
void b06(CaseInput& input) {
    const std::string rows = "vec4(floor(gl_FragCoord.y) / 255.0)", columns = "floor(gl_FragCoord.x) / 255.0";
    const auto over = blending(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    for (const bool opaque : {true, false}) {
        const std::string source = "vec4(vec3(" + columns + "), " + (opaque ? "1.0" : "0.0") + ")";
        const size_t scene = input.scene(blendScene("B06", VK_FORMAT_R8G8B8A8_UNORM, kPairs, rows, source, over));
        judgePixels(input, scene, 0, kPairs, [opaque](const PixelReader& pixels, const Declared&) -> Verdict {
            for (uint32_t y = 0; y < 256; ++y) {
                for (uint32_t x = 0; x < 256; ++x) {
                    if (pixels.code(x, y, 0) == (opaque ? x : y)) continue;
                    return Verdict::wrong("source " + quoted(x) + " over destination " + quoted(y) + " with alpha " +
                                          (opaque ? "1" : "0") + " gives " + quoted(pixels.code(x, y, 0)));
                }
            }
            return {};
        });
    }
}

void b07(CaseInput& input) {
    SceneRecorder record("B07", "255 additions of 1/255.");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const uint32_t pipeline =
        record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(writes("vec4(1.0 / 255.0)")))
            .blend(blending(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE));
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    for (int i = 0; i < 255; ++i) record.draw(pipeline, 3);
    record.output(target);
    judgeCodes(input, input.scene(record.finish()), 0, kTarget, {255, 255, 255, 255},
               "every sum is a code: 255 times 1/255 is 1");
}

void b08(CaseInput& input) {
    const auto constant = blending(VK_BLEND_FACTOR_CONSTANT_COLOR, VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR);
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT}) {
        addForOracle(input, blendScene("B08", format, kTarget, "vec4(0.25, 0.5, 0.75, 1.0)",
                                       "vec4(1.5, -0.5, 0.5, 2.0)", constant, {1.5f, 0.5f, -0.5f, 2}));
    }
}

void b09(CaseInput& input) {
    for (const VkBlendOp op : {VK_BLEND_OP_SUBTRACT, VK_BLEND_OP_REVERSE_SUBTRACT}) {
        for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT}) {
            addForOracle(input,
                         blendScene("B09", format, kTarget, "vec4(0.2, 0.8, 0.4, 1.0)", "vec4(0.6, 0.4, 0.4, 0.2)",
                                    blending(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, op)));
        }
    }
}

void b10(CaseInput& input) {
    for (const VkBlendOp op : {VK_BLEND_OP_MIN, VK_BLEND_OP_MAX}) {
        // Factors that would change everything.
        addForOracle(input,
                     blendScene("B10", VK_FORMAT_R8G8B8A8_UNORM, kTarget, "vec4(51.0, 102.0, 153.0, 204.0) / 255.0",
                                "vec4(204.0, 51.0, 153.0, 0.0) / 255.0",
                                blending(VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC_ALPHA, op)));
    }
}

// A float written to a half: the neighbours, and at the end of the range the largest one or infinity.
void b11(CaseInput& input) {
    struct Half {
        float value;
        std::vector<uint64_t> codes;  // the nearest first
    };
    for (const Half& half : {Half{65504.0f, {0x7bff}},
                             {65519.99f, {0x7bff, 0x7c00}},
                             {65520.0f, {0x7c00, 0x7bff}},
                             {0x1p-24f, {1}},
                             {0x1p-25f, {0, 1}},
                             {0x1.8p-24f, {2, 1}},
                             {-65504.0f, {0xfbff}},
                             {1.0f, {0x3c00}},
                             {-0.0f, {0x8000, 0}},
                             {0.1f, {0x2e66, 0x2e67}}}) {
        SceneRecorder record("B11", "A float written to a half.");
        const uint32_t target = record.colorTarget("half", VK_FORMAT_R16_SFLOAT, {4, 4});
        const std::vector<float> texel{half.value};
        const uint32_t texture = record.texture("value", VK_FORMAT_R32_SFLOAT, {1, 1}, {bytesOf(texel)});
        record.pass({4, 4}).color(target, {1, 1, 1, 1});
        record
            .draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D value;
layout(location = 0) out vec4 color;
void main() { color = vec4(texelFetch(value, ivec2(0), 0).r); }
)")),
                  3)
            .texture(0, texture, record.sampler(VK_FILTER_NEAREST));
        record.output(target);
        judgePixels(input, input.scene(record.finish()), 0, {4, 4},
                    [half](const PixelReader& pixels, const Declared&) -> Verdict {
                        const uint64_t code = pixels.code(1, 1, 0);
                        if (code == half.codes[0]) return {};
                        const std::string text = std::to_string(half.value) + " is stored as " + quoted(code) +
                                                 ", nearest " + quoted(half.codes[0]);
                        const bool flushed = std::abs(half.value) < 0x1p-14f && (code & 0x7fff) == 0;
                        return flushed || std::ranges::count(half.codes, code) != 0 ? Verdict::allowed(text)
                                                                                    : Verdict::wrong(text);
                    });
    }
}

// All values of a ramp, stored in channels of 2 to 10 bits.
void b14(CaseInput& input) {
    constexpr VkExtent2D kRamp{1024, 2};
    for (const VkFormat format : {VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_R5G6B5_UNORM_PACK16}) {
        SceneRecorder record("B14", "A ramp in few bits.");
        const uint32_t target = record.colorTarget("color", format, kRamp);
        record.pass(kRamp).color(target, {0, 0, 0, 0});
        record.draw(
            record.pipeline(
                record.vertex(kCoverVertexGlsl),
                record.fragment(writes("vec4(floor(gl_FragCoord.x) / 1024.0 + floor(gl_FragCoord.y) / 4096.0)"))),
            3);
        record.output(target);
        judgePixels(
            input, input.scene(record.finish()), 0, kRamp, [](const PixelReader& pixels, const Declared&) -> Verdict {
                Verdict worst;
                for (uint32_t y = 0; y < 2; ++y) {
                    for (uint32_t x = 0; x < 1024; ++x) {
                        const exact::Rational value = exact::fraction(int64_t{x} * 4 + y, 4096);
                        for (const exact::Component& c : pixels.format().all()) {
                            const exact::CodeSet codes = exact::encode(c, value);
                            const uint64_t code = pixels.code(x, y, c.channel);
                            if (code == codes.nearest) continue;
                            const std::string text = pixelText(x, y) + " channel " + "RGBA"[c.channel] + " has code " +
                                                     quoted(code) + ", nearest " + quoted(codes.nearest);
                            worst = worst.worse(Verdict::inexact(codes.permits(code), text));
                        }
                    }
                }
                return worst;
            });
    }
}

// All 16 operations on all pairs of four bits, in both halves of a byte.
void b15(CaseInput& input) {
    constexpr VkExtent2D kTable{16, 16};
    for (uint32_t op = 0; op < 16; ++op) {
        SceneRecorder record("B15", "A logic operation.");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTable);
        const uint32_t cover = record.vertex(kCoverVertexGlsl);
        record.pass(kTable).color(target, {0, 0, 0, 0});
        record.draw(record.pipeline(cover, record.fragment(writes("vec4(floor(gl_FragCoord.y) * 17.0 / 255.0)"))), 3);
        record.draw(record.pipeline(cover, record.fragment(writes("vec4(floor(gl_FragCoord.x) * 17.0 / 255.0)")))
                        .logicOp(static_cast<VkLogicOp>(op)),
                    3);
        record.output(target);
        judgePixels(input, input.scene(record.finish()), 0, kTable,
                    [op](const PixelReader& pixels, const Declared&) -> Verdict {
                        for (uint32_t y = 0; y < 16; ++y) {
                            for (uint32_t x = 0; x < 16; ++x) {
                                // Vulkan, Logical Operations: the operation's number is its truth table, source and
                                // destination both 1 first.
                                uint32_t expected = 0;
                                for (uint32_t bit = 0; bit < 8; ++bit) {
                                    const uint32_t s = x * 17 >> bit & 1, d = y * 17 >> bit & 1;
                                    const uint32_t place = s != 0 ? (d != 0 ? 0 : 1) : (d != 0 ? 2 : 3);
                                    expected |= (op >> place & 1) << bit;
                                }
                                if (pixels.code(x, y, 0) == expected) continue;
                                return Verdict::wrong("operation " + quoted(op) + " of " + quoted(x * 17) + " on " +
                                                      quoted(y * 17) + " gives " + quoted(pixels.code(x, y, 0)) +
                                                      ", exactly " + quoted(expected));
                            }
                        }
                        return {};
                    });
    }
}

void b16(CaseInput& input) {
    for (uint32_t mask = 0; mask < 16; ++mask) {
        auto state = blending(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ZERO);
        for (const bool enabled : {true, false}) {
            state.blendEnable = enabled ? VK_TRUE : VK_FALSE;
            state.colorWriteMask = mask;
            const size_t scene =
                input.scene(blendScene("B16", VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, "vec4(10.0, 20.0, 30.0, 40.0) / 255.0",
                                       "vec4(200.0, 210.0, 220.0, 230.0) / 255.0", state));
            std::vector<uint64_t> codes;
            for (uint64_t c = 0; c < 4; ++c) codes.push_back((mask >> c & 1) != 0 ? 200 + 10 * c : 10 + 10 * c);
            judgeCodes(input, scene, 0, {4, 4}, codes, "channels outside the write mask keep their codes");
        }
    }
}

void b17(CaseInput& input) {
    const auto state = blending(VK_BLEND_FACTOR_DST_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA);
    const size_t scene = input.scene(blendScene("B17", VK_FORMAT_R5G6B5_UNORM_PACK16, {4, 4},
                                                "vec4(0.0, 1.0, 0.0, 0.0)", "vec4(1.0, 0.0, 1.0, 0.0)", state));
    judgeCodes(input, scene, 0, {4, 4}, {31, 0, 31}, "alpha that a format lacks reads as 1");
}

// Transparent triangles over one another.
void b18(CaseInput& input) {
    std::vector<ColorVertex> vertices;
    uint32_t i = 0;
    for (const WindowTriangle& t : jitteredTiling(4, 13.5, 6, 256, 18)) {
        for (const WindowPoint& p : t) {
            const WindowPoint wide{32 + (p.x - 32) * 1.7, 32 + (p.y - 32) * 1.7};
            vertices.push_back({clipAt(wide, viewportOf(kTarget)),
                                {static_cast<float>(i * 3 % 5) / 5, static_cast<float>(i * 2 % 7) / 7,
                                 static_cast<float>(i % 3) / 3, 0.4f}});
        }
        ++i;
    }
    SceneRecorder record("B18", "Transparent triangles in order.");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) flat out vec4 vColor;
void main() {
    gl_Position = position;
    vColor = color;
}
)"),
                                            record.fragment(R"(#version 450
layout(location = 0) flat in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vColor; }
)"))
                                  .binding(sizeof(ColorVertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
                                  .blend(blending(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA));
    record.pass(kTarget).color(target, {0, 0, 0, 1});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("vertices", vertices));
    record.output(target);
    addForOracle(input, record.finish());
}

void b19(CaseInput& input) {
    const auto over = blending(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    for (const VkFormat format :
         {VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
        addForOracle(input, blendScene("B19", format, kTarget,
                                       "vec4(gl_FragCoord.x / 64.0, gl_FragCoord.y / 64.0, 0.123456, 1.0)",
                                       "vec4(0.7654321, 0.3333333, gl_FragCoord.x / 97.0, 0.2345678)", over));
    }
}

constexpr std::string_view kFixed = "Vulkan, Conversion From Floating-Point to Normalized Fixed-Point";
constexpr std::string_view kBlend = "Vulkan, Blending";

const std::vector<HardCase> kCases{
    {"B01", "0.25 cleared and written to RGBA8", "63.75: 64 is nearest, 63 is permitted; the same everywhere.", kFixed,
     b01},
    {"B02", "0.5 cleared and written to RGBA8: the one exact tie", "127.5: 127 or 128; the same everywhere.", kFixed,
     b02},
    {"B03", "Every code read and written unchanged, in four UNORM formats",
     "A value that is exactly a code maps to that code: the identity.", kFixed, b03},
    {"B04", "Every sRGB code read and written unchanged", "The identity: codes are far apart in linear light.",
     "Khronos Data Format Specification, sRGB transfer functions", b04},
    {"B05", "sRGB around the ends of its linear segment, values and codes",
     "Continuous and monotone; the nearest code.", "Khronos Data Format Specification, sRGB transfer functions", b05},
    {"B06", "All pairs of codes blended with alpha 1 and 0", "Exactly the source; exactly the destination.", kBlend,
     b06},
    {"B07", "255 additions of 1/255", "255.", kBlend, b07},
    {"B08", "Sources and constants outside [0, 1], to UNORM and to float", "Clamped for UNORM, not for float.", kBlend,
     b08},
    {"B09", "Subtractions with negative results, to UNORM and to float", "0 for UNORM, negative for float.", kBlend,
     b09},
    {"B10", "Minimum and maximum with factors", "Factors are ignored.", kBlend, b10},
    {"B11", "Floats written to halves: at ties, at both ends of the range",
     "Either neighbour; beyond the range the largest or infinity.", "Vulkan, 16-Bit Floating-Point Numbers", b11},
    {"B12", "R11G11B10: largest values, smallest denormals, negative numbers, NaN; all codes",
     "By the format; either neighbour of a value.", "Vulkan, Unsigned 11-Bit Floating-Point Numbers", b12},
    {"B13", "E5B9G9R9: all exponents, and channels that would round up to 512",
     "By the format, exactly; no driver writes it.", "Vulkan, RGB to Shared Exponent Conversion", b13},
    {"B14", "A ramp in channels of 2, 5, 6 and 10 bits", "The nearest code.", kFixed, b14},
    {"B15", "All 16 logic operations on all pairs of four bits", "Bit by bit on stored codes.",
     "Vulkan, Logical Operations", b15},
    {"B16", "All write masks, with blending and without", "Channels outside keep their codes.",
     "Vulkan, Color Write Mask", b16},
    {"B17", "Destination alpha of a format without alpha", "Reads as 1.", kBlend, b17},
    {"B18", "Transparent triangles over one another", "API order at every sample.", "Vulkan, Primitive Order", b18},
    {"B19", "Blending in 16 and 32 bits", "At least the precision of the destination.", kBlend, b19},
};

}  // namespace

std::span<const HardCase> blendingCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
