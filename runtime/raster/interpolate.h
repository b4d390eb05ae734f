// Interpolation over a batch of fragments: barycentrics once per lane, then every attribute as the value at
// one vertex plus weighted differences, so that a constant stays constant to the bit.
#pragma once

#include <cstdint>

#include "base/simd.h"
#include "runtime/raster/fragment_batch.h"

namespace vernier {

/// Weights of the second and third vertex of each lane's primitive. Single precision, and double where the
/// plan asks.
struct LaneWeights {
    alignas(64) std::array<float, kLaneRoom> perspective1, perspective2, linear1, linear2;
    alignas(64) std::array<double, kLaneRoom> precise1, precise2, preciseLinear1, preciseLinear2;
};

struct WeightsInput {
    const FragmentBatch* batch;
    const float* offsetX;  // per lane; nullptr: the pixel's centre
    const float* offsetY;
    bool perspective;  // some attribute is interpolated with perspective
    bool inDouble;     // fill the precise weights too
};

/// Results other than the weights that the fragment program wants; nullptr: not wanted. Room for kLaneRoom
/// lanes.
struct FragCoordOutput {
    float* z;
    float* inverseW;
};

struct AttributeInput {
    const FragmentBatch* batch;
    const float* weight1;
    const float* weight2;
    uint32_t attribute;  // index among the varyings
    uint32_t capacity;   // lanes that `result` has room for
    float* result;
};

struct Interpolation {
    /// Returns the number of lanes for which 1/w was divided.
    uint32_t (*weights)(const WeightsInput& input, LaneWeights& weights, const FragCoordOutput& fragCoord);
    void (*attribute)(const AttributeInput& input);
};
Interpolation interpolationFunctions(Isa isa);

/// The attribute in double, rounded once.
void interpolatePrecise(const FragmentBatch& batch, const double* weight1, const double* weight2, uint32_t attribute,
                        float* result);
/// Copies the bits of the provoking vertex.
void copyFlat(const FragmentBatch& batch, uint32_t attribute, float* result);

}  // namespace vernier
