// Fragments waiting to be shaded together: pixels of any number of primitives with the same fragment state.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/raster/triangle_planes.h"

namespace vernier {

inline constexpr uint32_t kMaxFragmentLanes = 128;
/// SIMD writes past the last lane of a segment; room for one vector more.
inline constexpr uint32_t kLaneRoom = kMaxFragmentLanes + 16;

/// Consecutive lanes of one primitive.
struct FragmentSegment {
    uint32_t planes = 0;  // index into FragmentBatch::planes
    uint32_t first = 0, count = 0;
};

/// Consecutive lanes that are neighbours on the screen, left to right: they are read and written together.
struct FragmentSpan {
    int32_t x = 0, y = 0;
    uint32_t first = 0, count = 0;
};

struct FragmentBatch {
    uint32_t count = 0;
    alignas(64) std::array<int32_t, kLaneRoom> x, y;      // pixels
    alignas(64) std::array<uint32_t, kLaneRoom> execute;  // ~0: the lane runs, as a helper perhaps
    alignas(64) std::array<uint32_t, kLaneRoom> store;    // ~0: its effects count
    alignas(64) std::array<float, kLaneRoom> offsetX,
        offsetY;                                           // place inside the pixel, when it is not the centre
    alignas(64) std::array<uint32_t, kLaneRoom> coverage;  // samples the lane stands for
    alignas(64) std::array<uint32_t, kLaneRoom> sample;    // when run per sample
    uint32_t spanCount = 0;
    std::array<FragmentSpan, kMaxFragmentLanes> spans;
    uint32_t segmentCount = 0;
    std::array<FragmentSegment, kMaxFragmentLanes> segments;
    // Slot planesCount - 1 belongs to the primitive being added.
    uint32_t planesCount = 0;
    std::array<TrianglePlanes, kMaxFragmentLanes + 1> planes;
};

}  // namespace vernier
