// Looking at a texture: a draw whose fragments each sample it once.
#include <algorithm>
#include <cstring>

#include "tests/peers/texture_lab_parts.h"
#include "tests/vulkan/pipeline_states.h"

namespace vernier::test {

std::vector<Vec4> TextureLab::look(const LabImage& image, const LabSampler& sampler, const std::string& samplerType,
                                   const std::string& glsl, const std::vector<Vec4>& inputs, VkExtent2D extent) {
    constexpr VkFormat kTarget = VK_FORMAT_R32G32B32A32_SFLOAT;
    const uint32_t count = extent.width * extent.height;
    const Texture texture = makeTexture(image, sampler);
    const Texture target = makeTarget(kTarget, extent);
    const Block in = allocate(std::max<size_t>(inputs.size(), 1) * sizeof(Vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    std::copy(inputs.begin(), inputs.end(), static_cast<Vec4*>(static_cast<void*>(in.data)));
    const Block out = allocate(count * sizeof(Vec4), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkShaderModule vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0, 1); })");
    const VkShaderModule fragment = makeShader(
        VK_SHADER_STAGE_FRAGMENT_BIT,
        "#version 450\n#extension GL_EXT_samplerless_texture_functions : enable\nlayout(binding = 0) uniform " +
            samplerType +
            " tex;\nlayout(binding = 1) readonly buffer In { vec4 v[]; } input_;\nlayout(location = 0) out vec4 "
            "color_;\n"
            "vec4 in_(int i) { return input_.v[i]; }\nvec4 look(ivec2 at, int i) {\n" +
            glsl + "\n}\nvoid main() { ivec2 at = ivec2(gl_FragCoord.xy); color_ = look(at, at.y * " +
            std::to_string(extent.width) + " + at.x); }\n");

    constexpr VkDescriptorType kTypes[2] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    VkDescriptorSetLayoutBinding bindings[2]{};
    for (uint32_t i = 0; i < 2; ++i) bindings[i] = {i, kTypes[i], 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    auto layoutInfo = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layoutInfo.bindingCount = 2;
    layoutInfo.pBindings = bindings;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateDescriptorSetLayout(device_, &layoutInfo, nullptr, &setLayout));
    const VkDescriptorPoolSize sizes[2] = {{kTypes[0], 1}, {kTypes[1], 1}};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 2;
    poolInfo.pPoolSizes = sizes;
    VkDescriptorPool descriptorPool = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateDescriptorPool(device_, &poolInfo, nullptr, &descriptorPool));
    auto setInfo = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    setInfo.descriptorPool = descriptorPool;
    setInfo.descriptorSetCount = 1;
    setInfo.pSetLayouts = &setLayout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    LAB_CHECK(vkAllocateDescriptorSets(device_, &setInfo, &set));
    const VkDescriptorImageInfo imageInfo{texture.sampler, texture.view, VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo bufferInfo{in.buffer, 0, VK_WHOLE_SIZE};
    for (uint32_t i = 0; i < 2; ++i) {
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.dstBinding = i;
        write.descriptorCount = 1;
        write.descriptorType = kTypes[i];
        write.pImageInfo = &imageInfo;
        write.pBufferInfo = &bufferInfo;
        vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    }
    auto pipelineLayoutInfo = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    pipelineLayoutInfo.setLayoutCount = 1;
    pipelineLayoutInfo.pSetLayouts = &setLayout;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    LAB_CHECK(vkCreatePipelineLayout(device_, &pipelineLayoutInfo, nullptr, &layout));

    VkAttachmentDescription attachment{};
    attachment.format = kTarget;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    const VkSubpassDependency dependency{0,
                                         VK_SUBPASS_EXTERNAL,
                                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         VK_PIPELINE_STAGE_TRANSFER_BIT,
                                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                         VK_ACCESS_TRANSFER_READ_BIT,
                                         0};
    auto passInfo = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    passInfo.attachmentCount = 1;
    passInfo.pAttachments = &attachment;
    passInfo.subpassCount = 1;
    passInfo.pSubpasses = &subpass;
    passInfo.dependencyCount = 1;
    passInfo.pDependencies = &dependency;
    VkRenderPass pass = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateRenderPass(device_, &passInfo, nullptr, &pass));
    auto framebufferInfo = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    framebufferInfo.renderPass = pass;
    framebufferInfo.attachmentCount = 1;
    framebufferInfo.pAttachments = &target.view;
    framebufferInfo.width = extent.width;
    framebufferInfo.height = extent.height;
    framebufferInfo.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateFramebuffer(device_, &framebufferInfo, nullptr, &framebuffer));
    const VkPipeline pipeline = makePipeline(vertex, fragment, layout, pass, extent);

    const VkCommandBuffer commands = begin();
    auto beginInfo = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    beginInfo.renderPass = pass;
    beginInfo.framebuffer = framebuffer;
    beginInfo.renderArea.extent = extent;
    vkCmdBeginRenderPass(commands, &beginInfo, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyImageToBuffer(commands, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, out.buffer, 1, &copy);
    auto barrier = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                         nullptr, 0, nullptr);
    submit(commands);
    std::vector<Vec4> result(count);
    std::memcpy(result.data(), out.data, count * sizeof(Vec4));

    vkDestroyPipeline(device_, pipeline, nullptr);
    vkDestroyFramebuffer(device_, framebuffer, nullptr);
    vkDestroyRenderPass(device_, pass, nullptr);
    vkDestroyPipelineLayout(device_, layout, nullptr);
    vkDestroyDescriptorPool(device_, descriptorPool, nullptr);
    vkDestroyDescriptorSetLayout(device_, setLayout, nullptr);
    vkDestroyShaderModule(device_, vertex, nullptr);
    vkDestroyShaderModule(device_, fragment, nullptr);
    destroy(in);
    destroy(out);
    destroy(target);
    destroy(texture);
    return result;
}

VkPipeline TextureLab::makePipeline(VkShaderModule vertex, VkShaderModule fragment, VkPipelineLayout layout,
                                    VkRenderPass pass, VkExtent2D extent) {
    const VkPipelineShaderStageCreateInfo stages[] = {stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                                      stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
    const PlainStates states(extent);
    const auto info = states.with(stages, layout, pass);
    VkPipeline pipeline = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    return pipeline;
}

}  // namespace vernier::test
