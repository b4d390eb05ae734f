// Surfaces: a window of an X server, one of a Wayland compositor, or nothing that is seen.
#pragma once

#include <memory>
#include <vector>

#include "api/vulkan/handle.h"
#include "api/vulkan/window_system.h"

namespace vernier::vulkan {

class Presenter;

struct Surface {
    // Of an X server.
    xcb_connection_t* connection = nullptr;
    xcb_window_t window = 0;
    // Of a Wayland compositor.
    wl_display* display = nullptr;
    wl_surface* waylandSurface = nullptr;
    /// Of the last swapchain made for it.
    std::weak_ptr<Presenter> presenter;
};

/// Fewer cannot be drawn to while one is shown.
inline constexpr uint32_t kMinSwapchainImages = 2;

struct SurfaceDescription {
    VkSurfaceCapabilitiesKHR capabilities{};
    std::vector<VkPresentModeKHR> presentModes;
    std::vector<VkSurfaceFormatKHR> formats;  // empty: nothing can be shown
};

/// VK_ERROR_SURFACE_LOST_KHR when the window is gone.
VkResult describe(const Surface& surface, SurfaceDescription& description);

}  // namespace vernier::vulkan
