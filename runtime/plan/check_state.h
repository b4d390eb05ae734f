// What a pipeline is refused for.
#pragma once

#include "base/result.h"
#include "runtime/plan/pipeline.h"

namespace vernier {

/// Checks the state alone: values in range, formats known and usable, nothing that is not implemented.
Status checkGraphicsState(const GraphicsState& state, const Accuracy& accuracy);

/// Checks the shaders against the state and each other.
Status checkInterfaces(const GraphicsState& state, const ShaderProgram& program);

/// Of what a geometry stage puts out, and of what patches are subdivided into; and one of what a geometry stage takes.
VkPrimitiveTopology topologyOf(ir::GeometryOutput output);
VkPrimitiveTopology topologyOf(const TessellationModes& modes);
VkPrimitiveTopology topologyOf(ir::GeometryInput input);

}  // namespace vernier
