// Resolves against their definition, one texel at a time: the sum of the scaled samples, packed.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "runtime/format/resolve.h"

namespace vernier {
namespace {

class ResolveTest : public testing::TestWithParam<VkFormat> {};

std::vector<std::byte> averageOneByOne(const FormatOps& ops, const std::vector<std::byte>& texels, size_t pitch,
                                       uint32_t samples, size_t n) {
    const size_t bytes = ops.layout.bytes;
    std::vector<std::byte> result(n * bytes);
    for (size_t k = 0; k < n; ++k) {
        alignas(64) float sum[4][16] = {}, sample[4][16] = {};
        void* planes[4] = {sample[0], sample[1], sample[2], sample[3]};
        const void* sums[4] = {sum[0], sum[1], sum[2], sum[3]};
        for (uint32_t s = 0; s < samples; ++s) {
            ops.unpack(texels.data() + s * pitch + k * bytes, 1, planes);
            for (int c = 0; c < 4; ++c) sum[c][0] += sample[c][0] * (1.0f / static_cast<float>(samples));
        }
        ops.pack(sums, 1, result.data() + k * bytes);
    }
    return result;
}

/// Any code, but of floats no NaN: which one a sum of several gives is not said.
void fillTexel(const FormatOps& ops, std::mt19937& random, std::byte* texel) {
    const ComponentKind kind = ops.layout.rgba[0].kind;
    for (uint32_t n = 0; n < ops.layout.bytes; ++n) texel[n] = static_cast<std::byte>(random());
    if (kind == ComponentKind::unorm || kind == ComponentKind::srgb || kind == ComponentKind::snorm) return;
    alignas(64) float values[4][16] = {};
    for (auto& value : values) value[0] = static_cast<float>(random() % 4096) / 1024 - 2;
    const void* planes[4] = {values[0], values[1], values[2], values[3]};
    ops.pack(planes, 1, texel);
}

TEST_P(ResolveTest, SameAsOneTexelAtATime) {
    std::mt19937 random(static_cast<uint32_t>(GetParam()));
    const FormatOps ops = formatOps(GetParam(), bestIsa());
    const size_t bytes = ops.layout.bytes;
    for (const uint32_t samples : {2u, 4u, 8u, 16u}) {
        for (int round = 0; round < 200; ++round) {
            const size_t n = 1 + random() % 150, pitch = n * bytes + random() % 3 * bytes;
            std::vector<std::byte> texels(pitch * samples);
            for (size_t at = 0; at + bytes <= texels.size(); at += bytes) fillTexel(ops, random, texels.data() + at);
            // Runs of texels whose samples are equal.
            for (size_t k = 0, equal = 0; k < n; ++k) {
                if (random() % 24 == 0) equal = 1 - equal;
                for (uint32_t s = 1; s < samples && equal != 0; ++s)
                    std::memcpy(texels.data() + s * pitch + k * bytes, texels.data() + k * bytes, bytes);
            }
            std::vector<std::byte> result(n * bytes);
            resolveTexels(ops, texels.data(), pitch, samples, n, result.data());
            ASSERT_EQ(result, averageOneByOne(ops, texels, pitch, samples, n)) << samples << " samples, " << n;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, ResolveTest,
                         testing::Values(VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB,
                                         VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_R5G6B5_UNORM_PACK16,
                                         VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R8G8B8A8_SNORM,
                                         VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                                         VK_FORMAT_R32G32B32A32_SFLOAT));

}  // namespace
}  // namespace vernier
