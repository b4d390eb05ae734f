// The tessellator of the oracle: what the levels of a patch make of its domain (Vulkan, "Tessellation"), in rationals,
// by the constructions that the specification describes. It knows nothing of Vernier's.
//
// The specification says which points there are, but for where fractional spacings have their two shorter segments; it
// leaves open how the area between two subdivided edges is cut into triangles, by which diagonal a rectangle is, with
// which vertex a primitive begins, in which order primitives come, and how exact coordinates are. Scenes are made so
// that none of this shows: tests draw them with other choices, too. The choices by default are Vernier's
// (runtime/geometry/tessellator.h).
#pragma once

#include "conformance/oracle/exact.h"
#include "conformance/oracle/oracle.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vernier::conformance::exact {

enum class PatchDomain : uint8_t { triangles, quads, isolines };
enum class PatchSpacing : uint8_t { equal, fractionalEven, fractionalOdd };

struct PatchModes {
    PatchDomain domain = PatchDomain::triangles;
    PatchSpacing spacing = PatchSpacing::equal;
    bool clockwise = false;
    bool points = false;
    bool lowerLeft = false;  // the origin of the domain
};

struct PatchLevels {
    std::array<double, 4> outer{};
    std::array<double, 2> inner{};  // numbers
};

/// TessCoord: w is 0 but for triangles.
using DomainPoint = std::array<Rational, 3>;

struct Subdivision {
    std::vector<DomainPoint> points;
    std::vector<std::vector<uint32_t>> primitives;  // points, lines or triangles: their vertices
};

/// maxTessellationGenerationLevel: the least that is allowed, which all drivers at hand have.
inline constexpr int kMaxTessellationLevel = 64;

/// Both ends of all segments of an edge, ascending from 0 to 1. `split`: one that is not divided counts as one of a
/// level that is a little above 1.
std::vector<Rational> edgeEnds(double level, PatchSpacing spacing, bool split = false,
                               const TessellationChoices& choices = {});

/// Nothing for a patch that is discarded.
Subdivision subdivide(const PatchModes& modes, const PatchLevels& levels, const TessellationChoices& choices = {});

}  // namespace vernier::conformance::exact
