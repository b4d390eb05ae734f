#include "spirv_interp/tool/trace.h"

#include <cstdio>
#include <memory>

#include <spirv-tools/libspirv.h>
#include <spirv/unified1/GLSL.std.450.h>

#include "spirv_interp/reference/module_data.h"

namespace vernier::tool {

using reference::Module;
using reference::Step;

namespace {

const char* glslName(uint32_t function) {
    switch (function) {
#define VERNIER_NAME(name) \
    case GLSLstd450##name: \
        return #name;
        VERNIER_NAME(Round)
        VERNIER_NAME(RoundEven)
        VERNIER_NAME(Trunc)
        VERNIER_NAME(FAbs)
        VERNIER_NAME(SAbs)
        VERNIER_NAME(FSign)
        VERNIER_NAME(SSign)
        VERNIER_NAME(Floor)
        VERNIER_NAME(Ceil)
        VERNIER_NAME(Fract)
        VERNIER_NAME(Radians)
        VERNIER_NAME(Degrees)
        VERNIER_NAME(Sin)
        VERNIER_NAME(Cos)
        VERNIER_NAME(Tan)
        VERNIER_NAME(Asin)
        VERNIER_NAME(Acos)
        VERNIER_NAME(Atan)
        VERNIER_NAME(Sinh)
        VERNIER_NAME(Cosh)
        VERNIER_NAME(Tanh)
        VERNIER_NAME(Asinh)
        VERNIER_NAME(Acosh)
        VERNIER_NAME(Atanh)
        VERNIER_NAME(Atan2)
        VERNIER_NAME(Pow)
        VERNIER_NAME(Exp)
        VERNIER_NAME(Log)
        VERNIER_NAME(Exp2)
        VERNIER_NAME(Log2)
        VERNIER_NAME(Sqrt)
        VERNIER_NAME(InverseSqrt)
        VERNIER_NAME(Determinant)
        VERNIER_NAME(MatrixInverse)
        VERNIER_NAME(Modf)
        VERNIER_NAME(ModfStruct)
        VERNIER_NAME(FMin)
        VERNIER_NAME(UMin)
        VERNIER_NAME(SMin)
        VERNIER_NAME(FMax)
        VERNIER_NAME(UMax)
        VERNIER_NAME(SMax)
        VERNIER_NAME(FClamp)
        VERNIER_NAME(UClamp)
        VERNIER_NAME(SClamp)
        VERNIER_NAME(FMix)
        VERNIER_NAME(Step)
        VERNIER_NAME(SmoothStep)
        VERNIER_NAME(Fma)
        VERNIER_NAME(Frexp)
        VERNIER_NAME(FrexpStruct)
        VERNIER_NAME(Ldexp)
        VERNIER_NAME(Length)
        VERNIER_NAME(Distance)
        VERNIER_NAME(Cross)
        VERNIER_NAME(Normalize)
        VERNIER_NAME(FaceForward)
        VERNIER_NAME(Reflect)
        VERNIER_NAME(Refract)
        VERNIER_NAME(NMin)
        VERNIER_NAME(NMax)
        VERNIER_NAME(NClamp)
#undef VERNIER_NAME
        default:
            return nullptr;
    }
}

/// Operands from here on are ids (as far as they are values): what comes before are literals or a set's number.
size_t firstIdOperand(spv::Op op) {
    return op == spv::OpExtInst ? 2 : 0;
}

bool literalsBehind(spv::Op op, size_t operand) {
    switch (op) {
        case spv::OpCompositeExtract:
        case spv::OpLoad:
            return operand >= 1;
        case spv::OpCompositeInsert:
        case spv::OpVectorShuffle:
        case spv::OpStore:
        case spv::OpSelectionMerge:
            return operand >= 2 || (op == spv::OpSelectionMerge && operand >= 1);
        case spv::OpVariable:
            return operand == 0;
        case spv::OpLoopMerge:
            return operand >= 2;
        case spv::OpBranchConditional:
            return operand >= 3;
        default:
            return false;
    }
}

}  // namespace

std::string idName(const Module& module, uint32_t id) {
    const auto found = module.data().names.find(id);
    if (found != module.data().names.end() && !found->second.empty()) return found->second;
    const auto& data = module.data();
    if (id < data.ids.size() && data.ids[id].kind == reference::IdKind::constant) {
        const reference::Constant& constant = data.constants[data.ids[id].index];
        if (constant.scalars.size() == 1) {
            const reference::Type& type = data.types[constant.type];
            char text[32];
            if (type.kind == reference::TypeKind::floating) {
                std::snprintf(text, sizeof text, "%.9g", constant.scalars[0].number);
            } else {
                std::snprintf(text, sizeof text, "%lld",
                              static_cast<long long>(static_cast<int32_t>(constant.scalars[0].bits)));
            }
            return text;
        }
    }
    return "%" + std::to_string(id);
}

std::string operationName(const Step& step) {
    if (step.op == spv::OpExtInst && step.operands.size() > 1) {
        if (const char* name = glslName(step.operands[1])) return name;
    }
    return reference::name(step.op);
}

std::string valueText(const Step& step) {
    std::string text;
    for (size_t k = 0; k < step.numbers.size(); ++k) {
        char scalar[40];
        if (step.isFloat) {
            std::snprintf(scalar, sizeof scalar, "%.9g", step.numbers[k]);
        } else {
            std::snprintf(scalar, sizeof scalar, "%lld", static_cast<long long>(static_cast<int32_t>(step.bits[k])));
        }
        text += (k > 0 ? ", " : "") + std::string(scalar);
    }
    return step.numbers.size() > 1 ? "(" + text + ")" : text;
}

std::string stepText(const Module& module, const Step& step) {
    std::string text = step.line != 0 ? "line " + std::to_string(step.line) : std::string();
    text.resize(std::max<size_t>(text.size() + 2, 11), ' ');
    if (step.result != 0) text += idName(module, step.result) + " = ";
    text += operationName(step);
    for (size_t k = firstIdOperand(step.op); k < step.operands.size(); ++k) {
        text +=
            " " + (literalsBehind(step.op, k) ? std::to_string(step.operands[k]) : idName(module, step.operands[k]));
    }
    const std::string value = valueText(step);
    if (!value.empty()) {
        text.resize(std::max<size_t>(text.size() + 2, 64), ' ');
        text += value;
    }
    return text;
}

}  // namespace vernier::tool
