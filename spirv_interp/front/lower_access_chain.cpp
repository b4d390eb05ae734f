// Access chains. In buffers, a place that the shader asks for and that 32 bits cannot hold must not become one inside:
// distances stop at kFarOutside instead of wrapping around.
#include <algorithm>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

using Base = Pointer::Base;

void Lowering::lowerAccessChain(const Instruction& inst) {
    Pointer pointer = pointerOf(inst[3]);
    for (uint32_t word = 4; word < inst.count; ++word) pointer = stepInto(pointer, inst[word], inst);
    setPointer(inst[2], pointer);
}

/// An access chain whose first index, Element, counts the pointer on in an array it points into.
void Lowering::lowerPtrAccessChain(const Instruction& inst) {
    Pointer pointer = pointerOf(inst[3]);
    if (!pointer.inBytes()) refuse(inst, "the base does not point into a buffer");
    advanceElement(pointer, inst[4], strideOfPointer(inst[3], pointer));
    for (uint32_t word = 5; word < inst.count; ++word) pointer = stepInto(pointer, inst[word], inst);
    setPointer(inst[2], pointer);
}

/// Moves by `index` steps of `stride` units; an index that is constant is kept inside `count` (0: no bound).
void Lowering::advance(Pointer& pointer, uint32_t indexId, uint32_t count, uint32_t stride) {
    if (pointer.base == Base::address) {
        const ir::ValueId wide =
            convertInteger(true, {ir::Type::i64, 64, true}, scalarOf(indexId), scalarOfId(indexId));
        pointer.dynamic =
            binary(ir::Op::iadd, pointer.dynamic, binary(ir::Op::imul, wide, emitter_.constant(ir::Type::i64, stride)));
        return;
    }
    const ir::ValueId index = indexOf(indexId);
    if (const std::optional<uint64_t> bits = emitter_.constantBits(index)) {
        const auto fixed = static_cast<uint32_t>(*bits);
        const uint64_t distance = uint64_t{count != 0 ? std::min(fixed, count - 1) : fixed} * stride;
        pointer.offset = static_cast<uint32_t>(std::min<uint64_t>(pointer.offset + distance, kFarOutside));
        return;
    }
    if (pointer.base == Base::ssa) {
        if (pointer.dynamic != ir::kNoValue) refuseId(indexId, "is a second index that is not constant");
        pointer.dynamic = index;
        pointer.choices = count;
        pointer.choiceStride = stride;
        return;
    }
    addDistance(pointer, index, stride);
}

/// Moves by elements of the array that the pointer points into, forwards or backwards.
void Lowering::advanceElement(Pointer& pointer, uint32_t indexId, uint32_t stride) {
    if (pointer.base == Base::address) return advance(pointer, indexId, 0, stride);
    const bool checked = !isWorkgroupMemory(pointer);
    ir::ValueId index = indexOf(indexId);
    if (checked) {
        // Either way at most as far as kFarOutside: what then lies before the buffer is, without a sign, far behind it.
        stride = std::clamp(stride, 1u, kMaxBufferBytes);
        const uint32_t most = kFarOutside / stride;
        index = binary(ir::Op::smax, binary(ir::Op::smin, index, emitter_.constantI32(most)),
                       emitter_.constantI32(0u - most));
    }
    const ir::ValueId distance = binary(ir::Op::imul, index, emitter_.constantI32(stride));
    pointer.dynamic = binary(ir::Op::iadd, place(pointer, 0), distance);
    if (checked) pointer.dynamic = notFarther(pointer.dynamic);
    pointer.offset = 0;
    pointer.fromResource = true;
}

/// Adds `index` steps of `stride` units to the part of a pointer that is not constant.
void Lowering::addDistance(Pointer& pointer, ir::ValueId index, uint32_t stride) {
    const bool checked = pointer.base == Base::buffer && !isWorkgroupMemory(pointer);
    if (checked) {
        // "Out-of-bounds" is said of the place the shader asks for: a product that wraps around must not lead back
        // inside (specification, "Robust Buffer Access").
        stride = std::clamp(stride, 1u, kMaxBufferBytes);
        index = binary(ir::Op::umin, index, emitter_.constantI32(kFarOutside / stride));
    }
    const ir::ValueId distance = binary(ir::Op::imul, index, emitter_.constantI32(stride));
    if (pointer.dynamic == ir::kNoValue) {
        pointer.dynamic = distance;
        return;
    }
    pointer.dynamic = binary(ir::Op::iadd, pointer.dynamic, distance);
    if (checked) pointer.dynamic = notFarther(pointer.dynamic);
}

ir::ValueId Lowering::notFarther(ir::ValueId distance) {
    return binary(ir::Op::umin, distance, emitter_.constantI32(kFarOutside));
}

/// Whose arrays have their sizes in their types: an index beyond them is undefined, and stays inside the memory.
bool Lowering::isWorkgroupMemory(const Pointer& pointer) {
    return pointer.base == Base::buffer && !pointer.anyResource &&
           program_.resources[resourceOf(pointer.root)].kind == ir::ResourceKind::workgroupMemory;
}

void Lowering::stepDescriptor(Pointer& pointer, const SpirvType& type, uint32_t indexId) {
    const ir::ValueId index = indexOf(indexId);
    if (pointer.descriptor == ir::kNoValue) {
        pointer.descriptor = index;
    } else {
        const ir::ValueId row =
            emitter_.emit(ir::Op::imul, ir::Type::i32, {pointer.descriptor, emitter_.constantI32(type.count)});
        pointer.descriptor = emitter_.emit(ir::Op::iadd, ir::Type::i32, {row, index});
    }
    pointer.type = type.element;
    const SpirvType::Kind next = typeInfo(type.element).kind;
    pointer.descriptorArray = next == SpirvType::Kind::array || next == SpirvType::Kind::runtimeArray;
}

Pointer Lowering::stepInto(const Pointer& from, uint32_t indexId, const Instruction& inst) {
    Pointer pointer = from;
    const uint32_t typeId = from.type;
    const SpirvType& type = typeInfo(typeId);
    if (pointer.descriptorArray) {
        stepDescriptor(pointer, type, indexId);
        return pointer;
    }
    const bool buffer = pointer.inBytes() && !pointer.wordLayout;
    const auto unitsOf = [&](const SpirvType& part) {
        return pointer.base == Base::ssa ? part.leaves : pointer.wordLayout ? part.words * 4 : part.words;
    };
    switch (type.kind) {
        case SpirvType::Kind::structure: {
            const std::optional<uint32_t> index = constantOf(indexId);
            if (!index || *index >= type.members.size()) refuse(inst, "a member index that is not a constant in range");
            pointer.type = type.members[*index];
            if (!buffer) {
                pointer.offset += pointer.base == Base::ssa ? type.memberLeaf[*index]
                                  : pointer.wordLayout      ? type.memberWord[*index] * 4
                                                            : type.memberWord[*index];
                return pointer;
            }
            pointer.offset += module_.decorationOr(typeId, spv::Decoration::Offset, *index, 0);
            if (const Decoration* d = module_.findDecoration(typeId, spv::Decoration::MatrixStride, *index)) {
                pointer.matrixStride = d->value;
                pointer.rowMajor = module_.hasDecoration(typeId, spv::Decoration::RowMajor, *index);
            }
            return pointer;
        }
        case SpirvType::Kind::array:
        case SpirvType::Kind::runtimeArray: {
            const uint32_t stride =
                buffer ? module_.decorationOr(typeId, spv::Decoration::ArrayStride, Decoration::kNoMember, 0)
                       : unitsOf(typeInfo(type.element));
            advance(pointer, indexId, pointer.inBytes() ? 0 : type.count, stride);
            break;
        }
        case SpirvType::Kind::matrix: {
            const SpirvType& column = typeInfo(type.element);
            const uint32_t stride = !buffer            ? unitsOf(column)
                                    : pointer.rowMajor ? column.scalar.bytes()
                                                       : pointer.matrixStride;
            pointer.elementStride = buffer && pointer.rowMajor ? pointer.matrixStride : 0;
            advance(pointer, indexId, type.count, stride);
            break;
        }
        case SpirvType::Kind::vector: {
            const SpirvType& scalar = typeInfo(type.element);
            uint32_t stride = buffer ? scalar.scalar.bytes() : unitsOf(scalar);
            if (pointer.elementStride != 0) stride = pointer.elementStride;
            pointer.elementStride = 0;
            advance(pointer, indexId, type.count, stride);
            break;
        }
        default:
            refuse(inst, "an index into something that has no parts");
    }
    pointer.type = type.element;
    return pointer;
}

}  // namespace vernier
