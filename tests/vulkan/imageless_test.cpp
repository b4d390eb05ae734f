// VK_KHR_imageless_framebuffer: framebuffers that learn their attachments when a render pass begins.
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{32, 16};

class ImagelessTest : public DrawTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_IMAGELESS_FRAMEBUFFER_EXTENSION_NAME, VK_KHR_IMAGE_FORMAT_LIST_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        features_.imagelessFramebuffer = VK_TRUE;
        return &features_;
    }
    TestImage colorImage() { return makeImage(kFormat, kExtent, kUsage); }
    VkFramebuffer makeFramebuffer(VkRenderPass pass) {
        auto attachment = make<VkFramebufferAttachmentImageInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENT_IMAGE_INFO);
        attachment.usage = kUsage;
        attachment.width = kExtent.width;
        attachment.height = kExtent.height;
        attachment.layerCount = attachment.viewFormatCount = 1;
        attachment.pViewFormats = &kFormat;
        auto attachments =
            make<VkFramebufferAttachmentsCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENTS_CREATE_INFO);
        attachments.attachmentImageInfoCount = 1;
        attachments.pAttachmentImageInfos = &attachment;
        auto info = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO, &attachments);
        info.flags = VK_FRAMEBUFFER_CREATE_IMAGELESS_BIT;
        info.renderPass = pass;
        info.attachmentCount = info.layers = 1;
        info.width = kExtent.width;
        info.height = kExtent.height;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateFramebuffer(device, &info, nullptr, &framebuffer), VK_SUCCESS);
        defer([this, framebuffer] { vkDestroyFramebuffer(device, framebuffer, nullptr); });
        return framebuffer;
    }
    void beginWith(VkCommandBuffer commands, VkRenderPass pass, VkFramebuffer framebuffer, const VkImageView* view) {
        auto attachments = make<VkRenderPassAttachmentBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_ATTACHMENT_BEGIN_INFO);
        attachments.attachmentCount = view != nullptr ? 1 : 0;
        attachments.pAttachments = view;
        auto info = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO, &attachments);
        const VkClearValue black{};
        info.renderPass = pass;
        info.framebuffer = framebuffer;
        info.renderArea = {{0, 0}, kExtent};
        info.clearValueCount = 1;
        info.pClearValues = &black;
        vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    }

    static constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
    static constexpr VkImageUsageFlags kUsage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

  private:
    VkPhysicalDeviceImagelessFramebufferFeatures features_ = make<VkPhysicalDeviceImagelessFramebufferFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGELESS_FRAMEBUFFER_FEATURES);
};

TEST_F(ImagelessTest, oneFramebufferDrawsToManyImages) {
    const TestImage images[] = {colorImage(), colorImage()};
    const Pass pass = makePass(images[0]);
    const VkFramebuffer framebuffer = makeFramebuffer(pass.pass);
    const char* const colors[] = {"1, 0, 0, 1", "0, 0, 1, 1"};
    const VkCommandBuffer commands = begin();
    for (int i = 0; i < 2; ++i) {
        PipelineDesc desc;
        desc.vertex = fullScreen();
        desc.fragment = constantColor(colors[i]);
        desc.extent = kExtent;
        beginWith(commands, pass.pass, framebuffer, &images[i].view);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, makePipeline(pass.pass, desc));
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRenderPass(commands);
    }
    submit(commands);
    EXPECT_EQ(pixelAt(readImage(images[0], VK_IMAGE_ASPECT_COLOR_BIT, 4), images[0], 31, 15), 0xFF0000FFu);
    EXPECT_EQ(pixelAt(readImage(images[1], VK_IMAGE_ASPECT_COLOR_BIT, 4), images[1], 31, 15), 0xFFFF0000u);
}

TEST_F(ImagelessTest, viewsThatDoNotFitAreRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestImage image = colorImage();
    const Pass pass = makePass(image);
    const VkFramebuffer framebuffer = makeFramebuffer(pass.pass);
    const TestImage small = makeImage(kFormat, {8, 8}, kUsage);
    const TestImage other = makeImage(VK_FORMAT_R16G16B16A16_SFLOAT, kExtent, kUsage);
    const VkImageView none = VK_NULL_HANDLE;
    for (const VkImageView* view : {&small.view, &other.view, &none, static_cast<const VkImageView*>(nullptr)}) {
        const VkCommandBuffer commands = begin();
        beginWith(commands, pass.pass, framebuffer, view);
        vkCmdEndRenderPass(commands);
        EXPECT_NE(vkEndCommandBuffer(commands), VK_SUCCESS);
    }
}

}  // namespace
}  // namespace vernier::test
