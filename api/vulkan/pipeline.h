// Graphics pipelines, shader modules and pipeline caches.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "api/vulkan/handle.h"
#include "runtime/plan/pipeline.h"

namespace vernier::vulkan {

struct ShaderModule {
    explicit ShaderModule(std::vector<uint32_t> code) : words(std::move(code)) {}
    std::vector<uint32_t> words;
};

/// Nothing is kept between pipelines: the data of a cache is its header alone.
struct PipelineCache {};

struct Pipeline {
    Pipeline(std::shared_ptr<const GraphicsPipeline> made, const DynamicState& values, uint32_t mask)
        : graphics(std::move(made)), fixed(values), dynamicMask(mask) {}
    std::shared_ptr<const GraphicsPipeline> graphics;
    DynamicState fixed;
    uint32_t dynamicMask;
};

/// The state of VkGraphicsPipelineCreateInfo in the runtime's terms (pipeline_state.cpp).
struct PipelineState {
    GraphicsState state;
    DynamicState fixed;
    uint32_t dynamicMask = 0;  // bit per VkDynamicState
};
Result<PipelineState> pipelineState(const VkGraphicsPipelineCreateInfo& info);

}  // namespace vernier::vulkan
