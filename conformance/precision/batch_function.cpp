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

std::string callText(const Function& function) {
    struct Format {
        const char *type, *open, *close;  // of a word, or a vector of two
    };
    const auto operandFormat = [](Word word) -> Format {
        switch (word) {
            case Word::float16:
                return {"float16_t", "unpackFloat2x16(floatBitsToUint(", ")).x"};
            case Word::int32:
                return {"int", "floatBitsToInt(", ")"};
            case Word::uint32:
                return {"uint", "floatBitsToUint(", ")"};
            case Word::float64:
                return {"double", "packDouble2x32(floatBitsToUint(", "))"};
            case Word::int64:
                return {"int64_t", "packInt2x32(floatBitsToInt(", "))"};
            case Word::uint64:
                return {"uint64_t", "packUint2x32(floatBitsToUint(", "))"};
            default:
                return {nullptr, "", ""};
        }
    };
    const auto result = [&]() -> std::string {
        switch (function.result) {
            case Word::int32:
                return "low = intBitsToFloat(" + function.glsl + ");";
            case Word::uint32:
                return "low = uintBitsToFloat(" + function.glsl + ");";
            case Word::float64:
                return "vec2 both = uintBitsToFloat(unpackDouble2x32(" + function.glsl + "));";
            case Word::int64:
                return "vec2 both = intBitsToFloat(unpackInt2x32(" + function.glsl + "));";
            case Word::uint64:
                return "vec2 both = uintBitsToFloat(unpackUint2x32(" + function.glsl + "));";
            default:
                return "low = float(" + function.glsl + ");";
        }
    };
    const bool wide = wordsOf(function.operand) == 2;
    const char* const operands[3] = {wide ? "u.xy" : "u.x", wide ? "vec2(u.z, v.x)" : "u.y", wide ? "v.yz" : "u.z"};
    std::string text = "float a = u.x, b = u.y, c = u.z, low = 0, high = 0;\n";
    const Format format = operandFormat(function.operand);
    for (uint32_t k = 0; format.type != nullptr && k < function.operands; ++k) {
        text += std::string(format.type) + " " + "pqr"[k] + " = " + format.open + operands[k] + format.close + ";\n";
    }
    text += result() + "\n";
    if (wordsOf(function.result) == 2) text += "low = both.x; high = both.y;\n";
    return text;
}

Result<BatchFunction> BatchFunction::compile(const Function& function, MathTier tier, Isa isa) {
    const bool wide = wordsOf(function.result) == 2;
    const std::string source = std::string("#version 450\n") + kGlslExtensions + R"(
layout(location = 0) flat in vec3 u;
layout(location = 1) flat in vec3 v;
layout(location = 0) out float lowResult;
)" + (wide ? "layout(location = 1) out float highResult;\n" : "") +
                               "void main() {\n" + callText(function) + "lowResult = low;\n" +
                               (wide ? "highResult = high;\n" : "") + "}\n";
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
    for (uint32_t slot = 0; slot < program->outputs.size(); ++slot) {
        result.outputs_[program->outputs[slot].location] = slot;
    }
    result.words_ = wordsOf(function.result);
    return result;
}

BatchRunner::BatchRunner(const BatchFunction& function)
    : function_(function), context_(function.program()), mask_(function.program()->lanes(), ~0u) {
    context_.beginDraw({});
}

void BatchRunner::run(const Operands& operands, size_t calls, Results& results) {
    const size_t lanes = function_.program()->lanes();
    for (uint32_t word = 0; word < function_.words(); ++word) results[word].resize(calls);
    for (size_t first = 0; first < calls; first += lanes) {
        const size_t count = std::min(lanes, calls - first);
        for (uint32_t k = 0; k < kMaxOperands; ++k) {
            if (operands[k].empty() || function_.slot(k) == BatchFunction::kNoSlot) continue;
            float* row = context_.input(function_.slot(k));
            if (row != nullptr) std::copy_n(operands[k].data() + first, count, row);
        }
        context_.run(static_cast<uint32_t>(lanes), mask_.data(), mask_.data());
        for (uint32_t word = 0; word < function_.words(); ++word) {
            std::copy_n(context_.output(function_.output(word)), count, results[word].data() + first);
        }
    }
}

}  // namespace vernier::precision
