// Swapchains in a few lines, on whatever surface a test has.
#pragma once

#include <chrono>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {

constexpr VkExtent2D kSwapchainExtent{70, 50};
constexpr uint64_t kTenSeconds = 10'000'000'000;

/// Any pattern that tells rows, columns and channels apart.
inline uint32_t patternAt(uint32_t x, uint32_t y, uint32_t frame) {
    return 0xFF000000u | (x * 3 + frame) % 256 << 16 | (y * 5) % 256 << 8 | (x + y) % 256;
}

/// Whether texels, row by row, are the pattern of a frame, whatever their alpha.
inline bool isPattern(const uint32_t* texels, VkExtent2D extent, uint32_t frame) {
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x, ++texels) {
            if (((*texels ^ patternAt(x, y, frame)) & 0xFFFFFF) != 0) return false;
        }
    }
    return true;
}

class PresentTest : public DrawTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    /// The surface under test, and the instance extensions that it takes.
    virtual VkSurfaceKHR createSurface() = 0;
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_SWAPCHAIN_EXTENSION_NAME, VK_KHR_SWAPCHAIN_MUTABLE_FORMAT_EXTENSION_NAME,
                VK_KHR_INCREMENTAL_PRESENT_EXTENSION_NAME, VK_KHR_IMAGE_FORMAT_LIST_EXTENSION_NAME};
    }
    void SetUp() override {
        DrawTest::SetUp();
        surface = createSurface();
        ASSERT_NE(surface, VkSurfaceKHR{VK_NULL_HANDLE});
        defer([this] { vkDestroySurfaceKHR(instance, surface, nullptr); });
        // What an application must ask before it makes a swapchain.
        VkBool32 supported = VK_FALSE;
        ASSERT_EQ(vkGetPhysicalDeviceSurfaceSupportKHR(physicalDevice, 0, surface, &supported), VK_SUCCESS);
        ASSERT_EQ(supported, VK_TRUE);
        ASSERT_EQ(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice, surface, &capabilities), VK_SUCCESS);
        uint32_t count = 16;
        formats.resize(count);
        ASSERT_EQ(vkGetPhysicalDeviceSurfaceFormatsKHR(physicalDevice, surface, &count, formats.data()), VK_SUCCESS);
        formats.resize(count);
        modes.resize(count = 16);
        ASSERT_EQ(vkGetPhysicalDeviceSurfacePresentModesKHR(physicalDevice, surface, &count, modes.data()), VK_SUCCESS);
        modes.resize(count);
    }

    VkSwapchainCreateInfoKHR swapchainInfo(VkPresentModeKHR mode, uint32_t count = 3) const {
        auto info = make<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
        info.surface = surface;
        info.minImageCount = count;
        info.imageFormat = VK_FORMAT_B8G8R8A8_UNORM;
        info.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
        info.imageExtent = kSwapchainExtent;
        info.imageArrayLayers = 1;
        info.imageUsage =
            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
        info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
        info.presentMode = mode;
        info.clipped = VK_TRUE;
        return info;
    }
    VkSwapchainKHR makeSwapchain(const VkSwapchainCreateInfoKHR& info) {
        VkSwapchainKHR swapchain = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain), VK_SUCCESS);
        defer([this, swapchain] { vkDestroySwapchainKHR(device, swapchain, nullptr); });
        return swapchain;
    }
    std::vector<VkImage> imagesOf(VkSwapchainKHR swapchain) {
        uint32_t count = 0;
        EXPECT_EQ(vkGetSwapchainImagesKHR(device, swapchain, &count, nullptr), VK_SUCCESS);
        std::vector<VkImage> images(count);
        EXPECT_EQ(vkGetSwapchainImagesKHR(device, swapchain, &count, images.data()), VK_SUCCESS);
        return images;
    }
    VkSemaphore makeSemaphore() {
        const auto info = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
        VkSemaphore semaphore = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSemaphore(device, &info, nullptr, &semaphore), VK_SUCCESS);
        defer([this, semaphore] { vkDestroySemaphore(device, semaphore, nullptr); });
        return semaphore;
    }
    VkFence makeFence() {
        const auto info = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        VkFence fence = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateFence(device, &info, nullptr, &fence), VK_SUCCESS);
        defer([this, fence] { vkDestroyFence(device, fence, nullptr); });
        return fence;
    }
    /// Acquires with a fence and waits for it.
    uint32_t acquire(VkSwapchainKHR swapchain, VkFence fence) {
        uint32_t index = ~0u;
        EXPECT_FALSE(imagesOf(swapchain).empty());  // the validation layer knows images that were asked for alone
        EXPECT_EQ(vkAcquireNextImageKHR(device, swapchain, kTenSeconds, VK_NULL_HANDLE, fence, &index), VK_SUCCESS);
        EXPECT_EQ(vkWaitForFences(device, 1, &fence, VK_TRUE, kTenSeconds), VK_SUCCESS);
        EXPECT_EQ(vkResetFences(device, 1, &fence), VK_SUCCESS);
        return index;
    }
    static void transition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
        changeLayout(commands, image, VK_IMAGE_ASPECT_COLOR_BIT, from, to);
    }
    /// Fills the image with a colour and leaves it as presentation wants it.
    VkCommandBuffer recordClear(VkImage image, float red) {
        const VkCommandBuffer commands = begin();
        transition(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkClearColorValue color{{red, 0, 0, 1}};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1, &all);
        transition(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
        return commands;
    }
    VkResult present(VkSwapchainKHR swapchain, uint32_t index, VkSemaphore wait = VK_NULL_HANDLE) {
        auto info = make<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
        info.waitSemaphoreCount = wait != VK_NULL_HANDLE ? 1 : 0;
        info.pWaitSemaphores = &wait;
        info.swapchainCount = 1;
        info.pSwapchains = &swapchain;
        info.pImageIndices = &index;
        return vkQueuePresentKHR(queue, &info);
    }
    /// Draws the pattern of a frame into the next image and presents it; tells what the presentation said.
    VkResult presentPattern(VkSwapchainKHR swapchain, VkExtent2D extent, uint32_t frame, VkFence fence) {
        const std::vector<VkImage> images = imagesOf(swapchain);
        uint32_t index = 0;
        const VkResult acquired = vkAcquireNextImageKHR(device, swapchain, kTenSeconds, VK_NULL_HANDLE, fence, &index);
        if (acquired != VK_SUCCESS) return acquired;
        EXPECT_EQ(vkWaitForFences(device, 1, &fence, VK_TRUE, kTenSeconds), VK_SUCCESS);
        EXPECT_EQ(vkResetFences(device, 1, &fence), VK_SUCCESS);
        const TestBuffer pattern =
            makeBuffer(VkDeviceSize{extent.width} * extent.height * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        auto* texels = static_cast<uint32_t*>(pattern.data);
        for (uint32_t y = 0; y < extent.height; ++y)
            for (uint32_t x = 0; x < extent.width; ++x) texels[y * extent.width + x] = patternAt(x, y, frame);
        const VkImage image = images.at(index);
        const VkCommandBuffer commands = begin();
        transition(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {extent.width, extent.height, 1};
        vkCmdCopyBufferToImage(commands, pattern.buffer, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        transition(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
        submit(commands);
        return present(swapchain, index);
    }
    /// Frames one after the other, each cleared and presented; returns the seconds they took.
    double presentFrames(VkSwapchainKHR swapchain, uint32_t frames) {
        const std::vector<VkImage> images = imagesOf(swapchain);
        const VkFence fence = makeFence();
        const auto start = std::chrono::steady_clock::now();
        for (uint32_t frame = 0; frame < frames; ++frame) {
            const uint32_t index = acquire(swapchain, fence);
            submit(recordClear(images.at(index), 0));
            EXPECT_EQ(present(swapchain, index), VK_SUCCESS);
        }
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    VkSurfaceKHR surface = VK_NULL_HANDLE;
    VkSurfaceCapabilitiesKHR capabilities{};
    std::vector<VkSurfaceFormatKHR> formats;
    std::vector<VkPresentModeKHR> modes;
};

}  // namespace vernier::test
