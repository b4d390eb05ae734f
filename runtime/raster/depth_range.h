// The depths that a primitive can leave in an attachment: conservative, so that what is left out because of them
// changes no image.
#pragma once

#include "runtime/plan/plan.h"
#include "runtime/raster/triangle_planes.h"

namespace vernier {

/// Depths as stored. A bound that is not known is an infinity; one that is NaN compares false with everything.
struct DepthRange {
    double low, high;
};

/// What conversion to the format may move a depth by.
double depthQuantum(DepthStorage storage);

/// After a clear to `depth`, which fixed-point formats take into 0..1.
DepthRange clearedDepths(DepthStorage storage, float depth);

/// In the block whose first pixel is (x, y), covered or not.
DepthRange blockDepths(DepthStorage storage, const TrianglePlanes& planes, int32_t x, int32_t y);

/// In all pixels that the primitive covers. `zLow`, `zHigh`: what depths are clamped to.
DepthRange primitiveDepths(DepthStorage storage, const Primitive& primitive, float zLow, float zHigh);

}  // namespace vernier
