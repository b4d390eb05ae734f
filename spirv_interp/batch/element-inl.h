// Operations of plain handlers over the lanes of a batch; included once per SIMD target (see base/simd.h).
#if defined(VERNIER_BATCH_ELEMENT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_BATCH_ELEMENT_INL_H
#undef VERNIER_BATCH_ELEMENT_INL_H
#else
#define VERNIER_BATCH_ELEMENT_INL_H
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include "base/simd-inl.h"
#include "spirv_interp/batch/bytecode.h"
#include "spirv_interp/batch/strip-inl.h"

/// Declares a vector operation: `In` is the element type its operands are read as, `Out` the type of its
/// result.
#define VERNIER_ELEMENT(name, In, Out, parameters, ...)                                  \
    struct name {                                                                        \
        using InType = In;                                                               \
        using V = hn::Vec<hn::ScalableTag<In>>;                                          \
        static HWY_INLINE hn::Vec<hn::ScalableTag<Out>> apply parameters { __VA_ARGS__ } \
    };

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A comparison's result as a b1 row: all ones or all zeros.
template <class M>
HWY_INLINE VU boolRow(M mask) {
    return hn::VecFromMask(kU32, hn::RebindMask(kU32, mask));
}

/// Shift counts are taken modulo the width.
HWY_INLINE VU shiftedLeft(VU a, VU b) {
    return hn::Shl(a, hn::And(b, hn::Set(kU32, 31u)));
}
HWY_INLINE VU shiftedRight(VU a, VU b) {
    return hn::Shr(a, hn::And(b, hn::Set(kU32, 31u)));
}

/// An operand: a row that is read vector by vector, or a scalar that is in a register for the whole loop.
template <class T, bool kScalar>
class LaneOperand;

template <class T>
class LaneOperand<T, false> {
  public:
    HWY_INLINE LaneOperand(const Frame& frame, uint32_t offset) : row_(frame.row<T>(offset)) {}
    HWY_INLINE hn::Vec<hn::ScalableTag<T>> at(size_t lane) const { return hn::Load(hn::ScalableTag<T>(), row_ + lane); }

  private:
    const T* row_;
};

template <class T>
class LaneOperand<T, true> {
  public:
    HWY_INLINE LaneOperand(const Frame& frame, uint32_t index)
        : value_(hn::BitCast(hn::ScalableTag<T>(), hn::Set(kU32, frame.scalars[index]))) {}
    HWY_INLINE hn::Vec<hn::ScalableTag<T>> at(size_t) const { return value_; }

  private:
    hn::Vec<hn::ScalableTag<T>> value_;
};

/// Calls function(lane) for the first lane of every vector and stores what it returns. The row and the count
/// are read once: for all the compiler knows, storing lanes could change the frame.
template <class F>
HWY_INLINE void fillRow(const Frame& frame, uint32_t offset, F&& function) {
    auto* row = frame.row<uint32_t>(offset);
    const size_t lanes = frame.lanes;
    for (size_t lane = 0; lane < lanes; lane += hn::Lanes(kU32)) {
        hn::Store(hn::BitCast(kU32, function(lane)), kU32, row + lane);
    }
}

/// A function of vectors over rows, all operands rows: for functions too long to be unrolled over a strip.
template <class E, size_t kOperands>
const Inst* runRows(Frame& frame, const Inst* inst) {
    using T = typename E::InType;
    const LaneOperand<T, false> a(frame, inst->operand[1]);
    if constexpr (kOperands == 1) {
        fillRow(frame, inst->operand[0], [&](size_t lane) HWY_ATTR { return E::apply(a.at(lane)); });
    } else {
        static_assert(kOperands == 2);
        const LaneOperand<T, false> b(frame, inst->operand[2]);
        fillRow(frame, inst->operand[0], [&](size_t lane) HWY_ATTR { return E::apply(a.at(lane), b.at(lane)); });
    }
    return inst + 1;
}

template <class T>
HWY_INLINE T readLane(const Frame& frame, uint32_t offset, uint32_t lane) {
    const uint32_t low = frame.row<uint32_t>(offset)[lane];
    if constexpr (sizeof(T) == 8) {
        const uint64_t high = frame.row<uint32_t>(offset + frame.rowBytes)[lane];
        return std::bit_cast<T>(high << 32 | low);
    } else {
        return std::bit_cast<T>(low);
    }
}

template <class T>
HWY_INLINE void writeLane(const Frame& frame, uint32_t offset, uint32_t lane, T value) {
    if constexpr (std::is_same_v<T, bool>) {
        frame.row<uint32_t>(offset)[lane] = value ? ~0u : 0u;
    } else if constexpr (sizeof(T) == 8) {
        const auto bits = std::bit_cast<uint64_t>(value);
        frame.row<uint32_t>(offset)[lane] = static_cast<uint32_t>(bits);
        frame.row<uint32_t>(offset + frame.rowBytes)[lane] = static_cast<uint32_t>(bits >> 32);
    } else {
        frame.row<uint32_t>(offset)[lane] = std::bit_cast<uint32_t>(value);
    }
}

/// The values of a lane group, in memory: loops over them are for the compiler to turn into vector code.
template <class T>
struct LaneValues {
    static HWY_INLINE void load(const Frame& frame, uint32_t offset, uint32_t lane, T* values) {
        const auto* low = frame.row<uint32_t>(offset) + lane;
        if constexpr (sizeof(T) == 8) {
            const auto* high = frame.row<uint32_t>(offset + frame.rowBytes) + lane;
            for (uint32_t k = 0; k < kLaneGroup; ++k) values[k] = std::bit_cast<T>(uint64_t{high[k]} << 32 | low[k]);
        } else {
            for (uint32_t k = 0; k < kLaneGroup; ++k) values[k] = std::bit_cast<T>(low[k]);
        }
    }
    static HWY_INLINE void store(const Frame& frame, uint32_t offset, uint32_t lane, const T* values) {
        auto* low = frame.row<uint32_t>(offset) + lane;
        if constexpr (std::is_same_v<T, bool>) {
            for (uint32_t k = 0; k < kLaneGroup; ++k) low[k] = values[k] ? ~0u : 0u;
        } else if constexpr (sizeof(T) == 8) {
            auto* high = frame.row<uint32_t>(offset + frame.rowBytes) + lane;
            for (uint32_t k = 0; k < kLaneGroup; ++k)
                low[k] = static_cast<uint32_t>(std::bit_cast<uint64_t>(values[k]));
            for (uint32_t k = 0; k < kLaneGroup; ++k) {
                high[k] = static_cast<uint32_t>(std::bit_cast<uint64_t>(values[k]) >> 32);
            }
        } else {
            for (uint32_t k = 0; k < kLaneGroup; ++k) low[k] = std::bit_cast<uint32_t>(values[k]);
        }
    }
};

/// An operation given as a function of one lane; 4-byte types are rows, 8-byte types pairs of rows, bool is a
/// b1 row.
template <auto kFunction>
struct LaneRunner;

template <class R, class... A, R (*kFunction)(A...)>
struct LaneRunner<kFunction> {
    static const Inst* run(Frame& frame, const Inst* inst) {
        call(frame, inst, std::index_sequence_for<A...>());
        return inst + instsFor(sizeof...(A) + 1);
    }
    /// With scalars for operands and result; 4-byte types only.
    static const Inst* runScalar(Frame& frame, const Inst* inst) {
        callScalar(frame.scalars, inst, std::index_sequence_for<A...>());
        return inst + instsFor(sizeof...(A) + 1);
    }
    static constexpr bool kScalar = ((sizeof(A) == 4) && ...) && (sizeof(R) == 4);

  private:
    template <size_t... kIndex>
    static HWY_INLINE void callScalar(uint32_t* scalars, const Inst* inst, std::index_sequence<kIndex...>) {
        scalars[(*inst)[0]] = std::bit_cast<uint32_t>(kFunction(std::bit_cast<A>(scalars[(*inst)[kIndex + 1]])...));
    }
    template <size_t... kIndex>
    static HWY_INLINE void call(Frame& frame, const Inst* inst, std::index_sequence<kIndex...>) {
        for (uint32_t lane = 0; lane < frame.lanes; lane += kLaneGroup) {
            // All operands are taken over before a result is written: it may lie where one of them does.
            std::tuple<std::array<A, kLaneGroup>...> from;
            (LaneValues<A>::load(frame, (*inst)[kIndex + 1], lane, std::get<kIndex>(from).data()), ...);
            std::array<R, kLaneGroup> result;
            for (uint32_t k = 0; k < kLaneGroup; ++k) result[k] = kFunction(std::get<kIndex>(from)[k]...);
            LaneValues<R>::store(frame, (*inst)[0], lane, result.data());
        }
    }
};

template <auto kFunction>
void addLanes(HandlerTables& tables, Op op) {
    addPlain<LaneRunner<kFunction>::run>(tables, op);
    if constexpr (LaneRunner<kFunction>::kScalar) addPlain<LaneRunner<kFunction>::runScalar>(tables, op, 1);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
