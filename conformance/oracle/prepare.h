// From the assembled primitives of a draw to what the pass renderer puts on its rows: triangles with facing, culling
// and depth bias; lines; points; and triangles drawn as either (polygon modes).
#pragma once

#include "conformance/oracle/fragment_shader.h"
#include "conformance/oracle/line_shape.h"
#include "conformance/oracle/triangle.h"

#include <optional>
#include <vector>

namespace vernier::conformance::exact {

struct PreparedPrimitive {
    Triangle carrier;  // the triangle itself; of lines and points what carries their inputs
    FragmentSource source;
    PixelBounds bounds;
    VkViewport viewport{};
    Interval bias;  // of depth
    uint64_t depthOrigin = 0;
    uint64_t outline = 0;  // which polygon it is an edge or a corner of; 0: none
    bool culled = false;   // nominally; only kept if another orientation is legal
    std::optional<LineShape> line;
    std::optional<PointShape> point;

    SampleVerdict classify(const GridPoint& sample) const;
    /// Of smooth lines.
    std::optional<double> smoothCoverage(const GridPoint& sample) const;
    /// The corners of the part of a pixel that a triangle covers; none for lines and points.
    std::vector<std::array<double, 2>> clippedPixel(int32_t x, int32_t y) const;
};

struct PrepareContext {
    const SceneDraw& draw;
    const ScenePipeline& pipeline;
    VkExtent2D extent;  // of the pass
    const OracleRules& rules;
    const PixelFormat* depthFormat = nullptr;
    std::optional<uint32_t> layer;  // only primitives of this layer
};

/// In the order of the draw. The geometry must outlive the result.
Result<std::vector<PreparedPrimitive>> preparePrimitives(const PrepareContext& context, const DrawGeometry& geometry);

}  // namespace vernier::conformance::exact
