// The table of formats: its consistency, the specification's mandatory features, aspects and copies.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "runtime/format/format.h"

namespace vernier {
namespace {

TEST(FormatTable, FindsEachFormatOnce) {
    std::set<VkFormat> seen;
    for (const FormatInfo& info : allFormats()) {
        EXPECT_TRUE(seen.insert(info.format).second) << info.name;
        EXPECT_EQ(findFormat(info.format), &info) << info.name;
    }
    EXPECT_EQ(findFormat(VK_FORMAT_UNDEFINED), nullptr);
    EXPECT_EQ(findFormat(VK_FORMAT_G8B8G8R8_422_UNORM), nullptr);
    EXPECT_EQ(findFormat(VK_FORMAT_MAX_ENUM), nullptr);
    EXPECT_EQ(findFormat(static_cast<VkFormat>(0x7ffffffe)), nullptr);
}

TEST(FormatTable, ComponentsFitTheTexelWithoutOverlap) {
    for (const FormatInfo& info : allFormats()) {
        if (info.block != nullptr) continue;
        std::array<int, 128> owner{};
        int components = 0;
        for (const VkImageAspectFlags aspect :
             {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
            if ((info.aspects & aspect) == 0) continue;
            const TexelLayout& layout = info.layout(aspect);
            EXPECT_EQ(layout.bytes, info.bytesPerTexel);
            for (const Component& part : layout.rgba) {
                if (part.bits == 0) continue;
                ++components;
                ASSERT_LE(part.offset + part.bits, info.bytesPerTexel * 8) << info.name;
                EXPECT_EQ(part.offset / 32, (part.offset + part.bits - 1) / 32) << info.name;
                for (int b = part.offset; b < part.offset + part.bits; ++b) EXPECT_EQ(owner[b]++, 0) << info.name;
            }
        }
        EXPECT_EQ(components, info.componentCount) << info.name;
    }
}

struct Requirement {
    VkFormat format;
    VkFormatFeatureFlags optimal, buffer;
};

// From the tables of "Required Format Support".
TEST(FormatTable, MandatoryFeatures) {
    constexpr VkFormatFeatureFlags kS = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_BLIT_SRC_BIT;
    constexpr VkFormatFeatureFlags kL = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    constexpr VkFormatFeatureFlags kC = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
    constexpr VkFormatFeatureFlags kB = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    constexpr VkFormatFeatureFlags kI = VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    constexpr VkFormatFeatureFlags kA = VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT;
    constexpr VkFormatFeatureFlags kD = VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    constexpr VkFormatFeatureFlags kV = VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT;
    constexpr VkFormatFeatureFlags kU = VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT;
    constexpr VkFormatFeatureFlags kT = VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT;
    constexpr VkFormatFeatureFlags kTA = VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_ATOMIC_BIT;
    const Requirement requirements[] = {
        {VK_FORMAT_B4G4R4A4_UNORM_PACK16, kS | kL, 0},
        {VK_FORMAT_R5G6B5_UNORM_PACK16, kS | kL | kC | kB, 0},
        {VK_FORMAT_A1R5G5B5_UNORM_PACK16, kS | kL | kC | kB, 0},
        {VK_FORMAT_R8_UNORM, kS | kL | kC | kB, kV | kU},
        {VK_FORMAT_R8_SNORM, kS | kL, kV | kU},
        {VK_FORMAT_R8_UINT, kS | kC, kV | kU},
        {VK_FORMAT_R8_SINT, kS | kC, kV | kU},
        {VK_FORMAT_R8G8_UNORM, kS | kL | kC | kB, kV | kU},
        {VK_FORMAT_R8G8_SNORM, kS | kL, kV | kU},
        {VK_FORMAT_R8G8_UINT, kS | kC, kV | kU},
        {VK_FORMAT_R8G8_SINT, kS | kC, kV | kU},
        {VK_FORMAT_R8G8B8A8_UNORM, kS | kL | kC | kB | kI, kV | kU | kT},
        {VK_FORMAT_R8G8B8A8_SNORM, kS | kL | kI, kV | kU | kT},
        {VK_FORMAT_R8G8B8A8_UINT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_R8G8B8A8_SINT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_R8G8B8A8_SRGB, kS | kL | kC | kB, 0},
        {VK_FORMAT_B8G8R8A8_UNORM, kS | kL | kC | kB, kV | kU},
        {VK_FORMAT_B8G8R8A8_SRGB, kS | kL | kC | kB, 0},
        {VK_FORMAT_A8B8G8R8_UNORM_PACK32, kS | kL | kC | kB, kV | kU | kT},
        {VK_FORMAT_A8B8G8R8_SNORM_PACK32, kS | kL, kV | kU | kT},
        {VK_FORMAT_A8B8G8R8_UINT_PACK32, kS | kC, kV | kU | kT},
        {VK_FORMAT_A8B8G8R8_SINT_PACK32, kS | kC, kV | kU | kT},
        {VK_FORMAT_A8B8G8R8_SRGB_PACK32, kS | kL | kC | kB, 0},
        {VK_FORMAT_A2B10G10R10_UNORM_PACK32, kS | kL | kC | kB, kV | kU},
        {VK_FORMAT_A2B10G10R10_UINT_PACK32, kS | kC, kU},
        {VK_FORMAT_R16_UNORM, 0, kV},
        {VK_FORMAT_R16_SNORM, 0, kV},
        {VK_FORMAT_R16_UINT, kS | kC, kV | kU},
        {VK_FORMAT_R16_SINT, kS | kC, kV | kU},
        {VK_FORMAT_R16_SFLOAT, kS | kL | kC | kB, kV | kU},
        {VK_FORMAT_R16G16_UINT, kS | kC, kV | kU},
        {VK_FORMAT_R16G16_SFLOAT, kS | kL | kC | kB, kV | kU},
        {VK_FORMAT_R16G16B16A16_UNORM, 0, kV},
        {VK_FORMAT_R16G16B16A16_UINT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_R16G16B16A16_SINT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_R16G16B16A16_SFLOAT, kS | kL | kC | kB | kI, kV | kU | kT},
        {VK_FORMAT_R32_UINT, kS | kC | kI | kA, kV | kU | kT | kTA},
        {VK_FORMAT_R32_SINT, kS | kC | kI | kA, kV | kU | kT | kTA},
        {VK_FORMAT_R32_SFLOAT, kS | kC | kI | kA, kV | kU | kT | kTA},  // shaderImageFloat32Atomics asks for it
        {VK_FORMAT_R32G32_UINT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_R32G32_SFLOAT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_R32G32B32_UINT, 0, kV},
        {VK_FORMAT_R32G32B32_SFLOAT, 0, kV},
        {VK_FORMAT_R32G32B32A32_UINT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_R32G32B32A32_SFLOAT, kS | kC | kI, kV | kU | kT},
        {VK_FORMAT_B10G11R11_UFLOAT_PACK32, kS | kL, kU},
        {VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, kS | kL, 0},
        {VK_FORMAT_D16_UNORM, kS | kD, 0},
        {VK_FORMAT_X8_D24_UNORM_PACK32, kD, 0},
        {VK_FORMAT_D32_SFLOAT, kS | kD, 0},
        {VK_FORMAT_D24_UNORM_S8_UINT, kD, 0},
        {VK_FORMAT_D32_SFLOAT_S8_UINT, kD, 0},
    };
    for (const Requirement& required : requirements) {
        const FormatInfo* const info = findFormat(required.format);
        ASSERT_NE(info, nullptr) << required.format;
        EXPECT_EQ(info->optimalTilingFeatures & required.optimal, required.optimal) << info->name;
        EXPECT_EQ(info->bufferFeatures & required.buffer, required.buffer) << info->name;
    }
}

// The formats that the feature shaderStorageImageExtendedFormats names.
TEST(FormatTable, ExtendedStorageFormats) {
    for (const VkFormat format : {VK_FORMAT_R16G16_SFLOAT,
                                  VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                                  VK_FORMAT_R16_SFLOAT,
                                  VK_FORMAT_R16G16B16A16_UNORM,
                                  VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                  VK_FORMAT_R16G16_UNORM,
                                  VK_FORMAT_R8G8_UNORM,
                                  VK_FORMAT_R16_UNORM,
                                  VK_FORMAT_R8_UNORM,
                                  VK_FORMAT_R16G16B16A16_SNORM,
                                  VK_FORMAT_R16G16_SNORM,
                                  VK_FORMAT_R8G8_SNORM,
                                  VK_FORMAT_R16_SNORM,
                                  VK_FORMAT_R8_SNORM,
                                  VK_FORMAT_R16G16_SINT,
                                  VK_FORMAT_R8G8_SINT,
                                  VK_FORMAT_R16_SINT,
                                  VK_FORMAT_R8_SINT,
                                  VK_FORMAT_A2B10G10R10_UINT_PACK32,
                                  VK_FORMAT_R16G16_UINT,
                                  VK_FORMAT_R8G8_UINT,
                                  VK_FORMAT_R16_UINT,
                                  VK_FORMAT_R8_UINT}) {
        EXPECT_TRUE(findFormat(format)->optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) << format;
    }
}

// Integer formats can be neither filtered nor blended, whatever else the table grows.
TEST(FormatTable, IntegersAreNotFilteredOrBlended) {
    for (const FormatInfo& info : allFormats()) {
        if ((info.aspects & VK_IMAGE_ASPECT_COLOR_BIT) == 0 || info.color.type == ValueType::floating) continue;
        EXPECT_EQ(info.optimalTilingFeatures & (VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                                VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT),
                  0u)
            << info.name;
    }
}

TEST(FormatTable, ComponentOrderOfPackedFormats) {
    const auto packed = [](VkFormat format, float r, float g, float b, float a) {
        uint32_t texel = 0;
        packTexel(findFormat(format)->color, {.float32 = {r, g, b, a}}, &texel);
        return texel;
    };
    EXPECT_EQ(packed(VK_FORMAT_R5G6B5_UNORM_PACK16, 1, 0, 0, 0), 0xf800u);
    EXPECT_EQ(packed(VK_FORMAT_R5G6B5_UNORM_PACK16, 0, 0, 1, 0), 0x001fu);
    EXPECT_EQ(packed(VK_FORMAT_R4G4B4A4_UNORM_PACK16, 1, 0, 0, 0), 0xf000u);
    EXPECT_EQ(packed(VK_FORMAT_B4G4R4A4_UNORM_PACK16, 1, 0, 0, 0), 0x00f0u);
    EXPECT_EQ(packed(VK_FORMAT_A1R5G5B5_UNORM_PACK16, 0, 0, 0, 1), 0x8000u);
    EXPECT_EQ(packed(VK_FORMAT_A1R5G5B5_UNORM_PACK16, 1, 0, 0, 0), 0x7c00u);
    EXPECT_EQ(packed(VK_FORMAT_R8G8B8A8_UNORM, 1, 0, 0, 0), 0xffu);
    EXPECT_EQ(packed(VK_FORMAT_B8G8R8A8_UNORM, 1, 0, 0, 0), 0xff0000u);
    EXPECT_EQ(packed(VK_FORMAT_A8B8G8R8_UNORM_PACK32, 0, 0, 0, 1), 0xff000000u);
    EXPECT_EQ(packed(VK_FORMAT_A2B10G10R10_UNORM_PACK32, 1, 0, 0, 0), 0x3ffu);
    EXPECT_EQ(packed(VK_FORMAT_A2R10G10B10_UNORM_PACK32, 1, 0, 0, 0), 0x3ff00000u);
    EXPECT_EQ(packed(VK_FORMAT_B10G11R11_UFLOAT_PACK32, 1, 0, 0, 0), 15u << 6);
    EXPECT_EQ(packed(VK_FORMAT_B10G11R11_UFLOAT_PACK32, 0, 0, 1, 0), 15u << 27);
}

TEST(FormatTable, ComponentBitsFollowTheWriteMask) {
    uint32_t bits = 0;
    componentBits(*findFormat(VK_FORMAT_B8G8R8A8_UNORM), VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_A_BIT, &bits);
    EXPECT_EQ(bits, 0xffff0000u);
    componentBits(*findFormat(VK_FORMAT_A2B10G10R10_UNORM_PACK32), VK_COLOR_COMPONENT_G_BIT, &bits);
    EXPECT_EQ(bits, 0x3ffu << 10);
    uint64_t wide = 0;
    componentBits(*findFormat(VK_FORMAT_R16G16B16A16_SFLOAT), VK_COLOR_COMPONENT_B_BIT, &wide);
    EXPECT_EQ(wide, 0xffffull << 32);
}

TEST(FormatCopy, AspectsTravelInTheSpecifiedPacking) {
    const FormatInfo& d24s8 = *findFormat(VK_FORMAT_D24_UNORM_S8_UINT);
    const uint32_t texels[3] = {0xab123456u, 0x00ffffffu, 0xff000001u};
    uint32_t depth[3];
    uint8_t stencil[3];
    EXPECT_EQ(bufferTexelBytes(d24s8, VK_IMAGE_ASPECT_DEPTH_BIT), 4u);
    EXPECT_EQ(bufferTexelBytes(d24s8, VK_IMAGE_ASPECT_STENCIL_BIT), 1u);
    copyTexelsToBuffer(d24s8, VK_IMAGE_ASPECT_DEPTH_BIT, texels, 3, depth);
    copyTexelsToBuffer(d24s8, VK_IMAGE_ASPECT_STENCIL_BIT, texels, 3, stencil);
    EXPECT_EQ(depth[0], 0x123456u);
    EXPECT_EQ(depth[1], 0xffffffu);
    EXPECT_EQ(stencil[0], 0xab);
    EXPECT_EQ(stencil[2], 0xff);
    uint32_t copy[3] = {0, 0x11111111u, 0};
    copyTexelsFromBuffer(d24s8, VK_IMAGE_ASPECT_DEPTH_BIT, depth, 3, copy);
    EXPECT_EQ(copy[1], 0x11ffffffu);
    copyTexelsFromBuffer(d24s8, VK_IMAGE_ASPECT_STENCIL_BIT, stencil, 3, copy);
    EXPECT_EQ(0, std::memcmp(copy, texels, sizeof texels));

    const FormatInfo& d32s8 = *findFormat(VK_FORMAT_D32_SFLOAT_S8_UINT);
    const float z[2] = {0.25f, 1.0f};
    const uint8_t s[2] = {7, 200};
    uint64_t pair[2] = {};
    copyTexelsFromBuffer(d32s8, VK_IMAGE_ASPECT_DEPTH_BIT, z, 2, pair);
    copyTexelsFromBuffer(d32s8, VK_IMAGE_ASPECT_STENCIL_BIT, s, 2, pair);
    EXPECT_EQ(pair[1], 200ull << 32 | 0x3f800000u);
    float zBack[2];
    uint8_t sBack[2];
    copyTexelsToBuffer(d32s8, VK_IMAGE_ASPECT_DEPTH_BIT, pair, 2, zBack);
    copyTexelsToBuffer(d32s8, VK_IMAGE_ASPECT_STENCIL_BIT, pair, 2, sBack);
    EXPECT_EQ(zBack[0], 0.25f);
    EXPECT_EQ(sBack[0], 7);

    const FormatInfo& x8d24 = *findFormat(VK_FORMAT_X8_D24_UNORM_PACK32);
    copyTexelsToBuffer(x8d24, VK_IMAGE_ASPECT_DEPTH_BIT, texels, 3, depth);
    EXPECT_EQ(depth[0], 0x123456u);

    const FormatInfo& rgba16 = *findFormat(VK_FORMAT_R16G16B16A16_SFLOAT);
    std::vector<uint8_t> bytes(8 * 5), out(8 * 5);
    std::iota(bytes.begin(), bytes.end(), uint8_t{1});
    copyTexelsToBuffer(rgba16, VK_IMAGE_ASPECT_COLOR_BIT, bytes.data(), 5, out.data());
    EXPECT_EQ(bytes, out);
}

TEST(FormatClear, PacksTheAspectsAskedFor) {
    VkClearValue clear{};
    clear.depthStencil = {0.5f, 0x1f3u};
    uint32_t texel = 0x77000000u;
    const FormatInfo& d24s8 = *findFormat(VK_FORMAT_D24_UNORM_S8_UINT);
    packClear(d24s8, VK_IMAGE_ASPECT_DEPTH_BIT, clear, &texel);
    EXPECT_EQ(texel, 0x77800000u);  // 8388607.5 rounds to even
    packClear(d24s8, VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT, clear, &texel);
    EXPECT_EQ(texel, 0xf3800000u);  // the stencil value keeps its low bits
    clear.color = {.float32 = {1.0f, 0.5f, -1.0f, 2.0f}};
    packClear(*findFormat(VK_FORMAT_R8G8B8A8_UNORM), VK_IMAGE_ASPECT_COLOR_BIT, clear, &texel);
    EXPECT_EQ(texel, 0xff0080ffu);
}

}  // namespace
}  // namespace vernier
