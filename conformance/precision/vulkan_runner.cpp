// The same calls as a compute shader of whatever Vulkan driver the loader finds.
#include <algorithm>

#include "conformance/drivers/vulkan_compute.h"
#include "conformance/precision/evaluator.h"
#include "conformance/precision/glsl.h"

namespace vernier::precision {

using conformance::Cleanup;
using conformance::VulkanBuffer;

struct VulkanRunner::Impl {
    conformance::VulkanContext context;
    conformance::VulkanResources resources{context};
    VulkanBuffer input, output;
    conformance::StorageBuffers bound;

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
        const VulkanBuffer buffers[] = {input, output};
        const auto result = conformance::bindStorageBuffers(context.device(), resources.cleanup(), buffers);
        if (!result) return result.error();
        bound = *result;
        return {};
    }

    Result<VkPipeline> createPipeline(const Function& function, Cleanup& cleanup) {
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
        const auto module = conformance::createShaderModule(context.device(), cleanup, *words);
        if (!module) return module.error();
        return conformance::createComputePipeline(context.device(), cleanup, bound.layout, *module);
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
            vkCmdBindDescriptorSets(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, bound.layout, 0, 1, &bound.set, 0,
                                    nullptr);
            vkCmdDispatch(*commands, static_cast<uint32_t>(kCalls / kGroup), 1, 1);
            conformance::computeBarrier(*commands, VK_ACCESS_HOST_READ_BIT, VK_PIPELINE_STAGE_HOST_BIT);
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
