#include "conformance/scene/scene_format.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

namespace vernier::conformance {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
    std::vector<std::byte> result;
    for (const int value : values) result.push_back(static_cast<std::byte>(value));
    return result;
}

double decode(VkFormat format, size_t component, const std::vector<std::byte>& texel) {
    const FormatComponent& description = sceneFormat(format)->components[component];
    return decodeComponent(description, componentCode(description, texel));
}

TEST(SceneFormat, ComponentsAreFoundInTheTexel) {
    const auto texel = bytes({0, 51, 102, 255});
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R8G8B8A8_UNORM, 1, texel), 0.2);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_B8G8R8A8_UNORM, 0, texel), 0.4);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_B8G8R8A8_UNORM, 2, texel), 0);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R8G8B8A8_UNORM, 3, texel), 1);
    // 5-6-5: red in the top bits.
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R5G6B5_UNORM_PACK16, 0, bytes({0x00, 0xf8})), 1);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R5G6B5_UNORM_PACK16, 1, bytes({0xe0, 0x07})), 1);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_A2B10G10R10_UNORM_PACK32, 1, bytes({0, 0xfc, 0x0f, 0})), 1);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R8G8B8A8_SNORM, 0, bytes({0x80, 0, 0, 0})), -1);
}

TEST(SceneFormat, SrgbIsDecodedToLinearAndAlphaIsNot) {
    const auto texel = bytes({0, 255, 188, 188});
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R8G8B8A8_SRGB, 0, texel), 0);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R8G8B8A8_SRGB, 1, texel), 1);
    EXPECT_NEAR(decode(VK_FORMAT_R8G8B8A8_SRGB, 2, texel), 0.5029, 1e-4);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R8G8B8A8_SRGB, 3, texel), 188.0 / 255);
}

TEST(SceneFormat, HalfFloats) {
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R16_SFLOAT, 0, bytes({0x00, 0x3c})), 1);
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R16_SFLOAT, 0, bytes({0x01, 0x00})), std::ldexp(1, -24));
    EXPECT_DOUBLE_EQ(decode(VK_FORMAT_R16_SFLOAT, 0, bytes({0xff, 0xfb})), -65504);
    EXPECT_TRUE(std::isinf(decode(VK_FORMAT_R16_SFLOAT, 0, bytes({0x00, 0x7c}))));
    EXPECT_TRUE(std::isnan(decode(VK_FORMAT_R16_SFLOAT, 0, bytes({0x01, 0x7c}))));
}

// For every format: the places are in the order of the values, neighbours differ by one, and places lead back
// to codes.
TEST(SceneFormat, PlacesRiseWithValues) {
    for (const SceneFormat& format : sceneFormats()) {
        for (size_t i = 0; i < format.componentCount; ++i) {
            const FormatComponent& component = format.components[i];
            const uint64_t codes = uint64_t{1} << component.bits;
            const uint64_t step = codes > 70000 ? codes / 65521 : 1;
            for (uint64_t code = 0; code < codes; code += step) {
                const auto here = static_cast<uint32_t>(code);
                if (isNan(component, here)) continue;
                const int64_t place = codePlace(component, here);
                const auto back = codeAtPlace(component, place);
                ASSERT_TRUE(back) << format.name << " " << code;
                EXPECT_EQ(decodeComponent(component, *back), decodeComponent(component, here))
                    << format.name << " " << code;
                const auto next = codeAtPlace(component, place + 1);
                if (next) {
                    EXPECT_GT(decodeComponent(component, *next), decodeComponent(component, here))
                        << format.name << " " << code;
                }
            }
        }
    }
}

TEST(SceneFormat, PlacesEnd) {
    const FormatComponent byte = sceneFormat(VK_FORMAT_R8_UNORM)->components[0];
    EXPECT_FALSE(codeAtPlace(byte, -1));
    EXPECT_FALSE(codeAtPlace(byte, 256));
    const FormatComponent single = sceneFormat(VK_FORMAT_R32_SFLOAT)->components[0];
    EXPECT_FALSE(codeAtPlace(single, 0x7f800001));
    EXPECT_EQ(codeAtPlace(single, -1), 0x80000001u);
    EXPECT_EQ(codePlace(single, std::bit_cast<uint32_t>(-0.0f)), 0);
}

TEST(SceneFormat, UnknownFormatsAreNone) {
    EXPECT_EQ(sceneFormat(VK_FORMAT_G8B8G8R8_422_UNORM), nullptr);
}

TEST(SceneFormat, CompressedImagesAreCountedInBlocks) {
    const SceneFormat& format = *sceneFormat(VK_FORMAT_ASTC_10x6_UNORM_BLOCK);
    EXPECT_TRUE(format.isCompressed());
    EXPECT_EQ(format.imageBytes(11, 6), 32u);
    EXPECT_EQ(format.imageBytes(1, 1), 16u);
    EXPECT_EQ(sceneFormat(VK_FORMAT_R8G8_UNORM)->imageBytes(3, 5), 30u);
}

}  // namespace
}  // namespace vernier::conformance
