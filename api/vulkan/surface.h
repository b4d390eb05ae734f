// Surfaces: a window of an X server, or nothing that is seen.
#pragma once

#include <memory>
#include <vector>

#include "api/vulkan/handle.h"
#include "api/vulkan/window_system.h"

namespace vernier::vulkan {

class Presenter;

struct Surface {
    xcb_connection_t* connection = nullptr;  // nullptr: headless
    xcb_window_t window = 0;
    /// Of the last swapchain made for it.
    std::weak_ptr<Presenter> presenter;
};

/// Fewer cannot be drawn to while one is shown.
inline constexpr uint32_t kMinSwapchainImages = 2;

struct SurfaceDescription {
    VkSurfaceCapabilitiesKHR capabilities{};
    std::vector<VkSurfaceFormatKHR> formats;  // empty: nothing can be shown
};

/// VK_ERROR_SURFACE_LOST_KHR when the window is gone.
VkResult describe(const Surface& surface, SurfaceDescription& description);

bool isPresentMode(VkPresentModeKHR mode);

}  // namespace vernier::vulkan
