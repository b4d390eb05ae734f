// Cases about order: triangles with a code each, of which the last one (or the first, with a depth test) must be seen.
#pragma once

#include "conformance/hardcases/coverage_input.h"

namespace vernier::conformance::hardcases {

struct PainterOptions {
    VkExtent2D extent{64, 64};
    bool firstWins = false;  // a LESS depth test at equal depths: later triangles lose
    bool depthTest = false;  // LESS_OR_EQUAL at equal depths: later triangles win
    uint32_t perDraw = 0;    // triangles per draw; 0: all in one
};

/// Triangle i (at most 250) writes code i + 1 into red of an RGBA8 target. Adds the scene and the judge: at every
/// sample the code of the triangle that is to be seen, or of one that a legal snapping can put there.
size_t addPainter(CaseInput& input, std::string_view name, const WindowTriangles& triangles,
                  const PainterOptions& options);

/// Adds the judge alone, for triangles that `scene` draws in its own way, with kCodeFragmentGlsl.
void judgePainter(CaseInput& input, size_t scene, const WindowTriangles& triangles, const PainterOptions& options);
extern const char* const kCodeFragmentGlsl;  // location 0: a flat float, the code

}  // namespace vernier::conformance::hardcases
