// Executes one render pass of a scene on the oracle's images and buffers.
#pragma once

#include "base/result.h"
#include "conformance/oracle/memory.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

namespace vernier::conformance::exact {

/// Snapping follows `rules`. What shaders store counts from the next draw on.
Status renderPass(const Scene& scene, const ScenePass& pass, const OracleRules& rules, Memory& memory);

}  // namespace vernier::conformance::exact
