// Variables, and the inputs and outputs of the stage.
#include <algorithm>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/front/spelling.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/tessellation.h"

namespace vernier {
namespace {

struct BuiltinEntry {
    spv::BuiltIn spirv;
    ir::Builtin builtin;
    ir::Stage stage;
    bool input;
};

constexpr auto kVertex = ir::Stage::vertex;
constexpr auto kFragment = ir::Stage::fragment;
constexpr auto kControl = ir::Stage::control;
constexpr auto kEvaluation = ir::Stage::evaluation;
constexpr auto kGeometry = ir::Stage::geometry;

constexpr BuiltinEntry kBuiltins[] = {
    {spv::BuiltIn::VertexIndex, ir::Builtin::vertexIndex, kVertex, true},
    {spv::BuiltIn::InstanceIndex, ir::Builtin::instanceIndex, kVertex, true},
    {spv::BuiltIn::BaseVertex, ir::Builtin::baseVertex, kVertex, true},
    {spv::BuiltIn::BaseInstance, ir::Builtin::baseInstance, kVertex, true},
    {spv::BuiltIn::DrawIndex, ir::Builtin::drawIndex, kVertex, true},
    {spv::BuiltIn::ViewIndex, ir::Builtin::viewIndex, kVertex, true},
    {spv::BuiltIn::ViewIndex, ir::Builtin::viewIndex, kFragment, true},
    {spv::BuiltIn::Position, ir::Builtin::position, kVertex, false},
    {spv::BuiltIn::PointSize, ir::Builtin::pointSize, kVertex, false},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kVertex, false},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kVertex, false},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kFragment, true},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kFragment, true},
    {spv::BuiltIn::Layer, ir::Builtin::layer, kVertex, false},
    {spv::BuiltIn::Layer, ir::Builtin::layer, kFragment, true},
    {spv::BuiltIn::ViewportIndex, ir::Builtin::viewportIndex, kVertex, false},
    {spv::BuiltIn::ViewportIndex, ir::Builtin::viewportIndex, kFragment, true},
    {spv::BuiltIn::FragCoord, ir::Builtin::fragCoord, kFragment, true},
    {spv::BuiltIn::FrontFacing, ir::Builtin::frontFacing, kFragment, true},
    {spv::BuiltIn::PointCoord, ir::Builtin::pointCoord, kFragment, true},
    {spv::BuiltIn::SampleId, ir::Builtin::sampleId, kFragment, true},
    {spv::BuiltIn::SamplePosition, ir::Builtin::samplePosition, kFragment, true},
    {spv::BuiltIn::SampleMask, ir::Builtin::sampleMaskIn, kFragment, true},
    {spv::BuiltIn::PrimitiveId, ir::Builtin::primitiveId, kFragment, true},
    {spv::BuiltIn::BaryCoordKHR, ir::Builtin::baryCoord, kFragment, true},
    {spv::BuiltIn::BaryCoordNoPerspKHR, ir::Builtin::baryCoordNoPersp, kFragment, true},
    {spv::BuiltIn::Position, ir::Builtin::position, kGeometry, true},
    {spv::BuiltIn::PointSize, ir::Builtin::pointSize, kGeometry, true},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kGeometry, true},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kGeometry, true},
    {spv::BuiltIn::PrimitiveId, ir::Builtin::primitiveId, kGeometry, true},
    {spv::BuiltIn::InvocationId, ir::Builtin::invocationId, kGeometry, true},
    {spv::BuiltIn::ViewIndex, ir::Builtin::viewIndex, kGeometry, true},
    {spv::BuiltIn::Position, ir::Builtin::position, kGeometry, false},
    {spv::BuiltIn::PointSize, ir::Builtin::pointSize, kGeometry, false},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kGeometry, false},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kGeometry, false},
    {spv::BuiltIn::PrimitiveId, ir::Builtin::primitiveId, kGeometry, false},
    {spv::BuiltIn::Layer, ir::Builtin::layer, kGeometry, false},
    {spv::BuiltIn::ViewportIndex, ir::Builtin::viewportIndex, kGeometry, false},
    {spv::BuiltIn::Position, ir::Builtin::position, kControl, true},
    {spv::BuiltIn::PointSize, ir::Builtin::pointSize, kControl, true},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kControl, true},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kControl, true},
    {spv::BuiltIn::PrimitiveId, ir::Builtin::primitiveId, kControl, true},
    {spv::BuiltIn::InvocationId, ir::Builtin::invocationId, kControl, true},
    {spv::BuiltIn::PatchVertices, ir::Builtin::patchVertices, kControl, true},
    {spv::BuiltIn::ViewIndex, ir::Builtin::viewIndex, kControl, true},
    {spv::BuiltIn::Position, ir::Builtin::position, kControl, false},
    {spv::BuiltIn::PointSize, ir::Builtin::pointSize, kControl, false},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kControl, false},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kControl, false},
    {spv::BuiltIn::TessLevelOuter, ir::Builtin::tessLevelOuter, kControl, false},
    {spv::BuiltIn::TessLevelInner, ir::Builtin::tessLevelInner, kControl, false},
    {spv::BuiltIn::Position, ir::Builtin::position, kEvaluation, true},
    {spv::BuiltIn::PointSize, ir::Builtin::pointSize, kEvaluation, true},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kEvaluation, true},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kEvaluation, true},
    {spv::BuiltIn::PrimitiveId, ir::Builtin::primitiveId, kEvaluation, true},
    {spv::BuiltIn::PatchVertices, ir::Builtin::patchVertices, kEvaluation, true},
    {spv::BuiltIn::TessCoord, ir::Builtin::tessCoord, kEvaluation, true},
    {spv::BuiltIn::TessLevelOuter, ir::Builtin::tessLevelOuter, kEvaluation, true},
    {spv::BuiltIn::TessLevelInner, ir::Builtin::tessLevelInner, kEvaluation, true},
    {spv::BuiltIn::ViewIndex, ir::Builtin::viewIndex, kEvaluation, true},
    {spv::BuiltIn::Position, ir::Builtin::position, kEvaluation, false},
    {spv::BuiltIn::PointSize, ir::Builtin::pointSize, kEvaluation, false},
    {spv::BuiltIn::ClipDistance, ir::Builtin::clipDistance, kEvaluation, false},
    {spv::BuiltIn::CullDistance, ir::Builtin::cullDistance, kEvaluation, false},
    {spv::BuiltIn::Layer, ir::Builtin::layer, kEvaluation, false},
    {spv::BuiltIn::ViewportIndex, ir::Builtin::viewportIndex, kEvaluation, false},
    {spv::BuiltIn::FragDepth, ir::Builtin::fragDepth, kFragment, false},
    {spv::BuiltIn::SampleMask, ir::Builtin::sampleMask, kFragment, false},
    {spv::BuiltIn::FragStencilRefEXT, ir::Builtin::fragStencilRef, kFragment, false},
};

constexpr uint32_t kMaxLocalWords = 1u << 16;

/// The decoration is the variable's or that of the members of blocks in an array.
bool isDecorated(const Module& module, uint32_t variable, const SpirvType& type, spv::Decoration decoration) {
    return module.hasDecoration(variable, decoration) ||
           (type.kind == SpirvType::Kind::array && module.findDecoration(type.element, decoration, 0) != nullptr);
}

}  // namespace

void Lowering::lowerVariable(const Instruction& inst) {
    const uint32_t id = inst[2];
    const SpirvType& pointerType = typeInfo(inst[1]);
    const SpirvType& type = typeInfo(pointerType.element);
    Pointer pointer;
    pointer.type = pointerType.element;
    switch (pointerType.storage) {
        case spv::StorageClass::Input:
        case spv::StorageClass::Output:
            if (std::find(interface_.begin(), interface_.end(), id) == interface_.end()) return;
            if (isComputedBuiltin(id)) {
                pointer.base = Pointer::Base::builtin;
                pointer.root = module_.findDecoration(id, spv::Decoration::BuiltIn)->value;
                break;
            }
            lowerStageVariable(inst, pointerType.storage == spv::StorageClass::Input);
            return;
        case spv::StorageClass::Function:
        case spv::StorageClass::Private:
            if (type.kind == SpirvType::Kind::pointer && type.leaves == 0) {
                refuse(inst, "variables that hold pointers are only supported for pointers into storage buffers");
            }
            if (type.isOpaque()) refuse(inst, "variables that hold images or samplers are not supported");
            if (indexing_[id] == Indexing::memory) {
                pointer.base = Pointer::Base::local;
                pointer.extent = type.words;
                if (localOfId_[id] == ir::kNoIndex) {
                    if (type.words > kMaxLocalWords - program_.localWords) {
                        refuse(inst, "variables indexed at run time take more than " +
                                         std::to_string(kMaxLocalWords * 4) + " bytes");
                    }
                    localOfId_[id] = program_.localWords;
                    program_.localWords += type.words;
                }
                pointer.root = localOfId_[id];
            } else {
                pointer.root = emitter_.newVariables(static_cast<uint32_t>(leafTypes(pointer.type).size()));
            }
            initialise(inst, pointer);
            break;
        case spv::StorageClass::Uniform:
        case spv::StorageClass::StorageBuffer:
        case spv::StorageClass::PushConstant:
            pointer.base = Pointer::Base::buffer;
            pointer.root = id;
            pointer.descriptorArray = type.kind == SpirvType::Kind::array || type.kind == SpirvType::Kind::runtimeArray;
            break;
        case spv::StorageClass::Workgroup:
            // Always zero at first: an initialiser, which can only be OpConstantNull, asks for nothing more.
            pointer.base = Pointer::Base::buffer;
            pointer.root = id;
            pointer.wordLayout = !module_.hasDecoration(pointer.type, spv::Decoration::Block);
            break;
        case spv::StorageClass::UniformConstant:
            pointer.base = Pointer::Base::handle;
            pointer.root = id;
            pointer.descriptorArray = type.kind == SpirvType::Kind::array || type.kind == SpirvType::Kind::runtimeArray;
            break;
        default:
            refuse(inst, "storage class " + nameOf(pointerType.storage) + " is not supported");
    }
    setPointer(id, pointer);
}

/// The value a variable begins with. SSA variables without one are undefined from here on: a second pass through an
/// inlined function does not see the first one's values.
void Lowering::initialise(const Instruction& inst, const Pointer& pointer) {
    if (inst.count > 4) {
        store(pointer, leavesOf(inst[4]));
    } else if (pointer.base == Pointer::Base::ssa) {
        store(pointer, undefOf(pointer.type));
    }
}

void Lowering::lowerStageVariable(const Instruction& inst, bool input) {
    if (!input && program_.stage == ir::Stage::control) return lowerPatchOutput(inst);
    const uint32_t id = inst[2];
    Pointer pointer;
    pointer.type = typeInfo(inst[1]).element;
    std::vector<ir::InterfaceSlot>& slots = input ? program_.inputs : program_.outputs;
    const auto first = static_cast<uint32_t>(slots.size());
    ir::InterfaceSlot slot;
    SlotCursor at;
    const SlotPlace place{id, 0, Decoration::kNoMember, input};
    decorateSlot(place, slot, at);
    leafTypes(pointer.type);  // refuses what is too large
    if (input && isNumberedByVertex(id, typeInfo(pointer.type))) {
        const SpirvType& type = typeInfo(pointer.type);
        if (program_.stage == kFragment) slot.interpolation = ir::Interpolation::flat;
        for (uint32_t vertex = 0; vertex < type.count; ++vertex) {
            slot.index = static_cast<uint8_t>(vertex + 1);
            SlotCursor ofVertex = at;
            appendSlots(type.element, place, slot, ofVertex, slots);
        }
    } else {
        appendSlots(pointer.type, place, slot, at, slots);
    }
    if (input) {
        pointer.base = Pointer::Base::input;
        pointer.root = first;
        pointer.extent = static_cast<uint32_t>(slots.size()) - first;
    } else if (indexing_[id] == Indexing::memory) {
        pointer.base = Pointer::Base::local;
        pointer.extent = static_cast<uint32_t>(slots.size()) - first;
        pointer.root = program_.localWords;
        program_.localWords += pointer.extent;
        initialise(inst, pointer);
        outputs_.push_back({pointer, first});
    } else {
        pointer.root = emitter_.newVariables(static_cast<uint32_t>(leafTypes(pointer.type).size()));
        initialise(inst, pointer);
        outputs_.push_back({pointer, first});
    }
    setPointer(id, pointer);
}

/// Whether the first index of an input, or of an output of a control stage, is the number of a vertex, and takes no
/// locations.
bool Lowering::isNumberedByVertex(uint32_t variable, const SpirvType& type) const {
    const bool isArray = type.kind == SpirvType::Kind::array;
    uint32_t most = kMaxPatchVertices;
    switch (program_.stage) {
        case kFragment:  // SPV_KHR_fragment_shader_barycentric
            if (!isDecorated(module_, variable, type, spv::Decoration::PerVertexKHR)) return false;
            most = isArray ? 3 : 0;
            break;
        case kGeometry:
        case kControl:
        case kEvaluation:
            if (!isArray || isDecorated(module_, variable, type, spv::Decoration::Patch)) return false;
            break;
        default:
            return false;
    }
    if (type.count > most || !isArray)
        refuseId(variable, "has values of vertices, but is no array of up to " + std::to_string(most));
    return true;
}

ir::Builtin Lowering::builtinOf(const SlotPlace& place, uint32_t builtin) const {
    for (const BuiltinEntry& entry : kBuiltins) {
        if (static_cast<uint32_t>(entry.spirv) == builtin && entry.stage == program_.stage &&
            entry.input == place.input) {
            return entry.builtin;
        }
    }
    refuseId(place.variable, "is the built-in " + nameOf(static_cast<spv::BuiltIn>(builtin)) +
                                 ", which is not supported in this stage");
}

void Lowering::decorateSlot(const SlotPlace& place, ir::InterfaceSlot& slot, SlotCursor& at) const {
    const uint32_t id = place.member == Decoration::kNoMember ? place.variable : place.structure;
    const auto find = [&](spv::Decoration kind) { return module_.findDecoration(id, kind, place.member); };
    if (const Decoration* d = find(spv::Decoration::BuiltIn)) {
        at.location = at.component = 0;
        slot.builtin = builtinOf(place, d->value);
        if (slot.builtin == ir::Builtin::baryCoordNoPersp) slot.interpolation = ir::Interpolation::noPerspective;
    }
    if (const Decoration* d = find(spv::Decoration::XfbBuffer)) at.buffer = d->value;
    if (const Decoration* d = find(spv::Decoration::XfbStride)) at.stride = d->value;
    if (const Decoration* d = find(spv::Decoration::Offset)) {
        at.offset = d->value;
        at.captured = true;
    }
    if (const Decoration* d = find(spv::Decoration::Stream); d != nullptr && d->value != 0) {
        if (d->value >= (program_.stage == kGeometry ? ir::kVertexStreams : 1)) {
            refuseId(place.variable, "goes to vertex stream " + std::to_string(d->value) + ", which there is not");
        }
        slot.index = static_cast<uint8_t>(d->value);
    }
    if (const Decoration* d = find(spv::Decoration::Location)) {
        at.location = d->value;
        at.component = 0;
        slot.component = 0;
    }
    if (const Decoration* d = find(spv::Decoration::Component)) slot.component = static_cast<uint8_t>(d->value & 3);
    if (const Decoration* d = find(spv::Decoration::Index)) slot.index = static_cast<uint8_t>(d->value);
    if (find(spv::Decoration::Flat) != nullptr) slot.interpolation = ir::Interpolation::flat;
    if (find(spv::Decoration::NoPerspective) != nullptr) slot.interpolation = ir::Interpolation::noPerspective;
    if (find(spv::Decoration::Centroid) != nullptr) slot.sampling = ir::Sampling::centroid;
    if (find(spv::Decoration::Sample) != nullptr) slot.sampling = ir::Sampling::sample;
    if (find(spv::Decoration::PerPrimitiveNV) != nullptr)
        refuseId(place.variable, "has a decoration that is not supported (PerPrimitive)");
}

// Locations: "Location Assignment" in the chapter "Shader Interfaces" of the Vulkan specification. A scalar or vector
// takes one location (a 64-bit vector of three or four components two), matrices one per column, arrays one per
// element.
void Lowering::appendSlots(uint32_t typeId, const SlotPlace& place, ir::InterfaceSlot slot, SlotCursor& at,
                           std::vector<ir::InterfaceSlot>& slots) {
    const SpirvType& type = typeInfo(typeId);
    switch (type.kind) {
        case SpirvType::Kind::matrix:
        case SpirvType::Kind::array:
            for (uint32_t i = 0; i < type.count; ++i) {
                appendSlots(type.element, place, slot, at, slots);
                // Blocks of an array go to buffers that follow each other.
                if (at.buffer != SlotCursor::kNoBuffer && module_.hasDecoration(type.element, spv::Decoration::Block))
                    ++at.buffer;
            }
            return;
        case SpirvType::Kind::structure:
            for (uint32_t member = 0; member < type.members.size(); ++member) {
                const SlotPlace inner{place.variable, typeId, member, place.input};
                ir::InterfaceSlot memberSlot = slot;
                SlotCursor memberAt = at;
                decorateSlot(inner, memberSlot, memberAt);
                appendSlots(type.members[member], inner, memberSlot, memberAt, slots);
                if (memberSlot.builtin == ir::Builtin::user) {
                    at.location = memberAt.location;
                    at.component = memberAt.component;
                }
                // What has one Offset as a whole: its members follow each other.
                if (at.captured) at.offset = memberAt.offset;
            }
            return;
        case SpirvType::Kind::vector:
        case SpirvType::Kind::boolean:
        case SpirvType::Kind::integer:
        case SpirvType::Kind::floating:
            break;
        default:
            refuseId(place.variable, "has a type that cannot be an input or output");
    }
    const bool wide = ir::isWide(type.scalar);
    const uint32_t firstComponent = slot.component;
    if (slot.builtin == ir::Builtin::user) at.component = firstComponent;
    slot.type = wide ? ir::Type::i32 : type.scalar.type;
    if (slot.type == ir::Type::i32 && place.input && program_.stage == ir::Stage::fragment) {
        slot.interpolation = ir::Interpolation::flat;
    }
    const size_t first = slots.size();
    for (uint32_t word = 0; word < type.words; ++word) {
        if (slot.builtin == ir::Builtin::user && at.component == 4) {
            ++at.location;
            at.component = 0;
        }
        if (at.location > 0xFFFF || at.component > 0xFF) refuseId(place.variable, "has a location that is too large");
        slot.location = static_cast<uint16_t>(at.location);
        slot.component = static_cast<uint8_t>(at.component++);
        slots.push_back(slot);
    }
    if (slot.builtin == ir::Builtin::user) {
        ++at.location;
        at.component = 0;
    }
    if (at.captured && at.buffer != SlotCursor::kNoBuffer && !place.input) {
        captureScalar(place, type.scalar, std::span(slots).subspan(first), at);
    }
}

/// Transform feedback of a scalar or vector. "Components are tightly packed", those of 64 bits aligned to their size.
void Lowering::captureScalar(const SlotPlace& place, const LeafType& scalar, std::span<const ir::InterfaceSlot> slots,
                             SlotCursor& at) {
    if (scalar.bits < 32) refuseId(place.variable, "is captured, but has components of less than 32 bits");
    if (at.buffer >= kCaptureBuffers) {
        refuseId(place.variable, "is captured into buffer " + std::to_string(at.buffer) + "; there are " +
                                     std::to_string(kCaptureBuffers));
    }
    const uint32_t bytes = scalar.bytes();
    at.offset = (at.offset + bytes - 1) / bytes * bytes;
    const uint64_t end = at.offset + 4 * slots.size();
    uint32_t& stride = capture_.strides[at.buffer];
    if (end > at.stride || at.stride % 4 != 0 || (stride != 0 && stride != at.stride)) {
        refuseId(place.variable, "is captured with a stride of " + std::to_string(at.stride) +
                                     " bytes, which is no multiple of 4, not that of other outputs, or ends before it");
    }
    stride = at.stride;
    for (const ir::InterfaceSlot& slot : slots) {
        capture_.words.push_back({slot, at.buffer, static_cast<uint32_t>(at.offset)});
        at.offset += 4;
    }
}

/// Calls visit(slot, value) for every word of the outputs; kNoValue: it has not been given a value.
template <class Visit>
void Lowering::visitOutputs(const Visit& visit) {
    for (const Output& output : outputs_) {
        uint32_t slot = output.firstSlot;
        const LeafTypes types = leafTypes(output.pointer.type);
        const Leaves leaves = load(output.pointer);
        for (size_t i = 0; i < leaves.size(); ++i) {
            const ir::ValueId leaf = types[i].isSigned ? signExtended(leaves[i], types[i]) : leaves[i];
            const bool wide = ir::isWide(emitter_.typeOf(leaf));
            const bool written = !emitter_.isUndef(leaves[i]);
            for (uint32_t word = 0; word < (wide ? 2u : 1u); ++word, ++slot) {
                if (!written) {
                    visit(slot, ir::kNoValue);
                    continue;
                }
                visit(slot, wide ? emitter_.emit(word == 0 ? ir::Op::lowWord : ir::Op::highWord, ir::Type::i32, {leaf})
                                 : leaf);
            }
        }
    }
}

void Lowering::storeOutputs() {
    visitOutputs([this](uint32_t slot, ir::ValueId value) {
        if (value != ir::kNoValue) emitter_.emit(ir::Op::storeOutput, ir::Type::none, {value}, slot);
    });
}

/// The outputs that belong to the stream, as they are now. One that has no value here may have one at another vertex.
void Lowering::storeVertex(ir::ValueId vertex, uint32_t stream) {
    visitOutputs([&](uint32_t slot, ir::ValueId value) {
        const ir::InterfaceSlot& output = program_.outputs[slot];
        if (output.index != stream) return;
        if (value == ir::kNoValue) value = emitter_.undef(output.type);
        emitter_.emit(ir::Op::storeVertex, ir::Type::none, {vertex, value}, slot);
    });
}

}  // namespace vernier
