// Barriers and subgroup operations. Each is a meeting: every invocation brings its operands, and works out its own
// result from what all that take part have brought. Reductions run over the invocations in order.
#include <algorithm>
#include <bit>
#include <limits>

#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/machine.h"

namespace vernier::reference {
namespace {

template <class Number>
using Group = std::vector<Scalars<Number>>;

template <class Number>
uint32_t activeMask(const Group<Number>& group) {
    uint32_t mask = 0;
    for (size_t k = 0; k < group.size(); ++k)
        if (!group[k].empty()) mask |= 1u << k;
    return mask;
}

template <class Number>
bool equal(const Scalars<Number>& a, const Scalars<Number>& b, bool floating) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [=](const Scalar<Number>& x, const Scalar<Number>& y) {
        return floating ? x.number == y.number : x.bits == y.bits;
    });
}

/// The instruction on two values that a reduction is made of; OpNop for float minimum and maximum.
spv::Op combination(spv::Op op) {
    switch (op) {
        case spv::OpGroupNonUniformIAdd:
            return spv::OpIAdd;
        case spv::OpGroupNonUniformIMul:
            return spv::OpIMul;
        case spv::OpGroupNonUniformBitwiseAnd:
            return spv::OpBitwiseAnd;
        case spv::OpGroupNonUniformBitwiseOr:
            return spv::OpBitwiseOr;
        case spv::OpGroupNonUniformBitwiseXor:
            return spv::OpBitwiseXor;
        case spv::OpGroupNonUniformLogicalAnd:
            return spv::OpLogicalAnd;
        case spv::OpGroupNonUniformLogicalOr:
            return spv::OpLogicalOr;
        case spv::OpGroupNonUniformLogicalXor:
            return spv::OpLogicalNotEqual;
        default:
            return spv::OpNop;
    }
}

bool isReduction(spv::Op op) {
    return op >= spv::OpGroupNonUniformIAdd && op <= spv::OpGroupNonUniformLogicalXor;
}

/// What a scan gives before the first value (SPIR-V specification, the identity I of each operation).
template <class Number>
Scalar<Number> identity(spv::Op op, uint32_t width) {
    using S = Scalar<Number>;
    const uint64_t mask = widthMask(width), top = uint64_t{1} << (width - 1);
    switch (op) {
        case spv::OpGroupNonUniformIMul:
        case spv::OpGroupNonUniformLogicalAnd:
            return S::ofBits(1);
        case spv::OpGroupNonUniformFMul:
            return S::ofNumber(Number(1));
        case spv::OpGroupNonUniformSMin:
            return S::ofBits(mask >> 1);
        case spv::OpGroupNonUniformSMax:
            return S::ofBits(top);
        case spv::OpGroupNonUniformUMin:
        case spv::OpGroupNonUniformBitwiseAnd:
            return S::ofBits(mask);
        case spv::OpGroupNonUniformFMin:
            return S::ofNumber(Number(std::numeric_limits<float>::infinity()));
        case spv::OpGroupNonUniformFMax:
            return S::ofNumber(-Number(std::numeric_limits<float>::infinity()));
        default:
            return {};
    }
}

template <class Number>
Scalar<Number> combined(spv::Op op, uint32_t width, const Scalar<Number>& a, const Scalar<Number>& b) {
    using std::isnan;
    using S = Scalar<Number>;
    switch (op) {
        case spv::OpGroupNonUniformFAdd:
            return S::ofNumber(a.number + b.number);
        case spv::OpGroupNonUniformFMul:
            return S::ofNumber(a.number * b.number);
        case spv::OpGroupNonUniformFMin:
            return isnan(b.number) || a.number < b.number ? a : b;
        case spv::OpGroupNonUniformFMax:
            return isnan(b.number) || b.number < a.number ? a : b;
        case spv::OpGroupNonUniformSMin:
            return asSigned(b.bits, width) < asSigned(a.bits, width) ? b : a;
        case spv::OpGroupNonUniformSMax:
            return asSigned(a.bits, width) < asSigned(b.bits, width) ? b : a;
        case spv::OpGroupNonUniformUMin:
            return b.bits < a.bits ? b : a;
        case spv::OpGroupNonUniformUMax:
            return a.bits < b.bits ? b : a;
        default:
            return S::ofBits(*integerOperation(combination(op), width, {a.bits, b.bits, 0, 0}));
    }
}

}  // namespace

template <class Number>
bool Machine<Number>::executeVote(const Instruction& i, size_t first) {
    using S = Scalar<Number>;
    const bool elect = i.op == spv::OpGroupNonUniformElect;
    if (!meet(Meeting::exchange, elect ? Scalars<Number>(1) : data(i.operand(first)))) return true;
    bool result = false;
    switch (i.op) {
        case spv::OpGroupNonUniformElect:
            result = static_cast<uint32_t>(std::countr_zero(activeMask(*group_))) == invocation_;
            break;
        case spv::OpGroupNonUniformAllEqual:
        case spv::OpSubgroupAllEqualKHR: {
            const Type& type = module_.scalarType(module_.valueType(i.operand(first)));
            result = std::all_of(group_->begin(), group_->end(), [&](const Scalars<Number>& other) {
                return other.empty() || equal(other, (*group_)[invocation_], type.kind == TypeKind::floating);
            });
            break;
        }
        default: {
            const bool any = i.op == spv::OpGroupNonUniformAny || i.op == spv::OpSubgroupAnyKHR;
            result = !any;
            for (const Scalars<Number>& other : *group_)
                if (!other.empty()) result = any ? result || other[0].bits != 0 : result && other[0].bits != 0;
            break;
        }
    }
    group_.reset();
    setResult(i, S::ofBits(result ? 1 : 0));
    return true;
}

/// Ballots are vectors of four words; only the first has bits, as subgroups have no more than 32 invocations.
template <class Number>
bool Machine<Number>::executeBallot(const Instruction& i, size_t first) {
    using S = Scalar<Number>;
    const auto word = [&](size_t operand) { return static_cast<uint32_t>(data(i.operand(operand), 4)[0].bits); };
    switch (i.op) {
        case spv::OpGroupNonUniformBallot:
        case spv::OpSubgroupBallotKHR: {
            if (!meet(Meeting::exchange, data(i.operand(first), 1))) return true;
            uint32_t mask = 0;
            for (size_t k = 0; k < group_->size(); ++k)
                if (!(*group_)[k].empty() && (*group_)[k][0].bits != 0) mask |= 1u << k;
            group_.reset();
            setResult(i, {S::ofBits(mask), S{}, S{}, S{}});
            return true;
        }
        case spv::OpGroupNonUniformInverseBallot:
            setResult(i, S::ofBits(word(first) >> invocation_ & 1));
            return true;
        case spv::OpGroupNonUniformBallotBitExtract: {
            const uint64_t index = bits(i.operand(first + 1));
            setResult(i, S::ofBits(index < kSubgroupSize ? word(first) >> index & 1 : 0));
            return true;
        }
        case spv::OpGroupNonUniformBallotFindLSB:
        case spv::OpGroupNonUniformBallotFindMSB: {
            // Undefined when no bit is set: -1, as FindILsb gives.
            const uint32_t mask = word(first);
            const int found =
                i.op == spv::OpGroupNonUniformBallotFindLSB ? std::countr_zero(mask) : 31 - std::countl_zero(mask);
            setResult(i, S::ofInt(mask == 0 ? -1 : found));
            return true;
        }
        case spv::OpGroupNonUniformBallotBitCount: {
            const uint32_t below = (1u << invocation_) - 1;
            uint32_t mask = word(first + 1);
            if (i.operand(first) == spv::GroupOperationInclusiveScan) mask &= below | 1u << invocation_;
            if (i.operand(first) == spv::GroupOperationExclusiveScan) mask &= below;
            setResult(i, S::ofBits(static_cast<uint64_t>(std::popcount(mask))));
            return true;
        }
        default:
            return false;
    }
}

/// What an invocation that does not take part would give is undefined: 0.
template <class Number>
bool Machine<Number>::executeShuffle(const Instruction& i, size_t first) {
    const auto operand = [&](size_t k) { return static_cast<uint32_t>(bits(i.operand(first + k))); };
    const Scalars<Number>& mine = data(i.operand(first));
    if (!meet(Meeting::exchange, mine)) return true;
    uint32_t from = invocation_;
    switch (i.op) {
        case spv::OpGroupNonUniformBroadcast:
        case spv::OpGroupNonUniformShuffle:
        case spv::OpSubgroupReadInvocationKHR:
            from = operand(1);
            break;
        case spv::OpGroupNonUniformBroadcastFirst:
        case spv::OpSubgroupFirstInvocationKHR:
            from = static_cast<uint32_t>(std::countr_zero(activeMask(*group_)));
            break;
        case spv::OpGroupNonUniformShuffleXor:
            from = invocation_ ^ operand(1);
            break;
        case spv::OpGroupNonUniformShuffleUp:
            from = invocation_ - operand(1);
            break;
        case spv::OpGroupNonUniformShuffleDown:
            from = invocation_ + operand(1);
            break;
        case spv::OpGroupNonUniformQuadBroadcast:
            from = (invocation_ & ~3u) | (operand(1) & 3u);
            break;
        default:  // QuadSwap: horizontal, vertical, diagonal
            from = invocation_ ^ (operand(1) + 1);
            break;
    }
    Scalars<Number> result(mine.size());
    if (from < group_->size() && !(*group_)[from].empty()) result = (*group_)[from];
    group_.reset();
    setResult(i, std::move(result));
    return true;
}

template <class Number>
bool Machine<Number>::executeReduction(const Instruction& i) {
    if (!meet(Meeting::exchange, data(i.operand(2)))) return true;
    const uint32_t width = module_.scalarType(resultType(i)).width;
    uint32_t begin = 0, end = static_cast<uint32_t>(group_->size());
    switch (static_cast<spv::GroupOperation>(i.operand(1))) {
        case spv::GroupOperationReduce:
            break;
        case spv::GroupOperationInclusiveScan:
            end = invocation_ + 1;
            break;
        case spv::GroupOperationExclusiveScan:
            end = invocation_;
            break;
        case spv::GroupOperationClusteredReduce: {
            const uint64_t size = bits(i.operand(3));
            if (size == 0 || (size & (size - 1)) != 0) fail("a cluster of " + std::to_string(size) + " invocations");
            if (size < end) {
                begin = invocation_ & ~(static_cast<uint32_t>(size) - 1);
                end = begin + static_cast<uint32_t>(size);
            }
            break;
        }
        default:
            failUnsupported("group operation " + std::to_string(i.operand(1)));
    }
    const size_t count = resultCount(i);
    Scalars<Number> result(count, identity<Number>(i.op, width));
    bool any = false;  // the first value stands for itself: 0 + -0 would lose the sign
    for (uint32_t k = begin; k < end; ++k) {
        const Scalars<Number>& other = (*group_)[k];
        if (other.empty()) continue;
        for (size_t c = 0; c < count; ++c) {
            result[c] = any ? combined(i.op, width, result[c], other[c]) : other[c];
            if (module_.scalarType(resultType(i)).kind == TypeKind::floating) round(result[c], width);
        }
        any = true;
    }
    group_.reset();
    setResult(i, std::move(result));
    return true;
}

template <class Number>
bool Machine<Number>::executeSubgroup(const Instruction& i) {
    if (isReduction(i.op)) return executeReduction(i);
    switch (i.op) {
        case spv::OpControlBarrier: {
            const bool subgroup = module_.constantInteger(i.operand(0)) >= spv::ScopeSubgroup;
            if (meet(subgroup ? Meeting::exchange : Meeting::barrier, Scalars<Number>(1))) group_.reset();
            return true;
        }
        case spv::OpGroupNonUniformElect:
        case spv::OpGroupNonUniformAll:
        case spv::OpGroupNonUniformAny:
        case spv::OpGroupNonUniformAllEqual:
            return executeVote(i, 1);
        case spv::OpSubgroupAllKHR:
        case spv::OpSubgroupAnyKHR:
        case spv::OpSubgroupAllEqualKHR:
            return executeVote(i, 0);
        case spv::OpSubgroupBallotKHR:
            return executeBallot(i, 0);
        case spv::OpGroupNonUniformBroadcast:
        case spv::OpGroupNonUniformBroadcastFirst:
        case spv::OpGroupNonUniformShuffle:
        case spv::OpGroupNonUniformShuffleXor:
        case spv::OpGroupNonUniformShuffleUp:
        case spv::OpGroupNonUniformShuffleDown:
        case spv::OpGroupNonUniformQuadBroadcast:
        case spv::OpGroupNonUniformQuadSwap:
            return executeShuffle(i, 1);
        case spv::OpSubgroupFirstInvocationKHR:
        case spv::OpSubgroupReadInvocationKHR:
            return executeShuffle(i, 0);
        default:
            return executeBallot(i, 1);
    }
}

template bool Machine<float>::executeSubgroup(const Instruction&);
template bool Machine<double>::executeSubgroup(const Instruction&);
template bool Machine<Real>::executeSubgroup(const Instruction&);

}  // namespace vernier::reference
