#include "spirv_interp/ir/link.h"

#include <algorithm>

#include "spirv_interp/ir/names.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/optimise.h"

namespace vernier::ir {
namespace {

bool samePlace(const InterfaceSlot& output, const InterfaceSlot& input) {
    return output.builtin == input.builtin && output.location == input.location && output.component == input.component;
}

/// Whether an input is fed by an output of the stage before, rather than by what lies between the stages.
bool isVarying(const Program& program, const InterfaceSlot& slot) {
    if (program.stage != Stage::fragment) return slot.index != 0;
    return slot.builtin == Builtin::user || slot.builtin == Builtin::clipDistance ||
           slot.builtin == Builtin::cullDistance;
}

/// What the rasteriser takes, and what the runner of the stage does.
bool isForRunner(const Program& producer, const Program& consumer, const InterfaceSlot& output) {
    if (output.builtin == Builtin::vertexFlags || output.builtin == Builtin::vertexCount) return true;
    const bool rasterised =
        consumer.stage == Stage::fragment && (producer.stage != Stage::geometry || output.index == 0);
    return rasterised && output.builtin != Builtin::user;
}

const InterfaceSlot* findSlot(std::span<const InterfaceSlot> slots, const InterfaceSlot& like) {
    const auto found =
        std::find_if(slots.begin(), slots.end(), [&](const InterfaceSlot& s) { return samePlace(s, like); });
    return found == slots.end() ? nullptr : &*found;
}

/// Returns how many outputs nobody reads.
uint32_t dropUnreadOutputs(Program& producer, const Program& consumer, std::span<const InterfaceSlot> kept) {
    std::vector<bool> read(producer.outputs.size());
    for (size_t i = 0; i < producer.outputs.size(); ++i) {
        const InterfaceSlot& slot = producer.outputs[i];
        read[i] = isForRunner(producer, consumer, slot) || findSlot(consumer.inputs, slot) != nullptr ||
                  findSlot(kept, slot) != nullptr;
    }
    for (Block& block : producer.blocks) {
        std::erase_if(block.insts,
                      [&](const Inst& inst) { return immKind(inst.op) == ImmKind::output && !read[inst.imm]; });
    }
    return static_cast<uint32_t>(std::count(read.begin(), read.end(), false));
}

/// Inputs that are read one by one and that nothing writes become 0. Returns whether there are any.
bool zeroUnwrittenInputs(Program& consumer, const std::vector<bool>& written) {
    bool any = false;
    for (Block& block : consumer.blocks) {
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

/// Places in the order in which the stages run.
uint32_t placeOf(Stage stage) {
    switch (stage) {
        case Stage::vertex:
            return 0;
        case Stage::control:
            return 1;
        case Stage::evaluation:
            return 2;
        case Stage::geometry:
            return 3;
        case Stage::fragment:
            return 4;
        default:
            return 5;
    }
}

}  // namespace

bool writesAll(const Program& producer, const Program& consumer) {
    return std::ranges::all_of(consumer.inputs, [&](const InterfaceSlot& input) {
        if (!isVarying(consumer, input)) return true;
        const InterfaceSlot* output = findSlot(producer.outputs, input);
        return output != nullptr && output->type == input.type;
    });
}

Status linkStages(Program& producer, Program& consumer, LinkFacts* facts, const LinkOptions& options) {
    if (placeOf(producer.stage) >= placeOf(consumer.stage) || consumer.stage == Stage::compute) {
        return invalidArgument("linkStages: a " + std::string(nameOf(producer.stage)) + " and a " +
                               std::string(nameOf(consumer.stage)) + " program do not follow each other");
    }
    std::vector<bool> written(consumer.inputs.size(), true);
    for (size_t i = 0; i < consumer.inputs.size(); ++i) {
        const InterfaceSlot& input = consumer.inputs[i];
        if (!isVarying(consumer, input)) continue;
        const InterfaceSlot* output = findSlot(producer.outputs, input);
        written[i] = output != nullptr;
        if (output != nullptr && output->type != input.type) {
            return invalidArgument("location " + std::to_string(input.location) + ", component " +
                                   std::to_string(input.component) + ": the " + std::string(nameOf(producer.stage)) +
                                   " shader writes " + std::string(typeName(output->type)) + ", the " +
                                   std::string(nameOf(consumer.stage)) + " shader reads " +
                                   std::string(typeName(input.type)));
        }
    }
    // Programs come optimised: only what changes here is worth another look.
    if (zeroUnwrittenInputs(consumer, written)) optimise(consumer);
    // Between others than these two, the runner gives 0 for what nobody writes.
    const bool atEnd = producer.stage != Stage::geometry && consumer.stage == Stage::fragment;
    bool producerChanged = false;
    for (const InterfaceSlot& input : consumer.inputs) {
        if (!atEnd || !isVarying(consumer, input) || findSlot(producer.outputs, input) != nullptr) continue;
        writeZero(producer, input);
        producerChanged = true;
    }
    const LiftFacts lifted = options.lift && atEnd ? lift(producer, consumer, options.liftLinear) : LiftFacts{};
    const bool changed = lifted.flat + lifted.linear != 0;
    if (changed) optimise(consumer);
    const uint32_t removed = options.dropUnread ? dropUnreadOutputs(producer, consumer, options.kept) : 0;
    if (facts != nullptr) *facts = {removed, lifted};
    if (producerChanged || changed || removed != 0) optimise(producer);
    return {};
}

}  // namespace vernier::ir
