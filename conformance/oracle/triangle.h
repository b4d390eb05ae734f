// One triangle of a draw as the oracle rasterises it: where samples must, may or must not be covered, and its
// depth.
//
// Nominal coverage is the declared one: vertices snapped to nearest even on the sub-pixel grid, exact integers,
// top-left ties. What is open is decided on the unsnapped vertices, each free to move by one sub-unit,
// or what the rules say (plus float rounding of the viewport transform). Triangles that cross the eye plane or reach
// very far out are tested in homogeneous coordinates, unsnapped: new vertices of a clipper would themselves be snapped
// within the same freedom. Near, far, the sides of the viewport and user clip planes are half-space tests at the
// sample, open within a sub-unit of the cut.
#pragma once

#include "conformance/oracle/coverage.h"
#include "conformance/oracle/homogeneous.h"
#include "conformance/oracle/interval.h"
#include "conformance/oracle/oracle.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vernier::conformance::exact {

/// An edge or cut that a legal implementation may put on either side of a sample. All primitives with the
/// same key must take the same side: their edges have the same two vertices.
struct OpenEdge {
    uint64_t key = 0;
    bool insideSide = false;     // the side, relative to the key, that is inside this triangle
    bool nominalInside = false;  // the declared answer
    bool tie = false;            // the sample lies on the edge exactly
};

struct SampleVerdict {
    bool possible = false;  // false: no legal implementation covers the sample; nothing below counts
    bool openAsWhole = false;
    bool nominalAsWhole = false;  // the declared answer when openAsWhole
    std::array<OpenEdge, 3> edges{};
    uint32_t edgeCount = 0;
    bool cutOpen = false, cutNominal = false;  // all clip planes together

    /// Covered by every legal implementation.
    bool isCertain() const { return possible && !openAsWhole && edgeCount == 0 && !cutOpen; }
    /// Covered by the declared rules.
    bool isNominal() const {
        bool inside = possible && (!openAsWhole || nominalAsWhole) && (!cutOpen || cutNominal);
        for (uint32_t i = 0; i < edgeCount; ++i) inside = inside && edges[i].nominalInside;
        return inside;
    }
};

/// A point in sub-units.
struct PixelBounds {
    int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half-open
    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

class Triangle {
  public:
    struct Setup {
        std::array<Clip<double>, 3> position;
        VkViewport viewport;
        bool depthClip = true;
        std::vector<std::array<double, 3>> clipDistances;  // per distance: the three vertices' values
        uint64_t context = 0;  // vertices with equal clip coordinates snap alike within a context
        // Of OracleRules.
        int subPixelBits = 8;
        double vertexFreedom = 1;
        bool planesBehindEye = false;
        TieRule ties = TieRule::topLeft;
    };

    /// Nothing when no implementation draws any of it.
    static std::optional<Triangle> create(const Setup& setup);

    /// What carries depths, inputs and clipping of a line or a point, whose coverage it does not tell: a triangle of
    /// the two ends and a point beside the first that has all of the first's values, so that everything interpolated
    /// depends on the place along the line alone. For a point both ends are its vertex. Nothing when an end is not in
    /// front of the eye or not finite, or when all is clipped.
    static std::optional<Triangle> createCarrier(const Setup& setup, bool majorAxis = false);
    /// Half-space tests of the cuts alone.
    SampleVerdict classifyCuts(const GridPoint& sample) const;

    /// +1 clockwise on the screen, -1 counter-clockwise, 0: empty after snapping.
    int orientation() const { return orientation_; }
    /// A legal snapping may give it the other orientation or no area.
    bool orientationOpen() const { return orientationOpen_; }

    PixelBounds bounds(const PixelBounds& within) const;
    SampleVerdict classify(const GridPoint& sample) const;

    const HomogeneousTriangle<double>& homogeneous() const { return shape_; }
    /// How far a point of the triangle may move, in pixels.
    double freedomAt(double x, double y) const { return freedom_ * leverage(x, y); }

    /// Window depth at a sample before clamping, with the freedom of snapping and of float interpolation.
    Interval depth(const GridPoint& sample) const;
    std::array<double, 3> vertexDepths() const;
    double depthSlopeX() const { return slopeX_; }
    double depthSlopeY() const { return slopeY_; }
    /// Equal for equal vertices in equal order: such triangles have the same depths (Vulkan, Invariance).
    uint64_t identity() const { return identity_; }

  private:
    explicit Triangle(const HomogeneousTriangle<double>& shape) : shape_(shape) {}

    bool addCuts(const Setup& setup);
    /// By how much vertices that move at most so far move a point at most: 1 inside of all three, more where planes
    /// through snapped vertices behind the eye are followed.
    double leverage(double x, double y) const;
    void findDepths(const Setup& setup);

    SampleVerdict classifySnapped(const GridPoint& sample) const;
    SampleVerdict classifyHomogeneous(const GridPoint& sample) const;
    void applyCuts(const GridPoint& sample, SampleVerdict& verdict) const;
    OpenEdge openEdge(size_t oppositeVertex, bool nominalInside, bool tie) const;
    /// What the rule says of a sample exactly on an edge; nothing where it is one triangle's and not the other's.
    std::optional<bool> tieForAll() const;
    bool tieInside(bool topLeft) const { return topLeft == (ties_ == TieRule::topLeft); }

    HomogeneousTriangle<double> shape_;
    bool snapped_ = false, planesBehindEye_ = false;
    TieRule ties_ = TieRule::topLeft;
    double side_ = 1;  // sign that makes edge functions positive inside
    int orientation_ = 0;
    bool orientationOpen_ = false;
    double subUnit_ = 1.0 / 256;  // pixels
    double freedom_ = 0;
    std::array<std::array<double, 2>, 3> window_{};  // snapped_: unsnapped positions
    GridTriangle grid_{};
    std::array<uint64_t, 3> edgeKey_{};        // of the edge opposite each vertex
    std::array<bool, 3> edgeForward_{};        // the edge runs along its key's direction
    std::vector<std::array<double, 3>> cuts_;  // per plane: the vertices' distances
    double slopeX_ = 0, slopeY_ = 0;
    double depthSlack_ = 0;
    uint64_t identity_ = 0;
};

/// 64-bit FNV-1a over the bits of some doubles.
uint64_t hashNumbers(uint64_t seed, const double* numbers, size_t count);

}  // namespace vernier::conformance::exact
