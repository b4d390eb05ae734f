// A window by SDL2 that shows pixels from memory and tells what the user does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "samples/common/input.h"

struct SDL_Window;

namespace samples {

/// The user may resize it. Ends the program with a message when no window can be opened.
class Window {
  public:
    Window(const std::string& title, uint32_t width, uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Brings `input` up to date; false once the window was closed or Escape pressed.
    bool poll(Input& input);
    /// In pixels, which may be smaller than the units that windows and mice are measured in.
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    /// Pixels per such unit: 2 on many screens of high density.
    float pixelRatio() const { return pixelRatio_; }
    /// RGBA8 pixels, width x height, row by row from the top.
    void show(std::vector<uint32_t>& pixels, uint32_t width, uint32_t height);
    void setTitle(const std::string& title);

  private:
    void measure();

    SDL_Window* window_ = nullptr;
    uint32_t width_ = 1, height_ = 1;
    float pixelRatio_ = 1;
};

}  // namespace samples
