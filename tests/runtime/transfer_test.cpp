// Copies, blits, resolves, clears on small images whose every texel is checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "runtime/transfer/region.h"
#include "runtime/transfer/transfer.h"

namespace vernier {
namespace {

struct BoundImage {
    std::unique_ptr<Memory> memory;
    Image image;
};

BoundImage makeImage(ImageInfo info) {
    Result<Image> image = Image::create(info);
    EXPECT_TRUE(image.ok());
    BoundImage bound{Memory::create({}, image->memorySize()).value(), std::move(image).value()};
    bound.image.bind(*bound.memory, 0);
    return bound;
}

struct BoundBuffer {
    std::unique_ptr<Memory> memory;
    Buffer buffer;
    uint8_t* bytes() { return reinterpret_cast<uint8_t*>(memory->data()); }
};

BoundBuffer makeBuffer(VkDeviceSize size) {
    BoundBuffer bound{Memory::create({}, size).value(), Buffer(size, 0)};
    bound.buffer.bind(*bound.memory, 0);
    return bound;
}

class Transfer : public testing::Test {
  protected:
    ThreadPool pool_{2};
    TransferContext context_{pool_, bestIsa()};

    uint32_t texel(const Image& image, uint32_t x, uint32_t y, uint32_t mip = 0, uint32_t z = 0, uint32_t sample = 0) {
        uint32_t value = 0;
        std::memcpy(&value, rowAddress(image, mip, y, z, sample) + x * image.format().bytesPerTexel,
                    std::min<size_t>(4, image.format().bytesPerTexel));
        return value;
    }
};

constexpr VkImageSubresourceLayers kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

TEST_F(Transfer, BufferToImageAndBackHonoursPitchesOffsetsAndLayers) {
    const BoundImage image = makeImage({.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {7, 5, 1}, .arrayLayers = 2});
    BoundBuffer from = makeBuffer(4096), to = makeBuffer(4096);
    std::iota(from.bytes(), from.bytes() + 4096, uint8_t{1});
    const VkBufferImageCopy region{16, 9, 4, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 2}, {2, 1, 0}, {4, 3, 1}};
    ASSERT_TRUE(checkBufferImageCopy(image.image, 4096, region).ok());
    copyBufferToImage(context_, from.buffer, image.image, region);
    EXPECT_EQ(texel(image.image, 0, 0), 0u);
    for (uint32_t layer = 0; layer < 2; ++layer)
        for (uint32_t y = 0; y < 3; ++y)
            for (uint32_t x = 0; x < 4; ++x) {
                uint32_t expected = 0;
                std::memcpy(&expected, from.bytes() + 16 + ((layer * 4 + y) * 9 + x) * 4, 4);
                ASSERT_EQ(texel(image.image, 2 + x, 1 + y, 0, layer), expected);
            }
    copyImageToBuffer(context_, image.image, to.buffer, region);
    for (uint32_t layer = 0; layer < 2; ++layer)
        for (uint32_t y = 0; y < 3; ++y) {
            const uint32_t offset = 16 + (layer * 4 + y) * 9 * 4;
            EXPECT_EQ(std::memcmp(from.bytes() + offset, to.bytes() + offset, 16), 0);
        }
    EXPECT_EQ(to.bytes()[16 + 16], 0) << "between the rows nothing is written";
}

TEST_F(Transfer, RegionsOutsideAreNamedAndTouchNothing) {
    const BoundImage image = makeImage({.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {4, 4, 1}});
    BoundBuffer buffer = makeBuffer(64);
    const struct {
        VkBufferImageCopy region;
        const char* message;
    } cases[] = {
        {{0, 0, 0, kColor, {0, 0, 0}, {5, 4, 1}}, "outside the image"},
        {{0, 0, 0, kColor, {-1, 0, 0}, {4, 4, 1}}, "outside the image"},
        {{0, 0, 0, kColor, {0, 0, 0}, {4, 0, 1}}, "outside the image"},
        {{4, 0, 0, kColor, {0, 0, 0}, {4, 4, 1}}, "more bytes from offset 4 on than the buffer's 64"},
        {{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 1, 0, 1}, {0, 0, 0}, {2, 2, 1}}, "mip level 1 of 1"},
        {{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 1}, {0, 0, 0}, {4, 4, 1}}, "outside the image"},
        {{0, 0, 0, {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1}, {0, 0, 0}, {4, 4, 1}}, "aspect mask 2"},
        {{0, 0xFFFFFFFF, 0xFFFFFFFF, kColor, {0, 0, 0}, {4, 4, 1}}, "more bytes from offset 0 on than the buffer's 64"},
    };
    for (const auto& item : cases) {
        const Status status = checkBufferImageCopy(image.image, 64, item.region);
        ASSERT_FALSE(status.ok());
        EXPECT_THAT(status.error().message, testing::HasSubstr(item.message));
        copyBufferToImage(context_, buffer.buffer, image.image, item.region);  // must not touch anything
        copyImageToBuffer(context_, image.image, buffer.buffer, item.region);
    }
}

TEST_F(Transfer, DepthAndStencilOfACombinedFormatAreCopiedApart) {
    for (const VkFormat format : {VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        const BoundImage image = makeImage({.format = format, .extent = {3, 2, 1}});
        clearDepthStencilImage(context_, image.image, {0.5f, 7},
                               {VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT, 0, 1, 0, 1});
        BoundBuffer stencil = makeBuffer(64), depth = makeBuffer(64);
        for (int i = 0; i < 6; ++i) stencil.bytes()[i] = static_cast<uint8_t>(100 + i);
        const VkBufferImageCopy stencilRegion{0, 0, 0, {VK_IMAGE_ASPECT_STENCIL_BIT, 0, 0, 1}, {0, 0, 0}, {3, 2, 1}};
        const VkBufferImageCopy depthRegion{0, 0, 0, {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1}, {0, 0, 0}, {3, 2, 1}};
        copyBufferToImage(context_, stencil.buffer, image.image, stencilRegion);
        std::memset(stencil.bytes(), 0, 64);
        copyImageToBuffer(context_, image.image, stencil.buffer, stencilRegion);
        copyImageToBuffer(context_, image.image, depth.buffer, depthRegion);
        for (int i = 0; i < 6; ++i) {
            EXPECT_EQ(stencil.bytes()[i], 100 + i);
            uint32_t bits = 0;
            std::memcpy(&bits, depth.bytes() + i * 4, 4);
            EXPECT_EQ(bits, format == VK_FORMAT_D24_UNORM_S8_UINT ? 0x800000u : 0x3F000000u) << "depth was left alone";
        }
    }
}

TEST_F(Transfer, ClearReachesOnlyItsRange) {
    const BoundImage image =
        makeImage({.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {300, 200, 1}, .mipLevels = 3, .arrayLayers = 3});
    clearColorImage(context_, image.image, {{1, 0, 0, 1}}, {VK_IMAGE_ASPECT_COLOR_BIT, 1, 1, 1, 2});
    EXPECT_EQ(texel(image.image, 10, 10, 0, 1), 0u);
    EXPECT_EQ(texel(image.image, 10, 10, 2, 1), 0u);
    EXPECT_EQ(texel(image.image, 10, 10, 1, 0), 0u);
    for (uint32_t layer = 1; layer < 3; ++layer)
        for (uint32_t y = 0; y < 100; ++y)
            for (uint32_t x = 0; x < 150; ++x) ASSERT_EQ(texel(image.image, x, y, 1, layer), 0xFF0000FFu);
}

TEST_F(Transfer, BlitNearestScalesAndMirrorsAndLinearHalves) {
    const BoundImage from = makeImage({.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {4, 2, 1}});
    for (uint32_t y = 0; y < 2; ++y)
        for (uint32_t x = 0; x < 4; ++x) {
            const uint32_t value = 0xFF000000u | (y * 4 + x) * 10;
            std::memcpy(rowAddress(from.image, 0, y, 0, 0) + x * 4, &value, 4);
        }
    const BoundImage big = makeImage({.format = VK_FORMAT_B8G8R8A8_UNORM, .extent = {8, 4, 1}});
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = kColor;
    blit.srcOffsets[0] = {4, 0, 0};
    blit.srcOffsets[1] = {0, 2, 1};
    blit.dstOffsets[1] = {8, 4, 1};
    blitImage(context_, from.image, big.image, blit, VK_FILTER_NEAREST);
    for (uint32_t y = 0; y < 4; ++y)
        for (uint32_t x = 0; x < 8; ++x)
            ASSERT_EQ(texel(big.image, x, y), 0xFF000000u | ((y / 2 * 4 + (3 - x / 2)) * 10) << 16);
    const BoundImage small = makeImage({.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {2, 1, 1}});
    blit.srcOffsets[0] = {0, 0, 0};
    blit.srcOffsets[1] = {4, 2, 1};
    blit.dstOffsets[1] = {2, 1, 1};
    blitImage(context_, from.image, small.image, blit, VK_FILTER_LINEAR);
    EXPECT_EQ(texel(small.image, 0, 0), 0xFF000000u | 25u);  // mean of 0, 10, 40, 50
    EXPECT_EQ(texel(small.image, 1, 0), 0xFF000000u | 45u);
}

TEST_F(Transfer, ResolveAveragesSamplesAndKeepsConstants) {
    const BoundImage from = makeImage({.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {5, 3, 1}, .samples = 4});
    const BoundImage to = makeImage({.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {5, 3, 1}});
    for (uint32_t sample = 0; sample < 4; ++sample)
        for (uint32_t y = 0; y < 3; ++y)
            for (uint32_t x = 0; x < 5; ++x) {
                const uint32_t value = 77u << 8 | sample * 20;
                std::memcpy(rowAddress(from.image, 0, y, 0, sample) + x * 4, &value, 4);
            }
    resolveImage(context_, from.image, to.image, {kColor, {0, 0, 0}, kColor, {0, 0, 0}, {5, 3, 1}});
    for (uint32_t y = 0; y < 3; ++y)
        for (uint32_t x = 0; x < 5; ++x) ASSERT_EQ(texel(to.image, x, y), 77u << 8 | 30u);
}

TEST_F(Transfer, BuffersCopyFillAndUpdateInsideTheirBounds) {
    BoundBuffer a = makeBuffer(40), b = makeBuffer(40);
    fillBuffer(context_, a.buffer, 8, VK_WHOLE_SIZE, 0x04030201);
    EXPECT_EQ(a.bytes()[7], 0);
    EXPECT_EQ(a.bytes()[8], 1);
    EXPECT_EQ(a.bytes()[39], 4);
    copyBuffer(context_, a.buffer, b.buffer, {8, 36, 100});
    EXPECT_EQ(b.bytes()[35], 0);
    EXPECT_EQ(b.bytes()[36], 1);
    const std::byte bytes[8]{std::byte{9}};
    updateBuffer(b.buffer, 39, bytes);
    EXPECT_EQ(b.bytes()[39], 9);
    updateBuffer(b.buffer, 400, bytes);
}

TEST(ImageDescription, EveryWrongFieldIsNamed) {
    const ImageInfo good{.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {4, 4, 1}};
    ASSERT_TRUE(Image::create(good).ok());
    const auto message = [&](auto change) {
        ImageInfo info = good;
        change(info);
        const Result<Image> result = Image::create(info);
        return result.ok() ? std::string("ok") : result.error().message;
    };
    using testing::HasSubstr;
    EXPECT_THAT(message([](ImageInfo& i) { i.extent.width = 0; }), HasSubstr("width is 0"));
    EXPECT_THAT(message([](ImageInfo& i) { i.extent.height = 16385; }), HasSubstr("height is 16385"));
    EXPECT_THAT(message([](ImageInfo& i) { i.mipLevels = 4; }), HasSubstr("mip levels is 4"));
    EXPECT_THAT(message([](ImageInfo& i) { i.arrayLayers = 0; }), HasSubstr("layers is 0"));
    EXPECT_THAT(message([](ImageInfo& i) { i.samples = 3; }), HasSubstr("sample count is 3"));
    EXPECT_THAT(message([](ImageInfo& i) { i.format = static_cast<VkFormat>(99999); }), HasSubstr("format 99999"));
}

}  // namespace
}  // namespace vernier
