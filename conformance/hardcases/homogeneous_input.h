// Triangles in clip coordinates: exact sides of samples, for cases about clipping and w.
#pragma once

#include "conformance/hardcases/coverage_input.h"
#include "conformance/oracle/homogeneous.h"

#include <algorithm>

namespace vernier::conformance::hardcases {

using ClipTriangle = std::array<ClipPosition, 3>;

/// In exact arithmetic, in window coordinates times w.
exact::HomogeneousTriangle<exact::Rational> exactTriangle(const ClipTriangle& triangle, const VkViewport& viewport);

enum class Side : uint8_t { inside, open, outside };

/// What is known of a sample: open where moving it by one sub-unit can change the answer.
struct SampleSides {
    std::array<Side, 3> edge{};  // opposite each vertex
    Side clip = Side::inside;    // near and far together
    Side worst() const { return std::max({edge[0], edge[1], edge[2], clip}); }
};

/// Answers for the samples of one triangle. Rationals decide; doubles answer where they are far enough from 0 to be
/// sure.
class TriangleSides {
  public:
    TriangleSides(const ClipTriangle& clip, const VkViewport& viewport, int subPixelBits);
    /// Of the homogeneous determinant: > 0 clockwise on the screen, 0 without area.
    int orientation() const { return orientation_; }
    /// At the centre of a pixel.
    SampleSides at(uint32_t x, uint32_t y) const;

  private:
    /// A linear function of the place that is positive inside.
    struct Line {
        std::array<exact::Rational, 3> exactly;
        std::array<double, 3> nearly;
    };
    static Line lineOf(const std::array<exact::Rational, 3>& coefficients);
    Side sideOf(const Line& line, uint32_t x, uint32_t y) const;

    std::array<Line, 3> edges_;
    std::array<Line, 2> cuts_;  // near, far
    int orientation_ = 0;
    double subUnit_;
};

/// Adds a judge: every sample is covered by at least the triangles that it lies inside of, and at most by those that it
/// does not lie outside of. Where nothing is open the count is exact.
void judgeSides(CaseInput& input, size_t scene, const std::vector<ClipTriangle>& triangles, VkExtent2D extent);

std::vector<ClipPosition> flatten(const std::vector<ClipTriangle>& triangles);

/// A vertex with a position and four numbers that the fragment shader sees.
struct ColorVertex {
    ClipPosition position;
    std::array<float, 4> color;
};

extern const char* const kColorVertexGlsl;  // locations 0 and 1: vec4 to gl_Position, vec4 to location 0

/// Draws vertices with their colours interpolated in perspective into one target, through a geometry shader if there is
/// one.
Result<Scene> colorScene(std::string_view name, const std::vector<ColorVertex>& vertices, VkExtent2D extent,
                         VkFormat format = VK_FORMAT_R8G8B8A8_UNORM,
                         VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
                         std::string_view geometryGlsl = {});

/// The same with two targets of floats: smooth and noperspective.
Result<Scene> interpolationScene(std::string_view name, const std::vector<ColorVertex>& vertices, VkExtent2D extent);

}  // namespace vernier::conformance::hardcases
