// Images beyond the plain 2D one, by hand: cubes, volumes, minima and maxima, compressed blocks; resolves of depth and
// stencil; what Bresenham lines may differ by.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "conformance/oracle/block_decode.h"
#include "conformance/oracle/bresenham_check.h"
#include "conformance/oracle/cube.h"
#include "conformance/oracle/texture_unit.h"
#include "conformance/scenes/recorder.h"

namespace vernier::conformance::exact {
namespace {

ImageStore storeOf(VkImageViewType type, VkExtent2D extent, uint32_t depth, uint32_t layers, std::vector<Bytes> data) {
    SceneImage image;
    image.format = VK_FORMAT_R8_UNORM;
    image.extent = extent;
    image.depth = depth;
    image.arrayLayers = layers;
    image.viewType = type;
    image.data = std::move(data);
    auto store = ImageStore::create(image);
    EXPECT_TRUE(store.ok()) << (store.ok() ? "" : store.error().message);
    return std::move(store).value();
}

Bytes bytes(std::initializer_list<int> values) {
    Bytes result;
    for (const int value : values) result.push_back(static_cast<std::byte>(value));
    return result;
}

SceneSampler linear(VkSamplerReductionMode reduction = VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
    SceneSampler sampler;
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    sampler.reduction = reduction;
    return sampler;
}

Interval sampled(const ImageStore& image, const SceneSampler& sampler, std::array<double, 3> place) {
    SampleQuery query;
    query.s = place[0];
    query.t = place[1];
    query.r = place[2];
    query.lod = 0;
    return sampleImage(image, sampler, query).color[0];
}

TEST(Cube, NeighboursByHand) {
    // Right of +z lies +x, above it +y; x runs against z on +x, y along z on +y.
    const auto right = cubeTexel(4, 4, 1, 4), above = cubeTexel(4, 2, -1, 4), below = cubeTexel(4, 2, 4, 4);
    ASSERT_TRUE(right && above && below);
    EXPECT_EQ(right->face, 0u);
    EXPECT_EQ(right->x, 0);
    EXPECT_EQ(right->y, 1);
    EXPECT_EQ(above->face, 2u);
    EXPECT_EQ(above->x, 2);
    EXPECT_EQ(above->y, 3);
    EXPECT_EQ(below->face, 3u);
    EXPECT_EQ(below->y, 0);
    EXPECT_FALSE(cubeTexel(4, -1, -1, 4)) << "three faces meet there";
}

TEST(Cube, NeighboursAreMutual) {
    constexpr int64_t n = 3;
    for (uint32_t face = 0; face < 6; ++face) {
        for (int64_t at = 0; at < n; ++at) {
            for (const auto& [x, y] : {std::pair{int64_t{-1}, at}, {n, at}, {at, int64_t{-1}}, {at, n}}) {
                const auto there = cubeTexel(face, x, y, n);
                ASSERT_TRUE(there);
                EXPECT_NE(there->face, face);
                const int64_t ownX = std::clamp<int64_t>(x, 0, n - 1), ownY = std::clamp<int64_t>(y, 0, n - 1);
                int back = 0;
                for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                    const auto again = cubeTexel(there->face, there->x + dx, there->y + dy, n);
                    back += again && again->face == face && again->x == ownX && again->y == ownY;
                }
                EXPECT_EQ(back, 1) << face << ": " << x << ", " << y;
            }
        }
    }
}

TEST(Cube, TiesGoToZThenY) {
    const auto places = cubePlaces({1, -1, 1}, {}, {}, 0x1p-20);
    ASSERT_EQ(places.size(), 3u);
    EXPECT_EQ(places[0].face, 4u);
    EXPECT_EQ(places[1].face, 3u);
    EXPECT_EQ(places[2].face, 0u);
    EXPECT_EQ(places[0].s, 1);
    EXPECT_EQ(places[0].t, 1);
    EXPECT_EQ(cubePlaces({2, 1, 1}, {}, {}, 0x1p-20).size(), 1u);
    EXPECT_TRUE(cubePlaces({0, 0, 0}, {}, {}, 0x1p-20).empty());
}

TEST(Cube, EdgesMixTwoFacesAndCornersThree) {
    std::vector<Bytes> faces;
    for (int face = 0; face < 6; ++face) faces.push_back(Bytes(4, static_cast<std::byte>(face * 30)));
    const ImageStore cube = storeOf(VK_IMAGE_VIEW_TYPE_CUBE, {2, 2}, 1, 6, faces);
    EXPECT_NEAR(sampled(cube, linear(), {0.1, 0.2, 1}).value * 255, 120, 1e-9);
    EXPECT_NEAR(sampled(cube, linear(), {1, 0, 1}).value * 255, 60, 1e-9) << "+x and +z";
    const Interval corner = sampled(cube, linear(), {1, 1, 1});
    EXPECT_NEAR(corner.value * 255, 60, 1e-9) << "+x, +y and +z";
    // The fourth texel is any mixture of the three, with a quarter of the weight.
    EXPECT_NEAR(corner.low * 255, 45, 2);
    EXPECT_NEAR(corner.high * 255, 75, 2);
}

TEST(Volume, LinearFiltersMixSlices) {
    const ImageStore volume = storeOf(VK_IMAGE_VIEW_TYPE_3D, {2, 1}, 2, 1, {bytes({0, 80, 160, 240})});
    EXPECT_EQ(volume.depth(0), 2u);
    EXPECT_NEAR(sampled(volume, linear(), {0.25, 0.5, 0.25}).value * 255, 0, 1e-9);
    EXPECT_NEAR(sampled(volume, linear(), {0.75, 0.5, 0.75}).value * 255, 240, 1e-9);
    EXPECT_NEAR(sampled(volume, linear(), {0.5, 0.5, 0.5}).value * 255, 120, 1e-9);
    EXPECT_NEAR(sampled(volume, linear(), {0.25, 0.5, 0.5}).value * 255, 80, 1e-9);
    EXPECT_EQ(fetchImage(volume, 1, 0, 1, 0, 0).color[0].value * 255, 240);
    EXPECT_EQ(fetchImage(volume, 1, 0, 2, 0, 0).color[0].value, 0) << "no third slice";
}

TEST(Reduction, TakesTexelsThatHaveAWeight) {
    const ImageStore row = storeOf(VK_IMAGE_VIEW_TYPE_2D, {3, 1}, 1, 1, {bytes({200, 10, 90})});
    const auto at = [&](VkSamplerReductionMode mode, double texel) {
        return sampled(row, linear(mode), {texel / 3, 0.5, 0});
    };
    EXPECT_NEAR(at(VK_SAMPLER_REDUCTION_MODE_MIN, 0.75).value * 255, 10, 1e-9);
    EXPECT_NEAR(at(VK_SAMPLER_REDUCTION_MODE_MAX, 0.75).value * 255, 200, 1e-9);
    EXPECT_NEAR(at(VK_SAMPLER_REDUCTION_MODE_MAX, 2).value * 255, 90, 1e-9);
    // Exactly on a texel its neighbour may count, or not.
    const Interval centre = at(VK_SAMPLER_REDUCTION_MODE_MIN, 2.5);
    EXPECT_NEAR(centre.value * 255, 90, 1e-9);
    EXPECT_LE(centre.low * 255, 10 + 1e-9);
}

TEST(Blocks, ByHand) {
    // BC1: red and blue, all four indices in the first row; two thirds within the weights' slack.
    const Bytes bc1 = bytes({0x00, 0xf8, 0x1f, 0x00, 0xe4, 0, 0, 0});
    const auto texel = [&](uint32_t x) { return decodeBlockTexel(VK_FORMAT_BC1_RGB_UNORM_BLOCK, bc1, x, 0); };
    EXPECT_EQ(texel(0)[0].value, 1);
    EXPECT_EQ(texel(1)[2].value, 1);
    EXPECT_NEAR(texel(2)[0].value, 2.0 / 3, 1e-12);
    EXPECT_LT(texel(2)[0].low, 2.0 / 3 - 0.03);
    EXPECT_NEAR(texel(3)[2].value, 2.0 / 3, 1e-12);
    // Turned round, the order of the end points says three colours and transparent black.
    const Bytes turned = bytes({0x1f, 0x00, 0x00, 0xf8, 0xe4, 0, 0, 0});
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC1_RGBA_UNORM_BLOCK, turned, 3, 0)[3].value, 0);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC1_RGB_UNORM_BLOCK, turned, 3, 0)[3].value, 1);
    // BC4: six values between 255 and 0, then the ends in the other order.
    const Bytes bc4 = bytes({255, 0, 0x88, 0xc6, 0xfa, 0, 0, 0}), ends = bytes({0, 255, 0x88, 0xc6, 0xfa, 0, 0, 0});
    EXPECT_NEAR(decodeBlockTexel(VK_FORMAT_BC4_UNORM_BLOCK, bc4, 2, 0)[0].value, 6.0 / 7, 1e-12);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC4_UNORM_BLOCK, ends, 2, 1)[0].value, 0);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC4_UNORM_BLOCK, ends, 3, 1)[0].value, 1);
    // ETC2, individual colours 8 and 0, table 0: 136 + 2 in the left half; below 0 is clamped in the right one.
    const Bytes etc2 = bytes({0x80, 0x80, 0x80, 0, 0xff, 0, 0, 0});
    EXPECT_EQ(std::lround(decodeBlockTexel(VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, etc2, 0, 0)[1].value * 255), 138);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, etc2, 3, 0)[1].value, 0);
    // EAC: (base 128) * 8 + 4 + (-3) * 8 * 1 of 2047.
    const Bytes eac = bytes({128, 0x10, 0, 0, 0, 0, 0, 0});
    EXPECT_NEAR(decodeBlockTexel(VK_FORMAT_EAC_R11_UNORM_BLOCK, eac, 2, 2)[0].value, 1004.0 / 2047, 1e-12);
}

TEST(DepthResolve, ByItsMode) {
    const PixelFormat& format = *findPixelFormat(VK_FORMAT_D32_SFLOAT_S8_UINT);
    ImageLevel level{{1, 1}, 4, std::vector<StoredTexel>(4)};
    const double depths[] = {0.5, 0.25, 1, 0.75};
    for (size_t s = 0; s < 4; ++s) {
        level.texels[s].channels[0] = depths[s];
        level.texels[s].channels[1] = static_cast<double>(10 * s + 3);
    }
    const auto resolved = [&](VkResolveModeFlagBits depth, VkResolveModeFlagBits stencil) {
        const StoredTexel texel = resolveDepthStencil(format, level, 0, 0, depth, stencil);
        return std::pair(texel.channels[0].value, texel.channels[1].value);
    };
    EXPECT_EQ(resolved(VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_MAX_BIT), std::pair(0.5, 33.0));
    EXPECT_EQ(resolved(VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MIN_BIT), std::pair(0.25, 3.0));
    EXPECT_EQ(resolved(VK_RESOLVE_MODE_MAX_BIT, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT), std::pair(1.0, 3.0));
    EXPECT_EQ(resolved(VK_RESOLVE_MODE_AVERAGE_BIT, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT), std::pair(0.625, 3.0));
    EXPECT_TRUE(resolveDepthStencil(format, level, 0, 0, VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_MIN_BIT).flags &
                kOracleUnknown);
}

TEST(BresenhamCheck, FourConditions) {
    const std::vector<PixelIndex> rule{{0, 0}, {1, 0}, {2, 1}, {3, 1}};
    const auto said = [&](std::vector<PixelIndex> observed, size_t segments = 1) {
        return checkBresenham(rule, observed, true, segments);
    };
    EXPECT_EQ(said(rule), "");
    EXPECT_EQ(said({{0, 0}, {1, 1}, {2, 1}, {3, 1}}), "") << "one pixel beside";
    EXPECT_EQ(said({{0, 0}, {1, 0}, {2, 1}}), "") << "one fragment less";
    EXPECT_NE(said({{0, 0}, {1, 3}, {2, 1}, {3, 1}}).find("condition 1"), std::string::npos);
    EXPECT_NE(said({{0, 0}, {1, 0}}).find("condition 2"), std::string::npos);
    EXPECT_NE(said({{0, 0}, {1, 0}, {1, 1}, {3, 1}}).find("condition 3"), std::string::npos);
    EXPECT_NE(said({{0, 0}, {1, 0}, {3, 1}}, 2).find("condition 4"), std::string::npos);
}

}  // namespace
}  // namespace vernier::conformance::exact
