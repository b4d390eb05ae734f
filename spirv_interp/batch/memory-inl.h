// What the handlers of memory operations share: buffers, operands lane by lane, lanes with effects. Included once per
// SIMD target (see base/simd.h).
#if defined(VERNIER_BATCH_MEMORY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_BATCH_MEMORY_INL_H
#undef VERNIER_BATCH_MEMORY_INL_H
#else
#define VERNIER_BATCH_MEMORY_INL_H
#endif

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/ir/ops.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {

/// The buffer of descriptor `index` of a resource, or of the buffer handle `index` if there is no resource; an empty
/// one when there is no such descriptor.
inline BufferBinding bufferOf(const Frame& frame, uint32_t resource, uint32_t index) {
    const ResourceBindings& bindings = *frame.bindings;
    if (resource == ir::kNoIndex) {
        resource = index >> ir::kHandleDescriptorBits;
        index &= (1u << ir::kHandleDescriptorBits) - 1;
        if (resource >= frame.program->resources.size() || !ir::isBuffer(frame.program->resources[resource].kind))
            return {};
    }
    if (bindings.buffers == nullptr || index >= bindings.count[resource]) return {};
    const BufferBinding& buffer = bindings.buffers[bindings.base[resource] + index];
    return buffer.data == nullptr ? BufferBinding{} : buffer;
}

/// The T at a byte offset, or nullptr outside the buffer. Offsets are aligned: low bits are dropped.
template <class T>
HWY_INLINE T* elementAt(const BufferBinding& buffer, uint32_t offset) {
    offset &= ~static_cast<uint32_t>(sizeof(T) - 1);
    if (buffer.size < sizeof(T) || offset > buffer.size - sizeof(T)) return nullptr;
    return reinterpret_cast<T*>(buffer.data + offset);
}

template <class T = uint32_t>
HWY_INLINE uint32_t loadElement(const BufferBinding& buffer, uint32_t offset) {
    const T* element = elementAt<T>(buffer, offset);
    return element == nullptr ? 0 : *element;
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

HWY_INLINE void spreadWord(const Frame& frame, uint32_t row, uint32_t value) {
    const VU word = hn::Set(kU32, value);
    fillRow(frame, row, [&](size_t) HWY_ATTR { return word; });
}

/// The words of lanes 0, 1, ... when they lie one behind the other inside the buffer; nullptr if they do not.
template <bool kScalar>
HWY_INLINE uint32_t* wordsInARow(const BufferBinding& buffer, const LaneSource<kScalar>& offsets, uint32_t lanes) {
    if constexpr (kScalar) {
        return nullptr;
    } else {
        const uint32_t first = offsets.at(0), bytes = lanes * 4;
        if (first % 4 != 0 || buffer.size < bytes || first > buffer.size - bytes) return nullptr;
        const VU steps = hn::ShiftLeft<2>(hn::Iota(kU32, 0));
        for (uint32_t lane = 0; lane < lanes; lane += kVectorLanes) {
            const VU expected = hn::Add(hn::Set(kU32, first + 4 * lane), steps);
            if (!hn::AllTrue(kU32, hn::Eq(hn::Load(kU32, offsets.words() + lane), expected))) return nullptr;
        }
        return reinterpret_cast<uint32_t*>(buffer.data + first);
    }
}

/// The lanes whose effects count.
inline LaneMask effectLanes(const Frame& frame) {
    return frame.masks[kCurrentMask] & frame.live;
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
