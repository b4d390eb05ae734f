// What the batch interpreter executes: instructions, the frame they work on, and the table of their handlers.
//
// Registers are *rows*: one 32-bit word per lane, 64-byte aligned, addressed by byte offset. A 64-bit value
// is two neighbouring rows, low words first. Values that are the same for a whole draw are *scalars*: one
// word (or two) of a separate file, and instructions have forms that take them as operands, so that they cost
// no rows. A handler works on all lanes whatever the masks say: only memory, phis and side effects look at
// masks.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "spirv_interp/program.h"
#include "spirv_interp/resources.h"

namespace vernier::batch {

inline constexpr uint32_t kMaxLanes = 128;
/// Lanes are computed in groups of this many: the widest vector. Row offsets are multiples of 64 bytes for
/// it.
inline constexpr uint32_t kLaneGroup = 16;
inline constexpr uint32_t kBackEdgeBudget = 1u << 24;
inline constexpr uint32_t kCurrentMask = 0;

/// A set of lanes.
struct LaneMask {
    std::array<uint64_t, kMaxLanes / 64> words{};

    static LaneMask first(uint32_t lanes) {
        LaneMask mask;
        for (uint32_t w = 0; w < mask.words.size(); ++w) {
            const uint32_t begin = w * 64;
            const uint32_t count = lanes <= begin ? 0 : lanes - begin;
            mask.words[w] = count >= 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
        }
        return mask;
    }
    bool empty() const { return (words[0] | words[1]) == 0; }
    bool test(uint32_t lane) const { return (words[lane / 64] >> (lane % 64) & 1) != 0; }
    bool contains(const LaneMask& other) const {
        return ((other.words[0] & ~words[0]) | (other.words[1] & ~words[1])) == 0;
    }
    /// The bits of lanes lane .. lane + 15 and up; `lane` is a multiple of a vector's width.
    uint64_t from(uint32_t lane) const { return words[lane / 64] >> (lane % 64); }
    void set(uint32_t lane, uint64_t bits) { words[lane / 64] |= bits << (lane % 64); }

    LaneMask operator&(const LaneMask& b) const { return {{words[0] & b.words[0], words[1] & b.words[1]}}; }
    LaneMask operator|(const LaneMask& b) const { return {{words[0] | b.words[0], words[1] | b.words[1]}}; }
    LaneMask without(const LaneMask& b) const { return {{words[0] & ~b.words[0], words[1] & ~b.words[1]}}; }
    bool operator==(const LaneMask&) const = default;

    template <class F>
    void forEach(F&& function) const {
        for (uint32_t w = 0; w < words.size(); ++w) {
            for (uint64_t left = words[w]; left != 0; left &= left - 1) {
                function(w * 64 + static_cast<uint32_t>(std::countr_zero(left)));
            }
        }
    }
};

enum class Op : uint16_t {
#define VERNIER_BATCH_VECTOR(name, operands) name,
#define VERNIER_BATCH_LANES(name, operands) name,
#define VERNIER_BATCH_MATH(name, operands) name,
#define VERNIER_BATCH_WIDE(name, operands) name,
#define VERNIER_BATCH_OTHER(name, operands) name,
#include "spirv_interp/batch/ops.def"
    count
};
inline constexpr size_t kOpCount = static_cast<size_t>(Op::count);

struct Frame;
struct Inst;

/// Executes one instruction and returns the next; nullptr ends the run.
using Handler = const Inst* (*)(Frame&, const Inst*);

/// One instruction, or the rest of one: an operation with more than four operands continues in the Insts
/// behind it.
struct Inst {
    Handler handler = nullptr;
    uint32_t operand[4] = {};  // byte offset of a row; index of a scalar; mask slot; jump distance; number

    uint32_t operator[](size_t k) const { return this[k / 4].operand[k % 4]; }
};
static_assert(sizeof(Inst) == 24);

/// How many Insts an operation with this many operands takes.
inline constexpr size_t instsFor(size_t operands) {
    return operands <= 4 ? 1 : (operands + 3) / 4;
}

/// Operand k + 1 (operand 0 is the destination) of a VECTOR operation is a scalar if bit k of its form is
/// set; so are the operands of memory operations that say "row or scalar" (there bit k is operand k, counted
/// without the destination).
inline constexpr size_t kForms = 8;
using HandlerTable = std::array<std::array<Handler, kForms>, kOpCount>;

/// The handlers for an instruction set and a math tier.
HandlerTable handlerTable(Isa isa, MathTier tier);

/// Between masks as words, one per lane, and LaneMasks; `lanes` is a multiple of kLaneGroup.
struct MaskFunctions {
    LaneMask (*pack)(const uint32_t* words, uint32_t lanes) = nullptr;  // by the top bit of each word
    void (*spread)(const LaneMask& mask, uint32_t* words, uint32_t lanes) = nullptr;
};
MaskFunctions maskFunctions(Isa isa);

/// An image instruction: where its operands and results lie.
struct ImageSite {
    static constexpr uint32_t kNone = ~0u;
    uint32_t op = 0;                                    // into Program::imageOps
    uint32_t imageIndex = kNone, samplerIndex = kNone;  // rows of descriptor indices
    uint32_t coord[4] = {kNone, kNone, kNone, kNone};
    uint32_t dref = kNone, lodOrBias = kNone;
    uint32_t ddx[3] = {kNone, kNone, kNone}, ddy[3] = {kNone, kNone, kNone};
    uint32_t offset[3] = {kNone, kNone, kNone};
    uint32_t sample = kNone;
    uint32_t texel[4] = {kNone, kNone, kNone, kNone};
    uint32_t result[4] = {kNone, kNone, kNone, kNone};
    bool effects = false;  // store or atomic: only lanes whose effects count
};

/// What running code works on.
struct Frame {
    std::byte* rows = nullptr;
    uint32_t* scalars = nullptr;
    uint32_t lanes = 0;     // lanes to compute, a multiple of kLaneGroup
    uint32_t rowBytes = 0;  // from a row to the next
    LaneMask* masks = nullptr;
    LaneMask exec;  // lanes that run
    LaneMask live;  // lanes whose effects count
    uint32_t backEdges = 0;
    bool lost = false;
    bool suspends = false;         // the work-group has other batches: a control barrier ends the run
    const Inst* resume = nullptr;  // where it goes on; nullptr when it has come to its end
    const ResourceBindings* bindings = nullptr;
    const ir::Program* program = nullptr;
    const ImageSite* imageSites = nullptr;
    const uint32_t* indexedRows = nullptr;
    uint32_t* local = nullptr;  // word w of lane l at local[w * localStride + l]
    uint32_t localStride = 0;
    uint32_t* imageScratch = nullptr;  // kImageScratchRows * kMaxLanes words
    BatchContext::Interpolator interpolator;

    template <class T>
    T* row(uint32_t offset) const {
        return reinterpret_cast<T*>(rows + offset);
    }
};
inline constexpr uint32_t kImageScratchRows = 5;  // a mask, four results

inline void execute(Frame& frame, const Inst* code) {
    for (const Inst* at = code; at != nullptr;) at = at->handler(frame, at);
}

}  // namespace vernier::batch
