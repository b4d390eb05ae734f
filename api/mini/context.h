// The context of vernier.h: what is bound, what is being recorded, what is still running.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "api/mini/objects.h"
#include "runtime/raster/render_pass.h"

namespace vernier::mini {

/// The axes of `profile` (VN_PROFILE_DEFAULT: `whenDefault`), changed as `axes` says ("axis=position ..."; may be
/// null).
Result<Accuracy> accuracyFrom(VnProfile profile, const char* axes, const Accuracy& whenDefault);

/// Copies a text for the user, zero-terminated and cut to `capacity`; returns its full length.
size_t copyText(const std::string& source, char* text, size_t capacity);

/// Commands and everything they use.
struct Recording {
    CommandBuffer commands;
    std::vector<std::shared_ptr<const void>> alive;

    template <class T>
    const T& keep(const std::shared_ptr<T>& object) {
        alive.push_back(object);
        return *object;
    }
};

/// One element of what vnBindBuffer, vnBindTexture and vnBindTexelBuffer bind.
struct BoundResource {
    std::shared_ptr<BufferObject> buffer;  // also of a texel buffer
    uint64_t offset = 0, size = 0;
    std::shared_ptr<BufferView> texels;
    std::shared_ptr<ViewObject> view;
    std::shared_ptr<SamplerObject> sampler;
};

/// A descriptor set made for one draw and the layout it needs.
struct SnapshotSet {
    DescriptorSetLayout layout;
    DescriptorSet set;
    explicit SnapshotSet(DescriptorSetLayout made) : layout(std::move(made)), set(layout) {}
};

}  // namespace vernier::mini

struct VnContext_T {
    explicit VnContext_T(VnDevice owner) : device(owner) {
        startRecording(std::make_shared<vernier::mini::Recording>());
    }

    /// A new recording knows nothing of what was bound before.
    void startRecording(std::shared_ptr<vernier::mini::Recording> empty) {
        recording = std::move(empty);
        pipelineChanged = dynamicChanged = resourcesChanged = indexBufferChanged = pushConstantsChanged = true;
        computeProgramChanged = computeResourcesChanged = computePushConstantsChanged = true;
        vertexBuffersChanged = ~0u;
    }
    /// Hands the recording to the queue. Throws std::bad_alloc, and then nothing was handed over.
    void submit();
    void waitIdle() const { done.wait(submitted); }

    VnDevice device;
    std::shared_ptr<vernier::mini::Recording> recording;
    vernier::Timeline done;  // counts finished submissions
    uint64_t submitted = 0;

    // The pass being recorded.
    bool inPass = false;
    VkRect2D renderArea{};
    struct ActiveQuery {
        std::shared_ptr<vernier::mini::QueryObject> query;
        bool inPass;
    };
    std::vector<ActiveQuery> queries;
    vernier::mini::PipelineKey key;  // the attachments' part; the rest follows the bindings below

    // What is bound.
    std::shared_ptr<vernier::mini::ProgramObject> program;         // for draws
    std::shared_ptr<vernier::mini::ProgramObject> computeProgram;  // for dispatches
    std::shared_ptr<vernier::mini::VertexLayoutObject> vertexLayout;
    std::shared_ptr<vernier::mini::RasterStateObject> raster;
    std::shared_ptr<vernier::mini::DepthStencilStateObject> depthStencil;
    std::shared_ptr<vernier::mini::BlendStateObject> blend;
    std::map<std::pair<uint32_t, uint32_t>, std::vector<vernier::mini::BoundResource>> resources;  // by (set, binding)
    struct BoundRange {
        std::shared_ptr<vernier::mini::BufferObject> buffer;
        uint64_t offset = 0;
    };
    std::array<BoundRange, vernier::kMaxVertexBindings> vertexBuffers;
    BoundRange indexBuffer;
    VkIndexType indexType = VK_INDEX_TYPE_UINT16;
    std::array<std::byte, vernier::kMaxPushConstantBytes> pushConstants{};
    std::array<VkViewport, vernier::kMaxViewports> viewports{};
    std::array<VkRect2D, vernier::kMaxViewports> scissors{};
    std::array<float, 4> blendConstants{};
    uint32_t stencilFront = 0, stencilBack = 0;

    // What the recording has to be told before the next draw.
    std::shared_ptr<const vernier::GraphicsPipeline> pipeline;  // of the key as last planned
    bool pipelineChanged = true;                                // another combination of state objects
    bool dynamicChanged = true;
    bool resourcesChanged = true;
    bool indexBufferChanged = true;
    bool pushConstantsChanged = true;
    uint32_t vertexBuffersChanged = ~0u;  // a bit per binding
    // And before the next dispatch.
    bool computeProgramChanged = true;
    bool computeResourcesChanged = true;
    bool computePushConstantsChanged = true;

    // Written by the queue while passes run; read after waitIdle().
    vernier::PassStatistics statistics;
    uint64_t draws = 0, dispatches = 0, plans = 0;
};

namespace vernier::mini {

/// Finds or makes the plan for what is bound and records everything that changed since the last draw. `function` is for
/// messages.
VnResult prepareDraw(VnContext context, const char* function);

/// The plan alone: context->pipeline is set on success.
VnResult preparePipeline(VnContext context, const char* function);

/// Records descriptor sets with what is bound for the resources of the programs, of which some may be nullptr.
VnResult recordResources(VnContext context, const char* function, command::BindPoint bindPoint,
                         std::span<const ir::Program* const> programs);

/// The dynamic state of the next draw.
DynamicState dynamicStateOf(const VnContext_T& context);

}  // namespace vernier::mini
