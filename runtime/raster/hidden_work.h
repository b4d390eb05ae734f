// What later opaque primitives hide is not rendered: if primitives together replace every colour of a tile, and pass
// the depth test whatever was drawn before them, the tile's work before the first of them has no effect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/geometry/prepared_draw.h"
#include "runtime/raster/pass_targets.h"
#include "runtime/raster/tile_renderer.h"

namespace vernier {

/// Where the visible work of a tile begins: entry `entry` of work[item]. 0, 0 with `replacesColors` false: everything
/// is visible, the load operations included.
struct VisibleStart {
    size_t item = 0;
    uint32_t entry = 0;
    bool replacesColors = false;  // what is rendered replaces every colour of the tile
};

struct TileInput {
    PixelRect rect;        // the pixels of the tile inside the render area
    int32_t tileX, tileY;  // first pixel of the tile
    std::span<const PreparedDraw> draws;
    std::span<const TileWork> work;
    bool cleared;  // all depth in it was just cleared by the load operation
};

/// Whether some primitive of the draws may hide others: false saves looking at every tile.
bool mayHideWork(const PassTargets& targets, std::span<const PreparedDraw> draws);

VisibleStart visibleStart(const PassTargets& targets, const TileInput& tile);

}  // namespace vernier
