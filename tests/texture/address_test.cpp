// Coordinates at the edges of the representable: texel boundaries, wrap-around, huge and special values.
#include <cstring>

#include "tests/texture/model.h"

namespace vernier::texture_test {
namespace {

constexpr VkSamplerAddressMode kAllModes[] = {
    VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE};

/// A row of texels 0, 1, 2, ... (uint), so that a sample names the texel it came from.
Image ramp(uint32_t width) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_UINT, width, 1, 1, 1, 1);
    for (uint32_t x = 0; x < width; ++x) image.set(0, x, 0, 0, {.uint32 = {x}});
    return image;
}

double texelAt(const Image& image, VkSamplerAddressMode mode, float s) {
    return sampleOne(image, makeSampler(VK_FILTER_NEAREST, mode), s, 0.5f)[0];
}

// T01: a coordinate on a texel's left edge belongs to that texel.
TEST(Address, TexelBoundariesBelongToTheRight) {
    const Image image = ramp(16);
    for (const VkSamplerAddressMode mode : kAllModes) {
        for (uint32_t i = 0; i < 16; ++i) {
            EXPECT_EQ(texelAt(image, mode, static_cast<float>(i) / 16), i);
            EXPECT_EQ(texelAt(image, mode, std::nextafter(static_cast<float>(i + 1) / 16, 0.0f)), i);
        }
    }
}

// T02, T03: just outside and just inside the unit interval.
TEST(Address, TinyNegativeAndAlmostOne) {
    for (const uint32_t width : {1u, 5u, 16u, 1000u}) {
        const Image image = ramp(width);
        const double last = width - 1;
        for (const float tiny : {-0x1p-30f, -0x1p-126f, -1e-44f}) {
            EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_REPEAT, tiny), last) << width << " " << tiny;
            EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, tiny), 0);
            EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, tiny), 0);
            EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, tiny), 0);
        }
        const float almostOne = 1 - 0x1p-24f;
        for (const VkSamplerAddressMode mode : kAllModes) EXPECT_EQ(texelAt(image, mode, almostOne), last);
        EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_REPEAT, 1.0f), 0);
        EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, 1.0f), last);
        EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1.0f), last);
        EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE, 1.0f), last);
    }
}

// The linear filter at the seam: half of the last texel, half of what follows it.
TEST(Address, LinearFilterAcrossTheSeam) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT, 4, 1, 1, 1, 1);
    for (uint32_t x = 0; x < 4; ++x) image.set(0, x, 0, 0, {.float32 = {static_cast<float>(10 * x + 10)}});
    const auto at = [&](VkSamplerAddressMode mode, float s) {
        SamplerState sampler = makeSampler(VK_FILTER_LINEAR, mode);
        sampler.addressMode[1] = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        sampler.borderColor = {.float32 = {100, 0, 0, 1}};
        return sampleOne(image, sampler, s, 0.5f)[0];
    };
    for (const float s : {0.0f, 1.0f, -3.0f}) EXPECT_EQ(at(VK_SAMPLER_ADDRESS_MODE_REPEAT, s), 25);
    EXPECT_NEAR(at(VK_SAMPLER_ADDRESS_MODE_REPEAT, -0x1p-30f), 25, 1e-5);
    EXPECT_EQ(at(VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, 1.0f), 40);
    EXPECT_EQ(at(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1.0f), 40);
    EXPECT_EQ(at(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, 1.0f), 70);
    EXPECT_EQ(at(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, 0.0f), 55);
    EXPECT_EQ(at(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, 1.25f), 100);
    EXPECT_EQ(at(VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE, -0.5f), 25);
}

// T05: the mirrored image is symmetrical about every whole coordinate.
TEST(Address, MirroredRepeatIsSymmetrical) {
    const Image image = ramp(16);
    for (int k = -2; k <= 2; ++k) {
        for (int i = 0; i < 64; ++i) {
            const float d = (static_cast<float>(i) + 0.5f) / 64;
            const auto mode = VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
            EXPECT_EQ(texelAt(image, mode, static_cast<float>(k) + d), texelAt(image, mode, static_cast<float>(k) - d));
        }
    }
}

// T06: the border colour of formats without alpha leaves alpha at 1, and a transparent border is transparent.
TEST(Address, BorderColours) {
    Image rgba(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_B8G8R8A8_UNORM, 2, 2, 1, 1, 1);
    Image red(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8_UNORM, 2, 2, 1, 1, 1);
    VkSamplerCreateInfo info{};
    info.magFilter = info.minFilter = VK_FILTER_NEAREST;
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.borderColor = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    EXPECT_EQ(sampleOne(rgba, makeSamplerState(info), 2, 0), (Rgba{0, 0, 0, 0}));
    EXPECT_EQ(sampleOne(red, makeSamplerState(info), 2, 0), (Rgba{0, 0, 0, 1}));
    info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    EXPECT_EQ(sampleOne(rgba, makeSamplerState(info), 2, 0), (Rgba{1, 1, 1, 1}));
    EXPECT_EQ(sampleOne(red, makeSamplerState(info), 0, -1), (Rgba{1, 0, 0, 1}));
}

// T04: whatever the coordinates, some texel (or the border) is read and nothing else; ASan watches.
TEST(Address, HugeAndSpecialCoordinatesStayInside) {
    const float values[] = {1e10f,  -1e10f, 0x1p31f, -0x1p31f, 0x1p24f,    3e38f,
                            -3e38f, kInf,   -kInf,   kNaN,     8388608.5f, -0.0f};
    for (const VkImageViewType type :
         {VK_IMAGE_VIEW_TYPE_1D, VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_VIEW_TYPE_3D, VK_IMAGE_VIEW_TYPE_CUBE,
          VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_IMAGE_VIEW_TYPE_CUBE_ARRAY}) {
        for (const VkFormat format :
             {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT}) {
            const uint32_t layers = type == VK_IMAGE_VIEW_TYPE_CUBE         ? 6
                                    : type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY ? 12
                                    : type == VK_IMAGE_VIEW_TYPE_2D_ARRAY   ? 3
                                                                            : 1;
            Image image(type, format, 5, type == VK_IMAGE_VIEW_TYPE_1D ? 1 : 5, type == VK_IMAGE_VIEW_TYPE_3D ? 5 : 1,
                        layers, 3);
            image.setAll({.float32 = {0.2f, 0.4f, 0.6f, 0.8f}});
            const VkClearColorValue texel = unpackTexel(image.info().color, image.texel(0, 0, 0, 0));
            for (const VkSamplerAddressMode mode : kAllModes) {
                for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
                    const SamplerState sampler = makeSampler(filter, mode, VK_SAMPLER_MIPMAP_MODE_LINEAR);
                    for (const Isa isa : availableIsas()) {
                        const TextureView view = image.view(isa);
                        for (const LodMode lodMode : {LodMode::implicitLod, LodMode::explicitLod, LodMode::base}) {
                            Batch batch(128);
                            std::mt19937 random(7);
                            for (uint32_t i = 0; i < batch.lanes; ++i) {
                                for (auto& c : batch.coord) c[i] = values[random() % std::size(values)];
                                batch.lod[i] = values[random() % std::size(values)];
                            }
                            batch.request.lodMode = lodMode;
                            batch.run(selectSampler(view, sampler, isa), view, sampler);
                            if (mode == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER && type != VK_IMAGE_VIEW_TYPE_CUBE)
                                continue;
                            if (type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) continue;
                            for (uint32_t i = 0; i < batch.lanes; ++i) ASSERT_EQ(batch.out[0][i], texel.float32[0]);
                        }
                    }
                }
            }
        }
    }
}

// A far repeat still lands on the right texel while the coordinate can tell.
TEST(Address, RepeatsFarAway) {
    const Image image = ramp(256);
    for (const float whole : {1000.0f, 65536.0f, -65536.0f}) {
        EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_REPEAT, whole + 0.25f), 64);
        EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_REPEAT, whole + 0.5f), 128);
    }
    EXPECT_EQ(texelAt(image, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, 65537.25f), 191);
}

// T14: layers round to nearest even and clamp.
TEST(Address, Layers) {
    Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_R32_UINT, 1, 1, 1, 4, 1);
    for (uint32_t layer = 0; layer < 4; ++layer) image.set(0, 0, 0, layer, {.uint32 = {layer}});
    const SamplerState sampler = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    const std::pair<float, double> cases[] = {{0.5f, 0},  {1.5f, 2},  {2.5f, 2}, {0.51f, 1},
                                              {-3.0f, 0}, {99.0f, 3}, {kInf, 3}, {kNaN, 0}};
    for (const auto& [layer, expected] : cases)
        EXPECT_EQ(sampleOne(image, sampler, 0, 0, 0, layer)[0], expected) << layer;
}

// T15: unnormalised coordinates are texels; equal to normalised ones at a power-of-two size.
TEST(Address, UnnormalizedCoordinates) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, 8, 4, 1, 1, 1);
    image.randomize(77);
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
        const SamplerState normalized = makeSampler(filter, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
        SamplerState texels = normalized;
        texels.unnormalizedCoordinates = true;
        for (int i = -4; i < 100; ++i) {
            const float u = static_cast<float>(i) * 0.125f;
            EXPECT_EQ(sampleOne(image, texels, u, u * 0.5f), sampleOne(image, normalized, u / 8, u * 0.5f / 4));
        }
    }
}

}  // namespace
}  // namespace vernier::texture_test
