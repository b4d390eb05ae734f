// A draw with everything that is the same for all its primitives worked out.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/geometry/draw_call.h"
#include "runtime/geometry/topology.h"
#include "runtime/plan/plan.h"

namespace vernier {

/// window = clip / w * scale + offset, in double: within half a unit of its last place of the exact value,
/// far finer than any sub-pixel grid, so that the grid point is the one nearest to the exact coordinate.
struct ViewportTransform {
    double scale[3], offset[3];
};

/// Pixels [x0, x1) x [y0, y1).
struct PixelRect {
    int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

/// One viewport with its scissor.
struct ViewportSetup {
    ViewportTransform transform{};
    PixelRect triangleArea;  // scissor, render area, and the viewport: what clipping to the view volume leaves
    PixelRect area;          // scissor and render area, for points and lines
    float depthLow = 0, depthHigh = 1;   // what depths are clamped to
    std::vector<PixelRect> sampleAreas;  // by sample, what of triangleArea is inside the viewport; empty: all of it
};

struct PreparedDraw {
    DrawCall call;
    const Plan* plan = nullptr;
    const GraphicsState* state = nullptr;
    ViewportSetup firstViewport;
    std::vector<ViewportSetup> otherViewports;  // none unless a program chooses viewports
    uint32_t viewIndex = 0;                     // multiview: the view, and the layer that the draw goes to
    uint32_t subPixelBits = 8;
    const SamplePosition* positions = nullptr;  // of all samples of a pixel
    bool stipples = false;                      // lines, by a pattern that has gaps
    bool samplesAtCentre = true;                // one sample, in the middle
    bool packsSmall = false;                    // primitives of a few pixels are drawn many at a time
    std::vector<VertexRun> runs;
    uint32_t primitivesPerInstance = 0;
    uint32_t primitiveWeight = 1;  // of kChunkPrimitives: stages may make many of one
    uint32_t fragmentState = 0;    // draws with the same number may share fragment batches

    uint32_t viewportCount() const { return 1 + static_cast<uint32_t>(otherViewports.size()); }
    const ViewportSetup& viewport(uint32_t index) const {
        return index == 0 ? firstViewport : otherViewports[index - 1];
    }
    uint64_t primitives() const { return uint64_t{primitivesPerInstance} * call.instances; }
};

PreparedDraw prepareDraw(const DrawCall& call, const VkRect2D& renderArea);

}  // namespace vernier
