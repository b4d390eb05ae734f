// The reference renderer's verdict on a scene: for every pixel of every output, the value and the range of
// values that the Vulkan specification permits.
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vernier::conformance {

enum OracleFlag : uint16_t {
    kOracleEdge = 1,      // what is drawn here is open: low..high spans all legal outcomes; the next four say why
    kOracleUnknown = 2,   // could not be decided; never silently accepted: counted and reported
    kOracleTie = 4,       // a sample lies exactly on an edge
    kOracleSnap = 8,      // a sample is so near to an edge that snapping decides
    kOracleOrder = 16,    // two depths are so near to each other that their precision decides
    kOraclePattern = 32,  // alpha becomes coverage, in whatever pattern
    // Why a value has a range, beside interpolation, which every value may have.
    kOracleWeights = 64,     // weights of a linear filter, of at least the declared bits
    kOracleLevel = 128,      // level of detail
    kOracleUndefined = 256,  // the specification defines no value
    kOracleSequence = 512,   // of what is open: the edges of one polygon come in whatever order
};
using OracleFlags = uint16_t;
/// Those of a pixel whose value cannot be held against anyone to the last digit.
inline constexpr OracleFlags kOracleOpen = kOracleEdge | kOracleUnknown | kOracleUndefined;

/// In decoded component values (linear for sRGB); low..high = what the specification permits.
struct OraclePixel {
    std::array<double, 4> value, low, high;
    OracleFlags flags;
};

struct OracleImage {
    VkFormat format;
    VkExtent2D extent;
    std::vector<OraclePixel> pixels;  // row by row
};

/// Which triangles a sample exactly on an edge belongs to. The specification wants one of the two that share the edge;
/// which one is the implementation's. The last two break that: for explaining what an implementation does.
enum class TieRule : uint8_t {
    topLeft,  // of top and left edges: declared
    bottomRight,
    both,
    neither,
};

/// What the specification leaves to a tessellator; by default as Vernier does (runtime/geometry/tessellator.h).
struct TessellationChoices {
    /// The two additional segments of fractional spacings are next to the middle instead of first and last, and
    /// shorter: of n segments for a level f they are (1 - (n - f) / 2)^2 as long as the others instead of 1 - (n - f)
    /// / 2.
    bool shortInside = false;
    /// Between two edges the triangles on the outer one come first; otherwise the next one is on the edge whose next
    /// segment has its middle first.
    bool outerFirst = false;
    bool otherDiagonals = false;  // of rectangles
    /// Primitives come in the other order, and begin with their last vertex.
    bool turned = false;
};

/// What an implementation declares and the specification leaves to it.
struct OracleRules {
    int subPixelBits = 8;               // subPixelPrecisionBits: vertices are snapped to multiples of 2^-bits pixel
    double vertexFreedom = 1;           // in those, by how much: to either neighbour; 1/2: to the nearest
    double interpolationError = 1e-5;   // of what depends on inputs, relative to the larger of it and 1
    int weightBits = 8;                 // subTexelPrecisionBits: of the weights of linear filters
    double levelSlack = 0x1p-6 + 0.03;  // by how much a level of detail may be off, beyond the accepted scale factors
    // A fragment shader runs once for 2x2 pixels, at the point where they meet, where
    // FragmentShader::mayShadeCoarsely() and one sample per pixel allow it. Not what the specification says unless the
    // application asks.
    bool coarseShading = false;
    // Attributes of Bresenham lines by the major axis alone. Not what the specification says: for explaining what an
    // implementation does.
    bool majorAxisLines = false;
    // The same of depths of samples at x mirrored within the pixel; of depths and inputs extrapolated from snapped
    // vertices behind the eye; of linear blits whose coordinates are truncated instead of floored.
    bool mirroredDepths = false, planesBehindEye = false, truncatedBlits = false;
    TieRule ties = TieRule::topLeft;  // of triangles
    TessellationChoices tessellation{};
};

/// One image per Scene::outputs, in that order. An error with code `unsupported` when the scene uses
/// something the oracle does not model.
Result<std::vector<OracleImage>> renderOracle(const Scene& scene, const OracleRules& rules = {});

}  // namespace vernier::conformance
