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
           std::vector<uint32_t>& lastWriter)
        : code_(code), begin_(begin), nodes_(end - begin), writes_(writes), lastWriter_(lastWriter) {}

    void run() {
        connect();
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
    const std::vector<uint32_t>& writes_;  // by place, in the whole code
    std::vector<uint32_t>& lastWriter_;    // by place: a node of this region, or kNone
};

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
    std::vector<uint32_t> lastWriter(writes.size(), kNone);
    for (uint32_t k = 0; k < code.insts.size();) {
        uint32_t end = k;
        while (end < code.insts.size() && isMovableOp(code.insts[end].op) && (end == k || !isTarget[end])) ++end;
        if (end > k + 1) Region(code, k, end, writes, lastWriter).run();
        k = std::max(end, k + 1);
    }
}

}  // namespace vernier::batch
