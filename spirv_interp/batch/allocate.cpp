#include "spirv_interp/batch/allocate.h"

#include <algorithm>
#include <numeric>

#include "spirv_interp/batch/accumulate.h"

namespace vernier::batch {
namespace {

// Instruction k reads at time 2k and writes at 2k + 1, so that a result may take the row of an operand that
// ends there.
constexpr uint32_t readTime(uint32_t position) {
    return 2 * position;
}
constexpr uint32_t writeTime(uint32_t position) {
    return 2 * position + 1;
}

struct Interval {
    uint32_t begin = kNone, end = 0;
    bool alive() const { return begin != kNone; }
    void cover(uint32_t time) {
        begin = std::min(begin, time);
        end = std::max(end, time);
    }
    void cover(const Interval& other) {
        begin = std::min(begin, other.begin);
        end = std::max(end, other.end);
    }
};

class Allocator {
  public:
    Allocator(MachineCode& code, const HandlerTable& handlers)
        : code_(code), handlers_(handlers), intervals_(code.registers.size()), parent_(code.registers.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    Allocation run() {
        findIntervals();
        coverLoops();
        for (uint32_t k = 0; k < code_.insts.size(); ++k) coalesce(k);
        useAccumulator(code_, handlers_, [this](uint32_t reg) { return find(reg); });
        for (const MachineInst& inst : code_.insts) {
            if (!inst.operands.empty() && inst.operands[0].kind == Operand::Kind::accumulator &&
                inst.operands[0].written) {
                intervals_[inst.operands[0].id] = {};
            }
        }
        return scan();
    }

  private:
    uint32_t find(uint32_t reg) {
        while (parent_[reg] != reg) reg = parent_[reg] = parent_[parent_[reg]];
        return reg;
    }

    void findIntervals() {
        facts_.resize(code_.registers.size());
        for (uint32_t k = 0; k < code_.insts.size(); ++k) {
            const MachineInst& inst = code_.insts[k];
            const bool masked = inst.op == Op::copyMasked || inst.op == Op::broadcastMasked;
            const auto visit = [&](const Operand& operand) {
                if (!operand.isRow()) return;
                Interval& interval = intervals_[operand.id];
                if (operand.written) {
                    interval.cover(writeTime(k));
                    RegisterFacts& facts = facts_[operand.id];
                    ++facts.writes;
                    facts.lastWrite = k;
                    facts.masked |= masked;
                } else {
                    interval.cover(inst.inPlace ? readTime(k) : writeTime(k));
                    facts_[operand.id].lastRead = k;
                }
            };
            for (const Operand& operand : inst.operands) visit(operand);
            for (const Operand& operand : inst.hidden) visit(operand);
        }
        // An input may itself be an output: then nothing reads or writes it, but it is there from beginning
        // to end.
        for (const uint32_t reg : code_.outputs) {
            if (reg != kNone) intervals_[reg].cover(writeTime(static_cast<uint32_t>(code_.insts.size())));
        }
        for (const uint32_t reg : code_.inputs) {
            if (reg != kNone && intervals_[reg].alive()) intervals_[reg].cover(0);
        }
    }

    bool isInside(uint32_t loop, uint32_t header) const {
        for (; loop != kNone; loop = parentOf(loop)) {
            if (loop == header) return true;
        }
        return false;
    }
    uint32_t parentOf(uint32_t header) const {
        for (const MachineLoop& loop : code_.loops) {
            if (loop.header == header) return loop.parent;
        }
        return kNone;
    }

    /// Growing for one loop can make an interval meet another: inner loops come later in the list, outer ones
    /// contain what they grow into, and siblings are met by another round.
    void coverLoops() {
        for (uint32_t reg = 0; reg < intervals_.size(); ++reg) {
            Interval& interval = intervals_[reg];
            for (bool grown = interval.alive(); grown;) {
                grown = false;
                for (const MachineLoop& loop : code_.loops) {
                    const uint32_t begin = readTime(loop.begin), end = writeTime(loop.end);
                    const bool meets = interval.begin <= end && interval.end >= begin;
                    const bool covers = interval.begin <= begin && interval.end >= end;
                    if (!meets || covers || isInside(code_.registers[reg].loop, loop.header)) continue;
                    interval.cover(Interval{begin, end});
                    grown = true;
                }
            }
        }
    }

    /// Joins the two registers of a masked move if no lane could tell.
    void coalesce(uint32_t position) {
        MachineInst& inst = code_.insts[position];
        if (inst.op != Op::copyMasked && inst.op != Op::copy) return;
        const uint32_t to = find(inst.operands[0].id), from = find(inst.operands[1].id);
        if (code_.registers[to].wide || code_.registers[from].wide) return;
        if (to == from) {
            inst.dead = true;
            return;
        }
        if (!canJoin(position, inst.operands[0].id, inst.operands[1].id)) return;
        parent_[from] = to;
        intervals_[to].cover(intervals_[from]);
        inst.dead = true;
    }

    bool canJoin(uint32_t position, uint32_t to, uint32_t from) {
        const Interval& source = intervals_[find(from)];
        const Interval& target = intervals_[find(to)];
        if (source.end != readTime(position)) return false;
        // The source ends where the target begins: nothing of the target exists yet that the source could
        // destroy.
        if (target.begin == writeTime(position)) return true;
        // The next value of a loop's phi, when the loop has one way back: it is computed for all lanes after
        // the phi was read for the last time in this round, and lanes that left the loop do not read the phi
        // again.
        if (find(from) != from || facts_[from].writes != 1 || facts_[from].masked) return false;
        const MachineLoop* loop = loopOfPhi(to, position);
        if (loop == nullptr || loop->backEdges != 1 || code_.registers[from].loop != loop->header) return false;
        return facts_[to].lastRead <= facts_[from].lastWrite && facts_[from].lastWrite >= loop->begin;
    }

    /// The innermost loop around a move, if the move's target is one of its phis.
    const MachineLoop* loopOfPhi(uint32_t phi, uint32_t position) const {
        const MachineLoop* innermost = nullptr;
        for (const MachineLoop& loop : code_.loops) {
            if (position >= loop.begin && position <= loop.end) innermost = &loop;
        }
        return innermost != nullptr && code_.registers[phi].phiOf == innermost->header ? innermost : nullptr;
    }

    Allocation scan() {
        Allocation allocation;
        allocation.row.assign(code_.registers.size(), kNone);
        std::vector<uint32_t> order;
        for (uint32_t reg = 0; reg < parent_.size(); ++reg) {
            if (find(reg) == reg && intervals_[reg].alive()) order.push_back(reg);
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return intervals_[a].begin < intervals_[b].begin; });
        std::vector<uint32_t> freeFrom;  // by row: the last time it is in use, plus one
        for (const uint32_t reg : order) {
            const Interval& interval = intervals_[reg];
            const uint32_t width = code_.registers[reg].wide ? 2 : 1;
            uint32_t row = 0;
            const auto fits = [&] {
                for (uint32_t k = row; k < row + width && k < freeFrom.size(); ++k) {
                    if (freeFrom[k] > interval.begin) return false;
                }
                return true;
            };
            while (!fits()) ++row;
            if (freeFrom.size() < row + width) freeFrom.resize(row + width);
            for (uint32_t k = row; k < row + width; ++k) freeFrom[k] = interval.end + 1;
            allocation.row[reg] = row;
        }
        for (uint32_t reg = 0; reg < parent_.size(); ++reg) allocation.row[reg] = allocation.row[find(reg)];
        allocation.rows = static_cast<uint32_t>(freeFrom.size());
        return allocation;
    }

    struct RegisterFacts {
        uint32_t writes = 0, lastWrite = 0, lastRead = 0;
        bool masked = false;
    };

    MachineCode& code_;
    const HandlerTable& handlers_;
    std::vector<Interval> intervals_;
    std::vector<RegisterFacts> facts_;
    std::vector<uint32_t> parent_;  // union-find
};

}  // namespace

Allocation allocate(MachineCode& code, const HandlerTable& handlers) {
    return Allocator(code, handlers).run();
}

}  // namespace vernier::batch
