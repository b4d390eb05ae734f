// What the stages between vertices and the rasteriser get, and what reaches the rasteriser.
#pragma once

#include "runtime/plan/plan.h"

namespace vernier {

/// Fills what Plan tells of them; of a program without such stages what the state says.
void planStages(const GraphicsState& state, const ShaderProgram& program, Plan& plan);

}  // namespace vernier
