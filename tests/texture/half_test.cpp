// Texels of four halves: the fast routine gives the bits of the general one, which a view of several layers gets.
#include <bit>
#include <cmath>
#include <cstring>

#include "tests/texture/model.h"

namespace vernier::texture_test {
namespace {

constexpr uint32_t kWidth = 37, kHeight = 21;

/// What the texels hold.
enum class Contents { positive, signedNumbers, withSpecials };

uint16_t randomHalf(std::mt19937& random, Contents contents) {
    constexpr uint16_t kSpecials[] = {0x0000, 0x8000, 0x0001, 0x83ff, 0x7bff, 0xfbff, 0x7c00, 0xfc00, 0x7e00};
    if (contents == Contents::withSpecials && random() % 4 == 0) return kSpecials[random() % std::size(kSpecials)];
    const auto magnitude = static_cast<uint16_t>(random() % 0x7c00);
    return contents == Contents::positive || random() % 2 == 0 ? magnitude : magnitude | 0x8000;
}

/// Blocks of 8 pixels a row at random places, as full-screen passes have them: beside the image, too; or anywhere.
void fillCoordinates(Batch& batch, std::mt19937& random, bool inRows) {
    std::uniform_real_distribution<float> anywhere(-1.5f, 2.5f), offset(-0.75f, 0.75f);
    const auto x = static_cast<float>(random() % (kWidth + 16)) - 8, y = static_cast<float>(random() % kHeight);
    const float dx = random() % 2 == 0 ? 0.5f : offset(random), dy = random() % 2 == 0 ? 0.5f : offset(random);
    const float scale = random() % 4 == 0 ? 0.5f : 1.0f;
    for (uint32_t i = 0; i < batch.lanes; ++i) {
        const float column = x + static_cast<float>(i % 8) * scale + dx,
                    row = y + static_cast<float>(i / 8) * scale + dy;
        batch.coord[0][i] = inRows ? column / kWidth : anywhere(random);
        batch.coord[1][i] = inRows ? row / kHeight : anywhere(random);
        batch.coord[3][i] = 0;
    }
}

TEST(Halves, AsTheGeneralRoutine) {
    std::mt19937 random(21);
    for (const Contents contents : {Contents::positive, Contents::signedNumbers, Contents::withSpecials}) {
        Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, 2, 1);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x)
                for (uint32_t c = 0; c < 4; ++c) {
                    const uint16_t half = randomHalf(random, contents);
                    std::memcpy(image.texel(0, x, y, 0) + 2 * c, &half, 2);
                }
        for (int round = 0; round < 200; ++round) {
            const SamplerState sampler =
                makeSampler(VK_FILTER_LINEAR,
                            round % 2 == 0 ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE : VK_SAMPLER_ADDRESS_MODE_REPEAT);
            image.swizzle = {};
            if (round % 5 == 0)
                image.swizzle = {VK_COMPONENT_SWIZZLE_B, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_R,
                                 VK_COMPONENT_SWIZZLE_A};
            Batch fast(round % 3 == 0 ? 20 : 64), general(fast.lanes);
            fillCoordinates(fast, random, round % 4 != 3);
            general.coord = fast.coord;
            for (uint32_t a = 0; a < 4; ++a) general.request.coord[a] = general.coord[a].data();
            for (const Isa isa : availableIsas()) {
                const TextureView layers = image.view(isa);
                TextureView flat = layers;
                flat.type = VK_IMAGE_VIEW_TYPE_2D;
                flat.layerCount = 1;
                fast.run(selectSampler(flat, sampler, isa), flat, sampler);
                general.run(selectSampler(layers, sampler, isa), layers, sampler);
                for (uint32_t i = 0; i < fast.lanes; ++i)
                    for (size_t c = 0; c < 4; ++c) {
                        const float a = fast.out[c][i], b = general.out[c][i];
                        if (std::isnan(a) && std::isnan(b)) continue;
                        ASSERT_EQ(std::bit_cast<uint32_t>(a), std::bit_cast<uint32_t>(b))
                            << isaName(isa) << " round " << round << " lane " << i << " component " << c << ": " << a
                            << ", " << b;
                    }
            }
        }
    }
}

}  // namespace
}  // namespace vernier::texture_test
