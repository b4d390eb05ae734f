// Command pools and the life of command buffers.
#include <algorithm>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {

void CommandBuffer::reset() {
    stream.reset();
    state = State::initial;
    result = VK_SUCCESS;
    pass = {};
    pipeline = nullptr;
    pipelineFits = false;
    computePipeline = nullptr;
    set = {};
    plans.clear();
    pushed.clear();
    latestPush = {};
}

void CommandBuffer::fail(const char* command, std::string_view text) {
    if (result != VK_SUCCESS) return;  // a consequence of what was told before, of memory that ran out, say
    device.messages().error(command, {VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<uint64_t>(this)}, text);
    result = VK_ERROR_UNKNOWN;
}

namespace {

/// What a secondary command buffer is told of the pass that it continues.
void inheritPass(const VkCommandBufferInheritanceInfo& inherited, CommandBuffer::Pass& pass) {
    if (inherited.renderPass != VK_NULL_HANDLE) {
        pass.pass = object(inherited.renderPass);
        pass.inside = inherited.subpass < pass.pass->subpasses.size();
        pass.subpass = inherited.subpass;
        if (pass.inside) pass.formats = pass.pass->formats(inherited.subpass);
    } else if (const auto* rendering = findInChain<VkCommandBufferInheritanceRenderingInfo>(inherited.pNext)) {
        pass.inside = true;
        pass.formats.colorCount = std::min(rendering->colorAttachmentCount, kMaxColorAttachments);
        std::copy_n(rendering->pColorAttachmentFormats, pass.formats.colorCount, pass.formats.colors);
        pass.formats.depth = rendering->depthAttachmentFormat;
        pass.formats.stencil = rendering->stencilAttachmentFormat;
        // The samples of the images (VUID-vkCmdExecuteCommands-pNext-06035): one may be drawn to with more.
        const auto samples = static_cast<uint32_t>(rendering->rasterizationSamples);
        pass.formats.samples = samples != 1 ? samples : 0;
        pass.formats.viewMask = rendering->viewMask;
    }
}

}  // namespace

CommandPool::CommandPool(Device& owner, const VkAllocationCallbacks* given)
    : device_(owner), hasCallbacks_(given != nullptr) {
    if (given != nullptr) callbacks_ = *given;
}

CommandPool::~CommandPool() {
    while (!buffers_.empty()) free(buffers_.back());
}

VkResult CommandPool::allocate(VkCommandBufferLevel level, VkCommandBuffer* out) {
    // Room first, and twice of it each time: nothing may fail once the object is made.
    if (buffers_.size() == buffers_.capacity()) buffers_.reserve(2 * buffers_.size() + 1);
    auto* buffer = newObject<CommandBuffer>(callbacks(), VK_SYSTEM_ALLOCATION_SCOPE_OBJECT, device_, *this, level);
    if (buffer == nullptr) return VK_ERROR_OUT_OF_HOST_MEMORY;
    buffers_.push_back(buffer);
    *out = handleOf<VkCommandBuffer>(buffer);
    return VK_SUCCESS;
}

void CommandPool::free(CommandBuffer* buffer) {
    const auto found = std::find(buffers_.begin(), buffers_.end(), buffer);
    if (found == buffers_.end()) return;
    *found = buffers_.back();
    buffers_.pop_back();
    deleteObject(callbacks(), buffer);
}

void CommandPool::reset() {
    for (CommandBuffer* buffer : buffers_) buffer->reset();
}

VKAPI_ATTR VkResult VKAPI_CALL CreateCommandPool(VkDevice device, const VkCommandPoolCreateInfo*,
                                                 const VkAllocationCallbacks* pAllocator, VkCommandPool* pCommandPool) {
    return createHandle(pAllocator, pCommandPool, *object(device), pAllocator);
}

VKAPI_ATTR void VKAPI_CALL DestroyCommandPool(VkDevice, VkCommandPool commandPool,
                                              const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, commandPool);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetCommandPool(VkDevice, VkCommandPool commandPool, VkCommandPoolResetFlags) {
    object(commandPool)->reset();
    return VK_SUCCESS;
}

// Command buffers hold their own memory; a pool has none to give back.
VKAPI_ATTR void VKAPI_CALL TrimCommandPool(VkDevice, VkCommandPool, VkCommandPoolTrimFlags) {}

VKAPI_ATTR VkResult VKAPI_CALL AllocateCommandBuffers(VkDevice, const VkCommandBufferAllocateInfo* pAllocateInfo,
                                                      VkCommandBuffer* pCommandBuffers) {
    CommandPool& pool = *object(pAllocateInfo->commandPool);
    const uint32_t count = pAllocateInfo->commandBufferCount;
    std::fill_n(pCommandBuffers, count, nullptr);
    const VkResult result = guarded([&] {
        for (uint32_t i = 0; i < count; ++i) {
            const VkResult one = pool.allocate(pAllocateInfo->level, &pCommandBuffers[i]);
            if (one != VK_SUCCESS) return one;
        }
        return VK_SUCCESS;
    });
    if (result != VK_SUCCESS) {
        // All or nothing, as with descriptor sets.
        for (uint32_t i = 0; i < count; ++i) {
            if (pCommandBuffers[i] != nullptr) pool.free(object(pCommandBuffers[i]));
            pCommandBuffers[i] = nullptr;
        }
    }
    return result;
}

VKAPI_ATTR void VKAPI_CALL FreeCommandBuffers(VkDevice, VkCommandPool commandPool, uint32_t commandBufferCount,
                                              const VkCommandBuffer* pCommandBuffers) {
    for (uint32_t i = 0; i < commandBufferCount; ++i) {
        if (pCommandBuffers[i] != nullptr) object(commandPool)->free(object(pCommandBuffers[i]));
    }
}

VKAPI_ATTR VkResult VKAPI_CALL BeginCommandBuffer(VkCommandBuffer commandBuffer,
                                                  const VkCommandBufferBeginInfo* pBeginInfo) {
    CommandBuffer& buffer = *object(commandBuffer);
    buffer.reset();
    buffer.state = CommandBuffer::State::recording;
    const VkCommandBufferInheritanceInfo* inherited = pBeginInfo->pInheritanceInfo;
    if (buffer.level == VK_COMMAND_BUFFER_LEVEL_SECONDARY && inherited != nullptr &&
        (pBeginInfo->flags & VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT) != 0) {
        inheritPass(*inherited, buffer.pass);
    }
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL EndCommandBuffer(VkCommandBuffer commandBuffer) {
    CommandBuffer& buffer = *object(commandBuffer);
    buffer.state = CommandBuffer::State::executable;
    return buffer.result;
}

VKAPI_ATTR VkResult VKAPI_CALL ResetCommandBuffer(VkCommandBuffer commandBuffer, VkCommandBufferResetFlags) {
    object(commandBuffer)->reset();
    return VK_SUCCESS;
}

}  // namespace vernier::vulkan
