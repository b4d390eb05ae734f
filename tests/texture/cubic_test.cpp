// Cubic filters ("Texel Cubic Filtering", Catmull-Rom): values by hand, the same bits on every instruction set.
#include "tests/texture/model.h"

namespace vernier::texture_test {
namespace {

/// 1, 2, 4, 8 along x, the same in every row.
Image powers(VkFormat format = VK_FORMAT_R32_SFLOAT, VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D) {
    Image image(type, format, 4, 4, 1, 1, 1);
    for (uint32_t y = 0; y < 4; ++y) {
        for (uint32_t x = 0; x < 4; ++x) {
            VkClearColorValue value{};
            value.float32[0] = static_cast<float>(1u << x);
            image.set(0, x, y, 0, value);
        }
    }
    return image;
}

/// At (u, v) in texels.
double red(const Image& image, float u, float v, VkSamplerAddressMode mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
           Isa isa = bestIsa()) {
    return sampleOne(image, makeSampler(VK_FILTER_CUBIC_EXT, mode), u / 4, v / 4, 0, 0, 0, isa)[0];
}

TEST(Cubic, BetweenTexelsByHand) {
    const Image image = powers();
    // Half-way: (-1, 9, 9, -1) sixteenths.
    EXPECT_EQ(red(image, 2, 2), (-1 + 9 * 2 + 9 * 4 - 8) / 16.0);
    // A quarter: (-9, 111, 29, -3) 128ths.
    EXPECT_EQ(red(image, 1.75f, 2), (-9 + 111 * 2 + 29 * 4 - 3 * 8) / 128.0);
    EXPECT_EQ(red(image, 1.5f, 2), 2) << "a texel's centre is the texel";
    EXPECT_EQ(red(image, 1.5f, 1.8125f), 2) << "equal rows";
}

TEST(Cubic, BeyondTheBorder) {
    const Image image = powers();
    EXPECT_EQ(red(image, 4, 2), (-4 + 9 * 8 + 9 * 8 - 8) / 16.0);
    EXPECT_EQ(red(image, 0, 2, VK_SAMPLER_ADDRESS_MODE_REPEAT), (-4 + 9 * 8 + 9 * 1 - 2) / 16.0);
    EXPECT_EQ(red(image, 0, 2, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT), (-2 + 9 + 9 - 2) / 16.0);
    // Two of the four are the border, which is 0.
    EXPECT_EQ(red(image, 0, 2, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER), (9 - 2) / 16.0);
    EXPECT_EQ(red(image, -40, 2), 1);
}

TEST(Cubic, BothAxes) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT, 4, 4, 1, 1, 1);
    VkClearColorValue one{};
    one.float32[0] = 256;
    image.set(0, 1, 1, 0, one);
    EXPECT_EQ(red(image, 2, 2), 81);
    EXPECT_EQ(red(image, 3, 3), 1);
    EXPECT_EQ(red(image, 2, 3), -9);
}

TEST(Cubic, InfinitiesStayWhereTheyHaveAWeight) {
    Image image = powers();
    VkClearColorValue infinite{};
    infinite.float32[0] = kInf;
    for (uint32_t y = 0; y < 4; ++y) image.set(0, 3, y, 0, infinite);
    EXPECT_EQ(red(image, 1.5f, 2), 2) << "a centre reads its texel alone";
    EXPECT_EQ(red(image, 3.5f, 2), kInf);
}

TEST(Cubic, MagnifiesBesideOtherFilters) {
    const Image image = powers();
    SamplerState sampler = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    sampler.magFilter = VK_FILTER_CUBIC_EXT;
    const TextureView view = image.view(bestIsa());
    Batch batch(8);
    for (uint32_t i = 0; i < 8; ++i) {
        batch.coord[0][i] = batch.coord[1][i] = 0.5f;
        batch.lod[i] = i < 4 ? -1.0f : 1.0f;
    }
    batch.run(selectSampler(view, sampler, bestIsa()), view, sampler);
    EXPECT_EQ(batch.result(view, 0)[0], 45.0 / 16);
    EXPECT_EQ(batch.result(view, 4)[0], 4);
}

TEST(Cubic, TheSameBitsOnEveryInstructionSet) {
    Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_R8G8B8A8_UNORM, 9, 7, 1, 3, 1);
    image.randomize(5);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-1.5f, 2.5f);
    for (int i = 0; i < 300; ++i) {
        const float s = place(random), t = place(random);
        const auto at = [&](Isa isa) {
            return sampleOne(image, makeSampler(VK_FILTER_CUBIC_EXT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT), s, t, 0,
                             1, 0, isa);
        };
        for (const Isa isa : availableIsas()) EXPECT_EQ(at(isa), at(bestIsa()));
    }
}

TEST(Cubic, WhatHasNoneIsRefused) {
    const SamplerState cubic = makeSampler(VK_FILTER_CUBIC_EXT, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    const auto refused = [](const Image& image, const SamplerState& sampler) {
        const Status status = checkSampling(image.view(bestIsa()), sampler);
        return !status.ok() && status.error().message.find("cubic") != std::string::npos;
    };
    EXPECT_FALSE(refused(powers(), cubic));
    EXPECT_TRUE(refused(Image(VK_IMAGE_VIEW_TYPE_3D, VK_FORMAT_R32_SFLOAT, 4, 4, 4, 1, 1), cubic));
    EXPECT_TRUE(refused(Image(VK_IMAGE_VIEW_TYPE_CUBE, VK_FORMAT_R8_UNORM, 4, 4, 1, 6, 1), cubic));
    EXPECT_TRUE(refused(Image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_UINT, 4, 4, 1, 1, 1), cubic));
    SamplerState anisotropic = cubic;
    anisotropic.maxAnisotropy = 2;
    EXPECT_TRUE(refused(powers(), anisotropic));
}

}  // namespace
}  // namespace vernier::texture_test
