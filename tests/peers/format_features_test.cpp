// What lavapipe can do with formats and Vernier cannot: every such feature has a reason in a table here, and a reason
// that no longer holds fails too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "tests/peers/texture_lab.h"

namespace vernier::test {
namespace {

enum class Place { linear, optimal, buffer };

constexpr VkFormatFeatureFlags kBlit = VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
constexpr VkFormatFeatureFlags kTexelBuffer =
    VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT | VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT;
constexpr VkFormatFeatureFlags kSampled =
    VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
    VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT |
    VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_MINMAX_BIT;

/// Features that Vernier leaves out of the formats first .. last.
struct Exception {
    VkFormat first, last;
    VkFormatFeatureFlags image, buffer;
    bool linearOnly;
    const char* reason;
};

constexpr const char* kScaled = "scaled formats are for vertices: no image of them can be sampled or drawn to";
constexpr const char* kWide = "components of 64 bits: neither texels nor attributes of that size in shaders";
constexpr Exception scaled(VkFormat uscaled) {
    // USCALED and SSCALED follow each other.
    return {uscaled, static_cast<VkFormat>(uscaled + 1), kBlit, 0, false, kScaled};
}

constexpr Exception kExceptions[] = {
    scaled(VK_FORMAT_R8_USCALED),
    scaled(VK_FORMAT_R8G8_USCALED),
    scaled(VK_FORMAT_R8G8B8_USCALED),
    scaled(VK_FORMAT_B8G8R8_USCALED),
    scaled(VK_FORMAT_R8G8B8A8_USCALED),
    scaled(VK_FORMAT_B8G8R8A8_USCALED),
    scaled(VK_FORMAT_A8B8G8R8_USCALED_PACK32),
    scaled(VK_FORMAT_A2R10G10B10_USCALED_PACK32),
    scaled(VK_FORMAT_A2B10G10R10_USCALED_PACK32),
    scaled(VK_FORMAT_R16_USCALED),
    scaled(VK_FORMAT_R16G16_USCALED),
    scaled(VK_FORMAT_R16G16B16_USCALED),
    scaled(VK_FORMAT_R16G16B16A16_USCALED),
    {VK_FORMAT_R64_UINT, VK_FORMAT_R64G64B64A64_SFLOAT, kBlit, kTexelBuffer, false, kWide},
    {VK_FORMAT_R32G32B32_UINT, VK_FORMAT_R32G32B32_SFLOAT,
     VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, 0, false,
     "texels of 12 bytes are not drawn to: blocks of pixels are powers of two"},
    {VK_FORMAT_BC1_RGB_UNORM_BLOCK, VK_FORMAT_BC7_SRGB_BLOCK, kSampled, 0, true,
     "compressed images are optimally tiled: the specification asks linear tiling of no format"},
};

VkFormatFeatureFlags excepted(VkFormat format, Place place) {
    VkFormatFeatureFlags flags = 0;
    for (const Exception& exception : kExceptions) {
        if (format < exception.first || format > exception.last) continue;
        if (place == Place::buffer) flags |= exception.buffer;
        if (place == Place::linear || (place == Place::optimal && !exception.linearOnly)) flags |= exception.image;
    }
    return flags;
}

std::map<VkFormat, VkFormatProperties> featuresOf(const char* manifest) {
    std::map<VkFormat, VkFormatProperties> result;
    const std::unique_ptr<TextureLab> lab = TextureLab::open(manifest);
    if (!lab) return result;
    constexpr std::pair<int, int> kRanges[] = {
        {VK_FORMAT_R4G4_UNORM_PACK8, VK_FORMAT_ASTC_12x12_SRGB_BLOCK},
        {VK_FORMAT_ASTC_4x4_SFLOAT_BLOCK, VK_FORMAT_ASTC_12x12_SFLOAT_BLOCK},
        {VK_FORMAT_G8B8G8R8_422_UNORM, VK_FORMAT_G16_B16_R16_3PLANE_444_UNORM},
        {VK_FORMAT_A4R4G4B4_UNORM_PACK16, VK_FORMAT_A4B4G4R4_UNORM_PACK16},
    };
    for (const auto& [first, last] : kRanges) {
        for (int format = first; format <= last; ++format)
            vkGetPhysicalDeviceFormatProperties(lab->physicalDevice(), static_cast<VkFormat>(format),
                                                &result[static_cast<VkFormat>(format)]);
    }
    return result;
}

TEST(FormatFeatures, AllOfLavapipesOrAReason) {
    const auto ours = featuresOf(VERNIER_ICD_JSON), theirs = featuresOf(VERNIER_LAVAPIPE_JSON);
    ASSERT_FALSE(ours.empty());
    if (theirs.empty()) GTEST_SKIP() << "no lavapipe here";
    std::map<const char*, VkFormatFeatureFlags> used;
    for (const auto& entry : theirs) {
        const VkFormat format = entry.first;
        const VkFormatProperties& peer = entry.second;
        const VkFormatProperties& own = ours.at(format);
        const auto check = [&](Place place, const char* where, VkFormatFeatureFlags has, VkFormatFeatureFlags wanted) {
            const VkFormatFeatureFlags missing = wanted & ~has;
            EXPECT_EQ(missing & ~excepted(format, place), 0u) << where << " features of format " << format;
            for (const Exception& exception : kExceptions)
                if (format >= exception.first && format <= exception.last) used[exception.reason] |= missing;
        };
        check(Place::linear, "linear", own.linearTilingFeatures, peer.linearTilingFeatures);
        check(Place::optimal, "optimal", own.optimalTilingFeatures, peer.optimalTilingFeatures);
        check(Place::buffer, "buffer", own.bufferFeatures, peer.bufferFeatures);
    }
    for (const Exception& exception : kExceptions)
        EXPECT_NE(used[exception.reason], 0u) << "nothing is missing any more: " << exception.reason;
}

}  // namespace
}  // namespace vernier::test
