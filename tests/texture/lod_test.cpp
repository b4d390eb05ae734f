// Level of detail: derivatives, logarithm, biases, clamps, choice of levels.
#include <mpfr.h>

#include "tests/texture/model.h"

namespace vernier::texture_test {
namespace {

/// Levels 0, 1, 2, ... hold their number.
Image levelsImage(uint32_t size, uint32_t levels, VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D) {
    const bool cube = type == VK_IMAGE_VIEW_TYPE_CUBE;
    Image image(type, VK_FORMAT_R32_SFLOAT, size, size, 1, cube ? 6 : 1, levels);
    for (uint32_t l = 0; l < levels; ++l) {
        const uint32_t extent = std::max(1u, size >> l);
        for (uint32_t f = 0; f < (cube ? 6u : 1u); ++f) {
            for (uint32_t y = 0; y < extent; ++y) {
                for (uint32_t x = 0; x < extent; ++x) image.set(l, x, y, f, {.float32 = {static_cast<float>(l)}});
            }
        }
    }
    return image;
}

struct LodResult {
    double level, lambda;
};

/// Queries with the derivatives dx, dy (in texels of a 256-wide image) along s.
LodResult query(const SamplerState& sampler, float dx, float dy, float bias = 0, bool explicitGradients = false,
                Isa isa = bestIsa(), const float* minLod = nullptr) {
    static const Image image = levelsImage(256, 9);
    const TextureView view = image.view(isa);
    Batch batch(8);
    std::vector<float> gx(8, dx / 256), gy(8, dy / 256), zero(8, 0.0f);
    for (uint32_t i = 0; i < 8; ++i) {
        batch.coord[0][i] = (i & 1 ? dx : 0) / 256 + (i & 2 ? dy : 0) / 256;
        batch.coord[1][i] = 0;
        batch.lod[i] = bias;
    }
    batch.request.lodMode = explicitGradients ? LodMode::gradients : LodMode::implicitLod;
    const std::vector<float> lowest(8, minLod == nullptr ? 0.0f : *minLod);
    if (minLod != nullptr) batch.request.minLod = lowest.data();
    batch.request.gradX[0] = gx.data();
    batch.request.gradY[0] = gy.data();
    batch.request.gradX[1] = batch.request.gradY[1] = zero.data();
    batch.run(selectQueryLod(view, sampler, isa), view, sampler);
    return {batch.out[0][5], batch.out[1][5]};
}

const SamplerState kTrilinear =
    makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_MIPMAP_MODE_LINEAR);
const SamplerState kNearestLevel = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);

TEST(Lod, InstructionsBoundItFromBelow) {
    for (const float least : {0.0f, 0.5f, 3.0f, 7.75f, 100.0f}) {
        for (int k = -3; k <= 8; ++k) {
            // The image has levels 0 to 8; lambda itself is told before any clamp.
            const LodResult result = query(kTrilinear, std::ldexp(1.0f, k), 0, 0, false, bestIsa(), &least);
            EXPECT_EQ(result.level, std::min(std::max(static_cast<float>(k), least), 8.0f));
            EXPECT_EQ(result.lambda, k);
        }
    }
    SamplerState bounded = kTrilinear;
    bounded.minLod = 2;
    bounded.maxLod = 5;
    for (const float least : {0.0f, 3.0f, 7.0f}) {
        EXPECT_EQ(query(bounded, 1, 0, 0, false, bestIsa(), &least).level, std::clamp(least, 2.0f, 5.0f));
    }
}

TEST(Lod, PowersOfTwoAreExact) {
    for (int k = -3; k <= 8; ++k) {
        EXPECT_EQ(query(kTrilinear, std::ldexp(1.0f, k), 0).lambda, k);
        EXPECT_EQ(query(kTrilinear, 0, std::ldexp(1.0f, k)).lambda, k);
        EXPECT_EQ(query(kTrilinear, std::ldexp(1.0f, k), 0, 0, true).lambda, k);
    }
}

// The stated bound is 2^-13 of a level; the logarithm itself does better.
TEST(Lod, LogarithmAgainstMpfr) {
    mpfr_t exact;
    mpfr_init2(exact, 100);
    double worst = 0;
    for (int i = 0; i < 40000; ++i) {
        const float rho = std::ldexp(1.0f + static_cast<float>(i) / 40000, i % 9);
        const double lambda = query(kTrilinear, rho, 0, 0, true).lambda;
        const float stored = rho / 256 * 256;
        mpfr_set_flt(exact, stored, MPFR_RNDN);
        mpfr_log2(exact, exact, MPFR_RNDN);
        worst = std::max(worst, std::abs(lambda - mpfr_get_d(exact, MPFR_RNDN)));
    }
    mpfr_clear(exact);
    EXPECT_LT(worst, std::ldexp(1.0, -18));
}

TEST(Lod, LongerGradientWins) {
    EXPECT_EQ(query(kTrilinear, 8, 2).lambda, 3);
    EXPECT_EQ(query(kTrilinear, 2, 8).lambda, 3);
    // L06: a rotation by 45 degrees keeps the length: (sqrt 2, sqrt 2) texels are 2.
    static const Image image = levelsImage(256, 9);
    const TextureView view = image.view(bestIsa());
    Batch batch(4);
    const float d = std::sqrt(2.0f) / 256;
    for (uint32_t i = 0; i < 4; ++i) {
        batch.coord[0][i] = (i & 1 ? d : 0) + (i & 2 ? d : 0);
        batch.coord[1][i] = (i & 1 ? d : 0) - (i & 2 ? d : 0);
    }
    batch.request.lodMode = LodMode::implicitLod;
    batch.request.lod = nullptr;
    batch.run(selectQueryLod(view, kTrilinear, bestIsa()), view, kTrilinear);
    EXPECT_NEAR(batch.out[1][0], 1.0, 1e-6);
}

// L04: half-integers go to the more detailed level, all of them.
TEST(Lod, HalfIntegersChooseByThePreferredRule) {
    for (int k = 0; k < 8; ++k) {
        EXPECT_EQ(query(kNearestLevel, 1, 0, static_cast<float>(k) + 0.5f).level, k) << k;
        EXPECT_EQ(query(kNearestLevel, 1, 0, static_cast<float>(k) + 0.50001f).level, k + 1);
        EXPECT_EQ(query(kNearestLevel, 1, 0, static_cast<float>(k) + 0.49999f).level, k);
    }
}

// L05: lambda <= 0 magnifies.
TEST(Lod, MagnificationUpToZero) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT, 2, 1, 1, 1, 1);
    image.set(0, 1, 0, 0, {.float32 = {1.0f}});
    SamplerState sampler = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    sampler.magFilter = VK_FILTER_NEAREST;
    const TextureView view = image.view(bestIsa());
    Batch batch(16);
    for (uint32_t i = 0; i < 16; ++i) {
        batch.coord[0][i] = 0.45f;
        batch.lod[i] = i % 4 == 0 ? 0.0f : i % 4 == 1 ? -1.0f : i % 4 == 2 ? 1e-6f : 3.0f;
    }
    batch.run(selectSampler(view, sampler, bestIsa()), view, sampler);
    for (uint32_t i = 0; i < 16; ++i) {
        if (i % 4 < 2)
            EXPECT_EQ(batch.out[0][i], 0.0f);
        else
            EXPECT_NEAR(batch.out[0][i], 0.4f, 1e-6);
    }
}

// L07, L08: no derivative, and absurd ones.
TEST(Lod, ExtremeDerivatives) {
    EXPECT_EQ(query(kTrilinear, 0, 0).level, 0);
    for (const bool gradients : {false, true}) {
        EXPECT_EQ(query(kTrilinear, 0x1p100f, 0, 0, gradients).level, 8);
        EXPECT_EQ(query(kTrilinear, 0x1p-100f, 0, 0, gradients).level, 0);
        for (const float x : {kInf, -kInf, kNaN}) {
            const LodResult r = query(kTrilinear, x, 0, 0, gradients);
            EXPECT_TRUE(r.level >= 0 && r.level <= 8) << x;
            EXPECT_FALSE(std::isnan(r.lambda));
        }
    }
    SamplerState limited = kTrilinear;
    limited.minLod = 2.25f;
    limited.maxLod = 3.5f;
    EXPECT_EQ(query(limited, 0, 0).level, 2.25);
    EXPECT_EQ(query(limited, 0x1p100f, 0).level, 3.5);
}

// L09: biases add up and are clamped; an inverted range stays in bounds.
TEST(Lod, BiasAndClamp) {
    SamplerState sampler = kTrilinear;
    sampler.mipLodBias = 1.5f;
    EXPECT_EQ(query(sampler, 1, 0, 2.0f).lambda, 3.5);
    EXPECT_EQ(query(sampler, 1, 0, 1000.0f).lambda, kMaxSamplerLodBias);
    EXPECT_EQ(query(sampler, 1, 0, -1000.0f).lambda, -kMaxSamplerLodBias);
    sampler.minLod = 5;
    sampler.maxLod = 2;
    const LodResult r = query(sampler, 1, 0);
    EXPECT_TRUE(r.level >= 0 && r.level <= 8);
    sampler.minLod = kNaN;
    EXPECT_LE(query(sampler, 1, 0).level, 8);
}

// L11: what the query says is what sampling does; lanes with different levels in one vector.
TEST(Lod, QueryAgreesWithSampling) {
    const Image image = levelsImage(256, 9);
    for (const SamplerState& sampler : {kTrilinear, kNearestLevel}) {
        for (const Isa isa : availableIsas()) {
            const TextureView view = image.view(isa);
            Batch batch(128);
            for (uint32_t q = 0; q < 32; ++q) {
                const float d = std::exp2(static_cast<float>(q) * 0.3f) / 256;
                for (uint32_t i = 0; i < 4; ++i) batch.coord[0][4 * q + i] = 0.3f + (i & 1 ? d : 0);
            }
            batch.request.lodMode = LodMode::implicitLod;
            batch.request.lod = nullptr;
            batch.run(selectQueryLod(view, sampler, isa), view, sampler);
            const std::vector<float> levels = batch.out[0];
            batch.run(selectSampler(view, sampler, isa), view, sampler);
            for (uint32_t i = 0; i < 128; ++i) EXPECT_NEAR(batch.out[0][i], levels[i], 1e-5) << i;
            EXPECT_GT(levels[127], 7.9f);
        }
    }
}

// Each quad has its own derivatives, in vectors of any width.
TEST(Lod, QuadsAreIndependent) {
    const Image image = levelsImage(64, 7);
    for (const Isa isa : availableIsas()) {
        const TextureView view = image.view(isa);
        Batch batch(28);
        for (uint32_t q = 0; q < 7; ++q) {
            const float d = std::ldexp(1.0f, static_cast<int>(q)) / 64;
            for (uint32_t i = 0; i < 4; ++i) batch.coord[1][4 * q + i] = i & 2 ? d : 0.0f;
        }
        batch.request.lodMode = LodMode::implicitLod;
        batch.request.lod = nullptr;
        batch.run(selectSampler(view, kNearestLevel, isa), view, kNearestLevel);
        for (uint32_t i = 0; i < 28; ++i) EXPECT_EQ(batch.out[0][i], static_cast<float>(i / 4)) << isaName(isa);
    }
}

// L13: across a cube's edge the level does not jump: a quad astride +X and +Z sees about the same lambda as
// one beside it.
TEST(Lod, CubeDerivativesUseOneFacePerLane) {
    const Image image = levelsImage(64, 7, VK_IMAGE_VIEW_TYPE_CUBE);
    const TextureView view = image.view(bestIsa());
    Batch batch(8);
    for (uint32_t q = 0; q < 2; ++q) {
        for (uint32_t i = 0; i < 4; ++i) {
            const double angle = (q == 0 ? 0.70 : 0.76) + (i & 1 ? 0.06 : 0);  // the edge is at 0.785
            batch.coord[0][4 * q + i] = static_cast<float>(std::sin(angle));
            batch.coord[1][4 * q + i] = i & 2 ? 0.03f : 0.0f;
            batch.coord[2][4 * q + i] = static_cast<float>(std::cos(angle));
        }
    }
    batch.request.lodMode = LodMode::implicitLod;
    batch.request.lod = nullptr;
    batch.run(selectQueryLod(view, kTrilinear, bestIsa()), view, kTrilinear);
    for (uint32_t i = 1; i < 8; ++i) EXPECT_NEAR(batch.out[1][i], batch.out[1][0], 0.4);
    EXPECT_NEAR(batch.out[1][0], std::log2(0.06 * 64 / 2 * 1.7), 0.3);
}

}  // namespace
}  // namespace vernier::texture_test
