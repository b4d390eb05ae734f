// T: texture filtering and addressing.
#include "conformance/hardcases/block_cases.h"
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/image_kind_cases.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/texture_input.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace vernier::conformance::hardcases {
namespace {

constexpr auto kRepeat = VK_SAMPLER_ADDRESS_MODE_REPEAT, kMirrored = VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
constexpr auto kEdge = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, kBorder = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

using Coordinates = std::vector<std::array<float, 4>>;

// A picture of 8 x 4 texels, looked up by the oracle's rules.
TextureTable picture(VkFilter filter, VkSamplerAddressMode address, Coordinates coordinates) {
    TextureTable table;
    table.extent = {8, 4};
    table.levels = {someTexels(table.extent, 5)};
    table.sampler = filtered(filter, address);
    table.coordinates = std::move(coordinates);
    return table;
}

Coordinates across(const std::vector<float>& us) {
    Coordinates result;
    for (const float u : us) {
        result.push_back({u, 0.375f, 0, 0});
        result.push_back({0.3125f, u, 0, 0});
    }
    return result;
}

void t01(CaseInput& input) {
    std::vector<float> us;
    for (int i = -9; i <= 17; ++i) us.push_back(static_cast<float>(i) / 8);
    for (const auto address : {kRepeat, kEdge})
        addForOracle(input, textureScene("T01", picture(VK_FILTER_NEAREST, address, across(us))));
}

void t02(CaseInput& input) {
    const Coordinates coordinates = across({-0x1p-30f, -0x1p-149f, -0.0f, 0.0f, -0x1p-24f});
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR})
        addForOracle(input, textureScene("T02", picture(filter, kRepeat, coordinates)));
}

void t03(CaseInput& input) {
    const Coordinates coordinates = across({std::nextafter(1.0f, 0.0f), 1.0f, std::nextafter(1.0f, 2.0f)});
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
        for (const auto address : {kRepeat, kEdge})
            addForOracle(input, textureScene("T03", picture(filter, address, coordinates)));
    }
}

// Whatever texel it is, it is one of the texture's.
void judgeInside(CaseInput& input, size_t scene, VkExtent2D extent) {
    judgePixels(input, scene, 0, extent, [extent](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t x = 0; x < extent.width; ++x) {
            for (uint8_t c = 0; c < 4; ++c) {
                const float v = pixels.number(x, 0, c);
                if (!(v >= 0 && v <= 1))
                    return Verdict::wrong("lookup " + std::to_string(x) + " gives " + std::to_string(v) +
                                          ", which no texel has");
            }
        }
        return {};
    });
}

void t04(CaseInput& input) {
    const Coordinates coordinates =
        across({1e10f, -1e10f, 0x1p31f, -0x1p31f, 0x1p32f, 3e38f, kInf, -kInf, kNan, 16777217.0f});
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
        for (const auto address : {kRepeat, kMirrored, kEdge}) {
            const TextureTable table = picture(filter, address, coordinates);
            // A weight that is NaN may reach the result of a linear filter.
            TextureTable finite = table;
            if (filter == VK_FILTER_LINEAR) {
                std::erase_if(finite.coordinates,
                              [](const auto& c) { return !std::isfinite(c[0]) || !std::isfinite(c[1]); });
            }
            judgeInside(input, input.scene(textureScene("T04", finite)), extentOf(finite));
            if (filter == VK_FILTER_LINEAR) input.scene(textureScene("T04_nan", table));
        }
    }
}

void t05(CaseInput& input) {
    std::vector<float> us;
    for (const float at : {-1.0f, 0.0f, 1.0f, 2.0f, 3.0f}) {
        for (const float u : {std::nextafter(at, -9.0f), at, std::nextafter(at, 9.0f), at + 0.0625f, at - 0.0625f})
            us.push_back(u);
    }
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR})
        addForOracle(input, textureScene("T05", picture(filter, kMirrored, across(us))));
}

void t06(CaseInput& input) {
    std::vector<float> us;
    for (int i = -3; i <= 19; ++i) us.push_back(static_cast<float>(i) / 16 + 0.01f);
    for (const VkBorderColor color : {VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK, VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK,
                                      VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE}) {
        TextureTable table = picture(VK_FILTER_LINEAR, kBorder, across(us));
        table.sampler.borderColor = color;
        addForOracle(input, textureScene("T06", table));
        // Red and green alone: the border's other channels are replaced as the texel's are.
        table.format = VK_FORMAT_R8G8_UNORM;
        table.levels = {Bytes(table.levels[0].begin(), table.levels[0].begin() + 64)};
        addForOracle(input, textureScene("T06_two_channels", table));
    }
}

void t07(CaseInput& input) {
    Coordinates coordinates;
    for (int i = 0; i < 300; ++i)
        coordinates.push_back({static_cast<float>(i * 37 % 300) / 300.0f, static_cast<float>(i) / 300.0f, 0, 0});
    addForOracle(input, textureScene("T07", picture(VK_FILTER_LINEAR, kRepeat, coordinates)));
}

// Pairs of equal texels, filtered between them, beside the texel itself.
void t08(CaseInput& input) {
    TextureTable table;
    table.extent = {512, 2};
    for (uint32_t y = 0; y < 2; ++y) {
        for (uint32_t x = 0; x < 512; ++x) {
            for (int c = 0; c < 4; ++c)
                table.levels.resize(1), table.levels[0].push_back(static_cast<std::byte>(x / 2));
        }
    }
    table.sampler = filtered(VK_FILTER_LINEAR);
    for (uint32_t code = 0; code < 256; ++code) {
        for (const float offset : {0.0f, 0.3f, -0.43f}) {
            const float u = (static_cast<float>(code * 2 + 1) + offset) / 512;
            table.coordinates.push_back({u, 0.41f, 0, static_cast<float>(code * 2)});
        }
    }
    table.expression = "vec4(textureLod(picture, c.xy, 0.0).r, texelFetch(picture, ivec2(int(c.w), 0), 0).r, 0.0, 1.0)";
    const size_t scene = input.scene(textureScene("T08", table));
    judgePixels(input, scene, 0, extentOf(table), [](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t x = 0; x < pixels.extent().width; ++x) {
            const float mixed = pixels.number(x, 0, 0), texel = pixels.number(x, 0, 1);
            if (mixed == texel) continue;
            const std::string text =
                "between two texels of " + std::to_string(texel) + " the filter gives " + std::to_string(mixed);
            worst = worst.worse(Verdict::inexact(std::abs(mixed - texel) <= 1e-5f, text));
        }
        return worst;
    });
}

// All codes of a format with 8 bits per channel, decoded.
void decodes(CaseInput& input, std::string_view name, VkFormat format, double (*exactly)(uint32_t code)) {
    TextureTable table;
    table.format = format;
    table.extent = {256, 1};
    table.levels.resize(1);
    for (uint32_t code = 0; code < 256; ++code) {
        for (int c = 0; c < 4; ++c) table.levels[0].push_back(static_cast<std::byte>(code));
        table.coordinates.push_back({static_cast<float>(code), 0, 0, 0});
    }
    table.expression = "texelFetch(picture, ivec2(int(c.x), 0), 0)";
    const size_t scene = input.scene(textureScene(name, table));
    judgePixels(input, scene, 0, extentOf(table), [exactly](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t code = 0; code < 256; ++code) {
            const double expected = exactly(code), got = pixels.number(code, 0, 0);
            if (got == static_cast<double>(static_cast<float>(expected))) continue;
            const std::string text = "code " + std::to_string(code) + " decodes to " + std::to_string(got) +
                                     ", exactly " + std::to_string(expected);
            const bool ends = expected == 0 || std::abs(expected) == 1;
            worst = worst.worse(Verdict::inexact(!ends && std::abs(got - expected) <= 1e-5, text));
        }
        return worst;
    });
}

void t09(CaseInput& input) {
    decodes(input, "T09", VK_FORMAT_R8G8B8A8_UNORM, [](uint32_t code) { return code / 255.0; });
}
void t10(CaseInput& input) {
    decodes(input, "T10", VK_FORMAT_R8G8B8A8_SNORM,
            [](uint32_t code) { return std::max(-1.0, static_cast<int8_t>(code) / 127.0); });
}

void t11(CaseInput& input) {
    Coordinates coordinates;
    for (int i = 0; i < 200; ++i)
        coordinates.push_back({static_cast<float>(i) / 200.0f, static_cast<float>(i * 7 % 200) / 200.0f, 0, 0});
    TextureTable table = picture(VK_FILTER_LINEAR, kEdge, coordinates);
    // No precision is stated for decoding: it shows in codes, not in floats.
    table.format = table.target = VK_FORMAT_R8G8B8A8_SRGB;
    addForOracle(input, textureScene("T11", table));
}

// At the centre of a texel the neighbours' weights are 0, whatever they hold.
void t12(CaseInput& input) {
    TextureTable table;
    table.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    table.extent = {4, 4};
    std::vector<uint16_t> halves;
    for (uint32_t i = 0; i < 16; ++i) {
        const bool one = i == 5;
        for (int c = 0; c < 4; ++c) halves.push_back(one ? 0x3c00 : c == 0 ? 0x7c00 : c == 1 ? 0x7e00 : 0x0001);
    }
    table.levels = {bytesOf(halves)};
    table.sampler = filtered(VK_FILTER_LINEAR);
    table.coordinates = {{0.375f, 0.375f, 0, 0}};
    const size_t scene = input.scene(textureScene("T12", table));
    judgePixels(input, scene, 0, {1, 1}, [](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint8_t c = 0; c < 4; ++c) {
            const float v = pixels.number(0, 0, c);
            if (v == 1.0f) continue;
            worst = worst.worse(c < 2 ? Verdict::allowed("a neighbour of weight 0 poisons the result")
                                      : Verdict::wrong("1 beside denormals is filtered to " + std::to_string(v)));
        }
        return worst;
    });
}

void t13(CaseInput& input) {
    for (const VkExtent2D extent : {VkExtent2D{5, 3}, {1, 1}, {1, 7}, {13, 1}}) {
        TextureTable table;
        table.extent = extent;
        for (VkExtent2D level = extent;;) {
            table.levels.push_back(someTexels(level, static_cast<uint32_t>(table.levels.size() + extent.width)));
            if (level.width == 1 && level.height == 1) break;
            level = {std::max(1u, level.width / 2), std::max(1u, level.height / 2)};
        }
        table.sampler = filtered(VK_FILTER_NEAREST);
        for (size_t level = 0; level < table.levels.size(); ++level) {
            for (int i = 0; i < 9; ++i)
                table.coordinates.push_back({(static_cast<float>(i) + 0.37f) / 9,
                                             (static_cast<float>(8 - i) + 0.41f) / 9, static_cast<float>(level), 0});
        }
        addForOracle(input, textureScene("T13", table));
    }
}

// The four texels of a gather are those that a linear filter at the same place mixes.
void t18(CaseInput& input) {
    Coordinates coordinates;
    for (int i = 0; i < 64; ++i)
        coordinates.push_back({static_cast<float>(i % 17) / 17 + 0.013f, static_cast<float>(i) / 64 + 0.003f, 0, 0});
    for (const char* expression : {"textureGather(picture, c.xy, 0)", "textureGather(picture, c.xy, 2)"}) {
        TextureTable table = picture(VK_FILTER_LINEAR, kRepeat, coordinates);
        table.expression = expression;
        addForOracle(input, textureScene("T18", table));
    }
}

// References at, and an ULP beside, the stored depth.
void t19(CaseInput& input) {
    const float stored = 0.3f;
    for (const VkCompareOp op :
         {VK_COMPARE_OP_LESS, VK_COMPARE_OP_LESS_OR_EQUAL, VK_COMPARE_OP_GREATER, VK_COMPARE_OP_EQUAL}) {
        TextureTable table;
        table.format = VK_FORMAT_D32_SFLOAT;
        table.extent = {1, 1};
        const std::vector<float> texel{stored};
        table.levels = {bytesOf(texel)};
        table.sampler = filtered(VK_FILTER_NEAREST);
        table.sampler.compareEnable = true;
        table.sampler.compareOp = op;
        table.type = "sampler2DShadow";
        table.expression = "vec4(textureLod(picture, vec3(c.xy, c.z), 0.0))";
        for (const float reference : {std::nextafter(stored, 0.0f), stored, std::nextafter(stored, 1.0f)})
            table.coordinates.push_back({0.5f, 0.5f, reference, 0});
        const size_t scene = input.scene(textureScene("T19", table));
        judgePixels(input, scene, 0, {3, 1}, [op](const PixelReader& pixels, const Declared&) -> Verdict {
            for (uint32_t x = 0; x < 3; ++x) {
                const int order = static_cast<int>(x) - 1;  // of the reference to the stored depth
                const bool passes = op == VK_COMPARE_OP_LESS            ? order < 0
                                    : op == VK_COMPARE_OP_LESS_OR_EQUAL ? order <= 0
                                    : op == VK_COMPARE_OP_GREATER       ? order > 0
                                                                        : order == 0;
                const float expected = passes ? 1.0f : 0.0f;
                if (pixels.number(x, 0, 0) != expected)
                    return Verdict::wrong("a reference " + std::to_string(order) +
                                          " ULP from the stored depth compares wrongly");
            }
            return {};
        });
    }
}

void t21(CaseInput& input) {
    TextureTable table =
        picture(VK_FILTER_NEAREST, kEdge,
                {{8, 0, 0, 0}, {-1, 0, 0, 0}, {0, 4, 0, 0}, {1e9f, 1e9f, 0, 0}, {0, 0, 1, 0}, {0, 0, -1, 0}});
    table.expression = "texelFetch(picture, ivec2(c.xy), int(c.z))";
    const size_t scene = input.scene(textureScene("T21", table));
    judgePixels(input, scene, 0, extentOf(table), [](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t x = 0; x < pixels.extent().width; ++x) {
            if (pixels.number(x, 0, 0) != 0)
                return Verdict::allowed("fetch " + std::to_string(x) + " outside gives " +
                                        std::to_string(pixels.number(x, 0, 0)) +
                                        "; undefined without robust image access");
        }
        return {};
    });
}

constexpr std::string_view kWrap = "Vulkan, Wrapping Operation; (u,v,w,a) to (i,j,k,l,n) Transformation";
constexpr std::string_view kFilter = "Vulkan, Texel Filtering";

const std::vector<HardCase> kCases{
    {"T01", "Coordinates exactly between texels, nearest", "floor(u): the texel on the right.", kWrap, t01},
    {"T02", "u of -2^-30 and smaller, repeated", "The last texel; no index outside.", kWrap, t02},
    {"T03", "u at 1 and an ULP beside, repeated and clamped", "The last texel, or the first.", kWrap, t03},
    {"T04", "u of 10^10, 2^31, infinities and NaN", "A texel of the texture; undefined for NaN, but no crash.", kWrap,
     t04},
    {"T05", "Mirrored repeat at whole numbers and an ULP beside", "mirror(n) = n or -(1 + n).", kWrap, t05},
    {"T06", "Borders of three colours in a linear filter, with two and four channels",
     "The border enters with its weight; absent channels are replaced.", "Vulkan, Texel Replacement", t06},
    {"T07", "Linear filtering at 300 places", "Weights of at least the declared bits.", kFilter, t07},
    {"T08", "Linear filtering between equal texels, all 256 codes", "Exactly that texel.", kFilter, t08},
    {"T09", "All UNORM8 codes decoded", "c / 255; 0 and 1 exactly.",
     "Vulkan, Conversion From Normalized Fixed-Point to Floating-Point", t09},
    {"T10", "All SNORM8 codes decoded", "max(c / 127, -1).",
     "Vulkan, Conversion From Normalized Fixed-Point to Floating-Point", t10},
    {"T11", "Linear filtering of sRGB texels", "Decoded before filtering.", "Vulkan, sRGB EOTF; Texel Filtering", t11},
    {"T12", "Infinities, NaN and denormals beside the texel that has all the weight",
     "A texel of weight 0 should not poison.", kFilter, t12},
    {"T13", "Mip levels of sizes that are no powers of two", "Every level is max(1, floor(size / 2^l)).",
     "Vulkan, Image Miplevel Sizing", t13},
    {"T14", "Array layers at 0.5, 1.5, 2.5, an ULP beside, and beyond the ends",
     "Rounded to even, or floor(a + 1/2); clamped.", "Vulkan, Layer Selection", t14},
    {"T15", "Unnormalised coordinates, nearest and linear, to the edge and to the border",
     "As normalised ones at powers of two.", kWrap, t15},
    {"T16", "Cube faces at ties of two and three axes, and the same vectors scaled",
     "A function of the direction alone: z before y before x.", "Vulkan, Cube Map Face Selection", t16},
    {"T17", "Corners and edges of seamless cubes", "The average of the texels that meet; equal texels stay.",
     "Vulkan, Cube Map Edge Handling", t17},
    {"T18", "Gathers of two channels at 64 places", "The four texels of the linear filter.", "Vulkan, Texel Gathering",
     t18},
    {"T19", "Shadow comparison with a reference an ULP below, at, and above the depth", "An exact comparison.",
     "Vulkan, Depth Compare Operation", t19},
    {"T20", "Blocks of BC1, BC4, ETC2 and EAC with end points at their ends, equal, and in both orders",
     "As the decoders specify; the weights of BC have slack.", "Khronos Data Format Specification", t20},
    {"T21",
     "texelFetch outside the image and its levels",
     "0 with robust access, otherwise undefined, but no crash.",
     "Vulkan, Texel Input Validation",
     t21,
     {},
     {{"lavapipe", "its CI lists crashes of image arrays read outside"}}},
    {"T22", "Blocks of BC2, BC3 and BC5, signed and sRGB: end points at their ends, equal, in both orders",
     "Colours of BC2 and BC3 are four whatever the order; -128 is -127.",
     "Khronos Data Format Specification, S3TC; RGTC", t22},
    {"T23", "Blocks of BC6H and BC7: every mode, reserved ones too, with bits all 0, all ones and random",
     "Integers all the way: one right answer; reserved modes are black, in BC7 without alpha.",
     "Khronos Data Format Specification, BPTC", t23},
    {"T24",
     "Blocks of ASTC, four footprints, with sRGB and without: end points in both orders, void extents, a reserved "
     "mode, "
     "partitions",
     "Integers all the way to 16 bits; with sRGB the upper eight are the code; errors are magenta.",
     "Khronos Data Format Specification, ASTC",
     t24,
     {},
     {{"lavapipe", "its CI lists ASTC with sRGB at full precision as failing"}}},
};

}  // namespace

std::span<const HardCase> textureCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
