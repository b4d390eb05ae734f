// Pipelines, shader modules and pipeline caches.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "api/vulkan/allocation.h"
#include "api/vulkan/handle.h"
#include "runtime/plan/compute_pipeline.h"
#include "runtime/plan/pipeline.h"
#include "spirv_interp/capture.h"
#include "spirv_interp/program.h"

namespace vernier::vulkan {

/// Validated when it is created, so that its pipelines need not be.
struct ShaderModule {
    explicit ShaderModule(ValidatedModule code) : module(std::move(code)) {}
    ValidatedModule module;
};

/// Nothing is kept between pipelines: the data of a cache is its header alone.
struct PipelineCache {};

/// Of one of the two kinds.
struct Pipeline {
    Pipeline(std::shared_ptr<const GraphicsPipeline> made, const DynamicState& values, uint32_t mask)
        : graphics(std::move(made)), fixed(values), dynamicMask(mask) {}
    explicit Pipeline(std::shared_ptr<const ComputePipeline> made) : compute(std::move(made)) {}
    std::shared_ptr<const GraphicsPipeline> graphics;
    DynamicState fixed;
    uint32_t dynamicMask = 0;
    std::shared_ptr<const ComputePipeline> compute;
};

/// Loads the program of a stage with its specialization (pipeline.cpp).
Result<ir::Program> loadStage(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind);
/// And what transform feedback keeps of it.
Result<ir::Program> loadStage(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind, CaptureLayout& capture);

/// The state of VkGraphicsPipelineCreateInfo in the runtime's terms (pipeline_state.cpp).
struct PipelineState {
    GraphicsState state;
    DynamicState fixed;
    uint32_t dynamicMask = 0;  // of dynamicStateBit()
};
/// The sample locations of a pixel in the runtime's terms; outside sampleLocationCoordinateRange they are clamped.
std::array<SamplePosition, kMaxSamples> sampleLocationsOf(const VkSampleLocationsInfoEXT& info);
Result<PipelineState> pipelineState(const VkGraphicsPipelineCreateInfo& info);

/// Calls create(info, place) for each, which returns a VkResult; a pipeline that fails becomes VK_NULL_HANDLE and the
/// others are made all the same ("Multiple Pipeline Creation" in the Vulkan specification).
template <class Info, class Create>
VkResult createEach(uint32_t count, const Info* infos, VkPipeline* pipelines, Create&& create) {
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count; ++i) {
        pipelines[i] = VK_NULL_HANDLE;
        const VkResult one = guarded([&] { return create(infos[i], &pipelines[i]); });
        if (one != VK_SUCCESS) result = one;
    }
    return result;
}

}  // namespace vernier::vulkan
