#include "tests/vulkan/test_compute.h"

#include "tests/vulkan/pipeline_states.h"

namespace vernier::test {

VkDescriptorSet ComputeTest::makeSet(const std::vector<TestDescriptor>& descriptors, VkDescriptorSetLayout* layout) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    std::vector<VkDescriptorPoolSize> sizes;
    for (const TestDescriptor& descriptor : descriptors) {
        bindings.push_back({static_cast<uint32_t>(bindings.size()), descriptor.type, 1, descriptor.stages,
                            descriptor.sampler != VK_NULL_HANDLE ? &descriptor.sampler : nullptr});
        sizes.push_back({descriptor.type, 1});
    }
    *layout = makeSetLayout(bindings);
    const VkDescriptorSet set = makeEmptySet(*layout, sizes);

    for (uint32_t i = 0; i < descriptors.size(); ++i) {
        const TestDescriptor& descriptor = descriptors[i];
        const VkDescriptorBufferInfo buffer{descriptor.buffer, 0, descriptor.range};
        const VkDescriptorImageInfo image{VK_NULL_HANDLE, descriptor.image, VK_IMAGE_LAYOUT_GENERAL};
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.dstBinding = i;
        write.descriptorCount = 1;
        write.descriptorType = descriptor.type;
        write.pBufferInfo = &buffer;
        write.pImageInfo = &image;
        write.pTexelBufferView = &descriptor.texels;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    return set;
}

ComputeTest::Compute ComputeTest::makeCompute(const std::string& glsl, const std::vector<TestDescriptor>& descriptors,
                                              uint32_t pushBytes, const VkSpecializationInfo* specialization,
                                              VkResult expected, VkPipelineCreateFlags flags) {
    Compute compute;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    compute.set = makeSet(descriptors, &setLayout);
    compute.layout = makeLayout({setLayout}, pushBytes, VK_SHADER_STAGE_COMPUTE_BIT);

    compute.pipeline = makeComputePipeline(compute.layout, glsl, specialization, expected, flags);
    return compute;
}

VkPipeline ComputeTest::makeComputePipeline(VkPipelineLayout layout, const std::string& glsl,
                                            const VkSpecializationInfo* specialization, VkResult expected,
                                            VkPipelineCreateFlags flags) {
    return makeComputePipeline(layout, makeShader(VK_SHADER_STAGE_COMPUTE_BIT, glsl), specialization, expected, flags);
}

VkPipeline ComputeTest::makeComputePipeline(VkPipelineLayout layout, VkShaderModule shader,
                                            const VkSpecializationInfo* specialization, VkResult expected,
                                            VkPipelineCreateFlags flags) {
    auto info = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.flags = flags;
    info.stage = stageOf(VK_SHADER_STAGE_COMPUTE_BIT, shader, specialization);
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), expected)
        << (messages.empty() ? "" : messages.back());
    defer([this, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });
    return pipeline;
}

VkBufferView ComputeTest::makeTexels(const TestBuffer& buffer, VkFormat format, VkDeviceSize offset,
                                     VkDeviceSize range) {
    auto info = make<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
    info.buffer = buffer.buffer;
    info.format = format;
    info.offset = offset;
    info.range = range;
    VkBufferView view = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateBufferView(device, &info, nullptr, &view), VK_SUCCESS);
    defer([this, view] { vkDestroyBufferView(device, view, nullptr); });
    return view;
}

void ComputeTest::bind(VkCommandBuffer commands, const Compute& compute) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.layout, 0, 1, &compute.set, 0, nullptr);
}

void ComputeTest::dispatch(VkCommandBuffer commands, const Compute& compute, uint32_t x, uint32_t y, uint32_t z) {
    bind(commands, compute);
    vkCmdDispatch(commands, x, y, z);
    makeVisible(commands);
}

void ComputeTest::makeVisible(VkCommandBuffer commands) {
    auto barrier = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0,
                         nullptr);
}

void ComputeTest::toGeneral(VkCommandBuffer commands, const TestImage& image, VkImageLayout from) {
    changeLayout(commands, image.image, VK_IMAGE_ASPECT_COLOR_BIT, from, VK_IMAGE_LAYOUT_GENERAL);
}

void ComputeTest::run(const Compute& compute, uint32_t x, uint32_t y, uint32_t z) {
    const VkCommandBuffer commands = begin();
    dispatch(commands, compute, x, y, z);
    submit(commands);
}

}  // namespace vernier::test
