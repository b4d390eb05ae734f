// Coverage of points and lines in a tile.
#pragma once

#include <cstdint>

#include "runtime/geometry/prepared_draw.h"
#include "runtime/raster/coverage.h"

namespace vernier {

/// Writes the blocks that have something covered, row by row, as a CoverTileFn does; returns how many. The tile's first
/// pixel is (tileX, tileY).
uint32_t coverShape(const PreparedDraw& draw, const Primitive& primitive, const Shape& shape, int32_t tileX,
                    int32_t tileY, BlockCoverage* blocks);

}  // namespace vernier
