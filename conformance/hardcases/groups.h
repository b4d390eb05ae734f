// The one list of groups: it declares what group_*.cpp define and makes the table of catalogue.cpp.
#pragma once

#include "conformance/hardcases/hard_case.h"

// X(letter, function, title)
#define VERNIER_CASE_GROUPS(X)                                  \
    X('E', edgeCases, "Coverage and edges")                     \
    X('C', clippingCases, "Clipping")                           \
    X('W', homogeneousCases, "w near zero and guard band")      \
    X('I', interpolationCases, "Interpolation and perspective") \
    X('L', levelCases, "Derivatives and level of detail")       \
    X('T', textureCases, "Texture filtering and addressing")    \
    X('D', depthCases, "Depth precision, bias, clamp")          \
    X('S', stencilCases, "Stencil")                             \
    X('M', multisampleCases, "Multisampling")                   \
    X('B', blendingCases, "Blending, rounding, formats")        \
    X('P', lineAndPointCases, "Lines and points")               \
    X('N', specialValueCases, "NaN, infinities, denormals")     \
    X('X', arithmeticCases, "Shader arithmetic")                \
    X('G', integerCases, "Integer operations")                  \
    X('V', viewportCases, "Set-up overflow, viewport, topology")

namespace vernier::conformance::hardcases {

#define VERNIER_DECLARE_GROUP(letter, function, title) std::span<const HardCase> function();
VERNIER_CASE_GROUPS(VERNIER_DECLARE_GROUP)
#undef VERNIER_DECLARE_GROUP

}  // namespace vernier::conformance::hardcases
