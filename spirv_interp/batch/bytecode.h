// What the batch interpreter executes: instructions, the frame they work on, and the table of their handlers.
//
// Registers are *rows*: one 32-bit word per lane, 64-byte aligned, addressed by byte offset. A 64-bit value
// is two neighbouring rows, low words first. Values that are the same for a whole draw are *scalars*: one
// word (or two) of a separate file, and instructions have forms that take them as operands, so that they cost
// no rows. A handler works on all lanes whatever the masks say: only memory, phis and side effects look at
// masks.
//
// Elementwise operations work on *strips* of a fixed number of lanes and hand their result on in vector registers (see
// strip-inl.h). Every program is encoded for full strips and for narrow ones of a single lane group.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "spirv_interp/batch/forms.h"
#include "spirv_interp/program.h"
#include "spirv_interp/resources.h"

namespace vernier::batch {

inline constexpr uint32_t kMaxLanes = 64;
/// Lanes are computed in groups of this many: the widest vector. Row offsets are multiples of 64 bytes for
/// it.
inline constexpr uint32_t kLaneGroup = 16;
inline constexpr uint32_t kCurrentMask = 0;

/// A set of lanes.
struct LaneMask {
    uint64_t bits = 0;

    static constexpr LaneMask first(uint32_t lanes) {
        return {lanes >= kMaxLanes ? ~uint64_t{0} : (uint64_t{1} << lanes) - 1};
    }
    bool empty() const { return bits == 0; }
    bool test(uint32_t lane) const { return (bits >> lane & 1) != 0; }
    bool contains(const LaneMask& other) const { return (other.bits & ~bits) == 0; }
    /// The bits of lanes `lane` and up.
    uint64_t from(uint32_t lane) const { return bits >> lane; }
    void set(uint32_t lane, uint64_t lanes) { bits |= lanes << lane; }

    LaneMask operator&(const LaneMask& b) const { return {bits & b.bits}; }
    LaneMask operator|(const LaneMask& b) const { return {bits | b.bits}; }
    LaneMask without(const LaneMask& b) const { return {bits & ~b.bits}; }
    bool operator==(const LaneMask&) const = default;

    template <class F>
    void forEach(F&& function) const {
        for (uint64_t left = bits; left != 0; left &= left - 1) function(static_cast<uint32_t>(std::countr_zero(left)));
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

/// The forms of a VECTOR operation. On x86, minimum and maximum of zeros of different sign depend on the order.
constexpr FormSet formSet(Op op) {
    switch (op) {
        case Op::fadd:
        case Op::fmul:
        case Op::ffma:
        case Op::multiplyAdd:
        case Op::multiplySubtract:
        case Op::subtractMultiply:
        case Op::iadd:
        case Op::imul:
        case Op::smin:
        case Op::smax:
        case Op::umin:
        case Op::umax:
        case Op::iand:
        case Op::ior:
        case Op::ixor:
        case Op::xor3:
        case Op::xorMultiply:
        case Op::andOr:
        case Op::integerMultiplyAdd:
        case Op::foeq:
        case Op::fone:
        case Op::fueq:
        case Op::fune:
        case Op::ieq:
        case Op::ine:
            return FormSet::commutative;
        case Op::shiftRightAnd:
        case Op::shiftRightXor:
        case Op::shiftLeftXor:
        case Op::shiftLeftAdd:
        case Op::shiftLeftOr:
        case Op::rotateLeft:
        case Op::xorShiftRight:
        case Op::xorShiftLeft:
        case Op::xorShiftMultiply:
        case Op::convertMultiply:
        case Op::convertMultiplyAdd:
        case Op::convertMultiplySubtract:
            return FormSet::byScalar;
        case Op::frem:
        case Op::fmod:
        case Op::fsmoothstep:
        case Op::ftoh:
        case Op::ftohZero:
            return FormSet::rare;
        default:
            return FormSet::general;
    }
}

struct Frame;
struct Inst;

/// Executes one instruction and returns the next; nullptr ends the run. The form in which operations are written that
/// have no use for the accumulator.
using PlainHandler = const Inst* (*)(Frame&, const Inst*);

/// A handler with the arguments of the strips of some instruction set; only they can call it.
using Handler = void (*)();

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

/// VECTOR operations have a Form. In the forms of memory operations bit k tells that operand k, counted without the
/// destination, is a scalar.
using HandlerTable = std::array<std::array<Handler, kForms>, kOpCount>;

/// Narrow strips are one lane group, full ones `fullLanes` of the instruction set.
struct HandlerTables {
    HandlerTable full{}, narrow{};
    void (*executeFull)(Frame&, const Inst*) = nullptr;
    void (*executeNarrow)(Frame&, const Inst*) = nullptr;
    uint32_t fullLanes = 0;
};

/// The handlers for an instruction set and a math tier. Thread-safe.
const HandlerTables& handlerTables(Isa isa, MathTier tier);

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
    uint32_t sample = kNone, minLod = kNone;
    uint32_t texel[4] = {kNone, kNone, kNone, kNone};
    uint32_t result[4] = {kNone, kNone, kNone, kNone};
    bool effects = false;  // store or atomic: only lanes whose effects count
};

/// What running code works on.
struct Frame {
    std::byte* rows = nullptr;
    uint32_t* scalars = nullptr;
    uint32_t lanes = 0;     // lanes to compute, a multiple of kLaneGroup; strips compute all they have
    uint32_t rowBytes = 0;  // from a row to the next
    LaneMask* masks = nullptr;
    LaneMask exec;  // lanes that run
    LaneMask live;  // lanes whose effects count
    uint32_t backEdgesLeft = 0;
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
    uint64_t* blockRuns = nullptr;                     // BatchOptions::blockRuns
    alignas(64) uint32_t accumulator[kMaxLanes] = {};  // between instructions, where calls are not turned into jumps

    template <class T>
    T* row(uint32_t offset) const {
        return reinterpret_cast<T*>(rows + offset);
    }
};
inline constexpr uint32_t kImageScratchRows = 5;  // a mask, four results

}  // namespace vernier::batch
