#include "api/vulkan/pipeline.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/instance.h"
#include "runtime/plan/check_state.h"
#include "runtime/plan/plan.h"
#include "spirv_interp/program.h"
#include "spirv_interp/tessellation.h"

namespace vernier::vulkan {
namespace {

struct StageKind {
    VkShaderStageFlagBits bit;
    ir::Stage stage;
    const ir::Program* ShaderProgramDesc::*program;
    const char* name;
};
/// In the order in which they run.
constexpr StageKind kStages[] = {
    {VK_SHADER_STAGE_VERTEX_BIT, ir::Stage::vertex, &ShaderProgramDesc::vertex, "vertex"},
    {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, ir::Stage::control, &ShaderProgramDesc::control, "tessellation control"},
    {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, ir::Stage::evaluation, &ShaderProgramDesc::evaluation,
     "tessellation evaluation"},
    {VK_SHADER_STAGE_GEOMETRY_BIT, ir::Stage::geometry, &ShaderProgramDesc::geometry, "geometry"},
    {VK_SHADER_STAGE_FRAGMENT_BIT, ir::Stage::fragment, &ShaderProgramDesc::fragment, "fragment"},
};

/// Of a stage, as the runtime's loader wants it. `entries` holds what the specialization points to.
ShaderSource shaderSource(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind,
                          std::vector<Specialization::Entry>& entries) {
    ShaderSource source;
    source.module = &object(stage.module)->module;
    source.entryPoint = stage.pName;
    source.stage = kind;
    if (const VkSpecializationInfo* special = stage.pSpecializationInfo) {
        for (uint32_t i = 0; i < special->mapEntryCount; ++i) {
            const VkSpecializationMapEntry& entry = special->pMapEntries[i];
            if (entry.offset > special->dataSize || entry.size > special->dataSize - entry.offset) continue;
            entries.push_back({entry.constantID, entry.offset, static_cast<uint32_t>(entry.size)});
        }
        source.specialization = {entries, {static_cast<const std::byte*>(special->pData), special->dataSize}};
    }
    return source;
}

Result<TessellationModes> loadTessellationModes(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind) {
    std::vector<Specialization::Entry> entries;
    return tessellationModes(shaderSource(stage, kind, entries));
}

/// A bit per location that an attachment keeps something of; alpha to coverage needs location 0 all the same.
uint32_t keptColors(const PipelineState& pipeline) {
    const GraphicsState& state = pipeline.state;
    const bool anyMask = pipeline.isDynamic(PlanState::COLOR_WRITE_MASK_EXT);
    uint32_t kept = state.alphaToCoverage || pipeline.isDynamic(PlanState::ALPHA_TO_COVERAGE_ENABLE_EXT) ? 1 : 0;
    for (uint32_t n = 0; n < state.colorCount; ++n) {
        const bool writes = anyMask || state.blend[n].colorWriteMask != 0;
        if (state.colorFormats[n] != VK_FORMAT_UNDEFINED && writes) kept |= 1u << n;
    }
    return kept;
}

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

Result<std::shared_ptr<const ShaderProgram>> loadProgram(const Device& device, const VkGraphicsPipelineCreateInfo& info,
                                                         const PipelineState& state) {
    std::array<const VkPipelineShaderStageCreateInfo*, std::size(kStages)> given{};
    for (uint32_t i = 0; i < info.stageCount; ++i) {
        const VkPipelineShaderStageCreateInfo& stage = info.pStages[i];
        const auto kind = std::ranges::find(kStages, stage.stage, &StageKind::bit);
        if (kind == std::end(kStages))
            return unsupported("shader stage " + std::to_string(stage.stage) + " is not supported");
        given[static_cast<size_t>(kind - kStages)] = &stage;
    }
    if (given.front() == nullptr) return invalidArgument("there is no vertex stage");
    if (state.state.rasterizerDiscard) given.back() = nullptr;

    ShaderProgramDesc desc;
    std::array<ir::Program, std::size(kStages)> programs;
    CaptureLayout capture;
    for (size_t n = 0; n < programs.size(); ++n) {
        if (given[n] == nullptr) continue;
        // Transform feedback takes what the last stage before the rasteriser puts out.
        CaptureLayout ignored;
        const StageKind& kind = kStages[n];
        CaptureLayout& kept = kind.stage == ir::Stage::fragment ? ignored : capture = {};
        Result<ir::Program> program = loadStage(*given[n], kind.stage, kept);
        if (!program)
            return Error{program.error().code, std::string(kind.name) + " shader: " + program.error().message};
        programs[n] = std::move(program).value();
        desc.*kind.program = &programs[n];
        if (kind.stage != ir::Stage::control && kind.stage != ir::Stage::evaluation) continue;
        Result<TessellationModes> modes = loadTessellationModes(*given[n], kind.stage);
        if (!modes) return modes.error();
        desc.tessellation = joined(desc.tessellation, *modes);
    }
    if (!state.isDynamic(PlanState::PATCH_CONTROL_POINTS_EXT)) desc.patchControlPoints = state.state.patchControlPoints;
    desc.capture = &capture;
    desc.keptColors = keptColors(state);
    desc.accuracy = device.physicalDevice.accuracy;
    desc.isa = device.runtime->isa();
    desc.skips = device.physicalDevice.configuration.skips;
    return ShaderProgram::create(desc);
}

VkResult createOne(const Device& device, const VkGraphicsPipelineCreateInfo& info,
                   const VkAllocationCallbacks* callbacks, VkPipeline* out) {
    Result<PipelineState> state = pipelineState(info);
    if (!state) return device.report("vkCreateGraphicsPipelines", state.error());
    auto program = loadProgram(device, info, *state);
    if (!program) return device.report("vkCreateGraphicsPipelines", program.error());
    if (state->isDynamic(PlanState::VERTEX_INPUT_EXT)) inventVertexInput((*program)->vertexIr(), state->state);
    // What draws set fits the stages; what stands here meanwhile need not.
    const auto geometry = (*program)->stage(ir::Stage::geometry);
    if (state->isDynamic(PlanState::PRIMITIVE_TOPOLOGY)) {
        if ((*program)->stage(ir::Stage::control) != nullptr)
            state->state.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
        else if (geometry != nullptr)
            state->state.topology = topologyOf(geometry->source().geometry.input);
    }
    if (state->isDynamic(PlanState::PATCH_CONTROL_POINTS_EXT)) state->state.patchControlPoints = 1;
    auto graphics = GraphicsPipeline::create({state->state, *program});
    if (!graphics) return device.report("vkCreateGraphicsPipelines", graphics.error());
    device.physicalDevice.instance.explainLog.pipeline("graphics", (*graphics)->plan().facts);
    return createHandle(callbacks, out, *graphics, state->fixed, state->dynamicMask, state->viewportCountDynamic,
                        makePlanCache(*state, std::move(program).value(), *graphics));
}

}  // namespace

Result<ir::Program> loadStage(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind) {
    CaptureLayout ignored;
    return loadStage(stage, kind, ignored);
}

Result<ir::Program> loadStage(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind, CaptureLayout& capture) {
    if (stage.module == VK_NULL_HANDLE) return invalidArgument("a stage without a shader module");
    const auto* subgroup = findInChain<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(stage.pNext);
    if (subgroup != nullptr && subgroup->requiredSubgroupSize != ir::kSubgroupSize) {
        return unsupported("requiredSubgroupSize is " + std::to_string(subgroup->requiredSubgroupSize) +
                           ", subgroups have " + std::to_string(ir::kSubgroupSize));
    }
    std::vector<Specialization::Entry> entries;
    return loadShader(shaderSource(stage, kind, entries), capture);
}

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
        Result<ValidatedModule> module = ValidatedModule::create(std::move(words));
        if (!module) return object(device)->report("vkCreateShaderModule", module.error());
        if (module->words().size() != given && object(device)->validates()) {
            (void)object(device)->report("vkCreateShaderModule", VK_SUCCESS,
                                         "the module uses a built-in variable whose capability it does not declare");
        }
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
