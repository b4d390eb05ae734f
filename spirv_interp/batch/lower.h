// From the IR to machine code. A program becomes pieces by rate: draw-rate code and, in compute, code at the rate of
// work-groups, straight-line, run once per draw or work-group on a batch of one lane group, which leave their results
// in the scalar file; and the code of a batch, with lane masks for its control flow.
#pragma once

#include <vector>

#include "base/result.h"
#include "spirv_interp/batch/machine.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::batch {

struct LoweredProgram {
    MachineCode batch, workGroup, draw;
    ScalarFile scalars;
    std::vector<uint32_t> inputScalars;  // by Program::inputs: where the runner puts its value, or kNone
};

/// `program` must verify. `packed`: a batch holds several work-groups, so that what is the same for one varies between
/// lanes. An operation on types it is not defined for is refused.
Result<LoweredProgram> lower(const ir::Program& program, bool packed);

/// Moves that happen at once, put in an order in which none destroys the source of another. `fresh` makes a
/// register for a cycle.
struct Move {
    Operand to;    // written row or scalar
    Operand from;  // row or scalar
};
template <class Emit, class Fresh>
void sequentialise(std::vector<Move> moves, Emit&& emit, Fresh&& fresh) {
    const auto same = [](const Operand& a, const Operand& b) {
        return a.kind == b.kind && a.id == b.id && a.word == b.word;
    };
    std::erase_if(moves, [&](const Move& m) { return same(m.to, m.from); });
    while (!moves.empty()) {
        bool progress = false;
        for (size_t k = 0; k < moves.size(); ++k) {
            bool needed = false;
            for (size_t j = 0; j < moves.size(); ++j) needed |= j != k && same(moves[j].from, moves[k].to);
            if (needed) continue;
            emit(moves[k]);
            moves.erase(moves.begin() + static_cast<ptrdiff_t>(k));
            progress = true;
            break;
        }
        if (progress) continue;
        // Only cycles are left: the first destination is saved, and whoever wanted it reads the copy.
        const Operand saved = fresh(moves.front().to);
        for (Move& move : moves) {
            if (same(move.from, moves.front().to)) move.from = saved;
        }
    }
}

}  // namespace vernier::batch
