// The same calls as a compute shader of whatever Vulkan driver the loader finds.
#include <algorithm>

#include "conformance/drivers/vulkan_resources.h"
#include "conformance/precision/evaluator.h"
#include "conformance/precision/glsl.h"

namespace vernier::precision {

using conformance::Cleanup;
using conformance::VulkanBuffer;

struct VulkanRunner::Impl {
    conformance::VulkanContext context;
    conformance::VulkanResources resources{context};
    VulkanBuffer input, output;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPipelineLayout pipelineLayout = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;

    static constexpr size_t kCalls = size_t{1} << 16;
    static constexpr uint32_t kGroup = 64;
    static constexpr size_t kResultWords = std::tuple_size_v<Results>;

    Status create() {
        VERNIER_TRY(context.create({}));
        VERNIER_TRY(resources.create({}));
        auto buffer =
            resources.createHostBuffer(kCalls * kMaxOperands * sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        if (!buffer) return buffer.error();
        input = *buffer;
        buffer = resources.createHostBuffer(kCalls * kResultWords * sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        if (!buffer) return buffer.error();
        output = *buffer;
        return createLayout();
    }

    Status createLayout() {
        const VkDevice device = context.device();
        VkDescriptorSetLayoutBinding bindings[2]{};
        for (uint32_t k = 0; k < 2; ++k) {
            bindings[k].binding = k;
            bindings[k].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            bindings[k].descriptorCount = 1;
            bindings[k].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
        }
        VkDescriptorSetLayoutCreateInfo setInfo{};
        setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        setInfo.bindingCount = 2;
        setInfo.pBindings = bindings;
        VERNIER_TRY_VK(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &setLayout));
        resources.cleanup().add([=, layout = setLayout] { vkDestroyDescriptorSetLayout(device, layout, nullptr); });
        VkPipelineLayoutCreateInfo layoutInfo{};
        layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layoutInfo.setLayoutCount = 1;
        layoutInfo.pSetLayouts = &setLayout;
        VERNIER_TRY_VK(vkCreatePipelineLayout(device, &layoutInfo, nullptr, &pipelineLayout));
        resources.cleanup().add([=, layout = pipelineLayout] { vkDestroyPipelineLayout(device, layout, nullptr); });
        const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
        VkDescriptorPoolCreateInfo poolInfo{};
        poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        poolInfo.maxSets = 1;
        poolInfo.poolSizeCount = 1;
        poolInfo.pPoolSizes = &size;
        VkDescriptorPool pool = VK_NULL_HANDLE;
        VERNIER_TRY_VK(vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool));
        resources.cleanup().add([=] { vkDestroyDescriptorPool(device, pool, nullptr); });
        VkDescriptorSetAllocateInfo allocateInfo{};
        allocateInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        allocateInfo.descriptorPool = pool;
        allocateInfo.descriptorSetCount = 1;
        allocateInfo.pSetLayouts = &setLayout;
        VERNIER_TRY_VK(vkAllocateDescriptorSets(device, &allocateInfo, &set));
        const VkDescriptorBufferInfo buffers[2] = {{input.handle, 0, VK_WHOLE_SIZE}, {output.handle, 0, VK_WHOLE_SIZE}};
        for (uint32_t k = 0; k < 2; ++k) {
            VkWriteDescriptorSet write{};
            write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
            write.dstSet = set;
            write.dstBinding = k;
            write.descriptorCount = 1;
            write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            write.pBufferInfo = &buffers[k];
            vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        }
        return {};
    }

    Result<VkPipeline> createPipeline(const Function& function, Cleanup& cleanup) {
        const VkDevice device = context.device();
        const std::string source = std::string("#version 450\n") + kGlslExtensions + R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input { float x[]; };
layout(set = 0, binding = 1) writeonly buffer Output { float results[]; };
void main() {
    const uint i = gl_GlobalInvocationID.x, n = 65536u;
    vec3 u = vec3(x[i], x[n + i], x[2u * n + i]), v = vec3(x[3u * n + i], x[4u * n + i], x[5u * n + i]);
)" + callText(function) + "results[i] = low; results[n + i] = high;\n}\n";
        const auto words = compileGlsl(VK_SHADER_STAGE_COMPUTE_BIT, source);
        if (!words) return words.error();
        VkShaderModuleCreateInfo moduleInfo{};
        moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        moduleInfo.codeSize = words->size() * sizeof(uint32_t);
        moduleInfo.pCode = words->data();
        VkShaderModule module = VK_NULL_HANDLE;
        VERNIER_TRY_VK(vkCreateShaderModule(device, &moduleInfo, nullptr, &module));
        cleanup.add([=] { vkDestroyShaderModule(device, module, nullptr); });
        VkComputePipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = module;
        info.stage.pName = "main";
        info.layout = pipelineLayout;
        VkPipeline pipeline = VK_NULL_HANDLE;
        VERNIER_TRY_VK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
        cleanup.add([=] { vkDestroyPipeline(device, pipeline, nullptr); });
        return pipeline;
    }

    Status run(const Function& function, const Operands& operands, size_t calls, Results& results) {
        Cleanup cleanup;
        for (std::vector<float>& row : results) row.resize(calls);
        const auto pipeline = createPipeline(function, cleanup);
        if (!pipeline) return pipeline.error();
        for (size_t first = 0; first < calls; first += kCalls) {
            const size_t count = std::min(kCalls, calls - first);
            for (uint32_t k = 0; k < function.operands * wordsOf(function.operand); ++k) {
                std::copy_n(operands[k].data() + first, count, static_cast<float*>(input.mapped) + k * kCalls);
            }
            const auto commands = resources.beginCommands();
            if (!commands) return commands.error();
            vkCmdBindPipeline(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, *pipeline);
            vkCmdBindDescriptorSets(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelineLayout, 0, 1, &set, 0, nullptr);
            vkCmdDispatch(*commands, static_cast<uint32_t>(kCalls / kGroup), 1, 1);
            VkMemoryBarrier barrier{};
            barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
            barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
            barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
            vkCmdPipelineBarrier(*commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                                 &barrier, 0, nullptr, 0, nullptr);
            VERNIER_TRY_VK(vkEndCommandBuffer(*commands));
            VERNIER_TRY(resources.run(*commands));
            for (size_t word = 0; word < kResultWords; ++word) {
                std::copy_n(static_cast<const float*>(output.mapped) + word * kCalls, count,
                            results[word].data() + first);
            }
        }
        return {};
    }
};

VulkanRunner::VulkanRunner() : impl_(std::make_unique<Impl>()) {}
VulkanRunner::~VulkanRunner() = default;

Status VulkanRunner::create() {
    return impl_->create();
}
std::string VulkanRunner::name() const {
    return impl_->context.properties().deviceName;
}
Status VulkanRunner::run(const Function& function, const Operands& operands, size_t calls, Results& results) {
    return impl_->run(function, operands, calls, results);
}

}  // namespace vernier::precision
