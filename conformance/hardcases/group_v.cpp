// V: set-up overflow, viewports, topology (topology_cases.h).
#include "conformance/hardcases/geometry_stage_cases.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/layer_cases.h"
#include "conformance/hardcases/robust_cases.h"
#include "conformance/hardcases/tessellation_cases.h"
#include "conformance/hardcases/topology_cases.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

CoverageOptions tiling() {
    CoverageOptions options;
    options.extent = kTarget;
    options.tiling = true;
    return options;
}

WindowTriangles movedBy(WindowTriangles triangles, double dx, double dy) {
    for (WindowTriangle& t : triangles) {
        for (WindowPoint& p : t) p = {p.x + dx, p.y + dy};
    }
    return triangles;
}

// Triangles across a plane of 16384 pixels, seen at its corners.
void v01(CaseInput& input) {
    const WindowTriangles large{{{{0, 0}, {16384, 3}, {5, 16384}}}, {{{16384, 16384}, {5, 16384}, {16384, 3}}}};
    for (const auto& [x, y] : {std::pair{0, 0}, {16320, 0}, {0, 16320}, {16320, 16320}, {8163, 8192}, {12288, 4090}}) {
        CoverageOptions options = tiling();
        options.viewport = VkViewport{0, 0, 16384, 16384, 0, 1};
        options.windowX = x;
        options.windowY = y;
        addCoverage(input, "V01", large, options);
    }
}

// Viewports that begin outside the target and are larger than it.
void v02(CaseInput& input) {
    const std::vector<VkViewport> viewports{{-1000, -40, 2048, 128, 0, 1},
                                            {32, 32, 64, 64, 0, 1},
                                            {-8192, -8192, 16384, 16384, 0, 1},
                                            {-32, 8, 64, 32, 0, 1},
                                            {63, 63, 4096, 4096, 0, 1}};
    for (const VkViewport& viewport : viewports) {
        CoverageOptions options = tiling();
        options.viewport = viewport;
        const auto left = static_cast<int32_t>(std::max(0.0f, viewport.x)),
                   top = static_cast<int32_t>(std::max(0.0f, viewport.y));
        const auto right = static_cast<int32_t>(std::min(64.0f, viewport.x + viewport.width));
        const auto bottom = static_cast<int32_t>(std::min(64.0f, viewport.y + viewport.height));
        options.visible =
            VkRect2D{{left, top}, {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
        addCoverage(input, "V02", jitteredTiling(9, 6.5, 1.9, 256, 2), options);
    }
}

// A viewport between pixels; an implementation without viewport sub-pixel bits may round it.
void v03(CaseInput& input) {
    const WindowTriangles base = jitteredTiling(6, 8.5, 2.9, 256, 3);
    const std::vector<ClipPosition> positions = clipAt(base, viewportOf(kTarget));
    const struct { double x, y, width; } viewports[] = {{0.25, 0.5, 64}, {3.75, 1.125, 56.5}};
    for (const auto& viewport : viewports) {
        const double x = viewport.x, y = viewport.y, width = viewport.width;
        CountOptions options;
        options.extent = kTarget;
        options.viewport =
            VkViewport{static_cast<float>(x), static_cast<float>(y), static_cast<float>(width), 64, 0, 1};
        const size_t scene = input.scene(countScene("V03", positions, options));
        input.judge({scene}, [=](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
            const auto counts = readCounts(*images[0], kTarget);
            if (!counts) return Verdict::wrong(counts.error().message);
            const int64_t half = int64_t{1} << (declared.subPixelBits - 1);
            const exact::SampleGrid grid{kTarget, declared.subPixelBits, {half, half}};
            Verdict best = Verdict::wrong("");
            for (double (*round)(double) :
                 {+[](double v) { return v; }, +[](double v) { return std::nearbyint(v); },
                  +[](double v) { return std::floor(v); }, +[](double v) { return std::ceil(v); }}) {
                const double vx = round(x), vy = round(y), scale = round(width) / 64;
                WindowTriangles moved;
                for (const WindowTriangle& t : base) {
                    WindowTriangle m;
                    for (size_t i = 0; i < 3; ++i) m[i] = {vx + t[i].x * scale, vy + t[i].y};
                    moved.push_back(m);
                }
                // Samples beyond the viewport's borders are cut off.
                const auto border = [](double v) { return static_cast<int32_t>(std::ceil(v - 0.5)); };
                const int32_t right = std::min(64, border(vx + round(width))), bottom = std::min(64, border(vy + 64));
                const VkRect2D visible{
                    {border(vx), border(vy)},
                    {static_cast<uint32_t>(right - border(vx)), static_cast<uint32_t>(bottom - border(vy))}};
                const std::string wrong =
                    exact::checkLegalCoverage(snapped(moved, declared.subPixelBits), grid, visible, *counts);
                if (wrong.empty())
                    return best.witness.empty() ? Verdict{}
                                                : Verdict::allowed("the viewport is rounded: " + best.witness);
                if (best.witness.empty()) best.witness = wrong;
            }
            return best;
        });
    }
}

void v04(CaseInput& input) {
    for (const VkViewport& viewport : {VkViewport{0, 64, 64, -64, 0, 1}, {16, 56, 32, -32, 0, 1}}) {
        CoverageOptions options = tiling();
        options.viewport = viewport;
        options.visible =
            VkRect2D{{static_cast<int32_t>(viewport.x), static_cast<int32_t>(viewport.y + viewport.height)},
                     {static_cast<uint32_t>(viewport.width), static_cast<uint32_t>(-viewport.height)}};
        // Rows of centres are ties: the rule is not mirrored with the picture.
        WindowTriangles triangles{{{{2, 8.5}, {2, 40.5}, {50, 8.5}}}, {{{50, 40.5}, {50, 8.5}, {2, 40.5}}}};
        addCoverage(input, "V04", triangles, options);
        addCoverage(input, "V04", jitteredTiling(9, 6.5, 1.9, 256, 4), options);
    }
    // The winding turns over with y.
    const WindowTriangle clockwise{{{4, 4}, {60, 10}, {20, 50}}};
    for (const bool flipped : {false, true}) {
        for (const VkCullModeFlags cull : {VK_CULL_MODE_FRONT_BIT, VK_CULL_MODE_BACK_BIT}) {
            CoverageOptions options;
            options.extent = kTarget;
            options.cull = cull;
            options.viewport = flipped ? VkViewport{0, 64, 64, -64, 0, 1} : VkViewport{0, 0, 64, 64, 0, 1};
            // Where it is on the screen decides, however it came there: clockwise is back.
            const size_t scene =
                input.scene(countScene("V04_winding", clipAt({clockwise}, *options.viewport), options));
            if (cull == VK_CULL_MODE_BACK_BIT) {
                judgeEmpty(input, scene, options, "clockwise on the screen faces back");
            } else {
                judgeCoverage(input, scene, {clockwise}, options);
            }
        }
    }
}

void v05(CaseInput& input) {
    CountOptions options;
    options.extent = kTarget;
    options.viewport = VkViewport{8, 8, 48, 0, 0, 1};
    const size_t scene =
        input.scene(countScene("V05", clipAt(jitteredTiling(4, 12, 3, 256, 5), viewportOf(kTarget)), options));
    judgeEmpty(input, scene, options, "the viewport has no height");
}

// Off the grid at 8K: every primitive sees a vertex at the same place.
void v06(CaseInput& input) {
    for (const auto& [x, y] : {std::pair{8000, 8100}, {5, 7900}, {4070, 33}}) {
        CoverageOptions options = tiling();
        options.viewport = VkViewport{0, 0, 8192, 8192, 0, 1};
        options.windowX = x;
        options.windowY = y;
        addCoverage(input, "V06", movedBy(jitteredTiling(28, 2.21875, 0.6, 0x1p11, 7), x, y), options);
    }
}

// A promise of Vernier's own: whole pixels of translation move a picture of grid vertices and nothing else.
void v07(CaseInput& input) {
    const WindowTriangles base = jitteredTiling(5, 6.5, 1.9, 16, 7);
    CountOptions options;
    options.extent = kTarget;
    const size_t still = input.scene(countScene("V07", clipAt(base, viewportOf(kTarget)), options));
    for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {17, 9}, {27, 27}}) {
        const size_t moved =
            input.scene(countScene("V07_moved", clipAt(movedBy(base, dx, dy), viewportOf(kTarget)), options));
        input.judge(
            {moved, still}, [dx = dx, dy = dy](std::span<const Drawn* const> images, const Declared&) -> Verdict {
                const auto a = readCounts(*images[0], kTarget), b = readCounts(*images[1], kTarget);
                if (!a || !b) return Verdict::wrong((a ? b : a).error().message);
                for (uint32_t y = 0; y + static_cast<uint32_t>(dy) < 64; ++y) {
                    for (uint32_t x = 0; x + static_cast<uint32_t>(dx) < 64; ++x) {
                        const uint32_t to = (y + static_cast<uint32_t>(dy)) * 64 + x + static_cast<uint32_t>(dx);
                        if ((*a)[to] == (*b)[y * 64 + x]) continue;
                        return Verdict::allowed(pixelText(x, y) + " changes when the picture moves by (" +
                                                std::to_string(dx) + ", " + std::to_string(dy) +
                                                "); Vulkan does not ask for more");
                    }
                }
                return {};
            });
    }
}

// Attachments that are no multiple of quads, blocks or tiles; derivatives at their borders.
void v12(CaseInput& input) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {65, 1}, {1, 67}, {4095, 1}, {129, 66}}) {
        SceneRecorder record("V12", "A ramp and its derivatives on an odd attachment.");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R32G32B32A32_SFLOAT, extent);
        const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() {
    vec2 p = gl_FragCoord.xy * 0.25;
    color = vec4(p, dFdx(p.x), dFdy(p.y));
}
)"));
        record.pass(extent).color(target, {0, 0, 0, 0});
        record.draw(pipeline, 3);
        record.output(target);
        const size_t scene = input.scene(record.finish());
        judgePixels(input, scene, 0, extent, [extent](const PixelReader& pixels, const Declared&) -> Verdict {
            for (uint32_t y = 0; y < extent.height; ++y) {
                for (uint32_t x = 0; x < extent.width; ++x) {
                    const bool right = pixels.number(x, y, 0) == (static_cast<float>(x) + 0.5f) * 0.25f &&
                                       pixels.number(x, y, 1) == (static_cast<float>(y) + 0.5f) * 0.25f &&
                                       pixels.number(x, y, 2) == 0.25f && pixels.number(x, y, 3) == 0.25f;
                    if (!right)
                        return Verdict::wrong(pixelText(x, y) + " of " + std::to_string(extent.width) + " x " +
                                              std::to_string(extent.height) +
                                              ": a ramp of 1/4 per pixel has a derivative of 1/4");
                }
            }
            return {};
        });
    }
}

// Triangles through near, far and the eye plane: each faces one way, whichever part is left of it.
void v14(CaseInput& input) {
    std::mt19937 random(14);
    const auto between = [&random](float low, float high) {
        return low + (high - low) * static_cast<float>(random()) / 4294967296.0f;
    };
    std::vector<ClipPosition> positions;
    for (int i = 0; i < 30; ++i) {
        const float w = between(0.3f, 2);
        positions.push_back({between(-2, 2) * w, between(-2, 2) * w, between(-1, 2) * w, i % 5 == 0 ? -w : w});
    }
    for (size_t first = 0; first + 3 <= positions.size(); first += 3) {
        const std::vector<ClipPosition> one(positions.begin() + static_cast<ptrdiff_t>(first),
                                            positions.begin() + static_cast<ptrdiff_t>(first) + 3);
        CountOptions options;
        options.extent = kTarget;
        const size_t whole = input.scene(countScene("V14", one, options));
        options.cull = VK_CULL_MODE_FRONT_BIT;
        const size_t back = input.scene(countScene("V14_back", one, options));
        options.cull = VK_CULL_MODE_BACK_BIT;
        const size_t front = input.scene(countScene("V14_front", one, options));
        const bool facesFront = TriangleSides({one[0], one[1], one[2]}, viewportOf(kTarget), 8).orientation() < 0;
        judgeSame(input, facesFront ? front : back, whole, "nothing is culled of a triangle that faces the other way");
        judgeEmpty(input, facesFront ? back : front, options, "all parts of the triangle face the way that is culled");
    }
}

constexpr std::string_view kViewport = "Vulkan, Controlling the Viewport";

const std::vector<HardCase> kCases{
    {"V01", "Triangles across a plane of 16384 pixels, at its corners",
     "Exact edge products: 48 bits at 8 sub-pixel bits.", "Vulkan, Basic Polygon Rasterization", v01},
    {"V02", "Viewports that begin outside the target and are larger than it",
     "The picture is the shifted one, within the viewport.", kViewport, v02},
    {"V03", "Viewports between pixels", "As given; an implementation may round them to its viewportSubPixelBits.",
     kViewport, v03},
    {"V04", "Viewports of negative height, culled and not", "y turns over and the winding with it; ties do not.",
     kViewport, v04},
    {"V05", "A viewport without height", "Nothing is drawn.", kViewport, v05},
    {"V06", "A tiling with vertices off the grid at 8K",
     "The same vertex has the same place in every triangle: a partition.", kViewport, v06},
    {"V07", "A picture of grid vertices moved by whole pixels",
     "The same picture: a promise of Vernier's, not of Vulkan's.", "Vernier: exact integers on the grid", v07},
    {"V08", "Flat colours in lists, strips and fans, from even and odd first vertices",
     "The colour of the first vertex of the primitive.", "Vulkan, Flat Shading; Primitive Topologies", v08},
    {"V09", "Restart indices, repeated and with a vertex offset, of 16 and 32 bits",
     "As draws of the pieces; compared before the offset is added.", "Vulkan, Primitive Restart", v09},
    {"V10", "Indices and vertex offsets beyond the vertex buffer",
     "Robust: 0 or a value of the buffer; the triangle is drawn.", "Vulkan, Robust Buffer Access", v10},
    {"V11", "First vertices and instances beyond 2^24, and counts of 0",
     "Numbers are integers; nothing is drawn of nothing.", "Vulkan, Programmable Primitive Shading", v11},
    {"V12", "Attachments of 1 x 1, 3 x 5, 65 x 1, 4095 x 1 and such, with derivatives",
     "Nothing outside; derivatives are right at borders.", "Vulkan, Derivative Operations", v12},
    {"V13", "Multiview and layers, with viewport indices", "Each view and layer by itself: as separate draws.",
     "Vulkan, Multiview; VK_EXT_shader_viewport_index_layer", v13},
    {"V14", "Triangles through near, far and the eye plane, culled front and back", "One facing for all parts.",
     "Vulkan, Basic Polygon Rasterization", v14},
    {"V15", "Flat colours in every topology of triangles and lines, with neighbours, of the first and the last vertex",
     "The provoking vertex of the table, of odd triangles of a strip too.",
     "Vulkan, Flat Shading; Primitive Topologies", v15},
    {"V16", "Strips of triangles and lines out of a geometry shader, ended and begun again, either provoking vertex",
     "Odd triangles are turned: all face one way; counting begins anew with each strip.",
     "Vulkan, Geometry Shader; Flat Shading", v16},
    {"V17", "Layers and viewports that invocations of a geometry shader choose",
     "Each layer by itself: as separate draws.", "Vulkan, Geometry Shader Output; Layered Rendering", v17},
    {"V18", "PrimitiveID through strips with restarts, culled and empty triangles, and instances",
     "Primitives are counted, drawn or not; restarts change nothing; instances begin at 0.", "Vulkan, PrimitiveID",
     v18},
    {"V19", "Levels of all spacings at the ends of their ranges, an ULP beside and beyond: 1, 2, 2 - 2^-23, 62 to 65",
     "Clamped and rounded up to so many segments, seen from either end the same; two of them vanish towards n - 2.",
     "Vulkan, Tessellator Spacing", v19},
};

}  // namespace

std::span<const HardCase> viewportCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
