#include "spirv_interp/ir/lift.h"

#include <algorithm>
#include <unordered_map>

#include "spirv_interp/ir/cost.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/primitive_inputs.h"

namespace vernier::ir {
namespace {

// Scalars between the stages, new ones included: half of what Vulkan's maxVertexOutputComponents may be.
constexpr size_t kMostOutputs = 64;
constexpr uint16_t kLastLocation = 0xFF00;  // room for the locations of new ones behind it

class Lifter {
  public:
    Lifter(Program& vertex, Program& fragment, bool linear)
        : vertex_(vertex),
          fragment_(fragment),
          linear_(linear),
          kinds_(fragment.valueTypes.size()),
          definition_(fragment.valueTypes.size(), nullptr),
          isRoot_(fragment.valueTypes.size()) {}

    LiftFacts run() {
        if (!findStores()) return {};
        classify();
        findRoots();
        if (roots_.empty() || !hasRoom()) return {};
        const uint32_t before = costWithout(std::vector<bool>(isRoot_.size()));
        dropCostlyRoots();
        if (roots_.empty() || vertex_.outputs.size() + roots_.size() > kMostOutputs) return {};
        if (costWithout(isRoot_) + (linear_ ? kLeastLinearGain : kLeastGain) > before) return {};
        const LiftFacts facts = countLifted();
        cloneIntoVertex();
        readInFragment();
        return facts;
    }

  private:
    /// How a value varies over a primitive.
    struct Kind {
        enum class Form : uint8_t {
            other,
            fixed,   // not at all, nor in the draw
            flat,    // not at all
            linear,  // as the interpolation of `slot` does, which stands for all of its kind
        };
        Form form = Form::other;
        InterfaceSlot slot;
        bool operator==(const Kind&) const = default;
    };
    using Form = Kind::Form;

    const InterfaceSlot* outputOf(const InterfaceSlot& input, size_t& index) const {
        for (index = 0; index < vertex_.outputs.size(); ++index) {
            const InterfaceSlot& output = vertex_.outputs[index];
            if (output.builtin == input.builtin && output.location == input.location &&
                output.component == input.component) {
                return &output;
            }
        }
        return nullptr;
    }

    /// The value each output of the vertex program has at its end; kNoValue for an output stored in another block than
    /// the last, or several times. False when the program has several ends.
    bool findStores() {
        stored_.assign(vertex_.outputs.size(), kNoValue);
        std::vector<uint32_t> stores(vertex_.outputs.size());
        size_t ends = 0;
        for (BlockId b = 0; b < vertex_.blocks.size(); ++b) {
            if (vertex_.blocks[b].insts.back().op != Op::ret) continue;
            end_ = b;
            ++ends;
        }
        if (ends != 1) return false;
        for (BlockId b = 0; b < vertex_.blocks.size(); ++b) {
            for (const Inst& inst : vertex_.blocks[b].insts) {
                if (inst.op != Op::storeOutput) continue;
                const bool only = ++stores[inst.imm] == 1 && b == end_;
                stored_[inst.imm] = only ? vertex_.operandsOf(inst)[0] : kNoValue;
            }
        }
        return true;
    }

    bool hasRoom() const {
        const auto isFar = [](const InterfaceSlot& output) { return output.location > kLastLocation; };
        return std::none_of(vertex_.outputs.begin(), vertex_.outputs.end(), isFar);
    }

    void classify() {
        for (const Block& block : fragment_.blocks) {
            for (const Inst& inst : block.insts) {
                if (inst.result == kNoValue) continue;
                definition_[inst.result] = &inst;
                kinds_[inst.result] = kindOf(inst);
            }
        }
    }

    Kind kindOfInput(const Inst& inst) const {
        const InterfaceSlot& slot = fragment_.inputs[inst.imm];
        size_t index = 0;
        if (slot.builtin != Builtin::user || outputOf(slot, index) == nullptr || stored_[index] == kNoValue) return {};
        if (isPerVertex(slot)) return {};
        if (slot.interpolation == Interpolation::flat) return {Form::flat, {}};
        if (!linear_ || slot.type != Type::f32) return {};
        InterfaceSlot like;
        like.interpolation = slot.interpolation;
        like.sampling = slot.sampling;
        return {Form::linear, like};
    }

    /// A load that the vertex program can do as well.
    bool isFixedLoad(const Inst& inst) const {
        if (inst.op != Op::loadBuffer || resourceOf(inst) == kNoIndex || isWide(inst.type)) return false;
        const ResourceKind kind = fragment_.resources[resourceOf(inst)].kind;
        if (kind != ResourceKind::uniformBuffer && kind != ResourceKind::pushConstants) return false;
        const auto operands = fragment_.operandsOf(inst);
        return std::all_of(operands.begin(), operands.end(),
                           [&](ValueId operand) { return kinds_[operand].form == Form::fixed; });
    }

    Kind kindOf(const Inst& inst) const {
        if (inst.op == Op::input) return kindOfInput(inst);
        if (inst.op == Op::constant || inst.op == Op::undef || isFixedLoad(inst)) return {Form::fixed, {}};
        const bool own = inst.op == Op::phi || inst.op == Op::inputIndexed || inst.op == Op::subgroupInvocation ||
                         immKind(inst.op) == ImmKind::input;
        if (opInfo(inst.op).kind != 'P' || own || isWide(inst.type)) return {};
        Kind kind{Form::fixed, {}};
        for (const ValueId operand : fragment_.operandsOf(inst)) {
            if (kinds_[operand].form == Form::linear) return linearKindOf(inst);
            if (kinds_[operand].form == Form::other) return {};
            kind.form = std::max(kind.form, kinds_[operand].form);
        }
        return kind;
    }

    Kind linearKindOf(const Inst& inst) const {
        if (inst.noContraction || inst.type != Type::f32) return {};
        const auto operands = fragment_.operandsOf(inst);
        const auto formOf = [&](size_t k) { return kinds_[operands[k]].form; };
        // Of the factors, one at most varies.
        const bool product = inst.op == Op::fmul || inst.op == Op::ffma;
        if (product && formOf(0) != Form::fixed && formOf(1) != Form::fixed) return {};
        if (inst.op == Op::fdiv && formOf(1) != Form::fixed) return {};
        const bool sum = inst.op == Op::fadd || inst.op == Op::fsub || inst.op == Op::fneg;
        if (!product && !sum && inst.op != Op::fdiv) return {};
        Kind kind;
        for (const ValueId operand : operands) {
            const Kind& part = kinds_[operand];
            if (part.form == Form::fixed) continue;
            if (part.form != Form::linear || (kind.form == Form::linear && kind != part)) return {};
            kind = part;
        }
        return kind;
    }

    bool isLifted(ValueId value) const {
        const Form form = kinds_[value].form;
        return (form == Form::flat || form == Form::linear) && definition_[value]->op != Op::input;
    }

    /// Lifted values that something else uses.
    void findRoots() {
        for (const Block& block : fragment_.blocks) {
            for (const Inst& inst : block.insts) {
                if (inst.result != kNoValue && isLifted(inst.result)) continue;
                for (const ValueId operand : fragment_.operandsOf(inst)) {
                    if (!isLifted(operand) || isRoot_[operand]) continue;
                    isRoot_[operand] = true;
                    roots_.push_back(operand);
                }
            }
        }
    }

    /// Calls visit(inst) for what the fragment program must still compute when `given` values are inputs.
    template <class Visit>
    void visitNeeded(const std::vector<bool>& given, Visit&& visit) const {
        std::vector<bool> needed(kinds_.size());
        for (size_t b = fragment_.blocks.size(); b-- > 0;) {
            const auto& insts = fragment_.blocks[b].insts;
            for (size_t k = insts.size(); k-- > 0;) {
                const Inst& inst = insts[k];
                const bool known = inst.result != kNoValue && given[inst.result];
                const bool idle =
                    inst.result != kNoValue && !needed[inst.result] && (isLifted(inst.result) || inst.op == Op::input);
                if (known || idle) continue;
                visit(inst);
                for (const ValueId operand : fragment_.operandsOf(inst)) needed[operand] = true;
            }
        }
    }

    /// Of a linear or flat operation, for a pixel. ir/cost.h tells what an operation costs at worst.
    uint32_t operationCost(const Inst& inst) const { return inst.op == Op::ffma ? 2 : costOf(fragment_, inst); }
    static uint32_t inputCost(Form form) { return form == Form::linear ? kSmoothInputCost : kFlatInputCost; }

    /// Of lifted operations and of inputs, per pixel, when `given` are inputs.
    uint32_t costWithout(const std::vector<bool>& given) const {
        uint32_t cost = 0;
        std::vector<bool> read(fragment_.inputs.size());
        visitNeeded(given, [&](const Inst& inst) {
            if (inst.result == kNoValue) return;
            if (isLifted(inst.result)) cost += operationCost(inst);
            if (inst.op != Op::input || read[inst.imm]) return;
            read[inst.imm] = true;
            cost += inputCost(kinds_[inst.result].form);
        });
        for (const ValueId root : roots_) {
            if (given[root]) cost += inputCost(kinds_[root].form);
        }
        return cost;
    }

    /// Keeps the roots without each of which the fragment program would cost more.
    void dropCostlyRoots() {
        uint32_t cost = costWithout(isRoot_);
        for (bool again = true; again;) {
            again = false;
            for (const ValueId root : roots_) {
                if (!isRoot_[root]) continue;
                isRoot_[root] = false;
                const uint32_t without = costWithout(isRoot_);
                if (without <= cost) {
                    cost = without;
                    again = true;
                } else {
                    isRoot_[root] = true;
                }
            }
        }
        std::erase_if(roots_, [&](ValueId root) { return !isRoot_[root]; });
    }

    LiftFacts countLifted() const {
        std::vector<bool> stays(kinds_.size());
        visitNeeded(isRoot_, [&](const Inst& inst) {
            if (inst.result != kNoValue) stays[inst.result] = true;
        });
        LiftFacts facts;
        for (const Block& block : fragment_.blocks) {
            for (const Inst& inst : block.insts) {
                if (inst.result == kNoValue || stays[inst.result] || !isLifted(inst.result)) continue;
                ++(kinds_[inst.result].form == Form::linear ? facts.linear : facts.flat);
            }
        }
        return facts;
    }

    ValueId insert(Inst inst, std::span<const ValueId> operands) {
        inst.firstOperand = static_cast<uint32_t>(vertex_.operands.size());
        inst.operandCount = static_cast<uint16_t>(operands.size());
        inst.line = inst.file = 0;
        if (inst.type != Type::none) inst.result = vertex_.newValue(inst.type);
        vertex_.operands.insert(vertex_.operands.end(), operands.begin(), operands.end());
        auto& insts = vertex_.blocks[end_].insts;
        insts.insert(insts.end() - 1, inst);
        return inst.result;
    }

    /// The vertex program's own number of a resource of the fragment program.
    uint32_t resourceInVertex(const Resource& wanted) {
        const auto same = [&](const Resource& r) {
            return r.kind == wanted.kind && r.set == wanted.set && r.binding == wanted.binding;
        };
        const auto found = std::find_if(vertex_.resources.begin(), vertex_.resources.end(), same);
        const auto index = static_cast<uint32_t>(found - vertex_.resources.begin());
        if (found == vertex_.resources.end()) {
            vertex_.resources.push_back(wanted);
        } else {
            found->byteSize = std::max(found->byteSize, wanted.byteSize);
            found->arraySize =
                found->arraySize == 0 || wanted.arraySize == 0 ? 0 : std::max(found->arraySize, wanted.arraySize);
        }
        return index;
    }

    /// A value of the fragment program, made anew at the end of the vertex program.
    ValueId cloned(ValueId value) {
        // Operands come first: in the order of a walk that visits them before their user.
        std::vector<ValueId> open{value};
        while (!open.empty()) {
            const ValueId at = open.back();
            const Inst& inst = *definition_[at];
            if (clones_.contains(at)) {
                open.pop_back();
                continue;
            }
            if (inst.op == Op::input) {
                size_t index = 0;
                outputOf(fragment_.inputs[inst.imm], index);
                clones_[at] = stored_[index];
                continue;
            }
            const size_t before = open.size();
            std::vector<ValueId> operands;
            for (const ValueId operand : fragment_.operandsOf(inst)) {
                const auto found = clones_.find(operand);
                if (found == clones_.end()) {
                    open.push_back(operand);
                } else {
                    operands.push_back(found->second);
                }
            }
            if (open.size() != before) continue;
            Inst clone = inst;
            if (inst.op == Op::loadBuffer) {
                clone.imm = immPair(resourceInVertex(fragment_.resources[resourceOf(inst)]), immHigh(inst));
            }
            clones_[at] = insert(clone, operands);
        }
        return clones_[value];
    }

    void cloneIntoVertex() {
        uint16_t location = 0;
        for (const InterfaceSlot& output : vertex_.outputs) location = std::max(location, output.location);
        uint32_t component = 4;
        for (const ValueId root : roots_) {
            if (component == 4) {
                ++location;
                component = 0;
            }
            InterfaceSlot slot;
            slot.location = location;
            slot.component = static_cast<uint8_t>(component++);
            slot.type = fragment_.valueTypes[root];
            ValueId value = cloned(root);
            // Between the stages there are numbers only.
            if (slot.type == Type::b1) {
                slot.type = Type::i32;
                Inst widen;
                widen.op = Op::zext;
                widen.type = Type::i32;
                widen.imm = static_cast<uint64_t>(Type::b1);
                value = insert(widen, std::span(&value, 1));
            }
            Inst store;
            store.op = Op::storeOutput;
            store.imm = vertex_.outputs.size();
            vertex_.outputs.push_back(slot);
            insert(store, std::span(&value, 1));
            const Kind& kind = kinds_[root];
            slot.interpolation = kind.form == Form::flat ? Interpolation::flat : kind.slot.interpolation;
            slot.sampling = kind.slot.sampling;
            fragment_.inputs.push_back(slot);
        }
    }

    void readInFragment() {
        const size_t first = fragment_.inputs.size() - roots_.size();
        std::unordered_map<ValueId, size_t> slotOf;
        for (size_t k = 0; k < roots_.size(); ++k) slotOf[roots_[k]] = first + k;
        for (Block& block : fragment_.blocks) {
            for (size_t i = 0; i < block.insts.size(); ++i) {
                const auto found = slotOf.find(block.insts[i].result);
                if (found == slotOf.end()) continue;
                Inst read;
                read.op = Op::input;
                read.type = fragment_.inputs[found->second].type;
                read.imm = found->second;
                if (block.insts[i].type != Type::b1) {
                    read.result = block.insts[i].result;
                    block.insts[i] = read;
                    continue;
                }
                Inst& test = block.insts[i];
                const ValueId result = test.result;
                Inst zero;
                zero.op = Op::constant;
                zero.type = Type::i32;
                zero.result = fragment_.newValue(Type::i32);
                read.result = fragment_.newValue(Type::i32);
                test = {};
                test.op = Op::ine;
                test.type = Type::b1;
                test.imm = static_cast<uint64_t>(Type::i32);
                test.result = result;
                test.firstOperand = static_cast<uint32_t>(fragment_.operands.size());
                test.operandCount = 2;
                fragment_.operands.insert(fragment_.operands.end(), {read.result, zero.result});
                block.insts.insert(block.insts.begin() + static_cast<ptrdiff_t>(i), {read, zero});
                i += 2;
            }
        }
    }

    Program& vertex_;
    Program& fragment_;
    const bool linear_;
    BlockId end_ = 0;              // of the vertex program
    std::vector<ValueId> stored_;  // by output of the vertex program
    std::vector<Kind> kinds_;      // by value of the fragment program
    std::vector<const Inst*> definition_;
    std::vector<bool> isRoot_;                     // by value of the fragment program: it becomes an input
    std::vector<ValueId> roots_;                   // those values
    std::unordered_map<ValueId, ValueId> clones_;  // from values of the fragment to those of the vertex program
};

}  // namespace

LiftFacts lift(Program& vertex, Program& fragment, bool linear) {
    if (linear) {
        const LiftFacts facts = Lifter(vertex, fragment, true).run();
        if (facts.flat + facts.linear != 0) return facts;
    }
    return Lifter(vertex, fragment, false).run();
}

}  // namespace vernier::ir
