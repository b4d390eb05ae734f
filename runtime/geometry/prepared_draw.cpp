#include "runtime/geometry/prepared_draw.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/geometry/chunk.h"

namespace vernier {
namespace {

int32_t clampPixel(double value) {
    if (!(value > kGuardBandMin)) return kGuardBandMin;  // NaN too
    return static_cast<int32_t>(std::min(value, double{kGuardBandMax}));
}

/// The pixels whose samples at `place` lie in [low, high): clipping to the view volume leaves exactly those of a shape
/// that covers them, since its right and bottom edges are no top-left edges.
void pixelRange(double low, double high, float place, int32_t& first, int32_t& end) {
    first = clampPixel(std::ceil(low - double{place}));
    end = clampPixel(std::ceil(high - double{place}));
}

PixelRect viewportPixels(const VkViewport& v, SamplePosition sample) {
    PixelRect rect;
    pixelRange(double{v.x}, double{v.x} + double{v.width}, sample.x(), rect.x0, rect.x1);
    const double y0 = double{v.y}, y1 = double{v.y} + double{v.height};
    pixelRange(std::min(y0, y1), std::max(y0, y1), sample.y(), rect.y0, rect.y1);
    return rect;
}

bool hasWholeEdges(const VkViewport& v) {
    const auto whole = [](float value) { return value == std::floor(value); };
    return whole(v.x) && whole(v.y) && whole(v.width) && whole(v.height);
}

PixelRect intersect(const PixelRect& a, const PixelRect& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

PixelRect unite(const PixelRect& a, const PixelRect& b) {
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

PixelRect rectOf(const VkRect2D& rect) {
    const auto end = [](int32_t offset, uint32_t extent) {
        return static_cast<int32_t>(std::min<int64_t>(int64_t{offset} + extent, kGuardBandMax));
    };
    return {rect.offset.x, rect.offset.y, end(rect.offset.x, rect.extent.width),
            end(rect.offset.y, rect.extent.height)};
}

/// Depths outside [0, 1] have no place in a fixed-point attachment, and without VK_EXT_depth_range_unrestricted none in
/// a float one.
void setUpDepths(const DepthPlan& plan, const VkViewport& v, ViewportSetup& setup) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    setup.depthLow = plan.unrestricted ? -kInfinity : 0.0f;
    setup.depthHigh = plan.unrestricted ? kInfinity : 1.0f;
    if (!plan.clampToViewport) return;
    const float low = setup.depthLow, high = setup.depthHigh;
    const auto inside = [&](float value) { return value >= low ? std::min(value, high) : low; };
    setup.depthLow = inside(std::min(v.minDepth, v.maxDepth));
    setup.depthHigh = inside(std::max(v.minDepth, v.maxDepth));
}

ViewportSetup setUpViewport(const PreparedDraw& draw, uint32_t index, const VkRect2D& renderArea) {
    ViewportSetup setup;
    const VkViewport& v = draw.call.dynamic->viewports[index];
    const double halfWidth = 0.5 * double{v.width}, halfHeight = 0.5 * double{v.height};
    const double minDepth = double{v.minDepth}, maxDepth = double{v.maxDepth};
    setup.transform = {{halfWidth, halfHeight, maxDepth - minDepth},
                       {double{v.x} + halfWidth, double{v.y} + halfHeight, minDepth}};
    if (draw.state->negativeOneToOne) {
        setup.transform.scale[2] = 0.5 * (maxDepth - minDepth);
        setup.transform.offset[2] = 0.5 * (maxDepth + minDepth);
    }
    setup.area = intersect(rectOf(draw.call.dynamic->scissors[index]), rectOf(renderArea));
    // Edges on pixel boundaries leave the same pixels to every sample.
    setup.triangleArea = viewportPixels(v, draw.positions[0]);
    if (!draw.samplesAtCentre && !hasWholeEdges(v)) {
        for (uint32_t s = 0; s < draw.plan->samples; ++s) {
            setup.sampleAreas.push_back(viewportPixels(v, draw.positions[s]));
            setup.triangleArea = unite(setup.triangleArea, setup.sampleAreas.back());
        }
    }
    setup.triangleArea = intersect(setup.area, setup.triangleArea);

    setUpDepths(draw.plan->depth, v, setup);
    return setup;
}

/// A chunk has room to find the vertices of its primitives again, and what it may put out is bounded, with work for all
/// lanes of a batch.
uint32_t weightOf(const DrawCall& call, const Plan& plan) {
    if (!plan.stages) return 1;
    constexpr uint32_t kVertexNumbers = 4 * kChunkPrimitives, kOutputVertices = 16 * kChunkPrimitives;
    const auto weigh = [](uint32_t each, uint32_t most) { return (each * kChunkPrimitives + most - 1) / most; };
    // What a patch may be subdivided into is known only with its levels: some hundred points, and 4225 at most.
    constexpr uint32_t kPatchPoints = 1024;
    uint32_t weight = weigh(plan.inputVertices, kVertexNumbers);
    if (call.pipeline->controlProgram() != nullptr) weight = std::max(weight, weigh(kPatchPoints, kOutputVertices));
    if (const auto& geometry = call.pipeline->geometryProgram()) {
        const ir::GeometryModes& modes = geometry->source().geometry;
        weight = std::max(weight, weigh(modes.invocations * modes.outputVertices, kOutputVertices));
    }
    return std::clamp(weight, 1u, kChunkPrimitives);
}

}  // namespace

PreparedDraw prepareDraw(const DrawCall& call, const VkRect2D& renderArea) {
    PreparedDraw draw;
    draw.call = call;
    const Plan* withoutQuads = call.needsLevels ? nullptr : call.pipeline->planWithoutQuads();
    draw.plan = withoutQuads != nullptr ? withoutQuads : &call.pipeline->plan();
    draw.state = &call.pipeline->state();
    draw.subPixelBits = call.pipeline->accuracy().subPixelBits;
    draw.positions =
        draw.state->sampleLocations ? call.dynamic->sampleLocations.data() : samplePositions(draw.plan->samples);
    constexpr uint16_t kNoGaps = 0xFFFF;
    draw.stipples = draw.state->stippledLine &&
                    (call.dynamic->lineStipplePattern != kNoGaps || !draw.plan->skips.has(Skip::idleState));
    draw.samplesAtCentre = draw.plan->samples == 1 && draw.positions[0].x16 == 8 && draw.positions[0].y16 == 8;
    draw.firstViewport = setUpViewport(draw, 0, renderArea);
    if (draw.plan->viewportIndexSlot != kNoSlot)
        for (uint32_t n = 1; n < std::min(call.dynamic->viewportCount, kMaxViewports); ++n)
            draw.otherViewports.push_back(setUpViewport(draw, n, renderArea));
    draw.packsSmall = draw.plan->packsSmall && draw.samplesAtCentre && draw.otherViewports.empty() &&
                      draw.subPixelBits <= kTinySubPixelBits;
    draw.primitiveWeight = weightOf(call, *draw.plan);
    draw.runs = vertexRuns(call, draw.state->topology, draw.state->primitiveRestart);
    if (!draw.runs.empty()) draw.primitivesPerInstance = draw.runs.back().firstPrimitive + draw.runs.back().primitives;
    return draw;
}

}  // namespace vernier
