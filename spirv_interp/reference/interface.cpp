// The inputs of an invocation, and what it leaves in its outputs.
#include <utility>

#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/machine.h"

namespace vernier::reference {

template <class Number>
void Machine<Number>::createInterface(const InterfaceValues<Number>& inputs) {
    for (const InterfaceLayout& layout : module_.entryPointData[program_.entryPoint].layouts) {
        const Variable& variable = module_.variables[layout.variable];
        variables_[layout.variable] = variablePointer(variable);
        Object<Number>& object = *variables_[layout.variable]->object;
        object.layout = &layout;
        if (layout.output) continue;
        for (const InterfaceCell& cell : layout.cells) {
            Scalar<Number>& target = object.cells[cell.cell];
            if (cell.vertex > inputs.vertices.size()) continue;
            const InterfaceValues<Number>& from = cell.vertex == 0 ? inputs : inputs.vertices[cell.vertex - 1];
            if (cell.isBuiltin) {
                if (cell.builtin == spv::BuiltInHelperInvocation) target.bits = helper_ ? 1 : 0;
                const auto found = from.builtins.find(cell.builtin);
                if (found != from.builtins.end() && cell.element < found->second.size())
                    target = found->second[cell.element];
            } else if (const auto found = from.locations.find(cell.location); found != from.locations.end()) {
                target = found->second[cell.component];
                if (module_.types[cell.type].width == 64 && cell.component < 3 &&
                    module_.types[cell.type].kind == TypeKind::integer)
                    target.bits = (target.bits & 0xFFFFFFFFu) | found->second[cell.component + 1].bits << 32;
            }
            const Type& type = module_.types[cell.type];
            target.bits &= widthMask(type.width);
            if (type.kind == TypeKind::boolean) target.bits = target.bits != 0 ? 1 : 0;
            if (type.kind == TypeKind::floating) round(target, type.width);
        }
    }
}

/// The outputs as they are now.
template <class Number>
InterfaceValues<Number> Machine<Number>::outputs() const {
    InterfaceValues<Number> result;
    for (const InterfaceLayout& layout : module_.entryPointData[program_.entryPoint].layouts) {
        if (!layout.output) continue;
        const Object<Number>& object = *variables_[layout.variable]->object;
        for (const InterfaceCell& cell : layout.cells) {
            if (!object.written[cell.cell]) continue;
            const Scalar<Number>& scalar = object.cells[cell.cell];
            if (result.vertices.size() < cell.vertex) result.vertices.resize(cell.vertex);
            InterfaceValues<Number>& to = cell.vertex == 0 ? result : result.vertices[cell.vertex - 1];
            if (cell.isBuiltin) {
                auto& scalars = to.builtins[cell.builtin];
                if (scalars.size() <= cell.element) scalars.resize(cell.element + 1);
                scalars[cell.element] = scalar;
            } else {
                Texel<Number>& texel = to.locations[cell.location];
                texel[cell.component] = scalar;
                const Type& type = module_.types[cell.type];
                if (type.kind == TypeKind::integer && type.isSigned && type.width < 32) {
                    texel[cell.component].bits = static_cast<uint32_t>(asSigned(scalar.bits, type.width));
                }
                if (type.kind == TypeKind::integer && type.width == 64 && cell.component < 3) {
                    texel[cell.component].bits &= 0xFFFFFFFFu;
                    texel[cell.component + 1].bits = scalar.bits >> 32;
                }
            }
        }
    }
    return result;
}

/// The outputs keep their values, where the specification leaves them undefined.
template <class Number>
void Machine<Number>::emitVertex(uint32_t stream) {
    const EntryPoint& entry = module_.entryPoints[program_.entryPoint];
    if (entry.model != spv::ExecutionModelGeometry) fail("OpEmitVertex outside a geometry shader");
    if (vertices_.size() >= entry.modes.outputVertices) return;
    charge(1);
    vertices_.push_back({outputs(), stream, std::exchange(startsStrip_, false)});
}

template <class Number>
Outcome<Number> Machine<Number>::outcome() const {
    Outcome<Number> result;
    result.outputs = outputs();
    result.vertices = vertices_;
    result.discarded = discarded_;
    result.steps = steps_;
    return result;
}

#define VERNIER_INSTANTIATE(Number)                                                 \
    template void Machine<Number>::createInterface(const InterfaceValues<Number>&); \
    template void Machine<Number>::emitVertex(uint32_t);                            \
    template Outcome<Number> Machine<Number>::outcome() const;
VERNIER_INSTANTIATE(float)
VERNIER_INSTANTIATE(double)
VERNIER_INSTANTIATE(Real)

}  // namespace vernier::reference
