// A plain evaluator of IR programs, one invocation at a time: the judge of the batch interpreter in its
// tests. Covers everything that does not reach outside the invocation, and loads: no stores, images,
// derivatives or transcendental functions.
#pragma once

#include <cstdint>
#include <vector>

#include "spirv_interp/ir/ir.h"

namespace vernier::test {

struct Evaluation {
    std::vector<uint32_t> outputs;  // by slot; zero if not stored
    bool killed = false, demoted = false;
};

/// `inputs` by slot; `buffer` is what every resource holds, and is only read. The program must end.
Evaluation evaluateInvocation(const ir::Program& program, const std::vector<uint32_t>& inputs,
                              const std::vector<uint32_t>& buffer = {});

/// One pure operation on bits.
uint64_t evaluateOp(ir::Op op, ir::Type result, ir::Type operand, const std::vector<uint64_t>& a, uint64_t imm);

/// Whether evaluateOp knows the operation.
bool isEvaluated(ir::Op op);

}  // namespace vernier::test
