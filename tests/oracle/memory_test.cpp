// What shaders store and what transfers move in the whole-scene oracle: answers known by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "conformance/oracle/texture_unit.h"
#include "conformance/oracle/transfers.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"
#include "tests/oracle/small_scene.h"

namespace vernier::conformance {
namespace {

using namespace small_scene;
using exact::ImageStore;

constexpr VkExtent3D kFour{4, 4, 4};

std::vector<OracleImage> answer(const Scene& scene) {
    auto images = renderOracle(scene);
    EXPECT_TRUE(images.ok()) << (images.ok() ? "" : images.error().message);
    return images ? std::move(images).value() : std::vector<OracleImage>{};
}

/// A red triangle or two whose fragments store 1 at their own place in an image of 16 x 16 numbers, which is output 1.
Scene storing(const std::vector<Vertex>& vertices, std::string_view place = "ivec2(gl_FragCoord.xy)") {
    SceneRecorder record("stores", "");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
    const uint32_t numbers = record.storageImage("numbers", VK_FORMAT_R32_UINT, kExtent, Bytes(16 * 16 * 4));
    const uint32_t buffer = record.vertexBuffer("vertices", vertices);
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(kVertex), record.fragment(R"(#version 450
layout(binding = 0, r32ui) writeonly uniform uimage2D numbers;
layout(location = 1) flat in vec4 flatColor;
layout(location = 0) out vec4 color;
void main() {
    imageStore(numbers, )" + std::string(place) + R"(, uvec4(flatColor.r == 1.0 ? 1u : 2u));
    color = flatColor;
}
)"))
                                  .binding(sizeof(Vertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 16);
    record.pass(kExtent).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(buffer).storageImage(0, numbers);
    record.output(target);
    record.output(numbers);
    auto scene = record.finish();
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    return *scene;
}

TEST(Stores, ByCoveredFragmentsAlone) {
    const OracleImage image = answer(storing(leftOf(8.501f)))[1];
    EXPECT_EQ(at(image, 7, 5).value[0], 1);
    EXPECT_EQ(at(image, 7, 5).low[0], 1);
    EXPECT_EQ(at(image, 9, 5).high[0], 0) << "neighbours in the quad are helpers";
    EXPECT_EQ(at(image, 8, 5).low[0], 0) << "snapping decides whether the fragment is there";
    EXPECT_EQ(at(image, 8, 5).high[0], 1);
    EXPECT_NE(at(image, 8, 5).flags & kOracleSnap, 0);
}

TEST(Stores, OutsideDoNothing) {
    const OracleImage image = answer(storing(leftOf(20), "ivec2(gl_FragCoord.xy) - 16"))[1];
    for (const OraclePixel& pixel : image.pixels) EXPECT_EQ(pixel.high[0], 0);
}

TEST(Stores, OfSeveralFragmentsInAnyOrder) {
    std::vector<Vertex> vertices = leftOf(20);
    for (const Vertex& v : leftOf(4, kGreen)) vertices.push_back(v);
    const OracleImage image = answer(storing(vertices))[1];
    EXPECT_EQ(at(image, 8, 8).high[0], 1);
    EXPECT_EQ(at(image, 1, 8).low[0], 1);
    EXPECT_EQ(at(image, 1, 8).high[0], 2);
    EXPECT_NE(at(image, 1, 8).flags & kOracleSequence, 0);
}

TEST(Stores, OfTestedFragmentsAreRefused) {
    Scene scene = storing(leftOf(20));
    scene.pipelines[0].depthTest = true;
    const auto images = renderOracle(scene);
    ASSERT_FALSE(images.ok());
    EXPECT_EQ(images.error().code, ErrorCode::unsupported);
}

TEST(Stores, TheSceneWithStorageImages) {
    const auto scene = findScene("storage_images")->build();
    ASSERT_TRUE(scene.ok());
    const std::vector<OracleImage> images = answer(*scene);
    ASSERT_EQ(images.size(), 3u);
    const Bytes& source = scene->images[1].data[0];
    for (const auto& [x, y] : {std::pair{0u, 0u}, {127u, 3u}, {40u, 90u}}) {
        for (uint32_t c = 0; c < 4; ++c) {
            const double code = std::to_integer<int>(source[(y * 128 + x) * 4 + c]);
            EXPECT_EQ(at(images[1], 127 - x, y).value[c] * 255, code);
            EXPECT_EQ(at(images[1], 127 - x, y).low[c], at(images[1], 127 - x, y).high[c]);
        }
        EXPECT_EQ(at(images[2], x, y).value[0], x * 1000 + y);
        EXPECT_EQ(at(images[2], x, y).flags & kOracleUnknown, 0);
    }
}

TEST(Stores, TheSceneWithTexelBuffers) {
    const auto scene = findScene("texel_buffers")->build();
    ASSERT_TRUE(scene.ok());
    const std::vector<OracleImage> images = answer(*scene);
    const Bytes& bytes = scene->buffers[0].data;
    for (const auto& [x, y] : {std::pair{0u, 0u}, {127u, 3u}, {40u, 90u}}) {
        // Read transposed: what the fragment (y, x) stored.
        const double green = std::to_integer<int>(bytes[((x / 2) * 64 + y / 2) * 4 + 1]) / 255.0;
        EXPECT_NEAR(at(images[0], x, y).value[0], green * 0.5 + 0.25, 0.5 / 255 + 1e-9);
        EXPECT_EQ(at(images[0], x, y).value[1], 1) << "its size";
        EXPECT_EQ(at(images[0], x, y).flags & kOracleUnknown, 0);
    }
}

ImageStore volume(const std::vector<int>& codes, VkExtent3D extent, uint32_t mips = 1) {
    SceneImage image;
    image.format = VK_FORMAT_R8_UNORM;
    image.extent = {extent.width, extent.height};
    image.depth = extent.depth;
    image.mipLevels = mips;
    image.viewType = VK_IMAGE_VIEW_TYPE_3D;
    image.data.resize(mips);
    for (const int code : codes) image.data[0].push_back(static_cast<std::byte>(code));
    auto store = ImageStore::create(image);
    EXPECT_TRUE(store.ok()) << (store.ok() ? "" : store.error().message);
    return std::move(store).value();
}

std::vector<int> countingUp(size_t count) {
    std::vector<int> codes;
    for (size_t i = 0; i < count; ++i) codes.push_back(static_cast<int>(i));
    return codes;
}

TEST(Transfers, CopiesBetweenSlices) {
    std::vector<ImageStore> images{volume(countingUp(64), kFour), volume(std::vector<int>(64, 200), kFour)};
    SceneCopyImage copy{0, 1, {}};
    copy.region = {
        {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {1, 0, 2}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {0, 1, 0}, {2, 3, 2}};
    ASSERT_TRUE(exact::copyImage(copy, images).ok());
    EXPECT_EQ(images[1].level(0, 0).at(0, 1).channels[0].value * 255, 33);
    EXPECT_EQ(images[1].level(0, 1).at(1, 3).channels[0].value * 255, 58);
    EXPECT_EQ(images[1].level(0, 2).at(0, 1).channels[0].value * 255, 200);
    copy.region.dstOffset.z = 3;
    EXPECT_FALSE(exact::copyImage(copy, images).ok()) << "beyond the last slice";
}

TEST(Transfers, BlitsScaleDepth) {
    std::vector<ImageStore> images{volume({0, 100}, {1, 1, 2}), volume({9, 9, 9, 9}, {1, 1, 4})};
    SceneBlitImage blit{0, 1, {}, VK_FILTER_LINEAR};
    blit.region = {{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                   {{0, 0, 0}, {1, 1, 2}},
                   {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                   {{0, 0, 4}, {1, 1, 0}}};
    ASSERT_TRUE(exact::blitImage(blit, {}, images).ok());
    for (const auto& [slice, code] : {std::pair{0u, 100}, {1u, 75}, {2u, 25}, {3u, 0}})
        EXPECT_EQ(images[1].level(0, slice).at(0, 0).channels[0].value * 255, code) << slice;
}

TEST(Transfers, MipsOfVolumesAreAveragesOfEight) {
    ImageStore image = volume({0, 8, 16, 24, 32, 40, 48, 56}, {2, 2, 2}, 2);
    exact::generateMips(image);
    EXPECT_EQ(image.level(1, 0).at(0, 0).channels[0].value * 255, 28);
}

TEST(Levels, AskedOfVolumesAndCubes) {
    exact::SampleQuery query;
    query.ddx = {0, 0, 2.0 / 4};
    const auto deep = exact::queriedLevel(volume(countingUp(64), kFour), {}, query);
    ASSERT_TRUE(deep);
    EXPECT_EQ(deep->value, 1) << "two slices a pixel";
    EXPECT_LT(deep->low, 1);

    SceneImage faces;
    faces.format = VK_FORMAT_R8_UNORM;
    faces.extent = {64, 64};
    faces.arrayLayers = 6;
    faces.viewType = VK_IMAGE_VIEW_TYPE_CUBE;
    const auto cube = ImageStore::create(faces);
    ASSERT_TRUE(cube.ok());
    query.s = 0.1;
    query.t = 0.2;
    query.r = 2;
    // s = (x / z + 1) / 2: four texels a pixel are a change of x by z / 8.
    query.ddx = {0.25, 0, 0};
    const auto flat = exact::queriedLevel(*cube, {}, query);
    ASSERT_TRUE(flat);
    EXPECT_NEAR(flat->value, 2, 1e-12);
    query.s = query.t = query.r = 0;
    EXPECT_FALSE(exact::queriedLevel(*cube, {}, query)) << "no direction";
}

}  // namespace
}  // namespace vernier::conformance
