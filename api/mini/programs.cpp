// Shaders and programs.
#include "api/mini/context.h"
#include "api/mini/errors.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

Result<ir::Stage> stageOf(VkShaderStageFlagBits stage) {
    if (stage == VK_SHADER_STAGE_VERTEX_BIT) return ir::Stage::vertex;
    if (stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT) return ir::Stage::control;
    if (stage == VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT) return ir::Stage::evaluation;
    if (stage == VK_SHADER_STAGE_GEOMETRY_BIT) return ir::Stage::geometry;
    if (stage == VK_SHADER_STAGE_FRAGMENT_BIT) return ir::Stage::fragment;
    if (stage == VK_SHADER_STAGE_COMPUTE_BIT) return ir::Stage::compute;
    return unsupported("stage is " + std::to_string(stage) +
                       "; only vertex, tessellation, geometry, fragment and compute are supported");
}

/// Shader errors have a code of their own: a broken module is no misuse of the API.
VnResult failShader(VnDevice device, const char* function, const Error& error) {
    if (error.code != ErrorCode::invalidArgument) return fail(device, function, error);
    return fail(device, VN_ERROR_SHADER, std::string(function) + ": " + error.message);
}

VnResult createComputeProgram(VnDevice device, const VnProgramDesc& desc, const Accuracy& accuracy,
                              VnProgram* program) {
    if (desc.vertex.id || desc.control.id || desc.evaluation.id || desc.geometry.id || desc.fragment.id)
        return invalid(device, "vnCreateProgram", "compute stands beside other stages; it must stand alone");
    const auto compute = device->shaders.find(desc.compute.id);
    if (!compute || compute->program.stage != ir::Stage::compute)
        return badHandle(device, "vnCreateProgram", "compute shader");
    auto made = ComputePipeline::create({&compute->program, accuracy, device->runtime->isa()});
    if (!made) return failShader(device, "vnCreateProgram", made.error());
    program->id =
        device->programs.insert(std::make_shared<ProgramObject>(ProgramObject{nullptr, std::move(made).value()}));
    return VN_SUCCESS;
}

}  // namespace

VnResult vnCreateShader(VnDevice device, const VnShaderDesc* desc, VnShader* shader) {
    return guarded(device, __func__, [&] {
        if (VnResult result = checkDesc(device, "vnCreateShader", desc, shader)) return result;
        shader->id = 0;
        if (!desc->words || desc->wordCount == 0) return invalid(device, "vnCreateShader", "there are no words");
        if (desc->specializationCount && !desc->specializations)
            return invalid(device, "vnCreateShader", "specializations is NULL");
        Result<ir::Stage> stage = stageOf(desc->stage);
        if (!stage) return fail(device, "vnCreateShader", stage.error());
        std::vector<Specialization::Entry> entries;
        std::vector<uint32_t> values;
        for (uint32_t i = 0; i < desc->specializationCount; ++i) {
            entries.push_back({desc->specializations[i].constantId, i * 4, 4});
            values.push_back(desc->specializations[i].bits);
        }
        ShaderSource source;
        source.words = {desc->words, desc->wordCount};
        source.entryPoint = desc->entryPoint ? desc->entryPoint : "main";
        source.stage = *stage;
        source.specialization = {entries, std::as_bytes(std::span(values))};
        Result<ir::Program> loaded = loadShader(source);
        if (!loaded) return failShader(device, "vnCreateShader", loaded.error());
        TessellationModes modes;
        if (*stage == ir::Stage::control || *stage == ir::Stage::evaluation) {
            const Result<TessellationModes> read = tessellationModes(source);
            if (!read) return failShader(device, "vnCreateShader", read.error());
            modes = *read;
        }
        auto object = std::make_shared<ShaderObject>(ShaderObject{std::move(loaded).value(), modes});
        shader->id = device->shaders.insert(std::move(object));
        return VN_SUCCESS;
    });
}

VnResult vnDestroyShader(VnDevice device, VnShader shader) {
    return guarded(device, __func__,
                   [&] { return destroyIn(device, "vnDestroyShader", "shader", device->shaders, shader.id); });
}

VnResult vnCreateProgram(VnDevice device, const VnProgramDesc* desc, VnProgram* program) {
    return guarded(device, __func__, [&] {
        if (VnResult result = checkDesc(device, "vnCreateProgram", desc, program)) return result;
        program->id = 0;
        const Result<Accuracy> accuracy = accuracyFrom(desc->profile, desc->axes, device->runtime->desc().accuracy);
        if (!accuracy) return fail(device, "vnCreateProgram", accuracy.error());
        if (desc->compute.id) return createComputeProgram(device, *desc, *accuracy, program);
        const auto vertex = device->shaders.find(desc->vertex.id);
        if (!vertex || vertex->program.stage != ir::Stage::vertex)
            return badHandle(device, "vnCreateProgram", "vertex shader");
        ShaderProgramDesc linked;
        linked.vertex = &vertex->program;
        const struct {
            VnShader handle;
            ir::Stage stage;
            const char* name;
            const ir::Program*& program;
        } others[] = {
            {desc->control, ir::Stage::control, "control shader", linked.control},
            {desc->evaluation, ir::Stage::evaluation, "evaluation shader", linked.evaluation},
            {desc->geometry, ir::Stage::geometry, "geometry shader", linked.geometry},
            {desc->fragment, ir::Stage::fragment, "fragment shader", linked.fragment},
        };
        std::vector<std::shared_ptr<ShaderObject>> held;
        for (const auto& other : others) {
            if (!other.handle.id) continue;
            const auto& shader = held.emplace_back(device->shaders.find(other.handle.id));
            if (!shader || shader->program.stage != other.stage)
                return badHandle(device, "vnCreateProgram", other.name);
            other.program = &shader->program;
            linked.tessellation = joined(linked.tessellation, shader->tessellation);
        }
        linked.accuracy = *accuracy;
        linked.isa = device->runtime->isa();
        linked.skips = device->runtime->desc().skips;
        auto made = ShaderProgram::create(linked);
        if (!made) return failShader(device, "vnCreateProgram", made.error());
        program->id =
            device->programs.insert(std::make_shared<ProgramObject>(ProgramObject{std::move(made).value(), nullptr}));
        return VN_SUCCESS;
    });
}

VnResult vnDestroyProgram(VnDevice device, VnProgram program) {
    return guarded(device, __func__, [&] {
        if (!device->programs.remove(program.id)) return badHandle(device, "vnDestroyProgram", "program");
        const std::lock_guard lock(device->pipelineMutex);
        std::erase_if(device->pipelines, [&](const auto& entry) { return entry.first.program == program.id; });
        return VN_SUCCESS;
    });
}
