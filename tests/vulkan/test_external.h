// Memory, semaphores and fences that leave the device by file descriptors, in a few lines.
#pragma once

#include "tests/vulkan/test_device.h"

namespace vernier::test {

inline constexpr uint64_t kLong = 20'000'000'000, kShort = 20'000'000;
inline constexpr VkDeviceSize kBytes = 65536;

class ExternalTest : public VulkanTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME,
                VK_KHR_EXTERNAL_FENCE_FD_EXTENSION_NAME, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME};
    }

    // --- Memory

    VkDeviceMemory exportable(VkDeviceSize size) {
        auto info = make<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
        info.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        return allocate(size, &info);
    }
    VkDeviceMemory import(int fd, VkDeviceSize size, VkResult expected = VK_SUCCESS) {
        auto info = make<VkImportMemoryFdInfoKHR>(VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR);
        info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        info.fd = fd;
        return allocate(size, &info, expected);
    }
    int fdOf(VkDeviceMemory memory) {
        return getFd<PFN_vkGetMemoryFdKHR>(
            "vkGetMemoryFdKHR", VkMemoryGetFdInfoKHR{VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR, nullptr, memory,
                                                     VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT});
    }
    uint8_t* map(VkDeviceMemory memory) {
        void* data = nullptr;
        EXPECT_EQ(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
        return static_cast<uint8_t*>(data);
    }
    VkBuffer bufferOn(VkDeviceMemory memory, VkDeviceSize size, VkExternalMemoryHandleTypeFlags type) {
        auto external = make<VkExternalMemoryBufferCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO);
        external.handleTypes = type;
        auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        info.pNext = &external;
        info.size = size;
        info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        VkBuffer buffer = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateBuffer(device, &info, nullptr, &buffer), VK_SUCCESS);
        defer([this, buffer] { vkDestroyBuffer(device, buffer, nullptr); });
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(device, buffer, &needs);
        EXPECT_LE(needs.size, size);
        EXPECT_EQ(vkBindBufferMemory(device, buffer, memory, 0), VK_SUCCESS);
        return buffer;
    }

    // --- Semaphores and fences

    VkSemaphore makeSemaphore(bool exported, bool timeline = false, uint64_t value = 0) {
        auto type = make<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
        type.semaphoreType = timeline ? VK_SEMAPHORE_TYPE_TIMELINE : VK_SEMAPHORE_TYPE_BINARY;
        type.initialValue = value;
        auto out = make<VkExportSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO);
        out.pNext = &type;
        out.handleTypes = exported ? VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT : 0;
        auto info = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
        info.pNext = &out;
        VkSemaphore semaphore = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSemaphore(device, &info, nullptr, &semaphore), VK_SUCCESS);
        defer([this, semaphore] { vkDestroySemaphore(device, semaphore, nullptr); });
        return semaphore;
    }
    int fdOf(VkSemaphore semaphore) {
        return getFd<PFN_vkGetSemaphoreFdKHR>(
            "vkGetSemaphoreFdKHR", VkSemaphoreGetFdInfoKHR{VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR, nullptr,
                                                           semaphore, VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT});
    }
    VkResult import(VkSemaphore semaphore, int fd, VkSemaphoreImportFlags flags = 0) {
        const VkImportSemaphoreFdInfoKHR info{
            VK_STRUCTURE_TYPE_IMPORT_SEMAPHORE_FD_INFO_KHR,  nullptr, semaphore, flags,
            VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT, fd};
        return command<PFN_vkImportSemaphoreFdKHR>("vkImportSemaphoreFdKHR")(device, &info);
    }
    VkFence makeFence(bool exported, bool signalled = false) {
        auto out = make<VkExportFenceCreateInfo>(VK_STRUCTURE_TYPE_EXPORT_FENCE_CREATE_INFO);
        out.handleTypes = exported ? VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT : 0;
        auto info = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        info.pNext = &out;
        info.flags = signalled ? VK_FENCE_CREATE_SIGNALED_BIT : 0;
        VkFence fence = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateFence(device, &info, nullptr, &fence), VK_SUCCESS);
        defer([this, fence] { vkDestroyFence(device, fence, nullptr); });
        return fence;
    }
    int fdOf(VkFence fence) {
        return getFd<PFN_vkGetFenceFdKHR>("vkGetFenceFdKHR",
                                          VkFenceGetFdInfoKHR{VK_STRUCTURE_TYPE_FENCE_GET_FD_INFO_KHR, nullptr, fence,
                                                              VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT});
    }
    VkResult import(VkFence fence, int fd, VkFenceImportFlags flags = 0) {
        const VkImportFenceFdInfoKHR info{VK_STRUCTURE_TYPE_IMPORT_FENCE_FD_INFO_KHR,  nullptr, fence, flags,
                                          VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT, fd};
        return command<PFN_vkImportFenceFdKHR>("vkImportFenceFdKHR")(device, &info);
    }
    VkResult wait(VkFence fence, uint64_t timeout) { return vkWaitForFences(device, 1, &fence, VK_TRUE, timeout); }

    struct Point {
        VkSemaphore semaphore;
        uint64_t value;
    };
    /// Waits, runs, signals; without waiting for it. Empty points are left out.
    void submitBetween(Point before, VkCommandBuffer commands, Point after, VkFence fence = VK_NULL_HANDLE) {
        auto values = make<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
        values.waitSemaphoreValueCount = before.semaphore != VK_NULL_HANDLE ? 1 : 0;
        values.pWaitSemaphoreValues = &before.value;
        values.signalSemaphoreValueCount = after.semaphore != VK_NULL_HANDLE ? 1 : 0;
        values.pSignalSemaphoreValues = &after.value;
        const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        auto info = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        info.pNext = &values;
        info.waitSemaphoreCount = values.waitSemaphoreValueCount;
        info.pWaitSemaphores = &before.semaphore;
        info.pWaitDstStageMask = &stage;
        info.commandBufferCount = commands != VK_NULL_HANDLE ? 1 : 0;
        info.pCommandBuffers = &commands;
        info.signalSemaphoreCount = values.signalSemaphoreValueCount;
        info.pSignalSemaphores = &after.semaphore;
        ASSERT_EQ(vkQueueSubmit(queue, 1, &info, fence), VK_SUCCESS);
    }
    static constexpr Point kNothing{VK_NULL_HANDLE, 0};
    VkCommandBuffer fill(VkBuffer buffer, uint32_t value) {
        const VkCommandBuffer commands = begin();
        vkCmdFillBuffer(commands, buffer, 0, VK_WHOLE_SIZE, value);
        EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
        return commands;
    }

  private:
    template <class Function, class Info>
    int getFd(const char* name, const Info& info) {
        int fd = -1;
        EXPECT_EQ(command<Function>(name)(device, &info, &fd), VK_SUCCESS);
        EXPECT_GE(fd, 0);
        return fd;
    }
};

}  // namespace vernier::test
