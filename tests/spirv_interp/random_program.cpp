#include "tests/spirv_interp/random_program.h"

#include <array>
#include <random>
#include <utility>

#include "spirv_interp/ir/analyse.h"
#include "spirv_interp/ir/builder.h"

namespace vernier::test {
namespace {

using ir::BlockId;
using ir::Op;
using ir::Type;
using ir::ValueId;

constexpr size_t kVariables = 5;
using State = std::array<ValueId, kVariables>;

class Generator {
  public:
    explicit Generator(uint64_t seed) : random_(seed), builder_(program_) {}

    ir::Program run() {
        program_.stage = ir::Stage::fragment;
        for (uint16_t k = 0; k < 3; ++k) program_.inputs.push_back(slot(k));
        for (uint16_t k = 0; k < 6; ++k) program_.outputs.push_back(slot(k));
        ir::Resource uniform;
        uniform.readOnly = true;
        program_.resources.push_back(uniform);
        program_.localWords = 8;
        place(newBlock(false));
        State state;
        for (uint32_t k = 0; k < kVariables; ++k) {
            state[k] = k < 3 ? builder_.append(Op::input, Type::i32, {}, k) : integer(random_() % 20);
        }
        statements(state, 3);
        for (uint32_t k = 0; k < kVariables; ++k) builder_.append(Op::storeOutput, Type::none, {state[k]}, k);
        builder_.ret();
        finish();
        ir::analyse(program_);
        return std::move(program_);
    }

  private:
    struct Phi {
        ValueId result;
        std::vector<ValueId> incoming;
    };
    struct BlockFacts {
        std::vector<Phi> phis;
        State state{};  // the variables at a block with phis
    };
    struct Loop {
        BlockId header, exit;
        ValueId counter = 0;
    };

    static ir::InterfaceSlot slot(uint16_t location) {
        ir::InterfaceSlot s;
        s.location = location;
        s.type = Type::i32;
        s.interpolation = ir::Interpolation::flat;
        return s;
    }
    uint32_t chance(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
    ValueId integer(uint32_t value) { return builder_.constant(Type::i32, value); }

    /// A block; with phis it joins the variables (and a loop's counter as one more).
    BlockId newBlock(bool joins, bool counter = false) {
        const BlockId block = builder_.newBlock();
        facts_.resize(block + 1);
        if (!joins) return block;
        for (size_t k = 0; k < kVariables + (counter ? 1 : 0); ++k) {
            const ValueId value = program_.newValue(Type::i32);
            facts_[block].phis.push_back({value, {}});
            if (k < kVariables) facts_[block].state[k] = value;
        }
        return block;
    }
    void place(BlockId block) {
        order_.push_back(block);
        builder_.setBlock(block);
    }
    /// Records what an edge that was just added carries.
    void carry(BlockId to, const State& state, ValueId counter = 0) {
        auto& phis = facts_[to].phis;
        for (size_t k = 0; k < phis.size(); ++k) phis[k].incoming.push_back(k < kVariables ? state[k] : counter);
    }
    void jump(BlockId to, const State& state, ValueId counter = 0) {
        builder_.jump(to);
        carry(to, state, counter);
    }

    ValueId any(const State& state) { return state[chance(kVariables)]; }
    ValueId uniform() {
        const ValueId zero = integer(0);
        return builder_.append(Op::loadBuffer, Type::i32, {zero, integer(4 * chance(kUniformWords))}, 0);
    }
    ValueId operand(const State& state) {
        const uint32_t kind = chance(8);
        return kind == 0 ? integer(static_cast<uint32_t>(random_() % 100)) : kind == 1 ? uniform() : any(state);
    }
    ValueId condition(const State& state) {
        const ValueId a = chance(4) == 0 ? uniform() : operand(state), b = operand(state);
        static constexpr Op kOps[] = {Op::slt, Op::ult, Op::ieq, Op::sle, Op::ine};
        if (chance(3) == 0) {
            const ValueId bit = builder_.append(Op::iand, Type::i32, {a, integer(1u << chance(3))});
            return builder_.append(Op::ine, Type::b1, {bit, integer(0)}, static_cast<uint64_t>(Type::i32));
        }
        return builder_.append(kOps[chance(5)], Type::b1, {a, b}, static_cast<uint64_t>(Type::i32));
    }
    ValueId expression(const State& state) {
        static constexpr Op kOps[] = {Op::iadd, Op::isub, Op::imul, Op::ixor, Op::iand,
                                      Op::ior,  Op::shl,  Op::lshr, Op::smin};
        switch (chance(7)) {
            case 0:
                return builder_.append(Op::select, Type::i32, {condition(state), operand(state), operand(state)});
            case 1: {  // a sum of products in float
                ValueId sum = 0;
                const uint32_t terms = 1 + chance(5);
                for (uint32_t k = 0; k < terms; ++k) {
                    const ValueId product = builder_.append(Op::fmul, Type::f32, {real(state), real(state)});
                    sum = k == 0 ? product : builder_.append(Op::fadd, Type::f32, {sum, product});
                }
                if (chance(2) == 0) sum = builder_.append(Op::fsub, Type::f32, {real(state), sum});
                return builder_.append(Op::ftos, Type::i32, {sum}, static_cast<uint64_t>(Type::f32));
            }
            case 2: {
                const ValueId index = builder_.append(Op::iand, Type::i32, {operand(state), integer(15)});
                if (chance(2) == 0) return builder_.append(Op::loadLocal, Type::i32, {index}, uint64_t{8} << 32);
                builder_.append(Op::storeLocal, Type::none, {index, operand(state)}, uint64_t{8} << 32);
                return operand(state);
            }
            default:
                return builder_.append(kOps[chance(9)], Type::i32, {operand(state), operand(state)});
        }
    }
    ValueId real(const State& state) {
        return builder_.append(Op::stof, Type::f32, {operand(state)}, static_cast<uint64_t>(Type::i32));
    }

    /// Statements at the end of the current block; false if the block has ended for good.
    bool statements(State& state, uint32_t depth) {
        const uint32_t count = 1 + chance(4);
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t kind = depth == 0 ? 0 : chance(10);
            if (kind < 4) {
                state[chance(kVariables)] = expression(state);
            } else if (kind < 6) {
                conditional(state, depth);
            } else if (kind < 8) {
                loop(state, depth);
            } else if (kind == 8) {
                choice(state, depth);
            } else {
                std::swap(state[chance(kVariables)], state[chance(kVariables)]);
                if (chance(3) == 0) builder_.append(Op::storeOutput, Type::none, {any(state)}, 5);
                if (chance(6) == 0) builder_.append(Op::demote, Type::none, {});
            }
        }
        return true;
    }

    /// What the arm of a conditional may do at its end; true if it ended.
    bool leaveEarly(const State& state) {
        const uint32_t kind = chance(12);
        if (kind == 0) {
            builder_.kill();
        } else if (kind == 1) {
            builder_.ret();
        } else if (kind < 4 && !loops_.empty()) {
            jump(loops_.back().exit, state);
        } else if (kind < 6 && !loops_.empty()) {
            nextRound(state);
        } else {
            return false;
        }
        return true;
    }
    void nextRound(const State& state) {
        const ValueId next = builder_.append(Op::iadd, Type::i32, {loops_.back().counter, integer(1)});
        jump(loops_.back().header, state, next);
    }

    void conditional(State& state, uint32_t depth) {
        const ValueId c = condition(state);
        const BlockId yes = newBlock(false), merge = newBlock(true);
        const bool hasElse = chance(2) == 0;
        const BlockId no = hasElse ? newBlock(false) : merge;
        builder_.branch(c, yes, no);
        if (!hasElse) carry(merge, state);
        State yesState = state;
        place(yes);
        statements(yesState, depth - 1);
        // Without an else the merge block has a way in already; else one arm must reach it.
        if (!(leaveEarly(yesState))) jump(merge, yesState);
        if (hasElse) {
            State noState = state;
            place(no);
            statements(noState, depth - 1);
            jump(merge, noState);
        }
        place(merge);
        state = facts_[merge].state;
    }

    void loop(State& state, uint32_t depth) {
        const BlockId header = newBlock(true, true), body = newBlock(false), exit = newBlock(true);
        jump(header, state, integer(0));
        const size_t first = order_.size();
        place(header);
        State inside = facts_[header].state;
        const ValueId counter = facts_[header].phis.back().result;
        const ValueId limit = builder_.append(Op::iand, Type::i32, {operand(inside), integer(3)});
        const ValueId going = builder_.append(Op::ult, Type::b1, {counter, limit}, static_cast<uint64_t>(Type::i32));
        builder_.branch(going, body, exit);
        carry(exit, inside);
        loops_.push_back({header, exit, counter});
        place(body);
        statements(inside, depth - 1);
        if (chance(2) == 0) std::swap(inside[0], inside[1]);
        nextRound(inside);
        loops_.pop_back();
        loopSpans_.push_back({first, order_.size()});
        place(exit);
        state = facts_[exit].state;
    }

    void choice(State& state, uint32_t depth) {
        const ValueId selector = builder_.append(Op::iand, Type::i32, {operand(state), integer(7)});
        const BlockId a = newBlock(false), b = newBlock(false), merge = newBlock(true);
        const int32_t cases[] = {1, 2, 5, 6};
        const BlockId targets[] = {a, b, merge, merge};
        const BlockId otherwise = merge;
        builder_.switchOn(selector, otherwise, cases, targets);
        // Edges in the order of the merge block's predecessors; the values need not differ.
        for (int k = 0; k < 3; ++k) carry(merge, state);
        for (const BlockId arm : {a, b}) {
            State armState = state;
            place(arm);
            statements(armState, depth - 1);
            jump(merge, armState);
        }
        place(merge);
        state = facts_[merge].state;
    }

    /// Puts phis in front, and blocks in the order in which they were placed.
    void finish() {
        std::vector<BlockId> place(program_.blocks.size());
        for (size_t k = 0; k < order_.size(); ++k) place[order_[k]] = static_cast<BlockId>(k);
        std::vector<ir::Block> blocks;
        for (const BlockId old : order_) {
            ir::Block block = std::move(program_.blocks[old]);
            std::vector<ir::Inst> insts;
            for (const Phi& phi : facts_[old].phis) {
                ir::Inst inst;
                inst.op = Op::phi;
                inst.type = Type::i32;
                inst.result = phi.result;
                inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
                inst.operandCount = static_cast<uint16_t>(phi.incoming.size());
                program_.operands.insert(program_.operands.end(), phi.incoming.begin(), phi.incoming.end());
                insts.push_back(inst);
            }
            insts.insert(insts.end(), block.insts.begin(), block.insts.end());
            block.insts = std::move(insts);
            for (BlockId& b : block.successors) b = place[b];
            for (BlockId& b : block.predecessors) b = place[b];
            blocks.push_back(std::move(block));
        }
        for (const auto& [begin, end] : loopSpans_) {
            blocks[begin].loopHeader = true;
            blocks[begin].loopEnd = static_cast<BlockId>(end);
        }
        program_.blocks = std::move(blocks);
    }

    std::mt19937_64 random_;
    ir::Program program_;
    ir::Builder builder_;
    std::vector<BlockFacts> facts_;
    std::vector<BlockId> order_;
    std::vector<Loop> loops_;
    std::vector<std::pair<size_t, size_t>> loopSpans_;
};

}  // namespace

ir::Program randomProgram(uint64_t seed) {
    return Generator(seed).run();
}

}  // namespace vernier::test
