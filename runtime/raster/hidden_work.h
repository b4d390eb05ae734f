// What a later opaque primitive hides is not rendered: if a primitive replaces every colour of a tile, the tile's work
// before it has no effect.
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
    bool replacesColors = false;  // the first primitive rendered replaces every colour of the tile
};

VisibleStart visibleStart(const PassTargets& targets, std::span<const PreparedDraw> draws,
                          std::span<const TileWork> work);

}  // namespace vernier
