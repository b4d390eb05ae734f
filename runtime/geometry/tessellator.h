// The tessellator: subdivides the domain of a patch into points, lines or triangles, by its levels (specification,
// "Tessellation Primitive Generation").
//
// Coordinates are multiples of 2^-24 in [0, 1], computed in integers: 1 - x is exact for each of them, u + v + w of a
// triangle is exactly 1, edges are symmetric to the bit and the same whichever edge of a patch they are and whatever
// lies inside ("Tessellation Invariance").
//
// What the specification leaves open is declared: of fractional spacings the first and the last segment are the shorter
// ones, of n segments for a level f 1 - (n - f) / 2 as long as the others; between two edges the next triangle is on
// the edge whose next segment has its middle first; rectangles are cut from the corner with the least u and v.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spirv_interp/tessellation.h"

namespace vernier {

/// maxTessellationGenerationLevel.
inline constexpr uint32_t kMaxTessellationLevel = 64;

struct TessellationLevels {
    std::array<float, 4> outer{};
    std::array<float, 2> inner{};
};

/// TessCoord; w is 0 but for triangles.
struct TessellationPoint {
    float u = 0, v = 0, w = 0;
    bool operator==(const TessellationPoint&) const = default;
};

/// A subdivided domain. No point stands twice in `points` unless the specification calls two of the same place
/// distinct. Each primitive is `verticesPerPrimitive` consecutive indices; both are empty for a patch that is culled.
struct SubdividedPatch {
    std::vector<TessellationPoint> points;
    std::vector<uint32_t> indices;
    uint32_t verticesPerPrimitive = 3;
};

/// Keeps the last subdivision, as many patches in a row have the same levels. Not thread-safe.
class Tessellator {
  public:
    /// Spacing and order that are not given are equal and counter-clockwise; a domain must be.
    explicit Tessellator(const TessellationModes& modes)
        : modes_(joined(modes, {.spacing = TessellationSpacing::equal, .order = TessellationOrder::counterClockwise})) {
    }

    /// Stays as it is until the next call.
    const SubdividedPatch& subdivide(const TessellationLevels& levels);

  private:
    /// The segments of an edge: their number, and the ends of all of them, in units of 2^-24.
    struct Edge {
        uint32_t segments = 0;
        std::array<uint32_t, kMaxTessellationLevel + 1> ends{};
    };

    static Edge edgeOf(double level, uint32_t segments, uint32_t multiple);
    Edge outerEdge(float level) const;
    Edge innerEdge(float level, bool split, uint32_t multiple) const;

    void subdivideTriangle(const TessellationLevels& levels);
    void subdivideQuad(const TessellationLevels& levels);
    void subdivideIsolines(const TessellationLevels& levels);
    uint32_t addPoint(uint32_t u, uint32_t v, uint32_t w);
    void addTriangle(uint32_t a, uint32_t b, uint32_t c);
    struct Side {
        std::vector<uint32_t> points, places;  // their numbers, and how far along the side they are, ascending
    };
    /// The area between two parallel sides.
    void fillBetween(const Side& outer, const Side& inner);

    TessellationModes modes_;
    TessellationLevels last_;
    bool hasLast_ = false;
    SubdividedPatch patch_;
};

}  // namespace vernier
