// Masks, jumps, moves between rows, and derivatives.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/flow.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstring>

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/handlers.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {

/// The vector mask of the lanes from `lane` on.
HWY_INLINE hn::Mask<U32> vectorMask(const LaneMask& mask, size_t lane) {
    const uint64_t bits = mask.from(static_cast<uint32_t>(lane));
    uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof bytes);
    return hn::LoadMaskBits(kU32, bytes);
}

inline const Inst* jump(const Inst* inst, uint32_t distance) {
    return inst + static_cast<int32_t>(distance);
}

const Inst* keepScalar(Frame& frame, const Inst* inst) {
    frame.scalars[inst->operand[0]] = frame.row<uint32_t>(inst->operand[1])[0];
    return inst + 1;
}

HWY_INLINE const Inst* moveScalar(Frame& frame, const Inst* inst) {
    frame.scalars[inst->operand[0]] = frame.scalars[inst->operand[1]];
    return inst + 1;
}

const Inst* helperLanes(Frame& frame, const Inst* inst) {
    const LaneMask helpers = frame.exec.without(frame.live);
    fillRow(frame, inst->operand[0],
            [&](size_t lane) HWY_ATTR { return hn::VecFromMask(kU32, vectorMask(helpers, lane)); });
    return inst + 1;
}

HWY_INLINE const Inst* countBlock(Frame& frame, const Inst* inst) {
    ++frame.blockRuns[inst->operand[0]];
    return inst + 1;
}

HWY_INLINE const Inst* enter(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[0]];
    if (mask.empty()) return jump(inst, inst->operand[1]);
    frame.masks[kCurrentMask] = mask;
    mask = {};
    return inst + 1;
}

const Inst* repeat(Frame& frame, const Inst* inst) {
    if (frame.masks[inst->operand[0]].empty()) return inst + 1;
    if (--frame.backEdgesLeft == 0) {
        frame.lost = true;
        return nullptr;
    }
    return jump(inst, inst->operand[1]);
}

const Inst* again(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[0]];
    if (!mask.empty()) {
        mask = mask | frame.masks[kCurrentMask];
        return inst + 1;
    }
    if (--frame.backEdgesLeft == 0) {
        frame.lost = true;
        return nullptr;
    }
    return jump(inst, inst->operand[1]);
}

HWY_INLINE const Inst* leaveInto(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[0]];
    if (mask.empty()) return jump(inst, inst->operand[1]);
    mask = mask | frame.masks[kCurrentMask];
    return inst + 1;
}

HWY_INLINE const Inst* leave(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[0]];
    mask = mask | frame.masks[kCurrentMask];
    return inst + 1;
}

HWY_INLINE const Inst* splitScalar(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[frame.scalars[inst->operand[0]] != 0 ? 1 : 2]];
    mask = mask | frame.masks[kCurrentMask];
    return inst + 1;
}

/// Splits the current lanes into those of `yes` and the rest. `kNext`: the operand that names the mask of the next
/// block, if any.
template <size_t kNext>
HWY_INLINE const Inst* splitBy(Frame& frame, const Inst* inst, LaneMask yes) {
    const LaneMask current = frame.masks[kCurrentMask];
    const LaneMask no = current.without(yes);
    if constexpr (kNext != 0) {
        const LaneMask& others = kNext == 1 ? no : yes;
        if (others.empty() && frame.masks[inst->operand[kNext]].empty()) return jump(inst, inst->operand[3]);
    }
    frame.masks[inst->operand[1]] = frame.masks[inst->operand[1]] | yes;
    frame.masks[inst->operand[2]] = frame.masks[inst->operand[2]] | no;
    return inst + 1;
}

template <size_t kNext>
HWY_INLINE const Inst* splitScalarInto(Frame& frame, const Inst* inst) {
    const bool yes = frame.scalars[inst->operand[0]] != 0;
    LaneMask& mask = frame.masks[inst->operand[yes ? 1 : 2]];
    if (yes == (kNext == 1) && mask.empty()) return jump(inst, inst->operand[3]);
    mask = mask | frame.masks[kCurrentMask];
    return inst + 1;
}

HWY_INLINE const Inst* follow(Frame& frame, const Inst* inst) {
    LaneMask& to = frame.masks[inst->operand[0]];
    LaneMask& from = frame.masks[inst->operand[1]];
    to = to | from;
    from = {};
    return inst + 1;
}

HWY_INLINE const Inst* skipEmpty(Frame& frame, const Inst* inst) {
    return frame.masks[inst->operand[0]].empty() ? jump(inst, inst->operand[1]) : inst + 1;
}

HWY_INLINE const Inst* discard(Frame& frame, const Inst* inst) {
    frame.live = frame.live.without(frame.masks[kCurrentMask]);
    return inst + 1;
}

const Inst* end(Frame&, const Inst*) {
    return nullptr;
}

/// A quad lies in a 128-bit block: lanes 0 (0,0), 1 (1,0), 2 (0,1), 3 (1,1). Fine derivatives belong to the
/// lane's own row or column, coarse ones to the first of the quad.
namespace derivative {

VERNIER_ELEMENT(ddxFine, float, float, (V a), return hn::Sub(hn::DupOdd(a), hn::DupEven(a));)
VERNIER_ELEMENT(ddyFine, float, float, (V a), const hn::RepartitionToWide<U32> pairs;
                const auto v = hn::BitCast(pairs, a);
                const V lower = hn::BitCast(kF32, hn::InterleaveUpper(pairs, v, v));
                return hn::Sub(lower, hn::BitCast(kF32, hn::InterleaveLower(pairs, v, v)));)
VERNIER_ELEMENT(ddxCoarse, float, float, (V a), return hn::Sub(hn::Broadcast<1>(a), hn::Broadcast<0>(a));)
VERNIER_ELEMENT(ddyCoarse, float, float, (V a), return hn::Sub(hn::Broadcast<2>(a), hn::Broadcast<0>(a));)

}  // namespace derivative

/// Moves and branches, which work on whole strips.
template <class S>
struct Moves;

template <size_t... K>
struct Moves<Strip<std::index_sequence<K...>>> {
    using S = Strip<std::index_sequence<K...>>;
    template <size_t>
    using Vector = VU;
    template <Source kSource>
    using At = StripOperand<uint32_t, kSource>;

    template <Source kSource, bool kStored>
    static const Inst* copy(Frame& frame, const Inst* inst, std::byte* rows, uint32_t* scalars, Vector<K>... acc) {
        return S::template finish<kStored>(frame, inst, inst + 1, rows, scalars,
                                           At<kSource>::template at<K>(rows, scalars, inst->operand[1], acc)...);
    }

    template <Source kSource>
    static const Inst* copyMasked(Frame& frame, const Inst* inst, std::byte* rows, uint32_t* scalars,
                                  Vector<K>... acc) {
        const LaneMask mask = frame.masks[inst->operand[2]];
        auto* row = reinterpret_cast<uint32_t*>(rows + inst->operand[0]);
        if (mask.contains(frame.exec)) {
            (hn::Store(At<kSource>::template at<K>(rows, scalars, inst->operand[1], acc), kU32, row + K * kVectorLanes),
             ...);
        } else {
            (store(mask, K * kVectorLanes, At<kSource>::template at<K>(rows, scalars, inst->operand[1], acc), row),
             ...);
        }
        return S::proceed(frame, inst + 1, rows, scalars, acc...);
    }

    template <Source kSource, size_t kNext>
    static const Inst* split(Frame& frame, const Inst* inst, std::byte* rows, uint32_t* scalars, Vector<K>... acc) {
        const LaneMask lanes{S::template lanesOf<kSource>(rows, scalars, inst->operand[0], acc...)};
        return S::proceed(frame, splitBy<kNext>(frame, inst, frame.masks[kCurrentMask] & lanes), rows, scalars, acc...);
    }

    template <Source kSource>
    static const Inst* choose(Frame& frame, const Inst* inst, std::byte* rows, uint32_t* scalars, Vector<K>... acc) {
        const VU wanted = hn::Set(kU32, scalars[inst->operand[1]]);
        const LaneMask equal{
            ((bitsOf(boolRow(hn::Eq(At<kSource>::template at<K>(rows, scalars, inst->operand[0], acc), wanted)))
              << (K * kVectorLanes)) |
             ...)};
        LaneMask& current = frame.masks[kCurrentMask];
        LaneMask& mask = frame.masks[inst->operand[2]];
        mask = mask | (current & equal);
        current = current.without(equal);
        return S::proceed(frame, inst + 1, rows, scalars, acc...);
    }

    static void add(HandlerTable& table) {
        const auto enter = [&](Op op, Form form, typename S::StripHandler handler) {
            table[static_cast<size_t>(op)][form.index()] = S::erase(handler);
        };
        constexpr Form kRow{}, kScalar{{Source::scalar}}, kAccumulator{{Source::accumulator}};
        constexpr Form kUnstored{{}, false}, kScalarUnstored{{Source::scalar}, false};
        enter(Op::copy, kRow, copy<Source::row, true>);
        enter(Op::copy, kUnstored, copy<Source::row, false>);
        enter(Op::copy, kAccumulator, copy<Source::accumulator, true>);
        enter(Op::broadcast, kScalar, copy<Source::scalar, true>);
        enter(Op::broadcast, kScalarUnstored, copy<Source::scalar, false>);
        enter(Op::copyMasked, kRow, copyMasked<Source::row>);
        enter(Op::copyMasked, kAccumulator, copyMasked<Source::accumulator>);
        enter(Op::broadcastMasked, kScalar, copyMasked<Source::scalar>);
        enter(Op::split, kRow, split<Source::row, 0>);
        enter(Op::split, kAccumulator, split<Source::accumulator, 0>);
        enter(Op::splitInto, kRow, split<Source::row, 1>);
        enter(Op::splitInto, kAccumulator, split<Source::accumulator, 1>);
        enter(Op::splitPast, kRow, split<Source::row, 2>);
        enter(Op::splitPast, kAccumulator, split<Source::accumulator, 2>);
        enter(Op::choose, kRow, choose<Source::row>);
        enter(Op::choose, kScalar, choose<Source::scalar>);
        enter(Op::choose, kAccumulator, choose<Source::accumulator>);
    }

  private:
    static HWY_INLINE void store(const LaneMask& mask, size_t lane, VU from, uint32_t* row) {
        const VU old = hn::Load(kU32, row + lane);
        hn::Store(hn::IfThenElse(vectorMask(mask, lane), from, old), kU32, row + lane);
    }
};

LaneMask packWords(const uint32_t* words, uint32_t lanes) {
    LaneMask mask;
    for (uint32_t lane = 0; lane < lanes; lane += kVectorLanes) mask.set(lane, bitsOf(hn::LoadU(kU32, words + lane)));
    return mask;
}

void spreadWords(const LaneMask& mask, uint32_t* words, uint32_t lanes) {
    for (size_t lane = 0; lane < lanes; lane += hn::Lanes(kU32)) {
        hn::StoreU(hn::VecFromMask(kU32, vectorMask(mask, lane)), kU32, words + lane);
    }
}

}  // namespace

MaskFunctions maskFunctions() {
    return {packWords, spreadWords};
}

void addFlow(HandlerTables& tables) {
    Moves<FullStrip>::add(tables.full);
    Moves<NarrowStrip>::add(tables.narrow);
    tables.executeFull = FullStrip::execute;
    tables.executeNarrow = NarrowStrip::execute;
    tables.fullLanes = kStripVectors * kVectorLanes;
    addPlain<keepScalar>(tables, Op::keepScalar);
    addForward<moveScalar>(tables, Op::moveScalar);
    addForward<countBlock>(tables, Op::countBlock);
    addPlain<helperLanes>(tables, Op::helperLanes);
    addForward<enter>(tables, Op::enter);
    addPlain<repeat>(tables, Op::repeat);
    addForward<leave>(tables, Op::leave);
    addPlain<again>(tables, Op::again);
    addForward<leaveInto>(tables, Op::leaveInto);
    addForward<splitScalar>(tables, Op::splitScalar);
    addForward<splitScalarInto<1>>(tables, Op::splitScalarInto);
    addForward<splitScalarInto<2>>(tables, Op::splitScalarPast);
    addForward<follow>(tables, Op::follow);
    addForward<skipEmpty>(tables, Op::skipEmpty);
    addForward<discard>(tables, Op::discard);
    addPlain<end>(tables, Op::end);
    addPlain<controlBarrier>(tables, Op::controlBarrier);
    addPlain<memoryBarrier>(tables, Op::memoryBarrier);
    addPlain<readClock>(tables, Op::readClock);
    addPlain<runImage>(tables, Op::image);
    addPlain<runInterpolation>(tables, Op::interpolate);
    addPlain<subgroupInvocation>(tables, Op::subgroupInvocation);
    addPlain<subgroupBallot>(tables, Op::subgroupBallot);
    addPlain<subgroupActive>(tables, Op::subgroupActive);
    addPlain<subgroupShuffle>(tables, Op::subgroupShuffle);
    addPlain<subgroupBroadcast>(tables, Op::subgroupBroadcast);
    addPlain<quadShuffle>(tables, Op::quadShuffle);
    addPlain<subgroupReduce>(tables, Op::subgroupReduce);
    addPlain<subgroupReduce64>(tables, Op::subgroupReduce64);
    addElement<derivative::ddxFine, 1, FormSet::general>(tables, Op::ddxFine);
    addElement<derivative::ddyFine, 1, FormSet::general>(tables, Op::ddyFine);
    addElement<derivative::ddxCoarse, 1, FormSet::general>(tables, Op::ddxCoarse);
    addElement<derivative::ddyCoarse, 1, FormSet::general>(tables, Op::ddyCoarse);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
using GetMaskFunctions = MaskFunctions (*)();
GetMaskFunctions selectMaskFunctions(Isa isa){VERNIER_SELECT_ISA(isa, maskFunctions)} AddHandlers selectFlow(Isa isa) {
    VERNIER_SELECT_ISA(isa, addFlow)
}
}  // namespace
void addFlow(Isa isa, HandlerTables& tables) {
    selectFlow(isa)(tables);
}
MaskFunctions maskFunctions(Isa isa) {
    return selectMaskFunctions(isa)();
}
}  // namespace vernier::batch
#endif
