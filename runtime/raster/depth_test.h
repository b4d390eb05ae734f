// The depth and stencil tests of blocks of 8x8 pixels, when there is no bounds test.
#pragma once

#include <cstdint>

#include "base/simd.h"
#include "runtime/raster/coverage.h"
#include "runtime/raster/depth_stencil.h"

namespace vernier {

struct DepthTestInput {
    const DepthPlan* plan;
    DepthTarget target;
    const TrianglePlanes* planes;
    int32_t tileX, tileY;
    uint32_t samples;
    const SamplePosition* positions;
    const DepthStencilState::Face* face;  // of the stencil test
    uint64_t certain;                     // without one, bit blockIndex(): all samples of the block pass
    // Depths that the fragment program gave, of all samples: a float for every pixel of the block, row by row. Of one
    // block only; nullptr: the planes tell.
    const float* exported = nullptr;
};

/// Tests the samples of the blocks and writes the depth of those that pass, and the stencil of all. Clears the bits of
/// those that fail; returns how many blocks have bits left, moved to the front in order.
using DepthTestFn = uint32_t (*)(const DepthTestInput& input, BlockCoverage* blocks, uint32_t count);
/// Without a stencil test.
DepthTestFn depthTestFunction(Isa isa);
/// With one, and a depth test perhaps.
DepthTestFn stencilTestFunction(Isa isa);

}  // namespace vernier
