#include "api/vulkan/pipeline.h"

#include <algorithm>
#include <cstring>

#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/instance.h"
#include "api/vulkan/pipeline_stages.h"
#include "api/vulkan/validation_cache.h"
#include "runtime/plan/check_state.h"
#include "runtime/plan/plan.h"
#include "spirv_interp/program.h"

namespace vernier::vulkan {
namespace {

/// Something for every input, so that the programs of a pipeline without a vertex input state can be told of.
void inventVertexInput(const ir::Program& vertex, GraphicsState& state) {
    state.vertexBindings = {{0, 16, VK_VERTEX_INPUT_RATE_VERTEX}};
    for (uint32_t location = 0; location < kMaxVertexAttributes; ++location) {
        const auto reads = [location](const ir::InterfaceSlot& slot) {
            return slot.builtin == ir::Builtin::user && slot.location == location;
        };
        if (std::ranges::any_of(vertex.inputs, reads))
            state.vertexAttributes.push_back({location, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0});
    }
}

/// Of a pipeline that has more than one plan; nullptr for others.
std::unique_ptr<PlanCache> makePlanCache(const PipelineState& state, std::shared_ptr<const ShaderProgram> program,
                                         std::shared_ptr<const GraphicsPipeline> example) {
    if (state.planStates == 0 && !state.dynamicRendering) return nullptr;
    PlanCache::Desc desc;
    desc.state = state.state;
    desc.program = std::move(program);
    desc.example = std::move(example);
    desc.dynamic = state.planStates;
    desc.clipsUnlessClamped = state.clipsUnlessClamped;
    desc.hasDepth = state.formats.depth != VK_FORMAT_UNDEFINED;
    desc.hasStencil = state.formats.stencil != VK_FORMAT_UNDEFINED;
    return std::make_unique<PlanCache>(std::move(desc));
}

Result<std::shared_ptr<const GraphicsPipeline>> makeGraphics(PipelineState& state,
                                                             std::shared_ptr<const ShaderProgram> program) {
    if (state.isDynamic(PlanState::VERTEX_INPUT_EXT)) inventVertexInput(program->vertexIr(), state.state);
    // What draws set fits the stages; what stands here meanwhile need not.
    const auto geometry = program->stage(ir::Stage::geometry);
    if (state.isDynamic(PlanState::PRIMITIVE_TOPOLOGY)) {
        if (program->stage(ir::Stage::control) != nullptr)
            state.state.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
        else if (geometry != nullptr)
            state.state.topology = topologyOf(geometry->source().geometry.input);
    }
    if (state.isDynamic(PlanState::PATCH_CONTROL_POINTS_EXT)) state.state.patchControlPoints = 1;
    return GraphicsPipeline::create({state.state, std::move(program)});
}

VkResult createOne(const Device& device, const VkGraphicsPipelineCreateInfo& info,
                   const VkAllocationCallbacks* callbacks, VkPipeline* out) {
    const auto fail = [&](const Error& error) { return device.report("vkCreateGraphicsPipelines", error); };
    if (!mayCompile(info.flags) && bringsShaders(info)) return VK_PIPELINE_COMPILE_REQUIRED;
    Result<PipelineLibrary> parts = gatherParts(device, info);
    if (!parts) return fail(parts.error());
    PipelineState& state = parts->state;
    const bool optimise = (info.flags & VK_PIPELINE_CREATE_LINK_TIME_OPTIMIZATION_BIT_EXT) != 0;
    if (!mayCompile(info.flags) && !isCompiled(parts->shaders, state, optimise)) return VK_PIPELINE_COMPILE_REQUIRED;
    if ((info.flags & VK_PIPELINE_CREATE_LIBRARY_BIT_KHR) != 0) {
        if (Status s = precompile(device, parts->shaders, state, optimise); !s) return fail(s.error());
        return createHandle(callbacks, out, std::make_shared<const PipelineLibrary>(std::move(parts).value()));
    }
    if (Status s = complete(state); !s) return fail(s.error());
    auto program = programOf(device, parts->shaders, state, optimise);
    if (!program) return fail(program.error());
    auto graphics = makeGraphics(state, *program);
    if (!graphics) return fail(graphics.error());
    device.physicalDevice.instance.explainLog.pipeline("graphics", (*graphics)->plan().facts);
    return createHandle(callbacks, out, *graphics, state.fixed, state.dynamicMask, state.viewportCountDynamic,
                        makePlanCache(state, std::move(program).value(), *graphics));
}

}  // namespace

void giveFeedback(const void* chain, bool made, std::chrono::nanoseconds duration) {
    const auto* info = findInChain<VkPipelineCreationFeedbackCreateInfo>(chain);
    if (info == nullptr) return;
    *info->pPipelineCreationFeedback = {};
    for (uint32_t i = 0; i < info->pipelineStageCreationFeedbackCount; ++i)
        info->pPipelineStageCreationFeedbacks[i] = {};
    if (!made) return;
    *info->pPipelineCreationFeedback = {VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT,
                                        static_cast<uint64_t>(duration.count())};
}

VKAPI_ATTR VkResult VKAPI_CALL CreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo* pCreateInfo,
                                                  const VkAllocationCallbacks* pAllocator,
                                                  VkShaderModule* pShaderModule) {
    return guarded([&] {
        std::vector<uint32_t> words(pCreateInfo->pCode, pCreateInfo->pCode + pCreateInfo->codeSize / sizeof(uint32_t));
        const size_t given = words.size();
        const auto* use = findInChain<VkShaderModuleValidationCacheCreateInfoEXT>(pCreateInfo->pNext);
        ValidationCache* cache = use != nullptr ? object(use->validationCache) : nullptr;
        const ModuleKey key = cache != nullptr ? moduleKey(words) : ModuleKey{};
        if (cache != nullptr && cache->has(key))
            return createHandle(pAllocator, pShaderModule, ValidatedModule::known(std::move(words)));
        Result<ValidatedModule> module = ValidatedModule::create(std::move(words));
        if (!module) return object(device)->report("vkCreateShaderModule", module.error());
        const bool completed = module->words().size() != given;
        if (completed && object(device)->validates()) {
            (void)object(device)->report("vkCreateShaderModule", VK_SUCCESS,
                                         "the module uses a built-in variable whose capability it does not declare");
        }
        if (cache != nullptr && !completed) cache->add(key);
        return createHandle(pAllocator, pShaderModule, std::move(module).value());
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyShaderModule(VkDevice, VkShaderModule shaderModule,
                                               const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, shaderModule);
}

VKAPI_ATTR VkResult VKAPI_CALL CreatePipelineCache(VkDevice, const VkPipelineCacheCreateInfo*,
                                                   const VkAllocationCallbacks* pAllocator,
                                                   VkPipelineCache* pPipelineCache) {
    return createHandle(pAllocator, pPipelineCache);
}

VKAPI_ATTR void VKAPI_CALL DestroyPipelineCache(VkDevice, VkPipelineCache pipelineCache,
                                                const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, pipelineCache);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineCacheData(VkDevice device, VkPipelineCache, size_t* pDataSize, void* pData) {
    const VkPhysicalDeviceProperties& properties = object(device)->physicalDevice.properties;
    VkPipelineCacheHeaderVersionOne header{};
    header.headerSize = sizeof header;
    header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
    header.vendorID = properties.vendorID;
    header.deviceID = properties.deviceID;
    std::memcpy(header.pipelineCacheUUID, properties.pipelineCacheUUID, sizeof header.pipelineCacheUUID);
    if (pData == nullptr) {
        *pDataSize = sizeof header;
        return VK_SUCCESS;
    }
    if (*pDataSize < sizeof header) {
        *pDataSize = 0;
        return VK_INCOMPLETE;
    }
    std::memcpy(pData, &header, sizeof header);
    *pDataSize = sizeof header;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL MergePipelineCaches(VkDevice, VkPipelineCache, uint32_t, const VkPipelineCache*) {
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateGraphicsPipelines(VkDevice device, VkPipelineCache, uint32_t createInfoCount,
                                                       const VkGraphicsPipelineCreateInfo* pCreateInfos,
                                                       const VkAllocationCallbacks* pAllocator,
                                                       VkPipeline* pPipelines) {
    return createEach(createInfoCount, pCreateInfos, pPipelines, [&](const auto& info, VkPipeline* pipeline) {
        return createOne(*object(device), info, pAllocator, pipeline);
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyPipeline(VkDevice, VkPipeline pipeline, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, pipeline);
}

}  // namespace vernier::vulkan
