// Fragments that are shaded together: pixels of any number of primitives with the same fragment state, or a block of
// one primitive.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/raster/triangle_planes.h"

namespace vernier {

inline constexpr uint32_t kMaxFragmentLanes = 128;
/// SIMD writes past the last lane of a segment; room for one vector more.
inline constexpr uint32_t kLaneRoom = kMaxFragmentLanes + 16;

/// Consecutive lanes of one primitive; or of any number of small ones, with attributes that are interpolated already.
struct FragmentSegment {
    const TrianglePlanes* planes = nullptr;  // nullptr: small primitives
    uint32_t first = 0, count = 0;
};

/// Consecutive lanes that are neighbours on the screen, left to right: they are read and written together.
struct FragmentSpan {
    int32_t x = 0, y = 0;
    uint32_t first = 0, count = 0;
};

/// Where the lanes of a batch lie on the screen.
enum class LaneOrder : uint8_t {
    spans,  // anywhere: FragmentBatch::spans tells
    rows,   // a rectangle kBlockSize pixels wide, row by row
    quads,  // such a rectangle, quad by quad: upper left, upper right, lower left, lower right
};

/// In rows and quads, all pixels belong to one primitive, which covers all samples of all of them, or a part
/// (`partial`). Or to two, both segments of all lanes: `second` tells the lanes of the other one.
struct FragmentBatch {
    uint32_t count = 0;
    LaneOrder order = LaneOrder::spans;
    bool partial = false;                                 // rows, quads: store and execute tell which lanes count
    uint32_t running = 0;                                 // partial: lanes that execute names
    int32_t originX = 0, originY = 0;                     // rows, quads: first pixel of the rectangle
    alignas(64) std::array<int32_t, kLaneRoom> x, y;      // pixels; in rows and quads only where somebody reads them
    alignas(64) std::array<uint32_t, kLaneRoom> execute;  // ~0: the lane runs, as a helper perhaps
    alignas(64) std::array<uint32_t, kLaneRoom> store;    // ~0: its effects count
    alignas(64) std::array<uint32_t, kLaneRoom> second;   // ~0: a lane of segments[1], where that has all lanes
    alignas(64) std::array<float, kLaneRoom> offsetX, offsetY;  // place in the pixel, when it is not the centre
    alignas(64) std::array<uint32_t, kLaneRoom> coverage;       // samples the lane stands for
    alignas(64) std::array<uint32_t, kLaneRoom> rasterized;     // Plan::maskBeforeTests: coverage before the tests
    alignas(64) std::array<uint32_t, kLaneRoom> sample;         // when run per sample
    bool apart = false;                                         // spans only: some lanes are in no span
    uint32_t spanCount = 0;                                     // spans only
    std::array<FragmentSpan, kMaxFragmentLanes> spans;
    uint32_t segmentCount = 0;
    std::array<FragmentSegment, kMaxFragmentLanes> segments;

    FragmentBatch();
};

/// Where lane `lane` of a rectangle in `order` lies in it.
constexpr uint32_t columnOf(LaneOrder order, uint32_t lane) {
    return order == LaneOrder::rows ? lane % 8 : lane / 4 % 4 * 2 + lane % 2;
}
constexpr uint32_t rowOf(LaneOrder order, uint32_t lane) {
    return order == LaneOrder::rows ? lane / 8 : lane / 16 * 2 + lane / 2 % 2;
}
static_assert(kBlockSize == 8);

}  // namespace vernier
