// The other threads of the soak: presenting, and devices that come and go.
#include <cstring>

#include "tests/vulkan/soak/context.h"

namespace vernier::soak {
namespace {

constexpr uint64_t kLong = 120'000'000'000;

/// A swapchain with a semaphore and a command buffer for each presentation in flight.
class Presentation {
  public:
    Presentation(Context& context, uint32_t seed) : context_(context), verdict_(context.verdict), random_(seed) {
        const auto info = make<VkHeadlessSurfaceCreateInfoEXT>(VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT);
        {
            const std::lock_guard lock(loaderMutex());
            const auto create = reinterpret_cast<PFN_vkCreateHeadlessSurfaceEXT>(
                vkGetInstanceProcAddr(context.instance, "vkCreateHeadlessSurfaceEXT"));
            SOAK_CHECK(verdict_, create, context.instance, &info, nullptr, &surface_);
        }
        auto poolInfo = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        SOAK_CHECK(verdict_, vkCreateCommandPool, context.device, &poolInfo, nullptr, &pool_);
        auto allocation = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        allocation.commandPool = pool_;
        allocation.commandBufferCount = 1;
        SOAK_CHECK(verdict_, vkAllocateCommandBuffers, context.device, &allocation, &commands_);
        const auto semaphoreInfo = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
        for (VkSemaphore* semaphore : {&acquired_, &drawn_})
            SOAK_CHECK(verdict_, vkCreateSemaphore, context.device, &semaphoreInfo, nullptr, semaphore);
        const auto fenceInfo = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        SOAK_CHECK(verdict_, vkCreateFence, context.device, &fenceInfo, nullptr, &fence_);
    }
    ~Presentation() {
        {
            const std::lock_guard lock(context_.queueMutex);
            vkQueueWaitIdle(context_.queue);
        }
        vkDestroySwapchainKHR(context_.device, swapchain_, nullptr);
        {
            const std::lock_guard lock(loaderMutex());
            vkDestroySurfaceKHR(context_.instance, surface_, nullptr);
        }
        vkDestroyFence(context_.device, fence_, nullptr);
        vkDestroySemaphore(context_.device, acquired_, nullptr);
        vkDestroySemaphore(context_.device, drawn_, nullptr);
        vkDestroyCommandPool(context_.device, pool_, nullptr);
    }

    void run() {
        for (uint32_t left = 0; !verdict_.stopped(); --left) {
            if (left == 0) {
                renew();
                left = 1 + below(random_, 40);
            }
            if (verdict_.failed()) break;
            frame();
            ++context_.presentations;
        }
    }

  private:
    void renew() {
        constexpr VkPresentModeKHR kModes[] = {VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR,
                                               VK_PRESENT_MODE_FIFO_KHR};
        const VkSwapchainKHR old = swapchain_;
        auto info = make<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
        info.surface = surface_;
        info.minImageCount = 2 + below(random_, 3);
        info.imageFormat = VK_FORMAT_B8G8R8A8_UNORM;
        info.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
        info.imageExtent = {1 + below(random_, 300), 1 + below(random_, 300)};
        info.imageArrayLayers = 1;
        info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
        info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
        info.presentMode = kModes[below(random_, 3)];
        info.clipped = VK_TRUE;
        info.oldSwapchain = old;
        {
            const std::lock_guard lock(loaderMutex());
            SOAK_CHECK(verdict_, vkCreateSwapchainKHR, context_.device, &info, nullptr, &swapchain_);
        }
        {
            const std::lock_guard lock(context_.queueMutex);
            SOAK_CHECK(verdict_, vkQueueWaitIdle, context_.queue);
        }
        vkDestroySwapchainKHR(context_.device, old, nullptr);
        uint32_t count = 16;
        images_.resize(count);
        SOAK_CHECK(verdict_, vkGetSwapchainImagesKHR, context_.device, swapchain_, &count, images_.data());
        images_.resize(count);
    }

    void frame() {
        uint32_t index = 0;
        SOAK_CHECK(verdict_, vkAcquireNextImageKHR, context_.device, swapchain_, kLong, acquired_, VK_NULL_HANDLE,
                   &index);
        if (verdict_.failed()) return;
        const auto begin = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        SOAK_CHECK(verdict_, vkBeginCommandBuffer, commands_, &begin);
        auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = images_[index];
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr,
                             0, nullptr, 1, &barrier);
        const VkClearColorValue color{.float32 = {0.25f, 0.5f, 0.75f, 1}};
        vkCmdClearColorImage(commands_, images_[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1,
                             &barrier.subresourceRange);
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = 0;
        barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
        vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0,
                             nullptr, 0, nullptr, 1, &barrier);
        SOAK_CHECK(verdict_, vkEndCommandBuffer, commands_);
        const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
        auto info = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        info.waitSemaphoreCount = info.commandBufferCount = info.signalSemaphoreCount = 1;
        info.pWaitSemaphores = &acquired_;
        info.pWaitDstStageMask = &stage;
        info.pCommandBuffers = &commands_;
        info.pSignalSemaphores = &drawn_;
        auto shown = make<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
        shown.waitSemaphoreCount = shown.swapchainCount = 1;
        shown.pWaitSemaphores = &drawn_;
        shown.pSwapchains = &swapchain_;
        shown.pImageIndices = &index;
        {
            const std::lock_guard lock(context_.queueMutex);
            SOAK_CHECK(verdict_, vkQueueSubmit, context_.queue, 1, &info, fence_);
            SOAK_CHECK(verdict_, vkQueuePresentKHR, context_.queue, &shown);
        }
        SOAK_CHECK(verdict_, vkWaitForFences, context_.device, 1, &fence_, VK_TRUE, kLong);
        SOAK_CHECK(verdict_, vkResetFences, context_.device, 1, &fence_);
    }

    Context& context_;
    Verdict& verdict_;
    Random random_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    std::vector<VkImage> images_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkSemaphore acquired_ = VK_NULL_HANDLE, drawn_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
};

}  // namespace

void present(Context& context, uint32_t seed) {
    Presentation(context, seed).run();
}

uint64_t makeDevices(Verdict& verdict, uint32_t seed) {
    Random random(seed);
    uint64_t count = 0;
    while (!verdict.stopped()) {
        Context context(verdict);
        if (verdict.failed()) break;
        // Some of them work, some are destroyed with work just done, some untouched.
        for (uint32_t submissions = below(random, 3); submissions > 0; --submissions) {
            const std::lock_guard lock(context.queueMutex);
            SOAK_CHECK(verdict, vkQueueSubmit, context.queue, 0, nullptr, VK_NULL_HANDLE);
        }
        if (below(random, 2) == 0) SOAK_CHECK(verdict, vkDeviceWaitIdle, context.device);
        ++count;
    }
    return count;
}

}  // namespace vernier::soak
