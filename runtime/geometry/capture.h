// Transform feedback of primitives that stages have made.
#pragma once

#include "runtime/geometry/chunk.h"
#include "runtime/geometry/prepared_draw.h"

namespace vernier {

/// Puts them where the draw's RunningCapture is, which goes on behind them; from the first that one of the stream's
/// buffers has no room for, all are dropped. Returns how many had room.
uint32_t writeCaptured(const PreparedDraw& draw, const CapturedPrimitives& captured);

}  // namespace vernier
