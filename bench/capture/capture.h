// Remembers what a program tells vernier.h, and makes one of its frames a conformance scene, which other drivers can
// draw.
#pragma once

#include <vernier/vernier.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "conformance/scene/scene.h"

namespace vernier::bench {

/// One program, one device, one context, one thread. What a scene cannot say (dispatches, clears inside a
/// pass, reading in the middle of a frame, ...) is remembered as the reason why there is none.
class Capture {
  public:
    // As the objects are made.
    void image(VnImage image, const VnImageDesc& desc) { images_[image.id] = desc; }
    void view(VnView view, const VnViewDesc& desc) { views_[view.id] = desc; }
    void buffer(VnBuffer buffer, const VnBufferDesc& desc) { buffers_[buffer.id] = desc.size; }
    void sampler(VnSampler sampler, const VnSamplerDesc& desc) { samplers_[sampler.id] = desc; }
    void shader(VnShader shader, const VnShaderDesc& desc);
    void program(VnProgram program, const VnProgramDesc& desc) { programs_[program.id] = desc; }
    void layout(VnVertexLayout layout, const VnVertexLayoutDesc& desc);
    void raster(VnRasterState state, const VnRasterStateDesc& desc) { rasters_[state.id] = desc; }
    void depthStencil(VnDepthStencilState state, const VnDepthStencilStateDesc& desc) { depths_[state.id] = desc; }
    void blend(VnBlendState state, const VnBlendStateDesc& desc) { blends_[state.id] = desc; }

    // What is bound and set.
    struct State {
        VnProgram program{};
        VnVertexLayout layout{};
        VnRasterState raster{};
        VnDepthStencilState depthStencil{};
        VnBlendState blend{};
        std::map<uint32_t, std::pair<VnBuffer, uint64_t>> vertexBuffers;
        VnBuffer indices{};
        uint64_t indexOffset = 0;
        VkIndexType indexType = VK_INDEX_TYPE_UINT16;
        struct Bound {
            VnView view{};
            VnSampler sampler{};
            VnBuffer buffer{};
            uint64_t offset = 0, size = 0;
        };
        std::map<std::pair<uint32_t, uint32_t>, Bound> bindings;  // by set and binding
        conformance::Bytes push;
        VkViewport viewport{};
        VkRect2D scissor{};
        VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        bool restart = false;
        uint32_t patchVertices = 3;
    };
    State bound;

    // The frame.
    void beginPass(const VnPassDesc& desc);
    void endPass();
    void draw(uint32_t count, uint32_t instances, uint32_t first, int32_t vertexOffset, uint32_t firstInstance,
              bool indexed);
    void generateMips(VnImage image);
    void copyImage(VnImage from, const VnRegion* fromRegion, VnImage to, const VnRegion* toRegion);
    void blitImage(VnImage from, const VnRegion* fromRegion, VnImage to, const VnRegion* toRegion, VkFilter filter);
    void updateBuffer(VnBuffer buffer);
    void cannot(const std::string& reason) {
        if (reason_.empty()) reason_ = reason;
    }

    /// Forgets the frame, not the objects.
    void startFrame();
    /// The frame so far, with `shown` as its picture; contents of what it reads are taken from `context`. "" and the
    /// scene, or why there is none.
    std::string finish(VnContext context, VnImage shown, conformance::Scene& scene);

  private:
    struct Shader {
        VkShaderStageFlagBits stage;
        std::vector<uint32_t> words;
        std::vector<VnSpecialization> constants;
        /// By set and binding: whether it is a storage buffer.
        std::map<std::pair<uint32_t, uint32_t>, bool> bindings;
    };
    struct Layout {
        std::vector<VnVertexAttribute> attributes;
        std::vector<VnVertexBinding> bindings;
    };

    uint32_t sceneImage(VnImage image, VkImageUsageFlags usage);
    uint32_t sceneBuffer(VnBuffer buffer, VkBufferUsageFlags usage);
    uint32_t sceneSampler(VnSampler sampler);
    uint32_t sceneShader(VnShader shader);
    conformance::SceneAttachment attachmentOf(const VnAttachment& from);
    conformance::ScenePipeline pipelineOf();
    void bindResources(conformance::SceneDraw& draw, const VnProgramDesc& program);
    void readContents(VnContext context, conformance::Scene& scene);
    VkExtent2D sizeOf(VnImage image, uint32_t mip) const;

    std::map<uint64_t, VnImageDesc> images_;
    std::map<uint64_t, VnViewDesc> views_;
    std::map<uint64_t, uint64_t> buffers_;
    std::map<uint64_t, VnSamplerDesc> samplers_;
    std::map<uint64_t, Shader> shaders_;
    std::map<uint64_t, VnProgramDesc> programs_;
    std::map<uint64_t, Layout> layouts_;
    std::map<uint64_t, VnRasterStateDesc> rasters_;
    std::map<uint64_t, VnDepthStencilStateDesc> depths_;
    std::map<uint64_t, VnBlendStateDesc> blends_;

    conformance::Scene scene_;
    std::map<uint64_t, uint32_t> imageIndex_, bufferIndex_, samplerIndex_, shaderIndex_;
    std::set<uint64_t> written_, updated_;  // images the frame draws to; buffers it has changed
    std::optional<conformance::ScenePass> pass_;
    std::string reason_;
};

}  // namespace vernier::bench
