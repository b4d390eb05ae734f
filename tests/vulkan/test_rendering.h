// For tests of dynamic rendering.
#pragma once

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {

class RenderingTest : public DrawTest {
  protected:
    static constexpr VkExtent2D kExtent{96, 80};  // more than one tile of the rasteriser
    static constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM, kDepth = VK_FORMAT_D32_SFLOAT_S8_UINT;

    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME, VK_KHR_DEPTH_STENCIL_RESOLVE_EXTENSION_NAME,
                VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        rendering_.dynamicRendering = multiview_.multiview = VK_TRUE;
        rendering_.pNext = &multiview_;
        return &rendering_;
    }
    void SetUp() override {
        DrawTest::SetUp();
        color = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        beginRendering = command<PFN_vkCmdBeginRenderingKHR>("vkCmdBeginRenderingKHR");
        endRendering = command<PFN_vkCmdEndRenderingKHR>("vkCmdEndRenderingKHR");
        ASSERT_NE(beginRendering, nullptr);
        ASSERT_NE(endRendering, nullptr);
    }

    static VkRenderingAttachmentInfo attach(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp loadOp,
                                            VkClearValue clear = {}) {
        auto info = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
        info.imageView = view;
        info.imageLayout = layout;
        info.loadOp = loadOp;
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        info.clearValue = clear;
        return info;
    }
    static VkRenderingAttachmentInfo attachColor(const TestImage& image,
                                                 VkAttachmentLoadOp loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR) {
        return attach(image.view, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, loadOp);
    }
    static VkRenderingInfo rendering(const VkRenderingAttachmentInfo& attachment) {
        auto info = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
        info.renderArea.extent = kExtent;
        info.layerCount = 1;
        info.colorAttachmentCount = 1;
        info.pColorAttachments = &attachment;
        return info;
    }
    /// For one colour attachment and, if not VK_FORMAT_UNDEFINED, these aspects.
    VkPipeline pipelineFor(PipelineDesc desc, VkFormat depth = VK_FORMAT_UNDEFINED,
                           VkFormat stencil = VK_FORMAT_UNDEFINED, uint32_t viewMask = 0) {
        auto formats = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
        formats.colorAttachmentCount = desc.colorCount;
        formats.pColorAttachmentFormats = &kColor;
        formats.depthAttachmentFormat = depth;
        formats.stencilAttachmentFormat = stencil;
        formats.viewMask = viewMask;
        desc.next = &formats;
        desc.extent = kExtent;
        return makePipeline(VK_NULL_HANDLE, desc);
    }
    PipelineDesc filling(const std::string& rgba, const std::string& z = "0.5") {
        PipelineDesc desc;
        desc.vertex = fullScreen(z);
        desc.fragment = constantColor(rgba);
        return desc;
    }
    void moveTo(VkCommandBuffer commands, const TestImage& image, VkImageLayout from, VkImageLayout to,
                VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT) {
        changeLayout(commands, image.image, aspect, from, to);
    }
    void toColor(VkCommandBuffer commands, const TestImage& image) {
        moveTo(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    }
    void toSource(VkCommandBuffer commands, const TestImage& image) {
        moveTo(commands, image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    }
    static void draw(VkCommandBuffer commands, VkPipeline pipeline) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, 0);
    }
    uint32_t colorAt(const TestImage& image, uint32_t x, uint32_t y, uint32_t layer = 0) {
        return pixelAt(readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4, layer), image, x, y);
    }

    TestImage color;
    PFN_vkCmdBeginRenderingKHR beginRendering = nullptr;
    PFN_vkCmdEndRenderingKHR endRendering = nullptr;

  private:
    VkPhysicalDeviceDynamicRenderingFeatures rendering_ =
        make<VkPhysicalDeviceDynamicRenderingFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES);
    VkPhysicalDeviceMultiviewFeatures multiview_ =
        make<VkPhysicalDeviceMultiviewFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES);
};

}  // namespace vernier::test
