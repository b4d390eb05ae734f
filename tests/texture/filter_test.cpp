// Sampling of every kind of image and format against the model, on every instruction set.
#include <cstring>

#include "tests/texture/model.h"

namespace vernier::texture_test {
namespace {

constexpr VkSamplerAddressMode kAllModes[] = {
    VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
    VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE};

struct FilterSetup {
    VkFilter mag, min;
    VkSamplerMipmapMode mipmap;
};

constexpr FilterSetup kFilters[] = {
    {VK_FILTER_NEAREST, VK_FILTER_NEAREST, VK_SAMPLER_MIPMAP_MODE_NEAREST},
    {VK_FILTER_LINEAR, VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_NEAREST},
    {VK_FILTER_LINEAR, VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR},
    {VK_FILTER_NEAREST, VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR},
    {VK_FILTER_LINEAR, VK_FILTER_NEAREST, VK_SAMPLER_MIPMAP_MODE_NEAREST},
};

void fillRandom(Batch& batch, uint32_t seed, float low, float high, float layers, float lodLow, float lodHigh) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> coordinate(low, high), layer(-1, layers + 1), lod(lodLow, lodHigh),
        unit(-0.1f, 1.1f);
    for (uint32_t i = 0; i < batch.lanes; ++i) {
        for (int a = 0; a < 3; ++a) batch.coord[a][i] = coordinate(random);
        batch.coord[3][i] = layer(random);
        batch.lod[i] = lod(random);
        batch.dref[i] = unit(random);
    }
}

Point pointOf(const Batch& batch, uint32_t i) {
    return {batch.coord[0][i],
            batch.coord[1][i],
            batch.coord[2][i],
            batch.coord[3][i],
            batch.dref[i],
            batch.lod[i],
            {batch.request.offset[0], batch.request.offset[1], batch.request.offset[2]}};
}

/// Runs the batch on every instruction set; all must agree to the bit, and with the model within `tolerance`.
void check(const Image& image, const SamplerState& sampler, Batch& batch, double tolerance, const std::string& what) {
    std::array<std::vector<float>, 4> reference;
    int compared = 0;
    for (const Isa isa : availableIsas()) {
        const TextureView view = image.view(isa);
        const Status status = checkSampling(view, sampler);
        ASSERT_TRUE(status.ok()) << what << ": " << status.error().message;
        batch.run(selectSampler(view, sampler, isa), view, sampler);
        const int outputs = sampler.compareEnable ? 1 : 4;
        if (isa == availableIsas().front()) {
            reference = batch.out;
        } else {
            for (int c = 0; c < outputs; ++c) {
                ASSERT_EQ(0, std::memcmp(reference[c].data(), batch.out[c].data(), batch.lanes * sizeof(float)))
                    << what << " differs between " << isaName(isa) << " and sse4 in component " << c;
            }
            continue;
        }
        for (uint32_t i = 0; i < batch.lanes; ++i) {
            const Point at = pointOf(batch, i);
            if (distanceToJump(view, sampler, at) < 1e-3) continue;
            ++compared;
            const Rgba expected = modelSample(view, sampler, at), actual = batch.result(view, i);
            for (int c = 0; c < outputs; ++c) {
                ASSERT_NEAR(actual[c], expected[c], tolerance)
                    << what << " lane " << i << " component " << c << " at (" << at.s << ", " << at.t << ", " << at.r
                    << ", " << at.layer << ") lod " << at.lambda;
            }
        }
    }
    EXPECT_GT(compared, static_cast<int>(batch.lanes) / 2) << what;
}

struct FormatCase {
    VkFormat format;
    double tolerance;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

constexpr FormatCase kFormats[] = {
    {VK_FORMAT_R8G8B8A8_UNORM, 2e-5},
    {VK_FORMAT_B8G8R8A8_UNORM, 2e-5},
    {VK_FORMAT_R8G8B8A8_SRGB, 2e-5},
    {VK_FORMAT_B8G8R8A8_SRGB, 2e-5},
    {VK_FORMAT_R8_UNORM, 2e-5},
    {VK_FORMAT_R8G8_SNORM, 4e-5},
    {VK_FORMAT_R5G6B5_UNORM_PACK16, 2e-5},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, 2e-5},
    {VK_FORMAT_R16G16B16A16_SFLOAT, 1e-4},
    {VK_FORMAT_R32_SFLOAT, 1e-4},
    {VK_FORMAT_R32G32B32A32_SFLOAT, 1e-4},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, 1e-4},
    {VK_FORMAT_D16_UNORM, 2e-5, VK_IMAGE_ASPECT_DEPTH_BIT},
    {VK_FORMAT_D24_UNORM_S8_UINT, 2e-5, VK_IMAGE_ASPECT_DEPTH_BIT},
    {VK_FORMAT_D32_SFLOAT_S8_UINT, 2e-5, VK_IMAGE_ASPECT_DEPTH_BIT},
};

std::string describe(const FormatInfo& info, VkSamplerAddressMode mode, const FilterSetup& filter) {
    return std::string(info.name) + " mode " + std::to_string(mode) + " mag " + std::to_string(filter.mag) + " min " +
           std::to_string(filter.min) + " mip " + std::to_string(filter.mipmap);
}

TEST(Filter, TwoDimensionalArraysOfAllFormats) {
    uint32_t seed = 0;
    for (const FormatCase& f : kFormats) {
        Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, f.format, 21, 16, 1, 3, 5, f.aspect);
        image.randomize(++seed);
        for (const VkSamplerAddressMode mode : kAllModes) {
            for (const FilterSetup& filter : kFilters) {
                SamplerState sampler = makeSampler(filter.min, mode, filter.mipmap);
                sampler.magFilter = filter.mag;
                sampler.borderColor = {.float32 = {1, 1, 1, 1}};
                Batch batch(124);
                fillRandom(batch, ++seed, -2.5f, 3.5f, 2, -1.0f, 6.0f);
                check(image, sampler, batch, f.tolerance, describe(image.info(), mode, filter));
            }
        }
    }
}

TEST(Filter, OneDimensionalAndVolumesAndMixedModes) {
    uint32_t seed = 1000;
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16_SFLOAT}) {
        for (const VkSamplerAddressMode mode : kAllModes) {
            for (const FilterSetup& filter : kFilters) {
                SamplerState sampler = makeSampler(filter.min, mode, filter.mipmap);
                sampler.magFilter = filter.mag;
                sampler.borderColor = {.float32 = {0, 0, 0, 1}};
                sampler.addressMode[1] = kAllModes[(static_cast<int>(mode) + 1) % 5];
                Batch batch(128);
                for (const auto& [type, w, h, d, layers] : {std::tuple(VK_IMAGE_VIEW_TYPE_1D, 13u, 1u, 1u, 1u),
                                                            std::tuple(VK_IMAGE_VIEW_TYPE_1D_ARRAY, 8u, 1u, 1u, 4u),
                                                            std::tuple(VK_IMAGE_VIEW_TYPE_2D, 7u, 9u, 1u, 1u),
                                                            std::tuple(VK_IMAGE_VIEW_TYPE_3D, 8u, 6u, 5u, 1u)}) {
                    Image image(type, format, w, h, d, layers, 3);
                    image.randomize(++seed);
                    fillRandom(batch, ++seed, -1.5f, 2.5f, static_cast<float>(layers), -1.0f, 4.0f);
                    check(image, sampler, batch, 1e-4,
                          describe(image.info(), mode, filter) + " view " + std::to_string(type));
                }
            }
        }
    }
}

TEST(Filter, IntegersAndStencilAreExact) {
    uint32_t seed = 2000;
    for (const FormatCase& f : {FormatCase{VK_FORMAT_R8G8B8A8_UINT, 0}, FormatCase{VK_FORMAT_R16G16_SINT, 0},
                                FormatCase{VK_FORMAT_R32G32B32A32_SINT, 0}, FormatCase{VK_FORMAT_R32_UINT, 0},
                                FormatCase{VK_FORMAT_D24_UNORM_S8_UINT, 0, VK_IMAGE_ASPECT_STENCIL_BIT},
                                FormatCase{VK_FORMAT_D32_SFLOAT_S8_UINT, 0, VK_IMAGE_ASPECT_STENCIL_BIT},
                                FormatCase{VK_FORMAT_S8_UINT, 0, VK_IMAGE_ASPECT_STENCIL_BIT}}) {
        Image image(VK_IMAGE_VIEW_TYPE_2D, f.format, 12, 10, 1, 1, 4, f.aspect);
        image.randomize(++seed);
        for (const VkSamplerAddressMode mode : kAllModes) {
            SamplerState sampler = makeSampler(VK_FILTER_NEAREST, mode);
            sampler.borderColor = {.uint32 = {1, 1, 1, 1}};
            Batch batch(64);
            fillRandom(batch, ++seed, -1.5f, 2.5f, 0, -1.0f, 5.0f);
            check(image, sampler, batch, 0, describe(image.info(), mode, kFilters[0]));
        }
        SamplerState linear = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
        EXPECT_FALSE(checkSampling(image.view(bestIsa()), linear).ok());
    }
}

TEST(Filter, Offsets) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, 6, 1, 1, 1, 1);
    image.randomize(5);
    for (const VkSamplerAddressMode mode : kAllModes) {
        for (const FilterSetup& filter : {kFilters[0], kFilters[1]}) {
            for (const int32_t offset : {-8, -1, 3, 7}) {
                const SamplerState sampler = makeSampler(filter.min, mode);
                Batch batch(64);
                fillRandom(batch, static_cast<uint32_t>(offset + 100), -1.5f, 2.5f, 0, 0, 0);
                batch.request.offset[0] = offset;
                batch.request.offset[1] = 0;
                check(image, sampler, batch, 2e-5, describe(image.info(), mode, filter));
            }
        }
    }
}

TEST(Filter, DepthComparison) {
    uint32_t seed = 3000;
    for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_X8_D24_UNORM_PACK32}) {
        Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, format, 16, 16, 1, 2, 3, VK_IMAGE_ASPECT_DEPTH_BIT);
        image.randomize(++seed);
        for (int op = VK_COMPARE_OP_NEVER; op <= VK_COMPARE_OP_ALWAYS; ++op) {
            for (const FilterSetup& filter : kFilters) {
                SamplerState sampler = makeSampler(filter.min, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, filter.mipmap);
                sampler.magFilter = filter.mag;
                sampler.borderColor = {.float32 = {1, 1, 1, 1}};
                sampler.compareEnable = true;
                sampler.compareOp = static_cast<VkCompareOp>(op);
                Batch batch(128);
                fillRandom(batch, ++seed, -0.2f, 1.2f, 1, -1, 3);
                check(image, sampler, batch, 1e-4, describe(image.info(), sampler.addressMode[0], filter));
            }
        }
    }
}

// T19: the comparison is exact, one float to either side of a stored value; fixed-point references are
// clamped.
TEST(Filter, DepthComparisonIsExact) {
    for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT}) {
        Image image(VK_IMAGE_VIEW_TYPE_2D, format, 1, 1, 1, 1, 1, VK_IMAGE_ASPECT_DEPTH_BIT);
        image.setAll({.float32 = {0.3f}});
        const float stored = unpackTexel(image.info().depth, image.texel(0, 0, 0, 0)).float32[0];
        SamplerState sampler = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
        sampler.compareEnable = true;
        sampler.compareOp = VK_COMPARE_OP_LESS;
        EXPECT_EQ(sampleOne(image, sampler, 0.1f, 0.7f, 0, 0, std::nextafter(stored, 0.0f))[0], 1);
        EXPECT_EQ(sampleOne(image, sampler, 0.1f, 0.7f, 0, 0, stored)[0], 0);
        EXPECT_EQ(sampleOne(image, sampler, 0.1f, 0.7f, 0, 0, std::nextafter(stored, 1.0f))[0], 0);
        image.setAll({.float32 = {1.0f}});
        sampler.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
        EXPECT_EQ(sampleOne(image, sampler, 0.1f, 0.7f, 0, 0, 1.5f)[0], format == VK_FORMAT_D16_UNORM ? 1 : 0);
    }
}

TEST(Filter, Swizzle) {
    for (const VkFormat format : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8_UNORM, VK_FORMAT_R32_UINT}) {
        Image image(VK_IMAGE_VIEW_TYPE_2D, format, 4, 4, 1, 1, 1);
        image.randomize(9);
        image.swizzle = {VK_COMPONENT_SWIZZLE_A, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_R,
                         VK_COMPONENT_SWIZZLE_ZERO};
        Batch batch(32);
        fillRandom(batch, 10, 0, 1, 0, 0, 0);
        check(image, makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT), batch, 1e-6, image.info().name);
    }
}

// T08: filtering equal texels gives that texel, bit for bit, at any weight and between levels.
TEST(Filter, ConstantTexturesStayConstant) {
    std::mt19937 random(11);
    const auto checkConstant = [&](VkImageViewType type, VkFormat format, const VkClearColorValue& value) {
        const bool cube = type == VK_IMAGE_VIEW_TYPE_CUBE;
        Image image(type, format, 4, 4, type == VK_IMAGE_VIEW_TYPE_3D ? 4 : 1, cube ? 6 : 1, 3);
        image.setAll(value);
        const VkClearColorValue stored = unpackTexel(image.info().color, image.texel(0, 0, 0, 0));
        const SamplerState sampler =
            makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_MIPMAP_MODE_LINEAR);
        Batch batch(32);
        for (const Isa isa : availableIsas()) {
            const TextureView view = image.view(isa);
            fillRandom(batch, static_cast<uint32_t>(random()), -1, 2, 0, -0.5f, 2.5f);
            batch.run(selectSampler(view, sampler, isa), view, sampler);
            for (uint32_t i = 0; i < batch.lanes; ++i) {
                for (int c = 0; c < 4; ++c) {
                    ASSERT_EQ(std::bit_cast<uint32_t>(batch.out[c][i]), stored.uint32[c])
                        << image.info().name << " " << type;
                }
            }
        }
    };
    for (int code = 0; code < 256; ++code) {
        const float x = static_cast<float>(code) / 255.0f;
        checkConstant(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {.float32 = {x, 1 - x, x, 1 - x}});
        checkConstant(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_SRGB, {.float32 = {x, 1 - x, x * x, 1 - x}});
        checkConstant(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R16G16B16A16_UNORM, {.float32 = {x, 1 - x, x * x, x * 0.37f}});
        if (code % 8 != 0) continue;
        checkConstant(VK_IMAGE_VIEW_TYPE_CUBE, VK_FORMAT_R8G8B8A8_UNORM, {.float32 = {x, 1 - x, x, 1 - x}});
        checkConstant(VK_IMAGE_VIEW_TYPE_CUBE, VK_FORMAT_R32G32B32A32_SFLOAT,
                      {.float32 = {x, -x, x * 1e30f, x * 1e-30f}});
        checkConstant(VK_IMAGE_VIEW_TYPE_3D, VK_FORMAT_R16_UNORM, {.float32 = {x, 0, 0, 1}});
    }
    checkConstant(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT, {.float32 = {kInf, 0, 0, 1}});
    checkConstant(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT,
                  {.float32 = {std::numeric_limits<float>::max(), 0, 0, 1}});
}

// T07: a filtered value lies between the smallest and the largest texel.
TEST(Filter, StaysWithinTheTexels) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, 2, 1, 1, 1, 1);
    std::mt19937 random(12);
    for (int round = 0; round < 200; ++round) {
        image.randomize(static_cast<uint32_t>(random()));
        const TextureView view = image.view(bestIsa());
        const SamplerState sampler = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
        Batch batch(128);
        fillRandom(batch, static_cast<uint32_t>(random()), 0, 1, 0, 0, 0);
        batch.run(selectSampler(view, sampler, bestIsa()), view, sampler);
        const VkClearColorValue a = unpackTexel(image.info().color, image.texel(0, 0, 0, 0));
        const VkClearColorValue b = unpackTexel(image.info().color, image.texel(0, 1, 0, 0));
        for (int c = 0; c < 4; ++c) {
            for (const float x : batch.out[c]) {
                ASSERT_GE(x, std::min(a.float32[c], b.float32[c]));
                ASSERT_LE(x, std::max(a.float32[c], b.float32[c]));
            }
        }
    }
}

// T12: texels of weight zero have no say; infinities do not turn into NaN.
TEST(Filter, InfinitiesAndNaNs) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT, 2, 1, 1, 1, 1);
    const SamplerState sampler = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    for (const float poison : {kInf, -kInf, kNaN}) {
        image.set(0, 0, 0, 0, {.float32 = {7.0f}});
        image.set(0, 1, 0, 0, {.float32 = {poison}});
        EXPECT_EQ(sampleOne(image, sampler, 0.25f, 0.5f)[0], 7.0);  // the centre of texel 0
    }
    image.set(0, 1, 0, 0, {.float32 = {-kInf}});
    EXPECT_EQ(sampleOne(image, sampler, 0.5f, 0.5f)[0], -kInf);
    image.set(0, 0, 0, 0, {.float32 = {3e38f}});
    image.set(0, 1, 0, 0, {.float32 = {-3e38f}});
    EXPECT_EQ(sampleOne(image, sampler, 0.5f, 0.5f)[0], 0.0);
}

// A NaN is unequal to whatever it is compared with, and neither the least nor the greatest of several texels.
TEST(Filter, NaNsOnEveryInstructionSet) {
    Image depth(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_D32_SFLOAT, 1, 1, 1, 1, 1, VK_IMAGE_ASPECT_DEPTH_BIT);
    depth.setAll({.float32 = {kNaN}});
    SamplerState compare = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    compare.compareEnable = true;
    Image row(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R32_SFLOAT, 2, 1, 1, 1, 1);
    SamplerState extreme = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    for (const Isa isa : availableIsas()) {
        for (uint32_t op = VK_COMPARE_OP_NEVER; op <= VK_COMPARE_OP_ALWAYS; ++op) {
            compare.compareOp = static_cast<VkCompareOp>(op);
            const bool passes = op == VK_COMPARE_OP_NOT_EQUAL || op == VK_COMPARE_OP_ALWAYS;
            EXPECT_EQ(sampleOne(depth, compare, 0.5f, 0.5f, 0, 0, 0.5f, isa)[0], passes ? 1 : 0)
                << isaName(isa) << ", operation " << op;
        }
        for (const auto mode : {VK_SAMPLER_REDUCTION_MODE_MIN, VK_SAMPLER_REDUCTION_MODE_MAX}) {
            extreme.reduction = mode;
            for (const uint32_t place : {0u, 1u}) {
                row.set(0, place, 0, 0, {.float32 = {kNaN}});
                row.set(0, 1 - place, 0, 0, {.float32 = {7.0f}});
                EXPECT_EQ(sampleOne(row, extreme, 0.5f, 0.5f, 0, 0, 0, isa)[0], 7.0) << isaName(isa) << ", " << place;
            }
        }
    }
}

TEST(Filter, InactiveLanesAndMissingOutputs) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, 4, 4, 1, 1, 1);
    image.randomize(3);
    const TextureView view = image.view(bestIsa());
    const SamplerState sampler = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    Batch batch(20);
    fillRandom(batch, 4, 0, 1, 0, 0, 0);
    for (uint32_t i = 0; i < 16; ++i) {
        batch.mask[i] = 0;
        batch.coord[0][i] = kNaN;
    }
    batch.request.out[2] = nullptr;
    batch.run(selectSampler(view, sampler, bestIsa()), view, sampler);
    EXPECT_EQ(batch.out[2][17], -12345.0f);
    const Rgba expected = modelSample(view, sampler, pointOf(batch, 17));
    EXPECT_NEAR(batch.out[0][17], expected[0], 2e-5);
    EXPECT_NEAR(batch.out[3][17], expected[3], 2e-5);
}

}  // namespace
}  // namespace vernier::texture_test
