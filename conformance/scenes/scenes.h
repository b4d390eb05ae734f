// Every conformance scene. VERNIER_SCENES is the one list: it declares the functions and makes the table.
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <span>
#include <string_view>

// X(function), grouped by the file that defines it; the function's name is the scene's name.
#define VERNIER_SCENES(X)      \
    /* geometry.cpp */         \
    X(solid)                   \
    X(gouraud)                 \
    X(interpolation_modes)     \
    X(indexed_strip)           \
    X(instancing)              \
    X(push_constants)          \
    X(shared_edges)            \
    X(near_plane)              \
    /* fragment_tests.cpp */   \
    X(scissor_viewport)        \
    X(depth_intersect)         \
    X(stencil_winding)         \
    X(alpha_test)              \
    X(msaa_resolve)            \
    /* geometry_stage.cpp */   \
    X(geometry_strips)         \
    X(geometry_adjacency)      \
    /* tessellation.cpp */     \
    X(tessellation_triangles)  \
    X(tessellation_quads)      \
    X(tessellation_spacing)    \
    X(tessellation_isolines)   \
    X(tessellation_points)     \
    X(tessellation_counts)     \
    X(tessellation_winding)    \
    /* lines_and_points.cpp */ \
    X(lines)                   \
    X(lines_bresenham)         \
    X(lines_wide)              \
    X(lines_smooth)            \
    X(lines_stippled)          \
    X(lines_stippled_wide)     \
    X(points)                  \
    X(polygon_modes)           \
    /* primitives.cpp */       \
    X(provoking_vertex)        \
    X(barycentrics)            \
    X(primitive_restart)       \
    X(adjacency)               \
    X(depth_bias)              \
    X(depth_bias_fixed)        \
    X(depth_clamp)             \
    X(depth_clip_control)      \
    X(depth_clip_enable)       \
    X(depth_bounds)            \
    X(viewports_indexed)       \
    X(layers)                  \
    X(geometry_layers)         \
    X(multiview)               \
    /* samples.cpp */          \
    X(sample_counts)           \
    X(sample_locations)        \
    X(sample_shading)          \
    X(sample_shading_partial)  \
    X(depth_stencil_resolve)   \
    X(depth_resolve_modes)     \
    X(centroid_inputs)         \
    X(alpha_to_coverage)       \
    X(alpha_to_one)            \
    /* stores.cpp */           \
    X(logic_operations)        \
    X(dual_source)             \
    X(storage_images)          \
    X(texel_buffers)           \
    X(storage_buffers)         \
    /* color_output.cpp */     \
    X(blend_modes)             \
    X(srgb)                    \
    X(multiple_targets)        \
    /* texturing.cpp */        \
    X(texture_nearest)         \
    X(texture_bilinear)        \
    X(texture_cubic)           \
    X(texture_lod)             \
    X(texture_trilinear)       \
    X(copy_and_blit)           \
    X(blit_mirrored)           \
    X(blit_cubic)              \
    /* texture_kinds.cpp */    \
    X(texture_anisotropic)     \
    X(cube_seams)              \
    X(texture_volume)          \
    X(texture_lines)           \
    X(border_custom)           \
    X(texture_extremes)        \
    X(blocks_bc)               \
    X(blocks_etc2)             \
    X(blocks_astc)             \
    /* multi_pass.cpp */       \
    X(render_to_texture)       \
    X(shadow_map)              \
    /* shading.cpp */          \
    X(lit_model)               \
    X(derivatives)             \
    X(julia)                   \
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
