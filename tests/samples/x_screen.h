// An X server as a user has it: windows to look at, keys to press, files to let fall. Xlib's header, full of macros,
// stays in its source.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace samples::test {

struct ScreenPicture {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> pixels;  // 0x00RRGGBB, row by row from the top
};

class XScreen {
  public:
    /// The server of DISPLAY; open() tells whether there is one that can fake keys.
    XScreen();
    ~XScreen();
    XScreen(const XScreen&) = delete;
    XScreen& operator=(const XScreen&) = delete;
    bool open() const { return display_ != nullptr; }

    using WindowId = unsigned long;
    /// The window whose title starts so, once it is there and can be seen; 0 when it does not come within half a
    /// minute.
    WindowId find(const std::string& title);
    ScreenPicture look(WindowId window);
    /// Down and up. `key` as X names keys: "v", "F1", "Left", "Escape".
    void press(WindowId window, const std::string& key);
    void hold(WindowId window, const std::string& key, bool down);
    /// Moves the mouse to one place of the window, presses the left button, moves on to another, and lets go.
    void drag(WindowId window, int fromX, int fromY, int toX, int toY);
    void resize(WindowId window, uint32_t width, uint32_t height);
    /// Lets a file fall on a window, by the protocol XDND 5. False when the window does not take it within half a
    /// minute.
    bool drop(WindowId window, const std::string& path);

  private:
    void* display_;
};

}  // namespace samples::test
