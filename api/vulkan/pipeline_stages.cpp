#include "api/vulkan/pipeline_stages.h"

#include <algorithm>
#include <string>
#include <vector>

#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/pipeline.h"

namespace vernier::vulkan {
namespace {

struct StageKind {
    VkShaderStageFlagBits bit;
    ir::Stage stage;
    const ir::Program* ShaderProgramDesc::*program;
    const char* name;
};
/// In the order in which they run.
constexpr StageKind kStages[kStageCount] = {
    {VK_SHADER_STAGE_VERTEX_BIT, ir::Stage::vertex, &ShaderProgramDesc::vertex, "vertex"},
    {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, ir::Stage::control, &ShaderProgramDesc::control, "tessellation control"},
    {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, ir::Stage::evaluation, &ShaderProgramDesc::evaluation,
     "tessellation evaluation"},
    {VK_SHADER_STAGE_GEOMETRY_BIT, ir::Stage::geometry, &ShaderProgramDesc::geometry, "geometry"},
    {VK_SHADER_STAGE_FRAGMENT_BIT, ir::Stage::fragment, &ShaderProgramDesc::fragment, "fragment"},
};

/// Of a stage, as the runtime's loader wants it. `entries` holds what the specialization points to.
Result<ShaderSource> shaderSource(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind,
                                  std::vector<Specialization::Entry>& entries) {
    ShaderSource source;
    if (stage.module != VK_NULL_HANDLE) {
        source.module = &object(stage.module)->module;
    } else if (const auto* code = findInChain<VkShaderModuleCreateInfo>(stage.pNext)) {
        source.words = {code->pCode, code->codeSize / sizeof(uint32_t)};
    } else {
        return invalidArgument("a stage without a shader module");
    }
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

Result<LoadedStage> load(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind) {
    const auto* subgroup = findInChain<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(stage.pNext);
    if (subgroup != nullptr && subgroup->requiredSubgroupSize != ir::kSubgroupSize) {
        return unsupported("requiredSubgroupSize is " + std::to_string(subgroup->requiredSubgroupSize) +
                           ", subgroups have " + std::to_string(ir::kSubgroupSize));
    }
    std::vector<Specialization::Entry> entries;
    const Result<ShaderSource> source = shaderSource(stage, kind, entries);
    if (!source) return source.error();
    LoadedStage loaded;
    Result<ir::Program> program = loadShader(*source, loaded.capture);
    if (!program) return program.error();
    loaded.program = std::move(program).value();
    if (kind != ir::Stage::control && kind != ir::Stage::evaluation) return loaded;
    const Result<TessellationModes> modes = tessellationModes(*source);
    if (!modes) return modes.error();
    loaded.modes = *modes;
    return loaded;
}

/// A bit per location that an attachment keeps something of; alpha to coverage needs location 0 all the same. All where
/// the attachments are not known yet.
uint32_t keptColors(const PipelineState& pipeline) {
    if ((pipeline.parts & kFragmentOutput) == 0) return ~0u;
    const GraphicsState& state = pipeline.state;
    const SubpassFormats& formats = pipeline.formats;
    const bool anyMask = pipeline.isDynamic(PlanState::COLOR_WRITE_MASK_EXT);
    uint32_t kept = state.alphaToCoverage || pipeline.isDynamic(PlanState::ALPHA_TO_COVERAGE_ENABLE_EXT) ? 1 : 0;
    for (uint32_t n = 0; n < formats.colorCount; ++n) {
        const bool writes = anyMask || state.blend[n].colorWriteMask != 0;
        if (formats.colors[n] != VK_FORMAT_UNDEFINED && writes) kept |= 1u << n;
    }
    return kept;
}

/// Transform feedback takes what the last stage before the rasteriser puts out.
const CaptureLayout* captureOf(const PipelineShaders& shaders) {
    const CaptureLayout* capture = nullptr;
    for (size_t n = 0; n + 1 < kStageCount; ++n)
        if (shaders.stages[n] != nullptr) capture = &shaders.stages[n]->capture;
    return capture;
}

ShaderProgramDesc programDesc(const Device& device, const PipelineShaders& shaders, const PipelineState& state) {
    ShaderProgramDesc desc;
    for (size_t n = 0; n < kStageCount; ++n) {
        if (shaders.stages[n] == nullptr) continue;
        desc.*kStages[n].program = &shaders.stages[n]->program;
        desc.tessellation = joined(desc.tessellation, shaders.stages[n]->modes);
    }
    if (!state.isDynamic(PlanState::PATCH_CONTROL_POINTS_EXT)) desc.patchControlPoints = state.state.patchControlPoints;
    desc.capture = captureOf(shaders);
    desc.keptColors = keptColors(state);
    desc.accuracy = device.physicalDevice.accuracy;
    desc.isa = device.runtime->isa();
    desc.skips = device.physicalDevice.configuration.skips;
    return desc;
}

/// Whether the parts with shaders are all there.
bool hasAllShaders(const PipelineState& state) {
    const PipelineParts needed =
        state.state.rasterizerDiscard ? kPreRasterization : kPreRasterization | kFragmentShader;
    return (state.parts & needed) == needed;
}

/// What libraries have compiled of all that the parts with shaders have, as one; nullptr if something is left to do.
std::shared_ptr<const ShaderProgram> compiledWhole(const PipelineShaders& shaders, const PipelineState& state) {
    if (shaders.whole != nullptr) return shaders.whole;
    if (shaders.before == nullptr) return nullptr;
    if (state.state.rasterizerDiscard || !shaders.hasFragment()) return shaders.before;
    return shaders.behind != nullptr ? ShaderProgram::join(*shaders.before, *shaders.behind) : nullptr;
}

/// One side of the rasteriser by itself.
Status compileSide(const ShaderProgramDesc& desc, ShaderProgram::Side side, std::shared_ptr<const ShaderProgram>& to) {
    auto made = ShaderProgram::createSide(desc, side);
    if (!made) return made.error();
    to = std::move(made).value();
    return {};
}

}  // namespace

Result<ir::Program> loadStage(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind) {
    Result<LoadedStage> loaded = load(stage, kind);
    if (!loaded) return loaded.error();
    return std::move(loaded->program);
}

Result<PipelineShaders> loadStages(const VkGraphicsPipelineCreateInfo& info, PipelineParts parts, bool discards) {
    PipelineShaders shaders;
    if ((parts & (kPreRasterization | kFragmentShader)) == 0) return shaders;
    for (uint32_t i = 0; i < info.stageCount; ++i) {
        const VkPipelineShaderStageCreateInfo& stage = info.pStages[i];
        const auto kind = std::ranges::find(kStages, stage.stage, &StageKind::bit);
        if (kind == std::end(kStages))
            return unsupported("shader stage " + std::to_string(stage.stage) + " is not supported");
        const bool isFragment = kind->stage == ir::Stage::fragment;
        if ((parts & (isFragment ? kFragmentShader : kPreRasterization)) == 0 || (isFragment && discards)) continue;
        Result<LoadedStage> loaded = load(stage, kind->stage);
        if (!loaded) return Error{loaded.error().code, std::string(kind->name) + " shader: " + loaded.error().message};
        shaders.stages[static_cast<size_t>(kind - kStages)] =
            std::make_shared<const LoadedStage>(std::move(loaded).value());
    }
    return shaders;
}

void takeShaders(PipelineShaders& to, const PipelineShaders& from) {
    const auto take = [](auto& into, const auto& one) {
        if (one != nullptr) into = one;
    };
    for (size_t n = 0; n < kStageCount; ++n) take(to.stages[n], from.stages[n]);
    take(to.before, from.before);
    take(to.behind, from.behind);
    take(to.whole, from.whole);
}

Result<std::shared_ptr<const ShaderProgram>> programOf(const Device& device, const PipelineShaders& shaders,
                                                       const PipelineState& state, bool optimise) {
    if (shaders.stages.front() == nullptr) return invalidArgument("there is no vertex stage");
    if (!optimise) {
        if (auto compiled = compiledWhole(shaders, state)) return compiled;
    }
    ShaderProgramDesc desc = programDesc(device, shaders, state);
    if (state.state.rasterizerDiscard) desc.fragment = nullptr;
    return ShaderProgram::create(desc);
}

bool isCompiled(const PipelineShaders& shaders, const PipelineState& state, bool optimise) {
    // The sides that libraries have alone they have compiled.
    return !hasAllShaders(state) || (!optimise && compiledWhole(shaders, state) != nullptr);
}

Status precompile(const Device& device, PipelineShaders& shaders, const PipelineState& state, bool optimise) {
    if (hasAllShaders(state)) {
        auto made = programOf(device, shaders, state, optimise);
        if (!made) return made.error();
        shaders.whole = std::move(made).value();
        return {};
    }
    const ShaderProgramDesc desc = programDesc(device, shaders, state);
    if (desc.vertex != nullptr && shaders.before == nullptr)
        return compileSide(desc, ShaderProgram::Side::beforeRasteriser, shaders.before);
    if (desc.fragment != nullptr && shaders.behind == nullptr)
        return compileSide(desc, ShaderProgram::Side::behindRasteriser, shaders.behind);
    return {};
}

}  // namespace vernier::vulkan
