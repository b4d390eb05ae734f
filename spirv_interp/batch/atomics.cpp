// Atomics on buffers and on memory reached by its address, and plain accesses by address. Lanes work in order. No
// address outside a buffer, or outside a range of device memory that the bindings know, is ever touched.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/atomics.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstring>

#include "spirv_interp/atomic.h"
#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/batch/memory-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {

/// An atomic in memory that only this thread sees.
template <class U>
U alone(ir::AtomicOp operation, U* word, U value, U comparator) {
    const U old = *word;
    *word = atomicCombined(operation, old, value, comparator);
    return operation == ir::AtomicOp::store ? 0 : old;
}

/// Runs an atomic for the lanes whose effects count; find(lane) is the word or nullptr. The others get 0.
template <class U, auto kApply = atomicApply<U>, class Find>
void runAtomic(const Frame& frame, uint32_t result, uint32_t operation, uint32_t value, uint32_t comparator,
               Find&& find) {
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) writeLane<U>(frame, result, lane, 0);
    effectLanes(frame).forEach([&](uint32_t lane) {
        U* word = find(lane);
        if (word == nullptr) return;
        writeLane<U>(frame, result, lane,
                     kApply(static_cast<ir::AtomicOp>(operation), word, readLane<U>(frame, value, lane),
                            readLane<U>(frame, comparator, lane)));
    });
}

template <class U>
const Inst* atomicBuffer(Frame& frame, const Inst* inst) {
    const Inst& in = *inst;
    const auto* descriptors = frame.row<uint32_t>(in[1]);
    const auto* offsets = frame.row<uint32_t>(in[2]);
    if (in[3] != ir::kNoIndex && frame.program->resources[in[3]].kind == ir::ResourceKind::workgroupMemory) {
        // A work-group never leaves its thread.
        const BufferBinding memory = bufferOf(frame, in[3], 0);
        runAtomic<U, alone<U>>(frame, in[0], in[4], in[5], in[6],
                               [&](uint32_t lane) { return elementAt<U>(memory, offsets[lane]); });
        return inst + instsFor(7);
    }
    runAtomic<U>(frame, in[0], in[4], in[5], in[6],
                 [&](uint32_t lane) { return elementAt<U>(bufferOf(frame, in[3], descriptors[lane]), offsets[lane]); });
    return inst + instsFor(7);
}

/// In work-group memory, which no other thread sees, 64-bit values may stand at any word.
const Inst* atomicShared64(Frame& frame, const Inst* inst) {
    const Inst& in = *inst;
    const auto* offsets = frame.row<uint32_t>(in[2]);
    const BufferBinding memory = bufferOf(frame, in[3], 0);
    const auto operation = static_cast<ir::AtomicOp>(in[4]);
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) writeLane<uint64_t>(frame, in[0], lane, 0);
    effectLanes(frame).forEach([&](uint32_t lane) {
        const uint32_t offset = offsets[lane] & ~3u;
        if (memory.size < 8 || offset > memory.size - 8) return;
        uint64_t old = 0;
        std::memcpy(&old, memory.data + offset, sizeof old);
        const uint64_t next = atomicCombined(operation, old, readLane<uint64_t>(frame, in[5], lane),
                                             readLane<uint64_t>(frame, in[6], lane));
        std::memcpy(memory.data + offset, &next, sizeof next);
        writeLane<uint64_t>(frame, in[0], lane, old);
    });
    return inst + instsFor(7);
}

/// Device memory by address; remembers the range of the last access, which most accesses share.
class AddressSpace {
  public:
    explicit AddressSpace(const Frame& frame) : resolver_(frame.bindings->addresses) {}

    /// The T at an address, which is aligned by dropping low bits; nullptr where there is no memory.
    template <class T>
    T* at(uint64_t address) {
        return reinterpret_cast<T*>(bytesAt(address & ~uint64_t{sizeof(T) - 1}, sizeof(T)));
    }
    /// The two words at an address; nullptr where one of them is no memory.
    uint32_t* wordsAt(uint64_t address) {
        return reinterpret_cast<uint32_t*>(bytesAt(address & ~uint64_t{3}, 2 * sizeof(uint32_t)));
    }

  private:
    std::byte* bytesAt(uint64_t address, uint64_t bytes) {
        if (!holds(address, bytes)) {
            if (resolver_.find == nullptr) return nullptr;
            range_ = resolver_.find(resolver_.self, address);
            if (!holds(address, bytes)) return nullptr;
        }
        return range_.data + (address - range_.address);
    }
    bool holds(uint64_t address, uint64_t bytes) const {
        return range_.data != nullptr && address >= range_.address && range_.size >= bytes &&
               address - range_.address <= range_.size - bytes;
    }
    AddressResolver resolver_;
    AddressRange range_;
};

/// Values of 64 bits, at any word.
void loadWideAddress(Frame& frame, const Inst* inst) {
    AddressSpace memory(frame);
    for (uint32_t lane = 0; lane < frame.lanes; ++lane) writeLane<uint64_t>(frame, inst->operand[0], lane, 0);
    frame.masks[kCurrentMask].forEach([&](uint32_t lane) {
        const uint32_t* words = memory.wordsAt(readLane<uint64_t>(frame, inst->operand[1], lane));
        if (words != nullptr) writeLane<uint64_t>(frame, inst->operand[0], lane, uint64_t{words[1]} << 32 | words[0]);
    });
}
void storeWideAddress(Frame& frame, const Inst* inst) {
    AddressSpace memory(frame);
    effectLanes(frame).forEach([&](uint32_t lane) {
        uint32_t* words = memory.wordsAt(readLane<uint64_t>(frame, inst->operand[0], lane));
        if (words == nullptr) return;
        const auto value = readLane<uint64_t>(frame, inst->operand[1], lane);
        std::atomic_ref(words[0]).store(static_cast<uint32_t>(value), std::memory_order_relaxed);
        std::atomic_ref(words[1]).store(static_cast<uint32_t>(value >> 32), std::memory_order_relaxed);
    });
}

/// Calls run(T()) for the unsigned type of an access of at most 4 bytes.
template <class Run>
void withWidth(uint32_t bytes, Run&& run) {
    if (bytes == 1) {
        run(uint8_t{});
    } else if (bytes == 2) {
        run(uint16_t{});
    } else {
        run(uint32_t{});
    }
}

const Inst* loadAddress(Frame& frame, const Inst* inst) {
    if (inst->operand[2] == 8) {
        loadWideAddress(frame, inst);
        return inst + 1;
    }
    AddressSpace memory(frame);
    auto* results = frame.row<uint32_t>(inst->operand[0]);
    const LaneMask& active = frame.masks[kCurrentMask];
    // Lanes that do not run hold any address: they ask for nothing.
    spreadWord(frame, inst->operand[0], 0);
    withWidth(inst->operand[2], [&](auto width) {
        active.forEach([&](uint32_t lane) {
            const auto* element = memory.at<decltype(width)>(readLane<uint64_t>(frame, inst->operand[1], lane));
            results[lane] = element == nullptr ? 0 : *element;
        });
    });
    return inst + 1;
}

const Inst* storeAddress(Frame& frame, const Inst* inst) {
    if (inst->operand[2] == 8) {
        storeWideAddress(frame, inst);
        return inst + 1;
    }
    AddressSpace memory(frame);
    const auto* values = frame.row<uint32_t>(inst->operand[1]);
    withWidth(inst->operand[2], [&](auto width) {
        using T = decltype(width);
        effectLanes(frame).forEach([&](uint32_t lane) {
            T* element = memory.at<T>(readLane<uint64_t>(frame, inst->operand[0], lane));
            if (element != nullptr) {
                std::atomic_ref(*element).store(static_cast<T>(values[lane]), std::memory_order_relaxed);
            }
        });
    });
    return inst + 1;
}

template <class U>
const Inst* atomicAddress(Frame& frame, const Inst* inst) {
    const Inst& in = *inst;
    AddressSpace memory(frame);
    runAtomic<U>(frame, in[0], in[2], in[3], in[4],
                 [&](uint32_t lane) { return memory.at<U>(readLane<uint64_t>(frame, in[1], lane)); });
    return inst + instsFor(5);
}

}  // namespace

void addAtomics(HandlerTables& tables) {
    addPlain<atomicBuffer<uint32_t>>(tables, Op::atomicBuffer);
    addPlain<atomicBuffer<uint64_t>>(tables, Op::atomicBuffer64);
    addPlain<atomicShared64>(tables, Op::atomicShared64);
    addPlain<loadAddress>(tables, Op::loadAddress);
    addPlain<storeAddress>(tables, Op::storeAddress);
    addPlain<atomicAddress<uint32_t>>(tables, Op::atomicAddress);
    addPlain<atomicAddress<uint64_t>>(tables, Op::atomicAddress64);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectAtomics(Isa isa) {
    VERNIER_SELECT_ISA(isa, addAtomics)
}
}  // namespace
void addAtomics(Isa isa, HandlerTables& tables) {
    selectAtomics(isa)(tables);
}
}  // namespace vernier::batch
#endif
