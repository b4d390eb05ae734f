#include "tests/vulkan/xlib_window.h"

#include <vulkan/vulkan.h>
#include <X11/Xlib.h>

#include <vulkan/vulkan_xlib.h>

namespace vernier::test {

const char* xlibSurfaceExtension() {
    return VK_KHR_XLIB_SURFACE_EXTENSION_NAME;
}

XlibWindow::XlibWindow(VkExtent2D extent) : display_(XOpenDisplay(nullptr)) {
    if (display_ == nullptr) return;
    auto* display = static_cast<Display*>(display_);
    window_ = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, extent.width, extent.height, 0, 0, 0);
    XMapWindow(display, window_);
    XSync(display, False);
}

XlibWindow::~XlibWindow() {
    if (display_ != nullptr) XCloseDisplay(static_cast<Display*>(display_));
}

VkSurfaceKHR XlibWindow::createSurface(VkInstance instance) const {
    VkXlibSurfaceCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_XLIB_SURFACE_CREATE_INFO_KHR;
    info.dpy = static_cast<Display*>(display_);
    info.window = window_;
    const auto create =
        reinterpret_cast<PFN_vkCreateXlibSurfaceKHR>(vkGetInstanceProcAddr(instance, "vkCreateXlibSurfaceKHR"));
    VkSurfaceKHR made = VK_NULL_HANDLE;
    return create(instance, &info, nullptr, &made) == VK_SUCCESS ? made : VK_NULL_HANDLE;
}

bool XlibWindow::supported(VkInstance instance, VkPhysicalDevice device) const {
    auto* display = static_cast<Display*>(display_);
    const auto supports = reinterpret_cast<PFN_vkGetPhysicalDeviceXlibPresentationSupportKHR>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceXlibPresentationSupportKHR"));
    return supports(device, 0, display, XVisualIDFromVisual(DefaultVisual(display, DefaultScreen(display)))) == VK_TRUE;
}

}  // namespace vernier::test
