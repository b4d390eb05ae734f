// Subgroup operations, the older ones of SPV_KHR_shader_ballot and SPV_KHR_subgroup_vote among them. A subgroup is one
// word of lanes: nearly everything is made of ballots and shuffles.
#include <algorithm>
#include <bit>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

using ir::Op;

struct Arithmetic {
    spv::Op spirv;
    ir::ReduceOp op;
};

constexpr Arithmetic kArithmetic[] = {
    {spv::Op::OpGroupNonUniformIAdd, ir::ReduceOp::iadd},
    {spv::Op::OpGroupNonUniformFAdd, ir::ReduceOp::fadd},
    {spv::Op::OpGroupNonUniformIMul, ir::ReduceOp::imul},
    {spv::Op::OpGroupNonUniformFMul, ir::ReduceOp::fmul},
    {spv::Op::OpGroupNonUniformSMin, ir::ReduceOp::smin},
    {spv::Op::OpGroupNonUniformUMin, ir::ReduceOp::umin},
    {spv::Op::OpGroupNonUniformFMin, ir::ReduceOp::fmin},
    {spv::Op::OpGroupNonUniformSMax, ir::ReduceOp::smax},
    {spv::Op::OpGroupNonUniformUMax, ir::ReduceOp::umax},
    {spv::Op::OpGroupNonUniformFMax, ir::ReduceOp::fmax},
    {spv::Op::OpGroupNonUniformBitwiseAnd, ir::ReduceOp::iand},
    {spv::Op::OpGroupNonUniformBitwiseOr, ir::ReduceOp::ior},
    {spv::Op::OpGroupNonUniformBitwiseXor, ir::ReduceOp::ixor},
    {spv::Op::OpGroupNonUniformLogicalAnd, ir::ReduceOp::iand},
    {spv::Op::OpGroupNonUniformLogicalOr, ir::ReduceOp::ior},
    {spv::Op::OpGroupNonUniformLogicalXor, ir::ReduceOp::ixor},
};

}  // namespace

ir::ValueId Lowering::subgroupInvocation() {
    return emitter_.emit(Op::subgroupInvocation, ir::Type::i32, {});
}

ir::ValueId Lowering::ballot(ir::ValueId condition) {
    return emitter_.emit(Op::subgroupBallot, ir::Type::i32, {condition});
}

/// The first lane that runs.
ir::ValueId Lowering::firstInvocation() {
    return unary(Op::findILsb, ballot(emitter_.constantBool(true)));
}

/// What a lane's place compares with, as bits: those of the lanes before it, or up to it.
ir::ValueId Lowering::lanesBefore(bool itself) {
    // 2 << 31 is 0: all lanes are up to the last.
    const ir::ValueId one = emitter_.constantI32(1);
    const ir::ValueId place = binary(Op::shl, one, subgroupInvocation());
    return binary(Op::isub, itself ? binary(Op::shl, place, one) : place, one);
}

ir::ValueId Lowering::shuffle(Op op, ir::ValueId value, ir::ValueId place) {
    const ir::Type type = emitter_.typeOf(value);
    if (ir::isWide(type)) {
        const auto word = [&](Op half) { return shuffle(op, emitter_.emit(half, ir::Type::i32, {value}), place); };
        const ir::ValueId low = word(Op::lowWord);
        return emitter_.emit(Op::makeWide, type, {low, word(Op::highWord)});
    }
    if (type == ir::Type::b1) {
        const ir::ValueId word = emitter_.emit(op, ir::Type::i32, {convert(Op::zext, ir::Type::i32, value), place});
        return compare(Op::ine, word, emitter_.constantI32(0));
    }
    return emitter_.emit(op, type, {value, place});
}

void Lowering::shuffleEach(const Instruction& inst, Op op, uint32_t valueId, ir::ValueId place) {
    const Leaves values = leavesOf(valueId);
    const NewScalars leaves = newLeaves(values.size());
    for (size_t i = 0; i < leaves.size(); ++i) leaves[i] = shuffle(op, values[i], place);
    setValue(inst[2], inst[1], leaves);
}

/// A ballot is a vector of four words, of which a subgroup fills the first.
void Lowering::setBallot(const Instruction& inst, ir::ValueId word) {
    const NewScalars leaves = newLeaves(4);
    std::fill(leaves.begin(), leaves.end(), emitter_.constantI32(0));
    leaves[0] = word;
    setValue(inst[2], inst[1], leaves);
}

void Lowering::lowerReduction(const Instruction& inst, ir::ReduceOp op) {
    ir::Reduction reduction;
    reduction.op = op;
    switch (static_cast<spv::GroupOperation>(inst[4])) {
        case spv::GroupOperation::Reduce:
            break;
        case spv::GroupOperation::InclusiveScan:
            reduction.mode = ir::ReduceMode::inclusive;
            break;
        case spv::GroupOperation::ExclusiveScan:
            reduction.mode = ir::ReduceMode::exclusive;
            break;
        case spv::GroupOperation::ClusteredReduce:
            reduction.cluster = constantIndex(inst[6]);
            if (!std::has_single_bit(reduction.cluster) || reduction.cluster > ir::kSubgroupSize) {
                refuse(inst, "clusters of " + std::to_string(reduction.cluster) +
                                 " invocations; a power of two up to " + std::to_string(ir::kSubgroupSize) +
                                 " is needed");
            }
            break;
        default:
            refuse(inst, "group operation " + std::to_string(inst[4]) + " is not supported");
    }
    const Leaves values = leavesOf(inst[5]);
    const NewScalars leaves = newLeaves(values.size());
    const LeafTypes types = leafTypes(inst[1]);
    const auto ofHalves = [](ir::ReduceOp of) {
        return of == ir::ReduceOp::fadd ? ir::ReduceOp::hadd : of == ir::ReduceOp::fmul ? ir::ReduceOp::hmul : of;
    };
    const bool looksAtSign = op == ir::ReduceOp::smin || op == ir::ReduceOp::smax;
    for (size_t i = 0; i < leaves.size(); ++i) {
        const ir::ValueId value = looksAtSign ? signExtended(values[i], types[i]) : values[i];
        reduction.op = types[i].isHalf() ? ofHalves(op) : op;
        ir::ValueId result = emitter_.emit(Op::subgroupReduce, types[i], {value}, ir::immOf(reduction));
        if (looksAtSign && types[i].isNarrowInteger()) {
            // The identity of 32 bits becomes that of the type.
            const uint32_t largest = types[i].mask() >> 1;
            result = binary(Op::smin, result, emitter_.constantI32(largest));
            result = binary(Op::smax, result, emitter_.constantI32(~largest));
        }
        leaves[i] = types[i].isNarrowInteger() ? normalised(result, types[i]) : result;
    }
    setValue(inst[2], inst[1], leaves);
}

/// Whether all lanes that run have the value of the first, component by component.
ir::ValueId Lowering::allEqual(Leaves values) {
    const ir::ValueId first = firstInvocation();
    ir::ValueId different = emitter_.constantBool(false);
    for (const ir::ValueId value : values) {
        const ir::ValueId other = shuffle(Op::subgroupShuffle, value, first);
        const Op op = ir::isFloat(emitter_.typeOf(value)) ? Op::fune : Op::ine;
        const ir::ValueId differs =
            emitter_.typeOf(value) == ir::Type::b1 ? binary(Op::bxor, value, other) : compare(op, value, other);
        different = binary(Op::bor, different, differs);
    }
    return compare(Op::ieq, ballot(different), emitter_.constantI32(0));
}

bool Lowering::lowerBallot(const Instruction& inst) {
    const ir::ValueId zero = emitter_.constantI32(0);
    switch (inst.op) {
        case spv::Op::OpGroupNonUniformBallot:
            setBallot(inst, ballot(scalarOf(inst[4])));
            return true;
        case spv::Op::OpSubgroupBallotKHR:
            setBallot(inst, ballot(scalarOf(inst[3])));
            return true;
        case spv::Op::OpGroupNonUniformInverseBallot:
        case spv::Op::OpGroupNonUniformBallotBitExtract: {
            const bool own = inst.op == spv::Op::OpGroupNonUniformInverseBallot;
            const ir::ValueId place = own ? subgroupInvocation() : toI32(scalarOf(inst[5]));
            const ir::ValueId bit =
                binary(Op::iand, binary(Op::lshr, leavesOf(inst[4])[0], place), emitter_.constantI32(1));
            setScalar(inst[2], inst[1], compare(Op::ine, bit, zero));
            return true;
        }
        case spv::Op::OpGroupNonUniformBallotBitCount: {
            ir::ValueId word = leavesOf(inst[5])[0];
            const auto operation = static_cast<spv::GroupOperation>(inst[4]);
            if (operation == spv::GroupOperation::InclusiveScan) word = binary(Op::iand, word, lanesBefore(true));
            if (operation == spv::GroupOperation::ExclusiveScan) word = binary(Op::iand, word, lanesBefore(false));
            setScalar(inst[2], inst[1], unary(Op::bitCount, word));
            return true;
        }
        case spv::Op::OpGroupNonUniformBallotFindLSB:
        case spv::Op::OpGroupNonUniformBallotFindMSB:
            setScalar(inst[2], inst[1],
                      unary(inst.op == spv::Op::OpGroupNonUniformBallotFindLSB ? Op::findILsb : Op::findUMsb,
                            leavesOf(inst[4])[0]));
            return true;
        default:
            return false;
    }
}

bool Lowering::lowerVote(const Instruction& inst) {
    const auto isZero = [this](ir::ValueId word) { return compare(Op::ieq, word, emitter_.constantI32(0)); };
    switch (inst.op) {
        case spv::Op::OpGroupNonUniformElect:
            setScalar(inst[2], inst[1], compare(Op::ieq, subgroupInvocation(), firstInvocation()));
            return true;
        case spv::Op::OpGroupNonUniformAll:
        case spv::Op::OpSubgroupAllKHR: {
            const ir::ValueId condition = scalarOf(inst[inst.op == spv::Op::OpSubgroupAllKHR ? 3 : 4]);
            setScalar(inst[2], inst[1], isZero(ballot(unary(Op::bnot, condition))));
            return true;
        }
        case spv::Op::OpGroupNonUniformAny:
        case spv::Op::OpSubgroupAnyKHR: {
            const ir::ValueId condition = scalarOf(inst[inst.op == spv::Op::OpSubgroupAnyKHR ? 3 : 4]);
            setScalar(inst[2], inst[1], unary(Op::bnot, isZero(ballot(condition))));
            return true;
        }
        case spv::Op::OpGroupNonUniformAllEqual:
        case spv::Op::OpSubgroupAllEqualKHR:
            setScalar(inst[2], inst[1], allEqual(leavesOf(inst[inst.op == spv::Op::OpSubgroupAllEqualKHR ? 3 : 4])));
            return true;
        default:
            return false;
    }
}

bool Lowering::lowerShuffle(const Instruction& inst) {
    const auto own = [this] { return subgroupInvocation(); };
    const auto operand = [&](uint32_t word) { return toI32(scalarOf(inst[word])); };
    switch (inst.op) {
        case spv::Op::OpGroupNonUniformBroadcast:
        case spv::Op::OpGroupNonUniformShuffle:
            shuffleEach(inst, Op::subgroupShuffle, inst[4], operand(5));
            return true;
        case spv::Op::OpSubgroupReadInvocationKHR:
            shuffleEach(inst, Op::subgroupShuffle, inst[3], operand(4));
            return true;
        case spv::Op::OpGroupNonUniformBroadcastFirst:
            shuffleEach(inst, Op::subgroupShuffle, inst[4], firstInvocation());
            return true;
        case spv::Op::OpSubgroupFirstInvocationKHR:
            shuffleEach(inst, Op::subgroupShuffle, inst[3], firstInvocation());
            return true;
        case spv::Op::OpGroupNonUniformShuffleXor:
            shuffleEach(inst, Op::subgroupShuffle, inst[4], binary(Op::ixor, own(), operand(5)));
            return true;
        case spv::Op::OpGroupNonUniformShuffleUp:
            shuffleEach(inst, Op::subgroupShuffle, inst[4], binary(Op::isub, own(), operand(5)));
            return true;
        case spv::Op::OpGroupNonUniformShuffleDown:
            shuffleEach(inst, Op::subgroupShuffle, inst[4], binary(Op::iadd, own(), operand(5)));
            return true;
        case spv::Op::OpGroupNonUniformQuadBroadcast:
            shuffleEach(inst, Op::quadShuffle, inst[4], operand(5));
            return true;
        case spv::Op::OpGroupNonUniformQuadSwap: {
            // Horizontal, vertical, diagonal: the neighbour differs in the lower, the upper or both bits of its place.
            const ir::ValueId place = binary(Op::iand, own(), emitter_.constantI32(3));
            const ir::ValueId bits = binary(Op::iadd, operand(5), emitter_.constantI32(1));
            shuffleEach(inst, Op::quadShuffle, inst[4], binary(Op::ixor, place, bits));
            return true;
        }
        default:
            return false;
    }
}

bool Lowering::lowerSubgroup(const Instruction& inst) {
    const auto found = std::find_if(std::begin(kArithmetic), std::end(kArithmetic),
                                    [&](const Arithmetic& entry) { return entry.spirv == inst.op; });
    if (found != std::end(kArithmetic)) {
        lowerReduction(inst, found->op);
        return true;
    }
    return lowerBallot(inst) || lowerVote(inst) || lowerShuffle(inst);
}

}  // namespace vernier
