// Buffers, invocation-local memory and indexed inputs. No address outside a buffer is ever formed: an offset
// is checked against the size of the binding first. Stores and atomics work in lane order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/memory.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <atomic>
#include <cstring>

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/handlers.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {

/// The buffer of descriptor `index` of a resource; an empty one when there is no such descriptor.
inline BufferBinding bufferOf(const Frame& frame, uint32_t resource, uint32_t index) {
    const ResourceBindings& bindings = *frame.bindings;
    if (bindings.buffers == nullptr || index >= bindings.count[resource]) return {};
    const BufferBinding& buffer = bindings.buffers[bindings.base[resource] + index];
    return buffer.data == nullptr ? BufferBinding{} : buffer;
}

/// The word at a byte offset, or nullptr outside the buffer. Offsets are whole words: the low two bits are
/// dropped.
inline uint32_t* wordAt(const BufferBinding& buffer, uint32_t offset) {
    offset &= ~3u;
    if (buffer.size < 4 || offset > buffer.size - 4) return nullptr;
    return reinterpret_cast<uint32_t*>(buffer.data + offset);
}

inline uint32_t loadWord(const BufferBinding& buffer, uint32_t offset) {
    const uint32_t* word = wordAt(buffer, offset);
    return word == nullptr ? 0 : *word;
}

/// An operand that is a row or a scalar, lane by lane.
template <bool kScalar>
class LaneSource {
  public:
    LaneSource(const Frame& frame, uint32_t place)
        : words_(kScalar ? frame.scalars + place : frame.row<uint32_t>(place)) {}
    uint32_t at(uint32_t lane) const { return words_[kScalar ? 0 : lane]; }
    const uint32_t* words() const { return words_; }

    /// Whether all lanes hold the word of the first.
    HWY_INLINE bool isUniform(uint32_t lanes) const {
        if constexpr (!kScalar) {
            const VU first = hn::Set(kU32, words_[0]);
            for (size_t lane = 0; lane < lanes; lane += hn::Lanes(kU32)) {
                if (!hn::AllTrue(kU32, hn::Eq(hn::Load(kU32, words_ + lane), first))) return false;
            }
        }
        return true;
    }

  private:
    const uint32_t* words_;
};

void spreadWord(const Frame& frame, uint32_t row, uint32_t value) {
    const VU word = hn::Set(kU32, value);
    fillRow(frame, row, [&](size_t) HWY_ATTR { return word; });
}

/// Loads one word per lane from one buffer.
template <bool kScalar>
void gather(const Frame& frame, uint32_t row, const BufferBinding& buffer, const LaneSource<kScalar>& offsets) {
    if (buffer.size < 4 || offsets.isUniform(frame.lanes)) {
        spreadWord(frame, row, loadWord(buffer, offsets.at(0)));
        return;
    }
    // The hardware's gather takes signed offsets.
    if (buffer.size > 0x80000000u) {
        for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
            frame.row<uint32_t>(row)[lane] = loadWord(buffer, offsets.at(lane));
        }
        return;
    }
    if constexpr (!kScalar) {
        const auto* base = reinterpret_cast<const uint32_t*>(buffer.data);
        const VU last = hn::Set(kU32, buffer.size - 4), words = hn::Set(kU32, ~3u);
        fillRow(frame, row, [&](size_t lane) HWY_ATTR {
            const VU offset = hn::And(hn::Load(kU32, offsets.words() + lane), words);
            const auto inside = hn::Not(hn::Gt(offset, last));
            const VI safe = hn::BitCast(kI32, hn::IfThenElseZero(inside, offset));
            return hn::IfThenElseZero(inside, hn::GatherOffset(kU32, base, safe));
        });
    }
}

template <size_t kForm>
const Inst* loadBuffer(Frame& frame, const Inst* inst) {
    const LaneSource<kForm & 1> descriptors(frame, inst->operand[1]);
    const LaneSource<(kForm >> 1 & 1)> offsets(frame, inst->operand[2]);
    const uint32_t resource = inst->operand[3];
    if (descriptors.isUniform(frame.lanes)) {
        gather(frame, inst->operand[0], bufferOf(frame, resource, descriptors.at(0)), offsets);
        return inst + 1;
    }
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
        frame.row<uint32_t>(inst->operand[0])[lane] =
            loadWord(bufferOf(frame, resource, descriptors.at(lane)), offsets.at(lane));
    }
    return inst + 1;
}

LaneMask effectLanes(const Frame& frame) {
    return frame.masks[kCurrentMask] & frame.live;
}

template <size_t kForm>
const Inst* storeBuffer(Frame& frame, const Inst* inst) {
    const LaneSource<kForm & 1> descriptors(frame, inst->operand[0]);
    const LaneSource<(kForm >> 1 & 1)> offsets(frame, inst->operand[1]);
    const auto* values = frame.row<uint32_t>(inst->operand[2]);
    effectLanes(frame).forEach([&](uint32_t lane) {
        uint32_t* word = wordAt(bufferOf(frame, inst->operand[3], descriptors.at(lane)), offsets.at(lane));
        if (word != nullptr) std::atomic_ref(*word).store(values[lane], std::memory_order_relaxed);
    });
    return inst + 1;
}

template <bool kScalar>
const Inst* bufferSize(Frame& frame, const Inst* inst) {
    const LaneSource<kScalar> descriptors(frame, inst->operand[1]);
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
        frame.row<uint32_t>(inst->operand[0])[lane] = bufferOf(frame, inst->operand[2], descriptors.at(lane)).size;
    }
    return inst + 1;
}

/// Replaces *word by change(*word) in one step; returns the old word.
template <class F>
uint32_t exchangeBy(uint32_t* word, F&& change) {
    std::atomic_ref target(*word);
    uint32_t old = target.load(std::memory_order_relaxed);
    while (!target.compare_exchange_weak(old, change(old), std::memory_order_acq_rel, std::memory_order_relaxed)) {
    }
    return old;
}

uint32_t atomic(ir::AtomicOp operation, uint32_t* word, uint32_t value, uint32_t comparator) {
    std::atomic_ref target(*word);
    const auto asSigned = [](uint32_t x) { return static_cast<int32_t>(x); };
    switch (operation) {
        case ir::AtomicOp::add:
            return target.fetch_add(value);
        case ir::AtomicOp::sub:
            return target.fetch_sub(value);
        case ir::AtomicOp::iand:
            return target.fetch_and(value);
        case ir::AtomicOp::ior:
            return target.fetch_or(value);
        case ir::AtomicOp::ixor:
            return target.fetch_xor(value);
        case ir::AtomicOp::exchange:
            return target.exchange(value);
        case ir::AtomicOp::load:
            return target.load();
        case ir::AtomicOp::store:
            target.store(value);
            return 0;
        case ir::AtomicOp::smin:
            return exchangeBy(word, [&](uint32_t old) { return asSigned(old) < asSigned(value) ? old : value; });
        case ir::AtomicOp::smax:
            return exchangeBy(word, [&](uint32_t old) { return asSigned(old) > asSigned(value) ? old : value; });
        case ir::AtomicOp::umin:
            return exchangeBy(word, [&](uint32_t old) { return old < value ? old : value; });
        case ir::AtomicOp::umax:
            return exchangeBy(word, [&](uint32_t old) { return old > value ? old : value; });
        case ir::AtomicOp::compareExchange:
            target.compare_exchange_strong(comparator, value);
            return comparator;
    }
    return 0;
}

const Inst* atomicBuffer(Frame& frame, const Inst* inst) {
    const Inst& in = *inst;
    auto* results = frame.row<uint32_t>(in[0]);
    const auto* descriptors = frame.row<uint32_t>(in[1]);
    const auto* offsets = frame.row<uint32_t>(in[2]);
    const auto* values = frame.row<uint32_t>(in[5]);
    const auto* comparators = frame.row<uint32_t>(in[6]);
    spreadWord(frame, in[0], 0);
    effectLanes(frame).forEach([&](uint32_t lane) {
        uint32_t* word = wordAt(bufferOf(frame, in[3], descriptors[lane]), offsets[lane]);
        if (word == nullptr) return;
        results[lane] = atomic(static_cast<ir::AtomicOp>(in[4]), word, values[lane], comparators[lane]);
    });
    return inst + instsFor(7);
}

template <bool kScalar>
const Inst* loadLocal(Frame& frame, const Inst* inst) {
    const LaneSource<kScalar> indices(frame, inst->operand[1]);
    const uint32_t first = inst->operand[2], words = inst->operand[3];
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
        const uint32_t index = indices.at(lane);
        frame.row<uint32_t>(inst->operand[0])[lane] =
            index < words ? frame.local[size_t{first + index} * frame.localStride + lane] : 0;
    }
    return inst + 1;
}

template <bool kScalar>
const Inst* storeLocal(Frame& frame, const Inst* inst) {
    const LaneSource<kScalar> indices(frame, inst->operand[0]);
    const auto* values = frame.row<uint32_t>(inst->operand[1]);
    const uint32_t first = inst->operand[2], words = inst->operand[3];
    frame.masks[kCurrentMask].forEach([&](uint32_t lane) {
        const uint32_t index = indices.at(lane);
        if (index < words) frame.local[size_t{first + index} * frame.localStride + lane] = values[lane];
    });
    return inst + 1;
}

const Inst* inputIndexed(Frame& frame, const Inst* inst) {
    const auto* indices = frame.row<int32_t>(inst->operand[1]);
    const uint32_t* rows = frame.indexedRows + inst->operand[2];
    const auto last = static_cast<int32_t>(inst->operand[3]) - 1;
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
        const int32_t index = indices[lane] < 0 ? 0 : indices[lane] > last ? last : indices[lane];
        frame.row<uint32_t>(inst->operand[0])[lane] = frame.row<uint32_t>(rows[index])[lane];
    }
    return inst + 1;
}

}  // namespace

void addMemory(HandlerTable& table) {
    const auto add = [&](Op op, Handler handler, size_t form = 0) { table[static_cast<size_t>(op)][form] = handler; };
    add(Op::loadBuffer, loadBuffer<0>, 0);
    add(Op::loadBuffer, loadBuffer<1>, 1);
    add(Op::loadBuffer, loadBuffer<2>, 2);
    add(Op::loadBuffer, loadBuffer<3>, 3);
    add(Op::storeBuffer, storeBuffer<0>, 0);
    add(Op::storeBuffer, storeBuffer<1>, 1);
    add(Op::storeBuffer, storeBuffer<2>, 2);
    add(Op::storeBuffer, storeBuffer<3>, 3);
    add(Op::bufferSize, bufferSize<false>, 0);
    add(Op::bufferSize, bufferSize<true>, 1);
    add(Op::atomicBuffer, atomicBuffer);
    add(Op::loadLocal, loadLocal<false>);
    add(Op::loadLocalScalar, loadLocal<true>);
    add(Op::storeLocal, storeLocal<false>);
    add(Op::storeLocalScalar, storeLocal<true>);
    add(Op::inputIndexed, inputIndexed);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectMemory(Isa isa) {
    VERNIER_SELECT_ISA(isa, addMemory)
}
}  // namespace
void addMemory(Isa isa, HandlerTable& table) {
    selectMemory(isa)(table);
}
}  // namespace vernier::batch
#endif
