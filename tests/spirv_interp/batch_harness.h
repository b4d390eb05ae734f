// Runs IR programs through the batch interpreter for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spirv_interp/ir/ir.h"
#include "spirv_interp/program.h"

namespace vernier::test {

/// The instruction sets of this CPU.
inline std::span<const Isa> isas() {
    return availableIsas();
}

/// Equal bits; two NaNs count as equal.
bool sameBits(const std::vector<float>& a, const std::vector<float>& b);

/// A program from its text; a failure ends the test.
ir::Program parseProgram(const std::string& text);

/// `op` on f32 rows, through a program of its own.
std::vector<float> evaluate(ir::Op op, const std::vector<std::vector<float>>& operands, Isa isa, MathTier tier);

/// What a run gave: words of every output by slot, and the live mask.
struct RunResult {
    std::vector<std::vector<uint32_t>> outputs;
    std::vector<uint32_t> live;
    bool ok = true;
    bool operator==(const RunResult&) const = default;
};

struct RunSetup {
    Isa isa = kLowestIsa;
    MathTier tier = MathTier::standard;
    uint32_t capacity = 64;             // BatchOptions::lanes
    uint32_t lanes = 64;                // lanes to run
    std::vector<uint32_t> exec, store;  // empty: all
    ResourceBindings bindings;
    BatchContext::Interpolator interpolator;
};

/// Runs once; inputs[slot][lane] are words.
RunResult runBatch(const ir::Program& program, const std::vector<std::vector<uint32_t>>& inputs, const RunSetup& setup);

}  // namespace vernier::test
