// Work on flat inputs, done where they come from.
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Expressions of `fragment` that depend on constants and flat inputs alone are the same all over a primitive: they are
/// moved into `vertex`, which stores them to new outputs, and `fragment` reads new flat inputs instead. The provoking
/// vertex of the primitive has the same values as before, so the result has the same bits. This is done when it saves
/// more work per pixel than `kLeastGain` operations, each new input counted as one and each old one that is no longer
/// read as one less. Returns the number of operations that `fragment` no longer has. Both programs must be linked:
/// every user input of `fragment` has an output of `vertex`. They are left to be optimised.
uint32_t liftFlat(Program& vertex, Program& fragment);

/// A pixel computes an operation for about a nanosecond; a vertex, for which they are all computed even if it provokes
/// no primitive, for as much. With primitives of a few pixels and one or two vertices for each, this gain pays.
inline constexpr uint32_t kLeastGain = 4;

}  // namespace vernier::ir
