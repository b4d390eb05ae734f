// Where a swapchain's images become visible.
#pragma once

#include <functional>
#include <memory>

#include "api/vulkan/surface.h"
#include "runtime/resource/image.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {

/// Each swapchain has one, which outlives the memory it gave. allocate() is called where the swapchain is made; show()
/// by one thread at a time.
class Screen {
  public:
    using Done = std::function<void()>;

    Screen() = default;
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    virtual ~Screen() = default;

    /// Memory for an image, of a kind that the window system can read where it has one.
    virtual Result<std::unique_ptr<Memory>> allocate(VkDeviceSize size) = 0;
    /// Shows an image that lies at the start of memory from allocate(). Calls `done` once when its texels are not
    /// needed any more, before it returns or later, from any thread; `done` must not call back.
    /// VK_ERROR_OUT_OF_DATE_KHR: the surface has another size; VK_ERROR_SURFACE_LOST_KHR: it is gone.
    virtual VkResult show(const Image& image, Done done) noexcept = 0;
    /// Whether show() returns when it is time for the next image; otherwise it must be called in time.
    virtual bool setsPace() const { return false; }
    /// From any thread: show() returns soon, and afterwards no `done` is called any more.
    virtual void stop() noexcept {}
};

/// VK_ERROR_SURFACE_LOST_KHR as an empty pointer. May throw std::bad_alloc.
std::unique_ptr<Screen> makeX11Screen(const Surface& surface);
/// `opaque`: what alpha says is of no account; `paced`: the compositor says when the next image is shown. May throw
/// std::system_error, too.
std::unique_ptr<Screen> makeWaylandScreen(const Surface& surface, bool opaque, bool paced);
std::unique_ptr<Screen> makeHeadlessScreen();

}  // namespace vernier::vulkan
