// Pipelines, shader modules and pipeline caches.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "api/vulkan/allocation.h"
#include "api/vulkan/handle.h"
#include "api/vulkan/pipeline_library.h"
#include "api/vulkan/plan_cache.h"
#include "runtime/command/access_set.h"
#include "runtime/command/commands.h"
#include "runtime/plan/compute_pipeline.h"
#include "runtime/plan/pipeline.h"
#include "spirv_interp/program.h"

namespace vernier::vulkan {

/// Validated when it is created, so that its pipelines need not be.
struct ShaderModule {
    explicit ShaderModule(ValidatedModule code) : module(std::move(code)) {}
    ValidatedModule module;
};

/// Nothing is kept between pipelines: the data of a cache is its header alone.
struct PipelineCache {};

/// Of one of the three kinds.
struct Pipeline {
    Pipeline(std::shared_ptr<const GraphicsPipeline> made, const DynamicState& values, uint32_t mask,
             bool countsViewports, std::unique_ptr<PlanCache> cache)
        : graphics(std::move(made)),
          fixed(values),
          dynamicMask(mask),
          viewportCountDynamic(countsViewports),
          plans(std::move(cache)),
          vertexAddresses(
              std::ranges::any_of(graphics->program().stages(),
                                  [](const StageProgram& stage) { return usesAddresses(stage.program->source()); })),
          fragmentAddresses(graphics->fragmentIr() != nullptr && usesAddresses(*graphics->fragmentIr())) {}
    explicit Pipeline(std::shared_ptr<const ComputePipeline> made)
        : compute(std::move(made)), computeAddresses(usesAddresses(compute->ir())) {}
    explicit Pipeline(std::shared_ptr<const PipelineLibrary> made) : library(std::move(made)) {}
    /// The command that binds it, with this plan.
    command::BindPipeline binding(const GraphicsPipeline& plan, const DynamicState& values) const {
        return {&plan, &values, dynamicMask, vertexAddresses, fragmentAddresses};
    }
    std::shared_ptr<const GraphicsPipeline> graphics;  // with `plans`: an example, which tells of the programs
    DynamicState fixed;
    uint32_t dynamicMask = 0;
    bool viewportCountDynamic = false;
    std::unique_ptr<PlanCache> plans;                         // nullptr: `graphics` is the only one
    bool vertexAddresses = false, fragmentAddresses = false;  // before the rasteriser, and behind it
    std::shared_ptr<const ComputePipeline> compute;
    bool computeAddresses = false;
    std::shared_ptr<const PipelineLibrary> library;
};

/// Whether shaders may be compiled for a pipeline; where they must be, it is else VK_PIPELINE_COMPILE_REQUIRED
/// (VK_EXT_pipeline_creation_cache_control).
inline bool mayCompile(VkPipelineCreateFlags flags) {
    return (flags & VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT) == 0;
}

/// Answers VkPipelineCreationFeedbackCreateInfo: of the whole pipeline, for stages are not made one by one.
void giveFeedback(const void* chain, bool made, std::chrono::nanoseconds duration);

/// Calls create(info, place) for each, which returns a VkResult; a pipeline that fails becomes VK_NULL_HANDLE and the
/// others are made all the same ("Multiple Pipeline Creation" in the Vulkan specification).
template <class Info, class Create>
VkResult createEach(uint32_t count, const Info* infos, VkPipeline* pipelines, Create&& create) {
    VkResult result = VK_SUCCESS;
    std::fill_n(pipelines, count, VkPipeline{VK_NULL_HANDLE});
    for (uint32_t i = 0; i < count; ++i) {
        const Info& info = infos[i];
        const auto start = std::chrono::steady_clock::now();
        const VkResult one = guarded([&] { return create(info, &pipelines[i]); });
        giveFeedback(info.pNext, one == VK_SUCCESS, std::chrono::steady_clock::now() - start);
        if (one == VK_SUCCESS) continue;
        if (result >= VK_SUCCESS) result = one;  // errors are negative, and count more
        if ((info.flags & VK_PIPELINE_CREATE_EARLY_RETURN_ON_FAILURE_BIT) != 0) break;
    }
    return result;
}

}  // namespace vernier::vulkan
