// Texel fetches, gathers, queries and refusals.
#include <cstring>

#include "tests/texture/model.h"

namespace vernier::texture_test {
namespace {

struct Fetched {
    std::array<std::vector<float>, 4> out;
};

Fetched fetch(const TextureView& view, const std::array<std::vector<int32_t>, 4>& coord,
              const std::vector<int32_t>& lod, const std::vector<int32_t>& sample = {},
              std::array<int32_t, 3> offset = {}) {
    Fetched result;
    FetchRequest request;
    request.lanes = static_cast<uint32_t>(lod.size());
    for (int i = 0; i < 4; ++i) {
        result.out[i].assign(lod.size(), -1);
        request.out[i] = result.out[i].data();
        request.coord[i] = coord[i].empty() ? nullptr : coord[i].data();
    }
    for (int i = 0; i < 3; ++i) request.offset[i] = offset[i];
    request.lod = lod.data();
    request.sample = sample.empty() ? nullptr : sample.data();
    selectFetch(view, bestIsa())(view, request);
    return result;
}

TEST(Fetch, ReadsTexelsOfAllLevelsAndLayers) {
    Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_R16G16_SFLOAT, 6, 5, 1, 3, 3);
    image.randomize(31);
    const TextureView view = image.view(bestIsa());
    for (int32_t level = 0; level < 3; ++level) {
        for (int32_t layer = 0; layer < 3; ++layer) {
            const auto w = static_cast<int32_t>(view.levels[level].width),
                       h = static_cast<int32_t>(view.levels[level].height);
            for (int32_t y = 0; y < h; ++y) {
                for (int32_t x = 0; x < w; ++x) {
                    const Fetched f = fetch(view, {{{x, x, x, x}, {y, y, y, y}, {}, {layer, layer, layer, layer}}},
                                            {level, level, level, level});
                    const VkClearColorValue texel = unpackTexel(image.info().color, image.texel(level, x, y, layer));
                    for (int c = 0; c < 4; ++c) ASSERT_EQ(f.out[c][2], texel.float32[c]);
                }
            }
        }
    }
}

// T21: outside in any coordinate, level or sample: zero, with alpha 1 where the format has none.
TEST(Fetch, OutsideGivesZero) {
    const int32_t far = std::numeric_limits<int32_t>::max(), negative = std::numeric_limits<int32_t>::min();
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8_UNORM, VK_FORMAT_R32G32B32A32_UINT}) {
        Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, format, 4, 4, 1, 2, 2);
        image.setAll({.uint32 = {0x3f800000u, 0x3f800000u, 0x3f800000u, 0x3f800000u}});
        const TextureView view = image.view(bestIsa());
        const std::vector<int32_t> x{4, -1, far, negative, 0, 0, 0, 0, 0, 0, 0, 0},
            y{0, 0, 0, 0, 4, -1, far, 0, 0, 0, 0, 0}, layer{0, 0, 0, 0, 0, 0, 0, 2, -1, far, 0, 0},
            lod{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, -1};
        const Fetched f = fetch(view, {{x, y, {}, layer}}, lod);
        const float one = format == VK_FORMAT_R8_UNORM ? 1.0f : 0.0f;
        for (size_t i = 0; i < lod.size(); ++i) {
            for (int c = 0; c < 3; ++c) EXPECT_EQ(f.out[c][i], 0.0f);
            EXPECT_EQ(f.out[3][i], one);
        }
        const Fetched moved =
            fetch(view, {{{3, 3, 3, 3}, {0, 0, 0, 0}, {}, {0, 0, 0, 0}}}, {0, 0, 0, 0}, {}, {1, 0, 0});
        EXPECT_EQ(moved.out[0][0], 0.0f);
    }
}

// Neighbours from left to right, inside and across the edges, between lanes that are anywhere.
TEST(Fetch, RowsOfTexels) {
    constexpr int32_t kWidth = 21, kHeight = 3;
    for (const VkFormat format :
         {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
        Image image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, format, kWidth, kHeight, 1, 2, 1);
        image.randomize(7);
        const TextureView view = image.view(bestIsa());
        for (int32_t first = -9; first < kWidth + 2; ++first)
            for (int32_t y = -1; y <= kHeight; ++y)
                for (int32_t shift = 0; shift < 3; ++shift) {
                    std::array<std::vector<int32_t>, 4> coord;
                    for (int32_t lane = 0; lane < 28; ++lane) {
                        const bool apart = shift == 2 && lane % 9 == 5;  // in the midst of a row
                        coord[0].push_back(first + lane % 8 - shift);
                        coord[1].push_back(lane / 8 == 2 || apart ? 1 : y);
                        coord[2].push_back(0);
                        coord[3].push_back(lane / 8 == 1 && (lane == 9 || shift == 1) ? 1 : 0);
                    }
                    const std::vector<int32_t> lod(28, 0);
                    const Fetched f = fetch(view, coord, lod, {}, {shift, 0, 0});
                    for (size_t lane = 0; lane < lod.size(); ++lane) {
                        const int32_t x = coord[0][lane] + shift, row = coord[1][lane], layer = coord[3][lane];
                        const bool inside = x >= 0 && x < kWidth && row >= 0 && row < kHeight;
                        const VkClearColorValue texel =
                            inside ? unpackTexel(image.info().color, image.texel(0, x, row, layer))
                                   : VkClearColorValue{};
                        for (int c = 0; c < 4; ++c) ASSERT_EQ(f.out[c][lane], texel.float32[c]) << first << ' ' << lane;
                    }
                }
    }
}

TEST(Fetch, SamplesOfMultisampledImages) {
    // Four samples stored side by side in each texel.
    std::vector<float> data(3 * 2 * 4);
    for (size_t i = 0; i < data.size(); ++i) data[i] = static_cast<float>(i);
    TextureView view;
    view.format = VK_FORMAT_R32_SFLOAT;
    view.samples = 4;
    view.texelPitch = 16;
    view.samplePitch = 4;
    view.levels[0] = {reinterpret_cast<const std::byte*>(data.data()), 3, 2, 1, 48, 96};
    view.ops = formatOps(view.format, bestIsa());
    ASSERT_TRUE(checkView(view).ok());
    const Fetched f = fetch(view, {{{2, 2, 2, 2}, {1, 1, 1, 1}, {}, {}}}, {0, 0, 0, 0}, {0, 3, 4, -1});
    EXPECT_EQ(f.out[0], (std::vector<float>{20, 23, 0, 0}));
    EXPECT_FALSE(checkSampling(view, makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT)).ok());
}

TEST(Fetch, SwizzleMayRepeatComponents) {
    Image image(VK_IMAGE_VIEW_TYPE_1D, VK_FORMAT_R8G8B8A8_UINT, 2, 1, 1, 1, 1);
    image.set(0, 1, 0, 0, {.uint32 = {11, 22, 33, 44}});
    image.swizzle = {VK_COMPONENT_SWIZZLE_G, VK_COMPONENT_SWIZZLE_G, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_R};
    const TextureView view = image.view(bestIsa());
    const Fetched f = fetch(view, {{{1, 1, 1, 1}, {}, {}, {}}}, {0, 0, 0, 0});
    const uint32_t expected[4] = {22, 22, 1, 11};
    for (int c = 0; c < 4; ++c) EXPECT_EQ(std::bit_cast<uint32_t>(f.out[c][3]), expected[c]);
}

// T18: a gather returns the texels of the linear footprint, so filtering them by hand gives the linear
// sample.
TEST(Gather, IsTheLinearFootprint) {
    Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, 7, 5, 1, 1, 1);
    image.randomize(41);
    for (const Isa isa : availableIsas()) {
        const TextureView view = image.view(isa);
        for (const VkSamplerAddressMode mode : {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
                                                VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER}) {
            const SamplerState sampler = makeSampler(VK_FILTER_LINEAR, mode);
            std::mt19937 random(42);
            std::uniform_real_distribution<float> coordinate(-1, 2);
            Batch batch(100);
            for (uint32_t i = 0; i < batch.lanes; ++i) {
                batch.coord[0][i] = coordinate(random);
                batch.coord[1][i] = coordinate(random);
            }
            batch.request.lodMode = LodMode::base;
            batch.request.offset[0] = 2;
            batch.request.component = 1;
            batch.run(selectGather(view, sampler, isa), view, sampler);
            const std::array<std::vector<float>, 4> gathered = batch.out;
            batch.run(selectSampler(view, sampler, isa), view, sampler);
            for (uint32_t i = 0; i < batch.lanes; ++i) {
                const double u = batch.coord[0][i] * 7.0 - 0.5, v = batch.coord[1][i] * 5.0 - 0.5;
                const double a = u - std::floor(u), b = v - std::floor(v);
                const double top = gathered[3][i] * (1 - a) + gathered[2][i] * a,
                             bottom = gathered[0][i] * (1 - a) + gathered[1][i] * a;
                ASSERT_NEAR(batch.out[1][i], top * (1 - b) + bottom * b, 2e-5);
            }
        }
    }
}

TEST(Gather, ComparesAndSwizzles) {
    Image depth(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_D32_SFLOAT, 2, 2, 1, 1, 1, VK_IMAGE_ASPECT_DEPTH_BIT);
    depth.set(0, 0, 0, 0, {.float32 = {0.1f}});
    depth.set(0, 1, 0, 0, {.float32 = {0.2f}});
    depth.set(0, 0, 1, 0, {.float32 = {0.3f}});
    depth.set(0, 1, 1, 0, {.float32 = {0.4f}});
    SamplerState sampler = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    sampler.compareEnable = true;
    sampler.compareOp = VK_COMPARE_OP_LESS;
    const TextureView view = depth.view(bestIsa());
    Batch batch(4);
    for (uint32_t i = 0; i < 4; ++i) {
        batch.coord[0][i] = batch.coord[1][i] = 0.5f;
        batch.dref[i] = 0.25f;
    }
    batch.run(selectGather(view, sampler, bestIsa()), view, sampler);
    EXPECT_EQ(batch.out[0][0], 1.0f);  // (0,1)
    EXPECT_EQ(batch.out[1][0], 1.0f);  // (1,1)
    EXPECT_EQ(batch.out[2][0], 0.0f);  // (1,0)
    EXPECT_EQ(batch.out[3][0], 0.0f);  // (0,0)

    Image colour(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UINT, 2, 2, 1, 1, 1);
    colour.setAll({.uint32 = {1, 2, 3, 4}});
    colour.swizzle.g = VK_COMPONENT_SWIZZLE_A;
    colour.swizzle.b = VK_COMPONENT_SWIZZLE_ONE;
    const TextureView colourView = colour.view(bestIsa());
    const SamplerState plain = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    for (const auto& [component, expected] :
         {std::pair(0u, 1u), std::pair(1u, 4u), std::pair(2u, 1u), std::pair(3u, 4u)}) {
        batch.request.component = component;
        batch.run(selectGather(colourView, plain, bestIsa()), colourView, plain);
        EXPECT_EQ(std::bit_cast<uint32_t>(batch.out[3][2]), expected) << component;
    }
}

TEST(Query, Sizes) {
    using Size = std::array<uint32_t, 4>;
    const Isa isa = bestIsa();
    EXPECT_EQ(querySize(Image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8_UNORM, 5, 3, 1, 1, 3).view(isa), 1),
              (Size{2, 1, 0, 0}));
    EXPECT_EQ(querySize(Image(VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_R8_UNORM, 5, 3, 1, 7, 3).view(isa), 0),
              (Size{5, 3, 7, 0}));
    EXPECT_EQ(querySize(Image(VK_IMAGE_VIEW_TYPE_1D_ARRAY, VK_FORMAT_R8_UNORM, 5, 1, 1, 7, 1).view(isa), 0),
              (Size{5, 7, 0, 0}));
    EXPECT_EQ(querySize(Image(VK_IMAGE_VIEW_TYPE_3D, VK_FORMAT_R8_UNORM, 5, 4, 3, 1, 2).view(isa), 1),
              (Size{2, 2, 1, 0}));
    EXPECT_EQ(querySize(Image(VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, VK_FORMAT_R8_UNORM, 4, 4, 1, 12, 1).view(isa), 0),
              (Size{4, 4, 2, 0}));
    EXPECT_EQ(querySize(Image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8_UNORM, 5, 3, 1, 1, 1).view(isa), 1), (Size{}));
}

// Each refusal names the object, the field and the value.
TEST(Checks, RefuseWithAReason) {
    const Image image(VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, 4, 4, 1, 1, 1);
    const SamplerState good = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    const auto refused = [&](auto change, const char* field) {
        TextureView view = image.view(bestIsa());
        SamplerState sampler = good;
        change(view, sampler);
        const Status status = checkSampling(view, sampler);
        ASSERT_FALSE(status.ok()) << field;
        EXPECT_NE(status.error().message.find(field), std::string::npos) << status.error().message;
    };
    EXPECT_TRUE(checkSampling(image.view(bestIsa()), good).ok());
    refused([](TextureView& v, SamplerState&) { v.format = VK_FORMAT_G8B8G8R8_422_UNORM; }, "TextureView.format");
    refused([](TextureView& v, SamplerState&) { v.format = VK_FORMAT_R16G16B16_SFLOAT; }, "R16G16B16_SFLOAT");
    refused([](TextureView& v, SamplerState&) { v.aspect = VK_IMAGE_ASPECT_DEPTH_BIT; }, "aspect");
    refused([](TextureView& v, SamplerState&) { v.levelCount = 17; }, "levelCount is 17");
    refused([](TextureView& v, SamplerState&) { v.layerCount = 0; }, "layerCount is 0");
    refused([](TextureView& v, SamplerState&) { v.levels[0].data = nullptr; }, "levels[0].data");
    refused([](TextureView& v, SamplerState&) { v.levels[0].width = 40000; }, "width is 40000");
    refused([](TextureView& v, SamplerState&) { v.levels[0].rowPitch = 12; }, "rowPitch is 12");
    refused(
        [](TextureView& v, SamplerState&) {
            v.layerCount = 2;
            v.levels[0].slicePitch = 8;
        },
        "slicePitch is 8");
    refused([](TextureView& v, SamplerState&) { v.type = VK_IMAGE_VIEW_TYPE_CUBE; }, "layerCount");
    refused([](TextureView&, SamplerState& s) { s.magFilter = static_cast<VkFilter>(2); }, "Filter");
    refused([](TextureView&, SamplerState& s) { s.compareEnable = true; }, "compareEnable");
    refused(
        [](TextureView&, SamplerState& s) {
            s.unnormalizedCoordinates = true;
            s.minFilter = VK_FILTER_NEAREST;
        },
        "unnormalizedCoordinates");
}

}  // namespace
}  // namespace vernier::texture_test
