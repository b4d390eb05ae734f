// Set-up of small triangles, a triangle in each SIMD lane: what Assembler and PrimitiveSetup decide about one triangle
// at a time, with the same results. Triangles that it is not made for are told apart.
#pragma once

#include <array>
#include <cstdint>

#include "base/simd.h"
#include "runtime/geometry/prepared_draw.h"

namespace vernier {

inline constexpr uint32_t kTriangleGroup = 16;

/// `count` triangles of a draw with PreparedDraw::packsSmall, filled and without depth bias.
struct TriangleGroupInput {
    const int32_t *x, *y;                                   // of all vertices: sub-units
    const uint32_t* flags;                                  // VertexFlag
    std::array<const uint32_t*, kTriangleGroup> triangles;  // each: the numbers of its three vertices
    uint32_t count;
    uint32_t subPixelBits;
    PixelRect area;
    bool clockwiseIsFront, cullFront, cullBack;
    int32_t gridX, gridY;  // first pixel of the tiles
    uint32_t columns;      // of tiles
};

/// Bit n is triangle n's.
struct TriangleGroup {
    uint32_t counted;   // something of it may be in the view volume
    uint32_t ordinary;  // to be set up by itself; of the others only those in `small` have anything to draw
    uint32_t small;
    uint32_t front, spread;  // of those: front-facing, in more than one tile
    // Of those in `small`: corners in canonical order (Primitive), each's place in the triangle, bounds as in Primitive
    // (low: x0 and y0, high: x1 and y1, 16 bits each), and the tile of the upper left one.
    alignas(64) std::array<int32_t, kTriangleGroup> x[3], y[3], corner[3], low, high, tile;
};

using SetUpTrianglesFn = void (*)(const TriangleGroupInput& input, TriangleGroup& group);
SetUpTrianglesFn setUpTrianglesFunction(Isa isa);

}  // namespace vernier
