// Tessellation stages: their modes, and the outputs of control, which the invocations of a patch share and read. These
// lie in memory of the runner, a row of words for each patch; Program::outputs tells what every word is, vertex by
// vertex (InterfaceSlot::index) where an output has a value for each.
#include "spirv_interp/front/lowering.h"
#include "spirv_interp/tessellation.h"

namespace vernier {

namespace {

/// Words of a patch: those of maxTessellationControlTotalOutputComponents, and room for built-in ones.
constexpr uint32_t kMaxPatchWords = 8192;

/// False: it is no mode of tessellation stages.
bool readMode(const Instruction& mode, TessellationModes& modes) {
    switch (static_cast<spv::ExecutionMode>(mode[2])) {
        case spv::ExecutionMode::Triangles:
            modes.domain = TessellationDomain::triangles;
            return true;
        case spv::ExecutionMode::Quads:
            modes.domain = TessellationDomain::quads;
            return true;
        case spv::ExecutionMode::Isolines:
            modes.domain = TessellationDomain::isolines;
            return true;
        case spv::ExecutionMode::SpacingEqual:
            modes.spacing = TessellationSpacing::equal;
            return true;
        case spv::ExecutionMode::SpacingFractionalEven:
            modes.spacing = TessellationSpacing::fractionalEven;
            return true;
        case spv::ExecutionMode::SpacingFractionalOdd:
            modes.spacing = TessellationSpacing::fractionalOdd;
            return true;
        case spv::ExecutionMode::VertexOrderCw:
            modes.order = TessellationOrder::clockwise;
            return true;
        case spv::ExecutionMode::VertexOrderCcw:
            modes.order = TessellationOrder::counterClockwise;
            return true;
        case spv::ExecutionMode::PointMode:
            modes.pointMode = true;
            return true;
        case spv::ExecutionMode::OutputVertices:
            modes.outputVertices = mode[3];
            return true;
        default:
            return false;
    }
}

}  // namespace

Result<TessellationModes> tessellationModes(const ShaderSource& source) {
    const Result<Module> module = Module::read(source.module != nullptr ? source.module->words() : source.words);
    if (!module) return module.error();
    TessellationModes modes;
    for (const EntryPoint& entry : module->entryPoints()) {
        if (entry.name != source.entryPoint || entry.model != modelOf(source.stage)) continue;
        for (uint32_t offset : module->executionModes()) {
            const Instruction inst = module->next(offset);
            if (inst[1] == entry.function) readMode(inst, modes);
        }
    }
    return modes;
}

/// The number of a control stage's invocations is its work-group size. False: it is no mode of tessellation stages.
bool Lowering::lowerTessellationMode(const Instruction& mode) {
    if (program_.stage != ir::Stage::control && program_.stage != ir::Stage::evaluation) return false;
    TessellationModes modes;
    if (!readMode(mode, modes)) return false;
    if (modes.outputVertices != 0) patchVertices_ = modes.outputVertices;
    return true;
}

void Lowering::lowerPatchOutput(const Instruction& inst) {
    const uint32_t id = inst[2];
    if (patchResource_ == ir::kNoIndex) {
        patchResource_ = static_cast<uint32_t>(program_.resources.size());
        program_.resources.emplace_back().kind = ir::ResourceKind::stageMemory;
    }
    Pointer pointer;
    pointer.base = Pointer::Base::stage;
    pointer.type = typeInfo(inst[1]).element;
    pointer.root = static_cast<uint32_t>(program_.outputs.size());
    leafTypes(pointer.type);  // refuses what is too large
    const SpirvType& type = typeInfo(pointer.type);
    const SlotPlace place{id, 0, Decoration::kNoMember, false};
    ir::InterfaceSlot slot;
    SlotCursor at;
    decorateSlot(place, slot, at);
    if (isNumberedByVertex(id, type)) {
        for (uint32_t vertex = 0; vertex < type.count; ++vertex) {
            slot.index = static_cast<uint8_t>(vertex + 1);
            SlotCursor ofVertex = at;
            appendSlots(type.element, place, slot, ofVertex, program_.outputs);
        }
    } else {
        appendSlots(pointer.type, place, slot, at, program_.outputs);
    }
    pointer.extent = static_cast<uint32_t>(program_.outputs.size()) - pointer.root;
    if (pointer.extent == 0) refuseId(id, "has no value");
    // Every invocation gives the same: they run in step, and none of them has stored anything before.
    initialise(inst, pointer);
    setPointer(id, pointer);
}

/// After the modes and the outputs.
void Lowering::endPatch() {
    if (program_.stage != ir::Stage::control) return;
    if (patchVertices_ == 0 || patchVertices_ > kMaxPatchVertices) {
        throw LoweringError{unsupported("SPIR-V: entry point '" + program_.name +
                                        "': " + std::to_string(patchVertices_) + " output vertices; from 1 to " +
                                        std::to_string(kMaxPatchVertices) + " are supported")};
    }
    if (program_.outputs.size() > kMaxPatchWords) {
        throw LoweringError{unsupported("SPIR-V: entry point '" + program_.name + "': outputs of " +
                                        std::to_string(program_.outputs.size()) + " components in all; " +
                                        std::to_string(kMaxPatchWords) + " are supported")};
    }
    program_.localSize = {patchVertices_, 1, 1};
    if (patchResource_ == ir::kNoIndex) return;
    program_.resources[patchResource_].byteSize = static_cast<uint32_t>(program_.outputs.size() * sizeof(uint32_t)) *
                                                  patchesPerBatch(kPatchLanes, patchVertices_);
}

/// Bytes from the begin of the memory to a word, `at` words behind where the pointer points. A place outside of the
/// variable, which an index at run time can ask for, is its last word.
ir::ValueId Lowering::patchPlace(const Pointer& pointer, uint32_t at) {
    const uint32_t fixed = std::min(pointer.offset + at, pointer.extent - 1);
    ir::ValueId word = emitter_.constantI32(pointer.root + fixed);
    if (pointer.dynamic != ir::kNoValue) {
        const ir::ValueId within =
            binary(ir::Op::umin, binary(ir::Op::iadd, pointer.dynamic, emitter_.constantI32(fixed)),
                   emitter_.constantI32(pointer.extent - 1));
        word = binary(ir::Op::iadd, within, emitter_.constantI32(pointer.root));
    }
    return binary(ir::Op::iadd, inputSlot(ir::Builtin::stageOffset, 0, ir::Type::i32),
                  binary(ir::Op::shl, word, emitter_.constantI32(2)));
}

}  // namespace vernier
