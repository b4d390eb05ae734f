// The commands as plain structs. A command names objects by pointer; whoever records keeps them alive until the
// commands have run (Vulkan's own rule; the mini API holds references for its user). Spans point into the command
// buffer's arena.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "runtime/attachment_ops.h"
#include "runtime/limits.h"
#include "runtime/plan/compute_pipeline.h"
#include "runtime/plan/pipeline.h"
#include "runtime/resource/descriptor.h"
#include "runtime/resource/image.h"
#include "runtime/resource/memory.h"

namespace vernier {

class CommandBuffer;
class QueryPool;
struct PassStatistics;

struct RenderingAttachment : AttachmentOps {
    const ImageView* view = nullptr;     // nullptr: not used
    const ImageView* resolve = nullptr;  // what the samples are resolved to at the end: the average of colours
    // Of depth and stencil.
    VkResolveModeFlagBits depthResolveMode = VK_RESOLVE_MODE_NONE, stencilResolveMode = VK_RESOLVE_MODE_NONE;
};

namespace command {

struct BeginRendering {
    uint32_t colorCount = 0;
    std::array<RenderingAttachment, kMaxColorAttachments> colors{};
    RenderingAttachment depthStencil{};
    VkRect2D renderArea{};
    uint32_t layers = 1;
    uint32_t viewMask = 0;  // not 0: multiview
    uint32_t samples = 1;
    PassStatistics* statistics = nullptr;  // where to add what was counted, or nullptr
    std::span<const SampledInput> sampledInputs;
};
struct EndRendering {};
/// Finishes the draws of the pass so far: what they wrote can be read by the draws to come.
struct Flush {};
struct ClearAttachments {
    std::span<const VkClearAttachment> attachments;
    std::span<const VkClearRect> rects;
};
struct BindPipeline {
    const GraphicsPipeline* pipeline = nullptr;
    // Values the pipeline fixes; applied to the dynamic state for the bits not set in `dynamicMask`.
    const DynamicState* fixed = nullptr;
    uint32_t dynamicMask = 0;  // of dynamicStateBit(): left as set by commands
    // Whether the stages reach memory by address (usesAddresses()).
    bool vertexAddresses = false, fragmentAddresses = false;
};
struct BindComputePipeline {
    const ComputePipeline* pipeline = nullptr;
    bool addresses = false;
};
/// Draws and dispatches have descriptor sets and push constants of their own.
enum class BindPoint : uint8_t { graphics, compute };
struct BindDescriptorSets {
    BindPoint bindPoint = BindPoint::graphics;
    uint32_t firstSet = 0;
    std::span<const DescriptorSet* const> sets;
    std::span<const std::span<const uint32_t>> dynamicOffsets;  // one per set
};
struct PushConstants {
    VkShaderStageFlags stages = VK_SHADER_STAGE_ALL;
    uint32_t offset = 0;
    std::span<const std::byte> bytes;
};
struct BufferRange {
    const Buffer* buffer = nullptr;  // nullptr: unbound, reads give 0
    VkDeviceSize offset = 0;
    VkDeviceSize size = VK_WHOLE_SIZE;  // what lies behind is neither read (vertices: it reads as 0) nor written
};
struct BindVertexBuffers {
    uint32_t first = 0;
    std::span<const BufferRange> ranges;
};
struct BindIndexBuffer {
    BufferRange range;
    VkIndexType type = VK_INDEX_TYPE_UINT16;
};
struct SetViewports {
    uint32_t first = 0;
    std::span<const VkViewport> viewports;
};
struct SetScissors {
    uint32_t first = 0;
    std::span<const VkRect2D> scissors;
};
struct SetLineWidth {
    float width = 1;
};
struct SetLineStipple {
    uint32_t factor = 1;
    uint16_t pattern = 0xFFFF;
};
struct SetDepthBias {
    float constant = 0, clamp = 0, slope = 0;
};
struct SetBlendConstants {
    std::array<float, 4> constants{};
};
struct SetColorWrites {
    uint32_t mask = ~0u;
};
struct SetDepthBounds {
    float min = 0, max = 1;
};
struct SetStencil {
    VkStencilFaceFlags faces = VK_STENCIL_FACE_FRONT_AND_BACK;
    enum class Field : uint8_t { compareMask, writeMask, reference } field = Field::reference;
    uint32_t value = 0;
};
struct SetSampleLocations {
    std::array<SamplePosition, kMaxSamples> locations{};
};
/// Draws, dispatches and clears of attachments up to the end are left out while the 32 bits of the predicate are 0, or,
/// inverted, while they are not. They are read here, once; a predicate outside its buffer is 0.
struct BeginConditionalRendering {
    BufferRange predicate;
    bool inverted = false;
};
struct EndConditionalRendering {};
struct Draw {
    bool indexed = false;
    uint32_t count = 0, instances = 1, first = 0, firstInstance = 0;
    int32_t vertexOffset = 0;
    uint32_t drawIndex = 0;
};
struct DrawIndirect {
    bool indexed = false;
    BufferRange arguments;
    uint32_t drawCount = 0;
    uint32_t stride = 0;
    BufferRange countBuffer;  // buffer == nullptr: drawCount counts
};
/// Where transform feedback writes from the next BeginTransformFeedback on.
struct BindTransformFeedbackBuffers {
    uint32_t first = 0;
    std::span<const BufferRange> ranges;
};
/// Draws capture from here on, unless the pass is multiview. `counters` belong to the buffers from `first` on: each
/// holds the bytes of the bound range after which its buffer goes on (32 bits); others begin with the range.
struct BeginTransformFeedback {
    uint32_t first = 0;
    std::span<const BufferRange> counters;
};
/// Writes counters from which BeginTransformFeedback can go on.
struct EndTransformFeedback {
    uint32_t first = 0;
    std::span<const BufferRange> counters;
};
/// As many vertices as have been captured: (counter - counterOffset) / stride.
struct DrawIndirectByteCount {
    BufferRange counter;
    uint32_t counterOffset = 0;
    uint32_t stride = 0;  // not 0
    uint32_t instances = 1, firstInstance = 0;
};
/// Outside a pass; not begun before all commands before it are done, and done before the next begins.
struct Dispatch {
    std::array<uint32_t, 3> base{};  // added to WorkgroupId
    std::array<uint32_t, 3> count{};
    PassStatistics* statistics = nullptr;  // where to add what was counted, or nullptr
};
/// VkDispatchIndirectCommand is read when the command runs. Counts above kMaxWorkGroupCount run nothing.
struct DispatchIndirect {
    BufferRange arguments;
    PassStatistics* statistics = nullptr;
};
struct CopyBuffer {
    const Buffer* source = nullptr;
    const Buffer* destination = nullptr;
    std::span<const VkBufferCopy> regions;
};
struct CopyImage {
    const Image* source = nullptr;
    const Image* destination = nullptr;
    std::span<const VkImageCopy> regions;
};
struct CopyBufferToImage {
    const Buffer* buffer = nullptr;
    const Image* image = nullptr;
    std::span<const VkBufferImageCopy> regions;
};
struct CopyImageToBuffer {
    const Image* image = nullptr;
    const Buffer* buffer = nullptr;
    std::span<const VkBufferImageCopy> regions;
};
struct BlitImage {
    const Image* source = nullptr;
    const Image* destination = nullptr;
    std::span<const VkImageBlit> regions;
    VkFilter filter = VK_FILTER_NEAREST;
};
struct ResolveImage {
    const Image* source = nullptr;
    const Image* destination = nullptr;
    std::span<const VkImageResolve> regions;
};
struct ClearColorImage {
    const Image* image = nullptr;
    VkClearColorValue value{};
    std::span<const VkImageSubresourceRange> ranges;
};
struct ClearDepthStencilImage {
    const Image* image = nullptr;
    VkClearDepthStencilValue value{};
    std::span<const VkImageSubresourceRange> ranges;
};
struct FillBuffer {
    const Buffer* buffer = nullptr;
    VkDeviceSize offset = 0, size = 0;  // VK_WHOLE_SIZE allowed
    uint32_t value = 0;
};
struct UpdateBuffer {
    const Buffer* buffer = nullptr;
    VkDeviceSize offset = 0;
    std::span<const std::byte> bytes;
};
struct ExecuteCommands {
    std::span<const CommandBuffer* const> buffers;
};
struct SetEvent {
    std::atomic<bool>* event = nullptr;
    bool value = true;
};
struct WaitEvent {
    const std::atomic<bool>* event = nullptr;
};
struct BeginQuery {
    QueryPool* pool = nullptr;
    uint32_t query = 0;
    uint32_t stream = 0;  // of vertices, below ir::kVertexStreams
};
struct EndQuery {
    QueryPool* pool = nullptr;
    uint32_t query = 0;
};
struct WriteTimestamp {
    QueryPool* pool = nullptr;
    uint32_t query = 0;
};
struct ResetQueries {
    QueryPool* pool = nullptr;
    uint32_t first = 0, count = 0;
};
struct CopyQueryResults {
    QueryPool* pool = nullptr;
    uint32_t first = 0, count = 0;
    const Buffer* buffer = nullptr;
    VkDeviceSize offset = 0, stride = 0;
    VkQueryResultFlags flags = 0;
};

}  // namespace command

enum class CommandType : uint8_t {
#define VERNIER_COMMAND(name) name,
#include "runtime/command/commands.def"
#undef VERNIER_COMMAND
};

}  // namespace vernier
