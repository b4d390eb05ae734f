// Draws through the whole driver, read back: triangles, buffers, descriptors, push constants, indirect draws,
// queries, and pipelines that cannot be made.
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr uint32_t kRed = 0xFF0000FFu, kGreen = 0xFF00FF00u, kBlue = 0xFFFF0000u;
constexpr VkExtent2D kExtent{32, 24};

class PictureTest : public DrawTest {
  protected:
    void SetUp() override {
        DrawTest::SetUp();
        color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        pass = makePass(color);
    }
    PipelineDesc defaults() {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = fullScreen();
        return desc;
    }
    std::vector<uint8_t> read() { return readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4); }
    /// Records `draws` inside the pass, runs it and returns the picture.
    template <class Draws>
    std::vector<uint8_t> render(Draws&& draws) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        draws(commands);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return read();
    }

    TestImage color;
    Pass pass;
};

TEST_F(PictureTest, triangleCoversItsHalf) {
    PipelineDesc desc = defaults();
    desc.bindings = {{0, 8, VK_VERTEX_INPUT_RATE_VERTEX}};
    desc.attributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, 0}};
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) in vec2 position;
void main() { gl_Position = vec4(position, 0, 1); })");
    desc.fragment = constantColor("1, 0, 0, 1");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer vertices = makeBuffer(24, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    const float corners[] = {-1, -1, 1, -1, -1, 1};  // the upper left half
    std::memcpy(vertices.data, corners, sizeof corners);
    const TestBuffer indices = makeBuffer(6, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const uint16_t order[] = {2, 0, 1};
    std::memcpy(indices.data, order, sizeof order);
    const VkDeviceSize offset = 0;
    for (const bool indexed : {false, true}) {
        const auto texels = render([&](VkCommandBuffer commands) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            vkCmdBindVertexBuffers(commands, 0, 1, &vertices.buffer, &offset);
            if (indexed) {
                vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
                vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
            } else {
                vkCmdDraw(commands, 3, 1, 0, 0);
            }
        });
        // Pixel centres strictly on one side of the diagonal (x+.5)/32 + (y+.5)/24 = 1; none lies on it.
        for (uint32_t y = 0; y < kExtent.height; ++y) {
            for (uint32_t x = 0; x < kExtent.width; ++x) {
                const uint32_t side = 24 * (2 * x + 1) + 32 * (2 * y + 1);
                if (side == 2 * 24 * 32) continue;
                ASSERT_EQ(pixelAt(texels, color, x, y), side < 2 * 24 * 32 ? kRed : 0u) << x << ", " << y;
            }
        }
    }
}

TEST_F(PictureTest, pushConstantsAndDynamicState) {
    PipelineDesc desc = defaults();
    desc.layout = makeLayout({}, 16);
    desc.dynamic = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(push_constant) uniform P { vec4 tint; };
layout(location = 0) out vec4 color;
void main() { color = tint; })");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const auto texels = render([&](VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        const VkViewport viewport{0, 0, 32, 24, 0, 1};
        vkCmdSetViewport(commands, 0, 1, &viewport);
        for (int i = 0; i < 2; ++i) {
            const float tint[] = {i == 0 ? 1.0f : 0.0f, i == 0 ? 0.0f : 1.0f, 0, 1};
            const VkRect2D scissor{{i * 16, 0}, {16, 12}};
            vkCmdSetScissor(commands, 0, 1, &scissor);
            vkCmdPushConstants(commands, desc.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, 16,
                               tint);
            vkCmdDraw(commands, 3, 1, 0, 0);
        }
    });
    EXPECT_EQ(pixelAt(texels, color, 15, 11), kRed);
    EXPECT_EQ(pixelAt(texels, color, 16, 11), kGreen);
    EXPECT_EQ(pixelAt(texels, color, 15, 12), 0u);
}

TEST_F(PictureTest, descriptorsWithDynamicOffsetsAndTextures) {
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}};
    auto layoutInfo = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layoutInfo.bindingCount = 2;
    layoutInfo.pBindings = bindings;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorSetLayout(device, &layoutInfo, nullptr, &setLayout), VK_SUCCESS);
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 2},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2}};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 2;
    poolInfo.poolSizeCount = 2;
    poolInfo.pPoolSizes = sizes;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorPool(device, &poolInfo, nullptr, &descriptors), VK_SUCCESS);
    const VkDescriptorSetLayout setLayouts[] = {setLayout, setLayout};
    auto allocation = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocation.descriptorPool = descriptors;
    allocation.descriptorSetCount = 2;
    allocation.pSetLayouts = setLayouts;
    VkDescriptorSet sets[2] = {};
    ASSERT_EQ(vkAllocateDescriptorSets(device, &allocation, sets), VK_SUCCESS);
    auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([=, this] {
        vkDestroySampler(device, sampler, nullptr);
        vkDestroyDescriptorPool(device, descriptors, nullptr);
        vkDestroyDescriptorSetLayout(device, setLayout, nullptr);
    });

    const TestBuffer uniforms = makeBuffer(512, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const float factors[] = {1, 0, 0, 1};
    std::memcpy(static_cast<std::byte*>(uniforms.data) + 256, factors, sizeof factors);
    const TestImage texture = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_SAMPLED_BIT);

    const VkDescriptorBufferInfo buffer{uniforms.buffer, 0, 16};
    const VkDescriptorImageInfo image{sampler, texture.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet writes[2] = {make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET),
                                      make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET)};
    writes[0].dstSet = writes[1].dstSet = sets[0];
    writes[0].descriptorCount = writes[1].descriptorCount = 1;
    writes[0].descriptorType = bindings[0].descriptorType;
    writes[0].pBufferInfo = &buffer;
    writes[1].dstBinding = 3;
    writes[1].descriptorType = bindings[1].descriptorType;
    writes[1].pImageInfo = &image;
    vkUpdateDescriptorSets(device, 2, writes, 0, nullptr);
    VkCopyDescriptorSet copies[2] = {make<VkCopyDescriptorSet>(VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET),
                                     make<VkCopyDescriptorSet>(VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET)};
    for (int i = 0; i < 2; ++i) {
        copies[i].srcSet = sets[0];
        copies[i].dstSet = sets[1];
        copies[i].srcBinding = copies[i].dstBinding = bindings[i].binding;
        copies[i].descriptorCount = 1;
    }
    vkUpdateDescriptorSets(device, 0, nullptr, 2, copies);

    PipelineDesc desc = defaults();
    desc.layout = makeLayout({setLayout}, 0);
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(set = 0, binding = 0) uniform U { vec4 factor; };
layout(set = 0, binding = 3) uniform sampler2D image;
layout(location = 0) out vec4 color;
void main() { color = factor * texture(image, gl_FragCoord.xy / vec2(32, 24)); })");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    const VkClearColorValue white{{1, 1, 1, 1}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                                      VK_REMAINING_ARRAY_LAYERS};
    auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.image = texture.image;
    barrier.subresourceRange = all;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                         nullptr, 1, &barrier);
    vkCmdClearColorImage(commands, texture.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &white, 1, &all);
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr,
                         0, nullptr, 1, &barrier);
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    const uint32_t offset = 256;
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &sets[1], 1, &offset);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_EQ(pixelAt(read(), color, 16, 12), kRed);
}

TEST_F(PictureTest, indirectDrawsAndInstances) {
    PipelineDesc desc = defaults();
    // Instance i covers columns 8i .. 8i+7.
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    vec2 p = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(-1 + 0.5 * (gl_InstanceIndex + p.x), p.y * 4 - 1, 0, 1);
})");
    desc.fragment = constantColor("0, 1, 0, 1");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer arguments = makeBuffer(64, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    const VkDrawIndirectCommand draws[] = {{3, 1, 0, 0}, {3, 1, 0, 2}};  // triangles: half of the columns each
    std::memcpy(arguments.data, draws, sizeof draws);
    const auto texels = render([&](VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDrawIndirect(commands, arguments.buffer, 0, 2, sizeof(VkDrawIndirectCommand));
    });
    EXPECT_EQ(pixelAt(texels, color, 0, 1), kGreen);
    EXPECT_EQ(pixelAt(texels, color, 10, 1), 0u);
    EXPECT_EQ(pixelAt(texels, color, 16, 1), kGreen);
    EXPECT_EQ(pixelAt(texels, color, 26, 1), 0u);
}

TEST_F(PictureTest, secondaryCommandBuffersAndClears) {
    PipelineDesc desc = defaults();
    desc.fragment = constantColor("0, 0, 1, 1");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer secondary = makeCommands(VK_COMMAND_BUFFER_LEVEL_SECONDARY);
    auto inheritance = make<VkCommandBufferInheritanceInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO);
    inheritance.renderPass = pass.pass;
    auto info = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT;
    info.pInheritanceInfo = &inheritance;
    ASSERT_EQ(vkBeginCommandBuffer(secondary, &info), VK_SUCCESS);
    vkCmdBindPipeline(secondary, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(secondary, 3, 1, 0, 0);
    VkClearAttachment clear{};
    clear.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    clear.clearValue.color = {{1, 0, 0, 1}};
    const VkClearRect rect{{{4, 4}, {3, 2}}, 0, 1};
    vkCmdClearAttachments(secondary, 1, &clear, 1, &rect);
    ASSERT_EQ(vkEndCommandBuffer(secondary), VK_SUCCESS);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass, VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS);
    vkCmdExecuteCommands(commands, 1, &secondary);
    vkCmdEndRenderPass(commands);
    submit(commands);
    const auto texels = read();
    EXPECT_EQ(pixelAt(texels, color, 3, 4), kBlue);
    EXPECT_EQ(pixelAt(texels, color, 4, 4), kRed);
    EXPECT_EQ(pixelAt(texels, color, 6, 5), kRed);
    EXPECT_EQ(pixelAt(texels, color, 7, 5), kBlue);
    EXPECT_EQ(pixelAt(texels, color, 4, 6), kBlue);
}

TEST_F(PictureTest, queriesCountSamplesAndInvocations) {
    const VkQueryPool occlusion = makeQueries(VK_QUERY_TYPE_OCCLUSION, 2);
    const VkQueryPool statistics = makeQueries(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1,
                                               VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
                                                   VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
                                                   VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT);
    PipelineDesc desc = defaults();
    desc.fragment = constantColor("gl_FragCoord.x / 32, 0, 0, 1");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, occlusion, 0, 2);
    vkCmdResetQueryPool(commands, statistics, 0, 1);
    vkCmdBeginQuery(commands, statistics, 0, 0);
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBeginQuery(commands, occlusion, 0, VK_QUERY_CONTROL_PRECISE_BIT);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndQuery(commands, occlusion, 0);
    vkCmdBeginQuery(commands, occlusion, 1, VK_QUERY_CONTROL_PRECISE_BIT);
    vkCmdEndQuery(commands, occlusion, 1);
    vkCmdEndRenderPass(commands);
    vkCmdEndQuery(commands, statistics, 0);
    submit(commands);
    uint64_t passed[2] = {7, 7}, counted[3] = {};
    ASSERT_EQ(vkGetQueryPoolResults(device, occlusion, 0, 2, sizeof passed, passed, 8, VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    EXPECT_EQ(passed[0], uint64_t{kExtent.width} * kExtent.height);
    EXPECT_EQ(passed[1], 0u);
    ASSERT_EQ(vkGetQueryPoolResults(device, statistics, 0, 1, sizeof counted, counted, sizeof counted,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              VK_SUCCESS);
    EXPECT_EQ(counted[0], 3u);
    EXPECT_EQ(counted[1], 1u);
    EXPECT_GE(counted[2], uint64_t{kExtent.width} * kExtent.height);
}

TEST_F(PictureTest, specializationConstants) {
    PipelineDesc desc = defaults();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(constant_id = 4) const float green = 0;
layout(location = 0) out vec4 color;
void main() { color = vec4(0, green, 0, 1); })");
    const float one = 1;
    const VkSpecializationMapEntry entry{4, 0, sizeof one};
    const VkSpecializationInfo special{1, &entry, sizeof one, &one};
    desc.specialization = &special;
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const auto texels = render([&](VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, 0);
    });
    EXPECT_EQ(pixelAt(texels, color, 5, 5), kGreen);
}

TEST_F(PictureTest, badShadersFailAndTheDeviceGoesOn) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const uint32_t garbage[] = {0x07230203, 0x00010000, 0, 10, 0, 0xFFFF0001, 3};
    auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = sizeof garbage;
    info.pCode = garbage;
    VkShaderModule broken = VK_NULL_HANDLE;
    PipelineDesc desc = defaults();
    if (vkCreateShaderModule(device, &info, nullptr, &broken) == VK_SUCCESS) {
        desc.fragment = broken;
        EXPECT_EQ(makePipeline(pass.pass, desc, VK_ERROR_UNKNOWN), VkPipeline{VK_NULL_HANDLE});
        vkDestroyShaderModule(device, broken, nullptr);
    }
    // Legal SPIR-V that the driver has no support for: sparse residency.
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
#extension GL_ARB_sparse_texture2 : require
layout(set = 0, binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 color;
void main() { sparseTextureARB(source, vec2(0.5), color); })");
    EXPECT_EQ(makePipeline(pass.pass, desc, VK_ERROR_FEATURE_NOT_PRESENT), VkPipeline{VK_NULL_HANDLE});
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages.back().find("SparseResidency"), std::string::npos) << messages.back();

    desc.fragment = constantColor("1, 0, 0, 1");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const auto texels = render([&](VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, 0);
    });
    EXPECT_EQ(pixelAt(texels, color, 0, 0), kRed);
}

TEST_F(PictureTest, drawingWithAPipelineForOtherAttachmentsIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestImage wide = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass other = makePass(wide);
    PipelineDesc desc = defaults();
    desc.fragment = constantColor("1, 0, 0, 1");
    const VkPipeline pipeline = makePipeline(other.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    EXPECT_NE(vkEndCommandBuffer(commands), VK_SUCCESS);
    auto submitInfo = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submitInfo.commandBufferCount = 1;
    submitInfo.pCommandBuffers = &commands;
    EXPECT_NE(vkQueueSubmit(queue, 1, &submitInfo, VK_NULL_HANDLE), VK_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
