// Where a swapchain's images become visible.
#pragma once

#include <memory>

#include "api/vulkan/surface.h"
#include "runtime/resource/image.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {

/// Each swapchain has one, which outlives the memory it gave. allocate() is called where the swapchain is made; show()
/// by one thread at a time.
class Screen {
  public:
    Screen() = default;
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    virtual ~Screen() = default;

    /// Memory for an image, of a kind that the window system can read where it has one.
    virtual Result<std::unique_ptr<Memory>> allocate(VkDeviceSize size) = 0;
    /// Shows an image that lies at the start of memory from allocate(), and returns when its texels are not needed any
    /// more. VK_ERROR_OUT_OF_DATE_KHR: the surface has another size; VK_ERROR_SURFACE_LOST_KHR: it is gone.
    virtual VkResult show(const Image& image) noexcept = 0;
};

/// VK_ERROR_SURFACE_LOST_KHR as an empty pointer. May throw std::bad_alloc.
std::unique_ptr<Screen> makeX11Screen(const Surface& surface);
std::unique_ptr<Screen> makeHeadlessScreen();

}  // namespace vernier::vulkan
