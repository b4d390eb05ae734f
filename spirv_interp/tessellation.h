// What the execution modes of tessellation stages say. Either stage may hold each of them, so that a pipeline's are
// those of both, joined (specification, "Tessellation"). Programs do not hold them: they are for what lies between the
// two stages.
#pragma once

#include <cstdint>

#include "base/result.h"

namespace vernier {

struct ShaderSource;

enum class TessellationDomain : uint8_t { none, triangles, quads, isolines };
enum class TessellationSpacing : uint8_t { none, equal, fractionalEven, fractionalOdd };
/// As seen with u to the right and v upwards.
enum class TessellationOrder : uint8_t { none, clockwise, counterClockwise };

struct TessellationModes {
    TessellationDomain domain = TessellationDomain::none;
    TessellationSpacing spacing = TessellationSpacing::none;
    TessellationOrder order = TessellationOrder::none;
    bool pointMode = false;
    uint32_t outputVertices = 0;  // of a patch that comes out of control; 0: it is not said
    bool operator==(const TessellationModes&) const = default;
};

/// What one stage leaves open is as the other says.
constexpr TessellationModes joined(const TessellationModes& a, const TessellationModes& b) {
    return {a.domain != TessellationDomain::none ? a.domain : b.domain,
            a.spacing != TessellationSpacing::none ? a.spacing : b.spacing,
            a.order != TessellationOrder::none ? a.order : b.order, a.pointMode || b.pointMode,
            a.outputVertices != 0 ? a.outputVertices : b.outputVertices};
}

/// Of the entry point that a shader names, a control or evaluation stage. Thread-safe. Defined in front/.
Result<TessellationModes> tessellationModes(const ShaderSource& source);

/// maxTessellationPatchSize: vertices of a patch that goes into a control stage, or comes out.
inline constexpr uint32_t kMaxPatchVertices = 32;

/// Lanes that share the memory of a control program's outputs (front/lower_patch.cpp): as many run at a time at most,
/// those of whole patches.
inline constexpr uint32_t kPatchLanes = 64;
constexpr uint32_t patchesPerBatch(uint32_t lanes, uint32_t outputVertices) {
    return (lanes < kPatchLanes ? lanes : kPatchLanes) / outputVertices;
}

}  // namespace vernier
