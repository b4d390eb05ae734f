// Writes a Scene: a few words per resource and per draw, everything not said has the obvious default.
//
//     SceneRecorder record("solid", "One triangle.");
//     const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, {256, 256});
//     const uint32_t pipeline = record.pipeline(record.vertex(kVertexGlsl), record.fragment(kFragmentGlsl));
//     record.pass({256, 256}).color(target, {0, 0, 0, 1});
//     record.draw(pipeline, 3);
//     record.output(target);
//     return record.finish();
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <vernier/vernier_glsl.h>

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace vernier::conformance {

/// The bytes of a contiguous range of plain values.
template <class Range>
Bytes bytesOf(const Range& range) {
    using Value = std::remove_cvref_t<decltype(*std::data(range))>;
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto bytes = std::as_bytes(std::span<const Value>(std::data(range), std::size(range)));
    return Bytes(bytes.begin(), bytes.end());
}

/// Sets the state of the pipeline it stands for, and converts to the pipeline's index.
class PipelineRecorder {
  public:
    PipelineRecorder(Scene& scene, uint32_t index) : scene_(&scene), index_(index) {}
    operator uint32_t() const { return index_; }

    PipelineRecorder& binding(uint32_t stride, VkVertexInputRate rate = VK_VERTEX_INPUT_RATE_VERTEX);
    /// An attribute read from the binding added last; locations count up from 0.
    PipelineRecorder& attribute(VkFormat format, uint32_t offset);
    PipelineRecorder& topology(VkPrimitiveTopology topology, bool primitiveRestart = false);
    PipelineRecorder& cull(VkCullModeFlags mode, VkFrontFace frontFace);
    PipelineRecorder& depth(VkCompareOp compare, bool write = true);
    PipelineRecorder& polygonMode(VkPolygonMode mode);
    PipelineRecorder& lineWidth(float width);
    PipelineRecorder& lineMode(VkLineRasterizationModeEXT mode);
    PipelineRecorder& stipple(uint32_t factor, uint16_t pattern);
    PipelineRecorder& provokingVertexLast();
    PipelineRecorder& geometry(uint32_t shader);
    /// Patches of so many vertices, in the place of other primitives.
    PipelineRecorder& patches(uint32_t vertices, uint32_t control, uint32_t evaluation);
    PipelineRecorder& domainLowerLeft();
    /// Clip depths from -w to w.
    PipelineRecorder& depthNegativeOneToOne();
    PipelineRecorder& depthClamp();
    PipelineRecorder& depthClip(bool clip);
    PipelineRecorder& depthBounds(float min, float max);
    PipelineRecorder& depthBias(float constant, float slope, float clamp = 0);
    PipelineRecorder& stencil(const VkStencilOpState& front, const VkStencilOpState& back);
    PipelineRecorder& samples(VkSampleCountFlagBits samples);
    PipelineRecorder& sampleMask(uint32_t mask);
    PipelineRecorder& sampleLocations(std::vector<std::array<uint8_t, 2>> locations);
    PipelineRecorder& sampleShading(float least);
    PipelineRecorder& alphaToCoverage();
    PipelineRecorder& alphaToOne();
    /// The number of colour attachments (1 unless said); all unblended, all components written.
    PipelineRecorder& targets(uint32_t count);
    PipelineRecorder& blend(const VkPipelineColorBlendAttachmentState& state, uint32_t target = 0);
    PipelineRecorder& blendConstants(const std::array<float, 4>& constants);
    PipelineRecorder& logicOp(VkLogicOp op);
    PipelineRecorder& writeMask(VkColorComponentFlags mask, uint32_t target = 0);
    PipelineRecorder& pushConstants(uint32_t bytes);

  private:
    ScenePipeline& state() { return scene_->pipelines[index_]; }

    Scene* scene_;
    uint32_t index_;
};

/// Adds attachments to the pass recorded last.
class PassRecorder {
  public:
    explicit PassRecorder(Scene& scene) : scene_(&scene) {}

    PassRecorder& color(uint32_t image, const std::array<float, 4>& clear, uint32_t resolveImage = kNone);
    /// Keeps what an earlier step left in the image.
    PassRecorder& loadColor(uint32_t image);
    PassRecorder& depthStencil(uint32_t image, float depth = 1, uint32_t stencil = 0);
    /// Keeps what an earlier step left in the image.
    PassRecorder& loadDepthStencil(uint32_t image);
    PassRecorder& resolveDepthStencil(uint32_t image, VkResolveModeFlagBits depth, VkResolveModeFlagBits stencil);
    /// Draws to this layer of the attachments added before.
    PassRecorder& layer(uint32_t layer);
    /// Draws to so many layers of the attachments added before, which a shader chooses by Layer.
    PassRecorder& layers(uint32_t count);
    /// Draws everything to each of these layers of the attachments added before.
    PassRecorder& views(uint32_t mask);

  private:
    ScenePass& pass() { return std::get<ScenePass>(scene_->steps.back()); }

    Scene* scene_;
};

/// Adds to the draw recorded last.
class DrawRecorder {
  public:
    explicit DrawRecorder(SceneDraw& draw) : draw_(&draw) {}

    DrawRecorder& vertices(uint32_t buffer, uint32_t binding = 0);
    DrawRecorder& indices(uint32_t buffer, VkIndexType type);
    DrawRecorder& first(uint32_t first, int32_t vertexOffset = 0);
    DrawRecorder& instances(uint32_t count, uint32_t firstInstance = 0);
    DrawRecorder& uniform(uint32_t binding, uint32_t buffer);
    DrawRecorder& texture(uint32_t binding, uint32_t image, uint32_t sampler);
    DrawRecorder& storageBuffer(uint32_t binding, uint32_t buffer);
    DrawRecorder& storageImage(uint32_t binding, uint32_t image);
    DrawRecorder& texelBuffer(uint32_t binding, uint32_t buffer, VkFormat format, VkDescriptorType type);
    DrawRecorder& viewport(float x, float y, float width, float height, float minDepth = 0, float maxDepth = 1);
    DrawRecorder& scissor(int32_t x, int32_t y, uint32_t width, uint32_t height);
    /// A further viewport, with a scissor.
    DrawRecorder& view(const SceneView& view);

    template <class T>
    DrawRecorder& push(const T& value) {
        draw_->pushConstants = bytesOf(std::span<const T>(&value, 1));
        return *this;
    }

  private:
    SceneDraw* draw_;
};

class SceneRecorder {
  public:
    SceneRecorder(std::string_view name, std::string_view description);

    template <class Range>
    uint32_t buffer(std::string_view name, VkBufferUsageFlags usage, const Range& data) {
        return addBuffer(name, usage, bytesOf(data));
    }
    template <class Range>
    uint32_t vertexBuffer(std::string_view name, const Range& data) {
        return buffer(name, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, data);
    }
    template <class Range>
    uint32_t indexBuffer(std::string_view name, const Range& data) {
        return buffer(name, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, data);
    }
    template <class T>
    uint32_t uniformBuffer(std::string_view name, const T& value) {
        return buffer(name, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, std::span<const T>(&value, 1));
    }

    uint32_t colorTarget(std::string_view name, VkFormat format, VkExtent2D extent,
                         VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT, VkImageUsageFlags moreUsage = 0);
    uint32_t layeredTarget(std::string_view name, VkFormat format, VkExtent2D extent, uint32_t layers);
    uint32_t depthTarget(std::string_view name, VkFormat format, VkExtent2D extent,
                         VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT, VkImageUsageFlags moreUsage = 0);
    /// An image that shaders load from and store to, with or without contents.
    uint32_t storageImage(std::string_view name, VkFormat format, VkExtent2D extent, Bytes data);
    /// A sampled image; levels[0] has `extent`, each next one half of it.
    uint32_t texture(std::string_view name, VkFormat format, VkExtent2D extent, std::vector<Bytes> levels);
    /// A sampled image of any kind, as described; its usage is set here.
    uint32_t texture(SceneImage image);
    /// A sampled image with room for all mip levels, whose levels above 0 are generated now.
    uint32_t mipmappedTexture(std::string_view name, VkFormat format, VkExtent2D extent, Bytes level0);

    uint32_t sampler(const SceneSampler& sampler);
    uint32_t sampler(VkFilter filter, VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);

    /// Compile a stage; an error is kept for finish().
    uint32_t vertex(std::string_view glsl, VnGlslTarget target = VN_GLSL_TARGET_VULKAN_1_0) {
        return shader(VK_SHADER_STAGE_VERTEX_BIT, glsl, target);
    }
    uint32_t control(std::string_view glsl, VnGlslTarget target = VN_GLSL_TARGET_VULKAN_1_0) {
        return shader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, glsl, target);
    }
    uint32_t evaluation(std::string_view glsl, VnGlslTarget target = VN_GLSL_TARGET_VULKAN_1_0) {
        return shader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, glsl, target);
    }
    uint32_t geometry(std::string_view glsl, VnGlslTarget target = VN_GLSL_TARGET_VULKAN_1_0) {
        return shader(VK_SHADER_STAGE_GEOMETRY_BIT, glsl, target);
    }
    uint32_t fragment(std::string_view glsl, VnGlslTarget target = VN_GLSL_TARGET_VULKAN_1_0) {
        return shader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl, target);
    }
    /// The words of a shader, for what GLSL cannot say.
    std::vector<uint32_t>& spirv(uint32_t shader) { return scene_.shaders[shader].spirv; }
    /// Gives specialization constant `id` of a shader a 32-bit value.
    void specialize(uint32_t shader, uint32_t id, uint32_t value);

    PipelineRecorder pipeline(uint32_t vertexShader, uint32_t fragmentShader);

    PassRecorder pass(VkExtent2D extent);
    /// A draw in the last pass; viewport and scissor cover the pass.
    DrawRecorder draw(uint32_t pipeline, uint32_t count);
    void copy(const SceneCopyImage& copy) { scene_.steps.push_back(copy); }
    void blit(const SceneBlitImage& blit) { scene_.steps.push_back(blit); }

    void output(uint32_t image);
    /// Shaders or indices of the scene reach outside of buffers.
    void robustBufferAccess() { scene_.robustBufferAccess = true; }

    /// The scene, or the first error met while recording it.
    Result<Scene> finish();

  private:
    uint32_t addBuffer(std::string_view name, VkBufferUsageFlags usage, Bytes data);
    uint32_t addImage(SceneImage image);
    uint32_t shader(VkShaderStageFlagBits stage, std::string_view glsl, VnGlslTarget target);

    Scene scene_;
    Status status_;
};

}  // namespace vernier::conformance
