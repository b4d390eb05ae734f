// What a geometry stage puts out: EmitVertex keeps the outputs as they are, vertex by vertex, with how they make up
// primitives ("Geometry Shader Output Primitives" in the Vulkan specification).
#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/place_vertices.h"

namespace vernier {

/// False: it is no mode of geometry stages.
bool Lowering::lowerGeometryMode(const Instruction& mode) {
    if (program_.stage != ir::Stage::geometry) return false;
    ir::GeometryModes& modes = program_.geometry;
    switch (static_cast<spv::ExecutionMode>(mode[2])) {
        case spv::ExecutionMode::InputPoints:
            modes.input = ir::GeometryInput::points;
            return true;
        case spv::ExecutionMode::InputLines:
            modes.input = ir::GeometryInput::lines;
            return true;
        case spv::ExecutionMode::InputLinesAdjacency:
            modes.input = ir::GeometryInput::linesAdjacency;
            return true;
        case spv::ExecutionMode::Triangles:
            modes.input = ir::GeometryInput::triangles;
            return true;
        case spv::ExecutionMode::InputTrianglesAdjacency:
            modes.input = ir::GeometryInput::trianglesAdjacency;
            return true;
        case spv::ExecutionMode::OutputPoints:
            modes.output = ir::GeometryOutput::points;
            return true;
        case spv::ExecutionMode::OutputLineStrip:
            modes.output = ir::GeometryOutput::lineStrip;
            return true;
        case spv::ExecutionMode::OutputTriangleStrip:
            modes.output = ir::GeometryOutput::triangleStrip;
            return true;
        case spv::ExecutionMode::Invocations:
            modes.invocations = mode[3];
            return true;
        case spv::ExecutionMode::OutputVertices:
            modes.outputVertices = mode[3];
            return true;
        default:
            return false;
    }
}

void Lowering::checkGeometryModes() const {
    if (program_.stage != ir::Stage::geometry) return;
    const auto check = [this](uint32_t value, uint32_t most, const char* what) {
        if (value != 0 && value <= most) return;
        throw LoweringError{unsupported("SPIR-V: entry point '" + program_.name + "': " + std::to_string(value) + " " +
                                        what + "; from 1 to " + std::to_string(most) + " are supported")};
    };
    check(program_.geometry.invocations, ir::kMaxGeometryInvocations, "invocations of a primitive");
    check(program_.geometry.outputVertices, ir::kMaxGeometryVertices, "output vertices");
}

void Lowering::beginVertices() {
    vertexCount_ = emitter_.newVariables(2);
    startsStrip_ = vertexCount_ + 1;
    emitter_.write(vertexCount_, emitter_.constantI32(0));
    emitter_.write(startsStrip_, emitter_.constantI32(ir::kStartsStrip));
    flagsSlot_ = static_cast<uint32_t>(program_.outputs.size());
    for (const ir::Builtin builtin : {ir::Builtin::vertexFlags, ir::Builtin::vertexCount}) {
        ir::InterfaceSlot& slot = program_.outputs.emplace_back();
        slot.builtin = builtin;
        slot.type = ir::Type::i32;
    }
    const uint64_t components = uint64_t{flagsSlot_} * program_.geometry.outputVertices;
    if (components > ir::kMaxGeometryComponents) {
        throw LoweringError{unsupported("SPIR-V: entry point '" + program_.name + "': " + std::to_string(flagsSlot_) +
                                        " components of " + std::to_string(program_.geometry.outputVertices) +
                                        " vertices; " + std::to_string(ir::kMaxGeometryComponents) +
                                        " are supported in all")};
    }
}

void Lowering::endVertices() {
    emitter_.emit(ir::Op::storeOutput, ir::Type::none, {emitter_.read(vertexCount_, ir::Type::i32)}, flagsSlot_ + 1);
}

uint32_t Lowering::streamOf(const Instruction& inst) {
    const bool names = inst.op == spv::Op::OpEmitStreamVertex || inst.op == spv::Op::OpEndStreamPrimitive;
    const uint32_t stream = names ? constantIndex(inst[1]) : 0;
    if (stream >= ir::kVertexStreams) refuse(inst, "there is no vertex stream " + std::to_string(stream));
    return stream;
}

bool Lowering::lowerEmission(const Instruction& inst) {
    switch (inst.op) {
        case spv::Op::OpEmitVertex:
        case spv::Op::OpEmitStreamVertex: {
            const uint32_t stream = streamOf(inst);
            if (program_.stage != ir::Stage::geometry) refuse(inst, "there are vertices in geometry stages alone");
            // Vertices beyond those declared are dropped: all of them have the number behind the last.
            const ir::ValueId vertex = emitter_.read(vertexCount_, ir::Type::i32);
            const ir::ValueId starts = emitter_.read(startsStrip_, ir::Type::i32);
            storeVertex(vertex, stream);
            const ir::ValueId flags = binary(ir::Op::ior, starts, emitter_.constantI32(stream << ir::kStreamBit));
            emitter_.emit(ir::Op::storeVertex, ir::Type::none, {vertex, flags}, flagsSlot_);
            emitter_.write(vertexCount_, binary(ir::Op::umin, binary(ir::Op::iadd, vertex, emitter_.constantI32(1)),
                                                emitter_.constantI32(program_.geometry.outputVertices)));
            // Of several streams all are of points: which strip goes on does not matter.
            emitter_.write(startsStrip_, emitter_.constantI32(0));
            return true;
        }
        case spv::Op::OpEndPrimitive:
        case spv::Op::OpEndStreamPrimitive:
            streamOf(inst);
            if (program_.stage != ir::Stage::geometry) refuse(inst, "there are primitives in geometry stages alone");
            emitter_.write(startsStrip_, emitter_.constantI32(ir::kStartsStrip));
            return true;
        default:
            return false;
    }
}

}  // namespace vernier
