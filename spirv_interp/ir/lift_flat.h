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

/// An operation takes as long for a vertex as for a pixel, about 0.1 ns (bench/micro/interp_bench), and to fill in a
/// flat input for a pixel takes as long as an operation. So moved work is saved work as soon as there are more pixels
/// than vertices; what would only trade one input for another stays where it is.
inline constexpr uint32_t kLeastGain = 4;

}  // namespace vernier::ir
