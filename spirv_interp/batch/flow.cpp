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

/// Adds the lanes of a vector mask, whose first is `lane`.
template <class M>
HWY_INLINE void addLanes(LaneMask& mask, size_t lane, M lanes) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(kU32, hn::RebindMask(kU32, lanes), bytes);
    mask.set(static_cast<uint32_t>(lane), bytes[0] | uint64_t{bytes[1]} << 8);
}

/// The lanes whose word is ~0: of a b1 row.
HWY_INLINE LaneMask lanesOf(const Frame& frame, uint32_t offset) {
    LaneMask mask;
    const auto* row = frame.row<uint32_t>(offset);
    for (size_t lane = 0; lane < frame.lanes; lane += hn::Lanes(kU32)) {
        addLanes(mask, lane, hn::MaskFromVec(hn::Load(kU32, row + lane)));
    }
    return mask;
}

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

template <bool kScalar>
const Inst* copy(Frame& frame, const Inst* inst) {
    const Source<uint32_t, kScalar> a(frame, inst->operand[1]);
    fillRow(frame, inst->operand[0], [&](size_t lane) HWY_ATTR { return a.at(lane); });
    return inst + 1;
}

template <bool kScalar>
const Inst* copyMasked(Frame& frame, const Inst* inst) {
    const LaneMask mask = frame.masks[inst->operand[2]];
    if (mask.contains(frame.exec)) return copy<kScalar>(frame, inst);
    const Source<uint32_t, kScalar> a(frame, inst->operand[1]);
    const Source<uint32_t, false> old(frame, inst->operand[0]);
    fillRow(frame, inst->operand[0],
            [&](size_t lane) HWY_ATTR { return hn::IfThenElse(vectorMask(mask, lane), a.at(lane), old.at(lane)); });
    return inst + 1;
}

const Inst* keepScalar(Frame& frame, const Inst* inst) {
    frame.scalars[inst->operand[0]] = frame.row<uint32_t>(inst->operand[1])[0];
    return inst + 1;
}

const Inst* helperLanes(Frame& frame, const Inst* inst) {
    const LaneMask helpers = frame.exec.without(frame.live);
    fillRow(frame, inst->operand[0],
            [&](size_t lane) HWY_ATTR { return hn::VecFromMask(kU32, vectorMask(helpers, lane)); });
    return inst + 1;
}

const Inst* enter(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[0]];
    if (mask.empty()) return jump(inst, inst->operand[1]);
    frame.masks[kCurrentMask] = mask;
    mask = {};
    return inst + 1;
}

const Inst* repeat(Frame& frame, const Inst* inst) {
    if (frame.masks[inst->operand[0]].empty()) return inst + 1;
    if (++frame.backEdges >= kBackEdgeBudget) {
        frame.lost = true;
        return nullptr;
    }
    return jump(inst, inst->operand[1]);
}

const Inst* leave(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[0]];
    mask = mask | frame.masks[kCurrentMask];
    return inst + 1;
}

const Inst* split(Frame& frame, const Inst* inst) {
    const LaneMask current = frame.masks[kCurrentMask];
    const LaneMask yes = current & lanesOf(frame, inst->operand[0]);
    frame.masks[inst->operand[1]] = frame.masks[inst->operand[1]] | yes;
    frame.masks[inst->operand[2]] = frame.masks[inst->operand[2]] | current.without(yes);
    return inst + 1;
}

const Inst* splitScalar(Frame& frame, const Inst* inst) {
    LaneMask& mask = frame.masks[inst->operand[frame.scalars[inst->operand[0]] != 0 ? 1 : 2]];
    mask = mask | frame.masks[kCurrentMask];
    return inst + 1;
}

template <bool kScalar>
const Inst* choose(Frame& frame, const Inst* inst) {
    const Source<uint32_t, kScalar> selector(frame, inst->operand[0]);
    const Source<uint32_t, true> wanted(frame, inst->operand[1]);
    LaneMask equal;
    for (size_t lane = 0; lane < frame.lanes; lane += hn::Lanes(kU32)) {
        addLanes(equal, lane, hn::Eq(selector.at(lane), wanted.at(lane)));
    }
    LaneMask& current = frame.masks[kCurrentMask];
    LaneMask& mask = frame.masks[inst->operand[2]];
    mask = mask | (current & equal);
    current = current.without(equal);
    return inst + 1;
}

const Inst* follow(Frame& frame, const Inst* inst) {
    LaneMask& to = frame.masks[inst->operand[0]];
    LaneMask& from = frame.masks[inst->operand[1]];
    to = to | from;
    from = {};
    return inst + 1;
}

const Inst* skipEmpty(Frame& frame, const Inst* inst) {
    return frame.masks[inst->operand[0]].empty() ? jump(inst, inst->operand[1]) : inst + 1;
}

const Inst* discard(Frame& frame, const Inst* inst) {
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
LaneMask packWords(const uint32_t* words, uint32_t lanes) {
    LaneMask mask;
    for (size_t lane = 0; lane < lanes; lane += hn::Lanes(kU32)) {
        addLanes(mask, lane, hn::MaskFromVec(hn::BroadcastSignBit(hn::BitCast(kI32, hn::LoadU(kU32, words + lane)))));
    }
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

void addFlow(HandlerTable& table) {
    const auto add = [&](Op op, Handler handler, size_t form = 0) { table[static_cast<size_t>(op)][form] = handler; };
    add(Op::broadcast, copy<true>);
    add(Op::copy, copy<false>);
    add(Op::copyMasked, copyMasked<false>);
    add(Op::broadcastMasked, copyMasked<true>);
    add(Op::keepScalar, keepScalar);
    add(Op::helperLanes, helperLanes);
    add(Op::enter, enter);
    add(Op::repeat, repeat);
    add(Op::leave, leave);
    add(Op::split, split);
    add(Op::splitScalar, splitScalar);
    add(Op::choose, choose<false>, 0);
    add(Op::choose, choose<true>, 1);
    add(Op::follow, follow);
    add(Op::skipEmpty, skipEmpty);
    add(Op::discard, discard);
    add(Op::end, end);
    addElement<derivative::ddxFine, 1>(table, Op::ddxFine);
    addElement<derivative::ddyFine, 1>(table, Op::ddyFine);
    addElement<derivative::ddxCoarse, 1>(table, Op::ddxCoarse);
    addElement<derivative::ddyCoarse, 1>(table, Op::ddyCoarse);
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
void addFlow(Isa isa, HandlerTable& table) {
    selectFlow(isa)(table);
}
MaskFunctions maskFunctions(Isa isa) {
    return selectMaskFunctions(isa)();
}
}  // namespace vernier::batch
#endif
