// Work of the fragment program that its inputs' vertices can do.
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

struct LiftFacts {
    uint32_t flat = 0;    // operations that the fragment program no longer has, on flat inputs
    uint32_t linear = 0;  // and on interpolated ones
};

/// Moves expressions from `fragment` into `vertex`, which stores them to new outputs; `fragment` reads new inputs
/// instead.
///
/// Flat: made of constants, of what uniform buffers and push constants hold, and of flat inputs. The provoking vertex
/// of the primitive has the same values as before: the result has the same bits.
///
/// Linear (only if `linear` says so): sums of interpolated inputs of one kind, times what does not vary inside a draw.
/// Interpolation commutes with them but for rounding. Of an expression of n operations both ways differ from the exact
/// value by at most kLinearError * (n + 4) * M, where M is the largest sum, over the vertices, of the absolute values
/// of its terms, as long as no term overflows; so this is for accuracies that do not ask for more. What NoContraction
/// marks is not moved.
///
/// Both are done where they save as much work per pixel as so many operations, with what the inputs cost that come and
/// go. Both programs must be linked: every user input of `fragment` has an output of `vertex`. They are left to be
/// optimised.
LiftFacts lift(Program& vertex, Program& fragment, bool linear);

/// An operation takes as long for a vertex as for a pixel, about 0.1 ns (bench/micro/interp_bench). So moved work is
/// saved work as soon as there are more pixels than vertices; what would only trade one input for another stays where
/// it is.
inline constexpr uint32_t kLeastGain = 4;
/// The same where bits change for it: what saves less cannot be measured (docs/rates.md).
inline constexpr uint32_t kLeastLinearGain = 8;
/// To fill in an input for a pixel takes as long as so many operations.
inline constexpr uint32_t kFlatInputCost = 1, kSmoothInputCost = 5;

/// Half a unit in the last place: that of each operation, and four of interpolation.
inline constexpr float kLinearError = 0x1p-24f;

}  // namespace vernier::ir
