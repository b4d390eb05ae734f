#include "spirv_interp/front/spelling.h"

#include <vector>

#include "spirv_interp/front/spirv_tools.h"

namespace vernier {
namespace {

/// One instruction as text without a line break; empty when it is none.
std::string disassembled(const std::vector<uint32_t>& instruction) {
    std::vector<uint32_t> words{spv::MagicNumber, 0x00010600, 0, 1u << 20, 0};
    words.insert(words.end(), instruction.begin(), instruction.end());
    const SpirvContext context(spvContextCreate(SPV_ENV_UNIVERSAL_1_6));
    spv_text made = nullptr;
    const spv_result_t status =
        spvBinaryToText(context.get(), words.data(), words.size(), SPV_BINARY_TO_TEXT_OPTION_NO_HEADER, &made, nullptr);
    const SpirvText text(made);
    if (status != SPV_SUCCESS) return {};
    std::string result(text->str, text->length);
    result.erase(result.find_last_not_of(" \n") + 1);
    return result;
}

}  // namespace

std::string lastOperandOf(spv::Op op, std::initializer_list<uint32_t> operands) {
    std::vector<uint32_t> words{static_cast<uint32_t>(operands.size() + 1) << 16 | static_cast<uint32_t>(op)};
    words.insert(words.end(), operands.begin(), operands.end());
    const std::string text = disassembled(words);
    return text.empty() ? std::to_string(words.back()) : text.substr(text.find_last_of(' ') + 1);
}

std::string nameOf(spv::Capability capability) {
    return lastOperandOf(spv::Op::OpCapability, {static_cast<uint32_t>(capability)});
}

std::string nameOf(spv::BuiltIn builtin) {
    constexpr auto kBuiltIn = static_cast<uint32_t>(spv::Decoration::BuiltIn);
    return lastOperandOf(spv::Op::OpDecorate, {1, kBuiltIn, static_cast<uint32_t>(builtin)});
}

std::string nameOf(spv::StorageClass storage) {
    return lastOperandOf(spv::Op::OpVariable, {1, 2, static_cast<uint32_t>(storage)});
}

std::string nameOf(spv::Decoration decoration) {
    return lastOperandOf(spv::Op::OpDecorate, {1, static_cast<uint32_t>(decoration)});
}

std::string executionModeOf(const Instruction& inst) {
    // "OpExecutionMode %4 LocalSize 8 8 1"
    std::string text = disassembled({inst.words, inst.words + inst.count});
    for (int word = 0; word < 2 && !text.empty(); ++word)
        text.erase(0, text.find(' ') == std::string::npos ? text.size() : text.find(' ') + 1);
    return text.empty() ? std::to_string(inst[2]) : text.substr(0, text.find(' '));
}

}  // namespace vernier
