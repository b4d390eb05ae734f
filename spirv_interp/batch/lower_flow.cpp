// Blocks, edges and phis to masks, jumps and masked moves.
//
// Every block but the first has a mask slot: the lanes that arrive by its edges. `enter` makes them the
// current lanes, or jumps over the block if there are none; the terminator hands them on. A back edge fills
// the slot of the loop's header while the loop runs, and `repeat` behind the loop's last block goes round as
// long as that slot is not empty. Phis are moves at the ends of the predecessors, for the lanes of the edge.
#include <algorithm>

#include "spirv_interp/batch/fuse.h"
#include "spirv_interp/batch/lowerer.h"

namespace vernier::batch {

/// Blocks that continue the block before them under the same mask, and those that all lanes run.
void Lowerer::planBlocks() {
    const auto count = static_cast<ir::BlockId>(program_.blocks.size());
    fallsIn_.assign(count, false);
    full_.assign(count, false);
    endsLoop_.assign(count, false);
    endLabels_.resize(count);
    loopLabels_.resize(count);
    headLabels_.resize(count);
    bodyLabels_.resize(count);
    for (ir::BlockId b = 0; b < count; ++b) {
        const ir::Block& block = program_.blocks[b];
        fallsIn_[b] = b > 0 && !block.loopHeader && block.predecessors.size() == 1 && block.predecessors[0] == b - 1 &&
                      program_.blocks[b - 1].insts.back().op == ir::Op::jump &&
                      facts_.cfg.loop[b] == facts_.cfg.loop[b - 1];
        full_[b] = b == 0 || (fallsIn_[b] && full_[b - 1]);
        if (block.loopHeader) endsLoop_[block.loopEnd - 1] = true;
        endLabels_[b] = newLabel();
        loopLabels_[b] = newLabel();
        headLabels_[b] = newLabel();
        bodyLabels_[b] = newLabel();
    }
    code_.masks = 1 + count;
}

/// An output that is stored once, where every lane that is not discarded passes, needs no row of its own.
void Lowerer::planOutputs() {
    outputPlans_.resize(program_.outputs.size());
    uint32_t returns = 0;
    ir::BlockId returning = 0;
    for (ir::BlockId b = 0; b < program_.blocks.size(); ++b) {
        if (program_.blocks[b].insts.back().op == ir::Op::ret) {
            ++returns;
            returning = b;
        }
    }
    std::vector<bool> zeroFirst(program_.outputs.size());
    for (ir::BlockId b = 0; b < program_.blocks.size(); ++b) {
        for (const ir::Inst& inst : program_.blocks[b].insts) {
            if (inst.op != ir::Op::storeOutput) continue;
            OutputPlan& plan = outputPlans_[inst.imm];
            const bool everyLane = full_[b] || (returns == 1 && b == returning);
            if (plan.stores == 0) zeroFirst[inst.imm] = !full_[b];
            plan.alias = plan.stores == 0 && everyLane && facts_.cfg.loop[b] == ir::kNoIndex;
            ++plan.stores;
        }
    }
    for (uint32_t k = 0; k < program_.outputs.size(); ++k) {
        if (outputPlans_[k].stores == 0) continue;
        code_.outputs[k] = newRegister(false);
        // Lanes that do not come past a store: zero, so that nothing depends on what was in the row before.
        if (zeroFirst[k] && !outputPlans_[k].alias) {
            emit(Op::broadcast, {Operand::write(code_.outputs[k]), Operand::scalar(scalars_.constant(0, false))});
        }
    }
}

std::vector<Move> Lowerer::movesOf(ir::BlockId from, size_t successor) {
    const ir::Block& block = program_.blocks[from];
    const ir::BlockId to = block.successors[successor];
    // The n-th edge from `from` to `to` is the n-th entry of `from` among the predecessors of `to`.
    const auto earlier =
        std::count(block.successors.begin(), block.successors.begin() + static_cast<ptrdiff_t>(successor), to);
    const auto& predecessors = program_.blocks[to].predecessors;
    size_t edge = 0;
    for (auto left = earlier; edge < predecessors.size(); ++edge) {
        if (predecessors[edge] == from && left-- == 0) break;
    }
    std::vector<Move> moves;
    for (const ir::Inst& phi : program_.blocks[to].insts) {
        if (phi.op != ir::Op::phi) break;
        const ir::ValueId source = program_.operandsOf(phi)[edge];
        if (isScalar(phi.result)) {
            moves.push_back({Operand::writeScalar(scalarOf(phi.result)), operandOf(source)});
            continue;
        }
        const uint32_t reg = registers_[phi.result];
        for (uint8_t word = 0; word <= (ir::isWide(phi.type) ? 1 : 0); ++word) {
            moves.push_back({Operand::write(reg, word), wordOf(source, word)});
        }
    }
    return moves;
}

void Lowerer::emitMoves(std::vector<Move> moves, uint32_t mask) {
    sequentialise(
        std::move(moves),
        [&](const Move& move) {
            const bool unmasked = move.to.isScalar() || (full_[block_] && mask == kCurrentMask);
            if (unmasked) return emitMove(move.to, move.from);
            emit(move.from.isScalar() ? Op::broadcastMasked : Op::copyMasked,
                 {move.to, move.from, Operand::mask(mask)});
        },
        [&](const Operand& saved) {
            if (saved.isScalar()) {
                const uint32_t temporary = scalars_.reserve(false);
                emit(Op::moveScalar, {Operand::writeScalar(temporary), Operand::scalar(saved.id)});
                return Operand::scalar(temporary);
            }
            const uint32_t temporary = newRegister(false);
            emit(Op::copy, {Operand::write(temporary), Operand::read(saved.id, saved.word)});
            return Operand::read(temporary);
        });
}

uint32_t Lowerer::edgeMask(ir::BlockId from, size_t successor) {
    const ir::BlockId to = program_.blocks[from].successors[successor];
    const bool moves = program_.blocks[to].insts.front().op == ir::Op::phi;
    return moves ? code_.masks++ : maskOf(to);
}

void Lowerer::lowerEdge(ir::BlockId from, size_t successor, uint32_t mask) {
    const ir::BlockId to = program_.blocks[from].successors[successor];
    if (mask == maskOf(to)) return;
    const uint32_t label = newLabel();
    emit(Op::skipEmpty, {Operand::mask(mask), Operand::label(label)});
    emitMoves(movesOf(from, successor), mask);
    emit(Op::follow, {Operand::mask(maskOf(to)), Operand::mask(mask)});
    bind(label);
}

void Lowerer::lowerTerminator(ir::BlockId b) {
    const ir::Block& block = program_.blocks[b];
    const ir::Inst& last = block.insts.back();
    line_ = last.line;
    const auto operands = program_.operandsOf(last);
    switch (last.op) {
        case ir::Op::jump: {
            emitMoves(movesOf(b, 0), kCurrentMask);
            const ir::BlockId to = block.successors[0];
            if (to == b + 1 && fallsIn_[to]) return;
            const bool goesRound = to == facts_.cfg.loop[b] && program_.blocks[to].loopEnd == b + 1;
            if (goesRound || isNext(b, to)) {
                emit(goesRound ? Op::again : Op::leaveInto,
                     {Operand::mask(maskOf(to)), Operand::label(bodyLabels_[to])});
            } else {
                emit(Op::leave, {Operand::mask(maskOf(to))});
            }
            return;
        }
        case ir::Op::branch: {
            const Operand condition = operandOf(operands[0]);
            const uint32_t yes = edgeMask(b, 0), no = edgeMask(b, 1);
            const bool into = entersNext(b, 0), past = !into && entersNext(b, 1), scalar = condition.isScalar();
            std::vector<Operand> split{condition, Operand::mask(yes), Operand::mask(no)};
            if (into || past) split.push_back(Operand::label(bodyLabels_[b + 1]));
            emit(into   ? (scalar ? Op::splitScalarInto : Op::splitInto)
                 : past ? (scalar ? Op::splitScalarPast : Op::splitPast)
                        : (scalar ? Op::splitScalar : Op::split),
                 std::move(split));
            lowerEdge(b, 0, yes);
            lowerEdge(b, 1, no);
            return;
        }
        case ir::Op::switchOn: {
            const Operand selector = operandOf(operands[0]);
            std::vector<uint32_t> masks(block.successors.size());
            for (size_t k = 0; k < block.cases.size(); ++k) {
                masks[k + 1] = edgeMask(b, k + 1);
                const uint32_t wanted = scalars_.constant(static_cast<uint32_t>(block.cases[k]), false);
                emit(Op::choose, {selector, Operand::scalar(wanted), Operand::mask(masks[k + 1])});
            }
            masks[0] = edgeMask(b, 0);
            emit(Op::leave, {Operand::mask(masks[0])});
            for (size_t k = 0; k < masks.size(); ++k) lowerEdge(b, k, masks[k]);
            return;
        }
        case ir::Op::kill:
            emit(Op::discard, {});
            return;
        default:
            return;  // ret: the lanes go nowhere
    }
}

void Lowerer::lowerBatch() {
    const auto count = static_cast<ir::BlockId>(program_.blocks.size());
    fusions_ = Fusions(program_, facts_.definition, facts_.uses, facts_.scalar);
    stores_ = JoinedStores(program_, facts_.definition, facts_.uses, facts_.scalar);
    planBlocks();
    planOutputs();
    // Phis first: edges name them before their block comes. A loop's own phis live through all of its rounds.
    for (ir::BlockId b = 0; b < count; ++b) {
        const uint32_t loop = facts_.cfg.loop[b];
        loop_ = program_.blocks[b].loopHeader ? facts_.cfg.loopParent[b] : loop;
        for (const ir::Inst& inst : program_.blocks[b].insts) {
            if (inst.op != ir::Op::phi) break;
            if (isScalar(inst.result)) continue;
            const uint32_t reg = registerOf(inst.result);
            if (program_.blocks[b].loopHeader) code_.registers[reg].phiOf = b;
        }
    }
    std::vector<size_t> open;  // indices into code_.loops
    for (ir::BlockId b = 0; b < count; ++b) {
        const ir::Block& block = program_.blocks[b];
        block_ = b;
        spread_.clear();
        if (block.loopHeader) {
            MachineLoop loop;
            loop.header = b;
            loop.parent = facts_.cfg.loopParent[b];
            loop.begin = static_cast<uint32_t>(code_.insts.size());
            loop.backEdges = static_cast<uint32_t>(
                std::count_if(block.predecessors.begin(), block.predecessors.end(), [&](auto p) { return p >= b; }));
            open.push_back(code_.loops.size());
            code_.loops.push_back(loop);
        }
        loop_ = facts_.cfg.loop[b];
        if (b > 0 && !fallsIn_[b]) {
            bind(headLabels_[b]);
            ir::BlockId last = b;
            while (last + 1 < count && fallsIn_[last + 1]) ++last;
            const uint32_t skip = block.loopHeader ? loopLabels_[b] : endLabels_[last];
            emit(Op::enter, {Operand::mask(maskOf(b)), Operand::label(skip)});
            bind(bodyLabels_[b]);
        }
        for (const ir::Inst& inst : block.insts) lowerInst(inst);
        lowerTerminator(b);
        bind(endLabels_[b]);
        while (!open.empty() && program_.blocks[code_.loops[open.back()].header].loopEnd == b + 1) {
            MachineLoop& loop = code_.loops[open.back()];
            emit(Op::repeat, {Operand::mask(maskOf(loop.header)), Operand::label(headLabels_[loop.header])});
            loop.end = static_cast<uint32_t>(code_.insts.size() - 1);
            bind(loopLabels_[loop.header]);
            open.pop_back();
        }
    }
    emit(Op::end, {});
}

}  // namespace vernier::batch
