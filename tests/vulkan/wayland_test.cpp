// Presenting on surfaces of a Wayland compositor, which is the test's own: what it shows, when, and what happens when
// it does not.
#include <wayland-client.h>

#include <vulkan/vulkan.h>
#include <vulkan/vulkan_wayland.h>

#include <algorithm>
#include <thread>

#include "tests/vulkan/test_compositor.h"
#include "tests/vulkan/test_swapchain.h"

namespace vernier::test {
namespace {

class WaylandTest : public PresentTest {
  protected:
    std::vector<const char*> moreInstanceExtensions() override {
        return {VK_KHR_SURFACE_EXTENSION_NAME, VK_KHR_WAYLAND_SURFACE_EXTENSION_NAME};
    }
    void SetUp() override {
        display = wl_display_connect_to_fd(server.connect());
        ASSERT_NE(display, nullptr);
        static const wl_registry_listener kGlobals = {&global, [](void*, wl_registry*, uint32_t) {}};
        wl_registry* const registry = wl_display_get_registry(display);
        wl_registry_add_listener(registry, &kGlobals, this);
        wl_display_roundtrip(display);
        wl_registry_destroy(registry);
        ASSERT_NE(compositor, nullptr);
        PresentTest::SetUp();
    }
    void TearDown() override {
        PresentTest::TearDown();
        for (wl_surface* const one : surfaces) wl_surface_destroy(one);
        if (compositor != nullptr) wl_compositor_destroy(compositor);
        if (display != nullptr) wl_display_disconnect(display);
    }
    static void global(void* self, wl_registry* registry, uint32_t name, const char* interface, uint32_t) {
        auto& test = *static_cast<WaylandTest*>(self);
        if (std::strcmp(interface, "wl_compositor") == 0)
            test.compositor =
                static_cast<wl_compositor*>(wl_registry_bind(registry, name, &wl_compositor_interface, 4));
    }
    VkSurfaceKHR createSurface() override {
        auto info = make<VkWaylandSurfaceCreateInfoKHR>(VK_STRUCTURE_TYPE_WAYLAND_SURFACE_CREATE_INFO_KHR);
        info.display = display;
        info.surface = surfaces.emplace_back(wl_compositor_create_surface(compositor));
        const auto create = reinterpret_cast<PFN_vkCreateWaylandSurfaceKHR>(
            vkGetInstanceProcAddr(instance, "vkCreateWaylandSurfaceKHR"));
        VkSurfaceKHR made = VK_NULL_HANDLE;
        EXPECT_EQ(create(instance, &info, nullptr, &made), VK_SUCCESS);
        return made;
    }
    /// Whether the compositor comes to show the pattern of a frame, pixel by pixel, before time is out.
    bool shows(VkExtent2D extent, uint32_t frame) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        while (std::chrono::steady_clock::now() < deadline) {
            const ShownPicture picture = server.shown();
            if (picture.extent.width == extent.width && picture.extent.height == extent.height &&
                isPattern(picture.texels.data(), extent, frame))
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }

    TestCompositor server;
    wl_display* display = nullptr;
    wl_compositor* compositor = nullptr;
    std::vector<wl_surface*> surfaces;
};

TEST_F(WaylandTest, surfacesTakeAnyExtent) {
    EXPECT_EQ(capabilities.currentExtent.width, UINT32_MAX);
    EXPECT_EQ(capabilities.currentExtent.height, UINT32_MAX);
    ASSERT_EQ(formats.size(), 2u);
    EXPECT_EQ(formats[0].format, VK_FORMAT_B8G8R8A8_UNORM);
    EXPECT_EQ(formats[1].format, VK_FORMAT_B8G8R8A8_SRGB);
    EXPECT_EQ(modes, (std::vector{VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR}));
    const auto supports = reinterpret_cast<PFN_vkGetPhysicalDeviceWaylandPresentationSupportKHR>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceWaylandPresentationSupportKHR"));
    EXPECT_TRUE(supports(physicalDevice, 0, display));
}

TEST_F(WaylandTest, surfacesShowWhatWasRendered) {
    for (const VkPresentModeKHR mode : modes) {
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        const auto info = swapchainInfo(mode);
        ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        const VkFence fence = makeFence();
        for (uint32_t frame = 0; frame < 9; ++frame) {
            ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, frame, fence), VK_SUCCESS);
            ASSERT_TRUE(shows(kSwapchainExtent, frame)) << mode << ", frame " << frame;
        }
        EXPECT_EQ(server.shown().format, uint32_t{WL_SHM_FORMAT_XRGB8888});
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        vkDestroySwapchainKHR(device, swapchain, nullptr);
    }
}

TEST_F(WaylandTest, extentsAndAlphaAreTheSwapchains) {
    VkSwapchainKHR last = VK_NULL_HANDLE;
    uint32_t frame = 0;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {64, 64}, {333, 7}, {1100, 700}}) {
        auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
        info.imageExtent = extent;
        info.compositeAlpha = VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR;
        info.oldSwapchain = last;
        const VkSwapchainKHR swapchain = makeSwapchain(info);
        ASSERT_EQ(presentPattern(swapchain, extent, ++frame, makeFence()), VK_SUCCESS);
        EXPECT_TRUE(shows(extent, frame)) << extent.width;
        EXPECT_EQ(server.shown().format, uint32_t{WL_SHM_FORMAT_ARGB8888});
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        last = swapchain;
    }
}

// FIFO: every image is shown, one a refresh; and while the compositor shows nothing, only who wants another image
// waits.
TEST_F(WaylandTest, theCompositorSetsThePace) {
    server.setAutomatic(false);
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_FIFO_KHR, 3));
    const VkFence fence = makeFence();
    for (uint32_t frame = 0; frame < 3; ++frame)
        ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, frame, fence), VK_SUCCESS);
    ASSERT_TRUE(server.awaitCommits(1));
    submit(begin());  // the queue goes on
    uint32_t index = 0;
    EXPECT_EQ(vkAcquireNextImageKHR(device, swapchain, 50'000'000, VK_NULL_HANDLE, fence, &index), VK_TIMEOUT);
    EXPECT_EQ(server.commits(), 1u);
    for (uint32_t frame = 0; frame < 3; ++frame) {
        ASSERT_TRUE(server.awaitCommits(frame + 1));
        server.refresh();
        EXPECT_TRUE(shows(kSwapchainExtent, frame));
    }
    // The second was given back when the third was shown.
    EXPECT_EQ(presentPattern(swapchain, kSwapchainExtent, 3, fence), VK_SUCCESS);
    ASSERT_TRUE(server.awaitCommits(4));
}

TEST_F(WaylandTest, mailboxesKeepTheNewest) {
    server.setAutomatic(false);
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_MAILBOX_KHR));
    const VkFence fence = makeFence();
    ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, 0, fence), VK_SUCCESS);
    ASSERT_TRUE(server.awaitCommits(1));
    server.refresh();  // which holds the image from now on
    ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, 1, fence), VK_SUCCESS);
    ASSERT_TRUE(server.awaitCommits(2));
    // Nobody waits for the refresh that does not come.
    for (uint32_t frame = 2; frame < 30; ++frame)
        ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, frame, fence), VK_SUCCESS);
    submit(begin());  // what the queue does after it, the presentation of the last is before
    EXPECT_EQ(server.commits(), 2u);
    server.refresh();
    EXPECT_TRUE(shows(kSwapchainExtent, 1));
    ASSERT_TRUE(server.awaitCommits(3));
    server.refresh();
    EXPECT_TRUE(shows(kSwapchainExtent, 29));
}

TEST_F(WaylandTest, swapchainsGoThoughNothingIsShown) {
    server.setAutomatic(false);
    for (const VkPresentModeKHR mode : modes) {
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        const auto info = swapchainInfo(mode);
        ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        const VkFence fence = makeFence();
        for (uint32_t frame = 0; frame < 2; ++frame)
            ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, frame, fence), VK_SUCCESS);
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        vkDestroySwapchainKHR(device, swapchain, nullptr);
    }
}

TEST_F(WaylandTest, surfacesAreLostWithTheirCompositor) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_FIFO_KHR));
    const VkFence fence = makeFence();
    ASSERT_EQ(presentPattern(swapchain, kSwapchainExtent, 0, fence), VK_SUCCESS);
    server.hangUp();
    VkResult result = VK_SUCCESS;
    for (uint32_t frame = 1; frame < 100 && result == VK_SUCCESS; ++frame)
        result = presentPattern(swapchain, kSwapchainExtent, frame, fence);
    EXPECT_EQ(result, VK_ERROR_SURFACE_LOST_KHR);
    VkSwapchainKHR next = VK_NULL_HANDLE;
    auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    info.oldSwapchain = swapchain;
    EXPECT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &next), VK_ERROR_SURFACE_LOST_KHR);
}

}  // namespace
}  // namespace vernier::test
