// What the user does: keys and mouse of one frame. Without a window nothing ever happens.
#pragma once

#include <glm/glm.hpp>
#include <set>
#include <string>
#include <vector>

namespace samples {

// Keys are lower-case ASCII where there is a character, else one of these.
enum Key : int { kKeyLeft = 256, kKeyRight, kKeyUp, kKeyDown, kKeyShift, kKeyControl, kKeyF1, kKeyF11, kKeyF12 };

struct Input {
    std::set<int> held;
    std::vector<int> pressed;          // went down since the last frame
    glm::vec2 mouse{0};                // pixels from the upper left corner
    glm::vec2 mouseMove{0};            // since the last frame
    float wheel = 0;                   // notches since the last frame, away from the user
    bool dragging = false;             // the left button is down
    std::vector<std::string> dropped;  // files let fall on the window since the last frame

    bool isHeld(int key) const { return held.count(key) != 0; }
    /// 1, 0 or -1.
    float axis(int negative, int positive) const {
        return static_cast<float>(isHeld(positive)) - static_cast<float>(isHeld(negative));
    }
};

}  // namespace samples
