// The accuracy dial, as the library lists it: a profile, and each axis on its own.
#pragma once

#include <vernier/vernier_accuracy.h>

#include <string>
#include <vector>

#include "samples/common/options.h"

namespace samples {

/// Where a program is drawn: what VnProgramDesc takes.
struct DialPosition {
    VnProfile profile = VN_PROFILE_STANDARD;
    std::string axes;  // "subpixel=4 math=fine"
};

constexpr int kProfileCount = 5;

class Dial {
  public:
    Dial();
    Dial(const Dial&) = delete;
    Dial& operator=(const Dial&) = delete;

    struct Axis {
        std::string name, meaning;
        std::vector<std::string> choices;  // "profile", then the positions from cheap to exact
        size_t lowestForVulkan = 0;        // of the positions
        int chosen = 0;                    // of the choices
    };

    /// --profile, and one option per axis; keys P and 1, 2, ...
    std::vector<Option> options();
    DialPosition position() const;
    /// "draft", or "standard, subpixel 4".
    std::string text() const;
    /// Where an axis stands, by its profile or on its own.
    const std::string& positionOf(const Axis& axis) const;

    int& profile() { return profile_; }
    const std::vector<std::string>& profileNames() const { return profileNames_; }
    std::vector<Axis>& axes() { return axes_; }
    const std::vector<Axis>& axes() const { return axes_; }

  private:
    int profile_ = VN_PROFILE_STANDARD - VN_PROFILE_DRAFT;  // from draft, 0, to reference
    std::vector<std::string> profileNames_{"draft", "fast", "standard", "fine", "reference"};
    std::vector<Axis> axes_;
};

}  // namespace samples
