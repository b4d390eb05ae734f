// What a render pass draws to.
#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "base/simd.h"
#include "runtime/attachment_ops.h"
#include "runtime/limits.h"
#include "spirv_interp/program.h"

namespace vernier {

/// One subresource that is drawn to. Rows and columns are padded to kAttachmentBlock texels in memory.
struct RenderTarget : AttachmentOps {
    VkFormat format = VK_FORMAT_UNDEFINED;  // VK_FORMAT_UNDEFINED: no attachment
    std::byte* data = nullptr;              // texel (0, 0) of sample 0 of layer 0
    uint32_t rowPitch = 0;                  // bytes
    VkDeviceSize samplePitch = 0;           // bytes
    VkDeviceSize layerPitch = 0;            // bytes
    VkExtent2D extent{};                    // of the mip level
    uint32_t samples = 1;
};

struct PassTargets {
    uint32_t colorCount = 0;
    std::array<RenderTarget, kMaxColorAttachments> colors{};
    std::array<RenderTarget, kMaxColorAttachments> resolves{};  // average resolve into these at the end
    RenderTarget depthStencil{};
    RenderTarget depthStencilResolve{};  // by the modes of its aspects
    VkResolveModeFlagBits depthResolveMode = VK_RESOLVE_MODE_NONE, stencilResolveMode = VK_RESOLVE_MODE_NONE;
    VkRect2D renderArea{};  // inside every target
    uint32_t layers = 1;
    uint32_t viewMask = 0;  // not 0: multiview, every draw goes once to each of these layers; `layers` does not count
    uint32_t samples = 1;   // of the pass; also when it has no attachments
    Isa isa = kLowestIsa;   // for resolves; draws have their pipeline's
};

/// What was run. Counted on all threads and summed; independent of the number of threads except where said.
struct PassStatistics {
    uint64_t inputVertices = 0;
    uint64_t inputPrimitives = 0;
    // By vertex stream: those before clipping; of them those while transform feedback was active; and that had room.
    std::array<uint64_t, ir::kVertexStreams> generatedPrimitives{}, capturablePrimitives{}, capturedPrimitives{};
    uint64_t vertexInvocations = 0;  // depends on the chunking, which does not depend on threads
    uint64_t controlPatches = 0, evaluationInvocations = 0;    // of tessellation stages
    uint64_t geometryInvocations = 0, geometryPrimitives = 0;  // of geometry programs; what they put out
    uint64_t clippingInvocations = 0;
    uint64_t clippingPrimitives = 0;   // not all outside; those to be culled are in it
    uint64_t clippedPrimitives = 0;    // primitives that really were cut
    uint64_t rasterPrimitives = 0;     // primitives that reached the rasteriser
    uint64_t fragmentInvocations = 0;  // helper lanes not counted
    uint64_t helperInvocations = 0;
    uint64_t computeInvocations = 0;  // of dispatches: 0 in a pass
    uint64_t batches = 0;             // fragment batches run
    uint64_t samplesPassed = 0;       // samples that passed all tests
    uint64_t perspectiveDivides = 0;  // pixels for which 1/w was divided
    uint64_t destinationReads = 0;    // pixels whose colour was read back for blending or masks
    uint64_t depthReads = 0;          // samples whose depth or stencil was read
    uint64_t coarseDepthRejects = 0;  // blocks
    uint64_t clearedPixels = 0;       // of all attachments, by load operations
    uint64_t vertexCycles = 0,
             rasterCycles = 0;  // time-stamp counter, all threads; for people, not for tests
};

/// Field by field: PassStatistics holds nothing but counters.
template <class Operation>
PassStatistics combine(const PassStatistics& a, const PassStatistics& b, Operation operation) {
    using Counters = std::array<uint64_t, sizeof(PassStatistics) / sizeof(uint64_t)>;
    Counters x = std::bit_cast<Counters>(a);
    const Counters y = std::bit_cast<Counters>(b);
    std::transform(x.begin(), x.end(), y.begin(), x.begin(), operation);
    return std::bit_cast<PassStatistics>(x);
}

}  // namespace vernier
