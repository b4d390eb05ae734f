// Command buffers: a stream of the runtime, and what recording has to remember.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "api/vulkan/descriptor.h"
#include "api/vulkan/handle.h"
#include "api/vulkan/plan_cache.h"
#include "api/vulkan/render_pass.h"
#include "runtime/command/command_buffer.h"

namespace vernier::vulkan {

struct Device;

struct CommandBuffer : Dispatchable {
    CommandBuffer(Device& owner, CommandPool& from, VkCommandBufferLevel of) : device(owner), pool(from), level(of) {}

    enum class State : uint8_t { initial, recording, executable };

    Device& device;
    CommandPool& pool;
    VkCommandBufferLevel level;
    State state = State::initial;
    vernier::CommandBuffer stream;
    VkResult result = VK_SUCCESS;  // what vkEndCommandBuffer will say

    /// The pass being recorded. In a secondary command buffer that continues one, `formats` and `pass` alone are set.
    struct Pass {
        bool inside = false;
        const RenderPassObject* pass = nullptr;  // nullptr: dynamic rendering
        std::vector<const ImageView*> views;
        uint32_t layers = 0;  // 0: not begun here
        uint32_t subpass = 0;
        VkRect2D area{};
        std::vector<VkClearValue> clears;
        SubpassFormats formats;
        bool begunHere() const { return inside && layers != 0; }
    };
    Pass pass;
    const Pipeline* pipeline = nullptr;
    bool pipelineFits = false;  // `pipeline` may draw in the current subpass, and its plan is chosen
    const Pipeline* computePipeline = nullptr;
    SetState set;
    std::vector<std::shared_ptr<const GraphicsPipeline>> plans;  // that draws follow, of plan caches
    std::vector<std::unique_ptr<DescriptorSetObject>> pushed;    // sets of push descriptors
    std::array<DescriptorSetObject*, 2> latestPush{};            // of draws and of dispatches

    bool executable() const { return state == State::executable && result == VK_SUCCESS; }
    void reset();
    /// Notes an error: the command is left out, vkEndCommandBuffer fails, and a message is sent.
    void fail(const char* command, std::string_view text);
    /// Sets pipelineFits, after a pipeline was bound or a subpass begun.
    void checkPipeline();
    /// The state that plans are made for is about to change: a pipeline that takes some from commands needs another.
    SetState& changePlanState();
    /// Notes the samples that a secondary command buffer draws with, where it was not told those of its pass.
    void takeSamples(const GraphicsState& drawn);
    /// Where the pipeline does not fit yet: looks its plan up and records it. False when it cannot draw here.
    bool choosePlan(const char* command);
};

struct CommandPool {
    CommandPool(Device& owner, const VkAllocationCallbacks* given);
    ~CommandPool();

    VkResult allocate(VkCommandBufferLevel level, VkCommandBuffer* out);
    void free(CommandBuffer* buffer);
    void reset();

  private:
    const VkAllocationCallbacks* callbacks() const { return hasCallbacks_ ? &callbacks_ : nullptr; }

    Device& device_;
    bool hasCallbacks_;
    VkAllocationCallbacks callbacks_{};
    std::vector<CommandBuffer*> buffers_;
};

/// Runs the body of a vkCmd* command. Running out of memory is remembered for vkEndCommandBuffer.
template <class Body>
void recording(VkCommandBuffer handle, Body&& body) noexcept {
    CommandBuffer& buffer = *object(handle);
    try {
        body(buffer);
    } catch (...) {
        buffer.result = VK_ERROR_OUT_OF_HOST_MEMORY;
    }
}

/// Copies an array into the buffer's arena.
template <class T>
std::span<const T> copyArray(CommandBuffer& buffer, uint32_t count, const T* elements) {
    return buffer.stream.copy(std::span<const T>(elements, count));
}

/// Ranges of buffers in the buffer's arena; none where there are no buffers. No offsets: from the begin; no sizes: to
/// the end.
inline std::span<const command::BufferRange> copyRanges(CommandBuffer& buffer, uint32_t count, const VkBuffer* buffers,
                                                        const VkDeviceSize* offsets,
                                                        const VkDeviceSize* sizes = nullptr) {
    if (buffers == nullptr) return {};
    const std::span ranges = buffer.stream.arena().array<command::BufferRange>(count);
    for (uint32_t i = 0; i < count; ++i) {
        ranges[i] = {object(buffers[i]), offsets != nullptr ? offsets[i] : 0,
                     sizes != nullptr ? sizes[i] : VK_WHOLE_SIZE};
    }
    return ranges;
}

}  // namespace vernier::vulkan
