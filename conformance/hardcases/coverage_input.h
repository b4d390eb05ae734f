// Coverage cases: triangles given in pixels, drawn additively so that the image counts how many cover each sample, and
// the judges of such counts.
#pragma once

#include "conformance/hardcases/hard_case.h"
#include "conformance/oracle/coverage_checks.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vernier::conformance::hardcases {

using ClipPosition = std::array<float, 4>;

struct WindowPoint {
    double x = 0, y = 0;  // pixels
};
using WindowTriangle = std::array<WindowPoint, 3>;
using WindowTriangles = std::vector<WindowTriangle>;

VkViewport viewportOf(VkExtent2D extent);

/// Clip coordinates of a window point. For points on a grid of 8 sub-pixel bits, exact in float and through the
/// viewport transform when the viewport is a power of two of at most 8192 pixels at integer offsets.
ClipPosition clipAt(const WindowPoint& p, const VkViewport& viewport, float z = 0.5f, float w = 1);
std::vector<ClipPosition> clipAt(const WindowTriangles& triangles, const VkViewport& viewport);

/// How triangles are drawn to be counted; everything not said is plain.
struct CountOptions {
    VkExtent2D extent{64, 64};
    std::optional<VkViewport> viewport;  // by default the extent's
    std::optional<VkRect2D> scissor;
    uint32_t samples = 1;  // with more than one, only `sample` is written and counted
    uint32_t sample = 0;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    bool depthClamp = false;
    float lineWidth = 1;
    VkLineRasterizationModeEXT lineMode = VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;
    VkPolygonMode polygonMode = VK_POLYGON_MODE_FILL;
    uint32_t stippleFactor = 0;  // 0: lines are not stippled
    uint16_t stipplePattern = 0;
    bool drawEach = false;  // one draw per three vertices instead of one for all
};

/// Every covering primitive adds kCountStep to red: at most 15 are counted.
inline constexpr uint32_t kCountStep = 16;
extern const char* const kPositionVertexGlsl;  // location 0: vec4 to gl_Position
extern const char* const kCountFragmentGlsl;
VkPipelineColorBlendAttachmentState countingBlend();
Result<Scene> countScene(std::string_view name, const std::vector<ClipPosition>& positions,
                         const CountOptions& options);

/// The counts of such an image; an error if a code is no count or another channel was touched. `samples` as drawn.
Result<std::vector<uint32_t>> readCounts(const Drawn& drawn, VkExtent2D extent, uint32_t samples = 1);

/// The triangles as a driver with so many sub-pixel bits declares to snap them: to nearest, ties to even.
std::vector<exact::GridTriangle> snapped(const WindowTriangles& triangles, int bits);

/// A standard sample location (Vulkan, Multisampling) in 1/16 pixel.
exact::GridPoint standardSample(uint32_t samples, uint32_t sample);

/// Adds a scene of triangles, and the judge that knows which samples they must, may and must not cover. `tiling`: they
/// share their edges, so that every sample away from the outline is covered exactly once. `windowX/Y`: the pixel of the
/// triangles' plane that is the target's pixel (0, 0). Returns the scene.
struct CoverageOptions : CountOptions {
    bool tiling = false;
    int64_t windowX = 0, windowY = 0;
    std::optional<VkRect2D> visible;  // pixels that the clip volume leaves, when it is not the scissor that cuts
};
size_t addCoverage(CaseInput& input, std::string_view name, const WindowTriangles& triangles,
                   const CoverageOptions& options);

/// Adds the judge alone, for triangles that `scene` draws in its own way.
void judgeCoverage(CaseInput& input, size_t scene, const WindowTriangles& triangles, const CoverageOptions& options);

/// No sample is covered.
void judgeEmpty(CaseInput& input, size_t scene, const CountOptions& options, std::string why);

/// A jittered grid of vertices, cut into triangles: a planar tiling. `resolution`: steps per pixel of the vertices.
WindowTriangles jitteredTiling(uint32_t cells, double cellPixels, double jitterPixels, double resolution,
                               uint32_t seed);

std::string pixelText(uint32_t x, uint32_t y);

}  // namespace vernier::conformance::hardcases
