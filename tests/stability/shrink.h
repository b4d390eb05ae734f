// Making a failing soup small: fewer triangles, then simpler coordinates, as long as it still fails.
#pragma once

#include "tests/stability/soup.h"

#include <functional>

namespace vernier::stability {

using Fails = std::function<bool(const Soup&)>;

/// A soup that fails as `failing` does, from which no triangle can be taken and in which no coordinate can be replaced
/// by a simpler one (0, 1 or -1, the nearest integer, fewer bits) without its holding again. Vertices with the same
/// position change together, so that meshes stay meshes. Asks `fails` at most `budget` times; out of budget it is only
/// smaller. Triangles go by halves, quarters, ... (Zeller and Hildebrandt, "Simplifying and Isolating Failure-Inducing
/// Input", 2002).
Soup shrink(Soup failing, const Fails& fails, size_t budget = 2000);

}  // namespace vernier::stability
