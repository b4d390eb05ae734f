#include <algorithm>
#include <optional>
#include <unordered_map>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/fold.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

constexpr uint32_t kMaxCounted = 256;  // trips
constexpr uint32_t kMaxTrips = 32;     // of a loop that goes away
constexpr size_t kMaxInsts = 1024;     // of all copies together
// Of all copies of a loop of which at least one value in kConstantPart is known in every trip.
constexpr size_t kMaxConstantInsts = 2048;
constexpr size_t kConstantPart = 16;
// Of a loop that stays, of which one round does the work of several: so small that keeping it up costs something.
constexpr size_t kMaxSmallInsts = 64;
constexpr uint32_t kRounds = 4;
constexpr uint32_t kMaxDepth = 32;  // of the expressions that decide
constexpr uint32_t kMaxLoops = 64;  // of a program: each is a pass over all of it

/// An innermost loop that only its header leaves, entered and repeated by one edge each.
struct Loop {
    BlockId header = 0, end = 0;  // blocks [header, end)
    BlockId latch = 0, exit = 0;
    uint32_t entryOperand = 0, latchOperand = 0;  // of the header's phis
    size_t staySuccessor = 0;                     // of the header
    uint32_t trips = 0;                           // how often the header goes on into the loop
    uint32_t rounds = 0;                          // put into one; 0: all of them, and the loop goes away
};

class Unroller {
  public:
    explicit Unroller(Program& program) : program_(program), definition_(program.valueTypes.size(), nullptr) {
        for (const Block& block : program.blocks)
            for (const Inst& inst : block.insts)
                if (opInfo(inst.op).results == 1) definition_[inst.result] = &inst;
    }

    /// The last loop that can be unrolled: inner loops stand behind their outer ones.
    std::optional<Loop> find() {
        for (auto b = static_cast<BlockId>(program_.blocks.size()); b-- > 0;) {
            if (!program_.blocks[b].loopHeader) continue;
            std::optional<Loop> loop = shapeOf(b);
            if (!loop || !countTrips(*loop)) continue;
            size_t insts = 0;
            for (BlockId i = loop->header; i < loop->end; ++i) insts += program_.blocks[i].insts.size();
            if (loop->trips <= kMaxTrips && insts * std::max(loop->trips, 1u) <= kMaxInsts) return loop;
            loop->rounds = kRounds;
            if (loop->trips % kRounds == 0 && insts <= kMaxSmallInsts && loop->latch != loop->header) return loop;
        }
        return std::nullopt;
    }

    /// The last loop of which enough is known.
    std::optional<Loop> findConstant() {
        for (auto b = static_cast<BlockId>(program_.blocks.size()); b-- > 0;) {
            if (!program_.blocks[b].loopHeader) continue;
            std::optional<Loop> loop = shapeOf(b);
            if (!loop || !countTrips(*loop) || loop->trips > kMaxTrips) continue;
            size_t insts = 0, known = 0;
            for (BlockId i = loop->header; i < loop->end; ++i) {
                for (const Inst& inst : program_.blocks[i].insts) {
                    ++insts;
                    // Of the trip that does not take place any more: what is known there was known in all before.
                    known += opInfo(inst.op).results == 1 && evaluate(inst.result, kMaxDepth) ? 1 : 0;
                }
            }
            if (insts * loop->trips <= kMaxConstantInsts && known * kConstantPart >= insts) return loop;
        }
        return std::nullopt;
    }

    void unroll(const Loop& loop);
    void repeat(const Loop& loop);

  private:
    std::optional<Loop> shapeOf(BlockId header) const;
    bool countTrips(Loop& loop);
    std::optional<uint64_t> evaluate(ValueId value, uint32_t depth);
    void nameThemselves();
    std::vector<Inst> headerPhis(const Loop& loop) const;
    void setPhis(const std::vector<Inst>& phis, uint32_t operand);
    Block copyBlock(const Loop& loop, BlockId from, uint32_t trip, bool last);
    void shiftOthers(const Loop& loop, BlockId shift, BlockId exiting);

    Program& program_;
    std::vector<const Inst*> definition_;
    std::unordered_map<ValueId, std::optional<uint64_t>> known_;  // in the trip that is counted
    std::vector<ValueId> map_;                                    // in the trip that is copied
};

std::optional<Loop> Unroller::shapeOf(BlockId header) const {
    const Block& block = program_.blocks[header];
    Loop loop;
    loop.header = header;
    loop.end = block.loopEnd;
    if (block.predecessors.size() != 2 || block.insts.back().op != Op::branch) return std::nullopt;
    loop.entryOperand = block.predecessors[0] < header ? 0 : 1;
    loop.latchOperand = 1 - loop.entryOperand;
    loop.latch = block.predecessors[loop.latchOperand];
    if (loop.latch < header || block.predecessors[loop.entryOperand] >= header) return std::nullopt;
    const auto inside = [&](BlockId b) { return b >= loop.header && b < loop.end; };
    loop.staySuccessor = inside(block.successors[0]) ? 0 : 1;
    loop.exit = block.successors[1 - loop.staySuccessor];
    if (!inside(block.successors[loop.staySuccessor]) || inside(loop.exit)) return std::nullopt;
    for (BlockId b = header + 1; b < loop.end; ++b) {
        const Block& body = program_.blocks[b];
        if (body.loopHeader || !std::all_of(body.successors.begin(), body.successors.end(), inside))
            return std::nullopt;
    }
    return loop;
}

/// The bits of a value that follows from constants alone, given the header's phis in known_.
std::optional<uint64_t> Unroller::evaluate(ValueId value, uint32_t depth) {
    if (const auto found = known_.find(value); found != known_.end()) return found->second;
    const Inst* inst = definition_[value];
    if (inst == nullptr || depth == 0) return std::nullopt;
    if (inst->op == Op::constant) return inst->imm;
    std::optional<uint64_t>& result = known_[value] = std::nullopt;
    constexpr uint32_t kMaxOperands = 4;
    if (opInfo(inst->op).kind != 'P' || inst->op == Op::phi || inst->operandCount == 0 ||
        inst->operandCount > kMaxOperands)
        return std::nullopt;
    uint64_t operands[kMaxOperands];
    for (uint32_t i = 0; i < inst->operandCount; ++i) {
        const std::optional<uint64_t> operand = evaluate(program_.operandsOf(*inst)[i], depth - 1);
        if (!operand) return std::nullopt;
        operands[i] = *operand;
    }
    // References into an unordered_map outlive insertions.
    return result = foldConstant(inst->op, inst->type, inst->imm, {operands, inst->operandCount});
}

bool Unroller::countTrips(Loop& loop) {
    const Block& header = program_.blocks[loop.header];
    const ValueId condition = program_.operandsOf(header.insts.back())[0];
    const auto phis = [&](auto&& visit) {
        for (const Inst& phi : header.insts) {
            if (phi.op != Op::phi) break;
            visit(phi, program_.operandsOf(phi));
        }
    };
    std::unordered_map<ValueId, std::optional<uint64_t>> next;
    known_.clear();
    phis([&](const Inst& phi, auto operands) { next[phi.result] = evaluate(operands[loop.entryOperand], kMaxDepth); });
    for (loop.trips = 0; loop.trips <= kMaxCounted; ++loop.trips) {
        known_ = next;
        const std::optional<uint64_t> stays = evaluate(condition, kMaxDepth);
        if (!stays) return false;
        if ((*stays != 0 ? 0u : 1u) != loop.staySuccessor) return true;
        phis([&](const Inst& phi, auto operands) {
            next[phi.result] = evaluate(operands[loop.latchOperand], kMaxDepth);
        });
    }
    return false;
}

void Unroller::nameThemselves() {
    map_.resize(program_.valueTypes.size());
    for (ValueId v = 0; v < map_.size(); ++v) map_[v] = v;
}

std::vector<Inst> Unroller::headerPhis(const Loop& loop) const {
    std::vector<Inst> phis;
    for (const Inst& inst : program_.blocks[loop.header].insts)
        if (inst.op == Op::phi) phis.push_back(inst);
    return phis;
}

/// The header's phis stand for one of their operands from now on, all at once.
void Unroller::setPhis(const std::vector<Inst>& phis, uint32_t operand) {
    std::vector<ValueId> values;
    for (const Inst& phi : phis) values.push_back(map_[program_.operandsOf(phi)[operand]]);
    for (size_t i = 0; i < phis.size(); ++i) map_[phis[i].result] = values[i];
}

/// A block of the loop as it runs in one trip, with map_ for the values. `last`: the header that finds the loop done;
/// it keeps the names of its values for those outside.
Block Unroller::copyBlock(const Loop& loop, BlockId from, uint32_t trip, bool last) {
    const BlockId blocks = loop.end - loop.header, first = loop.header + trip * blocks;
    const auto place = [&](BlockId b) { return first + (b - loop.header); };
    const Block& source = program_.blocks[from];
    Block copy;
    copy.cases = source.cases;
    for (const Inst& inst : source.insts) {
        if (from == loop.header && inst.op == Op::phi) continue;
        Inst& made = copy.insts.emplace_back(inst);
        made.firstOperand = static_cast<uint32_t>(program_.operands.size());
        for (uint32_t i = 0; i < inst.operandCount; ++i) {
            const ValueId operand = program_.operands[inst.firstOperand + i];
            program_.operands.push_back(map_[operand]);
        }
        const uint32_t results = opInfo(inst.op).results;
        if (results == 0 || last) continue;
        made.result = static_cast<ValueId>(program_.valueTypes.size());
        for (uint32_t r = 0; r < results; ++r) {
            const Type type = program_.valueTypes[inst.result + r];
            program_.valueTypes.push_back(type);
            map_[inst.result + r] = made.result + r;
        }
    }
    if (from == loop.header) {
        copy.insts.back().op = Op::jump;
        copy.insts.back().operandCount = 0;
        const BlockId stay = source.successors[loop.staySuccessor];
        copy.successors = {last ? loop.exit : stay == loop.header ? first + blocks : place(stay)};
        const BlockId latch = loop.latch - loop.header;
        copy.predecessors = {trip == 0 ? source.predecessors[loop.entryOperand] : first - blocks + latch};
        return copy;
    }
    for (const BlockId s : source.successors) copy.successors.push_back(s == loop.header ? first + blocks : place(s));
    for (const BlockId p : source.predecessors) copy.predecessors.push_back(place(p));
    return copy;
}

void Unroller::unroll(const Loop& loop) {
    const BlockId blocks = loop.end - loop.header, lastHeader = loop.header + loop.trips * blocks;
    const BlockId shift = loop.trips * blocks + 1 - blocks;  // of what stands behind the loop; may wrap around
    nameThemselves();
    const std::vector<Inst> phis = headerPhis(loop);
    std::vector<Block> copies;
    setPhis(phis, loop.entryOperand);
    for (uint32_t trip = 0; trip < loop.trips; ++trip) {
        for (BlockId b = loop.header; b < loop.end; ++b) copies.push_back(copyBlock(loop, b, trip, false));
        setPhis(phis, loop.latchOperand);
    }
    // The last header's own values have their old names again.
    std::vector<ValueId> replacement(program_.valueTypes.size(), kNoValue);
    for (const Inst& phi : phis) replacement[phi.result] = map_[phi.result];
    for (const Inst& inst : program_.blocks[loop.header].insts)
        for (uint32_t r = 0; inst.op != Op::phi && r < opInfo(inst.op).results; ++r)
            map_[inst.result + r] = inst.result + r;
    copies.push_back(copyBlock(loop, loop.header, loop.trips, true));
    replacement.resize(program_.valueTypes.size(), kNoValue);

    copies.back().successors[0] = loop.exit + shift;
    shiftOthers(loop, shift, lastHeader);
    auto& all = program_.blocks;
    const auto at = all.erase(all.begin() + loop.header, all.begin() + loop.end);
    all.insert(at, std::make_move_iterator(copies.begin()), std::make_move_iterator(copies.end()));
    replaceUses(program_, replacement);
}

/// The edges and loop ends of the blocks outside the loop when what stands behind it moves by `shift`. `exiting`: the
/// block that leaves the loop then.
void Unroller::shiftOthers(const Loop& loop, BlockId shift, BlockId exiting) {
    const auto moved = [&](BlockId b) { return b < loop.end ? b : b + shift; };
    for (BlockId b = 0; b < program_.blocks.size(); ++b) {
        Block& block = program_.blocks[b];
        if (b >= loop.header && b < loop.end) continue;
        for (BlockId& s : block.successors) s = moved(s);
        for (BlockId& p : block.predecessors) p = p == loop.header ? exiting : moved(p);
        if (block.loopHeader && block.loopEnd >= loop.end) block.loopEnd += shift;
    }
}

/// The loop stays, and goes round as many times less. The header asks once per round: in between the answer is known.
void Unroller::repeat(const Loop& loop) {
    const BlockId blocks = loop.end - loop.header, shift = (loop.rounds - 1) * blocks;
    nameThemselves();
    std::vector<Block> copies;
    const auto phis = headerPhis(loop);
    for (uint32_t round = 1; round < loop.rounds; ++round) {
        setPhis(phis, loop.latchOperand);
        for (BlockId b = loop.header; b < loop.end; ++b) copies.push_back(copyBlock(loop, b, round, false));
    }
    shiftOthers(loop, shift, loop.header);
    Block& header = program_.blocks[loop.header];
    Block& latch = program_.blocks[loop.latch];
    const BlockId lastLatch = loop.latch + shift;
    std::replace(latch.successors.begin(), latch.successors.end(), loop.header, loop.end);
    Block& last = copies[lastLatch - loop.end];
    std::replace(last.successors.begin(), last.successors.end(), loop.end + shift, loop.header);
    header.predecessors[loop.latchOperand] = lastLatch;
    header.successors[1 - loop.staySuccessor] = loop.exit + shift;
    header.loopEnd += shift;
    for (const Inst& phi : phis) {
        ValueId& operand = program_.operands[phi.firstOperand + loop.latchOperand];
        operand = map_[operand];
    }
    program_.blocks.insert(program_.blocks.begin() + loop.end, std::make_move_iterator(copies.begin()),
                           std::make_move_iterator(copies.end()));
}

}  // namespace

bool unrollLoops(Program& program) {
    for (uint32_t unrolled = 0; unrolled < kMaxLoops; ++unrolled) {
        Unroller unroller(program);
        const std::optional<Loop> loop = unroller.find();
        if (!loop) return unrolled > 0;
        if (loop->rounds == 0)
            unroller.unroll(*loop);
        else
            unroller.repeat(*loop);
    }
    return true;
}

bool unrollConstantLoops(Program& program) {
    for (uint32_t unrolled = 0; unrolled < kMaxLoops; ++unrolled) {
        Unroller unroller(program);
        const std::optional<Loop> loop = unroller.findConstant();
        if (!loop) return unrolled > 0;
        unroller.unroll(*loop);
    }
    return true;
}

}  // namespace vernier::ir
