// Constants and specialisation constants. They become `constant` values of the entry block; operations on them are
// lowered like any others and folded by the Emitter.
#include <bit>
#include <cmath>
#include <cstring>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

void Lowering::lowerConstant(const Instruction& inst) {
    const uint32_t type = inst[1], id = inst[2];
    switch (inst.op) {
        case spv::Op::OpConstantTrue:
        case spv::Op::OpConstantFalse:
            setScalar(id, type, emitter_.constantBool(inst.op == spv::Op::OpConstantTrue));
            break;
        case spv::Op::OpSpecConstantTrue:
        case spv::Op::OpSpecConstantFalse: {
            const uint64_t bits = specialised(inst, inst.op == spv::Op::OpSpecConstantTrue ? 1 : 0, 4);
            setScalar(id, type, emitter_.constantBool(bits != 0));
            break;
        }
        case spv::Op::OpConstant:
        case spv::Op::OpSpecConstant: {
            const LeafType& scalar = scalarType(type);
            uint64_t bits = inst[3];
            if (scalar.bits == 64) bits |= static_cast<uint64_t>(inst[4]) << 32;
            if (inst.op == spv::Op::OpSpecConstant) bits = specialised(inst, bits, scalar.bytes());
            setScalar(id, type, constantOfBits(scalar, bits));
            break;
        }
        case spv::Op::OpConstantComposite:
        case spv::Op::OpSpecConstantComposite: {
            const NewScalars leaves = newLeaves(leafTypes(type).size());
            size_t next = 0;
            for (uint32_t word = 3; word < inst.count; ++word) {
                if (typeInfo(typeOfId(inst[word])).leaves == 0) continue;
                for (const ir::ValueId leaf : leavesOf(inst[word])) {
                    if (next < leaves.size()) leaves[next++] = leaf;
                }
            }
            if (next != leaves.size()) refuse(inst, "the constituents do not fill the type");
            setValue(id, type, leaves);
            break;
        }
        case spv::Op::OpConstantNull:
            setValue(id, type, zeroOf(type));
            break;
        case spv::Op::OpUndef:
            setValue(id, type, undefOf(type));
            break;
        case spv::Op::OpSpecConstantOp: {
            // The operation without its opcode word has the layout of the instruction itself.
            std::vector<uint32_t> words{inst[0], type, id};
            for (uint32_t word = 4; word < inst.count; ++word) words.push_back(inst[word]);
            const Instruction operation{static_cast<spv::Op>(inst[3]), static_cast<uint32_t>(words.size()),
                                        words.data()};
            if (!lowerComposite(operation) && !lowerArithmetic(operation)) {
                refuse(operation, "is not supported in OpSpecConstantOp");
            }
            break;
        }
        default:
            refuse(inst, "the constant is not supported");
    }
}

/// A constant of a type from its bits; those above a narrow type's width do not count.
ir::ValueId Lowering::constantOfBits(const LeafType& type, uint64_t bits) {
    if (!type.isHalf()) return emitter_.constant(type, type.isNarrowInteger() ? bits & type.mask() : bits);
    const uint32_t sign = static_cast<uint32_t>(bits & 0x8000) << 16, mantissa = static_cast<uint32_t>(bits & 0x3FF);
    const auto exponent = static_cast<int>(bits >> 10 & 0x1F);
    if (exponent == 0x1F) return emitter_.constant(type, sign | 0x7F800000u | mantissa << 13);
    // Denormal: mantissa * 2^-24; normal: (1024 + mantissa) * 2^(exponent - 25).
    const float magnitude = exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                                          : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
    return emitter_.constant(type, sign | std::bit_cast<uint32_t>(magnitude));
}

uint64_t Lowering::specialised(const Instruction& inst, uint64_t bits, uint32_t bytes) const {
    const Decoration* decoration = module_.findDecoration(inst[2], spv::Decoration::SpecId);
    if (decoration == nullptr) return bits;
    for (const Specialization::Entry& entry : source_.specialization.entries) {
        if (entry.constantId != decoration->value) continue;
        const size_t available = source_.specialization.data.size();
        if (entry.size != bytes || entry.offset > available || available - entry.offset < bytes) {
            throw LoweringError{invalidArgument(
                "specialisation constant " + std::to_string(entry.constantId) + ": offset " +
                std::to_string(entry.offset) + " and size " + std::to_string(entry.size) + " do not give the " +
                std::to_string(bytes) + " bytes of the constant in " + std::to_string(available) + " bytes of data")};
        }
        bits = 0;
        std::memcpy(&bits, source_.specialization.data.data() + entry.offset, bytes);
        return bits;
    }
    return bits;
}

std::optional<uint32_t> Lowering::constantOf(uint32_t id) {
    const std::optional<uint64_t> bits = emitter_.constantBits(scalarOf(id));
    if (!bits) return std::nullopt;
    return static_cast<uint32_t>(*bits);
}

uint32_t Lowering::constantIndex(uint32_t id) {
    const std::optional<uint32_t> value = constantOf(id);
    if (!value) refuseId(id, "is not a constant that can be computed");
    return *value;
}

Lowering::Leaves Lowering::zeroOf(uint32_t type) {
    const LeafTypes types = leafTypes(type);
    const NewScalars leaves = newLeaves(types.size());
    for (size_t i = 0; i < types.size(); ++i) leaves[i] = emitter_.constant(types[i], 0);
    // A null pointer into a buffer has no descriptor and no handle.
    if (isBufferPointer(type)) leaves[0] = emitter_.constantI32(ir::kNullHandle);
    return leaves;
}

Lowering::Leaves Lowering::undefOf(uint32_t type) {
    const LeafTypes types = leafTypes(type);
    const NewScalars leaves = newLeaves(types.size());
    for (size_t i = 0; i < types.size(); ++i) leaves[i] = emitter_.undef(types[i]);
    return leaves;
}

}  // namespace vernier
