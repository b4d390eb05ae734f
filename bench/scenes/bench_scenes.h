// Scenes that are measured, written like the conformance scenes and drawn by the same drivers.
#pragma once

#include <span>
#include <string_view>

#include "conformance/scenes/scenes.h"

namespace vernier::bench {

/// 1024 x 768 (procedural ones 512 x 384); each bound by one thing: fill, small triangles, textures, arithmetic, ...
std::span<const conformance::SceneEntry> speedScenes();

/// Procedural pictures of 512 x 384, whose arithmetic is also measured as compute kernels.
Result<conformance::Scene> raymarchScene();
Result<conformance::Scene> noiseScene();
Result<conformance::Scene> uniformScene();

/// Small enough for the exact oracle; each sensitive to one axis of accuracy.
std::span<const conformance::SceneEntry> accuracyScenes();

/// The entry called `name` in either list, or nullptr.
const conformance::SceneEntry* findBenchScene(std::string_view name);

}  // namespace vernier::bench
