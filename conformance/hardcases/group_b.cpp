// B: blending, rounding, formats.
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/judges.h"
#include "conformance/oracle/encode.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

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

constexpr std::string_view kFixed = "Vulkan, Conversion From Floating-Point to Normalized Fixed-Point";

const std::vector<HardCase> kCases{
    {"B01", "0.25 cleared and written to RGBA8", "63.75: 64 is nearest, 63 is permitted; the same everywhere.", kFixed,
     b01},
    {"B02", "0.5 cleared and written to RGBA8: the one exact tie", "127.5: 127 or 128; the same everywhere.", kFixed,
     b02},
    {"B03", "Every code read and written unchanged, in four UNORM formats",
     "A value that is exactly a code maps to that code: the identity.", kFixed, b03},
    {"B04", "Every sRGB code read and written unchanged", "The identity: codes are far apart in linear light.",
     "Khronos Data Format Specification, sRGB transfer functions", b04},
};

}  // namespace

std::span<const HardCase> blendingCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
