#include "api/vulkan/pipeline_library.h"

#include <string>

#include "api/vulkan/chain.h"
#include "api/vulkan/pipeline.h"

namespace vernier::vulkan {
namespace {

/// The parts that a description has itself (VkGraphicsPipelineLibraryCreateInfoEXT).
PipelineParts ownParts(const VkGraphicsPipelineCreateInfo& info) {
    const auto* libraries = findInChain<VkPipelineLibraryCreateInfoKHR>(info.pNext);
    if (const auto* named = findInChain<VkGraphicsPipelineLibraryCreateInfoEXT>(info.pNext)) return named->flags;
    const bool isLibrary = (info.flags & VK_PIPELINE_CREATE_LIBRARY_BIT_KHR) != 0;
    return isLibrary || (libraries != nullptr && libraries->libraryCount > 0) ? 0 : kAllParts;
}

void take(PipelineLibrary& to, const PipelineState& state, const PipelineShaders& shaders) {
    takeParts(to.state, state);
    takeShaders(to.shaders, shaders);
}

}  // namespace

bool bringsShaders(const VkGraphicsPipelineCreateInfo& info) {
    return (ownParts(info) & (kPreRasterization | kFragmentShader)) != 0;
}

Result<PipelineLibrary> gatherParts(const Device& device, const VkGraphicsPipelineCreateInfo& info) {
    PipelineLibrary gathered;
    const auto* libraries = findInChain<VkPipelineLibraryCreateInfoKHR>(info.pNext);
    for (uint32_t i = 0; libraries != nullptr && i < libraries->libraryCount; ++i) {
        const Pipeline* pipeline = object(libraries->pLibraries[i]);
        const PipelineLibrary* library = pipeline != nullptr ? pipeline->library.get() : nullptr;
        if (library == nullptr) return invalidArgument("pLibraries[" + std::to_string(i) + "] is no library");
        take(gathered, library->state, library->shaders);
    }
    const PipelineParts parts = ownParts(info);
    if (parts == 0) return gathered;
    const auto state = readParts(device, info, parts, gathered.state.state.rasterizerDiscard);
    if (!state) return state.error();
    const bool discards = gathered.state.state.rasterizerDiscard || state->state.rasterizerDiscard;
    const auto shaders = loadStages(info, parts, discards);
    if (!shaders) return shaders.error();
    take(gathered, *state, *shaders);
    return gathered;
}

}  // namespace vernier::vulkan
