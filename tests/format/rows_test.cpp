// Rows of texels: all codes of every format survive the trip, and every instruction set gives the scalar's
// bits.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "runtime/format/convert.h"
#include "runtime/format/format.h"

namespace vernier {
namespace {

struct Case {
    const FormatInfo* info;
    VkImageAspectFlags aspect;
};

std::vector<Case> allCases() {
    std::vector<Case> cases;
    for (const FormatInfo& info : allFormats()) {
        if (info.block != nullptr) continue;  // read as the format they decode to
        for (const VkImageAspectFlags aspect :
             {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
            if ((info.aspects & aspect) != 0) cases.push_back({&info, aspect});
        }
    }
    return cases;
}

using Planes = std::array<std::vector<uint32_t>, 4>;

Planes makePlanes(size_t n) {
    Planes planes;
    planes.fill(std::vector<uint32_t>(n, 0xdeadbeefu));
    return planes;
}

/// All texels of formats of up to 16 bits; 2^16 texels of wider ones, among them each 16-bit pattern in each
/// half-word.
std::vector<std::byte> texelsToTry(const FormatInfo& info) {
    const size_t bytes = info.bytesPerTexel, count = bytes == 1 ? 256 : 65536;
    std::vector<std::byte> texels(count * bytes);
    std::mt19937 random(1);
    for (size_t i = 0; i < count; ++i) {
        for (size_t b = 0; b < bytes; b += 2) {
            const uint32_t code = static_cast<uint32_t>(i) * (b == 0 ? 1 : 40503 + static_cast<uint32_t>(b)) ^
                                  (b >= 2 && i % 3 == 0 ? static_cast<uint32_t>(random()) : 0);
            texels[i * bytes + b] = static_cast<std::byte>(code);
            if (b + 1 < bytes) texels[i * bytes + b + 1] = static_cast<std::byte>(code >> 8);
        }
    }
    return texels;
}

class Rows : public testing::TestWithParam<Case> {};

TEST_P(Rows, UnpackEqualsScalarOnEveryIsa) {
    const auto [info, aspect] = GetParam();
    const TexelLayout& layout = info->layout(aspect);
    const std::vector<std::byte> texels = texelsToTry(*info);
    const size_t n = texels.size() / info->bytesPerTexel;
    Planes expected = makePlanes(n);
    for (size_t i = 0; i < n; ++i) {
        const VkClearColorValue value = unpackTexel(layout, &texels[i * info->bytesPerTexel]);
        for (int c = 0; c < 4; ++c) expected[c][i] = value.uint32[c];
    }
    for (const Isa isa : availableIsas()) {
        const FormatOps ops = formatOps(info->format, aspect, isa);
        Planes planes = makePlanes(n);
        // In pieces of all lengths, at all alignments.
        for (size_t first = 0, length = 1; first < n; first += length, length = length % 41 + 1) {
            length = std::min(length, n - first);
            void* const part[4] = {&planes[0][first], &planes[1][first], &planes[2][first], &planes[3][first]};
            ops.unpack(&texels[first * info->bytesPerTexel], length, part);
        }
        EXPECT_TRUE(planes == expected) << info->name << " on " << isaName(isa);
        std::vector<const std::byte*> pointers(n);
        for (size_t i = 0; i < n; ++i) pointers[i] = &texels[(n - 1 - i) * info->bytesPerTexel];
        Planes reversed = makePlanes(n);
        void* const whole[4] = {reversed[0].data(), nullptr, reversed[2].data(), reversed[3].data()};
        ops.unpackEach(pointers.data(), n, whole);
        for (const int c : {0, 2, 3}) {
            EXPECT_TRUE(std::equal(reversed[c].rbegin(), reversed[c].rend(), expected[c].begin())) << info->name;
        }
        EXPECT_EQ(reversed[1][n / 2], 0xdeadbeefu);
    }
}

bool isNaNCode(const Component& part, uint32_t value) {
    return part.kind >= ComponentKind::ufloat && std::isnan(std::bit_cast<float>(value));
}

TEST_P(Rows, RoundTripKeepsEveryCode) {
    const auto [info, aspect] = GetParam();
    const TexelLayout& layout = info->layout(aspect);
    if (layout.sharedExponent) return;  // several codes per value; see SharedExponent
    const std::vector<std::byte> texels = texelsToTry(*info);
    const size_t bytes = info->bytesPerTexel, n = texels.size() / bytes;
    for (size_t i = 0; i < n; ++i) {
        const VkClearColorValue value = unpackTexel(layout, &texels[i * bytes]);
        std::array<std::byte, 16> packed{};
        if (layout.keepOtherBits) std::memcpy(packed.data(), &texels[i * bytes], bytes);
        packTexel(layout, value, packed.data());
        const VkClearColorValue again = unpackTexel(layout, packed.data());
        uint32_t words[4] = {}, original[4] = {};
        std::memcpy(words, packed.data(), bytes);
        std::memcpy(original, &texels[i * bytes], bytes);
        for (int c = 0; c < 4; ++c) {
            const Component& part = layout.rgba[c];
            if (part.bits == 0) continue;
            const auto code = [&](const uint32_t* w) {
                return w[part.offset / 32] >> part.offset % 32 & lowBits(part.bits);
            };
            if (isNaNCode(part, value.uint32[c])) {
                EXPECT_TRUE(isNaNCode(part, again.uint32[c]));
            } else if (part.kind == ComponentKind::snorm && code(original) == 1u << (part.bits - 1)) {
                EXPECT_EQ(code(words), code(original) + 1);  // -1 has two codes
            } else {
                ASSERT_EQ(code(words), code(original)) << info->name << " component " << c;
            }
        }
    }
}

/// Floats that matter: boundaries between codes and their neighbours, specials, and a spread over all
/// exponents.
std::vector<uint32_t> valuesToTry(const Component& part) {
    std::vector<uint32_t> values;
    if (part.kind == ComponentKind::uint || part.kind == ComponentKind::sint) {
        for (uint32_t i = 0; i < 70000; ++i) values.push_back(i * 977 - 30000 * 977);
        for (int bit = 0; bit < 32; ++bit) {
            for (int d = -2; d <= 2; ++d) values.push_back((1u << bit) + static_cast<uint32_t>(d));
        }
        return values;
    }
    const auto add = [&](double x) {
        const uint32_t bits = std::bit_cast<uint32_t>(static_cast<float>(x));
        for (uint32_t d = 0; d < 5; ++d) values.push_back(bits + d - 2);
    };
    const double max = part.kind == ComponentKind::uscaled || part.kind == ComponentKind::sscaled
                           ? 1.0
                           : lowBits(part.bits - (part.kind == ComponentKind::snorm ? 1 : 0));
    const uint32_t codes = part.bits > 16 ? 65536 : lowBits(part.bits);
    for (uint32_t code = 0; code <= codes; ++code) {
        const double middle = (code * (part.bits > 16 ? 256.0 : 1.0) + 0.5) / max;
        add(middle);
        if (part.kind == ComponentKind::snorm || part.kind == ComponentKind::sscaled) add(-middle);
        if (part.kind == ComponentKind::sfloat && part.bits == 16) add((decodeHalf(code) + decodeHalf(code + 1)) / 2.0);
        if (part.kind == ComponentKind::ufloat) {
            add((double{decodeUfloat(code, part.bits)} + decodeUfloat(code + 1, part.bits)) / 2);
        }
    }
    for (uint64_t bits = 0; bits < 1ull << 32; bits += 65521) values.push_back(static_cast<uint32_t>(bits));
    for (const float x : {0.0f, -0.0f, 1.0f, -1.0f, INFINITY, -INFINITY, NAN, -NAN, 65504.0f, 65520.0f, 0.0031308f}) {
        add(x);
    }
    return values;
}

TEST_P(Rows, PackEqualsScalarOnEveryIsa) {
    const auto [info, aspect] = GetParam();
    const TexelLayout& layout = info->layout(aspect);
    const size_t bytes = info->bytesPerTexel;
    const Component& widest = layout.rgba[1].bits > layout.rgba[0].bits ? layout.rgba[1] : layout.rgba[0];
    const std::vector<uint32_t> values = valuesToTry(widest);
    const size_t n = values.size();
    Planes planes = makePlanes(n);
    for (size_t i = 0; i < n; ++i) {
        for (size_t c = 0; c < 4; ++c) planes[c][i] = values[(i + c * 7919) % n];
    }
    std::vector<std::byte> expected(n * bytes, std::byte{0x5a});
    for (size_t i = 0; i < n; ++i) {
        VkClearColorValue value;
        for (int c = 0; c < 4; ++c) value.uint32[c] = planes[c][i];
        packTexel(layout, value, &expected[i * bytes]);
    }
    for (const Isa isa : availableIsas()) {
        const FormatOps ops = formatOps(info->format, aspect, isa);
        std::vector<std::byte> texels(n * bytes, std::byte{0x5a});
        for (size_t first = 0, length = 1; first < n; first += length, length = length % 131 + 1) {
            length = std::min(length, n - first);
            const void* part[4];
            for (int c = 0; c < 4; ++c) part[c] = layout.rgba[c].bits == 0 ? nullptr : &planes[c][first];
            ops.pack(part, length, &texels[first * bytes]);
        }
        for (size_t i = 0; i < n; ++i) {
            ASSERT_EQ(0, std::memcmp(&texels[i * bytes], &expected[i * bytes], bytes))
                << info->name << " on " << isaName(isa) << ": value " << std::hex << planes[0][i] << " " << planes[1][i]
                << " " << planes[2][i] << " " << planes[3][i];
        }
    }
}

INSTANTIATE_TEST_SUITE_P(AllFormats, Rows, testing::ValuesIn(allCases()), [](const auto& instance) {
    const Case& c = instance.param;
    return std::string(c.info->name) + (c.aspect == VK_IMAGE_ASPECT_STENCIL_BIT ? "_stencil" : "");
});

// The corrected quotient of the FMA targets is proved by trying everything.
TEST(Depth24, EveryCodeOnEveryIsa) {
    const FormatInfo& info = *findFormat(VK_FORMAT_X8_D24_UNORM_PACK32);
    constexpr size_t kRow = 1 << 16;
    std::vector<uint32_t> texels(kRow), back(kRow);
    std::vector<float> depth(kRow);
    for (const Isa isa : availableIsas()) {
        const FormatOps ops = formatOps(info.format, isa);
        uint32_t wrong = 0;
        for (uint32_t first = 0; first < 1u << 24; first += kRow) {
            for (uint32_t i = 0; i < kRow; ++i) texels[i] = first + i;
            ops.unpackOne(texels.data(), kRow, depth.data());
            ops.packOne(depth.data(), kRow, back.data());
            for (uint32_t i = 0; i < kRow; ++i) {
                wrong += depth[i] != static_cast<float>(first + i) / 16777215.0f || back[i] != texels[i];
            }
        }
        EXPECT_EQ(wrong, 0u) << isaName(isa);
    }
}

}  // namespace
}  // namespace vernier
