// The outcomes of running one quad of a fragment shader under several perturbations, and the ranges they
// span.
#pragma once

#include "conformance/oracle/sample_states.h"
#include "conformance/oracle/shader_resources.h"
#include "conformance/oracle/value_error.h"
#include "spirv_interp/reference/interpreter.h"

#include <array>
#include <span>
#include <vector>

namespace vernier::conformance::exact {

/// Outcomes by kind of perturbation; fragment_shader.h tells what each kind stands for.
struct ShaderRuns {
    using Quad = std::array<reference::Outcome<double>, 4>;

    Quad nominal;
    std::vector<Quad> shifted, filtered, coarse, rounded;
    std::array<std::vector<Quad>, 6> moved;  // by vertex and coordinate
};

bool isIntegerVariable(const reference::InterfaceVariable& variable);

/// What one fragment stores, in the order of the shader, with the ranges that the runs span; of several stores to a
/// texel the last. The first run is the nominal one, the last run the one that rounds. Where runs store to other
/// places, the result is unknown.
std::vector<TexelWrite> combineWrites(std::span<const std::vector<RunWrite>> runs, uint32_t lane, const Memory& memory,
                                      const ValueError& error, OracleFlags flags);

/// One fragment's result: nominal outputs with their ranges. Components that the shader has not written are
/// NaN.
FragmentResult combineRuns(const ShaderRuns& runs, size_t lane, std::span<const reference::InterfaceVariable> outputs,
                           const ValueError& error, size_t colorCount);

}  // namespace vernier::conformance::exact
