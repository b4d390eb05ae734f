#include "spirv_interp/batch/select.h"

#include <array>

#include "spirv_interp/ir/ops.h"

namespace vernier::batch {
namespace {

enum class Family : uint8_t { vector, lanes, math, wide, other };

struct OpFacts {
    std::string_view name;
    uint8_t operands;
    Family family;
};

constexpr std::array<OpFacts, kOpCount> kFacts{{
#define VERNIER_BATCH_VECTOR(name, operands) {#name, operands + 1, Family::vector},
#define VERNIER_BATCH_LANES(name, operands) {#name, operands + 1, Family::lanes},
#define VERNIER_BATCH_MATH(name, operands) {#name, operands + 1, Family::math},
#define VERNIER_BATCH_WIDE(name, operands) {#name, operands + 1, Family::wide},
#define VERNIER_BATCH_OTHER(name, operands) {#name, operands, Family::other},
#include "spirv_interp/batch/ops.def"
}};

const OpFacts& factsOf(Op op) {
    return kFacts[static_cast<size_t>(op)];
}

/// The elementwise operation with this name.
std::optional<Op> elementNamed(std::string_view name, std::string_view suffix) {
    for (size_t k = 0; k < kOpCount; ++k) {
        const OpFacts& facts = kFacts[k];
        if (facts.family == Family::other || facts.name.size() != name.size() + suffix.size()) continue;
        if (facts.name.starts_with(name) && facts.name.ends_with(suffix)) return static_cast<Op>(k);
    }
    return std::nullopt;
}

}  // namespace

std::string_view opName(Op op) {
    return factsOf(op).name;
}
size_t operandCount(Op op) {
    return factsOf(op).operands;
}
bool isVectorOp(Op op) {
    return factsOf(op).family == Family::vector;
}
bool takesScalars(Op op) {
    return factsOf(op).family == Family::vector || factsOf(op).family == Family::lanes;
}
bool isWideOp(Op op) {
    return factsOf(op).family == Family::wide;
}

bool isMovableOp(Op op) {
    if (factsOf(op).family != Family::other) return true;
    switch (op) {
        case Op::bufferSize:
        case Op::inputIndexed:
        case Op::loadBuffer:
        case Op::loadByte:
        case Op::loadHalfword:
        case Op::loadLocal:
        case Op::loadLocalScalar:
            return true;
        case Op::broadcast:
        case Op::copy:
        case Op::ddxCoarse:
        case Op::ddxFine:
        case Op::ddyCoarse:
        case Op::ddyFine:
        case Op::dot2:
        case Op::dot2Scalar:
        case Op::dot3:
        case Op::dot3Scalar:
        case Op::dot4:
        case Op::dot4Scalar:
        case Op::unpackMultiply:
        case Op::unpackMultiplyAdd:
        case Op::unpackMultiplySubtract:
        case Op::unpackDot3:
            return true;
        default:
            return false;
    }
}

std::optional<StripShape> stripShape(const MachineInst& inst) {
    const bool result = inst.operands.empty() || !inst.operands[0].isScalar();
    if (isVectorOp(inst.op)) return StripShape{1, static_cast<uint8_t>(operandCount(inst.op) - 1), result};
    switch (inst.op) {
        case Op::dot2:
        case Op::dot3:
        case Op::dot4:
        case Op::dot2Scalar:
        case Op::dot3Scalar:
        case Op::dot4Scalar:
        case Op::unpackMultiply:
        case Op::unpackMultiplyAdd:
        case Op::unpackMultiplySubtract:
        case Op::unpackDot3:
        case Op::ddxFine:
        case Op::ddyFine:
        case Op::ddxCoarse:
        case Op::ddyCoarse:
        case Op::copy:
        case Op::broadcast:
            return StripShape{1, 1, true};
        case Op::copyMasked:
        case Op::broadcastMasked:
            return StripShape{1, 1, false};
        case Op::split:
        case Op::splitInto:
        case Op::splitPast:
        case Op::choose:
            return StripShape{0, 1, false};
        case Op::enter:
        case Op::leave:
        case Op::leaveInto:
        case Op::splitScalar:
        case Op::splitScalarInto:
        case Op::splitScalarPast:
        case Op::follow:
        case Op::skipEmpty:
        case Op::discard:
        case Op::moveScalar:
        case Op::countBlock:
            return StripShape{0, 0, false};
        case Op::loadBuffer:  // of a scalar
            return result ? std::nullopt : std::optional(StripShape{0, 0, false});
        default:
            return std::nullopt;
    }
}

std::optional<Op> elementOp(const ir::Program& program, const ir::Inst& inst) {
    const auto operands = program.operandsOf(inst);
    const auto operandType = operands.empty() ? ir::Type::none : program.valueTypes[operands[0]];
    const bool wideFrom = ir::isWide(operandType), wideTo = ir::isWide(inst.type);
    switch (inst.op) {
        // A b1 is a word of zeros or ones: logic on it is logic on integers.
        case ir::Op::band:
            return Op::iand;
        case ir::Op::bor:
            return Op::ior;
        case ir::Op::bxor:
            return Op::ixor;
        case ir::Op::bnot:
            return Op::inot;
        case ir::Op::ieq:
        case ir::Op::ine:
            if (operandType == ir::Type::b1) return inst.op == ir::Op::ieq ? Op::ieq : Op::ine;
            break;
        case ir::Op::zext:
            if (operandType == ir::Type::b1) return wideTo ? Op::boolTo64 : Op::boolToInt;
            return Op::zextTo64;
        case ir::Op::sext:
            return Op::sextTo64;
        case ir::Op::ftos:
        case ir::Op::ftou:
        case ir::Op::stof:
        case ir::Op::utof:
        case ir::Op::ftof:
            return elementNamed(ir::opInfo(inst.op).name, wideFrom && wideTo ? "64"
                                                          : wideFrom         ? "From64"
                                                          : wideTo           ? "To64"
                                                                             : "");
        case ir::Op::ftoh:
        case ir::Op::ftohZero:
            return elementNamed(ir::opInfo(inst.op).name, wideFrom ? "From64" : "");
        default:
            break;
    }
    return elementNamed(ir::opInfo(inst.op).name, wideFrom ? "64" : "");
}

}  // namespace vernier::batch
