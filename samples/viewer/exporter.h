// Pictures written by the viewer: what is seen, without the panel.
#pragma once

#include <functional>
#include <string>

#include "samples/common/app.h"

namespace samples {

struct Exported {
    bool written;
    std::string message;  // what came of it, in words
};

/// The first of folder/viewer-0001.png, viewer-0002.png, ... that is free.
Exported exportScreenshot(App& app, const std::string& folder, const std::function<void()>& draw);

/// folder/turntable-0000.png, ...: `count` pictures; `draw` gets the angle in radians, once round.
Exported exportTurntable(App& app, const std::string& folder, int count, const std::function<void(double)>& draw);

}  // namespace samples
