// Every conformance scene. VERNIER_SCENES is the one list: it declares the functions and makes the table.
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <span>
#include <string_view>

// X(function), grouped by the file that defines it; the function's name is the scene's name.
#define VERNIER_SCENES(X)    \
    /* geometry.cpp */       \
    X(solid)                 \
    X(gouraud)               \
    X(interpolation_modes)   \
    X(indexed_strip)         \
    X(instancing)            \
    X(push_constants)        \
    X(shared_edges)          \
    X(near_plane)            \
    /* fragment_tests.cpp */ \
    X(scissor_viewport)      \
    X(depth_intersect)       \
    X(stencil_winding)       \
    X(alpha_test)            \
    X(msaa_resolve)          \
    /* color_output.cpp */   \
    X(blend_modes)           \
    X(srgb)                  \
    X(multiple_targets)      \
    /* texturing.cpp */      \
    X(texture_nearest)       \
    X(texture_bilinear)      \
    X(texture_lod)           \
    X(texture_trilinear)     \
    X(copy_and_blit)         \
    X(blit_mirrored)         \
    /* texture_kinds.cpp */  \
    X(texture_anisotropic)   \
    X(cube_seams)            \
    X(texture_volume)        \
    X(texture_lines)         \
    X(border_custom)         \
    X(texture_extremes)      \
    X(blocks_bc)             \
    X(blocks_etc2)           \
    X(blocks_astc)           \
    /* multi_pass.cpp */     \
    X(render_to_texture)     \
    X(shadow_map)            \
    /* shading.cpp */        \
    X(lit_model)             \
    X(derivatives)           \
    X(julia)                 \
    X(integer_noise)

namespace vernier::conformance {

/// Builds the scene anew, compiling its shaders; an error means a bug in the scene.
using BuildScene = Result<Scene> (*)();

struct SceneEntry {
    std::string_view name;
    BuildScene build;
};

/// All scenes, in the order of the report.
std::span<const SceneEntry> allScenes();

/// The entry called `name`, or nullptr.
const SceneEntry* findScene(std::string_view name);

namespace scenes {
#define VERNIER_DECLARE_SCENE(name) Result<Scene> name();
VERNIER_SCENES(VERNIER_DECLARE_SCENE)
#undef VERNIER_DECLARE_SCENE
}  // namespace scenes

}  // namespace vernier::conformance
