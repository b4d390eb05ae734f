#include "conformance/drivers/vulkan_compute.h"

#include "conformance/drivers/try.h"

namespace vernier::conformance {

Result<StorageBuffers> bindStorageBuffers(VkDevice device, Cleanup& cleanup, std::span<const VulkanBuffer> buffers,
                                          uint32_t pushBytes) {
    const auto count = static_cast<uint32_t>(buffers.size());
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (uint32_t i = 0; i < count; ++i)
        bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    VkDescriptorSetLayoutCreateInfo setInfo{};
    setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    setInfo.bindingCount = count;
    setInfo.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &setLayout));
    cleanup.add([=] { vkDestroyDescriptorSetLayout(device, setLayout, nullptr); });

    StorageBuffers result;
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
    VkPipelineLayoutCreateInfo layoutInfo{};
    layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout;
    layoutInfo.pushConstantRangeCount = pushBytes != 0 ? 1 : 0;
    layoutInfo.pPushConstantRanges = &range;
    VERNIER_TRY_VK(vkCreatePipelineLayout(device, &layoutInfo, nullptr, &result.layout));
    cleanup.add([device, layout = result.layout] { vkDestroyPipelineLayout(device, layout, nullptr); });

    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count};
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool));
    cleanup.add([=] { vkDestroyDescriptorPool(device, pool, nullptr); });
    VkDescriptorSetAllocateInfo allocateInfo{};
    allocateInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocateInfo.descriptorPool = pool;
    allocateInfo.descriptorSetCount = 1;
    allocateInfo.pSetLayouts = &setLayout;
    VERNIER_TRY_VK(vkAllocateDescriptorSets(device, &allocateInfo, &result.set));
    for (uint32_t i = 0; i < count; ++i) {
        const VkDescriptorBufferInfo whole{buffers[i].handle, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = result.set;
        write.dstBinding = i;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &whole;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    return result;
}

Result<VkShaderModule> createShaderModule(VkDevice device, Cleanup& cleanup, std::span<const uint32_t> words) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = words.size_bytes();
    info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateShaderModule(device, &info, nullptr, &module));
    cleanup.add([=] { vkDestroyShaderModule(device, module, nullptr); });
    return module;
}

Result<VkPipeline> createComputePipeline(VkDevice device, Cleanup& cleanup, VkPipelineLayout layout,
                                         VkShaderModule module) {
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    cleanup.add([=] { vkDestroyPipeline(device, pipeline, nullptr); });
    return pipeline;
}

void computeBarrier(VkCommandBuffer commands, VkAccessFlags access, VkPipelineStageFlags stage) {
    VkMemoryBarrier memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    memory.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    memory.dstAccessMask = access;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, stage, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

}  // namespace vernier::conformance
