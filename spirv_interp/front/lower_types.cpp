// Types, and the list of scalars a value of a type comes apart into.
#include <algorithm>

#include "spirv_interp/front/lowering.h"

namespace vernier {
namespace {

constexpr LeafType kWord{ir::Type::i32, 32, false};

uint32_t wordsOf(ir::Type type) {
    return type == ir::Type::i64 || type == ir::Type::f64 ? 2 : 1;
}

}  // namespace

const SpirvType& Lowering::typeInfo(uint32_t id) const {
    if (id >= typeIndex_.size() || typeIndex_[id] == 0) refuseId(id, "is not a type that is supported");
    return types_[typeIndex_[id]];
}

void Lowering::lowerType(const Instruction& inst) {
    using Kind = SpirvType::Kind;
    SpirvType type;
    const auto repeat = [&](Kind kind, uint32_t element, uint64_t count) {
        const SpirvType& part = typeInfo(element);
        type.kind = kind;
        type.element = element;
        type.depth = part.depth + 1;
        type.count = static_cast<uint32_t>(count);
        if (kind != Kind::array) type.scalar = part.scalar;
        // Buffers may hold arrays of any length; only values that come apart are limited, where they do.
        const auto capped = [count](uint64_t each) {
            return static_cast<uint32_t>(std::min<uint64_t>(each * count, ~0u));
        };
        type.leaves = capped(part.leaves);
        type.words = capped(part.words);
    };
    const uint32_t id = inst[1];
    switch (inst.op) {
        case spv::Op::OpTypeVoid:
            type.kind = Kind::void_;
            break;
        case spv::Op::OpTypeBool:
            type.kind = Kind::boolean;
            type.scalar = {ir::Type::b1, 32, false};
            break;
        case spv::Op::OpTypeInt:
            if (inst[2] != 8 && inst[2] != 16 && inst[2] != 32 && inst[2] != 64)
                refuse(inst, std::to_string(inst[2]) + "-bit integers are not supported");
            type.kind = Kind::integer;
            type.scalar = {inst[2] == 64 ? ir::Type::i64 : ir::Type::i32, static_cast<uint8_t>(inst[2]), inst[3] != 0};
            break;
        case spv::Op::OpTypeFloat:
            if (inst[2] != 16 && inst[2] != 32 && inst[2] != 64)
                refuse(inst, std::to_string(inst[2]) + "-bit floats are not supported");
            type.kind = Kind::floating;
            type.scalar = {inst[2] == 64 ? ir::Type::f64 : ir::Type::f32, static_cast<uint8_t>(inst[2]), true};
            break;
        case spv::Op::OpTypeVector:
            repeat(Kind::vector, inst[2], inst[3]);
            break;
        case spv::Op::OpTypeMatrix:
            repeat(Kind::matrix, inst[2], inst[3]);
            break;
        case spv::Op::OpTypeArray:
            repeat(Kind::array, inst[2], constantIndex(inst[3]));
            break;
        case spv::Op::OpTypeRuntimeArray:
            type.kind = Kind::runtimeArray;
            type.element = inst[2];
            type.depth = typeInfo(inst[2]).depth + 1;
            break;
        case spv::Op::OpTypeStruct:
            type.kind = Kind::structure;
            for (uint32_t word = 2; word < inst.count; ++word) {
                const SpirvType& member = typeInfo(inst[word]);
                type.members.push_back(inst[word]);
                type.depth = std::max(type.depth, member.depth + 1);
                type.memberLeaf.push_back(type.leaves);
                type.memberWord.push_back(type.words);
                const auto sum = [](uint64_t a, uint64_t b) {
                    return static_cast<uint32_t>(std::min<uint64_t>(a + b, ~0u));
                };
                type.leaves = sum(type.leaves, member.leaves);
                type.words = sum(type.words, member.words);
            }
            break;
        case spv::Op::OpTypeForwardPointer:
            // It names a type that comes later: no result, whose bounds the module has checked.
            if (id == 0 || id >= typeIndex_.size()) refuse(inst, "the id of the pointer is out of bounds");
            [[fallthrough]];
        case spv::Op::OpTypePointer:
            type.kind = Kind::pointer;
            type.storage = static_cast<spv::StorageClass>(inst[2]);
            type.element = inst[3];
            if (type.storage == spv::StorageClass::PhysicalStorageBuffer) {
                type.scalar = {ir::Type::i64, 64, false};
            } else if (isBufferPointer(id)) {
                // A descriptor or buffer handle, and a byte offset: lower_pointer.cpp.
                type.leaves = type.words = 2;
            }
            break;
        case spv::Op::OpTypeFunction:
            type.kind = Kind::function;
            break;
        case spv::Op::OpTypeImage: {
            const SpirvType& sampled = typeInfo(inst[2]);
            type.kind = Kind::image;
            type.image.component = sampled.kind == Kind::void_ ? ir::Type::f32 : sampled.scalar.type;
            if (sampled.kind != Kind::void_ && sampled.scalar.bits != 32) {
                refuse(inst, "images of " + std::to_string(sampled.scalar.bits) + "-bit components are not supported");
            }
            type.image.dim = static_cast<spv::Dim>(inst[3]);
            if (type.image.dim == spv::Dim::Rect) refuse(inst, "rectangle images are not supported");
            type.image.depth = inst[4] == 1;
            type.image.arrayed = inst[5] != 0;
            type.image.multisampled = inst[6] != 0;
            type.image.storage = inst[7] == 2;
            break;
        }
        case spv::Op::OpTypeSampler:
            type.kind = Kind::sampler;
            break;
        case spv::Op::OpTypeSampledImage:
            type.kind = Kind::sampledImage;
            type.element = inst[2];
            break;
        default:
            refuse(inst, "the type is not supported");
    }
    if (type.depth > kMaxTypeDepth) refuse(inst, "types are nested deeper than " + std::to_string(kMaxTypeDepth));
    if (type.scalar != ir::Type::none && !type.isComposite()) {
        type.leaves = 1;
        type.words = wordsOf(type.scalar);
    }
    typeIndex_[id] = static_cast<uint32_t>(types_.size());
    types_.push_back(std::move(type));
    leafTypes_.emplace_back();
}

Lowering::LeafTypes Lowering::leafTypes(uint32_t id) {
    const SpirvType& type = typeInfo(id);
    std::vector<LeafType>& types = leafTypes_[typeIndex_[id]];
    if (types.empty() && type.leaves != 0) {
        if (type.leaves > kMaxLeaves) {
            refuseId(id, "has values of " + std::to_string(type.leaves) + " scalars; the limit is " +
                             std::to_string(kMaxLeaves));
        }
        types.reserve(type.leaves);
        appendLeafTypes(id, types);
    }
    return types;
}

void Lowering::appendLeafTypes(uint32_t id, std::vector<LeafType>& types) const {
    const SpirvType& type = typeInfo(id);
    switch (type.kind) {
        case SpirvType::Kind::structure:
            for (const uint32_t member : type.members) appendLeafTypes(member, types);
            break;
        case SpirvType::Kind::vector:
        case SpirvType::Kind::matrix:
        case SpirvType::Kind::array:
            for (uint32_t i = 0; i < type.count && typeInfo(type.element).leaves != 0; ++i) {
                appendLeafTypes(type.element, types);
            }
            break;
        case SpirvType::Kind::pointer:
            types.insert(types.end(), type.leaves, type.scalar != ir::Type::none ? type.scalar : kWord);
            break;
        default:
            if (type.scalar != ir::Type::none) types.push_back(type.scalar);
            break;
    }
}

}  // namespace vernier
