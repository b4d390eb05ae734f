// Primitives of a few pixels, a group at a time: a SIMD lane is a primitive while coverage and planes are worked out,
// and a fragment from then on. The same operations in the same order as for one primitive (coverage.h,
// triangle_planes.h, depth_test.h, interpolate.h), so the same bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/simd.h"
#include "runtime/raster/depth_stencil.h"
#include "runtime/raster/interpolate.h"

namespace vernier {

/// Primitives in a group, at most.
inline constexpr uint32_t kSmallGroup = 16;
/// Fragments that a group can have; lists have room for one vector more.
inline constexpr uint32_t kSmallFragments = kSmallGroup * kSmallExtent * kSmallExtent;

/// A fragment of a group: x and y in the tile, 6 bits each, and the primitive's number in the group.
using SmallFragment = uint16_t;
static_assert(kTileSize <= 64 && kSmallGroup == 16);
constexpr SmallFragment smallFragment(uint32_t x, uint32_t y, uint32_t lane) {
    return static_cast<SmallFragment>(x | y << 6 | lane << 12);
}

/// An attribute of the primitives of a group: its value at the first vertex, and the differences of the others. Of a
/// flat one only the first counts: the bits at the provoking vertex.
struct SmallAttribute {
    alignas(64) std::array<float, kSmallGroup> first, difference1, difference2;
};

/// TrianglePlanes of a group, by primitive.
struct SmallGroup {
    uint32_t count = 0;
    uint32_t precise = 0;  // bit per primitive: too thin for float; its planes are not to be used
    uint32_t affine = 0;   // bit per primitive
    // Bit 8 y + x of `pixels`: the primitive covers pixel (left + x, top + y) of the tile.
    std::array<uint64_t, kSmallGroup> pixels;
    std::array<uint32_t, kSmallGroup> left, top;
    std::array<const float*, kSmallGroup> attributes[3], flat;
    alignas(64) std::array<int32_t, kSmallGroup> originX, originY;  // of the tile, from the anchor, in pixels
    alignas(64) std::array<float, kSmallGroup> centreX, centreY;    // 1/2 - fraction
    alignas(64) std::array<float, kSmallGroup> l1x, l1y, l2x, l2y, z0, zx, zy, w0, w1, w2;
    float zLow = 0, zHigh = 1;
};

/// Small primitives (Primitive::small) of one draw, and the attributes of their chunks.
struct SmallInput {
    std::array<const Primitive*, kSmallGroup> primitives;
    std::array<const float*, kSmallGroup> attributes;
    uint32_t count;
    int32_t tileX, tileY;
    uint32_t subPixelBits;
    float zLow, zHigh;
};
using SetUpSmallFn = void (*)(const SmallInput& input, SmallGroup& group);
SetUpSmallFn setUpSmallFunction(Isa isa);

/// The early depth test. No pixel may be there twice if depths are written.
struct SmallTestInput {
    const DepthPlan* plan;
    const SmallGroup* group;
    std::byte* texels;  // of the tile's first pixel
    uint32_t rowPitch, texelBytes;
};
/// Moves the fragments that pass to the front, in order; returns how many.
using TestSmallFn = uint32_t (*)(const SmallTestInput& input, SmallFragment* fragments, uint32_t count);
TestSmallFn testSmallFunction(Isa isa);

/// Attributes of a group: one in `to` for each target, the first `weighted` of them not flat.
struct SmallAttributeInput {
    const SmallGroup* group;
    std::span<const VaryingTarget> targets;
    size_t weighted;
    SmallAttribute* to;
};
using GatherSmallFn = void (*)(const SmallAttributeInput& input);
GatherSmallFn gatherSmallFunction(Isa isa);

/// What fragments become: lanes of a batch. Planes have room for one vector more than `count`.
struct SmallShadeInput {
    const SmallGroup* group;
    const SmallFragment* fragments;
    uint32_t count;
    int32_t tileX, tileY;
    int32_t *x, *y;
    // Attributes in the order smooth, linear, flat; their lanes.
    std::span<const SmallAttribute> attributes;
    std::span<float* const> planes;
    size_t smoothCount, linearCount;
};
/// Returns the number of lanes for which 1/w was divided.
using ShadeSmallFn = uint32_t (*)(const SmallShadeInput& input);
ShadeSmallFn shadeSmallFunction(Isa isa);

}  // namespace vernier
