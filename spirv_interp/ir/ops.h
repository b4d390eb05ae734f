// What is known about operations beyond ops.def: names of the closed sets, how an immediate is read, operand types.
#pragma once

#include <optional>
#include <string_view>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

std::string_view typeName(Type type);
std::optional<Type> typeFromName(std::string_view name);
std::optional<Op> opFromName(std::string_view name);

/// How Inst::imm of an operation is read.
enum class ImmKind : uint8_t {
    none,
    bits,      // of a constant
    type,      // the ir::Type of the operands
    input,     // index into Program::inputs
    output,    // index into Program::outputs
    resource,  // index into Program::resources, or kNoIndex; high 32 bits: bytes of the access, 0 for a word
    imageOp,   // index into Program::imageOps
    pair,      // two 32-bit numbers, low and high
};
ImmKind immKind(Op op);

inline uint32_t immLow(const Inst& inst) {
    return static_cast<uint32_t>(inst.imm);
}
inline uint32_t immHigh(const Inst& inst) {
    return static_cast<uint32_t>(inst.imm >> 32);
}
inline uint64_t immPair(uint32_t low, uint32_t high) {
    return low | static_cast<uint64_t>(high) << 32;
}

/// The resource that a buffer instruction names; kNoIndex: its first operand is a buffer handle.
inline uint32_t resourceOf(const Inst& inst) {
    return immLow(inst);
}

/// A descriptor of any resource in one i32, for pointers that may point into one of several buffers.
inline constexpr uint32_t kHandleDescriptorBits = 20;
inline constexpr uint32_t bufferHandle(uint32_t resource, uint32_t descriptor) {
    return resource << kHandleDescriptorBits | descriptor;
}
/// Points nowhere: no program has so many resources.
inline constexpr uint32_t kNullHandle = ~0u;

/// Memory that buffer instructions work on.
constexpr bool isBuffer(ResourceKind kind) {
    return kind == ResourceKind::uniformBuffer || kind == ResourceKind::storageBuffer ||
           kind == ResourceKind::pushConstants || kind == ResourceKind::workgroupMemory ||
           kind == ResourceKind::stageMemory;
}

/// Buffers that stores can go to.
constexpr bool isWritable(ResourceKind kind) {
    return kind == ResourceKind::storageBuffer || kind == ResourceKind::workgroupMemory ||
           kind == ResourceKind::stageMemory;
}

/// Memory without a descriptor, of whoever runs the program: no memory of the draw.
constexpr bool isOfRunner(ResourceKind kind) {
    return kind == ResourceKind::workgroupMemory || kind == ResourceKind::stageMemory;
}

constexpr bool isFloatAtomic(AtomicOp op) {
    return op == AtomicOp::fadd || op == AtomicOp::fmin || op == AtomicOp::fmax;
}

/// The immediate of subgroupReduce.
struct Reduction {
    ReduceOp op = ReduceOp::iadd;
    ReduceMode mode = ReduceMode::reduce;
    uint32_t cluster = kSubgroupSize;  // lanes, a power of two
};
inline Reduction reductionOf(const Inst& inst) {
    return {static_cast<ReduceOp>(inst.imm & 0xFF), static_cast<ReduceMode>(inst.imm >> 32 & 0xFF),
            static_cast<uint32_t>(inst.imm >> 40)};
}
inline uint64_t immOf(const Reduction& reduction) {
    return immPair(static_cast<uint32_t>(reduction.op), static_cast<uint32_t>(reduction.mode) | reduction.cluster << 8);
}

/// The bits of a b1 constant that is true, as in a lane.
inline constexpr uint64_t kTrueBits = 0xFFFFFFFFu;

constexpr bool isFloat(Type type) {
    return type == Type::f32 || type == Type::f64;
}
constexpr bool isInteger(Type type) {
    return type == Type::i32 || type == Type::i64;
}
constexpr bool isWide(Type type) {
    return type == Type::i64 || type == Type::f64;
}

/// The types operand `index` may have, as a bit set of 1 << Type; 0 when the instruction has no such operand or its
/// immediate is out of range.
uint32_t operandTypes(const Program& program, const Inst& inst, uint32_t index);

/// The types the result may have, as a bit set of 1 << Type; 1 << Type::none for operations without a result.
uint32_t resultTypes(Op op);

/// The number of operands the instruction must have; kNoIndex for a phi (its block tells) and for an image operation
/// whose immediate is out of range.
uint32_t operandCountOf(const Program& program, const Inst& inst);

/// Where the operands of an image instruction stand; kNoIndex = not there. `count` is their number.
struct ImageOperands {
    uint32_t image = 0, sampler = kNoIndex, coords = kNoIndex, dref = kNoIndex, lodOrBias = kNoIndex,
             gradients = kNoIndex, offsets = kNoIndex, sample = kNoIndex, minLod = kNoIndex, values = kNoIndex;
    uint32_t count = 0;
};
ImageOperands imageOperands(const ImageOp& op);

/// Whether the instruction does something besides defining its results; such a one is never removed.
bool hasSideEffect(const Program& program, const Inst& inst);

/// Whether equal instructions give equal results anywhere in the program: pure ones, and loads from memory that nothing
/// in the program writes.
bool isMovable(const Program& program, const Inst& inst);

inline bool isTerminator(Op op) {
    return opInfo(op).kind == 'T';
}

}  // namespace vernier::ir
