// The plan, told fact by fact.
#pragma once

#include "runtime/plan/plan.h"

namespace vernier {

const char* tierName(MathTier tier);

/// Fills plan.facts from the decisions in `plan`.
void collectFacts(const GraphicsState& state, const ShaderProgram& program, Plan& plan);

}  // namespace vernier
