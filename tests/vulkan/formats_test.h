// What the tests of format features share: each bit that the driver reports is tried with every format that has it.
#pragma once

#include <map>
#include <random>

#include "runtime/format/format.h"
#include "tests/vulkan/test_compute.h"

namespace vernier::test {

constexpr uint32_t kFormatSize = 24;  // texels on a side of an image: whole blocks of every compressed format

class FormatsTest : public ComputeTest {
  protected:
    /// A format, one of its aspects and how the image lies in memory.
    struct Case {
        const FormatInfo* info;
        VkImageAspectFlags aspect;
        VkImageTiling tiling;
        const TexelLayout& layout() const { return info->layout(aspect); }
        bool isBlock() const { return info->block != nullptr; }
    };
    /// Calls run(case) for every format, aspect and tiling with the feature; none at all fails.
    template <class Run>
    void forEachImageCase(VkFormatFeatureFlags feature, Run run) {
        uint32_t count = 0;
        for (const FormatInfo& info : allFormats()) {
            VkFormatProperties properties{};
            vkGetPhysicalDeviceFormatProperties(physicalDevice, info.format, &properties);
            for (const VkImageTiling tiling : {VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_TILING_LINEAR}) {
                const VkFormatFeatureFlags features = tiling == VK_IMAGE_TILING_OPTIMAL
                                                          ? properties.optimalTilingFeatures
                                                          : properties.linearTilingFeatures;
                if ((features & feature) != feature) continue;
                for (VkImageAspectFlags aspect = 1; aspect <= info.aspects; aspect <<= 1) {
                    if ((info.aspects & aspect) == 0) continue;
                    SCOPED_TRACE(std::string(info.name) + ", aspect " + std::to_string(aspect) + ", tiling " +
                                 std::to_string(tiling));
                    run(Case{&info, aspect, tiling});
                    ++count;
                    if (HasFailure()) return;
                }
            }
        }
        EXPECT_GT(count, 0u);
    }

    TestImage makeImage(const Case& of, VkImageUsageFlags usage, uint32_t size = kFormatSize);
    /// The aspect of the whole image from and to bytes, packed as in buffers; into VK_IMAGE_LAYOUT_GENERAL.
    void upload(const TestImage& image, const Case& of, const std::vector<uint8_t>& bytes);
    std::vector<uint8_t> download(const TestImage& image, const Case& of,
                                  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL);

    /// Bits that stand for values everywhere: for an image of `size`, as buffers pack them.
    static std::vector<uint8_t> randomTexels(const Case& of, uint32_t seed, uint32_t size = kFormatSize);
    /// What a shader sees of texel (x, y) of these bytes.
    static VkClearColorValue texelAt(const Case& of, const std::vector<uint8_t>& bytes, uint32_t x, uint32_t y,
                                     uint32_t size = kFormatSize);
    /// A colour that every format of the kind can hold, or comes near to.
    static VkClearColorValue plainColor(const TexelLayout& layout);
    /// The bytes of a texel of this value; whole blocks do not encode.
    static std::vector<uint8_t> packed(const Case& of, const VkClearColorValue& value);

    /// A pipeline made once for all sets of the same kinds of descriptors, with a set for these.
    Compute computeFor(const std::string& glsl, const std::vector<TestDescriptor>& descriptors);
    VkSampler makeSampler(VkFilter filter, VkSamplerReductionMode reduction);

    static constexpr const char* kPrefix[] = {"", "u", "i"};  // by ValueType, of sampler and image types

  private:
    std::map<std::pair<std::string, std::vector<VkSampler>>, Compute> pipelines_;
};

/// Equal bits, or both of them NaN where they stand for floats.
void expectSameColor(const VkClearColorValue& found, const VkClearColorValue& wanted, ValueType type);

}  // namespace vernier::test
