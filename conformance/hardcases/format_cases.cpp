#include "conformance/hardcases/format_cases.h"

#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/texture_input.h"
#include "conformance/oracle/encode.h"
#include "conformance/oracle/quantise.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vernier::conformance::hardcases {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// Values written to a target of this format, one pixel each, the same in all channels.
TextureTable written(VkFormat format, const std::vector<float>& values) {
    TextureTable table;
    table.format = VK_FORMAT_R32_SFLOAT;
    table.extent = {static_cast<uint32_t>(values.size()), 1};
    table.levels = {bytesOf(values)};
    table.sampler = filtered(VK_FILTER_NEAREST);
    table.target = format;
    table.expression = "vec4(texelFetch(picture, ivec2(int(c.x), 0), 0).r)";
    for (size_t i = 0; i < values.size(); ++i) table.coordinates.push_back({static_cast<float>(i), 0, 0, 0});
    return table;
}

std::string codeText(uint64_t code) {
    return std::to_string(code);
}

/// Texels of a format of four bytes, fetched; `exactly` tells what each is.
void fetched(CaseInput& input, std::string_view name, VkFormat format, const std::vector<uint32_t>& texels,
             std::function<std::array<double, 3>(uint32_t texel)> exactly) {
    TextureTable table;
    table.format = format;
    table.extent = {static_cast<uint32_t>(texels.size()), 1};
    table.levels = {bytesOf(texels)};
    table.sampler = filtered(VK_FILTER_NEAREST);
    table.expression = "texelFetch(picture, ivec2(int(c.x), 0), 0)";
    for (size_t i = 0; i < texels.size(); ++i) table.coordinates.push_back({static_cast<float>(i), 0, 0, 0});
    const size_t scene = input.scene(textureScene(name, table));
    judgePixels(input, scene, 0, extentOf(table), [=](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t x = 0; x < texels.size(); ++x) {
            const std::array<double, 3> expected = exactly(texels[x]);
            for (uint8_t c = 0; c < 3; ++c) {
                const double seen = pixels.number(x, 0, c);
                if (seen == expected[c] || (std::isnan(seen) && std::isnan(expected[c]))) continue;
                return Verdict::wrong("texel " + std::to_string(texels[x]) + ", channel " + "RGB"[c] + ": " +
                                      std::to_string(seen) + ", exactly " + std::to_string(expected[c]));
            }
        }
        return {};
    });
}

}  // namespace

void b05(CaseInput& input) {
    // Rising values from half of the segment's end to one and a half of it, its neighbours, and the codes' midpoints.
    std::vector<float> values{0.0031308f, std::nextafter(0.0031308f, 0.0f), std::nextafter(0.0031308f, 1.0f)};
    for (int i = 0; i < 1000; ++i) values.push_back(0.0031308f * (0.5f + static_cast<float>(i) / 999));
    for (int code = 5; code < 20; ++code) {
        const auto middle = static_cast<float>(exact::srgbDecode((code + 0.5) / 255));
        for (const float v : {std::nextafter(middle, 0.0f), middle, std::nextafter(middle, 1.0f)}) values.push_back(v);
    }
    std::ranges::sort(values);
    const TextureTable table = written(VK_FORMAT_R8G8B8A8_SRGB, values);
    const size_t scene = input.scene(textureScene("B05_encode", table));
    judgePixels(input, scene, 0, extentOf(table), [values](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t x = 0; x < values.size(); ++x) {
            const exact::CodeSet codes = exact::encode({0, 0, 8, exact::Encoding::srgb}, exact::rational(values[x]));
            const uint64_t code = pixels.code(x, 0, 0);
            if (x > 0 && code < pixels.code(x - 1, 0, 0)) return Verdict::wrong("codes fall where values rise");
            if (code == codes.nearest) continue;
            const std::string text =
                std::to_string(values[x]) + " is encoded as " + codeText(code) + ", nearest " + codeText(codes.nearest);
            worst = worst.worse(Verdict::inexact(codes.permits(code), text));
        }
        return worst;
    });
    // Decoding around code 10.3, where the segments meet: rising, and near the exact value.
    TextureTable decoded;
    decoded.format = VK_FORMAT_R8G8B8A8_SRGB;
    decoded.extent = {32, 1};
    decoded.levels.resize(1);
    for (uint32_t code = 0; code < 32; ++code) {
        for (int c = 0; c < 4; ++c) decoded.levels[0].push_back(static_cast<std::byte>(code));
        decoded.coordinates.push_back({static_cast<float>(code), 0, 0, 0});
    }
    decoded.sampler = filtered(VK_FILTER_NEAREST);
    decoded.expression = "texelFetch(picture, ivec2(int(c.x), 0), 0)";
    const size_t back = input.scene(textureScene("B05_decode", decoded));
    judgePixels(input, back, 0, extentOf(decoded), [](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t code = 0; code < 32; ++code) {
            const double seen = pixels.number(code, 0, 0), expected = exact::srgbDecode(code / 255.0);
            if (code > 0 && seen <= static_cast<double>(pixels.number(code - 1, 0, 0)))
                return Verdict::wrong("decoded values do not rise at code " + std::to_string(code));
            if (seen == static_cast<double>(static_cast<float>(expected))) continue;
            const std::string text = "code " + std::to_string(code) + " decodes to " + std::to_string(seen) +
                                     ", exactly " + std::to_string(expected);
            // No precision is stated; less than half a code away it reads back as that code.
            const double half = (exact::srgbDecode((code + 1) / 255.0) - expected) / 2;
            worst = worst.worse(Verdict::inexact(std::abs(seen - expected) < half, text));
        }
        return worst;
    });
}

void b12(CaseInput& input) {
    std::vector<float> values{0.0f, -0.0f, 1.0f, -1.0f, -kInf, kInf, std::numeric_limits<float>::quiet_NaN()};
    for (const float v : {65024.0f, 64512.0f, 65280.0f, 65535.0f, 65536.0f, 1e9f, 0x1p-20f, 0x1p-19f, 0x1p-21f,
                          0x1.8p-20f, 0x1p-14f, 0x1.fcp-15f, 1.0078125f, 1.015625f, 3.14159265f, 0x1p-149f}) {
        for (const float w : {std::nextafter(v, 0.0f), v, std::nextafter(v, kInf), -v}) values.push_back(w);
    }
    const TextureTable table = written(VK_FORMAT_B10G11R11_UFLOAT_PACK32, values);
    const size_t scene = input.scene(textureScene("B12_encode", table));
    judgePixels(input, scene, 0, extentOf(table), [values](const PixelReader& pixels, const Declared& declared) {
        Verdict worst;
        for (uint32_t x = 0; x < values.size(); ++x) {
            const float value = values[x];
            for (const exact::Component& component : pixels.format().all()) {
                const uint64_t code = pixels.code(x, 0, component.channel),
                               infinity = uint64_t{31} << (component.bits - 5);
                const std::string text = std::to_string(value) + " is stored as code " + codeText(code) + " of " +
                                         std::to_string(component.bits) + " bits";
                if (!std::isfinite(value)) {
                    const bool right = std::isnan(value) ? code > infinity : code == (value > 0 ? infinity : 0);
                    if (!right) return Verdict::wrong(text);
                    continue;
                }
                const exact::CodeSet codes = exact::encode(component, exact::rational(value));
                if (code == codes.nearest) continue;
                const std::string nearest = text + ", nearest " + codeText(codes.nearest);
                // Ours: what is finite stays finite.
                const bool own = declared.own && codes.nearest == infinity && code == infinity - 1;
                worst = worst.worse(own ? Verdict::declared(nearest) : Verdict::inexact(codes.permits(code), nearest));
            }
        }
        return worst;
    });
    std::vector<uint32_t> texels;
    for (uint32_t code = 0; code < 2048; ++code) texels.push_back(code | (2047 - code) << 11 | (code & 1023) << 22);
    fetched(input, "B12_decode", VK_FORMAT_B10G11R11_UFLOAT_PACK32, texels, [](uint32_t texel) {
        const exact::PixelFormat& format = *exact::findPixelFormat(VK_FORMAT_B10G11R11_UFLOAT_PACK32);
        const std::array<double, 4> all = exact::decodeTexel(format, reinterpret_cast<const std::byte*>(&texel));
        return std::array<double, 3>{all[0], all[1], all[2]};
    });
}

void b13(CaseInput& input) {
    // All exponents with mantissas of 0, 1, 256 and 511, and what encoding makes of a largest channel that would round
    // up to 512.
    std::vector<uint32_t> texels;
    for (uint32_t exponent = 0; exponent < 32; ++exponent) {
        texels.push_back(exponent << 27 | 511u << 18 | 256u << 9 | 1u);
        texels.push_back(exponent << 27 | 0u << 18 | 511u << 9 | 511u);
    }
    for (const double top : {511.4, 511.5, 511.75, 512.0}) {
        for (const double scale : {1.0, 0x1p-8, 0x1p7})
            texels.push_back(exact::encodeSharedExponent(
                {exact::rational(top * scale), exact::rational(3.5 * scale), exact::rational(scale / 4)}));
    }
    fetched(input, "B13", VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, texels, [](uint32_t texel) {
        const std::array<exact::Rational, 3> rgb = exact::decodeSharedExponent(texel);
        return std::array<double, 3>{rgb[0].get_d(), rgb[1].get_d(), rgb[2].get_d()};
    });
}

}  // namespace vernier::conformance::hardcases
