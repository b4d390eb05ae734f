// Compute pipelines.
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/instance.h"
#include "api/vulkan/pipeline.h"
#include "api/vulkan/pipeline_stages.h"

namespace vernier::vulkan {
namespace {

VkResult createOne(const Device& device, const VkComputePipelineCreateInfo& info,
                   const VkAllocationCallbacks* callbacks, VkPipeline* out) {
    if (!mayCompile(info.flags)) return VK_PIPELINE_COMPILE_REQUIRED;
    const auto fail = [&](const Error& error) { return device.report("vkCreateComputePipelines", error); };
    if (info.stage.stage != VK_SHADER_STAGE_COMPUTE_BIT)
        return fail(invalidArgument("stage.stage is " + std::to_string(info.stage.stage) + ", not COMPUTE"));
    const Result<ir::Program> program = loadStage(info.stage, ir::Stage::compute);
    if (!program) return fail(program.error());
    auto pipeline = ComputePipeline::create({&*program, device.physicalDevice.accuracy, device.runtime->isa()});
    if (!pipeline) return fail(pipeline.error());
    if (ExplainLog& log = device.physicalDevice.instance.explainLog; log.enabled())
        log.pipeline("compute", (*pipeline)->explain());
    return createHandle(callbacks, out, std::move(pipeline).value());
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL CreateComputePipelines(VkDevice device, VkPipelineCache, uint32_t createInfoCount,
                                                      const VkComputePipelineCreateInfo* pCreateInfos,
                                                      const VkAllocationCallbacks* pAllocator, VkPipeline* pPipelines) {
    return createEach(createInfoCount, pCreateInfos, pPipelines, [&](const auto& info, VkPipeline* pipeline) {
        return createOne(*object(device), info, pAllocator, pipeline);
    });
}

}  // namespace vernier::vulkan
