#include "api/vulkan/surface.h"

#include <algorithm>
#include <iterator>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"
#include "api/vulkan/format_properties.h"
#include "api/vulkan/wayland_library.h"
#include "api/vulkan/x11_window.h"
#include "runtime/limits.h"

// Of libX11-xcb. Its header would bring Xlib's macros.
extern "C" xcb_connection_t* XGetXCBConnection(Display* display);

namespace vernier::vulkan {
namespace {

constexpr VkFormat kBlueFirst[] = {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB};
constexpr VkFormat kRedFirst[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB};

/// What all images of these formats can be used for.
constexpr VkImageUsageFlags kUsages = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                      VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;

void addFormats(const VkFormat (&formats)[2], SurfaceDescription& to) {
    for (const VkFormat format : formats) to.formats.push_back({format, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR});
}

bool fits(xcb_connection_t* connection, xcb_visualid_t visual, uint32_t queueFamily) {
    return queueFamily == 0 && findVisual(connection, visual).has_value();
}

}  // namespace

VkResult describe(const Surface& surface, SurfaceDescription& description) {
    VkSurfaceCapabilitiesKHR& can = description.capabilities;
    can.minImageCount = kMinSwapchainImages;
    can.maxImageCount = 0;  // as many as memory holds
    can.maxImageArrayLayers = 1;
    can.supportedTransforms = can.currentTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    can.supportedUsageFlags = kUsages;
    description.presentModes = {VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR};
    // A Wayland compositor shows whole pictures alone.
    if (surface.display == nullptr) description.presentModes.push_back(VK_PRESENT_MODE_IMMEDIATE_KHR);
    if (surface.connection == nullptr) {
        can.currentExtent = {UINT32_MAX, UINT32_MAX};  // the swapchain's
        can.minImageExtent = {1, 1};
        can.maxImageExtent = {kMaxImageDimension2D, kMaxImageDimension2D};
        can.supportedCompositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR | VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
        addFormats(kBlueFirst, description);
        if (surface.display == nullptr) {
            addFormats(kRedFirst, description);
        } else {
            can.supportedCompositeAlpha |= VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR;
        }
        return VK_SUCCESS;
    }
    const std::optional<X11Window> window = findWindow(surface.connection, surface.window);
    if (!window) return VK_ERROR_SURFACE_LOST_KHR;
    can.currentExtent = can.minImageExtent = can.maxImageExtent = window->extent;
    can.supportedCompositeAlpha =
        VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR |
        (window->visual.hasAlpha ? VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR : VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR);
    if (window->visual.depth != 0) addFormats(window->visual.redFirst ? kRedFirst : kBlueFirst, description);
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateXcbSurfaceKHR(VkInstance, const VkXcbSurfaceCreateInfoKHR* pCreateInfo,
                                                   const VkAllocationCallbacks* pAllocator, VkSurfaceKHR* pSurface) {
    Surface surface;
    surface.connection = pCreateInfo->connection;
    surface.window = pCreateInfo->window;
    return createHandle(pAllocator, pSurface, std::move(surface));
}

VKAPI_ATTR VkResult VKAPI_CALL CreateXlibSurfaceKHR(VkInstance, const VkXlibSurfaceCreateInfoKHR* pCreateInfo,
                                                    const VkAllocationCallbacks* pAllocator, VkSurfaceKHR* pSurface) {
    Surface surface;
    surface.connection = XGetXCBConnection(pCreateInfo->dpy);
    surface.window = static_cast<xcb_window_t>(pCreateInfo->window);
    return createHandle(pAllocator, pSurface, std::move(surface));
}

VKAPI_ATTR VkResult VKAPI_CALL CreateWaylandSurfaceKHR(VkInstance, const VkWaylandSurfaceCreateInfoKHR* pCreateInfo,
                                                       const VkAllocationCallbacks* pAllocator,
                                                       VkSurfaceKHR* pSurface) {
    Surface surface;
    surface.display = pCreateInfo->display;
    surface.waylandSurface = pCreateInfo->surface;
    return createHandle(pAllocator, pSurface, std::move(surface));
}

VKAPI_ATTR VkResult VKAPI_CALL CreateHeadlessSurfaceEXT(VkInstance, const VkHeadlessSurfaceCreateInfoEXT*,
                                                        const VkAllocationCallbacks* pAllocator,
                                                        VkSurfaceKHR* pSurface) {
    return createHandle(pAllocator, pSurface, Surface{});
}

VKAPI_ATTR void VKAPI_CALL DestroySurfaceKHR(VkInstance, VkSurfaceKHR surface,
                                             const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, surface);
}

VKAPI_ATTR VkBool32 VKAPI_CALL GetPhysicalDeviceXcbPresentationSupportKHR(VkPhysicalDevice, uint32_t queueFamilyIndex,
                                                                          xcb_connection_t* connection,
                                                                          xcb_visualid_t visual_id) {
    return fits(connection, visual_id, queueFamilyIndex) ? VK_TRUE : VK_FALSE;
}

VKAPI_ATTR VkBool32 VKAPI_CALL GetPhysicalDeviceXlibPresentationSupportKHR(VkPhysicalDevice, uint32_t queueFamilyIndex,
                                                                           Display* dpy, VisualID visualID) {
    return fits(XGetXCBConnection(dpy), static_cast<xcb_visualid_t>(visualID), queueFamilyIndex) ? VK_TRUE : VK_FALSE;
}

VKAPI_ATTR VkBool32 VKAPI_CALL GetPhysicalDeviceWaylandPresentationSupportKHR(VkPhysicalDevice,
                                                                              uint32_t queueFamilyIndex, wl_display*) {
    return queueFamilyIndex == 0 && WaylandLibrary::get() != nullptr ? VK_TRUE : VK_FALSE;
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceSupportKHR(VkPhysicalDevice, uint32_t queueFamilyIndex,
                                                                  VkSurfaceKHR surface, VkBool32* pSupported) {
    return guarded([&] {
        SurfaceDescription description;
        const VkResult result = describe(*object(surface), description);
        *pSupported = queueFamilyIndex == 0 && !description.formats.empty() ? VK_TRUE : VK_FALSE;
        return result;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceCapabilitiesKHR(VkPhysicalDevice, VkSurfaceKHR surface,
                                                                       VkSurfaceCapabilitiesKHR* pSurfaceCapabilities) {
    return guarded([&] {
        SurfaceDescription description;
        const VkResult result = describe(*object(surface), description);
        *pSurfaceCapabilities = description.capabilities;
        return result;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceCapabilities2KHR(
    VkPhysicalDevice physicalDevice, const VkPhysicalDeviceSurfaceInfo2KHR* pSurfaceInfo,
    VkSurfaceCapabilities2KHR* pSurfaceCapabilities) {
    return GetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice, pSurfaceInfo->surface,
                                                   &pSurfaceCapabilities->surfaceCapabilities);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceFormatsKHR(VkPhysicalDevice, VkSurfaceKHR surface,
                                                                  uint32_t* pSurfaceFormatCount,
                                                                  VkSurfaceFormatKHR* pSurfaceFormats) {
    return guarded([&] {
        SurfaceDescription description;
        if (const VkResult result = describe(*object(surface), description); result != VK_SUCCESS) return result;
        OutputArray<VkSurfaceFormatKHR> output(pSurfaceFormatCount, pSurfaceFormats);
        for (const VkSurfaceFormatKHR& format : description.formats) output.add(format);
        return output.result();
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfaceFormats2KHR(VkPhysicalDevice,
                                                                   const VkPhysicalDeviceSurfaceInfo2KHR* pSurfaceInfo,
                                                                   uint32_t* pSurfaceFormatCount,
                                                                   VkSurfaceFormat2KHR* pSurfaceFormats) {
    return guarded([&] {
        SurfaceDescription description;
        const VkResult result = describe(*object(pSurfaceInfo->surface), description);
        if (result != VK_SUCCESS) return result;
        OutputArray<VkSurfaceFormat2KHR> output(pSurfaceFormatCount, pSurfaceFormats);
        for (const VkSurfaceFormatKHR& format : description.formats) {
            if (VkSurfaceFormat2KHR* slot = output.next()) slot->surfaceFormat = format;
        }
        return output.result();
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceSurfacePresentModesKHR(VkPhysicalDevice, VkSurfaceKHR surface,
                                                                       uint32_t* pPresentModeCount,
                                                                       VkPresentModeKHR* pPresentModes) {
    return guarded([&] {
        SurfaceDescription description;
        if (const VkResult result = describe(*object(surface), description); result != VK_SUCCESS) return result;
        OutputArray<VkPresentModeKHR> output(pPresentModeCount, pPresentModes);
        for (const VkPresentModeKHR mode : description.presentModes) output.add(mode);
        return output.result();
    });
}

// A group is of one device, which shows its own images on the whole of a surface.

VKAPI_ATTR VkResult VKAPI_CALL
GetDeviceGroupPresentCapabilitiesKHR(VkDevice, VkDeviceGroupPresentCapabilitiesKHR* pCapabilities) {
    std::ranges::fill(pCapabilities->presentMask, 0u);
    pCapabilities->presentMask[0] = 1;
    pCapabilities->modes = VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetDeviceGroupSurfacePresentModesKHR(VkDevice, VkSurfaceKHR,
                                                                    VkDeviceGroupPresentModeFlagsKHR* pModes) {
    *pModes = VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDevicePresentRectanglesKHR(VkPhysicalDevice, VkSurfaceKHR surface,
                                                                     uint32_t* pRectCount, VkRect2D* pRects) {
    return guarded([&] {
        SurfaceDescription description;
        if (const VkResult result = describe(*object(surface), description); result != VK_SUCCESS) return result;
        OutputArray<VkRect2D> output(pRectCount, pRects);
        output.add({{0, 0}, description.capabilities.maxImageExtent});
        return output.result();
    });
}

}  // namespace vernier::vulkan
