#include "samples/common/window.h"

#include <SDL.h>

#include <cstdio>
#include <cstdlib>

namespace samples {
namespace {

[[noreturn]] void stop() {
    std::fprintf(stderr, "no window: %s (try --headless OUT.png)\n", SDL_GetError());
    std::exit(1);
}

/// 0 for keys the samples have no use for.
int keyOf(SDL_Keycode code) {
    switch (code) {
        case SDLK_LEFT:
            return kKeyLeft;
        case SDLK_RIGHT:
            return kKeyRight;
        case SDLK_UP:
            return kKeyUp;
        case SDLK_DOWN:
            return kKeyDown;
        case SDLK_LSHIFT:
        case SDLK_RSHIFT:
            return kKeyShift;
        case SDLK_LCTRL:
        case SDLK_RCTRL:
            return kKeyControl;
        case SDLK_F1:
            return kKeyF1;
        case SDLK_F11:
            return kKeyF11;
        case SDLK_F12:
            return kKeyF12;
        default:
            return code < 128 ? code : 0;
    }
}

}  // namespace

Window::Window(const std::string& title, uint32_t width, uint32_t height) {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) stop();
    // The pixels lie in memory: textures of another renderer on the way would be a copy more.
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    window_ = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, static_cast<int>(width),
                               static_cast<int>(height), SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    if (!window_) stop();
    measure();
}

void Window::measure() {
    int unitsWide = 1, unitsHigh = 1, pixelsWide = 1, pixelsHigh = 1;
    SDL_GetWindowSize(window_, &unitsWide, &unitsHigh);
    SDL_GetWindowSizeInPixels(window_, &pixelsWide, &pixelsHigh);
    width_ = static_cast<uint32_t>(SDL_max(pixelsWide, 1));
    height_ = static_cast<uint32_t>(SDL_max(pixelsHigh, 1));
    pixelRatio_ = static_cast<float>(width_) / static_cast<float>(SDL_max(unitsWide, 1));
}

Window::~Window() {
    SDL_DestroyWindow(window_);
    SDL_Quit();
}

bool Window::poll(Input& input) {
    input.pressed.clear();
    input.mouseMove = glm::vec2(0);
    input.wheel = 0;
    input.dropped.clear();
    bool open = true;
    for (SDL_Event event; SDL_PollEvent(&event);) {
        switch (event.type) {
            case SDL_QUIT:
                open = false;
                break;
            case SDL_KEYDOWN:
                if (event.key.keysym.sym == SDLK_ESCAPE) open = false;
                if (const int key = keyOf(event.key.keysym.sym)) {
                    if (!event.key.repeat) input.pressed.push_back(key);
                    input.held.insert(key);
                }
                break;
            case SDL_KEYUP:
                input.held.erase(keyOf(event.key.keysym.sym));
                break;
            case SDL_MOUSEMOTION:
                input.mouse = glm::vec2(event.motion.x, event.motion.y) * pixelRatio_;
                input.mouseMove += glm::vec2(event.motion.xrel, event.motion.yrel) * pixelRatio_;
                break;
            case SDL_MOUSEBUTTONDOWN:
            case SDL_MOUSEBUTTONUP:
                if (event.button.button == SDL_BUTTON_LEFT) input.dragging = event.type == SDL_MOUSEBUTTONDOWN;
                break;
            case SDL_MOUSEWHEEL:
                input.wheel += static_cast<float>(event.wheel.y);
                break;
            case SDL_DROPFILE:
                input.dropped.emplace_back(event.drop.file);
                SDL_free(event.drop.file);
                break;
            // A key that goes up elsewhere is not told.
            case SDL_WINDOWEVENT:
                if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) input.held.clear();
                break;
            default:
                break;
        }
    }
    measure();
    return open;
}

void Window::show(std::vector<uint32_t>& pixels, uint32_t width, uint32_t height) {
    SDL_Surface* image =
        SDL_CreateRGBSurfaceWithFormatFrom(pixels.data(), static_cast<int>(width), static_cast<int>(height), 32,
                                           static_cast<int>(width * 4), SDL_PIXELFORMAT_RGBA32);
    if (!image) stop();
    SDL_BlitSurface(image, nullptr, SDL_GetWindowSurface(window_), nullptr);
    SDL_UpdateWindowSurface(window_);
    SDL_FreeSurface(image);
}

void Window::setTitle(const std::string& title) {
    SDL_SetWindowTitle(window_, title.c_str());
}

}  // namespace samples
