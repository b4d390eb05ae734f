// What the execution modes of a geometry stage say (specification, "Geometry Shading").
#pragma once

#include <cstdint>

namespace vernier::ir {

enum class GeometryInput : uint8_t { points, lines, linesAdjacency, triangles, trianglesAdjacency };
enum class GeometryOutput : uint8_t { points, lineStrip, triangleStrip };

// Limits of geometry stages ("Required Limits" in the Vulkan specification asks for 32, 256 and 1024).
inline constexpr uint32_t kMaxGeometryInvocations = 32;
inline constexpr uint32_t kMaxGeometryVertices = 1024;
inline constexpr uint32_t kMaxGeometryComponents = 16384;  // of all vertices of an invocation together

/// Vertex streams that a geometry stage can put vertices into.
inline constexpr uint32_t kVertexStreams = 4;

struct GeometryModes {
    GeometryInput input = GeometryInput::triangles;
    GeometryOutput output = GeometryOutput::points;
    uint32_t invocations = 1;     // of each primitive
    uint32_t outputVertices = 0;  // that an invocation can put out at most, of all streams
    bool operator==(const GeometryModes&) const = default;
};

/// Vertices of a primitive that goes in, those of its neighbours included.
constexpr uint32_t verticesOf(GeometryInput input) {
    constexpr uint32_t kVertices[] = {1, 2, 4, 3, 6};
    return kVertices[static_cast<uint32_t>(input)];
}

/// Vertices of a primitive that comes out.
constexpr uint32_t verticesOf(GeometryOutput output) {
    return static_cast<uint32_t>(output) + 1;
}

}  // namespace vernier::ir
