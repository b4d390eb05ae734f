// Executes one render pass of a scene on the oracle's images.
#pragma once

#include "base/result.h"
#include "conformance/oracle/image_store.h"
#include "conformance/scene/scene.h"

#include <vector>

namespace vernier::conformance::exact {

Status renderPass(const Scene& scene, const ScenePass& pass, std::vector<ImageStore>& images);

}  // namespace vernier::conformance::exact
