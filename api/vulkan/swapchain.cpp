#include "api/vulkan/swapchain.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"
#include "api/vulkan/format_properties.h"
#include "api/vulkan/sync.h"

namespace vernier::vulkan {
namespace {

/// A window has another size when it gets one: what was made for its old size is out of date when it is shown.
Status checkCreateInfo(const PhysicalDevice& device, const VkSwapchainCreateInfoKHR& info,
                       const SurfaceDescription& surface) {
    const auto formatFits = [&](const VkSurfaceFormatKHR& one) {
        return one.format == info.imageFormat && one.colorSpace == info.imageColorSpace;
    };
    if (std::ranges::none_of(surface.formats, formatFits)) {
        return invalidArgument("imageFormat " + nameOf(info.imageFormat) + " is not one of the surface's");
    }
    if (std::ranges::count(surface.presentModes, info.presentMode) == 0) {
        return invalidArgument("presentMode " + std::to_string(info.presentMode) + " is not one of the surface's");
    }
    if (info.imageArrayLayers != 1) return invalidArgument("imageArrayLayers must be 1");
    if ((info.flags & ~VkSwapchainCreateFlagsKHR{VK_SWAPCHAIN_CREATE_MUTABLE_FORMAT_BIT_KHR}) != 0) {
        return unsupported("flags " + std::to_string(info.flags) + " are not supported");
    }
    VkImageFormatProperties limits{};
    if (imageFormatProperties(device, info.imageFormat, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, info.imageUsage, 0,
                              limits) != VK_SUCCESS) {
        return unsupported("imageUsage " + std::to_string(info.imageUsage) + " is not supported");
    }
    const VkExtent2D& extent = info.imageExtent;
    if (extent.width - 1 >= limits.maxExtent.width || extent.height - 1 >= limits.maxExtent.height) {
        return invalidArgument("imageExtent is " + std::to_string(extent.width) + " x " +
                               std::to_string(extent.height) + "; allowed are 1 to " +
                               std::to_string(limits.maxExtent.width));
    }
    return {};
}

Result<SwapchainImage> makeImage(const VkSwapchainCreateInfoKHR& info, Screen& screen) {
    ImageInfo wanted;
    wanted.format = info.imageFormat;
    wanted.extent = {info.imageExtent.width, info.imageExtent.height, 1};
    wanted.usage = info.imageUsage;
    if ((info.flags & VK_SWAPCHAIN_CREATE_MUTABLE_FORMAT_BIT_KHR) != 0) {
        wanted.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
    }
    Result<Image> image = Image::create(wanted);
    if (!image) return image.error();
    Result<std::unique_ptr<Memory>> memory = screen.allocate(image->memorySize());
    if (!memory) return memory.error();
    image->bind(**memory, 0);
    return SwapchainImage{std::move(image).value(), std::move(memory).value()};
}

std::unique_ptr<Screen> makeScreen(const Surface& surface, const VkSwapchainCreateInfoKHR& info, uint32_t hertz) {
    if (surface.connection != nullptr) return makeX11Screen(surface);
    if (surface.display == nullptr) return makeHeadlessScreen();
    const bool opaque = info.compositeAlpha == VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    return makeWaylandScreen(surface, opaque, /*paced=*/hertz != 0);
}

Presenter::Clock::duration refreshPeriod(uint32_t hertz) {
    if (hertz == 0) return Presenter::Clock::duration::zero();
    return std::chrono::duration_cast<Presenter::Clock::duration>(std::chrono::seconds(1)) / hertz;
}

constexpr const char* kCommand = "vkCreateSwapchainKHR";

/// Throws std::system_error when no thread can be started.
VkResult create(Device& device, const VkSwapchainCreateInfoKHR& info, const VkAllocationCallbacks* callbacks,
                VkSwapchainKHR* out) {
    Surface& surface = *object(info.surface);
    // "oldSwapchain is retired, even if creation of the new swapchain fails".
    if (info.oldSwapchain != VK_NULL_HANDLE) object(info.oldSwapchain)->presenter->retire();
    if (const auto other = surface.presenter.lock(); other && other->active()) {
        return device.report(kCommand, VK_ERROR_NATIVE_WINDOW_IN_USE_KHR, "the surface has another swapchain");
    }
    SurfaceDescription description;
    if (const VkResult result = describe(surface, description); result != VK_SUCCESS) return result;
    if (const Status status = checkCreateInfo(device.physicalDevice, info, description); !status) {
        return device.report(kCommand, status.error());
    }
    const uint32_t hertz = device.physicalDevice.configuration.refreshRate;
    std::shared_ptr<Screen> screen = makeScreen(surface, info, hertz);
    if (!screen) return VK_ERROR_SURFACE_LOST_KHR;
    // One that waits for the refresh, one that is shown, and one to draw to: a mailbox never makes anybody wait. A
    // Wayland compositor can have one more, which it is about to show.
    const uint32_t more = surface.display != nullptr ? 2 : 1;
    const uint32_t least = kMinSwapchainImages + (info.presentMode == VK_PRESENT_MODE_MAILBOX_KHR ? more : 0);
    std::deque<SwapchainImage> images;
    std::vector<const Image*> shown;
    const uint32_t count = std::max(info.minImageCount, least);
    const VkDeviceSize heap = device.physicalDevice.memory.memoryHeaps[0].size;
    for (uint32_t i = 0; i < count; ++i) {
        Result<SwapchainImage> image = makeImage(info, *screen);
        if (!image) return device.report(kCommand, image.error());
        if (count > heap / image->memory->size()) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        shown.push_back(&images.emplace_back(std::move(image).value()).image);
    }
    const auto presenter =
        std::make_shared<Presenter>(screen, std::move(shown), info.presentMode, refreshPeriod(hertz));
    const VkResult result = createHandle(callbacks, out, Swapchain(std::move(screen), std::move(images), presenter));
    if (result == VK_SUCCESS) surface.presenter = presenter;
    return result;
}

VkResult acquire(const Device& device, VkSwapchainKHR swapchain, uint64_t timeout, VkSemaphore semaphore, VkFence fence,
                 uint32_t* index) {
    return guarded([&] {
        if (device.lost()) return VK_ERROR_DEVICE_LOST;
        const VkResult result = object(swapchain)->presenter->acquire(timeout, *index);
        if (result != VK_SUCCESS) return result;
        // The image is free: nothing is left to wait for.
        if (semaphore != VK_NULL_HANDLE) object(semaphore)->binary.signal();
        if (fence != VK_NULL_HANDLE) object(fence)->signal();
        return VK_SUCCESS;
    });
}

/// The images of one vkQueuePresentKHR. The application has them back unless the queue takes them.
class EnqueuedImages {
  public:
    using List = std::vector<std::pair<std::shared_ptr<Presenter>, uint32_t>>;

    explicit EnqueuedImages(uint32_t most) { list_.reserve(most); }
    EnqueuedImages(const EnqueuedImages&) = delete;
    EnqueuedImages& operator=(const EnqueuedImages&) = delete;
    ~EnqueuedImages() {
        for (const auto& [presenter, index] : list_) presenter->takeBack(index);
    }

    /// False: the image is not acquired.
    bool add(const std::shared_ptr<Presenter>& presenter, uint32_t index) {
        if (!presenter->enqueue(index)) return false;
        list_.emplace_back(presenter, index);
        return true;
    }
    const List& list() const { return list_; }
    void taken() { list_.clear(); }

  private:
    List list_;
};

/// The worst counts ("vkQueuePresentKHR"): in this order.
VkResult worse(VkResult one, VkResult other) {
    const auto rank = [](VkResult result) {
        switch (result) {
            case VK_SUCCESS:
                return 0;
            case VK_ERROR_OUT_OF_DATE_KHR:
                return 1;
            default:
                return 2;
        }
    };
    return rank(one) >= rank(other) ? one : other;
}

VkResult present(Device& device, const VkPresentInfoKHR& info) {
    Submission submission;
    for (uint32_t i = 0; i < info.waitSemaphoreCount; ++i) {
        submission.waitSemaphores.push_back(&object(info.pWaitSemaphores[i])->binary);
    }
    EnqueuedImages images(info.swapchainCount);
    VkResult worst = VK_SUCCESS;
    for (uint32_t i = 0; i < info.swapchainCount; ++i) {
        const std::shared_ptr<Presenter>& presenter = object(info.pSwapchains[i])->presenter;
        VkResult one = presenter->status();
        // With an error, too, the semaphores are waited for, and the image goes back to the swapchain.
        if (!images.add(presenter, info.pImageIndices[i])) {
            one = device.report("vkQueuePresentKHR", VK_ERROR_UNKNOWN,
                                "image " + std::to_string(info.pImageIndices[i]) + " is not acquired");
        }
        if (info.pResults != nullptr) info.pResults[i] = one;
        worst = worse(worst, one);
    }
    submission.done = [shows = images.list()] {
        for (const auto& [presenter, index] : shows) presenter->present(index);
    };
    device.runtime->queue().submit(std::move(submission));
    images.taken();
    return device.lost() ? VK_ERROR_DEVICE_LOST : worst;
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL CreateSwapchainKHR(VkDevice device, const VkSwapchainCreateInfoKHR* pCreateInfo,
                                                  const VkAllocationCallbacks* pAllocator, VkSwapchainKHR* pSwapchain) {
    return guarded([&] {
        try {
            return create(*object(device), *pCreateInfo, pAllocator, pSwapchain);
        } catch (const std::system_error& error) {
            return object(device)->report(kCommand, VK_ERROR_OUT_OF_HOST_MEMORY,
                                          std::string("no thread could be started: ") + error.what());
        }
    });
}

VKAPI_ATTR void VKAPI_CALL DestroySwapchainKHR(VkDevice, VkSwapchainKHR swapchain,
                                               const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, swapchain);
}

VKAPI_ATTR VkResult VKAPI_CALL GetSwapchainImagesKHR(VkDevice, VkSwapchainKHR swapchain, uint32_t* pSwapchainImageCount,
                                                     VkImage* pSwapchainImages) {
    OutputArray<VkImage> output(pSwapchainImageCount, pSwapchainImages);
    for (SwapchainImage& one : object(swapchain)->images) output.add(handleOf<VkImage>(&one.image));
    return output.result();
}

VKAPI_ATTR VkResult VKAPI_CALL AcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout,
                                                   VkSemaphore semaphore, VkFence fence, uint32_t* pImageIndex) {
    return acquire(*object(device), swapchain, timeout, semaphore, fence, pImageIndex);
}

VKAPI_ATTR VkResult VKAPI_CALL AcquireNextImage2KHR(VkDevice device, const VkAcquireNextImageInfoKHR* pAcquireInfo,
                                                    uint32_t* pImageIndex) {
    return acquire(*object(device), pAcquireInfo->swapchain, pAcquireInfo->timeout, pAcquireInfo->semaphore,
                   pAcquireInfo->fence, pImageIndex);
}

VKAPI_ATTR VkResult VKAPI_CALL QueuePresentKHR(VkQueue queue, const VkPresentInfoKHR* pPresentInfo) {
    return guarded([&] { return present(object(queue)->device, *pPresentInfo); });
}

}  // namespace vernier::vulkan
