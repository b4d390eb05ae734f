// A window made with Xlib. Xlib's header, full of macros, stays in its source.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace vernier::test {

const char* xlibSurfaceExtension();

class XlibWindow {
  public:
    explicit XlibWindow(VkExtent2D extent);
    XlibWindow(const XlibWindow&) = delete;
    XlibWindow& operator=(const XlibWindow&) = delete;
    ~XlibWindow();

    bool open() const { return display_ != nullptr; }
    uint32_t id() const { return static_cast<uint32_t>(window_); }
    VkSurfaceKHR createSurface(VkInstance instance) const;
    bool supported(VkInstance instance, VkPhysicalDevice device) const;

  private:
    void* display_;
    unsigned long window_ = 0;
};

}  // namespace vernier::test
