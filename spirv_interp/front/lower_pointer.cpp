// Pointers as values, which phis, selects, variables, functions and buffers can hold.
//
// A pointer into a physical storage buffer is its address, i64. A pointer into a storage buffer or work-group memory is
// two i32: where it points and a byte offset. The first is the index of the descriptor when all pointers that can meet
// it point into one variable (classify.cpp), otherwise a buffer handle, which names the resource as well.
#include <algorithm>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

using Base = Pointer::Base;

/// The resource of a buffer instruction's immediate.
uint32_t Lowering::resourceOrAny(const Pointer& pointer) {
    return pointer.anyResource ? ir::kNoIndex : resourceOf(pointer.root);
}

Lowering::Leaves Lowering::pointerLeaves(uint32_t id, const Pointer& pointer) {
    if (pointer.base == Base::address) {
        const NewScalars address = newLeaves(1);
        address[0] = place(pointer, 0);
        return address;
    }
    if (pointer.base != Base::buffer || pointer.descriptorArray) {
        refuseId(id, "is a pointer that is used as a value, which is only supported for storage buffers");
    }
    const SpirvType* type = &typeInfo(pointer.type);
    while (type->kind == SpirvType::Kind::array) type = &typeInfo(type->element);
    if (!pointer.wordLayout && (type->kind == SpirvType::Kind::matrix || pointer.elementStride != 0)) {
        refuseId(id, "points to a matrix or a row of one and is used as a value, which is not supported");
    }
    const NewScalars leaves = newLeaves(2);
    leaves[0] = descriptorOf(pointer);
    leaves[1] = place(pointer, 0);
    if (!pointer.anyResource && onlyVariableOf(id) == kSeveral) {
        const uint32_t resource = resourceOf(pointer.root);
        if (resource >= 1u << (32 - ir::kHandleDescriptorBits)) refuseId(id, "points into one of too many resources");
        const ir::ValueId last = emitter_.constantI32((1u << ir::kHandleDescriptorBits) - 1);
        leaves[0] = binary(ir::Op::ior, binary(ir::Op::umin, leaves[0], last),
                           emitter_.constantI32(ir::bufferHandle(resource, 0)));
    }
    return leaves;
}

Pointer Lowering::pointerOfLeaves(uint32_t id, uint32_t typeId, Leaves leaves) {
    const SpirvType& type = typeInfo(typeId);
    Pointer pointer;
    pointer.type = type.element;
    pointer.root = id;
    if (type.storage == spv::StorageClass::PhysicalStorageBuffer) {
        pointer.base = Base::address;
        pointer.dynamic = leaves[0];
        return pointer;
    }
    if (leaves.size() != 2) refuseId(id, "is no pointer that can be followed");
    pointer.base = Base::buffer;
    pointer.descriptor = leaves[0];
    pointer.dynamic = leaves[1];
    const uint32_t variable = onlyVariableOf(id);
    pointer.anyResource = variable == kSeveral;
    pointer.fromResource = true;
    pointer.wordLayout = type.storage == spv::StorageClass::Workgroup && !workgroupBlocks_;
    if (!pointer.anyResource) pointer.root = variable;
    return pointer;
}

/// Bytes from one element to the next of the array that a pointer points into.
uint32_t Lowering::strideOfPointer(uint32_t pointerId, const Pointer& pointer) {
    if (pointer.wordLayout) return typeInfo(pointer.type).words * 4;
    const uint32_t type = module_.definition(pointerId)[1];
    const Decoration* stride = module_.findDecoration(type, spv::Decoration::ArrayStride);
    return stride != nullptr ? stride->value : byteSizeOf(typeInfo(type).element, 0, false);
}

bool Lowering::lowerPointer(const Instruction& inst) {
    switch (inst.op) {
        case spv::Op::OpConvertUToPtr:
            setScalar(inst[2], inst[1],
                      convertInteger(false, scalarType(inst[1]), scalarOf(inst[3]), scalarOfId(inst[3])));
            return true;
        case spv::Op::OpConvertPtrToU:
            setScalar(inst[2], inst[1],
                      convertInteger(false, scalarType(inst[1]), scalarOf(inst[3]), scalarOfId(inst[3])));
            return true;
        case spv::Op::OpPtrEqual:
        case spv::Op::OpPtrNotEqual: {
            const Leaves a = leavesOf(inst[3]), b = leavesOf(inst[4]);
            ir::ValueId equal = compare(ir::Op::ieq, a[0], b[0]);
            if (a.size() > 1) equal = binary(ir::Op::band, equal, compare(ir::Op::ieq, a[1], b[1]));
            setScalar(inst[2], inst[1], inst.op == spv::Op::OpPtrEqual ? equal : unary(ir::Op::bnot, equal));
            return true;
        }
        case spv::Op::OpPtrDiff:
            lowerPointerDifference(inst);
            return true;
        default:
            return false;
    }
}

/// In elements.
void Lowering::lowerPointerDifference(const Instruction& inst) {
    const Leaves a = leavesOf(inst[3]), b = leavesOf(inst[4]);
    const ir::ValueId bytes = binary(ir::Op::isub, a.back(), b.back());
    const LeafType from{emitter_.typeOf(bytes), static_cast<uint8_t>(ir::isWide(emitter_.typeOf(bytes)) ? 64 : 32),
                        true};
    const uint32_t stride = std::max(strideOfPointer(inst[3], pointerOf(inst[3])), 1u);
    const ir::ValueId elements = binary(ir::Op::sdiv, bytes, emitter_.constant(from, stride));
    setScalar(inst[2], inst[1], convertInteger(true, scalarType(inst[1]), elements, from));
}

}  // namespace vernier
