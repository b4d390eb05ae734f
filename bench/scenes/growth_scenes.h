// Scenes with a size: what a measurement of growth varies.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "base/result.h"
#include "conformance/scene/scene.h"

namespace vernier::bench {

/// A grid over the whole target, each cell two triangles of their own colours, with depth test.
Result<conformance::Scene> trianglesScene(const char* name, const char* description, uint32_t columns, uint32_t rows);

struct GrowthAxis {
    std::string_view name;  // "triangles", ...
    std::string_view what;  // for people: what is counted, and in which scene
    // The scene of a given amount; amounts are those of `amounts` or near them.
    Result<conformance::Scene> (*build)(uint32_t amount);
    std::span<const uint32_t> amounts;
};

/// All axes but threads, which no scene can set.
std::span<const GrowthAxis> growthAxes();

/// "triangles:4096" as a scene of that name; `invalidArgument` when it is none.
Result<conformance::Scene> growthScene(std::string_view name);

}  // namespace vernier::bench
