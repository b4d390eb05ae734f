#include "spirv_interp/ir/link.h"

#include <algorithm>

#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/primitive_inputs.h"

namespace vernier::ir {
namespace {

bool samePlace(const InterfaceSlot& output, const InterfaceSlot& input) {
    return output.builtin == input.builtin && output.location == input.location && output.component == input.component;
}

/// Whether a fragment input is fed by a vertex output, rather than by the rasteriser.
bool isVarying(const InterfaceSlot& slot) {
    if (isBaryCoord(slot)) return false;
    return slot.builtin == Builtin::user || slot.builtin == Builtin::clipDistance ||
           slot.builtin == Builtin::cullDistance;
}

const InterfaceSlot* findSlot(std::span<const InterfaceSlot> slots, const InterfaceSlot& like) {
    const auto found =
        std::find_if(slots.begin(), slots.end(), [&](const InterfaceSlot& s) { return samePlace(s, like); });
    return found == slots.end() ? nullptr : &*found;
}

/// Returns how many outputs nobody reads.
uint32_t dropUnreadOutputs(Program& vertex, const Program& fragment, std::span<const InterfaceSlot> kept) {
    std::vector<bool> read(vertex.outputs.size());
    for (size_t i = 0; i < vertex.outputs.size(); ++i) {
        const InterfaceSlot& slot = vertex.outputs[i];
        read[i] = slot.builtin != Builtin::user || findSlot(fragment.inputs, slot) != nullptr ||
                  findSlot(kept, slot) != nullptr;
    }
    for (Block& block : vertex.blocks) {
        std::erase_if(block.insts, [&](const Inst& inst) { return inst.op == Op::storeOutput && !read[inst.imm]; });
    }
    return static_cast<uint32_t>(std::count(read.begin(), read.end(), false));
}

/// Inputs that are read one by one and that nothing writes become 0. Returns whether there are any.
bool zeroUnwrittenInputs(Program& fragment, const std::vector<bool>& written) {
    bool any = false;
    for (Block& block : fragment.blocks) {
        for (Inst& inst : block.insts) {
            if (inst.op == Op::inputIndexed || immKind(inst.op) != ImmKind::input || written[inst.imm]) continue;
            inst.op = Op::constant;
            inst.operandCount = 0;
            inst.imm = 0;
            any = true;
        }
    }
    return any;
}

/// Writes 0 to `slot` before every return.
void writeZero(Program& vertex, const InterfaceSlot& slot) {
    Inst zero;
    zero.op = Op::constant;
    zero.type = slot.type;
    zero.result = vertex.newValue(slot.type);
    const auto index = static_cast<uint32_t>(vertex.outputs.size());
    InterfaceSlot output = slot;
    output.interpolation = Interpolation::smooth;
    output.sampling = Sampling::center;
    output.index = 0;
    vertex.outputs.push_back(output);
    for (Block& block : vertex.blocks) {
        if (block.insts.back().op != Op::ret) continue;
        Inst store;
        store.op = Op::storeOutput;
        store.imm = index;
        store.firstOperand = static_cast<uint32_t>(vertex.operands.size());
        store.operandCount = 1;
        vertex.operands.push_back(zero.result);
        block.insts.insert(block.insts.end() - 1, store);
    }
    auto& entry = vertex.blocks[0].insts;
    entry.insert(entry.begin(), zero);
}

}  // namespace

Status linkStages(Program& vertex, Program& fragment, LinkFacts* facts, const LinkOptions& options) {
    if (vertex.stage != Stage::vertex || fragment.stage != Stage::fragment) {
        return invalidArgument("linkStages: the programs are not a vertex and a fragment program, in this order");
    }
    std::vector<bool> written(fragment.inputs.size(), true);
    for (size_t i = 0; i < fragment.inputs.size(); ++i) {
        const InterfaceSlot& input = fragment.inputs[i];
        if (!isVarying(input)) continue;
        const InterfaceSlot* output = findSlot(vertex.outputs, input);
        written[i] = output != nullptr;
        if (output != nullptr && output->type != input.type) {
            return invalidArgument("location " + std::to_string(input.location) + ", component " +
                                   std::to_string(input.component) + ": the vertex shader writes " +
                                   std::string(typeName(output->type)) + ", the fragment shader reads " +
                                   std::string(typeName(input.type)));
        }
    }
    // Programs come optimised: only what changes here is worth another look.
    if (zeroUnwrittenInputs(fragment, written)) optimise(fragment);
    bool vertexChanged = false;
    for (const InterfaceSlot& input : fragment.inputs) {
        if (!isVarying(input) || findSlot(vertex.outputs, input) != nullptr) continue;
        writeZero(vertex, input);
        vertexChanged = true;
    }
    const LiftFacts lifted = options.lift ? lift(vertex, fragment, options.liftLinear) : LiftFacts{};
    const bool changed = lifted.flat + lifted.linear != 0;
    if (changed) optimise(fragment);
    const uint32_t removed = options.dropUnread ? dropUnreadOutputs(vertex, fragment, options.kept) : 0;
    if (facts != nullptr) *facts = {removed, lifted};
    if (vertexChanged || changed || removed != 0) optimise(vertex);
    return {};
}

}  // namespace vernier::ir
