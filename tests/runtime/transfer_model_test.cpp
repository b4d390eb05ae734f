// Transfers on random images and regions against the plainest model there is: one texel at a time, every texel of the
// destination looked at, those that must not change too.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "runtime/transfer/transfer.h"

namespace vernier {
namespace {

using Random = std::mt19937;

uint32_t below(Random& random, uint32_t limit) {
    return static_cast<uint32_t>(random() % limit);
}

struct TestImage {
    std::unique_ptr<Memory> memory;
    Image image;

    TestImage(const ImageInfo& info, Random& random) : image(Image::create(info).value()) {
        memory = Memory::create({}, image.memorySize()).value();
        image.bind(*memory, 0);
        for (VkDeviceSize i = 0; i < image.memorySize(); ++i) memory->data()[i] = static_cast<std::byte>(random());
    }
    bool volume() const { return image.info().type == VK_IMAGE_TYPE_3D; }
    /// Slices or layers.
    uint32_t depth(uint32_t mip) const { return volume() ? image.level(mip).extent.depth : image.info().arrayLayers; }
    /// Where a texel lies; all texels of all subresources in one order.
    size_t place(uint32_t mip, uint32_t z, uint32_t y, uint32_t x) const {
        const std::byte* first = image.address(mip, volume() ? 0 : z, volume() ? z : 0, 0);
        return static_cast<size_t>(first - memory->data()) + y * image.level(mip).rowPitch +
               size_t{x} * image.format().bytesPerTexel;
    }
    std::vector<std::byte> bytes() const { return {memory->data(), memory->data() + image.memorySize()}; }
};

ImageInfo randomInfo(Random& random, VkFormat format, bool mips = true) {
    ImageInfo info{.format = format};
    switch (below(random, 4)) {
        case 0:
            info.type = VK_IMAGE_TYPE_1D;
            info.extent = {1 + below(random, 400), 1, 1};
            info.arrayLayers = 1 + below(random, 3);
            break;
        case 1:
            info.type = VK_IMAGE_TYPE_3D;
            info.extent = {1 + below(random, 40), 1 + below(random, 40), 1 + below(random, 9)};
            break;
        case 2:  // big enough for all threads
            info.extent = {300 + below(random, 60), 280 + below(random, 60), 1};
            break;
        default:
            info.extent = {1 + below(random, 50), 1 + below(random, 50), 1};
            info.arrayLayers = 1 + below(random, 4);
    }
    if (mips) info.mipLevels = 1 + below(random, 3);
    const uint32_t longest = std::max({info.extent.width, info.extent.height, info.extent.depth});
    while (info.mipLevels > 1 && longest >> (info.mipLevels - 1) == 0) --info.mipLevels;
    return info;
}

/// A box inside one level.
struct Box {
    uint32_t mip = 0, x = 0, y = 0, z = 0, width = 1, height = 1, depth = 1;

    static Box random(Random& random, const TestImage& in) {
        Box box;
        box.mip = below(random, in.image.info().mipLevels);
        const VkExtent3D& size = in.image.level(box.mip).extent;
        const auto span = [&](uint32_t limit, uint32_t& first, uint32_t& count) {
            first = below(random, limit);
            count = 1 + below(random, limit - first);
        };
        span(size.width, box.x, box.width);
        span(size.height, box.y, box.height);
        span(in.depth(box.mip), box.z, box.depth);
        return box;
    }
    VkImageSubresourceLayers layers(const TestImage& of) const {
        return {VK_IMAGE_ASPECT_COLOR_BIT, mip, of.volume() ? 0 : z, of.volume() ? 1 : depth};
    }
    VkOffset3D offset(const TestImage& of) const {
        return {static_cast<int32_t>(x), static_cast<int32_t>(y), of.volume() ? static_cast<int32_t>(z) : 0};
    }
};

class TransferModel : public testing::Test {
  protected:
    ThreadPool pool_{3};
    TransferContext context_{pool_, bestIsa()};
    Random random_{20240607};
};

TEST_F(TransferModel, ImageCopies) {
    // Formats of one texel size copy into one another bit by bit.
    constexpr std::array<std::array<VkFormat, 2>, 6> kPairs{{
        {VK_FORMAT_R8_UNORM, VK_FORMAT_R8_SINT},
        {VK_FORMAT_R16_SFLOAT, VK_FORMAT_R8G8_UINT},
        {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32_SFLOAT},
        {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32_UINT},
        {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_UINT},
        {VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_R16G16_SNORM},
    }};
    for (uint32_t round = 0; round < 120; ++round) {
        const auto& pair = kPairs[round % kPairs.size()];
        const TestImage source(randomInfo(random_, pair[0]), random_), target(randomInfo(random_, pair[1]), random_);
        Box from = Box::random(random_, source), to = Box::random(random_, target);
        // Slices stand for layers only between a volume and an array; 1D images have one row.
        from.width = to.width = std::min(from.width, to.width);
        from.height = to.height = std::min(from.height, to.height);
        from.depth = to.depth = std::min(from.depth, to.depth);
        const uint32_t slices = source.volume() || target.volume() ? from.depth : 1;
        const VkImageCopy region{from.layers(source),
                                 from.offset(source),
                                 to.layers(target),
                                 to.offset(target),
                                 {from.width, from.height, slices}};
        std::vector<std::byte> expected = target.bytes();
        const uint32_t bytes = target.image.format().bytesPerTexel;
        for (uint32_t z = 0; z < from.depth; ++z)
            for (uint32_t y = 0; y < from.height; ++y)
                for (uint32_t x = 0; x < from.width; ++x)
                    std::memcpy(expected.data() + target.place(to.mip, to.z + z, to.y + y, to.x + x),
                                source.memory->data() + source.place(from.mip, from.z + z, from.y + y, from.x + x),
                                bytes);
        copyImage(context_, source.image, target.image, region);
        ASSERT_TRUE(target.bytes() == expected) << "round " << round;
    }
}

TEST_F(TransferModel, BufferImageCopies) {
    constexpr std::array kFormats{VK_FORMAT_R8_UNORM, VK_FORMAT_R5G6B5_UNORM_PACK16, VK_FORMAT_R8G8B8A8_SRGB,
                                  VK_FORMAT_R16G16B16A16_SNORM, VK_FORMAT_R32G32B32A32_SFLOAT};
    for (uint32_t round = 0; round < 120; ++round) {
        const TestImage image(randomInfo(random_, kFormats[round % kFormats.size()]), random_);
        const Box box = Box::random(random_, image);
        const uint32_t bytes = image.image.format().bytesPerTexel;
        const uint32_t rowLength = below(random_, 2) ? 0 : box.width + below(random_, 5);
        const uint32_t imageHeight = below(random_, 2) ? 0 : box.height + below(random_, 5);
        const uint64_t offset = uint64_t{below(random_, 7)} * bytes;
        const uint64_t row = uint64_t{rowLength ? rowLength : box.width} * bytes;
        const uint64_t slice = (imageHeight ? imageHeight : box.height) * row;
        const uint64_t size = offset + slice * box.depth;
        const std::unique_ptr<Memory> memory = Memory::create({}, size).value();
        for (uint64_t i = 0; i < size; ++i) memory->data()[i] = static_cast<std::byte>(random_());
        Buffer buffer(size, 0);
        buffer.bind(*memory, 0);
        const VkBufferImageCopy region{offset,
                                       rowLength,
                                       imageHeight,
                                       box.layers(image),
                                       box.offset(image),
                                       {box.width, box.height, image.volume() ? box.depth : 1}};
        const bool toImage = below(random_, 2) != 0;
        std::vector<std::byte> texels = image.bytes(), data(memory->data(), memory->data() + size);
        for (uint32_t z = 0; z < box.depth; ++z)
            for (uint32_t y = 0; y < box.height; ++y)
                for (uint32_t x = 0; x < box.width; ++x) {
                    std::byte* there = data.data() + offset + z * slice + y * row + uint64_t{x} * bytes;
                    std::byte* here = texels.data() + image.place(box.mip, box.z + z, box.y + y, box.x + x);
                    toImage ? std::memcpy(here, there, bytes) : std::memcpy(there, here, bytes);
                }
        if (toImage)
            copyBufferToImage(context_, buffer, image.image, region);
        else
            copyImageToBuffer(context_, image.image, buffer, region);
        ASSERT_TRUE(image.bytes() == texels) << "round " << round;
        ASSERT_EQ(std::memcmp(data.data(), memory->data(), size), 0) << "round " << round;
    }
}

/// Where a destination texel of a blit comes from, along one axis.
double sourcePlace(uint32_t texel, const std::array<int32_t, 2>& from, const std::array<int32_t, 2>& to) {
    return (texel + 0.5 - to[0]) * (from[1] - from[0]) / (to[1] - to[0]) + from[0];
}

struct BlitCase {
    Box from, to;
    std::array<std::array<int32_t, 2>, 2> source, target;  // x and y, in the order of the offsets

    static BlitCase random(Random& random, const TestImage& source, const TestImage& target) {
        BlitCase blit{Box::random(random, source), Box::random(random, target), {}, {}};
        const auto span = [&](uint32_t first, uint32_t count) {
            std::array<int32_t, 2> ends{static_cast<int32_t>(first), static_cast<int32_t>(first + count)};
            if (below(random, 2)) std::swap(ends[0], ends[1]);
            return ends;
        };
        blit.source = {span(blit.from.x, blit.from.width), span(blit.from.y, blit.from.height)};
        blit.target = {span(blit.to.x, blit.to.width), span(blit.to.y, blit.to.height)};
        return blit;
    }
    VkImageBlit region() const {
        return {{VK_IMAGE_ASPECT_COLOR_BIT, from.mip, from.z, 1},
                {{source[0][0], source[1][0], 0}, {source[0][1], source[1][1], 1}},
                {VK_IMAGE_ASPECT_COLOR_BIT, to.mip, to.z, 1},
                {{target[0][0], target[1][0], 0}, {target[0][1], target[1][1], 1}}};
    }
};

ImageInfo flatInfo(Random& random, VkFormat format) {
    ImageInfo info = randomInfo(random, format);
    while (info.type != VK_IMAGE_TYPE_2D) info = randomInfo(random, format);
    return info;
}

TEST_F(TransferModel, NearestBlitsOfOneFormatMoveBits) {
    constexpr std::array kFormats{VK_FORMAT_R8_SNORM, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R8G8B8A8_UNORM,
                                  VK_FORMAT_R16G16B16A16_SNORM, VK_FORMAT_R32G32B32A32_UINT};
    for (uint32_t round = 0; round < 100; ++round) {
        const VkFormat format = kFormats[round % kFormats.size()];
        const TestImage source(flatInfo(random_, format), random_), target(flatInfo(random_, format), random_);
        const BlitCase blit = BlitCase::random(random_, source, target);
        std::vector<std::byte> expected = target.bytes();
        const VkExtent3D& limit = source.image.level(blit.from.mip).extent;
        for (uint32_t y = blit.to.y; y < blit.to.y + blit.to.height; ++y)
            for (uint32_t x = blit.to.x; x < blit.to.x + blit.to.width; ++x) {
                const auto texel = [](double place, uint32_t size) {
                    return static_cast<uint32_t>(std::clamp(std::floor(place), 0.0, size - 1.0));
                };
                const uint32_t sx = texel(sourcePlace(x, blit.source[0], blit.target[0]), limit.width);
                const uint32_t sy = texel(sourcePlace(y, blit.source[1], blit.target[1]), limit.height);
                std::memcpy(expected.data() + target.place(blit.to.mip, blit.to.z, y, x),
                            source.memory->data() + source.place(blit.from.mip, blit.from.z, sy, sx),
                            source.image.format().bytesPerTexel);
            }
        blitImage(context_, source.image, target.image, blit.region(), VK_FILTER_NEAREST);
        ASSERT_TRUE(target.bytes() == expected) << "round " << round;
    }
}

TEST_F(TransferModel, LinearBlitsAreWithinACode) {
    for (uint32_t round = 0; round < 60; ++round) {
        const TestImage source(flatInfo(random_, VK_FORMAT_R8_UNORM), random_),
            target(flatInfo(random_, VK_FORMAT_R8_UNORM), random_);
        const BlitCase blit = BlitCase::random(random_, source, target);
        const std::vector<std::byte> before = target.bytes();
        blitImage(context_, source.image, target.image, blit.region(), VK_FILTER_LINEAR);
        const std::vector<std::byte> after = target.bytes();
        const VkExtent3D& limit = source.image.level(blit.from.mip).extent;
        const auto code = [&](int64_t x, int64_t y) {
            const auto sx = static_cast<uint32_t>(std::clamp<int64_t>(x, 0, limit.width - 1));
            const auto sy = static_cast<uint32_t>(std::clamp<int64_t>(y, 0, limit.height - 1));
            return std::to_integer<int>(source.memory->data()[source.place(blit.from.mip, blit.from.z, sy, sx)]);
        };
        std::vector<bool> written(after.size());
        for (uint32_t y = blit.to.y; y < blit.to.y + blit.to.height; ++y)
            for (uint32_t x = blit.to.x; x < blit.to.x + blit.to.width; ++x) {
                const double u = sourcePlace(x, blit.source[0], blit.target[0]) - 0.5;
                const double v = sourcePlace(y, blit.source[1], blit.target[1]) - 0.5;
                const auto x0 = static_cast<int64_t>(std::floor(u)), y0 = static_cast<int64_t>(std::floor(v));
                const double wx = u - std::floor(u), wy = v - std::floor(v);
                const double value = (code(x0, y0) * (1 - wx) + code(x0 + 1, y0) * wx) * (1 - wy) +
                                     (code(x0, y0 + 1) * (1 - wx) + code(x0 + 1, y0 + 1) * wx) * wy;
                const size_t place = target.place(blit.to.mip, blit.to.z, y, x);
                written[place] = true;
                ASSERT_NEAR(std::to_integer<int>(after[place]), value, 0.501) << "round " << round;
            }
        for (size_t i = 0; i < after.size(); ++i) {
            if (written[i]) continue;
            ASSERT_EQ(after[i], before[i]) << "round " << round << ", byte " << i;
        }
    }
}

TEST_F(TransferModel, Fills) {
    constexpr uint64_t kSizes[] = {4, 8, 12, 4096, 8196, 100000, (1 << 21) + 4, (5 << 20) + 12};
    for (const uint64_t size : kSizes) {
        const std::unique_ptr<Memory> memory = Memory::create({}, size + 8).value();
        std::memset(memory->data(), 0x55, size + 8);
        Buffer buffer(size + 8, 0);
        buffer.bind(*memory, 0);
        fillBuffer(context_, buffer, 4, size, 0x01234567);
        for (uint64_t i = 0; i < size + 8; ++i) {
            constexpr uint8_t kBytes[] = {0x67, 0x45, 0x23, 0x01};
            const uint8_t expected = i < 4 || i >= size + 4 ? 0x55 : kBytes[i % 4];
            ASSERT_EQ(std::to_integer<uint8_t>(memory->data()[i]), expected) << "size " << size << ", byte " << i;
        }
    }
}

}  // namespace
}  // namespace vernier
