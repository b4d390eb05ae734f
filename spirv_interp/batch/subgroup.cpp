// Operations between the lanes of a subgroup: 32 lanes of the batch in a row, so that any set of them is one word. All
// results are made lane by lane in a fixed order, and do not depend on the instruction set.
#include <algorithm>
#include <bit>
#include <limits>
#include <type_traits>

#include "spirv_interp/batch/half.h"
#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::batch {
namespace {

constexpr uint32_t kSize = ir::kSubgroupSize;

/// The lanes of the subgroup that begins at `first` that run here.
uint32_t activeLanes(const Frame& frame, uint32_t first) {
    return static_cast<uint32_t>(frame.masks[kCurrentMask].from(first));
}

/// Calls function(first lane, lanes) for every subgroup; the last may be half there.
template <class F>
void forEachSubgroup(const Frame& frame, F&& function) {
    for (uint32_t first = 0; first < frame.lanes; first += kSize) function(first, std::min(kSize, frame.lanes - first));
}

void fillWord(uint32_t* row, uint32_t lanes, uint32_t word) {
    std::fill_n(row, lanes, word);
}

/// `value` of the lane at `place` of a group of `size` lanes, those of which in `active` run.
uint32_t taken(const uint32_t* values, uint32_t active, uint32_t place, uint32_t size) {
    return place < size && (active >> place & 1) != 0 ? values[place] : 0;
}

template <class T>
struct LaneWords {
    uint32_t *low, *high;  // high: of 64-bit types only

    T get(uint32_t lane) const {
        if constexpr (sizeof(T) == 8) {
            return std::bit_cast<T>(uint64_t{high[lane]} << 32 | low[lane]);
        } else {
            return std::bit_cast<T>(low[lane]);
        }
    }
    void set(uint32_t lane, T value) const {
        if constexpr (sizeof(T) == 8) {
            const auto bits = std::bit_cast<uint64_t>(value);
            low[lane] = static_cast<uint32_t>(bits);
            high[lane] = static_cast<uint32_t>(bits >> 32);
        } else {
            low[lane] = std::bit_cast<uint32_t>(value);
        }
    }
};

template <class T>
LaneWords<T> wordsAt(const Frame& frame, uint32_t row, uint32_t first) {
    uint32_t* high = sizeof(T) == 8 ? frame.row<uint32_t>(row + frame.rowBytes) + first : nullptr;
    return {frame.row<uint32_t>(row) + first, high};
}

/// The operations of ir::ReduceOp with their identities ("Group Operation" in the SPIR-V specification). Integers are
/// unsigned here, so that sums and products wrap.
template <class T>
using Signed = std::make_signed_t<T>;
template <ir::ReduceOp kOp, class T>
struct Reduce;

#define VERNIER_REDUCE(name, identity_, expression)         \
    template <class T>                                      \
    struct Reduce<ir::ReduceOp::name, T> {                  \
        static constexpr T identity() { return identity_; } \
        static T apply(T a, T b) { return expression; }     \
    };

VERNIER_REDUCE(iadd, 0, a + b)
VERNIER_REDUCE(imul, 1, a* b)
VERNIER_REDUCE(smin, std::numeric_limits<Signed<T>>::max(),
               static_cast<Signed<T>>(a) < static_cast<Signed<T>>(b) ? a : b)
VERNIER_REDUCE(smax, static_cast<T>(std::numeric_limits<Signed<T>>::min()),
               static_cast<Signed<T>>(a) > static_cast<Signed<T>>(b) ? a : b)
VERNIER_REDUCE(umin, std::numeric_limits<T>::max(), std::min(a, b))
VERNIER_REDUCE(umax, 0, std::max(a, b))
VERNIER_REDUCE(iand, static_cast<T>(~T{0}), a& b)
VERNIER_REDUCE(ior, 0, a | b)
VERNIER_REDUCE(ixor, 0, a ^ b)
VERNIER_REDUCE(fadd, 0, a + b)
VERNIER_REDUCE(fmul, 1, a* b)
// Sums and products of two halves are exact in double.
VERNIER_REDUCE(hadd, 0, nearestHalf(double{a} + double{b}))
VERNIER_REDUCE(hmul, 1, nearestHalf(double{a} * double{b}))
// A NaN gives way to a number.
VERNIER_REDUCE(fmin, std::numeric_limits<T>::infinity(), b != b || a < b ? a : b)
VERNIER_REDUCE(fmax, -std::numeric_limits<T>::infinity(), b != b || a > b ? a : b)

#undef VERNIER_REDUCE

/// One cluster, or a whole subgroup: `active` are its lanes that run.
template <class Op, class T>
void reduceLanes(const LaneWords<T>& from, const LaneWords<T>& to, uint32_t active, ir::ReduceMode mode) {
    T sum = Op::identity();
    bool any = false;
    for (uint32_t left = active; left != 0; left &= left - 1) {
        const auto lane = static_cast<uint32_t>(std::countr_zero(left));
        // The first value stands for itself: the identity of a float sum would change the sign of a zero.
        const T value = from.get(lane), next = any ? Op::apply(sum, value) : value;
        if (mode != ir::ReduceMode::reduce) to.set(lane, mode == ir::ReduceMode::inclusive ? next : sum);
        sum = next;
        any = true;
    }
    if (mode != ir::ReduceMode::reduce) return;
    for (uint32_t left = active; left != 0; left &= left - 1) {
        to.set(static_cast<uint32_t>(std::countr_zero(left)), sum);
    }
}

template <ir::ReduceOp kOp, class T>
void reduce(const Frame& frame, const Inst* inst, ir::ReduceMode mode, uint32_t cluster) {
    const uint32_t lanesOfCluster = cluster == kSize ? ~0u : (1u << cluster) - 1;
    forEachSubgroup(frame, [&](uint32_t first, uint32_t lanes) {
        const LaneWords<T> from = wordsAt<T>(frame, inst->operand[1], first);
        const LaneWords<T> to = wordsAt<T>(frame, inst->operand[0], first);
        const uint32_t active = activeLanes(frame, first);
        for (uint32_t lane = 0; lane < lanes; lane += cluster) {
            reduceLanes<Reduce<kOp, T>, T>(from, to, active & lanesOfCluster << lane, mode);
        }
    });
}

template <class Integer, class Float>
void reduceAs(const Frame& frame, const Inst* inst) {
    const uint32_t packed = inst->operand[2];
    const auto mode = static_cast<ir::ReduceMode>(packed >> 8 & 0xFF);
    const uint32_t cluster = packed >> 16;
    switch (static_cast<ir::ReduceOp>(packed & 0xFF)) {
#define VERNIER_REDUCE(name, T) \
    case ir::ReduceOp::name:    \
        return reduce<ir::ReduceOp::name, T>(frame, inst, mode, cluster);
        VERNIER_REDUCE(iadd, Integer)
        VERNIER_REDUCE(imul, Integer)
        VERNIER_REDUCE(smin, Integer)
        VERNIER_REDUCE(smax, Integer)
        VERNIER_REDUCE(umin, Integer)
        VERNIER_REDUCE(umax, Integer)
        VERNIER_REDUCE(iand, Integer)
        VERNIER_REDUCE(ior, Integer)
        VERNIER_REDUCE(ixor, Integer)
        VERNIER_REDUCE(fadd, Float)
        VERNIER_REDUCE(fmul, Float)
        VERNIER_REDUCE(fmin, Float)
        VERNIER_REDUCE(fmax, Float)
        VERNIER_REDUCE(hadd, float)
        VERNIER_REDUCE(hmul, float)
#undef VERNIER_REDUCE
    }
}

}  // namespace

const Inst* subgroupInvocation(Frame& frame, const Inst* inst) {
    auto* row = frame.row<uint32_t>(inst->operand[0]);
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) row[lane] = lane % kSize;
    return inst + 1;
}

const Inst* subgroupBallot(Frame& frame, const Inst* inst) {
    auto* to = frame.row<uint32_t>(inst->operand[0]);
    const auto* from = frame.row<uint32_t>(inst->operand[1]);
    forEachSubgroup(frame, [&](uint32_t first, uint32_t lanes) {
        uint32_t word = 0;
        for (uint32_t lane = 0; lane < lanes; ++lane) word |= (from[first + lane] >> 31) << lane;
        fillWord(to + first, lanes, word & activeLanes(frame, first));
    });
    return inst + 1;
}

const Inst* subgroupActive(Frame& frame, const Inst* inst) {
    forEachSubgroup(frame, [&](uint32_t first, uint32_t lanes) {
        fillWord(frame.row<uint32_t>(inst->operand[0]) + first, lanes, activeLanes(frame, first));
    });
    return inst + 1;
}

const Inst* subgroupShuffle(Frame& frame, const Inst* inst) {
    auto* to = frame.row<uint32_t>(inst->operand[0]);
    const auto *from = frame.row<uint32_t>(inst->operand[1]), *places = frame.row<uint32_t>(inst->operand[2]);
    forEachSubgroup(frame, [&](uint32_t first, uint32_t lanes) {
        const uint32_t active = activeLanes(frame, first);
        for (uint32_t lane = first; lane < first + lanes; ++lane) {
            to[lane] = taken(from + first, active, places[lane], kSize);
        }
    });
    return inst + 1;
}

const Inst* subgroupBroadcast(Frame& frame, const Inst* inst) {
    auto* to = frame.row<uint32_t>(inst->operand[0]);
    const auto* from = frame.row<uint32_t>(inst->operand[1]);
    const uint32_t place = frame.scalars[inst->operand[2]];
    forEachSubgroup(frame, [&](uint32_t first, uint32_t lanes) {
        fillWord(to + first, lanes, taken(from + first, activeLanes(frame, first), place, kSize));
    });
    return inst + 1;
}

const Inst* quadShuffle(Frame& frame, const Inst* inst) {
    constexpr uint32_t kQuad = 4;
    auto* to = frame.row<uint32_t>(inst->operand[0]);
    const auto *from = frame.row<uint32_t>(inst->operand[1]), *places = frame.row<uint32_t>(inst->operand[2]);
    for (uint32_t first = 0; first < frame.lanes; first += kQuad) {
        const uint32_t active = activeLanes(frame, first) & 0xF;
        for (uint32_t lane = first; lane < first + kQuad; ++lane) {
            to[lane] = taken(from + first, active, places[lane] % kQuad, kQuad);
        }
    }
    return inst + 1;
}

const Inst* subgroupReduce(Frame& frame, const Inst* inst) {
    reduceAs<uint32_t, float>(frame, inst);
    return inst + 1;
}

const Inst* subgroupReduce64(Frame& frame, const Inst* inst) {
    reduceAs<uint64_t, double>(frame, inst);
    return inst + 1;
}

}  // namespace vernier::batch
