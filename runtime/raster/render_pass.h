// One render pass instance on the backend: targets are begun, draws are handed over in order, end() makes everything
// visible in the images. Geometry of draws is processed in chunks on all threads and binned into tiles; tiles are then
// rasterised, each by one thread at a time, with their primitives in submission order.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/thread_pool.h"
#include "runtime/limits.h"
#include "runtime/plan/pipeline.h"
#include "spirv_interp/resources.h"

namespace vernier {

/// One subresource that is drawn to. Rows and columns are padded to kAttachmentBlock texels in memory.
struct RenderTarget {
    VkFormat format = VK_FORMAT_UNDEFINED;  // VK_FORMAT_UNDEFINED: no attachment
    std::byte* data = nullptr;              // texel (0, 0) of sample 0 of layer 0
    uint32_t rowPitch = 0;                  // bytes
    VkDeviceSize samplePitch = 0;           // bytes
    VkDeviceSize layerPitch = 0;            // bytes
    VkExtent2D extent{};                    // of the mip level
    uint32_t samples = 1;
    VkAttachmentLoadOp loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkAttachmentStoreOp storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkAttachmentLoadOp stencilLoadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkAttachmentStoreOp stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkClearValue clear{};
};

struct PassTargets {
    uint32_t colorCount = 0;
    std::array<RenderTarget, kMaxColorAttachments> colors{};
    std::array<RenderTarget, kMaxColorAttachments> resolves{};  // average resolve into these at the end
    RenderTarget depthStencil{};
    VkRect2D renderArea{};  // inside every target
    uint32_t layers = 1;
    uint32_t samples = 1;   // of the pass; also when it has no attachments
};

struct VertexStream {
    const std::byte* data = nullptr;
    VkDeviceSize size = 0;  // bytes from `data`; fetches outside give 0 (robustBufferAccess)
};

struct IndexStream {
    const std::byte* data = nullptr;  // nullptr: a non-indexed draw
    VkDeviceSize size = 0;
    VkIndexType type = VK_INDEX_TYPE_UINT16;
};

/// One draw. What it points to must stay alive until the pass ends.
struct DrawCall {
    const GraphicsPipeline* pipeline = nullptr;
    const DynamicState* dynamic = nullptr;
    std::array<VertexStream, kMaxVertexBindings> vertexStreams{};
    IndexStream indices;
    ResourceBindings vertexResources, fragmentResources;
    uint32_t count = 0;          // vertices or indices
    uint32_t instances = 1;
    uint32_t first = 0;          // first vertex or index
    int32_t vertexOffset = 0;    // added to each index
    uint32_t firstInstance = 0;
    uint32_t drawIndex = 0;      // of an indirect draw
};

/// What was run. Counted on all threads and summed; independent of the number of threads except where said.
struct PassStatistics {
    uint64_t inputVertices = 0;
    uint64_t inputPrimitives = 0;
    uint64_t vertexInvocations = 0;       // depends on the chunking, which does not depend on threads
    uint64_t clippingInvocations = 0;
    uint64_t clippedPrimitives = 0;       // primitives that really were cut
    uint64_t rasterPrimitives = 0;        // primitives that reached the rasteriser
    uint64_t fragmentInvocations = 0;     // helper lanes not counted
    uint64_t helperInvocations = 0;
    uint64_t batches = 0;                 // fragment batches run
    uint64_t samplesPassed = 0;           // samples that passed all tests
    uint64_t perspectiveDivides = 0;      // pixels for which 1/w was divided
    uint64_t destinationReads = 0;        // pixels whose colour was read back for blending or masks
    uint64_t depthReads = 0;              // samples whose depth or stencil was read
    uint64_t coarseDepthRejects = 0;      // blocks
    uint64_t vertexCycles = 0, rasterCycles = 0;  // time-stamp counter, all threads; for people, not for tests
};

class RenderPass {
  public:
    explicit RenderPass(ThreadPool& pool);
    ~RenderPass();

    /// Starts a pass. A pass object is reused from pass to pass and keeps its memory.
    void begin(const PassTargets& targets);
    void draw(const DrawCall& call);
    /// vkCmdClearAttachments: `aspect` colour (attachment index `color`), depth and/or stencil inside `rect`.
    void clear(VkImageAspectFlags aspect, uint32_t color, const VkClearValue& value, const VkClearRect& rect);
    /// Finishes all draws so far, so that their results can be read from memory; the pass goes on.
    void flush();
    /// Runs what is left, resolves, and stores. Returns false when a shader ran out of its loop budget.
    bool end();

    /// Sums since begin(); complete after flush() or end().
    const PassStatistics& statistics() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vernier
