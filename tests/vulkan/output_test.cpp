// What becomes of fragments: dual-source blending, alpha to one, depth bounds, resolves of depth and stencil; and
// arrays of descriptors indexed at run time.
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{32, 16};
constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

class OutputTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_MULTIVIEW_EXTENSION_NAME, VK_KHR_MAINTENANCE_2_EXTENSION_NAME,
                VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME, VK_KHR_DEPTH_STENCIL_RESOLVE_EXTENSION_NAME};
    }
    PipelineDesc defaults(const std::string& z = "0.5") {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = fullScreen(z);
        return desc;
    }
    void draw(const Pass& pass, const std::vector<VkPipeline>& pipelines,
              const std::function<void(VkCommandBuffer)>& before = {}) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        for (const VkPipeline pipeline : pipelines) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            if (before) before(commands);
            vkCmdDraw(commands, 3, 1, 0, 0);
        }
        vkCmdEndRenderPass(commands);
        submit(commands);
    }
};

TEST_F(OutputTest, dualSourceBlending) {
    const TestImage color = makeImage(kFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    Pass pass = makePass(color);
    pass.clears[0].color = {{0.5f, 1, 0.25f, 0.5f}};
    PipelineDesc desc = defaults();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0, index = 0) out vec4 first;
layout(location = 0, index = 1) out vec4 second;
void main() { first = vec4(0.2, 0.4, 0.6, 0.8); second = vec4(0, 0.5, 1, 0.25); })");
    desc.change = [](const PipelineStates& states) {
        auto& blend = states.blends[0];
        blend.blendEnable = VK_TRUE;
        blend.srcColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR;
        blend.dstColorBlendFactor = VK_BLEND_FACTOR_SRC1_COLOR;
        blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC1_ALPHA;
        blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA;
    };
    draw(pass, {makePipeline(pass.pass, desc)});
    const uint32_t pixel = pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 5, 5);
    const double expected[] = {0.2, 0.5 * 0.4 + 0.5 * 1, 0.25, 0.25 * 0.8 + 0.75 * 0.5};
    for (uint32_t c = 0; c < 4; ++c) EXPECT_NEAR(pixel >> (8 * c) & 0xFF, expected[c] * 255, 1) << c;
}

TEST_F(OutputTest, alphaToOneAndToCoverage) {
    const TestImage color = makeImage(kFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
    const TestImage resolved = makeImage(kFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color, nullptr, &resolved);
    for (const bool toCoverage : {false, true}) {
        PipelineDesc desc = defaults();
        desc.samples = VK_SAMPLE_COUNT_4_BIT;
        desc.fragment = constantColor("1, 1, 1, 0.25");
        desc.change = [&](const PipelineStates& states) {
            states.multisample.alphaToOneEnable = VK_TRUE;
            states.multisample.alphaToCoverageEnable = toCoverage ? VK_TRUE : VK_FALSE;
        };
        draw(pass, {makePipeline(pass.pass, desc)});
        const uint32_t pixel = pixelAt(readImage(resolved, VK_IMAGE_ASPECT_COLOR_BIT, 4), resolved, 5, 5);
        // Coverage comes from the alpha before it becomes one: a quarter of the samples.
        EXPECT_EQ(pixel >> 24, toCoverage ? 64u : 255u);
        EXPECT_EQ(pixel & 0xFF, toCoverage ? 64u : 255u);
    }
}

TEST_F(OutputTest, depthBounds) {
    const TestImage color = makeImage(kFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const TestImage depth = makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    const Pass pass = makePass(color, &depth);
    // Depth p.x / 8 + 0.5: from 3/8 at the left edge to 5/8 at the right one.
    PipelineDesc slope = defaults("0.5 + p.x / 8");
    slope.depthTest = true;
    slope.fragment = constantColor("0");
    slope.dynamic = {VK_DYNAMIC_STATE_DEPTH_BOUNDS};
    PipelineDesc bounded = defaults();
    bounded.fragment = constantColor("1");
    bounded.dynamic = {VK_DYNAMIC_STATE_DEPTH_BOUNDS};
    bounded.change = [](const PipelineStates& states) { states.depth.depthBoundsTestEnable = VK_TRUE; };
    draw(pass, {makePipeline(pass.pass, slope), makePipeline(pass.pass, bounded)}, [](VkCommandBuffer commands) {
        vkCmdSetDepthBounds(commands, 0.4375f, 0.5f);  // p.x from -1/2 to 0
    });
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t x = 0; x < kExtent.width; ++x)
        EXPECT_EQ(pixelAt(texels, color, x, 8) & 0xFF, x >= 8 && x < 16 ? 255u : 0u) << x;
}

TEST_F(OutputTest, depthAndStencilResolve) {
    constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT_S8_UINT;
    constexpr VkImageAspectFlags kBoth = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    struct Case {
        VkResolveModeFlagBits depth, stencil;
        float z;
        uint8_t value;
    };
    // Sample 0 gets depth 0.25 and stencil 9, the others stay at 1 and 5. What is not resolved stays 0.5 and 77.
    for (const Case& c : {Case{VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, 0.25f, 9},
                          {VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MAX_BIT, 0.25f, 9},
                          {VK_RESOLVE_MODE_MAX_BIT, VK_RESOLVE_MODE_MIN_BIT, 1, 5},
                          {VK_RESOLVE_MODE_AVERAGE_BIT, VK_RESOLVE_MODE_NONE, 0.8125f, 77},
                          {VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_MIN_BIT, 0.5f, 5}}) {
        const TestImage image =
            makeImage(kDepth, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
        const TestImage resolved = makeImage(kDepth, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        std::vector<VkAttachmentDescription2> attachments(
            2, make<VkAttachmentDescription2>(VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2));
        for (auto& attachment : attachments) {
            attachment.format = kDepth;
            attachment.samples = VK_SAMPLE_COUNT_4_BIT;
            attachment.loadOp = attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            attachment.storeOp = attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
            attachment.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        }
        attachments[1].samples = VK_SAMPLE_COUNT_1_BIT;
        attachments[1].loadOp = attachments[1].stencilLoadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
        attachments[1].initialLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        auto reference = make<VkAttachmentReference2>(VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2);
        reference.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        reference.aspectMask = kBoth;
        VkAttachmentReference2 target = reference;
        target.attachment = 1;
        auto resolve =
            make<VkSubpassDescriptionDepthStencilResolve>(VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE);
        resolve.depthResolveMode = c.depth;
        resolve.stencilResolveMode = c.stencil;
        resolve.pDepthStencilResolveAttachment = &target;
        auto subpass = make<VkSubpassDescription2>(VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2);
        subpass.pNext = &resolve;
        subpass.pDepthStencilAttachment = &reference;
        auto info = make<VkRenderPassCreateInfo2>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2);
        info.attachmentCount = 2;
        info.pAttachments = attachments.data();
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        Pass pass;
        pass.extent = kExtent;
        pass.clears.resize(1);
        pass.clears[0].depthStencil = {1, 5};
        ASSERT_EQ(command<PFN_vkCreateRenderPass2KHR>("vkCreateRenderPass2KHR")(device, &info, nullptr, &pass.pass),
                  VK_SUCCESS);
        makeFramebuffer(pass, {image.view, resolved.view});
        PipelineDesc desc = defaults("0.25");
        desc.samples = VK_SAMPLE_COUNT_4_BIT;
        desc.depthTest = true;
        desc.colorCount = 0;
        const VkSampleMask first = 1;
        desc.change = [&](const PipelineStates& states) {
            states.multisample.pSampleMask = &first;
            states.depth.stencilTestEnable = VK_TRUE;
            states.depth.front = {
                VK_STENCIL_OP_KEEP, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xFF, 0xFF, 9};
            states.depth.back = states.depth.front;
        };
        const VkPipeline pipeline = makePipeline(pass.pass, desc);

        const VkCommandBuffer commands = begin();
        auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
        barrier.image = resolved.image;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.subresourceRange = {kBoth, 0, 1, 0, 1};
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr,
                             0, nullptr, 1, &barrier);
        const VkClearDepthStencilValue before{0.5f, 77};
        vkCmdClearDepthStencilImage(commands, resolved.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &before, 1,
                                    &barrier.subresourceRange);
        auto beginInfo = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
        beginInfo.renderPass = pass.pass;
        beginInfo.framebuffer = pass.framebuffer;
        beginInfo.renderArea.extent = kExtent;
        beginInfo.clearValueCount = 1;
        beginInfo.pClearValues = pass.clears.data();
        const auto subpassBegin = make<VkSubpassBeginInfo>(VK_STRUCTURE_TYPE_SUBPASS_BEGIN_INFO);
        const auto subpassEnd = make<VkSubpassEndInfo>(VK_STRUCTURE_TYPE_SUBPASS_END_INFO);
        command<PFN_vkCmdBeginRenderPass2KHR>("vkCmdBeginRenderPass2KHR")(commands, &beginInfo, &subpassBegin);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, 0);
        command<PFN_vkCmdEndRenderPass2KHR>("vkCmdEndRenderPass2KHR")(commands, &subpassEnd);
        submit(commands);
        float z = 0;
        std::memcpy(&z, readImage(resolved, VK_IMAGE_ASPECT_DEPTH_BIT, 4).data() + 4 * 40, 4);
        EXPECT_EQ(z, c.z) << c.depth;
        EXPECT_EQ(readImage(resolved, VK_IMAGE_ASPECT_STENCIL_BIT, 1)[40], c.value) << c.stencil;
    }
}

TEST_F(OutputTest, descriptorArraysAreIndexedAtRunTime) {
    const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    std::vector<VkDescriptorPoolSize> sizes;
    for (uint32_t b = 0; b < 4; ++b) {
        bindings.push_back({b, types[b], 3, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
        sizes.push_back({types[b], 3});
    }
    const VkDescriptorSetLayout setLayout = makeSetLayout(bindings);
    const VkDescriptorSet set = makeEmptySet(setLayout, sizes);
    const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([=, this] { vkDestroySampler(device, sampler, nullptr); });

    // Element n of each array holds n + 1 in its own channel, times 20.
    const VkCommandBuffer setUp = begin();
    for (uint32_t n = 0; n < 3; ++n) {
        const float value = static_cast<float>(20 * (n + 1)) / 255;
        VkDescriptorBufferInfo buffers[2];
        VkDescriptorImageInfo images[2];
        for (uint32_t b = 0; b < 2; ++b) {
            const TestBuffer buffer =
                makeBuffer(16, b == 0 ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
            std::memcpy(buffer.data, &value, sizeof value);
            buffers[b] = {buffer.buffer, 0, VK_WHOLE_SIZE};
            const TestImage image = makeImage(VK_FORMAT_R32_SFLOAT, {1, 1},
                                              b == 0 ? VK_IMAGE_USAGE_SAMPLED_BIT : VK_IMAGE_USAGE_STORAGE_BIT);
            auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
            barrier.image = image.image;
            barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
            barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT;
            vkCmdPipelineBarrier(setUp, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                                 nullptr, 0, nullptr, 1, &barrier);
            const VkClearColorValue color{{value, 0, 0, 0}};
            vkCmdClearColorImage(setUp, image.image, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &barrier.subresourceRange);
            images[b] = {sampler, image.view, VK_IMAGE_LAYOUT_GENERAL};
        }
        for (uint32_t b = 0; b < 4; ++b) {
            auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
            write.dstSet = set;
            write.dstBinding = b;
            write.dstArrayElement = n;
            write.descriptorCount = 1;
            write.descriptorType = types[b];
            write.pBufferInfo = b < 2 ? &buffers[b] : nullptr;
            write.pImageInfo = b >= 2 ? &images[b - 2] : nullptr;
            vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        }
    }
    submit(setUp);

    const TestImage color = makeImage(kFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc = defaults();
    desc.layout = makeLayout({setLayout}, 16);
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(push_constant) uniform P { ivec4 index; };
layout(binding = 0) uniform U { float value; } uniforms[3];
layout(binding = 1) readonly buffer S { float value; } storage[3];
layout(binding = 2) uniform sampler2D textures[3];
layout(binding = 3, r32f) readonly uniform image2D images[3];
layout(location = 0) out vec4 color;
void main() {
    color = vec4(uniforms[index.x].value, storage[index.y].value, texelFetch(textures[index.z], ivec2(0), 0).r,
                 imageLoad(images[index.w], ivec2(0)).r);
})");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    for (const std::array<int32_t, 4> index : {std::array{0, 1, 2, 0}, {2, 0, 1, 2}, {1, 2, 0, 1}}) {
        draw(pass, {pipeline}, [&](VkCommandBuffer commands) {
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
            vkCmdPushConstants(commands, desc.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, 16,
                               index.data());
        });
        const uint32_t pixel = pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 5, 5);
        for (uint32_t c = 0; c < 4; ++c)
            EXPECT_EQ(pixel >> (8 * c) & 0xFF, 20u * (static_cast<uint32_t>(index[c]) + 1)) << c;
    }
}

}  // namespace
}  // namespace vernier::test
