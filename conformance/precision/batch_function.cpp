#include <algorithm>

#include "api/include/vernier/vernier_glsl.h"
#include "conformance/precision/evaluator.h"
#include "conformance/precision/glsl.h"

namespace vernier::precision {

Result<std::vector<uint32_t>> compileGlsl(VkShaderStageFlagBits stage, const std::string& source) {
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = source.c_str();
    VnGlslOutput* output = nullptr;
    const VnGlslResult result = vnCompileGlsl(&desc, &output);
    const std::unique_ptr<VnGlslOutput, void (*)(VnGlslOutput*)> owner(output, vnFreeGlslOutput);
    if (result != VN_GLSL_SUCCESS) {
        return Error{ErrorCode::invalidArgument, output != nullptr ? output->log : "out of memory"};
    }
    return std::vector<uint32_t>(output->words, output->words + output->wordCount);
}

Result<BatchFunction> BatchFunction::compile(const Function& function, MathTier tier, Isa isa) {
    const std::string source = R"(#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : enable
layout(location = 0) flat in vec3 u;
layout(location = 1) flat in vec3 v;
layout(location = 0) out float result;
void main() {
    float a = u.x, b = u.y, c = u.z;
    result = )" + function.glsl +
                               ";\n}\n";
    const auto words = compileGlsl(VK_SHADER_STAGE_FRAGMENT_BIT, source);
    if (!words) return Error{words.error().code, function.name + ": " + words.error().message};
    ShaderSource shader;
    shader.words = *words;
    shader.stage = ir::Stage::fragment;
    const auto program = loadShader(shader);
    if (!program) return Error{program.error().code, function.name + ": " + program.error().message};
    const auto compiled = BatchProgram::compile(*program, {isa, tier, 64});
    if (!compiled) return Error{compiled.error().code, function.name + ": " + compiled.error().message};
    BatchFunction result;
    result.program_ = *compiled;
    result.slots_.fill(kNoSlot);
    for (uint32_t slot = 0; slot < program->inputs.size(); ++slot) {
        const ir::InterfaceSlot& input = program->inputs[slot];
        result.slots_[input.location * 3u + input.component] = slot;
    }
    return result;
}

BatchRunner::BatchRunner(const BatchFunction& function)
    : function_(function), context_(function.program()), mask_(function.program()->lanes(), ~0u) {
    context_.beginDraw({});
}

void BatchRunner::run(const Operands& operands, std::span<float> results) {
    const size_t lanes = function_.program()->lanes();
    for (size_t first = 0; first < results.size(); first += lanes) {
        const size_t count = std::min(lanes, results.size() - first);
        for (uint32_t k = 0; k < kMaxOperands; ++k) {
            if (operands[k].empty() || function_.slot(k) == BatchFunction::kNoSlot) continue;
            float* row = context_.input(function_.slot(k));
            if (row != nullptr) std::copy_n(operands[k].data() + first, count, row);
        }
        context_.run(static_cast<uint32_t>(lanes), mask_.data(), mask_.data());
        std::copy_n(context_.output(0), count, results.data() + first);
    }
}

}  // namespace vernier::precision
