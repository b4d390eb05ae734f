// Soups that are tried in every run: those on which some renderer once failed, as small as they could be made.
#pragma once

#include <limits>
#include <string_view>

#include "tests/stability/soup.h"

namespace vernier::stability {

struct KeptCase {
    std::string_view name;
    Soup soup;
};

inline std::vector<KeptCase> keptCases() {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    return {
        // Edges of a quad whose diagonal runs through centres, with a vertex an ULP from the grid.
        {"DiagonalBesideCentres",
         Soup{{{atWindow(0.5, 0.49993896), atWindow(0.5, 6.5), atWindow(6.500061, 0.49993896)}},
              {{atWindow(6.500061, 0.49993896), atWindow(0.5, 6.5), atWindow(6.5, 6.5)}}}},
        // An area of 0 in floats, and its neighbours.
        {"SliverOfNoFloatArea",
         Soup{{{atWindow(1.0625, 1.0625), atWindow(60.9375, 40.25), atWindow(30.9375, 20.625)}},
              {{atWindow(1.0625, 1.0625), atWindow(60.9375, 40.25), atWindow(1.0625, 50)}},
              {{atWindow(1.0625, 1.0625), atWindow(30.9375, 20.625), atWindow(60.9375, 1.0625)}}}},
        // Cut by the near plane in two corners: the pieces hung on the winding.
        {"WindingOfACutTriangle",
         Soup{{{{0, -0x1.22ep-2f, 0x1.1p-1f, 0x1.0116p-1f}, {0, 0, -1, 0x1p-10f}, {0x1.8p+0f, 0, 0, 0x1.4ed6p+0f}}}}},
        {"WindingAtTheEye", Soup{{{{0, -1, 1, 0},
                                   {-0x1.1ceep-2f, 0, -0x1.cp-16f, 0x1.3568p-1f},
                                   {0x1.7cf4p+1f, -0x1.92d2p-1f, 0x1p-4f, 0}}}}},
        // One vertex at infinity, one behind the eye.
        {"VertexAtInfinity", Soup{{{{-1, -1, 0.25f, 1}, {1, 0.5f, 0, 0}, {-0.5f, 1, 0.25f, 1}}}}},
        {"VertexBehindTheEye", Soup{{{{-0.5f, -0.5f, 0.25f, 1}, {0.5f, 0.25f, -1, -1}, {0.5f, 0.75f, 0.5f, 1}}}}},
        {"NanInW", Soup{{{{-1, -1, 0.5f, kNan}, {1, -1, 0.5f, 1}, {-1, 1, 0.5f, 1}}},
                        {{{1, 1, 0.5f, 1}, {1, -1, 0.5f, 1}, {-1, 1, 0.5f, 1}}}}},
        {"InfiniteX", Soup{{{{kInf, -1, 0.5f, 1}, {1, -1, 0.5f, 1}, {-1, 1, 0.5f, 1}}},
                           {{{1, 1, 0.5f, 1}, {1, -1, 0.5f, 1}, {-1, 1, 0.5f, 1}}}}},
    };
}

}  // namespace vernier::stability
