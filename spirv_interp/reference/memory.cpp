// Variables, pointers, loads and stores.
#include <cstring>

#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/machine.h"

namespace vernier::reference {
namespace {

/// Offsets beyond this are outside every buffer: sums of a few of them cannot wrap around.
constexpr int64_t kMaxOffset = int64_t{1} << 48;

template <class Number>
Scalar<Number> readScalar(std::span<const std::byte> bytes, uint64_t offset, const Type& type) {
    const size_t size = type.width / 8;
    if (bytes.size() < size || offset > bytes.size() - size) return {};
    uint64_t raw = 0;
    std::memcpy(&raw, bytes.data() + offset, size);
    return bitsScalar<Number>(raw, type);
}

template <class Number>
void writeScalar(std::span<std::byte> bytes, uint64_t offset, const Type& type, const Scalar<Number>& scalar) {
    const size_t size = type.width / 8;
    if (bytes.size() < size || offset > bytes.size() - size) return;
    const uint64_t raw = scalarBits(scalar, type);
    std::memcpy(bytes.data() + offset, &raw, size);
}

}  // namespace

/// One object for all invocations of a work-group, or of a patch: its outputs.
template <class Number>
bool Machine<Number>::isShared(const Variable& variable) const {
    return variable.storage == spv::StorageClassWorkgroup ||
           (variable.storage == spv::StorageClassOutput && shared_ != nullptr);
}

template <class Number>
Pointer<Number> Machine<Number>::variablePointer(const Variable& variable) {
    Pointer<Number> pointer;
    pointer.type = module_.types[variable.pointerType].element;
    const Type& type = module_.types[pointer.type];
    const Decorations& d = module_.decorationsOf(variable.id);
    pointer.descriptor = {d.set.value_or(0), d.binding.value_or(0), 0};
    const bool shared = isShared(variable);
    switch (variable.storage) {
        case spv::StorageClassUniformConstant:
            pointer.atDescriptors = type.isArray();
            return pointer;
        case spv::StorageClassPushConstant:
            pointer.isBuffer = true;
            pointer.kind = BufferKind::pushConstants;
            pointer.descriptor = {};
            return pointer;
        case spv::StorageClassUniform:
        case spv::StorageClassStorageBuffer: {
            pointer.isBuffer = true;
            pointer.atDescriptors = type.isArray();
            const Type* block = &type;
            while (block->isArray()) block = &module_.types[block->element];
            if (variable.storage == spv::StorageClassStorageBuffer || module_.decorationsOf(block->id).bufferBlock)
                pointer.kind = BufferKind::storage;
            return pointer;
        }
        case spv::StorageClassWorkgroup:
            if (shared_ == nullptr) fail("work-group variable " + name(variable.id) + " outside a compute shader");
            break;
        default:
            break;
    }
    if (shared) {
        pointer.object = (*shared_)[static_cast<uint32_t>(&variable - module_.variables.data())];
        if (pointer.object) return pointer;
    }
    const uint64_t count = module_.valueScalars(type);
    charge(count);
    pointer.object = std::make_shared<Object<Number>>();
    pointer.object->cells.resize(count);
    pointer.object->written.resize(count);
    if (shared) (*shared_)[static_cast<uint32_t>(&variable - module_.variables.data())] = pointer.object;
    if (variable.initializer != 0) store(pointer, data(variable.initializer, count));
    return pointer;
}

template <class Number>
Scalar<Number> Machine<Number>::pointerScalar(const Pointer<Number>& p) const {
    if (p.isPhysical) return Scalar<Number>::ofBits(p.outside ? 0 : p.offset);
    pointers_.push_back(p);
    return Scalar<Number>::ofBits(pointers_.size());
}

template <class Number>
Pointer<Number> Machine<Number>::scalarPointer(const Type& type, uint64_t bits) const {
    Pointer<Number> p;
    if (type.storage == spv::StorageClassPhysicalStorageBuffer) {
        p.isBuffer = p.isPhysical = true;
        p.kind = BufferKind::storage;
        p.offset = bits;
    } else if (bits != 0 && bits <= pointers_.size()) {
        p = pointers_[bits - 1];
    } else {
        p.outside = true;  // null
    }
    p.type = type.element;
    return p;
}

/// OpPtrAccessChain's first index: elements of the array that the pointer points into.
template <class Number>
Pointer<Number> Machine<Number>::element(Pointer<Number> p, const Type& pointerType, Id indexId) const {
    const int64_t i = signedInteger(indexId);
    const Type& type = module_.types[p.type];
    const auto stride =
        static_cast<int64_t>(p.isBuffer ? module_.decorationsOf(pointerType.id).arrayStride.value_or(0) : type.scalars);
    __extension__ using Wide = __int128;
    const Wide offset = Wide(i) * stride + static_cast<int64_t>(p.offset);
    const auto end = p.object ? static_cast<int64_t>(p.object->cells.size() - type.scalars) : kMaxOffset;
    p.outside = p.outside || offset < 0 || offset > end;
    p.offset = p.outside ? 0 : static_cast<uint64_t>(offset);
    return p;
}

/// The bytes that hold an access of `size` bytes at `offset`, which becomes an offset into them.
template <class Number>
std::span<std::byte> Machine<Number>::bytesOf(const Pointer<Number>& p, uint64_t& offset, uint64_t size) {
    if (!p.isPhysical) return resources_.buffer(p.kind, p.descriptor);
    const uint64_t address = offset;
    offset = 0;
    return resources_.memory(address, size);
}

template <class Number>
Scalars<Number> Machine<Number>::loadTexel(const Pointer<Number>& p) {
    const Texel<Number> texel = resources_.fetch(*p.texel);
    return {texel[0]};
}

template <class Number>
bool Machine<Number>::comparePointers(const Instruction& i) {
    const Pointer<Number> a = pointer(i.operand(0)), b = pointer(i.operand(1));
    const bool same = a.object == b.object && a.offset == b.offset && a.outside == b.outside &&
                      a.isBuffer == b.isBuffer && a.kind == b.kind && a.descriptor == b.descriptor;
    if (i.op != spv::OpPtrDiff) {
        setResult(i, Scalar<Number>::ofBits(same == (i.op == spv::OpPtrEqual) ? 1 : 0));
        return true;
    }
    const Type& pointerType = module_.valueType(i.operand(0));
    const auto stride = static_cast<int64_t>(a.isBuffer ? module_.decorationsOf(pointerType.id).arrayStride.value_or(0)
                                                        : module_.types[a.type].scalars);
    const int64_t bytes = static_cast<int64_t>(a.offset) - static_cast<int64_t>(b.offset);
    setResult(i, Scalar<Number>::ofBits(static_cast<uint64_t>(stride != 0 ? bytes / stride : 0) &
                                        widthMask(resultType(i).width)));
    return true;
}

template <class Number>
const Pointer<Number>& Machine<Number>::pointer(Id id) {
    const IdInfo& info = module_.info(id);
    if (info.kind == IdKind::variable) {
        auto& known = variables_[info.index];
        if (!known) known = variablePointer(module_.variables[info.index]);
        return *known;
    }
    const Value<Number>& v = value(id);
    if (!v.pointer) fail(name(id) + " is no pointer");
    return *v.pointer;
}

template <class Number>
Pointer<Number> Machine<Number>::index(Pointer<Number> p, Id indexId) const {
    const Type& type = module_.types[p.type];
    const int64_t i = signedInteger(indexId);
    if (p.atDescriptors) {
        // Arrays of arrays: one number, the last index changing fastest.
        p.descriptor.arrayIndex = p.descriptor.arrayIndex * type.count + static_cast<uint32_t>(i);
        p.type = type.element;
        p.atDescriptors = module_.types[p.type].isArray();
        return p;
    }
    // Moves by i * stride bytes; what ends outside all buffers stays outside.
    const auto move = [&p, i](uint64_t stride) {
        __extension__ using Wide = __int128;
        const Wide offset = Wide(i) * static_cast<int64_t>(stride) + static_cast<int64_t>(p.offset);
        p.outside = p.outside || i < 0 || offset > kMaxOffset;
        p.offset = p.outside ? 0 : static_cast<uint64_t>(offset);
    };
    if (type.kind == TypeKind::structure) {
        if (i < 0 || static_cast<uint64_t>(i) >= type.members.size())
            fail("index " + std::to_string(i) + " into struct " + name(type.id) + " is out of range");
        const auto member = static_cast<uint32_t>(i);
        p.type = type.members[member];
        if (p.isBuffer) {
            const Decorations& d = module_.decorationsOf(type.id, member);
            p.offset += d.offset.value_or(0);
            p.matrix = {d.matrixStride.value_or(0), d.rowMajor};
        } else {
            p.offset += type.cellOffsets[member];
        }
        return p;
    }
    if (!type.isArray() && type.kind != TypeKind::matrix && type.kind != TypeKind::vector)
        fail("an access chain goes into type " + name(type.id) + ", which has no parts");
    const Type& element = module_.types[type.element];
    p.type = type.element;
    if (!p.isBuffer) {
        p.outside = p.outside || i < 0 || i >= static_cast<int64_t>(type.count);
        if (!p.outside) p.offset += static_cast<uint64_t>(i) * element.scalars;
        return p;
    }
    const uint64_t scalarBytes = module_.scalarType(type).width / 8;
    switch (type.kind) {
        case TypeKind::matrix:
            move(p.matrix.rowMajor ? scalarBytes : p.matrix.stride);
            p.componentStride = p.matrix.rowMajor ? p.matrix.stride : 0;
            break;
        case TypeKind::vector:
            move(p.componentStride != 0 ? p.componentStride : scalarBytes);
            p.componentStride = 0;
            break;
        default:
            move(module_.decorationsOf(type.id).arrayStride.value_or(0));
            break;
    }
    return p;
}

/// Calls visit(scalar type, byte offset) for the scalars of `type` in flattened order.
template <class Number>
template <class Visit>
void Machine<Number>::forEachScalar(const Type& type, uint64_t offset, MatrixLayout matrix, uint32_t componentStride,
                                    const Visit& visit) const {
    switch (type.kind) {
        case TypeKind::vector: {
            const Type& scalar = module_.types[type.element];
            const uint64_t stride = componentStride != 0 ? componentStride : scalar.width / 8;
            for (uint64_t c = 0; c < type.count; ++c) visit(scalar, offset + c * stride);
            break;
        }
        case TypeKind::matrix: {
            const uint64_t step = matrix.rowMajor ? module_.scalarType(type).width / 8 : matrix.stride;
            for (uint64_t c = 0; c < type.count; ++c)
                forEachScalar(module_.types[type.element], offset + c * step, matrix,
                              matrix.rowMajor ? matrix.stride : 0, visit);
            break;
        }
        case TypeKind::array: {
            const uint64_t stride = module_.decorationsOf(type.id).arrayStride.value_or(0);
            for (uint64_t e = 0; e < type.count; ++e)
                forEachScalar(module_.types[type.element], offset + e * stride, matrix, 0, visit);
            break;
        }
        case TypeKind::structure:
            for (uint32_t m = 0; m < type.members.size(); ++m) {
                const Decorations& d = module_.decorationsOf(type.id, m);
                forEachScalar(module_.types[type.members[m]], offset + d.offset.value_or(0),
                              {d.matrixStride.value_or(0), d.rowMajor}, 0, visit);
            }
            break;
        case TypeKind::integer:
        case TypeKind::floating:
        case TypeKind::pointer:
            visit(type, offset);
            break;
        default:
            fail("type " + name(type.id) + " cannot be in a buffer");
    }
}

template <class Number>
BufferAccess Machine<Number>::accessOf(const Pointer<Number>& p, const Type& scalar, uint64_t offset) const {
    return {p.descriptor, offset, scalar.width / 8, scalar.kind == TypeKind::floating, scalar.isSigned, invocation_};
}

template <class Number>
Scalars<Number> Machine<Number>::loadScalars(const Pointer<Number>& p) {
    const Type& type = module_.types[p.type];
    const uint64_t count = module_.valueScalars(type);
    charge(count / kScalarsPerStep);
    Scalars<Number> result;
    if (p.outside) {
        result.resize(count);
    } else if (p.object) {
        if (p.offset > p.object->cells.size() || count > p.object->cells.size() - p.offset)
            fail("a pointer does not fit its variable");
        const auto begin = p.object->cells.begin() + static_cast<ptrdiff_t>(p.offset);
        result.assign(begin, begin + static_cast<ptrdiff_t>(count));
    } else if (p.isBuffer && !p.atDescriptors) {
        const bool told = p.kind == BufferKind::storage && !p.isPhysical && !combining_;
        forEachScalar(type, p.offset, p.matrix, p.componentStride, [&](const Type& scalar, uint64_t offset) {
            if (told) resources_.loaded(accessOf(p, scalar, offset));
            const std::span<const std::byte> bytes = bytesOf(p, offset, scalar.width / 8);
            result.push_back(readScalar<Number>(bytes, offset, scalar));
        });
    } else if (p.texel) {
        result = loadTexel(p);
    } else {
        fail("a load through a pointer to type " + name(type.id));
    }
    return result;
}

template <class Number>
Value<Number> Machine<Number>::load(const Pointer<Number>& p) {
    Value<Number> result;
    const Type& type = module_.types[p.type];
    if (!type.isOpaque()) {
        result.scalars = loadScalars(p);
    } else if (p.object || p.isBuffer || p.atDescriptors) {
        fail("a load of type " + name(type.id) + " that is not in UniformConstant");
    } else {
        result.image =
            ImageHandle{type.kind == TypeKind::sampledImage ? type.element : p.type, p.descriptor, p.descriptor};
    }
    return result;
}

template <class Number>
void Machine<Number>::store(const Pointer<Number>& p, const Scalars<Number>& scalars) {
    const Type& type = module_.types[p.type];
    const uint64_t count = module_.valueScalars(type);
    charge(count / kScalarsPerStep);
    if (scalars.size() != count) fail("a stored value does not fit type " + name(type.id));
    if (p.outside) return;
    if (p.object) {
        if (p.offset > p.object->cells.size() || count > p.object->cells.size() - p.offset)
            fail("a pointer does not fit its variable");
        for (size_t k = 0; k < count; ++k) {
            p.object->cells[p.offset + k] = scalars[k];
            p.object->written[p.offset + k] = true;
        }
        return;
    }
    if (p.texel) {
        Texel<Number> texel{};
        texel[0] = scalars[0];
        if (!helper_) resources_.write(*p.texel, texel);
        return;
    }
    if (!p.isBuffer || p.kind != BufferKind::storage || p.atDescriptors)
        fail("a store to type " + name(type.id) + " in read-only memory");
    if (helper_) return;
    size_t next = 0;
    const bool told = !p.isPhysical && !combining_;
    forEachScalar(type, p.offset, p.matrix, p.componentStride, [&](const Type& scalar, uint64_t offset) {
        if (told) resources_.stored(accessOf(p, scalar, offset), scalars[next]);
        const std::span<std::byte> bytes = bytesOf(p, offset, scalar.width / 8);
        writeScalar(bytes, offset, scalar, scalars[next++]);
    });
}

template <class Number>
uint64_t Machine<Number>::arrayLength(const Instruction& i) {
    const Pointer<Number>& p = pointer(i.operand(0));
    const Type& type = module_.types[p.type];
    const uint32_t member = i.operand(1);
    if (!p.isBuffer || p.atDescriptors || type.kind != TypeKind::structure || member >= type.members.size())
        fail("OpArrayLength of type " + name(type.id));
    const Type& array = module_.types[type.members[member]];
    const uint64_t stride = module_.decorationsOf(array.id).arrayStride.value_or(0);
    if (array.kind != TypeKind::runtimeArray || stride == 0) fail("OpArrayLength of type " + name(array.id));
    const uint64_t first = p.offset + module_.decorationsOf(type.id, member).offset.value_or(0);
    const uint64_t size = resources_.buffer(p.kind, p.descriptor).size();
    return p.outside || size < first ? 0 : (size - first) / stride;
}

template <class Number>
bool Machine<Number>::executeMemory(const Instruction& i) {
    switch (i.op) {
        case spv::OpVariable: {
            Variable variable;
            variable.id = i.result;
            variable.pointerType = module_.typeIndex(i.type);
            variable.storage = enumerant<spv::StorageClass>(i.operand(0));
            if (i.operands.size() > 1) variable.initializer = i.operands[1];
            if (variable.storage != spv::StorageClassFunction ||
                module_.types[variable.pointerType].kind != TypeKind::pointer)
                fail("variable " + name(i.result) + " in a function has another storage class");
            Value<Number> v;
            v.pointer = variablePointer(variable);
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpLoad: {
            Value<Number> v = load(pointer(i.operand(0)));
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpStore:
            store(pointer(i.operand(0)), data(i.operand(1)));
            return true;
        case spv::OpCopyMemory: {
            const Scalars<Number> scalars = loadScalars(pointer(i.operand(1)));
            store(pointer(i.operand(0)), scalars);
            return true;
        }
        case spv::OpAccessChain:
        case spv::OpInBoundsAccessChain: {
            Pointer<Number> p = pointer(i.operand(0));
            for (const Id id : i.operands.subspan(1)) p = index(std::move(p), id);
            Value<Number> v;
            v.pointer = std::move(p);
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpPtrAccessChain:
        case spv::OpInBoundsPtrAccessChain: {
            Pointer<Number> p = element(pointer(i.operand(0)), module_.valueType(i.operand(0)), i.operand(1));
            for (const Id id : i.operands.subspan(2)) p = index(std::move(p), id);
            Value<Number> v;
            v.pointer = std::move(p);
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpPtrEqual:
        case spv::OpPtrNotEqual:
        case spv::OpPtrDiff:
            return comparePointers(i);
        case spv::OpImageTexelPointer: {
            const Value<Number> image = load(pointer(i.operand(0)));
            if (!image.image) fail("OpImageTexelPointer of no image");
            auto r = std::make_shared<ImageRequest<Number>>(request(*image.image));
            const Scalars<Number>& coordinates = data(i.operand(1));
            for (size_t k = 0; k < coordinates.size() && k < 4; ++k)
                r->texel[k] = static_cast<int32_t>(static_cast<uint32_t>(coordinates[k].bits));
            r->sample = static_cast<int32_t>(signedInteger(i.operand(2)));
            r->lodMode = LodMode::explicitLod;
            Value<Number> v;
            v.pointer.emplace();
            v.pointer->type = resultType(i).element;
            v.pointer->texel = std::move(r);
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpArrayLength:
            setResult(i, Scalar<Number>::ofBits(arrayLength(i) & 0xFFFFFFFFu));
            return true;
        default:
            return false;
    }
}

#define VERNIER_INSTANTIATE(Number)                                                                       \
    template Pointer<Number> Machine<Number>::variablePointer(const Variable&);                           \
    template Scalar<Number> Machine<Number>::pointerScalar(const Pointer<Number>&) const;                 \
    template Pointer<Number> Machine<Number>::scalarPointer(const Type&, uint64_t) const;                 \
    template const Pointer<Number>& Machine<Number>::pointer(Id);                                         \
    template BufferAccess Machine<Number>::accessOf(const Pointer<Number>&, const Type&, uint64_t) const; \
    template Scalars<Number> Machine<Number>::loadScalars(const Pointer<Number>&);                        \
    template void Machine<Number>::store(const Pointer<Number>&, const Scalars<Number>&);                 \
    template bool Machine<Number>::executeMemory(const Instruction&);
VERNIER_INSTANTIATE(float)
VERNIER_INSTANTIATE(double)
VERNIER_INSTANTIATE(Real)

}  // namespace vernier::reference
