// What the execution modes of tessellation stages say. Either stage may hold each of them, so that a pipeline's are
// those of both, joined (specification, "Tessellation").
#pragma once

#include <cstdint>

namespace vernier::ir {

enum class TessellationDomain : uint8_t { none, triangles, quads, isolines };
enum class TessellationSpacing : uint8_t { none, equal, fractionalEven, fractionalOdd };
/// As seen with u to the right and v upwards.
enum class TessellationOrder : uint8_t { none, clockwise, counterClockwise };

struct TessellationModes {
    TessellationDomain domain = TessellationDomain::none;
    TessellationSpacing spacing = TessellationSpacing::none;
    TessellationOrder order = TessellationOrder::none;
    bool pointMode = false;
    bool operator==(const TessellationModes&) const = default;
};

/// What one stage leaves open is as the other says.
constexpr TessellationModes joined(const TessellationModes& a, const TessellationModes& b) {
    return {a.domain != TessellationDomain::none ? a.domain : b.domain,
            a.spacing != TessellationSpacing::none ? a.spacing : b.spacing,
            a.order != TessellationOrder::none ? a.order : b.order, a.pointMode || b.pointMode};
}

}  // namespace vernier::ir
