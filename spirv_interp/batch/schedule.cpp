#include "spirv_interp/batch/schedule.h"

#include <algorithm>

#include "spirv_interp/batch/select.h"

namespace vernier::batch {
namespace {

/// Registers, then scalars; kNone for operands that are neither.
uint32_t placeOf(const MachineCode& code, const Operand& operand) {
    if (operand.isRow()) return operand.id;
    return operand.isScalar() ? static_cast<uint32_t>(code.registers.size()) + operand.id : kNone;
}

/// One stretch of movable instructions: a depth-first walk from the results that are needed further on, in their
/// order. Of the operands of an instruction the one that takes most rows to compute comes first (Sethi and Ullman,
/// "The Generation of Optimal Code for Arithmetic Expressions", JACM 17(4), 1970), and one that only this instruction
/// reads last.
class Region {
  public:
    Region(MachineCode& code, uint32_t begin, uint32_t end, const std::vector<uint32_t>& writes,
           const std::vector<uint32_t>& becomes, std::vector<uint32_t>& lastWriter)
        : code_(code),
          begin_(begin),
          nodes_(end - begin),
          writes_(writes),
          becomes_(becomes),
          lastWriter_(lastWriter) {}

    void run() {
        connect();
        deferNextRound();
        measure();
        std::vector<uint32_t> order;
        order.reserve(nodes_.size());
        for (uint32_t n = 0; n < nodes_.size(); ++n) {
            if (nodes_[n].users == 0) place(n, order);
        }
        std::vector<MachineInst> moved;
        moved.reserve(order.size());
        for (const uint32_t n : order) moved.push_back(std::move(code_.insts[begin_ + n]));
        std::move(moved.begin(), moved.end(), code_.insts.begin() + begin_);
    }

  private:
    struct Node {
        std::vector<uint32_t> before;   // must come earlier
        std::vector<uint32_t> readers;  // since its last write: whoever writes its register anew comes after them
        uint32_t users = 0;             // nodes that must come later
        uint32_t need = 1;              // rows, about
        bool placed = false;
    };

    /// Calls function(place, written) for every register and scalar of an instruction.
    template <class F>
    void forEachPlace(const MachineInst& inst, F&& function) const {
        const auto visit = [&](const Operand& operand) {
            if (const uint32_t place = placeOf(code_, operand); place != kNone) function(place, operand.written);
        };
        std::for_each(inst.operands.begin(), inst.operands.end(), visit);
        std::for_each(inst.hidden.begin(), inst.hidden.end(), visit);
    }

    void constrain(uint32_t earlier, uint32_t later) {
        std::vector<uint32_t>& before = nodes_[later].before;
        if (earlier == later || std::find(before.begin(), before.end(), earlier) != before.end()) return;
        before.push_back(earlier);
        ++nodes_[earlier].users;
    }

    void connect() {
        std::vector<std::pair<uint32_t, uint32_t>> readBefore;  // place, node: reads of values from outside
        for (uint32_t n = 0; n < nodes_.size(); ++n) {
            const MachineInst& inst = code_.insts[begin_ + n];
            forEachPlace(inst, [&](uint32_t place, bool written) {
                if (written) return;
                const uint32_t writer = lastWriter_[place];
                if (writer == kNone) {
                    if (writes_[place] > 1) readBefore.emplace_back(place, n);
                    return;
                }
                constrain(writer, n);
                nodes_[writer].readers.push_back(n);
            });
            forEachPlace(inst, [&](uint32_t place, bool written) {
                if (!written) return;
                uint32_t& writer = lastWriter_[place];
                if (writer == kNone) {
                    for (const auto& [read, reader] : readBefore) {
                        if (read == place) constrain(reader, n);
                    }
                } else {
                    constrain(writer, n);
                    for (const uint32_t reader : nodes_[writer].readers) constrain(reader, n);
                }
                writer = n;
            });
        }
        for (uint32_t n = 0; n < nodes_.size(); ++n) {
            forEachPlace(code_.insts[begin_ + n], [&](uint32_t place, bool written) {
                if (written) lastWriter_[place] = kNone;
            });
        }
    }

    bool reaches(uint32_t from, uint32_t to) const {
        constexpr size_t kMost = 256;
        std::vector<uint32_t> open{to}, seen{to};
        while (!open.empty()) {
            const uint32_t n = open.back();
            open.pop_back();
            for (const uint32_t b : nodes_[n].before) {
                // A walk that gets long says yes: nothing is lost but an order that would be nicer.
                if (b == from || seen.size() > kMost) return true;
                if (std::find(seen.begin(), seen.end(), b) != seen.end()) continue;
                seen.push_back(b);
                open.push_back(b);
            }
        }
        return false;
    }

    /// Puts the definition of what a place is about to become behind the readers of what it is.
    void deferNextRound() {
        std::vector<std::pair<uint32_t, uint32_t>> defined;  // place that it becomes, node
        for (uint32_t n = 0; n < nodes_.size(); ++n) {
            forEachPlace(code_.insts[begin_ + n], [&](uint32_t place, bool written) {
                if (written && becomes_[place] != kNone) defined.emplace_back(becomes_[place], n);
            });
        }
        for (const auto& value : defined) {
            // A lambda cannot capture a structured binding (P1091 came after Clang 14).
            const uint32_t place = value.first, definition = value.second;
            for (uint32_t n = 0; n < nodes_.size(); ++n) {
                bool reads = false;
                forEachPlace(code_.insts[begin_ + n],
                             [&](uint32_t p, bool written) { reads |= p == place && !written; });
                if (reads && n != definition && !reaches(definition, n)) constrain(n, definition);
            }
        }
    }

    /// The rows that a tree of values with one reader takes, in order of need; and the order of operands by it.
    void measure() {
        for (Node& node : nodes_) {
            std::stable_sort(node.before.begin(), node.before.end(), [&](uint32_t a, uint32_t b) {
                const bool aloneA = nodes_[a].users == 1, aloneB = nodes_[b].users == 1;
                return aloneA != aloneB ? aloneB : nodes_[a].need > nodes_[b].need;
            });
            uint32_t taken = 0;
            for (const uint32_t b : node.before) {
                if (nodes_[b].users == 1) node.need = std::max(node.need, nodes_[b].need + taken++);
            }
        }
    }

    /// Appends a node and what must come before it.
    void place(uint32_t root, std::vector<uint32_t>& order) {
        std::vector<std::pair<uint32_t, size_t>> open{{root, 0}};
        while (!open.empty()) {
            auto& [n, next] = open.back();
            if (next < nodes_[n].before.size()) {
                const uint32_t b = nodes_[n].before[next++];
                if (!nodes_[b].placed) {
                    nodes_[b].placed = true;
                    open.emplace_back(b, 0);
                }
            } else {
                order.push_back(n);
                open.pop_back();
            }
        }
    }

    MachineCode& code_;
    const uint32_t begin_;
    std::vector<Node> nodes_;
    const std::vector<uint32_t>& writes_;   // by place, in the whole code
    const std::vector<uint32_t>& becomes_;  // by place: where a move further on takes its value, or kNone
    std::vector<uint32_t>& lastWriter_;     // by place: a node of this region, or kNone
};

bool isMove(Op op) {
    return op == Op::copy || op == Op::copyMasked || op == Op::moveScalar;
}

/// Lets the next value of a phi be computed where a move behind would put it, if nobody can tell.
void foldScalarMoves(MachineCode& code, const std::vector<bool>& isTarget, const std::vector<uint32_t>& writes) {
    std::vector<uint32_t> reads;
    const auto countOf = [&](uint32_t scalar) -> uint32_t& {
        if (scalar >= reads.size()) reads.resize(scalar + 1);
        return reads[scalar];
    };
    for (const MachineInst& inst : code.insts) {
        for (const Operand& operand : inst.operands) {
            if (operand.isScalar() && !operand.written) ++countOf(operand.id);
        }
    }
    for (uint32_t k = 0; k < code.insts.size(); ++k) {
        MachineInst& move = code.insts[k];
        if (move.op != Op::moveScalar || countOf(move.operands[1].id) != 1) continue;
        const uint32_t to = move.operands[0].id, from = move.operands[1].id;
        if (writes[placeOf(code, move.operands[0])] < 2) continue;
        for (uint32_t j = k; !isTarget[j] && j-- > 0;) {
            MachineInst& inst = code.insts[j];
            const auto names = [&](uint32_t scalar, bool written) {
                return std::any_of(inst.operands.begin(), inst.operands.end(), [&](const Operand& operand) {
                    return operand.isScalar() && operand.id == scalar && operand.written == written;
                });
            };
            if (names(from, true)) {
                // Both are read before the result is written.
                inst.operands[0].id = to;
                move.dead = true;
                break;
            }
            const auto isLabel = [](const Operand& operand) { return operand.kind == Operand::Kind::label; };
            if (std::any_of(inst.operands.begin(), inst.operands.end(), isLabel)) break;
            if (names(to, true) || names(to, false)) break;
        }
    }
}

}  // namespace

void schedule(MachineCode& code) {
    std::vector<bool> isTarget(code.insts.size() + 1);
    for (const uint32_t label : code.labels) isTarget[label] = true;
    std::vector<uint32_t> writes;
    for (const MachineInst& inst : code.insts) {
        for (const Operand& operand : inst.operands) {
            const uint32_t place = placeOf(code, operand);
            if (place == kNone) continue;
            if (place >= writes.size()) writes.resize(place + 1);
            writes[place] += operand.written ? 1 : 0;
        }
    }
    writes.resize(std::max(writes.size(), code.registers.size()));
    std::vector<uint32_t> lastWriter(writes.size(), kNone), becomes(writes.size(), kNone);
    for (const MachineInst& inst : code.insts) {
        if (!isMove(inst.op)) continue;
        const uint32_t to = placeOf(code, inst.operands[0]), from = placeOf(code, inst.operands[1]);
        if (from != kNone && writes[to] > 1) becomes[from] = to;
    }
    for (uint32_t k = 0; k < code.insts.size();) {
        uint32_t end = k;
        while (end < code.insts.size() && isMovableOp(code.insts[end].op) && (end == k || !isTarget[end])) ++end;
        if (end > k + 1) Region(code, k, end, writes, becomes, lastWriter).run();
        k = std::max(end, k + 1);
    }
    foldScalarMoves(code, isTarget, writes);
}

}  // namespace vernier::batch
