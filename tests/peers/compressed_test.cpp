// Random blocks of every compressed format: what the decoders make of them, against what the peers make of them, and
// against what the driver's texel fetches give.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "runtime/format/format.h"
#include "tests/peers/texture_lab.h"

namespace vernier::test {
namespace {

constexpr uint32_t kBlocks = 24;  // per side

/// Blocks of random bits; some with little in them, so that rare modes come up: few bits set at the start, or a start
/// of zeros before a one.
LabImage randomBlocks(const FormatInfo& format, uint32_t seed) {
    LabImage image;
    image.format = format.format;
    image.extent = {kBlocks * format.blockWidth() - 1, kBlocks * format.blockHeight() - 2, 1};
    std::vector<uint8_t> bytes = randomBytes(size_t{kBlocks} * kBlocks * format.bytesPerTexel, seed);
    const std::vector<uint8_t> choices = randomBytes(bytes.size(), seed + 1);
    for (size_t at = 0, block = 0; at < bytes.size(); at += format.bytesPerTexel, ++block) {
        uint8_t* const b = &bytes[at];
        switch (block % 8) {
            case 0:  // BC7's modes in turn
                b[0] = static_cast<uint8_t>((b[0] & ~0u << (block / 8 % 9)) | 1u << (block / 8 % 9));
                break;
            case 1:  // BC6H's five-bit modes in turn
                b[0] = static_cast<uint8_t>((b[0] & 0xe0u) | (block / 8 % 32));
                break;
            case 2:  // ASTC: one partition, valid weight ranges and LDR endpoint modes are likelier with these cleared
                b[1] &= 0xe7;
                b[2] &= choices[at];
                break;
            case 3:  // ASTC void extents: LDR and HDR; without extents, with them, with empty ones
                if (format.bytesPerTexel == 16) {
                    b[0] = 0xfc;
                    b[1] = static_cast<uint8_t>((choices[at] & 1) != 0 ? 0xfd : (choices[at] & 6) != 0 ? 0xfd : b[1]);
                    b[1] = static_cast<uint8_t>(b[1] | 1);
                    if ((choices[at + 1] & 3) != 0) {
                        for (int i = 2; i < 8; ++i) b[i] = 0xff;
                        b[1] |= 0xf0;
                    }
                }
                break;
            case 4:  // equal end points
                b[2] = b[0];
                b[3] = b[1];
                break;
            case 5:  // ETC2's differential bit
                b[3] |= 2;
                if (format.bytesPerTexel == 16) b[11] |= 2;
                break;
            case 6:
                for (size_t i = 0; i < format.bytesPerTexel; ++i) b[i] &= choices[at + i];
                break;
            default:
                break;
        }
    }
    image.data.push_back(std::move(bytes));
    return image;
}

/// Every texel as the decoders of runtime/format give it.
std::vector<Vec4> decodeAll(const FormatInfo& format, const LabImage& image) {
    std::vector<Vec4> texels(size_t{image.extent.width} * image.extent.height);
    std::vector<std::byte> decoded(kMaxBlockTexels * kMaxDecodedBytes);
    const uint32_t columns = format.columns(image.extent.width);
    for (uint32_t y = 0; y < image.extent.height; ++y) {
        for (uint32_t x = 0; x < image.extent.width; ++x) {
            const uint32_t column = x / format.blockWidth(), row = y / format.blockHeight();
            const uint8_t* const block = image.data[0].data() + (size_t{row} * columns + column) * format.bytesPerTexel;
            format.block->decode(reinterpret_cast<const std::byte*>(block), decoded.data());
            const uint32_t inside = y % format.blockHeight() * format.blockWidth() + x % format.blockWidth();
            const VkClearColorValue value = unpackTexel(format.color, decoded.data() + inside * format.color.bytes);
            std::copy_n(value.float32, 4, texels[size_t{y} * image.extent.width + x].data());
        }
    }
    return texels;
}

std::vector<Vec4> fetchAll(TextureLab& lab, const LabImage& image) {
    return lab.look(image, LabSampler(), "sampler2D", "return texelFetch(tex, at, 0);", {},
                    {image.extent.width, image.extent.height});
}

bool isAstc(VkFormat format) {
    return format >= VK_FORMAT_ASTC_4x4_UNORM_BLOCK && format <= VK_FORMAT_ASTC_12x12_SRGB_BLOCK;
}

/// The largest difference that a peer's lower precision explains; nearly 0 where the specification's arithmetic is
/// exact.
float tolerance(const FormatInfo& format, uint32_t channel) {
    const bool snorm = std::string(format.name).find("SNORM") != std::string::npos;
    const bool srgb = std::string(format.name).find("SRGB") != std::string::npos && channel < 3;
    const float slope = srgb ? 2.3f : 1.0f;  // of the sRGB curve where it is steepest
    // Peers interpolate 8-bit codes and round down, from end points widened to 8 bits.
    if (format.format <= VK_FORMAT_BC5_SNORM_BLOCK) return slope * 1.9f / (snorm ? 127 : 255);
    if (isAstc(format.format)) return slope * 1.01f / 255;  // 8 bits instead of 16; sRGB widened like linear
    // SwiftShader adds half a base codeword to signed blocks, which the specification says not to.
    if (format.format >= VK_FORMAT_EAC_R11_UNORM_BLOCK) return snorm ? 5.0f / 1023 : 0x1p-11f;
    return srgb ? 1e-5f : 0x1p-23f;  // the last place of the division by 255; SwiftShader's sRGB curve
}

bool samples(const TextureLab& lab, VkFormat format) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(lab.physicalDevice(), format, &properties);
    return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) != 0;
}

/// Texels further apart than `limit(channel)`, the first of them described.
template <class Limit>
void expectNear(const FormatInfo& format, const LabImage& image, const std::vector<Vec4>& mine,
                const std::vector<Vec4>& theirs, Limit limit) {
    size_t wrong = 0, first = 0;
    for (size_t i = 0; i < mine.size(); ++i) {
        bool differs = false;
        for (uint32_t c = 0; c < 4; ++c) {
            const bool same = std::bit_cast<uint32_t>(mine[i][c]) == std::bit_cast<uint32_t>(theirs[i][c]);
            differs = differs || (!same && !(std::fabs(mine[i][c] - theirs[i][c]) <= limit(c)));
        }
        if (differs && wrong++ == 0) first = i;
    }
    const size_t x = first % image.extent.width, y = first / image.extent.width;
    EXPECT_EQ(wrong, 0u) << format.name << ": of " << mine.size() << " texels; the first at " << x << ", " << y
                         << ", block " << x / format.blockWidth() << ", " << y / format.blockHeight() << ": "
                         << testing::PrintToString(mine[first]) << " instead of "
                         << testing::PrintToString(theirs[first]);
}

class CompressedPeer : public testing::TestWithParam<const FormatInfo*> {};

TEST_P(CompressedPeer, decodersAgreeWithPeers) {
    const FormatInfo& format = *GetParam();
    const LabImage image = randomBlocks(format, static_cast<uint32_t>(format.format));
    const std::vector<Vec4> mine = decodeAll(format, image);
    bool any = false;
    for (const char* manifest : {VERNIER_LAVAPIPE_JSON, VERNIER_SWIFTSHADER_JSON}) {
        const std::unique_ptr<TextureLab> lab = TextureLab::open(manifest);
        if (lab == nullptr || !samples(*lab, format.format)) continue;
        any = true;
        expectNear(format, image, mine, fetchAll(*lab, image), [&](uint32_t c) { return tolerance(format, c); });
    }
    if (!any) GTEST_SKIP() << "no peer samples " << format.name;
}

TEST_P(CompressedPeer, driverFetchesWhatDecodersGive) {
    const FormatInfo& format = *GetParam();
    const LabImage image = randomBlocks(format, static_cast<uint32_t>(format.format) + 1);
    const std::unique_ptr<TextureLab> lab = TextureLab::open(VERNIER_ICD_JSON);
    ASSERT_NE(lab, nullptr);
    ASSERT_TRUE(samples(*lab, format.format));
    expectNear(format, image, fetchAll(*lab, image), decodeAll(format, image), [](uint32_t) { return 0.0f; });
}

std::vector<const FormatInfo*> compressedFormats() {
    std::vector<const FormatInfo*> formats;
    for (const FormatInfo& info : allFormats()) {
        if (info.block != nullptr) formats.push_back(&info);
    }
    return formats;
}

INSTANTIATE_TEST_SUITE_P(Formats, CompressedPeer, testing::ValuesIn(compressedFormats()),
                         [](const auto& parameter) { return std::string(parameter.param->name); });

}  // namespace
}  // namespace vernier::test
