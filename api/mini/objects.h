// What the handles of vernier.h stand for. Objects are shared: a recording keeps what it uses alive.
#pragma once

#include <vernier/vernier.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "api/mini/handle_table.h"
#include "runtime/command/device.h"
#include "runtime/command/query_pool.h"
#include "runtime/plan/compute_pipeline.h"
#include "runtime/plan/pipeline.h"
#include "runtime/resource/buffer_view.h"
#include "runtime/resource/descriptor.h"
#include "spirv_interp/tessellation.h"

namespace vernier::mini {

struct BufferObject {
    std::unique_ptr<Memory> memory;
    Buffer buffer;
};

struct ImageObject {
    std::unique_ptr<Memory> memory;
    Image image;
    bool cube = false;
    std::mutex defaultViewMutex;
    uint64_t defaultView = 0;  // handle, made on first use
};

struct ViewObject {
    std::shared_ptr<ImageObject> image;
    ImageView view;
};

struct SamplerObject {
    SamplerState state;
};

struct ShaderObject {
    ir::Program program;
    TessellationModes tessellation;  // of a control or evaluation stage
};

/// For draws or for dispatches: one of the two is set.
struct ProgramObject {
    std::shared_ptr<const ShaderProgram> program;
    std::shared_ptr<const ComputePipeline> compute;
};

struct VertexLayoutObject {
    std::vector<VkVertexInputAttributeDescription> attributes;
    std::vector<VkVertexInputBindingDescription> bindings;
};

struct RasterStateObject {
    VnRasterStateDesc desc{};
};

struct DepthStencilStateObject {
    VnDepthStencilStateDesc desc{};
};

struct BlendStateObject {
    VnBlendStateDesc desc{};
};

struct QueryObject {
    VnQueryType type;
    QueryPool pool;  // of one query
    explicit QueryObject(VnQueryType queryType);
};

/// The most that the text about memory that ran out takes; a device's error has room for it from the start.
inline constexpr size_t kOutOfMemoryLength = 64;

/// Everything a plan depends on. State objects are named by handle: they are immutable, and no handle is used twice.
struct PipelineKey {
    uint64_t program = 0, vertexLayout = 0, raster = 0, depthStencil = 0, blend = 0;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    uint32_t patchVertices = 3;
    bool primitiveRestart = false;
    uint32_t colorCount = 0;
    std::array<VkFormat, kMaxColorAttachments> colorFormats{};
    VkFormat depthStencilFormat = VK_FORMAT_UNDEFINED;
    uint32_t samples = 1;
    auto operator<=>(const PipelineKey&) const = default;
};

}  // namespace vernier::mini

/// The device of vernier.h. Its tables are thread-safe.
struct VnDevice_T {
    VnDevice_T(std::unique_ptr<vernier::Device> runtimeDevice, const VnDeviceDesc& desc);
    ~VnDevice_T();

    std::unique_ptr<vernier::Device> runtime;
    VnMessageCallback message;
    void* messageUser;

    std::mutex errorMutex;
    std::string error;

    uint16_t salt;
    vernier::mini::HandleTable<vernier::mini::BufferObject> buffers{salt};
    vernier::mini::HandleTable<vernier::mini::ImageObject> images{salt};
    vernier::mini::HandleTable<vernier::mini::ViewObject> views{salt};
    vernier::mini::HandleTable<vernier::mini::SamplerObject> samplers{salt};
    vernier::mini::HandleTable<vernier::mini::ShaderObject> shaders{salt};
    vernier::mini::HandleTable<vernier::mini::ProgramObject> programs{salt};
    vernier::mini::HandleTable<vernier::mini::VertexLayoutObject> vertexLayouts{salt};
    vernier::mini::HandleTable<vernier::mini::RasterStateObject> rasterStates{salt};
    vernier::mini::HandleTable<vernier::mini::DepthStencilStateObject> depthStencilStates{salt};
    vernier::mini::HandleTable<vernier::mini::BlendStateObject> blendStates{salt};
    vernier::mini::HandleTable<vernier::mini::QueryObject> queries{salt};

    std::mutex pipelineMutex;
    std::map<vernier::mini::PipelineKey, std::shared_ptr<const vernier::GraphicsPipeline>> pipelines;

    std::mutex contextMutex;
    std::vector<VnContext> contexts;
};
