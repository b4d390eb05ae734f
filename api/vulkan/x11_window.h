// What an X server tells about a window that images are to be shown on.
#pragma once

#include <cstdlib>
#include <memory>
#include <optional>

#include "api/vulkan/window_system.h"

namespace vernier::vulkan {

struct FreeReply {
    void operator()(void* reply) const { std::free(reply); }
};
/// What libxcb hands out is freed with free().
template <class T>
using XcbReply = std::unique_ptr<T, FreeReply>;

/// How the texels of a visual lie in memory: four bytes each.
struct X11Visual {
    uint8_t depth = 0;
    bool redFirst = false;  // R8G8B8A8; otherwise B8G8R8A8
    bool hasAlpha = false;
};

struct X11Window {
    VkExtent2D extent{};
    X11Visual visual;
};

/// Empty for a visual whose texels are not four bytes of red, green, blue in a known order.
std::optional<X11Visual> findVisual(xcb_connection_t* connection, xcb_visualid_t id);

/// Empty when the window, or the connection, is gone; a visual of depth 0 is one that nothing can be shown on.
std::optional<X11Window> findWindow(xcb_connection_t* connection, xcb_window_t window);

}  // namespace vernier::vulkan
