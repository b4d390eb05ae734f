// Taking composites apart and putting them together: bookkeeping of leaves, without instructions, except where a
// component is chosen at run time.
#include <algorithm>

#include "spirv_interp/front/lowering.h"

namespace vernier {

/// The first leaf of the part that the literal indices from `firstWord` on name; `partType` becomes its type.
uint32_t Lowering::leafOfPart(uint32_t typeId, const Instruction& inst, uint32_t firstWord, uint32_t& partType) const {
    uint32_t leaf = 0;
    partType = typeId;
    for (uint32_t word = firstWord; word < inst.count; ++word) {
        const SpirvType& type = typeInfo(partType);
        const uint32_t index = inst[word];
        const uint32_t count =
            type.kind == SpirvType::Kind::structure ? static_cast<uint32_t>(type.members.size()) : type.count;
        if (index >= count) refuse(inst, "index " + std::to_string(index) + " is out of range");
        if (type.kind == SpirvType::Kind::structure) {
            leaf += type.memberLeaf[index];
            partType = type.members[index];
        } else {
            leaf += index * typeInfo(type.element).leaves;
            partType = type.element;
        }
    }
    return leaf;
}

bool Lowering::lowerComposite(const Instruction& inst) {
    const uint32_t type = inst[1], id = inst[2];
    switch (inst.op) {
        case spv::Op::OpExpectKHR:
        case spv::Op::OpCopyObject: {
            const IdValue copied = idValue(inst[3]);
            ids_[id] = copied;
            return true;
        }
        case spv::Op::OpCopyLogical:
            setValue(id, type, leavesOf(inst[3]));
            return true;
        case spv::Op::OpCompositeConstruct: {
            const NewScalars leaves = newLeaves(leafTypes(type).size());
            size_t next = 0;
            for (uint32_t word = 3; word < inst.count; ++word) {
                const bool empty =
                    idValue(inst[word]).kind == IdValue::Kind::value && idValue(inst[word]).leaves.empty();
                if (empty) continue;
                for (const ir::ValueId leaf : leavesOf(inst[word])) {
                    if (next < leaves.size()) leaves[next++] = leaf;
                }
            }
            if (next != leaves.size()) refuse(inst, "the constituents do not fill the type");
            setValue(id, type, leaves);
            return true;
        }
        case spv::Op::OpCompositeExtract: {
            uint32_t part = 0;
            const uint32_t leaf = leafOfPart(typeOfId(inst[3]), inst, 4, part);
            setValue(id, type, leavesOf(inst[3]).subspan(leaf, typeInfo(part).leaves));
            return true;
        }
        case spv::Op::OpCompositeInsert: {
            uint32_t part = 0;
            const uint32_t leaf = leafOfPart(type, inst, 5, part);
            const NewScalars leaves = arena_.copy(leavesOf(inst[4]));
            std::ranges::copy(leavesOf(inst[3]), leaves.begin() + leaf);
            setValue(id, type, leaves);
            return true;
        }
        case spv::Op::OpVectorShuffle: {
            const Leaves a = leavesOf(inst[3]), b = leavesOf(inst[4]);
            const NewScalars leaves = newLeaves(leafTypes(type).size());
            for (uint32_t i = 0; i < leaves.size(); ++i) {
                const uint32_t from = inst[5 + i];
                // 0xFFFFFFFF: a component without a source.
                if (from < a.size()) {
                    leaves[i] = a[from];
                } else {
                    leaves[i] = from - a.size() < b.size() ? b[from - a.size()] : emitter_.undef(scalarType(type));
                }
            }
            setValue(id, type, leaves);
            return true;
        }
        case spv::Op::OpVectorExtractDynamic: {
            const Leaves vector = leavesOf(inst[3]);
            const ir::ValueId index = indexOf(inst[4]);
            setScalar(id, type, chooseLeaf(vector, index));
            return true;
        }
        case spv::Op::OpVectorInsertDynamic: {
            const Leaves vector = leavesOf(inst[3]);
            const ir::ValueId component = scalarOf(inst[4]), index = indexOf(inst[5]);
            const NewScalars leaves = newLeaves(vector.size());
            for (uint32_t i = 0; i < leaves.size(); ++i) {
                const ir::ValueId here = compare(ir::Op::ieq, index, emitter_.constantI32(i));
                leaves[i] = emitter_.emit(ir::Op::select, emitter_.typeOf(component), {here, component, vector[i]});
            }
            setValue(id, type, leaves);
            return true;
        }
        default:
            return false;
    }
}

/// values[index]; an index out of range gives the last.
ir::ValueId Lowering::chooseLeaf(Leaves values, ir::ValueId index) {
    ir::ValueId result = values.back();
    for (uint32_t i = static_cast<uint32_t>(values.size()) - 1; i-- > 0;) {
        const ir::ValueId here = compare(ir::Op::ieq, index, emitter_.constantI32(i));
        result = emitter_.emit(ir::Op::select, emitter_.typeOf(result), {here, values[i], result});
    }
    return result;
}

}  // namespace vernier
