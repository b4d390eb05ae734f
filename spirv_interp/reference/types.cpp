// Types: their declaration, their flattened size and their layout in buffers.
#include <algorithm>

#include "spirv_interp/reference/module_data.h"

namespace vernier::reference {
namespace {

constexpr uint64_t kHuge = uint64_t{1} << 60;

uint64_t saturatingAdd(uint64_t a, uint64_t b) {
    return std::min(kHuge, a + b);
}  // both at most kHuge
uint64_t saturatingMultiply(uint64_t a, uint64_t b) {
    return a != 0 && b > kHuge / a ? kHuge : a * b;
}

class TypeParser {
  public:
    TypeParser(const ModuleData& module, const Instruction& instruction) : module_(module), i_(instruction) {
        type_.id = i_.result;
    }

    Type run() {
        switch (i_.op) {
            case spv::OpTypeVoid:
                type_.kind = TypeKind::voidType;
                break;
            case spv::OpTypeBool:
                scalar(TypeKind::boolean, 32);
                break;
            case spv::OpTypeInt:
                scalar(TypeKind::integer, i_.operand(0));
                type_.isSigned = i_.operand(1) != 0;
                break;
            case spv::OpTypeFloat:
                scalar(TypeKind::floating, i_.operand(0));
                break;
            case spv::OpTypeVector:
                vector();
                break;
            case spv::OpTypeMatrix:
                matrix();
                break;
            case spv::OpTypeArray:
                array();
                break;
            case spv::OpTypeRuntimeArray:
                type_.kind = TypeKind::runtimeArray;
                element(i_.operand(0));
                break;
            case spv::OpTypeStruct:
                structure();
                break;
            case spv::OpTypePointer:
                type_.kind = TypeKind::pointer;
                type_.storage = enumerant<spv::StorageClass>(i_.operand(0));
                element(i_.operand(1));
                type_.depth = 0;  // what it points at is no part of it
                pointer();
                break;
            case spv::OpTypeForwardPointer:
                type_.id = i_.operand(0);
                type_.kind = TypeKind::pointer;
                type_.storage = enumerant<spv::StorageClass>(i_.operand(1));
                pointer();
                break;
            case spv::OpTypeFunction:
                type_.kind = TypeKind::function;
                element(i_.operand(0));
                for (size_t k = 1; k < i_.operands.size(); ++k)
                    type_.members.push_back(module_.typeIndex(i_.operands[k]));
                break;
            case spv::OpTypeImage:
                image();
                break;
            case spv::OpTypeSampler:
                type_.kind = TypeKind::sampler;
                break;
            case spv::OpTypeSampledImage:
                type_.kind = TypeKind::sampledImage;
                if (element(i_.operand(0)).kind != TypeKind::image)
                    fail(name(i_.result) + ": sampled image of no image");
                break;
            default:
                failUnsupported(name(i_.op));
        }
        if (type_.depth > kMaxTypeDepth) fail("type " + name(i_.result) + " is nested too deeply");
        return std::move(type_);
    }

  private:
    void scalar(TypeKind kind, uint32_t width) {
        const bool narrow = width == 16 || (width == 8 && kind == TypeKind::integer);
        if (width != 32 && width != 64 && !narrow) failUnsupported(name(i_.op) + " of width " + std::to_string(width));
        type_.kind = kind;
        type_.width = width;
        type_.scalars = 1;
        type_.holdable = true;
    }

    /// One scalar: an address in physical storage, or a number of the invocation's own for a logical pointer.
    void pointer() {
        type_.width = 64;
        type_.scalars = 1;
        type_.holdable = true;
    }

    const Type& element(Id id) {
        type_.element = module_.typeIndex(id);
        const Type& e = module_.types[type_.element];
        type_.depth = e.depth + 1;
        return e;
    }

    void vector() {
        type_.kind = TypeKind::vector;
        type_.count = i_.operand(1);
        if (!element(i_.operand(0)).isScalar() || type_.count < 2 || type_.count > 4)
            failUnsupported("vector type " + name(i_.result) + " of " + std::to_string(type_.count) + " components");
        type_.scalars = type_.count;
        type_.holdable = true;
    }

    void matrix() {
        type_.kind = TypeKind::matrix;
        type_.count = i_.operand(1);
        const Type& column = element(i_.operand(0));
        if (column.kind != TypeKind::vector || module_.types[column.element].kind != TypeKind::floating ||
            type_.count < 2 || type_.count > 4)
            failUnsupported("matrix type " + name(i_.result));
        type_.scalars = type_.count * column.scalars;
        type_.holdable = true;
    }

    void array() {
        type_.kind = TypeKind::array;
        const uint64_t length = module_.constantInteger(i_.operand(1));
        if (length == 0 || length > 0xFFFFFFFFu)
            fail("array type " + name(i_.result) + " of length " + std::to_string(length));
        type_.count = static_cast<uint32_t>(length);
        const Type& e = element(i_.operand(0));
        type_.scalars = saturatingMultiply(length, e.scalars);
        type_.holdable = e.holdable;
    }

    void structure() {
        type_.kind = TypeKind::structure;
        type_.holdable = !i_.operands.empty();
        for (const Id id : i_.operands) {
            const uint32_t index = module_.typeIndex(id);
            const Decorations& d = module_.decorationsOf(i_.result, static_cast<uint32_t>(type_.members.size()));
            const uint64_t bytes = module_.byteSize(module_.types[index], d.matrixStride.value_or(0), d.rowMajor);
            type_.bytes = std::max(type_.bytes, saturatingAdd(d.offset.value_or(0), bytes));
            type_.holdable = type_.holdable && module_.types[index].holdable;
            type_.members.push_back(index);
            type_.cellOffsets.push_back(type_.scalars);
            type_.scalars = saturatingAdd(type_.scalars, module_.types[index].scalars);
            type_.depth = std::max(type_.depth, module_.types[index].depth + 1);
        }
    }

    void image() {
        type_.kind = TypeKind::image;
        const Type& texel = element(i_.operand(0));
        if ((texel.kind != TypeKind::floating && texel.kind != TypeKind::integer) || texel.width != 32)
            failUnsupported("image type " + name(i_.result) + " with texels that are not 32-bit numbers");
        ImageShape& shape = type_.shape;
        shape.dim = enumerant<spv::Dim>(i_.operand(1));
        shape.depth = i_.operand(2) == 1;
        shape.arrayed = i_.operand(3) != 0;
        shape.multisampled = i_.operand(4) != 0;
        shape.storage = i_.operand(5) == 2;
        shape.floating = texel.kind == TypeKind::floating;
        shape.signedTexels = shape.floating || texel.isSigned;
        if (i_.operand(1) > spv::DimSubpassData) failUnsupported("image dimension " + std::to_string(i_.operand(1)));
    }

    const ModuleData& module_;
    const Instruction& i_;
    Type type_;
};

}  // namespace

void parseType(ModuleData& module, const Instruction& instruction) {
    Type type = TypeParser(module, instruction).run();
    const bool forward = type.id < module.ids.size() && module.ids[type.id].kind == IdKind::type;
    if (forward) {
        // A pointer that was announced: structs may already have it as a member.
        if (instruction.op != spv::OpTypePointer || module.typeOf(type.id).kind != TypeKind::pointer)
            fail(name(type.id) + " is defined twice");
        module.types[module.typeIndex(type.id)] = std::move(type);
    } else {
        module.types.push_back(std::move(type));
    }
}

const Type& ModuleData::scalarType(const Type& type) const {
    const Type* inner = &type;
    while (inner->kind == TypeKind::vector || inner->kind == TypeKind::matrix) inner = &types[inner->element];
    return *inner;
}

uint64_t ModuleData::valueScalars(const Type& type) const {
    if (!type.holdable) fail("type " + name(type.id) + " has no values that can be held in a variable or result");
    if (type.scalars > kMaxScalars) failUnsupported("type " + name(type.id) + " is too large to be held in a value");
    return type.scalars;
}

ModuleData::Range ModuleData::subrange(const Type& type, std::span<const uint32_t> indices) const {
    Range range{static_cast<uint32_t>(&type - types.data()), 0, valueScalars(type)};
    for (const uint32_t index : indices) {
        const Type& at = types[range.type];
        const bool isStruct = at.kind == TypeKind::structure;
        if (at.isScalar() || index >= (isStruct ? at.members.size() : at.count))
            fail("index " + std::to_string(index) + " into type " + name(at.id) + " is out of range");
        range.type = isStruct ? at.members[index] : at.element;
        range.count = types[range.type].scalars;
        range.first += isStruct ? at.cellOffsets[index] : index * range.count;
    }
    return range;
}

uint64_t ModuleData::byteSize(const Type& type, uint32_t matrixStride, bool rowMajor) const {
    switch (type.kind) {
        case TypeKind::boolean:
        case TypeKind::integer:
        case TypeKind::floating:
        case TypeKind::pointer:
            return type.width / 8;
        case TypeKind::vector:
            return uint64_t{type.count} * types[type.element].width / 8;
        case TypeKind::matrix: {
            const uint64_t rows = types[type.element].count, bytes = scalarType(type).width / 8;
            const uint64_t lines = rowMajor ? rows : type.count, along = rowMajor ? type.count : rows;
            return (lines - 1) * matrixStride + along * bytes;
        }
        case TypeKind::array:
            return saturatingAdd(saturatingMultiply(type.count - 1, decorationsOf(type.id).arrayStride.value_or(0)),
                                 byteSize(types[type.element], matrixStride, rowMajor));
        case TypeKind::structure:
            return type.bytes;
        default:
            return 0;
    }
}

}  // namespace vernier::reference
