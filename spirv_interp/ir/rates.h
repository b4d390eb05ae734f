// How often a value can change: what can be computed once per draw need not be computed per batch.
#pragma once

#include <vector>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// From the one that changes least.
/// `draw`: made of constants and of loads, at draw-rate places, from push constants and from buffers that the program
/// only reads. Such loads may run before any branch: outside a buffer they give 0. In compute also NumWorkgroups: a
/// dispatch is a draw.
/// `workGroup`: the same, made of WorkgroupId too.
enum class Rate : uint8_t { constant, draw, workGroup, invocation };

/// By value, the lowest rate that is safe. Values without a definition are `invocation`.
std::vector<Rate> computeRates(const Program& program);

}  // namespace vernier::ir
