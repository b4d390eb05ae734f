// Clipping in homogeneous coordinates, for the few primitives that need it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/geometry/chunk.h"
#include "runtime/geometry/prepared_draw.h"

namespace vernier {

struct ClipVertex {
    std::array<double, 4> position;  // clip coordinates
    std::array<double, kMaxClipDistances> distances;
    uint32_t attributes;      // first float in Chunk::attributes
    float pointSize = 1;      // of polygons drawn as points
    bool hiddenEdge = false;  // the edge to the next vertex lies on a plane of the view volume
};

/// A plane adds at most one vertex to a convex polygon: w, near, far, four sides (of lines), four of the guard band,
/// and the user's.
inline constexpr uint32_t kMaxClipPlanes = 11 + kMaxClipDistances;
inline constexpr uint32_t kMaxPolygonVertices = 3 + kMaxClipPlanes;

struct ClipPolygon {
    std::array<ClipVertex, kMaxPolygonVertices> vertices;
    uint32_t count = 0;
};

/// Clips a polygon to w >= 0, the near and far plane (unless depth clipping is off), the guard band, and the user's
/// clip distances; a line (two vertices) to the sides of the view volume, too, which for polygons the rasteriser does.
/// Attributes of new vertices are appended to the chunk. What is left has count 0 when nothing is. Returns whether
/// anything was cut.
///
/// New vertices depend on the two ends of the edge alone, not on the direction in which it is walked, so that
/// primitives sharing an edge share its new vertices to the bit.
bool clipPolygon(const PreparedDraw& draw, const ViewportTransform& viewport, ClipPolygon& polygon, Chunk& chunk);

}  // namespace vernier
