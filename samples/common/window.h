// A window by SDL2 that shows pixels from memory and tells what the user does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "samples/common/input.h"

struct SDL_Window;

namespace samples {

/// Ends the program with a message when no window can be opened.
class Window {
  public:
    Window(const std::string& title, uint32_t width, uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Brings `input` up to date; false once the window was closed or Escape pressed.
    bool poll(Input& input);
    /// width x height RGBA8 pixels, row by row from the top.
    void show(std::vector<uint32_t>& pixels);
    void setTitle(const std::string& title);

  private:
    SDL_Window* window_ = nullptr;
    uint32_t width_, height_;
};

}  // namespace samples
