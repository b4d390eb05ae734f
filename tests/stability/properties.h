// What must hold of every soup, whatever is in it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tests/stability/canvas.h"

namespace vernier::stability {

/// Canvases at one position of the dial that differ in their number of threads.
struct Canvases {
    Canvas& one;
    Canvas& several;
};

struct Property {
    std::string_view name;
    std::string_view law;  // what holds, in words
    /// Empty if it holds; otherwise where it does not.
    std::string (*check)(const Soup& soup, const Canvases& canvases);
    std::span<Soup (*const)(uint64_t seed)> soups;  // those that it is tried on
};

std::span<const Property> allProperties();

}  // namespace vernier::stability
