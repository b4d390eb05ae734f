// What a primitive looks like inside a tile: exact edge functions, and the planes of everything that is
// interpolated.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/geometry/chunk.h"
#include "runtime/plan/sample_positions.h"

namespace vernier {

/// The edge functions of a primitive over a tile, divided by the sub-pixel scale and rounded down: pixel (x,
/// y) of the tile is inside edge e at sample s when c[e][s] + a[e] * x + b[e] * y >= 0. Nothing is lost: from
/// pixel to pixel the edge function changes by whole multiples of that scale, so the low bits dropped are the
/// same everywhere in the tile, and floor(v) >= 0 exactly when v >= 0. The top-left rule is in c.
/// A triangle has three, the rectangle of a line four.
struct TileEdges {
    std::array<int64_t, 4> a, b;
    std::array<std::array<int64_t, kMaxSamples>, 4> c;
    int32_t x0, y0, x1, y1;  // pixels to look at, inclusive, relative to the tile
    uint32_t samples;
    bool smallEdges;  // a and b below 2^kSmallEdgeBits
    bool fourEdges;
};

TileEdges tileEdges(const Primitive& primitive, int32_t tileX, int32_t tileY, uint32_t subPixelBits, uint32_t samples,
                    const SamplePosition* positions);

/// Points exactly on the edge a -> b of a clockwise triangle (y down) belong to it when the edge is a left
/// edge (going up) or a top edge (horizontal, going right).
constexpr bool isTopLeft(int64_t dx, int64_t dy) {
    return dy < 0 || (dy == 0 && dx > 0);
}

/// Above this, |gradient of lambda| * extent, the terms of lambda cancel: float would keep fewer than 20
/// bits.
inline constexpr double kThinTriangle = 16;

/// Barycentric coordinates and depth as functions of the position. All of them are taken relative to the
/// primitive's own first vertex (its anchor), so that the error does not grow with the distance from the
/// framebuffer's origin. With d = pixel - anchor + (offset - fraction), where offset is the place inside the
/// pixel:
///   lambda1 = l1x * dx + l1y * dy      lambda2 = l2x * dx + l2y * dy      z = z0 + (zx * dx + zy * dy)
struct TrianglePlanes {
    int32_t anchorX, anchorY;  // pixels
    float fractionX, fractionY;
    float l1x, l1y, l2x, l2y;
    float z0, zx, zy;
    float zLow, zHigh;  // depths are clamped to these
    float w0, w1, w2;   // 1 / w, scaled
    float wScale;       // times this: 1 / w
    bool affine;        // all w equal: barycentrics are the lambdas
    bool precise;       // evaluate in double: thin triangles, or the plan says so
    struct {
        double l1x, l1y, l2x, l2y, z0, zx, zy;
    } d;
    const float* attributes[3];
    const float* flat;
    const Primitive* primitive;
    const Shape* shape;  // of a point or line; nullptr: a triangle
};

/// The same for a point or a line: along a segment, lambda1 is the parameter of the point projected onto it ("Basic
/// Line Segment Rasterization"), and lambda2 is zero.
void makeShapePlanes(const Primitive& primitive, const Shape& shape, const float* attributes, uint32_t subPixelBits,
                     bool precise, float zLow, float zHigh, TrianglePlanes& planes);

/// `precise` forces double. Triangles so thin that float planes would lose bits to cancellation get it
/// anyway.
void makePlanes(const Primitive& primitive, const float* attributes, uint32_t subPixelBits, bool precise, float zLow,
                float zHigh, TrianglePlanes& planes);

/// The depth at a place in a pixel: the definition of what the SIMD depth test and gl_FragCoord.z compute.
float depthAt(const TrianglePlanes& planes, int32_t x, int32_t y, float offsetX, float offsetY);

/// Barycentrics at a place in a pixel, likewise.
struct Barycentrics {
    double l1, l2;  // linear on the screen
    double b1, b2;  // perspective
};
Barycentrics barycentricsAt(const TrianglePlanes& planes, int32_t x, int32_t y, float offsetX, float offsetY);

}  // namespace vernier
