// VK_LAYER_VERNIER_frames: writes what a program presents into files, on whatever driver it runs, for
// `vernier run --diff`.
//
//   VERNIER_FRAMES_DIR   the folder: frame-0000.ppm, frame-0001.ppm, ... in the order of presentation
//   VERNIER_FRAMES       after so many the program is ended, with success
//   VERNIER_FRAMES_IDLE  when it presents nothing for so many seconds after a frame, too: it waits for somebody at the
//   window
//
// Frames of formats that it cannot write are counted, and named once.
// Each presentation waits for the device, so that the picture is complete: the layer is for comparing, not for speed.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "api/vulkan/run/layer.h"

namespace vernier::layer {
namespace {

struct SwapchainData {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::vector<VkImage> images;
};

/// Of the next layer, or the driver.
#define FRAMES_DEVICE_COMMANDS(X)  \
    X(AllocateCommandBuffers)      \
    X(AllocateMemory)              \
    X(BeginCommandBuffer)          \
    X(BindBufferMemory)            \
    X(CmdCopyImageToBuffer)        \
    X(CmdPipelineBarrier)          \
    X(CreateBuffer)                \
    X(CreateCommandPool)           \
    X(CreateSwapchainKHR)          \
    X(DestroyBuffer)               \
    X(DestroyCommandPool)          \
    X(DestroySwapchainKHR)         \
    X(DeviceWaitIdle)              \
    X(EndCommandBuffer)            \
    X(FreeMemory)                  \
    X(GetBufferMemoryRequirements) \
    X(GetDeviceQueue)              \
    X(GetDeviceQueue2)             \
    X(GetSwapchainImagesKHR)       \
    X(MapMemory)                   \
    X(QueuePresentKHR)             \
    X(QueueSubmit)                 \
    X(QueueWaitIdle)

struct DeviceData {
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkSetDeviceLoaderData setLoaderData = nullptr;
    VkPhysicalDeviceMemoryProperties memory{};
#define FRAMES_MEMBER(name) PFN_vk##name name = nullptr;
    FRAMES_DEVICE_COMMANDS(FRAMES_MEMBER)
#undef FRAMES_MEMBER
    std::map<VkQueue, uint32_t> families;
    std::map<VkSwapchainKHR, SwapchainData> swapchains;
};

struct Registry {
    std::mutex mutex;
    std::map<void*, std::unique_ptr<DeviceData>> devices;  // by keyOf()
    uint32_t frames = 0;
};

Registry& registry() {
    static Registry one;
    return one;
}

DeviceData* find(void* key) {
    const std::lock_guard lock(registry().mutex);
    const auto found = registry().devices.find(key);
    return found != registry().devices.end() ? found->second.get() : nullptr;
}

template <class T>
T make(VkStructureType type) {
    T structure{};
    structure.sType = type;
    return structure;
}

// --- Pictures

/// Whether texels have four bytes that are R, G, B or B, G, R and something.
bool isKnown(VkFormat format) {
    return format == VK_FORMAT_B8G8R8A8_UNORM || format == VK_FORMAT_B8G8R8A8_SRGB ||
           format == VK_FORMAT_R8G8B8A8_UNORM || format == VK_FORMAT_R8G8B8A8_SRGB;
}

void write(const SwapchainData& swapchain, const uint8_t* texels, uint32_t number) {
    const char* const folder = std::getenv("VERNIER_FRAMES_DIR");
    char name[32];
    std::snprintf(name, sizeof name, "/frame-%04u.ppm", number);
    std::FILE* const file = folder != nullptr ? std::fopen((folder + std::string(name)).c_str(), "wb") : nullptr;
    if (file == nullptr) return;
    const bool blueFirst = swapchain.format == VK_FORMAT_B8G8R8A8_UNORM || swapchain.format == VK_FORMAT_B8G8R8A8_SRGB;
    std::fprintf(file, "P6\n%u %u\n255\n", swapchain.extent.width, swapchain.extent.height);
    std::vector<uint8_t> row(size_t{swapchain.extent.width} * 3);
    for (uint32_t y = 0; y < swapchain.extent.height; ++y) {
        for (uint32_t x = 0; x < swapchain.extent.width; ++x, texels += 4) {
            for (uint32_t c = 0; c < 3; ++c) row[3 * x + c] = texels[blueFirst ? 2 - c : c];
        }
        std::fwrite(row.data(), 1, row.size(), file);
    }
    std::fclose(file);
}

/// Copies the image to memory of the host's and writes it. The device is idle.
void capture(DeviceData& data, VkQueue queue, const SwapchainData& swapchain, VkImage image, uint32_t number) {
    const VkDevice device = data.device;
    auto bufferInfo = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    bufferInfo.size = VkDeviceSize{4} * swapchain.extent.width * swapchain.extent.height;
    bufferInfo.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    void* texels = nullptr;
    const auto run = [&] {
        if (data.CreateBuffer(device, &bufferInfo, nullptr, &buffer) != VK_SUCCESS) return;
        VkMemoryRequirements needs{};
        data.GetBufferMemoryRequirements(device, buffer, &needs);
        auto allocation = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        allocation.allocationSize = needs.size;
        constexpr VkMemoryPropertyFlags kWanted =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        while (allocation.memoryTypeIndex < data.memory.memoryTypeCount &&
               ((needs.memoryTypeBits >> allocation.memoryTypeIndex & 1) == 0 ||
                (data.memory.memoryTypes[allocation.memoryTypeIndex].propertyFlags & kWanted) != kWanted))
            ++allocation.memoryTypeIndex;
        if (data.AllocateMemory(device, &allocation, nullptr, &memory) != VK_SUCCESS ||
            data.BindBufferMemory(device, buffer, memory, 0) != VK_SUCCESS)
            return;
        auto poolInfo = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        poolInfo.queueFamilyIndex = data.families[queue];
        if (data.CreateCommandPool(device, &poolInfo, nullptr, &pool) != VK_SUCCESS) return;
        auto commandsInfo = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        commandsInfo.commandPool = pool;
        commandsInfo.commandBufferCount = 1;
        if (data.AllocateCommandBuffers(device, &commandsInfo, &commands) != VK_SUCCESS) return;
        if (data.setLoaderData != nullptr) data.setLoaderData(device, commands);
        const auto begin = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        if (data.BeginCommandBuffer(commands, &begin) != VK_SUCCESS) return;
        auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
        barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image;
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        const auto pass = [&] {
            data.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                                    0, nullptr, 0, nullptr, 1, &barrier);
        };
        pass();
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {swapchain.extent.width, swapchain.extent.height, 1};
        data.CmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
        std::swap(barrier.oldLayout, barrier.newLayout);
        std::swap(barrier.srcAccessMask, barrier.dstAccessMask);
        pass();
        auto submission = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        submission.commandBufferCount = 1;
        submission.pCommandBuffers = &commands;
        if (data.EndCommandBuffer(commands) != VK_SUCCESS ||
            data.QueueSubmit(queue, 1, &submission, VK_NULL_HANDLE) != VK_SUCCESS ||
            data.QueueWaitIdle(queue) != VK_SUCCESS ||
            data.MapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &texels) != VK_SUCCESS)
            return;
        write(swapchain, static_cast<const uint8_t*>(texels), number);
    };
    run();
    data.DestroyCommandPool(device, pool, nullptr);
    data.DestroyBuffer(device, buffer, nullptr);
    data.FreeMemory(device, memory, nullptr);
}

// --- Programs that show something and then wait for somebody

/// The number in a variable of the environment, 0 without one.
uint32_t numberOf(const char* variable) {
    const char* const text = std::getenv(variable);
    return text != nullptr ? static_cast<uint32_t>(std::strtoul(text, nullptr, 10)) : 0;
}

/// Ends the program some time after its last frame. Lives as long as the process.
class Watch {
  public:
    /// nullptr when nobody asked for it.
    static Watch* get() {
        static Watch* const one = numberOf("VERNIER_FRAMES_IDLE") != 0 ? new Watch : nullptr;
        return one;
    }
    /// While a frame is taken time does not count.
    void pause() {
        const std::lock_guard lock(mutex_);
        ++taking_;
    }
    void resume() {
        const std::lock_guard lock(mutex_);
        --taking_;
        deadline_ = Clock::now() + std::chrono::seconds(numberOf("VERNIER_FRAMES_IDLE"));
        if (started_) return;
        try {
            std::thread([this] { main(); }).detach();
            started_ = true;
        } catch (const std::system_error&) {
            // The next frame tries again; without a thread the program goes on.
        }
    }

  private:
    using Clock = std::chrono::steady_clock;

    void main() {
        for (;;) {
            Clock::time_point until;
            {
                const std::lock_guard lock(mutex_);
                const Clock::time_point now = Clock::now();
                if (taking_ == 0 && now >= deadline_) {
                    std::fprintf(stderr, "VK_LAYER_VERNIER_frames: the program presents nothing more\n");
                    std::_Exit(EXIT_SUCCESS);
                }
                until = taking_ == 0 ? deadline_ : now + std::chrono::seconds(1);
            }
            std::this_thread::sleep_until(until);
        }
    }

    std::mutex mutex_;
    Clock::time_point deadline_;
    uint32_t taking_ = 0;
    bool started_ = false;
};

struct FrameTaken {
    FrameTaken() {
        if (Watch* const watch = Watch::get()) watch->pause();
    }
    FrameTaken(const FrameTaken&) = delete;
    FrameTaken& operator=(const FrameTaken&) = delete;
    ~FrameTaken() {
        if (Watch* const watch = Watch::get()) watch->resume();
    }
};

// --- Commands that the layer takes part in

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physicalDevice, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks, VkDevice* device) {
    Next next;
    const VkResult result = createDeviceOfNext(physicalDevice, *info, callbacks, device, next);
    if (result != VK_SUCCESS) return result;
    auto data = std::make_unique<DeviceData>();
    data->device = *device;
    data->setLoaderData = next.setLoaderData;
    const auto memory = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        next.ofInstance(next.instance, "vkGetPhysicalDeviceMemoryProperties"));
    memory(physicalDevice, &data->memory);
#define FRAMES_LOAD(name) data->name = reinterpret_cast<PFN_vk##name>(next.ofDevice(*device, "vk" #name));
    FRAMES_DEVICE_COMMANDS(FRAMES_LOAD)
#undef FRAMES_LOAD
    const std::lock_guard lock(registry().mutex);
    registry().devices[keyOf(*device)] = std::move(data);
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* callbacks) {
    if (device == VK_NULL_HANDLE) return;
    {
        const std::lock_guard lock(registry().mutex);
        registry().devices.erase(keyOf(device));
    }
    destroyDeviceOfNext(device, callbacks);
}

VKAPI_ATTR void VKAPI_CALL getDeviceQueue(VkDevice device, uint32_t family, uint32_t index, VkQueue* queue) {
    DeviceData& data = *find(keyOf(device));
    data.GetDeviceQueue(device, family, index, queue);
    data.families[*queue] = family;
}

VKAPI_ATTR void VKAPI_CALL getDeviceQueue2(VkDevice device, const VkDeviceQueueInfo2* info, VkQueue* queue) {
    DeviceData& data = *find(keyOf(device));
    data.GetDeviceQueue2(device, info, queue);
    data.families[*queue] = info->queueFamilyIndex;
}

VKAPI_ATTR VkResult VKAPI_CALL createSwapchain(VkDevice device, const VkSwapchainCreateInfoKHR* info,
                                               const VkAllocationCallbacks* callbacks, VkSwapchainKHR* swapchain) {
    DeviceData& data = *find(keyOf(device));
    VkSwapchainCreateInfoKHR copied = *info;
    copied.imageUsage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const VkResult result = data.CreateSwapchainKHR(device, &copied, callbacks, swapchain);
    if (result != VK_SUCCESS) return result;
    SwapchainData made{info->imageFormat, info->imageExtent, {}};
    uint32_t count = 0;
    (void)data.GetSwapchainImagesKHR(device, *swapchain, &count, nullptr);
    made.images.resize(count);
    (void)data.GetSwapchainImagesKHR(device, *swapchain, &count, made.images.data());
    data.swapchains[*swapchain] = std::move(made);
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroySwapchain(VkDevice device, VkSwapchainKHR swapchain,
                                            const VkAllocationCallbacks* callbacks) {
    DeviceData& data = *find(keyOf(device));
    data.swapchains.erase(swapchain);
    data.DestroySwapchainKHR(device, swapchain, callbacks);
}

VKAPI_ATTR VkResult VKAPI_CALL queuePresent(VkQueue queue, const VkPresentInfoKHR* info) {
    DeviceData& data = *find(keyOf(queue));
    const uint32_t most = numberOf("VERNIER_FRAMES");
    {
        const FrameTaken taken;
        // All that the semaphores stand for has been submitted, and is done then.
        data.DeviceWaitIdle(data.device);
        for (uint32_t i = 0; i < info->swapchainCount; ++i) {
            const SwapchainData& swapchain = data.swapchains[info->pSwapchains[i]];
            const uint32_t index = info->pImageIndices[i];
            if (index >= swapchain.images.size()) continue;
            uint32_t number = 0;
            {
                const std::lock_guard lock(registry().mutex);
                number = registry().frames++;
            }
            if (isKnown(swapchain.format)) {
                capture(data, queue, swapchain, swapchain.images[index], number);
            } else if (number == 0) {
                std::fprintf(stderr, "VK_LAYER_VERNIER_frames: images of format %d cannot be written\n",
                             swapchain.format);
            }
            if (most != 0 && number + 1 >= most) std::_Exit(EXIT_SUCCESS);
        }
    }
    return data.QueuePresentKHR(queue, info);
}

}  // namespace

std::span<const OwnCommand> ownCommands() {
#define FRAMES_OWN(command, function, ofDevice) \
    { command, reinterpret_cast<PFN_vkVoidFunction>(&function), ofDevice }
    static const OwnCommand kOwn[] = {
        FRAMES_OWN("vkCreateDevice", createDevice, false),
        FRAMES_OWN("vkDestroyDevice", destroyDevice, true),
        FRAMES_OWN("vkGetDeviceQueue", getDeviceQueue, true),
        FRAMES_OWN("vkGetDeviceQueue2", getDeviceQueue2, true),
        FRAMES_OWN("vkCreateSwapchainKHR", createSwapchain, true),
        FRAMES_OWN("vkDestroySwapchainKHR", destroySwapchain, true),
        FRAMES_OWN("vkQueuePresentKHR", queuePresent, true),
    };
#undef FRAMES_OWN
    return kOwn;
}

}  // namespace vernier::layer
