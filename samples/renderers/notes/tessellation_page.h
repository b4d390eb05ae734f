// The page on tessellation: four Bezier patches of 16 points each. The upper left quarter has them undivided, with the
// net of their points; then come two levels between whole ones, which the spacings take in their own ways; in the lower
// right one every edge has a level by its distance from the eye, and patches fit together all the same.
#pragma once

#include "samples/renderers/notes/quarters.h"

namespace samples {

class TessellationPage {
  public:
    explicit TessellationPage(App& app);
    /// `spacing`: 0 equal, 1 fractional even, 2 fractional odd.
    void draw(const PageView& view, int spacing);

  private:
    App& app_;
    Quarters quarters_;
    VnProgram surfaces_[3], edges_[3], net_;  // by spacing
    VnBuffer patches_, netLines_;
    uint32_t netVertices_ = 0;
};

}  // namespace samples
