// Surfaces and swapchains without a window (VK_EXT_headless_surface): the same presentation engine that windows have.
#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "tests/vulkan/test_swapchain.h"

namespace vernier::test {
namespace {

class SwapchainTest : public PresentTest {
  protected:
    std::vector<const char*> moreInstanceExtensions() override {
        return {VK_KHR_SURFACE_EXTENSION_NAME, VK_KHR_GET_SURFACE_CAPABILITIES_2_EXTENSION_NAME,
                VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME};
    }
    VkSurfaceKHR createSurface() override {
        const auto create = reinterpret_cast<PFN_vkCreateHeadlessSurfaceEXT>(
            vkGetInstanceProcAddr(instance, "vkCreateHeadlessSurfaceEXT"));
        const auto info = make<VkHeadlessSurfaceCreateInfoEXT>(VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT);
        VkSurfaceKHR made = VK_NULL_HANDLE;
        EXPECT_EQ(create(instance, &info, nullptr, &made), VK_SUCCESS);
        return made;
    }
};

TEST_F(SwapchainTest, surfacesTellWhatTheyTake) {
    EXPECT_EQ(capabilities.currentExtent.width, UINT32_MAX);
    EXPECT_GE(capabilities.minImageCount, 1u);
    EXPECT_TRUE(capabilities.supportedUsageFlags & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    EXPECT_EQ(modes,
              (std::vector{VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR}));
    std::set<VkFormat> listed;
    for (const VkSurfaceFormatKHR& format : formats) {
        EXPECT_EQ(format.colorSpace, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR);
        listed.insert(format.format);
        VkImageFormatProperties properties{};
        EXPECT_EQ(vkGetPhysicalDeviceImageFormatProperties(physicalDevice, format.format, VK_IMAGE_TYPE_2D,
                                                           VK_IMAGE_TILING_OPTIMAL, capabilities.supportedUsageFlags, 0,
                                                           &properties),
                  VK_SUCCESS);
    }
    EXPECT_EQ(listed.count(VK_FORMAT_B8G8R8A8_UNORM) + listed.count(VK_FORMAT_B8G8R8A8_SRGB), 2u);

    const auto capabilities2 = reinterpret_cast<PFN_vkGetPhysicalDeviceSurfaceCapabilities2KHR>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceSurfaceCapabilities2KHR"));
    const auto formats2 = reinterpret_cast<PFN_vkGetPhysicalDeviceSurfaceFormats2KHR>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceSurfaceFormats2KHR"));
    auto about = make<VkPhysicalDeviceSurfaceInfo2KHR>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SURFACE_INFO_2_KHR);
    about.surface = surface;
    auto same = make<VkSurfaceCapabilities2KHR>(VK_STRUCTURE_TYPE_SURFACE_CAPABILITIES_2_KHR);
    ASSERT_EQ(capabilities2(physicalDevice, &about, &same), VK_SUCCESS);
    EXPECT_EQ(std::memcmp(&same.surfaceCapabilities, &capabilities, sizeof capabilities), 0);
    uint32_t count = static_cast<uint32_t>(formats.size());
    std::vector<VkSurfaceFormat2KHR> again(count, make<VkSurfaceFormat2KHR>(VK_STRUCTURE_TYPE_SURFACE_FORMAT_2_KHR));
    ASSERT_EQ(formats2(physicalDevice, &about, &count, again.data()), VK_SUCCESS);
    for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(again[i].surfaceFormat.format, formats[i].format);

    uint32_t rectangles = 1;
    VkRect2D rectangle{};
    ASSERT_EQ(vkGetPhysicalDevicePresentRectanglesKHR(physicalDevice, surface, &rectangles, &rectangle), VK_SUCCESS);
    EXPECT_EQ(rectangles, 1u);
    auto group = make<VkDeviceGroupPresentCapabilitiesKHR>(VK_STRUCTURE_TYPE_DEVICE_GROUP_PRESENT_CAPABILITIES_KHR);
    ASSERT_EQ(vkGetDeviceGroupPresentCapabilitiesKHR(device, &group), VK_SUCCESS);
    EXPECT_EQ(group.presentMask[0], 1u);
    VkDeviceGroupPresentModeFlagsKHR local = 0;
    ASSERT_EQ(vkGetDeviceGroupSurfacePresentModesKHR(device, surface, &local), VK_SUCCESS);
    EXPECT_EQ(local, VkFlags{VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR});
}

TEST_F(SwapchainTest, imagesGoRoundWithSemaphores) {
    for (const VkPresentModeKHR mode : modes) {
        const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(mode));
        const std::vector<VkImage> images = imagesOf(swapchain);
        ASSERT_GE(images.size(), 3u);
        const VkSemaphore acquired = makeSemaphore(), drawn = makeSemaphore();
        const VkFence fence = makeFence();
        std::set<uint32_t> seen;
        for (int frame = 0; frame < 8; ++frame) {
            auto next = make<VkAcquireNextImageInfoKHR>(VK_STRUCTURE_TYPE_ACQUIRE_NEXT_IMAGE_INFO_KHR);
            next.swapchain = swapchain;
            next.timeout = kTenSeconds;
            next.semaphore = acquired;
            next.deviceMask = 1;
            uint32_t index = ~0u;
            ASSERT_EQ(vkAcquireNextImage2KHR(device, &next, &index), VK_SUCCESS);
            ASSERT_LT(index, images.size());
            seen.insert(index);
            const VkCommandBuffer commands = recordClear(images[index], 1);
            ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
            const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
            auto work = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
            work.waitSemaphoreCount = work.signalSemaphoreCount = work.commandBufferCount = 1;
            work.pWaitSemaphores = &acquired;
            work.pSignalSemaphores = &drawn;
            work.pWaitDstStageMask = &stage;
            work.pCommandBuffers = &commands;
            ASSERT_EQ(vkQueueSubmit(queue, 1, &work, fence), VK_SUCCESS);
            ASSERT_EQ(present(swapchain, index, drawn), VK_SUCCESS);
            ASSERT_EQ(vkWaitForFences(device, 1, &fence, VK_TRUE, kTenSeconds), VK_SUCCESS);
            ASSERT_EQ(vkResetFences(device, 1, &fence), VK_SUCCESS);
            vkFreeCommandBuffers(device, pool, 1, &commands);
        }
        EXPECT_EQ(seen.size(), images.size());
        // The surface is free for the next one.
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        auto replacement = swapchainInfo(mode);
        replacement.oldSwapchain = swapchain;
        VkSwapchainKHR last = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSwapchainKHR(device, &replacement, nullptr, &last), VK_SUCCESS);
        vkDestroySwapchainKHR(device, last, nullptr);
    }
}

// VK_KHR_incremental_present: a hint that presentations take.
TEST_F(SwapchainTest, presentationsMaySayWhatChanged) {
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_FIFO_KHR));
    const std::vector<VkImage> images = imagesOf(swapchain);
    const VkFence fence = makeFence();
    // The layer forbids 0 rectangles, which the specification gives a meaning.
    for (uint32_t rectangles = validated() ? 1 : 0; rectangles < 3; ++rectangles) {
        const uint32_t index = acquire(swapchain, fence);
        submit(recordClear(images.at(index), 1));
        const VkRectLayerKHR changed[] = {{{0, 0}, {8, 8}, 0}, {{16, 16}, {20, 4}, 0}};
        const VkPresentRegionKHR region{rectangles, changed};
        auto regions = make<VkPresentRegionsKHR>(VK_STRUCTURE_TYPE_PRESENT_REGIONS_KHR);
        regions.swapchainCount = 1;
        regions.pRegions = &region;
        auto info = make<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
        info.pNext = &regions;
        info.swapchainCount = 1;
        info.pSwapchains = &swapchain;
        info.pImageIndices = &index;
        EXPECT_EQ(vkQueuePresentKHR(queue, &info), VK_SUCCESS);
    }
    EXPECT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
}

TEST_F(SwapchainTest, whatIsDrawnIsWhatIsThere) {
    for (const VkFormat format : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB}) {
        auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
        info.imageFormat = format;
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        TestImage image;
        image.image = imagesOf(swapchain).at(acquire(swapchain, makeFence()));
        image.extent = kSwapchainExtent;
        const VkCommandBuffer commands = recordClear(image.image, 0.5f);
        transition(commands, image.image, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        submit(commands);
        const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        const bool blueFirst = format == VK_FORMAT_B8G8R8A8_UNORM;
        // 0.5 is 128 of 255; encoded for sRGB it is 188.
        EXPECT_EQ(pixelAt(texels, image, 69, 49), blueFirst ? 0xFF800000u : 0xFF0000BCu);
        vkDestroySwapchainKHR(device, swapchain, nullptr);
    }
}

TEST_F(SwapchainTest, acquiringTimesOut) {
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_IMMEDIATE_KHR, 2));
    const VkFence fence = makeFence();
    const uint32_t one = acquire(swapchain, fence), other = acquire(swapchain, fence);
    EXPECT_NE(one, other);
    uint32_t index = 0;
    // With all images taken nothing may be waited for without a limit.
    EXPECT_EQ(vkAcquireNextImageKHR(device, swapchain, 0, VK_NULL_HANDLE, fence, &index), VK_NOT_READY);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(vkAcquireNextImageKHR(device, swapchain, 20'000'000, VK_NULL_HANDLE, fence, &index), VK_TIMEOUT);
    EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(20));
    EXPECT_EQ(vkGetFenceStatus(device, fence), VK_NOT_READY);
    const std::vector<VkImage> images = imagesOf(swapchain);
    submit(recordClear(images[other], 0));
    EXPECT_EQ(present(swapchain, other), VK_SUCCESS);
    EXPECT_EQ(acquire(swapchain, fence), other);
}

TEST_F(SwapchainTest, refreshesSetThePace) {
    // The default is 60 a second: the last of 13 images waits for the eleventh refresh after the first, which may come
    // at once. That it does not wait much longer cannot be tested on a busy machine.
    const VkSwapchainKHR paced = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_FIFO_KHR, 2));
    EXPECT_GE(presentFrames(paced, 13), 9.0 / 60);
    // A mailbox and immediate presentation never make the application wait for a refresh: of 200 frames, which would
    // take more than three seconds, each must only find an image.
    for (const VkPresentModeKHR mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR}) {
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        auto info = swapchainInfo(mode);
        if (mode == VK_PRESENT_MODE_MAILBOX_KHR) info.oldSwapchain = paced;
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        presentFrames(swapchain, 200);
        ASSERT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
        vkDestroySwapchainKHR(device, swapchain, nullptr);
    }
}

TEST_F(SwapchainTest, aRetiredSwapchainGivesNoImages) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const VkSwapchainKHR old = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_FIFO_KHR));
    const VkFence fence = makeFence();
    const uint32_t held = acquire(old, fence);
    const std::vector<VkImage> images = imagesOf(old);
    auto info = swapchainInfo(VK_PRESENT_MODE_MAILBOX_KHR);
    info.oldSwapchain = old;
    const VkSwapchainKHR swapchain = makeSwapchain(info);
    uint32_t index = 0;
    EXPECT_EQ(vkAcquireNextImageKHR(device, old, kTenSeconds, VK_NULL_HANDLE, fence, &index), VK_ERROR_OUT_OF_DATE_KHR);
    EXPECT_EQ(vkGetFenceStatus(device, fence), VK_NOT_READY);
    // An image acquired before can still be presented.
    submit(recordClear(images[held], 0));
    EXPECT_EQ(present(old, held), VK_SUCCESS);
    submit(recordClear(imagesOf(swapchain).at(acquire(swapchain, fence)), 0));
}

TEST_F(SwapchainTest, twoSwapchainsInOnePresentation) {
    const VkSurfaceKHR second = createSurface();
    defer([this, second] { vkDestroySurfaceKHR(instance, second, nullptr); });
    VkBool32 supported = VK_FALSE;
    ASSERT_EQ(vkGetPhysicalDeviceSurfaceSupportKHR(physicalDevice, 0, second, &supported), VK_SUCCESS);
    VkSurfaceCapabilitiesKHR other{};
    ASSERT_EQ(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice, second, &other), VK_SUCCESS);
    auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    const VkSwapchainKHR first = makeSwapchain(info);
    info.surface = second;
    const VkSwapchainKHR swapchains[] = {first, makeSwapchain(info)};
    const VkFence fence = makeFence();
    const uint32_t indices[] = {acquire(swapchains[0], fence), acquire(swapchains[1], fence)};
    for (uint32_t i = 0; i < 2; ++i) submit(recordClear(imagesOf(swapchains[i]).at(indices[i]), 0));
    VkResult results[] = {VK_ERROR_UNKNOWN, VK_ERROR_UNKNOWN};
    auto both = make<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    both.swapchainCount = 2;
    both.pSwapchains = swapchains;
    both.pImageIndices = indices;
    both.pResults = results;
    EXPECT_EQ(vkQueuePresentKHR(queue, &both), VK_SUCCESS);
    EXPECT_EQ(results[0], VK_SUCCESS);
    EXPECT_EQ(results[1], VK_SUCCESS);
}

TEST_F(SwapchainTest, anImageIsAnotherNameOfOneOfTheSwapchain) {
    const auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    const VkSwapchainKHR swapchain = makeSwapchain(info);
    auto ofSwapchain = make<VkImageSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_IMAGE_SWAPCHAIN_CREATE_INFO_KHR);
    ofSwapchain.swapchain = swapchain;
    auto imageInfo = flatImage(info.imageFormat, kSwapchainExtent, info.imageUsage);
    imageInfo.pNext = &ofSwapchain;
    TestImage image;
    image.extent = kSwapchainExtent;
    ASSERT_EQ(vkCreateImage(device, &imageInfo, nullptr, &image.image), VK_SUCCESS);
    defer([this, image] { vkDestroyImage(device, image.image, nullptr); });
    const uint32_t index = acquire(swapchain, makeFence());
    auto bound = make<VkBindImageMemorySwapchainInfoKHR>(VK_STRUCTURE_TYPE_BIND_IMAGE_MEMORY_SWAPCHAIN_INFO_KHR);
    bound.swapchain = swapchain;
    bound.imageIndex = index;
    auto bind = make<VkBindImageMemoryInfo>(VK_STRUCTURE_TYPE_BIND_IMAGE_MEMORY_INFO, &bound);
    bind.image = image.image;
    ASSERT_EQ(vkBindImageMemory2(device, 1, &bind), VK_SUCCESS);
    const VkCommandBuffer commands = recordClear(imagesOf(swapchain).at(index), 1);
    transition(commands, image.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    submit(commands);
    EXPECT_EQ(pixelAt(readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4), image, 3, 4), 0xFFFF0000u);
}

TEST_F(SwapchainTest, mutableFormatsAreSeenAsOthers) {
    const VkFormat viewed[] = {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB};
    auto list = make<VkImageFormatListCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_FORMAT_LIST_CREATE_INFO);
    list.viewFormatCount = 2;
    list.pViewFormats = viewed;
    auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    info.flags = VK_SWAPCHAIN_CREATE_MUTABLE_FORMAT_BIT_KHR;
    info.pNext = &list;
    const VkSwapchainKHR swapchain = makeSwapchain(info);
    TestImage image;
    image.image = imagesOf(swapchain).at(acquire(swapchain, makeFence()));
    image.extent = kSwapchainExtent;
    image.format = VK_FORMAT_B8G8R8A8_SRGB;
    auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = image.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = image.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    ASSERT_EQ(vkCreateImageView(device, &view, nullptr, &image.view), VK_SUCCESS);
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex = fullScreen();
    desc.fragment = constantColor("0.5, 0, 0, 1");
    desc.extent = kSwapchainExtent;
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    drawTriangle(pass, pipeline);
    EXPECT_EQ(pixelAt(readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4), image, 40, 40), 0xFFBC0000u);
    vkDestroyImageView(device, image.view, nullptr);
}

TEST_F(SwapchainTest, wrongUseIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    VkSwapchainKHR refused = VK_NULL_HANDLE;
    auto format = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    format.imageFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    EXPECT_NE(vkCreateSwapchainKHR(device, &format, nullptr, &refused), VK_SUCCESS);
    auto huge = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    huge.imageExtent = {1u << 20, 1};
    EXPECT_NE(vkCreateSwapchainKHR(device, &huge, nullptr, &refused), VK_SUCCESS);
    auto empty = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    empty.imageExtent = {0, 7};
    EXPECT_NE(vkCreateSwapchainKHR(device, &empty, nullptr, &refused), VK_SUCCESS);
    auto layers = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    layers.imageArrayLayers = 2;
    EXPECT_NE(vkCreateSwapchainKHR(device, &layers, nullptr, &refused), VK_SUCCESS);
    auto many = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR, 0xFFFFFFFF);
    EXPECT_EQ(vkCreateSwapchainKHR(device, &many, nullptr, &refused), VK_ERROR_OUT_OF_DEVICE_MEMORY);
}

TEST_F(SwapchainTest, oneSwapchainASurfaceAndOnlyAcquiredImages) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const VkSwapchainKHR swapchain = makeSwapchain(swapchainInfo(VK_PRESENT_MODE_FIFO_KHR));
    VkSwapchainKHR refused = VK_NULL_HANDLE;
    const auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
    EXPECT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &refused), VK_ERROR_NATIVE_WINDOW_IN_USE_KHR);
    EXPECT_NE(present(swapchain, 0), VK_SUCCESS) << "not acquired";
    EXPECT_NE(present(swapchain, 99), VK_SUCCESS) << "does not exist";
    const VkFence fence = makeFence();
    const uint32_t index = acquire(swapchain, fence);
    EXPECT_EQ(present(swapchain, index), VK_SUCCESS);
    EXPECT_NE(present(swapchain, index), VK_SUCCESS) << "presented already";
}

TEST_F(SwapchainTest, aSwapchainMayGoWhilePresentationsAreInTheQueue) {
    VERNIER_SKIP_WHEN_VALIDATED();
    for (int round = 0; round < 20; ++round) {
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        const auto info = swapchainInfo(VK_PRESENT_MODE_FIFO_KHR);
        ASSERT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        const VkFence fence = makeFence();
        for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(present(swapchain, acquire(swapchain, fence)), VK_SUCCESS);
        vkDestroySwapchainKHR(device, swapchain, nullptr);
    }
    EXPECT_EQ(vkDeviceWaitIdle(device), VK_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
