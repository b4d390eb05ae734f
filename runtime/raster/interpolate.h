// Interpolation over a batch of fragments: barycentrics once per lane, then every attribute as the value at
// one vertex plus weighted differences, so that a constant stays constant to the bit.
#pragma once

#include <cstdint>
#include <span>

#include "base/simd.h"
#include "runtime/raster/fragment_batch.h"

namespace vernier {

/// A varying that the fragment program reads, and where its lanes go.
struct VaryingTarget {
    uint32_t varying = 0;  // index into Plan::varyings
    float* plane = nullptr;
};

struct InterpolationInput {
    const FragmentBatch* batch;
    const float* offsetX;  // per lane; nullptr: the pixel's centre
    const float* offsetY;
    std::span<const VaryingTarget> smooth, linear;  // linear: noperspective
    std::span<const VaryingTarget> flat;            // get the bits of the provoking vertex
    uint32_t capacity;                              // lanes that the planes have room for
    bool perspective;                               // some attribute of the plan is interpolated with perspective
    // What else the fragment program wants; nullptr: not wanted. Room for kLaneRoom lanes.
    float* fragZ;
    float* fragInverseW;
};

/// Of a batch in rows or quads, x and y need not be filled.
/// Returns the number of lanes for which 1/w was divided.
using InterpolateFn = uint32_t (*)(const InterpolationInput& input);
InterpolateFn interpolateFunction(Isa isa);

/// The smooth and linear targets in double, rounded once. From x and y of the batch.
void interpolatePrecise(const InterpolationInput& input);

/// Fills x and y of a batch in rows or quads.
using PlaceLanesFn = void (*)(FragmentBatch& batch);
PlaceLanesFn placeLanesFunction(Isa isa);

/// Bit 8 y + x of `pixels` to ~0 or 0 in the lane of pixel (x, y), for `count` lanes (a multiple of 16) in rows or
/// quads.
using SpreadPixelsFn = void (*)(uint64_t pixels, LaneOrder order, uint32_t count, uint32_t* lanes);
SpreadPixelsFn spreadPixelsFunction(Isa isa);

/// The other way: the pixels whose lanes have a bit of `bits`.
using CollectPixelsFn = uint64_t (*)(const uint32_t* lanes, uint32_t bits, LaneOrder order, uint32_t count);
CollectPixelsFn collectPixelsFunction(Isa isa);

}  // namespace vernier
