// Strips: how elementwise operations run; included once per SIMD target (see base/simd.h).
//
// A handler is a function whose vector arguments hold one value of a whole strip of lanes: the accumulator. It loads
// its other operands, stores its result if its form says so, and jumps to the handler of the next instruction with
// the result as its arguments: a sibling call, for which the compiler emits a plain jump. Handlers that are no
// elementwise operations (plain handlers) return the next instruction to execute(), which calls its handler.
// Builds in which calls are not turned into jumps return after every instruction and keep the accumulator in the
// frame; every backward jump returns to execute(), so that no loop can grow the stack.
#if defined(VERNIER_BATCH_STRIP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_BATCH_STRIP_INL_H
#undef VERNIER_BATCH_STRIP_INL_H
#else
#define VERNIER_BATCH_STRIP_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <utility>

#include "spirv_interp/batch/bytecode.h"
#include "spirv_interp/batch/forms.h"

#ifndef VERNIER_BATCH_CHAINED
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VERNIER_BATCH_CHAINED true
#else
#define VERNIER_BATCH_CHAINED false
#endif
#endif

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::ScalableTag<float>;
using I32 = hn::ScalableTag<int32_t>;
using U32 = hn::ScalableTag<uint32_t>;
inline constexpr F32 kF32{};
inline constexpr I32 kI32{};
inline constexpr U32 kU32{};
using VF = hn::Vec<F32>;
using VI = hn::Vec<I32>;
using VU = hn::Vec<U32>;

inline constexpr size_t kVectorLanes = HWY_LANES(uint32_t);
/// As many as the calling convention passes in registers, and no more lanes than a mask has bits.
inline constexpr size_t kStripVectors = kVectorLanes * 8 <= kMaxLanes ? 8 : kMaxLanes / kVectorLanes;

/// The bits of a vector of b1 words.
HWY_INLINE uint64_t bitsOf(VU words) {
#if HWY_TARGET == HWY_AVX3
    return hn::MaskFromVec(hn::BitCast(kI32, words)).raw;
#elif HWY_TARGET == HWY_AVX2
    return static_cast<uint32_t>(_mm256_movemask_ps(hn::BitCast(kF32, words).raw));
#elif HWY_TARGET == HWY_SSE4
    return static_cast<uint32_t>(_mm_movemask_ps(hn::BitCast(kF32, words).raw));
#else
    alignas(16) static constexpr uint32_t kBits[kVectorLanes] = {1, 2, 4, 8};
    return vaddvq_u32(hn::And(words, hn::Load(kU32, kBits)).raw);
#endif
}

/// Vector K of an operand of a strip. No objects: the compiler turns no call into a jump while one might be in use.
template <class T, Source kSource>
struct StripOperand {
    using D = hn::ScalableTag<T>;
    template <size_t K>
    static HWY_INLINE hn::Vec<D> at(const std::byte* rows, const uint32_t* scalars, uint32_t place, VU accumulator) {
        if constexpr (kSource == Source::row) {
            (void)scalars, (void)accumulator;
            return hn::Load(D(), reinterpret_cast<const T*>(rows + place) + K * kVectorLanes);
        } else if constexpr (kSource == Source::scalar) {
            (void)rows, (void)accumulator;
            return hn::BitCast(D(), hn::Set(kU32, scalars[place]));
        } else {
            (void)rows, (void)scalars, (void)place;
            return hn::BitCast(D(), accumulator);
        }
    }
};

/// The handlers for strips of sizeof...(K) vectors.
template <class Indices>
struct Strip;

template <size_t... K>
struct Strip<std::index_sequence<K...>> {
    template <size_t>
    using Vector = VU;
    using StripHandler = const Inst* (*)(Frame&, const Inst*, std::byte* rows, uint32_t* scalars,
                                         Vector<K>... accumulator);

    static Handler erase(StripHandler handler) { return reinterpret_cast<Handler>(handler); }

    static void execute(Frame& frame, const Inst* at) {
        while (at != nullptr) {
            const auto handler = reinterpret_cast<StripHandler>(at->handler);
            if constexpr (VERNIER_BATCH_CHAINED) {
                at = handler(frame, at, frame.rows, frame.scalars, zero(K)...);
            } else {
                at = handler(frame, at, frame.rows, frame.scalars,
                             hn::Load(kU32, frame.accumulator + K * kVectorLanes)...);
            }
        }
    }

    /// Goes on with an instruction further down, with these vectors as the accumulator.
    static HWY_INLINE const Inst* proceed(Frame& frame, const Inst* next, std::byte* rows, uint32_t* scalars,
                                          Vector<K>... accumulator) {
        if constexpr (VERNIER_BATCH_CHAINED) {
            return reinterpret_cast<StripHandler>(next->handler)(frame, next, rows, scalars, accumulator...);
        } else {
            (hn::Store(accumulator, kU32, frame.accumulator + K * kVectorLanes), ...);
            return next;
        }
    }

    template <bool kStored>
    static HWY_INLINE const Inst* finish(Frame& frame, const Inst* inst, const Inst* next, std::byte* rows,
                                         uint32_t* scalars, Vector<K>... result) {
        if constexpr (kStored) {
            auto* row = reinterpret_cast<uint32_t*>(rows + inst->operand[0]);
            (hn::Store(result, kU32, row + K * kVectorLanes), ...);
        }
        return proceed(frame, next, rows, scalars, result...);
    }

    template <PlainHandler kHandler>
    static const Inst* plain(Frame& frame, const Inst* inst, std::byte*, uint32_t*, Vector<K>...) {
        return kHandler(frame, inst);
    }

    /// An elementwise operation. With scalars alone as operands its result is a scalar, and the accumulator stays.
    template <class E, size_t kOperands, uint8_t kForm>
    static const Inst* element(Frame& frame, const Inst* inst, std::byte* rows, uint32_t* scalars, Vector<K>... acc) {
        constexpr Form form = Form::at(kForm);
        if constexpr (form.count(Source::scalar, kOperands) == kOperands) {
            scalars[inst->operand[0]] = hn::GetLane(vectorOf<E, kOperands, kForm, 0>(inst, rows, scalars, zero(0)));
            return proceed(frame, inst + 1, rows, scalars, acc...);
        } else {
            return finish<form.stored>(frame, inst, inst + 1, rows, scalars,
                                       vectorOf<E, kOperands, kForm, K>(inst, rows, scalars, acc)...);
        }
    }

    /// An operation with operands of its own kind: E::at<K, source>(rows, scalars, inst, accumulator) is vector K of
    /// the result, and it takes E::kInsts Insts. Its first operand may be the accumulator.
    template <class E, Source kSource, bool kStored>
    static const Inst* compound(Frame& frame, const Inst* inst, std::byte* rows, uint32_t* scalars, Vector<K>... acc) {
        return finish<kStored>(frame, inst, inst + E::kInsts, rows, scalars,
                               hn::BitCast(kU32, E::template at<K, kSource>(rows, scalars, inst, acc))...);
    }

    /// A plain handler that only ever goes on further down, and leaves the accumulator as it is.
    template <PlainHandler kHandler>
    static const Inst* forward(Frame& frame, const Inst* inst, std::byte* rows, uint32_t* scalars, Vector<K>... acc) {
        return proceed(frame, kHandler(frame, inst), rows, scalars, acc...);
    }

    /// The lanes of a b1 operand.
    template <Source kSource>
    static HWY_INLINE uint64_t lanesOf(const std::byte* rows, const uint32_t* scalars, uint32_t place,
                                       Vector<K>... acc) {
        return (
            (bitsOf(StripOperand<uint32_t, kSource>::template at<K>(rows, scalars, place, acc)) << (K * kVectorLanes)) |
            ...);
    }

  private:
    static HWY_INLINE VU zero(size_t) { return hn::Zero(kU32); }

    template <class E, size_t kOperands, uint8_t kForm, size_t kVector>
    static HWY_INLINE VU vectorOf(const Inst* inst, const std::byte* rows, const uint32_t* scalars, VU acc) {
        using T = typename E::InType;
        constexpr Form form = Form::at(kForm);
        const auto a = StripOperand<T, form.sources[0]>::template at<kVector>(rows, scalars, inst->operand[1], acc);
        if constexpr (kOperands == 1) {
            return hn::BitCast(kU32, E::apply(a));
        } else {
            const auto b = StripOperand<T, form.sources[1]>::template at<kVector>(rows, scalars, inst->operand[2], acc);
            if constexpr (kOperands == 2) {
                return hn::BitCast(kU32, E::apply(a, b));
            } else {
                const auto c =
                    StripOperand<T, form.sources[2]>::template at<kVector>(rows, scalars, inst->operand[3], acc);
                return hn::BitCast(kU32, E::apply(a, b, c));
            }
        }
    }
};

using FullStrip = Strip<std::make_index_sequence<kStripVectors>>;
using NarrowStrip = Strip<std::make_index_sequence<kLaneGroup / kVectorLanes>>;

/// Enters a plain handler.
template <PlainHandler kHandler>
void addPlain(HandlerTables& tables, Op op, size_t form = 0) {
    tables.full[static_cast<size_t>(op)][form] = FullStrip::erase(FullStrip::plain<kHandler>);
    tables.narrow[static_cast<size_t>(op)][form] = NarrowStrip::erase(NarrowStrip::plain<kHandler>);
}

/// Enters a plain handler that satisfies Strip::forward.
template <PlainHandler kHandler>
void addForward(HandlerTables& tables, Op op, size_t form = 0) {
    tables.full[static_cast<size_t>(op)][form] = FullStrip::erase(FullStrip::forward<kHandler>);
    tables.narrow[static_cast<size_t>(op)][form] = NarrowStrip::erase(NarrowStrip::forward<kHandler>);
}

/// Enters an operation that satisfies Strip::compound.
template <class E>
void addCompound(HandlerTables& tables, Op op) {
    const auto add = [op](auto strip, HandlerTable& table) {
        using S = decltype(strip);
        const auto enter = [&](Form form, Handler handler) { table[static_cast<size_t>(op)][form.index()] = handler; };
        enter({}, S::erase(S::template compound<E, Source::row, true>));
        enter({{}, false}, S::erase(S::template compound<E, Source::row, false>));
        enter({{Source::accumulator}}, S::erase(S::template compound<E, Source::accumulator, true>));
        enter({{Source::accumulator}, false}, S::erase(S::template compound<E, Source::accumulator, false>));
    };
    add(FullStrip(), tables.full);
    add(NarrowStrip(), tables.narrow);
}

/// Enters the handlers of every form of an elementwise operation.
template <class E, size_t kOperands, FormSet kSet, uint8_t kForm = 0>
void addElement(HandlerTables& tables, Op op) {
    if constexpr (hasForm(kOperands, kSet, Form::at(kForm))) {
        tables.full[static_cast<size_t>(op)][kForm] = FullStrip::erase(FullStrip::element<E, kOperands, kForm>);
        tables.narrow[static_cast<size_t>(op)][kForm] = NarrowStrip::erase(NarrowStrip::element<E, kOperands, kForm>);
    }
    if constexpr (kForm + 1 < kForms) addElement<E, kOperands, kSet, kForm + 1>(tables, op);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
