#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <iterator>
#include <map>

#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp>

namespace vernier::proof {
namespace {

constexpr uint32_t kHeader = 5;

/// Instructions that may stand for each other.
const std::vector<std::vector<uint32_t>> kForms = {
    {spv::OpFAdd, spv::OpFSub, spv::OpFMul, spv::OpFDiv, spv::OpFRem, spv::OpFMod},
    {spv::OpIAdd, spv::OpISub, spv::OpIMul, spv::OpSDiv, spv::OpSRem, spv::OpSMod, spv::OpBitwiseAnd, spv::OpBitwiseOr,
     spv::OpBitwiseXor, spv::OpShiftLeftLogical, spv::OpShiftRightLogical, spv::OpShiftRightArithmetic, spv::OpUDiv,
     spv::OpUMod},
    {spv::OpSNegate, spv::OpNot, spv::OpBitReverse, spv::OpBitCount},
    {spv::OpFOrdEqual, spv::OpFOrdLessThan, spv::OpFUnordGreaterThan, spv::OpFUnordNotEqual,
     spv::OpFOrdGreaterThanEqual},
    {spv::OpIEqual, spv::OpINotEqual, spv::OpSLessThan, spv::OpULessThan, spv::OpSGreaterThanEqual,
     spv::OpUGreaterThan},
    {spv::OpLogicalAnd, spv::OpLogicalOr, spv::OpLogicalEqual, spv::OpLogicalNotEqual},
    {spv::OpDPdx, spv::OpDPdy, spv::OpFwidth, spv::OpDPdxFine, spv::OpDPdyCoarse, spv::OpFNegate},
    {spv::OpReturn, spv::OpKill, spv::OpUnreachable, spv::OpTerminateInvocation},
    {spv::OpAtomicIAdd, spv::OpAtomicISub, spv::OpAtomicSMin, spv::OpAtomicUMax, spv::OpAtomicExchange,
     spv::OpAtomicXor},
    {spv::OpConvertSToF, spv::OpConvertUToF},
    {spv::OpConvertFToS, spv::OpConvertFToU},
};

struct Instruction {
    uint32_t at, count, op, type, result;
};

std::vector<Instruction> read(const std::vector<uint32_t>& words) {
    std::vector<Instruction> list;
    for (uint32_t at = kHeader; at < words.size();) {
        const uint32_t count = words[at] >> 16;
        if (count == 0 || count > words.size() - at) return {};
        Instruction i{at, count, words[at] & 0xFFFF, 0, 0};
        bool hasResult = false, hasType = false;
        spv::HasResultAndType(static_cast<spv::Op>(i.op), &hasResult, &hasType);
        if (hasType && count > 1) i.type = words[at + 1];
        if (hasResult && count > (hasType ? 2 : 1)) i.result = words[at + (hasType ? 2 : 1)];
        list.push_back(i);
        at += count;
    }
    return list;
}

}  // namespace

void mutateModule(std::vector<uint32_t>& words, std::mt19937& random) {
    for (uint32_t changes = 1 + random() % 4; changes > 0; --changes) {
        const std::vector<Instruction> list = read(words);
        if (list.empty()) return;
        const auto any = [&]() -> const Instruction& { return list[random() % list.size()]; };
        std::map<uint32_t, uint32_t> typeOf;
        for (const Instruction& i : list)
            if (i.result != 0) typeOf[i.result] = i.type;
        const Instruction& i = any();
        const uint32_t operand = i.count > 1 ? 1 + random() % (i.count - 1) : 0;
        switch (random() % 10) {
            case 0:
            case 1:
            case 2: {
                // An operand for another value of its type.
                const auto found = operand != 0 ? typeOf.find(words[i.at + operand]) : typeOf.end();
                if (found == typeOf.end() || found->second == 0) break;
                std::vector<uint32_t> same;
                for (const auto& [id, type] : typeOf)
                    if (type == found->second) same.push_back(id);
                words[i.at + operand] = same[random() % same.size()];
                break;
            }
            case 3:
            case 4:
                for (const auto& form : kForms) {
                    if (std::find(form.begin(), form.end(), i.op) == form.end()) continue;
                    words[i.at] = i.count << 16 | form[random() % form.size()];
                }
                break;
            case 5:
                // A literal: of a constant, a member number, a mask.
                if (operand == 0) break;
                words[i.at + operand] = random() % 2 == 0 ? words[i.at + operand] ^ 1u << random() % 32 : random() % 40;
                break;
            case 6:
                if (operand != 0) words[i.at + operand] = random() % std::max(words[3], 1u);
                break;
            case 7:
                words.erase(words.begin() + i.at, words.begin() + i.at + i.count);
                break;
            case 8: {
                // A copy with a result of its own, next to it.
                std::vector<uint32_t> copy(words.begin() + i.at, words.begin() + i.at + i.count);
                if (i.result != 0) copy[i.type != 0 ? 2 : 1] = words[3]++;
                words.insert(words.begin() + i.at + i.count, copy.begin(), copy.end());
                break;
            }
            default: {
                const Instruction& other = any();
                const std::vector<uint32_t> copy(words.begin() + i.at, words.begin() + i.at + i.count);
                if (other.at > i.at) {
                    words.insert(words.begin() + other.at, copy.begin(), copy.end());
                    words.erase(words.begin() + i.at, words.begin() + i.at + i.count);
                }
                break;
            }
        }
    }
}

}  // namespace vernier::proof
