// What the picture says about itself: which view it is, and what its colours stand for.
#pragma once

#include "samples/viewer/views.h"

namespace samples {

struct LegendText {
    glm::vec2 place;  // pixels: of the upper left corner, or with `end` of the upper right one
    std::string text;
    bool end = false;
};

/// Where the bar of colours lies, in pixels: left, top, right, bottom; all 0 for views that need none. `unit` is the
/// height of a line of text.
glm::vec4 legendBar(ViewKind view, VkExtent2D size, float unit);
/// The lines of a view that was drawn; none for the plain picture.
std::vector<LegendText> legendTexts(const ViewSettings& settings, const Dial& dial, const ViewReport& report,
                                    VkExtent2D size, float unit);

}  // namespace samples
