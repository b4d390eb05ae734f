// Borders of images whose views swap components (VK_EXT_border_color_swizzle).
#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class BorderColorTest : public ComputeTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME, VK_EXT_BORDER_COLOR_SWIZZLE_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        swizzles_.borderColorSwizzle = swizzles_.borderColorSwizzleFromImage = VK_TRUE;
        return &swizzles_;
    }

  private:
    VkPhysicalDeviceBorderColorSwizzleFeaturesEXT swizzles_ = make<VkPhysicalDeviceBorderColorSwizzleFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BORDER_COLOR_SWIZZLE_FEATURES_EXT);
};

// Whether the sampler is told how the view swaps them, or takes it from the view.
TEST_F(BorderColorTest, viewsSwapTheBordersComponents) {
    constexpr VkComponentMapping kSwapped{VK_COMPONENT_SWIZZLE_A, VK_COMPONENT_SWIZZLE_G, VK_COMPONENT_SWIZZLE_B,
                                          VK_COMPONENT_SWIZZLE_R};
    const TestImage image = makeImage(flatImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_SAMPLED_BIT));
    auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = image.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = image.format;
    view.components = kSwapped;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkImageView swapped = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateImageView(device, &view, nullptr, &swapped), VK_SUCCESS);
    defer([this, swapped] { vkDestroyImageView(device, swapped, nullptr); });
    auto mapping = make<VkSamplerBorderColorComponentMappingCreateInfoEXT>(
        VK_STRUCTURE_TYPE_SAMPLER_BORDER_COLOR_COMPONENT_MAPPING_CREATE_INFO_EXT);
    mapping.components = kSwapped;
    for (const bool told : {true, false}) {
        auto info = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, told ? &mapping : nullptr);
        info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
        info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK;  // 0, 0, 0, 1
        VkSampler sampler = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSampler(device, &info, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
        const TestBuffer out = makeStorage(4);
        const Compute compute = makeCompute(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1) buffer Out { uvec4 v; };
void main() { v = uvec4(textureLod(image, vec2(-2.0), 0.0)); })",
                                            {sampledImage(swapped, sampler), storageBuffer(out)});
        const VkCommandBuffer commands = begin();
        toGeneral(commands, image);
        dispatch(commands, compute, 1);
        submit(commands);
        EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 4), (std::vector<uint32_t>{1, 0, 0, 0})) << told;
    }
}

}  // namespace
}  // namespace vernier::test
