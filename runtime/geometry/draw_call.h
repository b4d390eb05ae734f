// One draw as it is handed to the backend.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/limits.h"
#include "runtime/plan/pipeline.h"
#include "spirv_interp/resources.h"

namespace vernier {

struct VertexStream {
    const std::byte* data = nullptr;
    VkDeviceSize size = 0;  // bytes from `data`; fetches outside give 0 (robustBufferAccess)
};

struct IndexStream {
    const std::byte* data = nullptr;  // nullptr: a non-indexed draw
    VkDeviceSize size = 0;
    VkIndexType type = VK_INDEX_TYPE_UINT16;
};

/// Where transform feedback goes on behind stages that make as many primitives as they like. Moves on in the order of
/// the primitives, when they are known.
struct RunningCapture {
    struct Buffer {
        std::byte* data = nullptr;
        uint64_t size = 0, offset = 0;  // bytes
        /// How many vertices fit, and can be counted in 32 bits, `offset` among them. The last one need not have room
        /// for all of its stride.
        uint64_t room(uint32_t extent, uint32_t stride) const;
    };
    std::array<Buffer, kCaptureBuffers> buffers{};
};

/// Where transform feedback puts the vertices of a draw.
struct CaptureTarget {
    std::array<std::byte*, kCaptureBuffers> data{};  // of the first vertex; by CapturePlan::strides from there
    uint64_t primitives = 0;                         // that have room in every buffer: the others are dropped
    RunningCapture* running = nullptr;               // of a draw with stages behind its vertices, instead of these
};

/// The bindings of the stages between vertices and the rasteriser.
struct StageResources {
    ResourceBindings control, evaluation, geometry;
    ResourceBindings& of(ir::Stage stage) {
        return stage == ir::Stage::control ? control : stage == ir::Stage::evaluation ? evaluation : geometry;
    }
};

/// One draw. What it points to must stay alive until the pass ends.
struct DrawCall {
    const GraphicsPipeline* pipeline = nullptr;
    const DynamicState* dynamic = nullptr;
    std::array<VertexStream, kMaxVertexBindings> vertexStreams{};
    IndexStream indices;
    ResourceBindings vertexResources, fragmentResources;
    const StageResources* stageResources = nullptr;  // nullptr: they need none
    const CaptureTarget* capture = nullptr;          // nullptr: nothing is captured
    bool needsLevels = true;  // what fragments sample depends on levels of detail (resource/texture_unit.h)
    uint32_t count = 0;       // vertices or indices
    uint32_t instances = 1;
    uint32_t first = 0;        // first vertex or index
    int32_t vertexOffset = 0;  // added to each index
    uint32_t firstInstance = 0;
    uint32_t drawIndex = 0;  // of an indirect draw
};

}  // namespace vernier
