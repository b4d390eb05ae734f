// Scenes that are measured, written like the conformance scenes and drawn by the same drivers.
#pragma once

#include <span>
#include <string_view>

#include "conformance/scenes/scenes.h"

// X(function), in the order of the table; the function's name is the scene's name.
#define VERNIER_SPEED_SCENES(X) \
    /* fill_scenes.cpp */       \
    X(fill)                     \
    X(overdraw)                 \
    X(overdraw_front_to_back)   \
    X(overdraw_back_to_front)   \
    X(blending)                 \
    X(particles)                \
    X(stencil)                  \
    /* geometry_scenes.cpp */   \
    X(small_triangles)          \
    X(tiny_draws)               \
    X(lines)                    \
    X(points)                   \
    /* texture_scenes.cpp */    \
    X(texture_nearest)          \
    X(texture_bilinear)         \
    X(texture_trilinear)        \
    X(textured)                 \
    /* shading_scenes.cpp */    \
    X(lighting)                 \
    X(arithmetic)               \
    X(divergent)                \
    /* procedural_scenes.cpp */ \
    X(raymarch_fragment)        \
    X(noise_fragment)           \
    X(uniform_fragment)         \
    /* pass_scenes.cpp */       \
    X(shadow_map)               \
    X(deferred)                 \
    X(small_passes)             \
    X(msaa4)

#define VERNIER_TRANSFER_SCENES(X) \
    X(transfer_copy)               \
    X(transfer_nearest)            \
    X(transfer_linear)             \
    X(transfer_mirror)             \
    X(transfer_convert)            \
    X(transfer_mips)               \
    X(transfer_clear)              \
    X(transfer_resolve)

namespace vernier::bench {

/// 1024 x 768 (procedural ones 512 x 384); each bound by one thing: fill, small triangles, textures, arithmetic, ...
std::span<const conformance::SceneEntry> speedScenes();

/// 2048 x 2048 texels moved, and nothing drawn.
std::span<const conformance::SceneEntry> transferScenes();

/// The scene called `name`: of a list above, or of a measurement of growth ("triangles:4096").
Result<conformance::Scene> buildBenchScene(std::string_view name);

namespace speed {
#define VERNIER_DECLARE_SCENE(name) Result<conformance::Scene> name();
VERNIER_SPEED_SCENES(VERNIER_DECLARE_SCENE)
}  // namespace speed
namespace transfer {
VERNIER_TRANSFER_SCENES(VERNIER_DECLARE_SCENE)
}  // namespace transfer
#undef VERNIER_DECLARE_SCENE

}  // namespace vernier::bench
