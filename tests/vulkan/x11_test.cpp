// Presenting on windows of an X server: what was rendered is what the window shows. Needs a server: DISPLAY.
#include <xcb/xcb.h>

#include <vulkan/vulkan.h>
#include <vulkan/vulkan_xcb.h>

#include <memory>
#include <thread>

#include "tests/vulkan/test_swapchain.h"
#include "tests/vulkan/xlib_window.h"

namespace vernier::test {
namespace {

class X11Test : public PresentTest {
  protected:
    std::vector<const char*> moreInstanceExtensions() override {
        return {VK_KHR_SURFACE_EXTENSION_NAME, VK_KHR_XCB_SURFACE_EXTENSION_NAME, xlibSurfaceExtension()};
    }
    void SetUp() override {
        connection = xcb_connect(nullptr, nullptr);
        ASSERT_EQ(xcb_connection_has_error(connection), 0) << "no X server at DISPLAY";
        window = makeWindow(kSwapchainExtent);
        PresentTest::SetUp();
    }
    void TearDown() override {
        PresentTest::TearDown();
        xcb_disconnect(connection);
    }
    xcb_window_t makeWindow(VkExtent2D extent) {
        const xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(connection)).data;
        const xcb_window_t made = xcb_generate_id(connection);
        xcb_create_window(connection, XCB_COPY_FROM_PARENT, made, screen->root, 0, 0,
                          static_cast<uint16_t>(extent.width), static_cast<uint16_t>(extent.height), 0,
                          XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, nullptr);
        xcb_map_window(connection, made);
        finish();
        return made;
    }
    /// Waits until the server has done what it was asked.
    void finish() { std::free(xcb_get_input_focus_reply(connection, xcb_get_input_focus(connection), nullptr)); }
    VkSurfaceKHR surfaceOf(xcb_window_t of) {
        auto info = make<VkXcbSurfaceCreateInfoKHR>(VK_STRUCTURE_TYPE_XCB_SURFACE_CREATE_INFO_KHR);
        info.connection = connection;
        info.window = of;
        const auto create =
            reinterpret_cast<PFN_vkCreateXcbSurfaceKHR>(vkGetInstanceProcAddr(instance, "vkCreateXcbSurfaceKHR"));
        VkSurfaceKHR made = VK_NULL_HANDLE;
        EXPECT_EQ(create(instance, &info, nullptr, &made), VK_SUCCESS);
        return made;
    }
    VkSurfaceKHR createSurface() override { return surfaceOf(window); }

    /// Whether the window comes to show the pattern of a frame, pixel by pixel, before time is out.
    bool shows(xcb_window_t of, VkExtent2D extent, uint32_t frame) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        while (std::chrono::steady_clock::now() < deadline) {
            const auto cookie =
                xcb_get_image(connection, XCB_IMAGE_FORMAT_Z_PIXMAP, of, 0, 0, static_cast<uint16_t>(extent.width),
                              static_cast<uint16_t>(extent.height), ~0u);
            const std::unique_ptr<xcb_get_image_reply_t, decltype(&std::free)> reply(
                xcb_get_image_reply(connection, cookie, nullptr), &std::free);
            if (!reply) return false;
            if (isPattern(reinterpret_cast<const uint32_t*>(xcb_get_image_data(reply.get())), extent, frame))
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }

    xcb_connection_t* connection = nullptr;
    xcb_window_t window = 0;
};

TEST_F(X11Test, surfacesFollowTheirWindow) {
    EXPECT_EQ(capabilities.currentExtent.width, kSwapchainExtent.width);
    EXPECT_EQ(capabilities.currentExtent.height, kSwapchainExtent.height);
    ASSERT_EQ(formats.size(), 2u);
    EXPECT_EQ(formats[0].format, VK_FORMAT_B8G8R8A8_UNORM);
    EXPECT_EQ(formats[1].format, VK_FORMAT_B8G8R8A8_SRGB);
    const xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(connection)).data;
    const auto supports = reinterpret_cast<PFN_vkGetPhysicalDeviceXcbPresentationSupportKHR>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceXcbPresentationSupportKHR"));
    EXPECT_TRUE(supports(physicalDevice, 0, connection, screen->root_visual));
    EXPECT_FALSE(supports(physicalDevice, 0, connection, 0xFFFFFF));
}

TEST_F(X11Test, windowsShowWhatWasRendered) {
    for (const VkPresentModeKHR mode : modes) {
        auto info = swapchainInfo(mode);
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        const VkFence fence = makeFence();
        for (uint32_t frame = 0; frame < 5; ++frame) {
            ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, frame, fence), VK_SUCCESS);
            ASSERT_TRUE(shows(window, kSwapchainExtent, frame)) << mode << ", frame " << frame;
        }
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        vkDestroySwapchainKHR(device, swapchain, nullptr);
    }
}

TEST_F(X11Test, rowsOfEveryWidth) {
    // Requests that carry texels are cut into rows, whose pitch in an image is another.
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {64, 64}, {333, 7}, {1100, 700}}) {
        const xcb_window_t other = makeWindow(extent);
        const VkSurfaceKHR on = surfaceOf(other);
        VkBool32 supported = VK_FALSE;
        ASSERT_EQ(vkGetPhysicalDeviceSurfaceSupportKHR(physicalDevice, 0, on, &supported), VK_SUCCESS);
        VkSurfaceCapabilitiesKHR seen{};
        ASSERT_EQ(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice, on, &seen), VK_SUCCESS);
        auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
        info.surface = on;
        info.imageExtent = extent;
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        ASSERT_EQ(presentPattern(swapchain, extent, 9, makeFence()), VK_SUCCESS);
        EXPECT_TRUE(shows(other, extent, 9)) << extent.width;
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        vkDestroySwapchainKHR(device, swapchain, nullptr);
        vkDestroySurfaceKHR(instance, on, nullptr);
        xcb_destroy_window(connection, other);
    }
}

TEST_F(X11Test, resizedWindowsMakeSwapchainsOutOfDate) {
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_FIFO_KHR));
    const VkFence fence = makeFence();
    ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, 0, fence), VK_SUCCESS);
    ASSERT_TRUE(shows(window, kSwapchainExtent, 0));
    constexpr VkExtent2D kLarger{120, 90};
    const uint32_t size[] = {kLarger.width, kLarger.height};
    xcb_configure_window(connection, window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, size);
    finish();
    VkResult result = VK_SUCCESS;
    for (uint32_t frame = 1; frame < 100 && result == VK_SUCCESS; ++frame)
        result = presentPattern(swapchain, kSwapchainExtent, frame, fence);
    EXPECT_EQ(result, VK_ERROR_OUT_OF_DATE_KHR);
    ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
    VkSurfaceCapabilitiesKHR now{};
    ASSERT_EQ(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice, surface, &now), VK_SUCCESS);
    EXPECT_EQ(now.currentExtent.width, kLarger.width);
    auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    info.imageExtent = kLarger;
    info.oldSwapchain = swapchain;
    const VkSwapchainKHR next = makeSwapchain(info);
    const VkFence other = makeFence();
    ASSERT_EQ(presentPattern(next, kLarger, 7, other), VK_SUCCESS);
    EXPECT_TRUE(shows(window, kLarger, 7));
}

TEST_F(X11Test, destroyedWindowsLoseTheirSurface) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_IMMEDIATE_KHR));
    const VkFence fence = makeFence();
    xcb_destroy_window(connection, window);
    finish();
    VkResult result = VK_SUCCESS;
    for (uint32_t frame = 0; frame < 100 && result == VK_SUCCESS; ++frame)
        result = presentPattern(swapchain, kSwapchainExtent, frame, fence);
    EXPECT_EQ(result, VK_ERROR_SURFACE_LOST_KHR);
    VkSurfaceCapabilitiesKHR now{};
    EXPECT_EQ(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice, surface, &now), VK_ERROR_SURFACE_LOST_KHR);
    // What the driver asked of the window that was gone is no event for the application.
    const std::unique_ptr<xcb_generic_event_t, decltype(&std::free)> event(xcb_poll_for_event(connection), &std::free);
    EXPECT_EQ(event, nullptr);
}

TEST_F(X11Test, windowsOfXlib) {
    XlibWindow xlib(kSwapchainExtent);
    ASSERT_TRUE(xlib.open());
    const VkSurfaceKHR on = xlib.createSurface(instance);
    ASSERT_NE(on, VkSurfaceKHR{VK_NULL_HANDLE});
    EXPECT_TRUE(xlib.supported(instance, physicalDevice));
    VkBool32 supported = VK_FALSE;
    ASSERT_EQ(vkGetPhysicalDeviceSurfaceSupportKHR(physicalDevice, 0, on, &supported), VK_SUCCESS);
    ASSERT_TRUE(supported);
    VkSurfaceCapabilitiesKHR seen{};
    ASSERT_EQ(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice, on, &seen), VK_SUCCESS);
    EXPECT_EQ(seen.currentExtent.width, kSwapchainExtent.width);
    auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    info.surface = on;
    VkSwapchainKHR swapchain = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
    ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, 3, makeFence()), VK_SUCCESS);
    EXPECT_TRUE(shows(xlib.id(), kSwapchainExtent, 3));
    ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
    vkDestroySwapchainKHR(device, swapchain, nullptr);
    vkDestroySurfaceKHR(instance, on, nullptr);
}

}  // namespace
}  // namespace vernier::test
