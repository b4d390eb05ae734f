// Executes one render pass of a scene on the oracle's images.
#pragma once

#include "base/result.h"
#include "conformance/oracle/image_store.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

#include <vector>

namespace vernier::conformance::exact {

/// Snapping follows `rules`.
Status renderPass(const Scene& scene, const ScenePass& pass, const OracleRules& rules, std::vector<ImageStore>& images);

}  // namespace vernier::conformance::exact
