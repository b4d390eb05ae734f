// Buffers, invocation-local memory and indexed inputs. No address outside a buffer is ever formed: an offset
// is checked against the size of the binding first. Stores work in lane order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/memory.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <atomic>
#include <cstring>

#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/batch/memory-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {

/// Loads one word per lane from one buffer.
template <bool kScalar>
void gather(const Frame& frame, uint32_t row, const BufferBinding& buffer, const LaneSource<kScalar>& offsets) {
    if (buffer.size < 4 || offsets.isUniform(frame.lanes)) {
        spreadWord(frame, row, loadElement(buffer, offsets.at(0)));
        return;
    }
    if (const uint32_t* words = wordsInARow(buffer, offsets, frame.lanes)) {
        fillRow(frame, row, [&](size_t lane) HWY_ATTR { return hn::LoadU(kU32, words + lane); });
        return;
    }
    // The hardware's gather takes signed offsets.
    if (buffer.size > 0x80000000u) {
        for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
            frame.row<uint32_t>(row)[lane] = loadElement(buffer, offsets.at(lane));
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
            loadElement(bufferOf(frame, resource, descriptors.at(lane)), offsets.at(lane));
    }
    return inst + 1;
}

/// As loadBuffer, for bytes and halfwords.
template <class T, size_t kForm>
const Inst* loadNarrow(Frame& frame, const Inst* inst) {
    const LaneSource<kForm & 1> descriptors(frame, inst->operand[1]);
    const LaneSource<(kForm >> 1 & 1)> offsets(frame, inst->operand[2]);
    const uint32_t resource = inst->operand[3];
    auto* results = frame.row<uint32_t>(inst->operand[0]);
    if (descriptors.isUniform(frame.lanes)) {
        const BufferBinding buffer = bufferOf(frame, resource, descriptors.at(0));
        for (uint32_t lane = 0; lane < frame.lanes; ++lane) results[lane] = loadElement<T>(buffer, offsets.at(lane));
    } else {
        for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
            results[lane] = loadElement<T>(bufferOf(frame, resource, descriptors.at(lane)), offsets.at(lane));
        }
    }
    return inst + 1;
}

template <class T, bool kScalar>
void storeLanes(const BufferBinding& buffer, const LaneSource<kScalar>& offsets, const uint32_t* values,
                const LaneMask& lanes) {
    lanes.forEach([&](uint32_t lane) {
        T* element = elementAt<T>(buffer, offsets.at(lane));
        if (element != nullptr) {
            std::atomic_ref(*element).store(static_cast<T>(values[lane]), std::memory_order_relaxed);
        }
    });
}

/// Whether `bytes` bytes of every lane lie in the buffer.
template <bool kScalar>
HWY_INLINE bool allInside(const BufferBinding& buffer, const LaneSource<kScalar>& offsets, uint32_t lanes,
                          uint32_t bytes) {
    if (kScalar || buffer.size < bytes) return false;
    const VU last = hn::Set(kU32, buffer.size - bytes);
    for (uint32_t lane = 0; lane < lanes; lane += kVectorLanes) {
        if (!hn::AllFalse(kU32, hn::Gt(hn::Load(kU32, offsets.words() + lane), last))) return false;
    }
    return true;
}

template <class T, size_t kForm>
const Inst* storeBuffer(Frame& frame, const Inst* inst) {
    const LaneSource<kForm & 1> descriptors(frame, inst->operand[0]);
    const LaneSource<(kForm >> 1 & 1)> offsets(frame, inst->operand[1]);
    const auto* values = frame.row<uint32_t>(inst->operand[2]);
    const uint32_t resource = inst->operand[3];
    const LaneMask lanes = effectLanes(frame);
    if (!descriptors.isUniform(frame.lanes)) {
        lanes.forEach([&](uint32_t lane) {
            storeLanes<T>(bufferOf(frame, resource, descriptors.at(lane)), offsets, values,
                          LaneMask{uint64_t{1} << lane});
        });
        return inst + 1;
    }
    const BufferBinding buffer = bufferOf(frame, resource, descriptors.at(0));
    uint32_t* words = sizeof(T) == 4 ? wordsInARow(buffer, offsets, frame.lanes) : nullptr;
    if (words == nullptr) {
        if (lanes.contains(LaneMask::first(frame.lanes)) && allInside(buffer, offsets, frame.lanes, sizeof(T))) {
            for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
                auto* element = reinterpret_cast<T*>(buffer.data + (offsets.at(lane) & ~uint32_t{sizeof(T) - 1}));
                std::atomic_ref(*element).store(static_cast<T>(values[lane]), std::memory_order_relaxed);
            }
        } else {
            storeLanes<T>(buffer, offsets, values, lanes);
        }
        return inst + 1;
    }
    for (uint32_t lane = 0; lane < frame.lanes; lane += kVectorLanes) {
        const LaneMask part{LaneMask::first(kVectorLanes).bits << lane};
        if (lanes.contains(part)) {
            hn::StoreU(hn::Load(kU32, values + lane), kU32, words + lane);
        } else {
            storeLanes<T>(buffer, offsets, values, lanes & part);
        }
    }
    return inst + 1;
}

/// Word k of a lane from rows[k], four lanes and four words at a time; offsets are inside the buffer.
HWY_INLINE void storeFours(const BufferBinding& buffer, const LaneSource<false>& offsets,
                           const std::array<const uint32_t*, 4>& rows, uint32_t lanes) {
    const hn::FixedTag<uint32_t, 4> four;
    const hn::RepartitionToWide<decltype(four)> pairs;
    for (uint32_t lane = 0; lane < lanes; lane += 4) {
        const auto a = hn::Load(four, rows[0] + lane), b = hn::Load(four, rows[1] + lane);
        const auto c = hn::Load(four, rows[2] + lane), d = hn::Load(four, rows[3] + lane);
        const auto lowAB = hn::BitCast(pairs, hn::InterleaveLower(four, a, b));
        const auto lowCD = hn::BitCast(pairs, hn::InterleaveLower(four, c, d));
        const auto highAB = hn::BitCast(pairs, hn::InterleaveUpper(four, a, b));
        const auto highCD = hn::BitCast(pairs, hn::InterleaveUpper(four, c, d));
        const auto store = [&](uint32_t k, auto words) HWY_ATTR {
            auto* to = reinterpret_cast<uint32_t*>(buffer.data + (offsets.at(lane + k) & ~3u));
            hn::StoreU(hn::BitCast(four, words), four, to);
        };
        store(0, hn::InterleaveLower(pairs, lowAB, lowCD));
        store(1, hn::InterleaveUpper(pairs, lowAB, lowCD));
        store(2, hn::InterleaveLower(pairs, highAB, highCD));
        store(3, hn::InterleaveUpper(pairs, highAB, highCD));
    }
}

const Inst* storeWords(Frame& frame, const Inst* inst) {
    const Inst& in = *inst;
    const BufferBinding buffer = bufferOf(frame, in[6], frame.scalars[in[0]]);
    const LaneSource<false> offsets(frame, in[1]);
    const std::array<const uint32_t*, 4> rows{frame.row<uint32_t>(in[2]), frame.row<uint32_t>(in[3]),
                                              frame.row<uint32_t>(in[4]), frame.row<uint32_t>(in[5])};
    const uint32_t words = in[7];
    const LaneMask lanes = effectLanes(frame);
    if (words == rows.size() && lanes.contains(LaneMask::first(frame.lanes)) &&
        allInside(buffer, offsets, frame.lanes, sizeof(uint32_t) * words)) {
        storeFours(buffer, offsets, rows, frame.lanes);
        return inst + instsFor(8);
    }
    lanes.forEach([&](uint32_t lane) {
        for (uint32_t k = 0; k < words; ++k) {
            auto* element = elementAt<uint32_t>(buffer, offsets.at(lane) + k * static_cast<uint32_t>(sizeof(uint32_t)));
            if (element != nullptr) std::atomic_ref(*element).store(rows[k][lane], std::memory_order_relaxed);
        }
    });
    return inst + instsFor(8);
}

/// One word for all lanes.
HWY_INLINE const Inst* loadBufferScalar(Frame& frame, const Inst* inst) {
    uint32_t* scalars = frame.scalars;
    const BufferBinding buffer = bufferOf(frame, inst->operand[3], scalars[inst->operand[1]]);
    scalars[inst->operand[0]] = loadElement(buffer, scalars[inst->operand[2]]);
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

/// Word `index` of a variable for all lanes; nullptr outside it.
inline uint32_t* localRow(const Frame& frame, uint32_t first, uint32_t words, uint32_t index) {
    return index < words ? frame.local + size_t{first + index} * frame.localStride : nullptr;
}

template <bool kScalar>
const Inst* loadLocal(Frame& frame, const Inst* inst) {
    const LaneSource<kScalar> indices(frame, inst->operand[1]);
    const uint32_t first = inst->operand[2], words = inst->operand[3];
    if (indices.isUniform(frame.lanes)) {
        const uint32_t* row = localRow(frame, first, words, indices.at(0));
        if (row == nullptr) {
            spreadWord(frame, inst->operand[0], 0);
        } else {
            fillRow(frame, inst->operand[0], [&](size_t lane) HWY_ATTR { return hn::Load(kU32, row + lane); });
        }
        return inst + 1;
    }
    auto* results = frame.row<uint32_t>(inst->operand[0]);
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) {
        const uint32_t* row = localRow(frame, first, words, indices.at(lane));
        results[lane] = row == nullptr ? 0 : row[lane];
    }
    return inst + 1;
}

template <bool kScalar>
const Inst* storeLocal(Frame& frame, const Inst* inst) {
    const LaneSource<kScalar> indices(frame, inst->operand[0]);
    const auto* values = frame.row<uint32_t>(inst->operand[1]);
    const uint32_t first = inst->operand[2], words = inst->operand[3];
    const LaneMask current = frame.masks[kCurrentMask];
    if (current.contains(LaneMask::first(frame.lanes)) && indices.isUniform(frame.lanes)) {
        uint32_t* row = localRow(frame, first, words, indices.at(0));
        for (uint32_t lane = 0; row != nullptr && lane < frame.lanes; lane += kVectorLanes) {
            hn::Store(hn::Load(kU32, values + lane), kU32, row + lane);
        }
        return inst + 1;
    }
    current.forEach([&](uint32_t lane) {
        uint32_t* row = localRow(frame, first, words, indices.at(lane));
        if (row != nullptr) row[lane] = values[lane];
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

/// The forms of operations whose descriptor (bit 0) and offset (bit 1) are rows or scalars.
template <size_t... kForm>
void addForms(HandlerTables& tables, std::index_sequence<kForm...>) {
    (addPlain<loadBuffer<kForm>>(tables, Op::loadBuffer, kForm), ...);
    (addPlain<loadNarrow<uint8_t, kForm>>(tables, Op::loadByte, kForm), ...);
    (addPlain<loadNarrow<uint16_t, kForm>>(tables, Op::loadHalfword, kForm), ...);
    (addPlain<storeBuffer<uint32_t, kForm>>(tables, Op::storeBuffer, kForm), ...);
    (addPlain<storeBuffer<uint8_t, kForm>>(tables, Op::storeByte, kForm), ...);
    (addPlain<storeBuffer<uint16_t, kForm>>(tables, Op::storeHalfword, kForm), ...);
}

}  // namespace

void addMemory(HandlerTables& tables) {
    addForms(tables, std::make_index_sequence<4>());
    addPlain<storeWords>(tables, Op::storeWords);
    addForward<loadBufferScalar>(tables, Op::loadBuffer, 4);
    addPlain<bufferSize<false>>(tables, Op::bufferSize, 0);
    addPlain<bufferSize<true>>(tables, Op::bufferSize, 1);
    addPlain<loadLocal<false>>(tables, Op::loadLocal);
    addPlain<loadLocal<true>>(tables, Op::loadLocalScalar);
    addPlain<storeLocal<false>>(tables, Op::storeLocal);
    addPlain<storeLocal<true>>(tables, Op::storeLocalScalar);
    addPlain<inputIndexed>(tables, Op::inputIndexed);
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
void addMemory(Isa isa, HandlerTables& tables) {
    selectMemory(isa)(tables);
}
}  // namespace vernier::batch
#endif
