// Pictures written by the viewer: what is seen, without the panel.
#pragma once

#include <functional>
#include <string>

#include "samples/common/app.h"

namespace samples {

/// The first of folder/viewer-0001.png, viewer-0002.png, ... that is free. Returns what came of it, in words.
std::string exportScreenshot(App& app, const std::string& folder, const std::function<void()>& draw);

/// folder/turntable-0000.png, ...: `count` pictures; `draw` gets the angle in radians, once round. Returns what came of
/// it.
std::string exportTurntable(App& app, const std::string& folder, int count, const std::function<void(double)>& draw);

}  // namespace samples
