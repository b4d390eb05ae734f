// Pointers, loads and stores.
#include <algorithm>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

using Base = Pointer::Base;

// --- scalars in memory
// --------------------------------------------------------------------------------------------------

/// The place in the pointer's unit, `more` further on, as a value: i32, or i64 for an address.
ir::ValueId Lowering::place(const Pointer& pointer, uint32_t more) {
    if (pointer.base == Base::address) {
        return binary(ir::Op::iadd, pointer.dynamic, emitter_.constant(ir::Type::i64, pointer.offset + more));
    }
    const bool fromVariable = pointer.base == Base::buffer && !pointer.fromResource;
    const uint32_t first = fromVariable ? bufferOffsetOf(pointer.root) : 0;
    const auto fixedBytes = std::min<uint64_t>(uint64_t{first} + pointer.offset + more, kFarOutside);
    const ir::ValueId fixed = emitter_.constantI32(static_cast<uint32_t>(fixedBytes));
    return pointer.dynamic == ir::kNoValue ? fixed
                                           : emitter_.emit(ir::Op::iadd, ir::Type::i32, {pointer.dynamic, fixed});
}

ir::ValueId Lowering::descriptorOf(const Pointer& pointer) {
    return pointer.descriptor == ir::kNoValue ? emitter_.constantI32(0) : pointer.descriptor;
}

/// One 32-bit word at `at` units from the pointer, which is local, stage, input or buffer; in a buffer also 1 or 2
/// bytes.
ir::ValueId Lowering::loadWord(const Pointer& pointer, uint32_t at, ir::Type type, uint32_t bytes) {
    switch (pointer.base) {
        case Base::local:
            return emitter_.emit(ir::Op::loadLocal, type, {place(pointer, at)},
                                 ir::immPair(pointer.root, pointer.extent));
        case Base::stage:
            return emitter_.emit(ir::Op::loadBuffer, type, {emitter_.constantI32(0), patchPlace(pointer, at)},
                                 patchResource_);
        case Base::buffer:
            return emitter_.emit(ir::Op::loadBuffer, type, {descriptorOf(pointer), place(pointer, at)},
                                 ir::immPair(resourceOrAny(pointer), bytes));
        case Base::address:
            return emitter_.emit(ir::Op::loadAddress, type, {place(pointer, at)}, bytes == 0 ? 4 : bytes);
        default:
            break;
    }
    if (pointer.dynamic != ir::kNoValue) {
        return emitter_.emit(ir::Op::inputIndexed, type, {place(pointer, at)},
                             ir::immPair(pointer.root, pointer.extent));
    }
    const uint32_t slot = pointer.root + pointer.offset + at;
    return emitter_.emit(ir::Op::input, program_.inputs[slot].type, {}, slot);
}

/// A pointer to access the two words at `at` by: into the buffer if it holds both, else outside.
Pointer Lowering::wholly(const Pointer& pointer, uint32_t at) {
    if (pointer.base != Base::buffer || isWorkgroupMemory(pointer)) return pointer;
    const ir::ValueId first = place(pointer, at);
    const ir::ValueId size =
        emitter_.emit(ir::Op::bufferSize, ir::Type::i32, {descriptorOf(pointer)}, resourceOrAny(pointer));
    const ir::ValueId last = binary(ir::Op::iadd, first, emitter_.constantI32(7));
    Pointer whole = pointer;
    whole.dynamic =
        emitter_.emit(ir::Op::select, ir::Type::i32,
                      {compare(ir::Op::ult, last, size), binary(ir::Op::isub, first, emitter_.constantI32(at)),
                       emitter_.constantI32(kFarOutside)});
    whole.offset = 0;
    whole.fromResource = true;
    return whole;
}

ir::ValueId Lowering::loadScalar(const Pointer& pointer, uint32_t at, const LeafType& type) {
    if (ir::isWide(type) && pointer.base == Base::address) {
        return emitter_.emit(ir::Op::loadAddress, type, {place(pointer, at)}, 8);
    }
    if (ir::isWide(type)) {
        const uint32_t word = pointer.inBytes() ? 4 : 1;
        const Pointer whole = wholly(pointer, at);
        const ir::ValueId low = loadWord(whole, at, ir::Type::i32);
        return emitter_.emit(ir::Op::makeWide, type, {low, loadWord(whole, at + word, ir::Type::i32)});
    }
    if (type.type == ir::Type::b1 && pointer.base != Base::input) {
        return compare(ir::Op::ine, loadWord(pointer, at, ir::Type::i32), emitter_.constantI32(0));
    }
    if (type.bits < 32 && pointer.inBytes()) {
        return ofPiece(loadWord(pointer, at, ir::Type::i32, type.bytes()), type);
    }
    const ir::ValueId value = loadWord(pointer, at, type);
    // Attributes come sign-extended, and interpolated with more digits than a half has.
    return pointer.base == Base::input || pointer.base == Base::stage ? normalised(value, type) : value;
}

void Lowering::storeScalar(const Pointer& pointer, uint32_t at, ir::ValueId value, const LeafType& type) {
    if (ir::isWide(type) && pointer.base == Base::address) {
        emitter_.emit(ir::Op::storeAddress, ir::Type::none, {place(pointer, at), value}, 8);
    } else if (ir::isWide(type)) {
        const uint32_t word = pointer.inBytes() ? 4 : 1;
        const Pointer whole = wholly(pointer, at);
        storeWord(whole, at, emitter_.emit(ir::Op::lowWord, ir::Type::i32, {value}));
        storeWord(whole, at + word, emitter_.emit(ir::Op::highWord, ir::Type::i32, {value}));
    } else if (type.type == ir::Type::b1) {
        storeWord(pointer, at, convert(ir::Op::zext, ir::Type::i32, value));
    } else if (type.bits < 32 && pointer.inBytes()) {
        storeWord(pointer, at, pieceOf(value, type), type.bytes());
    } else if (pointer.base == Base::stage && type.isSigned) {
        storeWord(pointer, at, signExtended(value, type));
    } else {
        storeWord(pointer, at, value);
    }
}

/// The counterpart of loadWord.
void Lowering::storeWord(const Pointer& pointer, uint32_t at, ir::ValueId value, uint32_t bytes) {
    if (pointer.base == Base::local) {
        emitter_.emit(ir::Op::storeLocal, ir::Type::none, {place(pointer, at), value},
                      ir::immPair(pointer.root, pointer.extent));
    } else if (pointer.base == Base::stage) {
        emitter_.emit(ir::Op::storeBuffer, ir::Type::none, {emitter_.constantI32(0), patchPlace(pointer, at), value},
                      patchResource_);
    } else if (pointer.base == Base::address) {
        emitter_.emit(ir::Op::storeAddress, ir::Type::none, {place(pointer, at), value}, bytes == 0 ? 4 : bytes);
    } else {
        emitter_.emit(ir::Op::storeBuffer, ir::Type::none, {descriptorOf(pointer), place(pointer, at), value},
                      ir::immPair(resourceOrAny(pointer), bytes));
    }
}

/// Calls visit(byte offset, scalar type) for every scalar of what a buffer pointer points to, by the offsets and
/// strides of its layout decorations.
template <class Visit>
void Lowering::visitBuffer(const Pointer& pointer, uint32_t at, const Visit& visit) {
    const uint32_t typeId = pointer.type;
    const SpirvType& type = typeInfo(typeId);
    Pointer part = pointer;
    if (pointer.wordLayout) {
        for (const LeafType& leaf : leafTypes(typeId)) {
            visit(at, leaf);
            at += ir::isWide(leaf) ? 8 : 4;
        }
        return;
    }
    switch (type.kind) {
        case SpirvType::Kind::structure:
            for (uint32_t m = 0; m < type.members.size(); ++m) {
                part = pointer;
                part.type = type.members[m];
                if (const Decoration* d = module_.findDecoration(typeId, spv::Decoration::MatrixStride, m)) {
                    part.matrixStride = d->value;
                    part.rowMajor = module_.hasDecoration(typeId, spv::Decoration::RowMajor, m);
                }
                visitBuffer(part, at + module_.decorationOr(typeId, spv::Decoration::Offset, m, 0), visit);
            }
            break;
        case SpirvType::Kind::array: {
            const uint32_t stride =
                module_.decorationOr(typeId, spv::Decoration::ArrayStride, Decoration::kNoMember, 0);
            part.type = type.element;
            for (uint32_t i = 0; i < type.count; ++i) visitBuffer(part, at + i * stride, visit);
            break;
        }
        case SpirvType::Kind::matrix: {
            const SpirvType& column = typeInfo(type.element);
            if (pointer.matrixStride == 0) refuseId(pointer.root, "points to a matrix whose layout is not known");
            part.type = type.element;
            part.elementStride = pointer.rowMajor ? pointer.matrixStride : 0;
            const uint32_t stride = pointer.rowMajor ? column.scalar.bytes() : pointer.matrixStride;
            for (uint32_t i = 0; i < type.count; ++i) visitBuffer(part, at + i * stride, visit);
            break;
        }
        case SpirvType::Kind::vector: {
            const uint32_t stride = pointer.elementStride != 0 ? pointer.elementStride : type.scalar.bytes();
            for (uint32_t i = 0; i < type.count; ++i) visit(at + i * stride, type.scalar);
            break;
        }
        default:
            if (type.scalar.type == ir::Type::none)
                refuseId(pointer.root, "is read or written as a whole where that is not possible");
            visit(at, type.scalar);
            break;
    }
}

// --- loads and stores
// ---------------------------------------------------------------------------------------------------

Lowering::Leaves Lowering::load(const Pointer& pointer) {
    const LeafTypes types = leafTypes(pointer.type);
    const NewScalars leaves = newLeaves(types.size());
    if (pointer.inBytes()) {
        size_t next = 0;
        visitBuffer(pointer, 0,
                    [&](uint32_t at, const LeafType& type) { leaves[next++] = loadScalar(pointer, at, type); });
        return leaves;
    }
    uint32_t at = 0;
    for (size_t i = 0; i < types.size(); ++i) {
        switch (pointer.base) {
            case Base::ssa: {
                const uint32_t first = pointer.root + pointer.offset + static_cast<uint32_t>(i);
                if (pointer.dynamic == ir::kNoValue) {
                    leaves[i] = emitter_.read(first, types[i]);
                    break;
                }
                const NewScalars parts = newLeaves(pointer.choices);
                for (uint32_t c = 0; c < pointer.choices; ++c) {
                    parts[c] = emitter_.read(first + c * pointer.choiceStride, types[i]);
                }
                leaves[i] = chooseLeaf(parts, pointer.dynamic);
                break;
            }
            case Base::builtin: {
                const Leaves parts = builtinLeaves(static_cast<spv::BuiltIn>(pointer.root));
                leaves[i] = pointer.dynamic != ir::kNoValue
                                ? chooseLeaf(parts, place(pointer, at))
                                : parts[std::min<size_t>(pointer.offset + at, parts.size() - 1)];
                break;
            }
            case Base::local:
            case Base::stage:
            case Base::input:
                leaves[i] = loadScalar(pointer, at, types[i]);
                break;
            default:
                refuseId(pointer.root, "is not memory that can be loaded from");
        }
        at += ir::isWide(types[i]) ? 2 : 1;
    }
    return leaves;
}

void Lowering::store(const Pointer& pointer, Leaves leaves) {
    const LeafTypes types = leafTypes(pointer.type);
    require(leaves, pointer.type, pointer.root);
    switch (pointer.base) {
        case Base::ssa:
            if (pointer.dynamic != ir::kNoValue) return storeChoice(pointer, leaves);
            for (uint32_t i = 0; i < leaves.size(); ++i) emitter_.write(pointer.root + pointer.offset + i, leaves[i]);
            break;
        case Base::local:
        case Base::stage: {
            uint32_t at = 0;
            for (size_t i = 0; i < leaves.size(); ++i) {
                storeScalar(pointer, at, leaves[i], types[i]);
                at += ir::isWide(types[i]) ? 2 : 1;
            }
            break;
        }
        case Base::buffer:
            if (!pointer.anyResource && !ir::isWritable(program_.resources[resourceOf(pointer.root)].kind)) {
                refuseId(pointer.root, "is stored to, but it is only read");
            }
            [[fallthrough]];
        case Base::address: {
            size_t next = 0;
            visitBuffer(pointer, 0,
                        [&](uint32_t at, const LeafType& type) { storeScalar(pointer, at, leaves[next++], type); });
            break;
        }
        default:
            refuseId(pointer.root, "is stored to, but it is only read");
    }
}

/// Every part keeps its value unless it is the chosen one; an index out of range stores nothing.
void Lowering::storeChoice(const Pointer& pointer, Leaves leaves) {
    for (uint32_t c = 0; c < pointer.choices; ++c) {
        const ir::ValueId here = compare(ir::Op::ieq, pointer.dynamic, emitter_.constantI32(c));
        for (uint32_t i = 0; i < leaves.size(); ++i) {
            const uint32_t variable = pointer.root + pointer.offset + c * pointer.choiceStride + i;
            const ir::Type type = emitter_.typeOf(leaves[i]);
            emitter_.write(variable,
                           emitter_.emit(ir::Op::select, type, {here, leaves[i], emitter_.read(variable, type)}));
        }
    }
}

bool Lowering::lowerMemory(const Instruction& inst) {
    switch (inst.op) {
        case spv::Op::OpAccessChain:
        case spv::Op::OpInBoundsAccessChain:
            lowerAccessChain(inst);
            return true;
        case spv::Op::OpPtrAccessChain:
        case spv::Op::OpInBoundsPtrAccessChain:
            lowerPtrAccessChain(inst);
            return true;
        case spv::Op::OpLoad: {
            const Pointer& pointer = pointerOf(inst[3]);
            if (pointer.base != Base::handle) {
                setValue(inst[2], inst[1], load(pointer));
                return true;
            }
            const SpirvType& type = typeInfo(pointer.type);
            if (!type.isOpaque()) refuse(inst, "arrays of images cannot be loaded as a whole");
            Handle handle;
            const uint32_t resource = resourceOf(pointer.root);
            if (type.kind != SpirvType::Kind::sampler) {
                handle.imageType = type.kind == SpirvType::Kind::image ? pointer.type : type.element;
                handle.imageResource = resource;
                handle.imageIndex = descriptorOf(pointer);
            }
            if (type.kind != SpirvType::Kind::image) {
                handle.samplerResource = resource;
                handle.samplerIndex = descriptorOf(pointer);
            }
            setHandle(inst[2], handle);
            return true;
        }
        case spv::Op::OpStore:
            store(pointerOf(inst[1]), leavesOf(inst[2]));
            return true;
        case spv::Op::OpCopyMemory:
            store(pointerOf(inst[1]), load(pointerOf(inst[2])));
            return true;
        case spv::Op::OpArrayLength:
            lowerArrayLength(inst);
            return true;
        case spv::Op::OpImageTexelPointer:
            lowerTexelPointer(inst);
            return true;
        default:
            return lowerAtomic(inst) || lowerPointer(inst);
    }
}

/// The elements of a runtime array: what of the buffer lies behind the array's offset, in whole strides.
void Lowering::lowerArrayLength(const Instruction& inst) {
    const Pointer& pointer = pointerOf(inst[3]);
    const SpirvType& type = typeInfo(pointer.type);
    if (pointer.base != Base::buffer || inst[4] >= type.members.size()) refuse(inst, "is not of a member of a buffer");
    const uint32_t offset = module_.decorationOr(pointer.type, spv::Decoration::Offset, inst[4], 0);
    const uint32_t stride =
        module_.decorationOr(type.members[inst[4]], spv::Decoration::ArrayStride, Decoration::kNoMember, 4);
    const ir::ValueId size =
        emitter_.emit(ir::Op::bufferSize, ir::Type::i32, {descriptorOf(pointer)}, resourceOrAny(pointer));
    const ir::ValueId first = emitter_.constantI32(offset);
    // max(size, offset) - offset: an array that begins behind the end has no elements.
    const ir::ValueId bytes = binary(ir::Op::isub, binary(ir::Op::umax, size, first), first);
    setScalar(inst[2], inst[1], binary(ir::Op::udiv, bytes, emitter_.constantI32(std::max(stride, 1u))));
}

}  // namespace vernier
