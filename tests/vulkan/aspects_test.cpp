// Depth and stencil each for itself: usages (VK_EXT_separate_stencil_usage), layouts and barriers
// (VK_KHR_separate_depth_stencil_layouts).
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{16, 8};
constexpr VkFormat kFormat = VK_FORMAT_D32_SFLOAT_S8_UINT;

class AspectsTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_SEPARATE_STENCIL_USAGE_EXTENSION_NAME, VK_KHR_SEPARATE_DEPTH_STENCIL_LAYOUTS_EXTENSION_NAME,
                VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME, VK_KHR_MULTIVIEW_EXTENSION_NAME,
                VK_KHR_MAINTENANCE_2_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        layouts_.separateDepthStencilLayouts = VK_TRUE;
        return &layouts_;
    }

    /// What the device says about an image whose stencil has a usage of its own.
    VkResult ask(VkImageUsageFlags usage, VkImageUsageFlags stencilUsage) const {
        auto stencil = make<VkImageStencilUsageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_STENCIL_USAGE_CREATE_INFO);
        stencil.stencilUsage = stencilUsage;
        auto info = make<VkPhysicalDeviceImageFormatInfo2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2);
        info.pNext = &stencil;
        info.format = kFormat;
        info.type = VK_IMAGE_TYPE_2D;
        info.tiling = VK_IMAGE_TILING_OPTIMAL;
        info.usage = usage;
        auto properties = make<VkImageFormatProperties2>(VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2);
        const auto query = reinterpret_cast<PFN_vkGetPhysicalDeviceImageFormatProperties2KHR>(
            vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceImageFormatProperties2KHR"));
        return query(physicalDevice, &info, &properties);
    }

    /// A depth/stencil image with a view of both aspects.
    TestImage makeSeparate(VkImageUsageFlags usage, VkImageUsageFlags stencilUsage) {
        auto stencil = make<VkImageStencilUsageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_STENCIL_USAGE_CREATE_INFO);
        stencil.stencilUsage = stencilUsage;
        auto info = flatImage(kFormat, kExtent, usage);
        info.pNext = &stencil;
        TestImage result = makeImage(info);
        result.view = makeView(result.image, VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT);
        return result;
    }

    VkImageView makeView(VkImage image, VkImageAspectFlags aspects) {
        return DrawTest::makeView(image, VK_IMAGE_VIEW_TYPE_2D, kFormat, {aspects, 0, 1, 0, 1});
    }

    struct Aspect {
        VkAttachmentLoadOp load;
        VkImageLayout before, during, after;
    };
    /// A pass on the depth/stencil image alone, each aspect in layouts of its own.
    Pass makeAspectPass(const TestImage& image, const Aspect& depth, const Aspect& stencil) {
        auto stencilLayouts =
            make<VkAttachmentDescriptionStencilLayout>(VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_STENCIL_LAYOUT);
        stencilLayouts.stencilInitialLayout = stencil.before;
        stencilLayouts.stencilFinalLayout = stencil.after;
        auto attachment = make<VkAttachmentDescription2>(VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2);
        attachment.pNext = &stencilLayouts;
        attachment.format = kFormat;
        attachment.samples = VK_SAMPLE_COUNT_1_BIT;
        attachment.loadOp = depth.load;
        attachment.stencilLoadOp = stencil.load;
        attachment.initialLayout = depth.before;
        attachment.finalLayout = depth.after;
        auto stencilReference =
            make<VkAttachmentReferenceStencilLayout>(VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_STENCIL_LAYOUT);
        stencilReference.stencilLayout = stencil.during;
        auto reference = make<VkAttachmentReference2>(VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2);
        reference.pNext = &stencilReference;
        reference.layout = depth.during;
        reference.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
        auto subpass = make<VkSubpassDescription2>(VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2);
        subpass.pDepthStencilAttachment = &reference;
        auto info = make<VkRenderPassCreateInfo2>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2);
        info.attachmentCount = 1;
        info.pAttachments = &attachment;
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        Pass pass;
        pass.extent = kExtent;
        pass.clears.resize(1);
        pass.clears[0].depthStencil = {1, 3};
        EXPECT_EQ(command<PFN_vkCreateRenderPass2KHR>("vkCreateRenderPass2KHR")(device, &info, nullptr, &pass.pass),
                  VK_SUCCESS);
        makeFramebuffer(pass, {image.view});
        return pass;
    }

    /// Writes depths that fall from left to right, or compares with them, and replaces the stencil by `reference`.
    VkPipeline makeStencilPipeline(const Pass& pass, VkCompareOp compare, bool writesDepth, uint32_t reference) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.colorCount = 0;
        desc.depthTest = true;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, writesDepth ? R"(#version 450
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
    gl_Position = vec4(corner, 0.5 - corner.x * 0.5, 1);
})"
                                                                         : R"(#version 450
void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1); })");
        desc.change = [=](const PipelineStates& states) {
            states.raster.depthClampEnable = VK_TRUE;
            states.depth.depthCompareOp = compare;
            states.depth.depthWriteEnable = writesDepth ? VK_TRUE : VK_FALSE;
            states.depth.stencilTestEnable = VK_TRUE;
            states.depth.front = {
                VK_STENCIL_OP_KEEP, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff,
                reference};
            states.depth.back = states.depth.front;
        };
        return makePipeline(pass.pass, desc);
    }

    void draw(VkCommandBuffer commands, const Pass& pass, VkPipeline pipeline) {
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRenderPass(commands);
    }

  private:
    VkPhysicalDeviceSeparateDepthStencilLayoutsFeatures layouts_ =
        make<VkPhysicalDeviceSeparateDepthStencilLayoutsFeatures>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SEPARATE_DEPTH_STENCIL_LAYOUTS_FEATURES);
};

constexpr VkImageUsageFlags kAttachment = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                            kSource = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

TEST_F(AspectsTest, usagesOfBothAspectsAreAskedFor) {
    EXPECT_EQ(ask(kAttachment, kAttachment | VK_IMAGE_USAGE_SAMPLED_BIT), VK_SUCCESS);
    EXPECT_EQ(ask(kAttachment | VK_IMAGE_USAGE_SAMPLED_BIT, kAttachment), VK_SUCCESS);
    // Neither aspect can be stored to or be a colour attachment.
    EXPECT_EQ(ask(kAttachment, VK_IMAGE_USAGE_STORAGE_BIT), VK_ERROR_FORMAT_NOT_SUPPORTED);
    EXPECT_EQ(ask(kAttachment, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT), VK_ERROR_FORMAT_NOT_SUPPORTED);
    EXPECT_EQ(ask(VK_IMAGE_USAGE_STORAGE_BIT, kAttachment), VK_ERROR_FORMAT_NOT_SUPPORTED);
}

TEST_F(AspectsTest, stencilIsSampledWhereDepthIsNot) {
    const TestImage image = makeSeparate(kAttachment, kAttachment | VK_IMAGE_USAGE_SAMPLED_BIT);
    const VkImageView stencilView = makeView(image.image, VK_IMAGE_ASPECT_STENCIL_BIT);
    const Aspect cleared{VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED,
                         VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    const Pass write =
        makeAspectPass(image, cleared,
                       {VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED,
                        VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    const VkPipeline writing = makeStencilPipeline(write, VK_COMPARE_OP_GREATER, false, 77);

    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass show = makePass(color);
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                               VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    auto setInfo = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    setInfo.bindingCount = 1;
    setInfo.pBindings = &binding;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &setLayout), VK_SUCCESS);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorPool(device, &poolInfo, nullptr, &descriptors), VK_SUCCESS);
    const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([=, this] {
        vkDestroySampler(device, sampler, nullptr);
        vkDestroyDescriptorPool(device, descriptors, nullptr);
        vkDestroyDescriptorSetLayout(device, setLayout, nullptr);
    });
    auto allocation = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocation.descriptorPool = descriptors;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &setLayout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    ASSERT_EQ(vkAllocateDescriptorSets(device, &allocation, &set), VK_SUCCESS);
    const VkDescriptorImageInfo texture{sampler, stencilView, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    auto update = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    update.dstSet = set;
    update.descriptorCount = 1;
    update.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    update.pImageInfo = &texture;
    vkUpdateDescriptorSets(device, 1, &update, 0, nullptr);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = fullScreen();
    desc.layout = makeLayout({setLayout}, 0);
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(binding = 0) uniform usampler2D stencil;
layout(location = 0) out vec4 color;
void main() { color = vec4(float(texelFetch(stencil, ivec2(gl_FragCoord.xy), 0).r) / 255.0, 0, 0, 1); }
)");
    const VkPipeline showing = makePipeline(show.pass, desc);

    const VkCommandBuffer commands = begin();
    draw(commands, write, writing);
    changeLayout(commands, image.image, VK_IMAGE_ASPECT_STENCIL_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    beginPass(commands, show);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, showing);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    // Depth 0.5 is not greater than the clear value of 1: the first stencil stays.
    EXPECT_EQ(pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 5, 5), 0xFF000003u);
}

TEST_F(AspectsTest, depthIsReadWhileStencilIsWritten) {
    const TestImage image = makeSeparate(kAttachment | kSource, kAttachment | kSource);
    const auto kDepth = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, kStencil = VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL;
    const Pass first = makeAspectPass(image, {VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED, kDepth, kDepth},
                                      {VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED, kStencil, kStencil});
    const auto kDepthRead = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, kEnd = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const Pass second = makeAspectPass(image, {VK_ATTACHMENT_LOAD_OP_LOAD, kDepthRead, kDepthRead, kEnd},
                                       {VK_ATTACHMENT_LOAD_OP_LOAD, kStencil, kStencil, kEnd});
    const VkPipeline writing = makeStencilPipeline(first, VK_COMPARE_OP_ALWAYS, true, 5);
    const VkPipeline reading = makeStencilPipeline(second, VK_COMPARE_OP_LESS, false, 9);
    const VkCommandBuffer commands = begin();
    draw(commands, first, writing);
    changeLayout(commands, image.image, VK_IMAGE_ASPECT_DEPTH_BIT, kDepth, kDepthRead);
    changeLayout(commands, image.image, VK_IMAGE_ASPECT_STENCIL_BIT, kStencil, kStencil);
    draw(commands, second, reading);
    submit(commands);
    const auto depths = readImage(image, VK_IMAGE_ASPECT_DEPTH_BIT, 4);
    const auto stencils = readImage(image, VK_IMAGE_ASPECT_STENCIL_BIT, 1);
    for (uint32_t x = 0; x < kExtent.width; ++x) {
        float depth = 0;
        std::memcpy(&depth, depths.data() + 4 * (3 * kExtent.width + x), 4);
        const float expected = 1 - (static_cast<float>(x) + 0.5f) / static_cast<float>(kExtent.width);
        EXPECT_NEAR(depth, expected, 1e-6f) << x;
        EXPECT_EQ(stencils[3 * kExtent.width + x], expected > 0.5f ? 9 : 5) << x;
    }
}

}  // namespace
}  // namespace vernier::test
