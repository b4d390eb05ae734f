// The one list of numeric cases: it declares the functions that cases_*.cpp define and makes the table of
// cases.cpp.
#pragma once

#include "conformance/oracle/cases.h"

// X(name, description)
#define VERNIER_NUMERIC_CASES(X)                                                                          \
    /* cases_coverage.cpp */                                                                              \
    X(E01, "Quads split along a diagonal through pixel centres: every centre belongs to one triangle.")   \
    X(E02, "The same two triangles in all vertex orders and windings: the same coverage.")                \
    X(E06, "A random tiling with vertices on the sub-pixel grid: a partition.")                           \
    X(E07, "A random tiling with vertices off the grid: a partition of the snapped tiling.")              \
    X(E10, "A sliver whose float area is zero, between its neighbours: its 24 centres are covered once.") \
    X(E11, "Triangles without area: no fragments.")                                                       \
    /* cases_homogeneous.cpp */                                                                           \
    X(C02, "Triangles sharing an edge that the near plane cuts: a partition across the clip.")            \
    X(W06, "Clip coordinates scaled by powers of two, up to overflow of their products: the same image.") \
    X(I01, "Attributes equal at all vertices, in perspective: constant to the bit.")                      \
    X(I02, "One-pixel triangles 4000 pixels from the origin: the error does not grow with the distance.") \
    /* cases_output.cpp */                                                                                \
    X(D03, "The same triangles drawn again with an EQUAL depth test: every fragment passes.")             \
    X(B01, "0.25 cleared and written to RGBA8: 63.75 becomes 64 (63 is legal), the same everywhere.")     \
    X(B02, "0.5 to RGBA8, the one exact tie: 127 or 128, the same everywhere.")                           \
    X(B03, "Every code read and written unchanged, in four UNORM formats: the identity.")                 \
    X(B04, "Every sRGB code read and written: the identity.")

namespace vernier::conformance::cases {

#define VERNIER_DECLARE_CASE(name, description) \
    Result<std::vector<Scene>> build##name();   \
    Status check##name(const CaseImages& images, Strictness strictness);
VERNIER_NUMERIC_CASES(VERNIER_DECLARE_CASE)
#undef VERNIER_DECLARE_CASE

}  // namespace vernier::conformance::cases
