// For tests of VK_EXT_multisampled_render_to_single_sampled.
#pragma once

#include "tests/vulkan/test_inputs.h"

namespace vernier::test {

class MultisampledTest : public InputsTest {
  protected:
    static constexpr VkExtent2D kExtent{70, 40};  // more than one tile of the rasteriser
    static constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT_S8_UINT;
    static constexpr VkImageAspectFlags kBoth = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    static constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_GENERAL;  // of attachments
    static constexpr VkImageCreateFlags kToSingle = VK_IMAGE_CREATE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_BIT_EXT;
    static constexpr VkImageUsageFlags kUsage =
        VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    static constexpr VkImageUsageFlags kColorUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | kUsage,
                                       kDepthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | kUsage;

    uint32_t apiVersion() override { return VK_API_VERSION_1_3; }
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_EXTENSION_NAME,
                VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        single_.multisampledRenderToSingleSampled = VK_TRUE;
        single_.pNext = &eleven_;
        eleven_.multiview = VK_TRUE;
        eleven_.pNext = &twelve_;
        twelve_.timelineSemaphore = twelve_.imagelessFramebuffer = VK_TRUE;
        twelve_.shaderOutputLayer = twelve_.shaderOutputViewportIndex = VK_TRUE;
        twelve_.pNext = &thirteen_;
        thirteen_.dynamicRendering = VK_TRUE;
        return &single_;
    }

    static VkImageAspectFlags aspectsOf(VkFormat format) {
        return format == kDepth ? kBoth : VkImageAspectFlags{VK_IMAGE_ASPECT_COLOR_BIT};
    }
    /// A colour or depth-stencil attachment of one level, with a view of all of it.
    TestImage makeTarget(VkFormat format, VkSampleCountFlagBits samples, VkImageCreateFlags flags,
                         uint32_t layers = 1) {
        auto info = flatImage(format, kExtent, format == kDepth ? kDepthUsage : kColorUsage);
        info.arrayLayers = layers;
        info.flags = flags;
        info.samples = samples;
        TestImage image = makeImage(info);
        image.view = makeView(image.image, layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, format,
                              {aspectsOf(format), 0, 1, 0, layers});
        return image;
    }
    static void barrier(VkCommandBuffer commands, const TestImage& image, VkImageLayout from, VkImageLayout to) {
        changeLayout(commands, image.image, aspectsOf(image.format), from, to);
    }

    static VkAttachmentDescription2 describe(VkFormat format, VkSampleCountFlagBits samples, VkAttachmentLoadOp load,
                                             VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_STORE) {
        auto info = make<VkAttachmentDescription2>(VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2);
        info.format = format;
        info.samples = samples;
        info.loadOp = info.stencilLoadOp = load;
        info.storeOp = info.stencilStoreOp = store;
        info.initialLayout = info.finalLayout = kLayout;
        return info;
    }
    static VkAttachmentReference2 refer(uint32_t attachment, VkImageAspectFlags aspects) {
        auto info = make<VkAttachmentReference2>(VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2);
        info.attachment = attachment;
        info.layout = kLayout;
        info.aspectMask = aspects;
        return info;
    }
    static VkMultisampledRenderToSingleSampledInfoEXT toSingle(bool enable, VkSampleCountFlagBits samples) {
        auto info = make<VkMultisampledRenderToSingleSampledInfoEXT>(
            VK_STRUCTURE_TYPE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_INFO_EXT);
        info.multisampledRenderToSingleSampledEnable = enable ? VK_TRUE : VK_FALSE;
        info.rasterizationSamples = samples != VK_SAMPLE_COUNT_1_BIT ? samples : VK_SAMPLE_COUNT_4_BIT;
        return info;
    }

  private:
    VkPhysicalDeviceMultisampledRenderToSingleSampledFeaturesEXT single_ =
        make<VkPhysicalDeviceMultisampledRenderToSingleSampledFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_FEATURES_EXT);
    VkPhysicalDeviceVulkan11Features eleven_ =
        make<VkPhysicalDeviceVulkan11Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES);
    VkPhysicalDeviceVulkan12Features twelve_ =
        make<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    VkPhysicalDeviceVulkan13Features thirteen_ =
        make<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
};

}  // namespace vernier::test
