#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

namespace vernier::conformance {
namespace {

template <class T>
uint32_t append(std::vector<T>& list, T element) {
    list.push_back(std::move(element));
    return static_cast<uint32_t>(list.size() - 1);
}

const char* endingOf(VkShaderStageFlagBits stage) {
    switch (stage) {
        case VK_SHADER_STAGE_VERTEX_BIT:
            return ".vert";
        case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
            return ".tesc";
        case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
            return ".tese";
        case VK_SHADER_STAGE_GEOMETRY_BIT:
            return ".geom";
        default:
            return ".frag";
    }
}

Result<std::vector<uint32_t>> compile(VkShaderStageFlagBits stage, const std::string& glsl, VnGlslTarget target,
                                      const std::string& name) {
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = glsl.c_str();
    desc.sourceLength = glsl.size();
    desc.sourceName = name.c_str();
    desc.target = target;
    VnGlslOutput* raw = nullptr;
    const VnGlslResult result = vnCompileGlsl(&desc, &raw);
    const std::unique_ptr<VnGlslOutput, decltype(&vnFreeGlslOutput)> output(raw, &vnFreeGlslOutput);
    if (result == VN_GLSL_SUCCESS) return std::vector<uint32_t>(output->words, output->words + output->wordCount);
    return invalidArgument(name + " does not compile:\n" + (output ? output->log : "out of memory"));
}

/// Remembers what was compiled: hundreds of small scenes share a few shaders, and compiling takes longer than drawing.
Result<std::vector<uint32_t>> compileOnce(VkShaderStageFlagBits stage, const std::string& glsl, VnGlslTarget target,
                                          const std::string& name) {
    static std::mutex mutex;
    static std::map<std::tuple<VkShaderStageFlagBits, VnGlslTarget, std::string>, std::vector<uint32_t>> known;
    const std::lock_guard lock(mutex);
    const auto found = known.find({stage, target, glsl});
    if (found != known.end()) return found->second;
    Result<std::vector<uint32_t>> compiled = compile(stage, glsl, target, name);
    if (compiled) known.emplace(std::tuple(stage, target, glsl), *compiled);
    return compiled;
}

}  // namespace

PassRecorder& PassRecorder::color(uint32_t image, const std::array<float, 4>& clear, uint32_t resolveImage) {
    SceneAttachment attachment;
    attachment.image = image;
    std::copy(clear.begin(), clear.end(), attachment.clear.color.float32);
    attachment.resolveImage = resolveImage;
    pass().colors.push_back(attachment);
    return *this;
}

PassRecorder& PassRecorder::loadColor(uint32_t image) {
    SceneAttachment attachment;
    attachment.image = image;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    pass().colors.push_back(attachment);
    return *this;
}

PassRecorder& PassRecorder::depthStencil(uint32_t image, float depth, uint32_t stencil) {
    pass().depthStencil.image = image;
    pass().depthStencil.clear.depthStencil = {depth, stencil};
    return *this;
}

PassRecorder& PassRecorder::loadDepthStencil(uint32_t image) {
    pass().depthStencil.image = image;
    pass().depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    return *this;
}

PassRecorder& PassRecorder::resolveDepthStencil(uint32_t image, VkResolveModeFlagBits depth,
                                                VkResolveModeFlagBits stencil) {
    pass().depthStencil.resolveImage = image;
    pass().depthStencil.depthResolve = depth;
    pass().depthStencil.stencilResolve = stencil;
    return *this;
}

PassRecorder& PassRecorder::layer(uint32_t layer) {
    for (SceneAttachment& color : pass().colors) color.layer = layer;
    pass().depthStencil.layer = layer;
    return *this;
}

PassRecorder& PassRecorder::layers(uint32_t count) {
    for (SceneAttachment& color : pass().colors) color.layerCount = count;
    pass().depthStencil.layerCount = count;
    return *this;
}

PassRecorder& PassRecorder::views(uint32_t mask) {
    pass().viewMask = mask;
    return layers(static_cast<uint32_t>(std::bit_width(mask)));
}

DrawRecorder& DrawRecorder::vertices(uint32_t buffer, uint32_t binding) {
    draw_->vertexBuffers.push_back({binding, buffer, 0});
    return *this;
}

DrawRecorder& DrawRecorder::indices(uint32_t buffer, VkIndexType type) {
    draw_->indexBuffer = buffer;
    draw_->indexType = type;
    return *this;
}

DrawRecorder& DrawRecorder::first(uint32_t first, int32_t vertexOffset) {
    draw_->first = first;
    draw_->vertexOffset = vertexOffset;
    return *this;
}

DrawRecorder& DrawRecorder::instances(uint32_t count, uint32_t firstInstance) {
    draw_->instances = count;
    draw_->firstInstance = firstInstance;
    return *this;
}

DrawRecorder& DrawRecorder::uniform(uint32_t binding, uint32_t buffer) {
    SceneBinding entry;
    entry.binding = binding;
    entry.buffer = buffer;
    draw_->bindings.push_back(entry);
    return *this;
}

DrawRecorder& DrawRecorder::texture(uint32_t binding, uint32_t image, uint32_t sampler) {
    SceneBinding entry;
    entry.binding = binding;
    entry.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    entry.image = image;
    entry.sampler = sampler;
    draw_->bindings.push_back(entry);
    return *this;
}

DrawRecorder& DrawRecorder::storageBuffer(uint32_t binding, uint32_t buffer) {
    uniform(binding, buffer);
    draw_->bindings.back().type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    return *this;
}

DrawRecorder& DrawRecorder::storageImage(uint32_t binding, uint32_t image) {
    SceneBinding entry;
    entry.binding = binding;
    entry.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    entry.image = image;
    draw_->bindings.push_back(entry);
    return *this;
}

DrawRecorder& DrawRecorder::texelBuffer(uint32_t binding, uint32_t buffer, VkFormat format, VkDescriptorType type) {
    uniform(binding, buffer);
    draw_->bindings.back().type = type;
    draw_->bindings.back().texelFormat = format;
    return *this;
}

DrawRecorder& DrawRecorder::viewport(float x, float y, float width, float height, float minDepth, float maxDepth) {
    draw_->viewport = {x, y, width, height, minDepth, maxDepth};
    return *this;
}

DrawRecorder& DrawRecorder::scissor(int32_t x, int32_t y, uint32_t width, uint32_t height) {
    draw_->scissor = {{x, y}, {width, height}};
    return *this;
}

DrawRecorder& DrawRecorder::view(const SceneView& view) {
    draw_->moreViews.push_back(view);
    return *this;
}

SceneRecorder::SceneRecorder(std::string_view name, std::string_view description) {
    scene_.name = name;
    scene_.description = description;
}

uint32_t SceneRecorder::addBuffer(std::string_view name, VkBufferUsageFlags usage, Bytes data) {
    return append(scene_.buffers, {std::string(name), usage, std::move(data)});
}

uint32_t SceneRecorder::addImage(SceneImage image) {
    return append(scene_.images, std::move(image));
}

uint32_t SceneRecorder::colorTarget(std::string_view name, VkFormat format, VkExtent2D extent,
                                    VkSampleCountFlagBits samples, VkImageUsageFlags moreUsage) {
    SceneImage image;
    image.name = name;
    image.format = format;
    image.extent = extent;
    image.samples = samples;
    image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | moreUsage;
    return addImage(std::move(image));
}

uint32_t SceneRecorder::layeredTarget(std::string_view name, VkFormat format, VkExtent2D extent, uint32_t layers) {
    const uint32_t index = colorTarget(name, format, extent);
    scene_.images[index].arrayLayers = layers;
    return index;
}

uint32_t SceneRecorder::depthTarget(std::string_view name, VkFormat format, VkExtent2D extent,
                                    VkSampleCountFlagBits samples, VkImageUsageFlags moreUsage) {
    SceneImage image;
    image.name = name;
    image.format = format;
    image.extent = extent;
    image.samples = samples;
    image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | moreUsage;
    return addImage(std::move(image));
}

uint32_t SceneRecorder::storageImage(std::string_view name, VkFormat format, VkExtent2D extent, Bytes data) {
    SceneImage image;
    image.name = name;
    image.format = format;
    image.extent = extent;
    image.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    if (!data.empty()) image.data.push_back(std::move(data));
    return addImage(std::move(image));
}

uint32_t SceneRecorder::texture(std::string_view name, VkFormat format, VkExtent2D extent, std::vector<Bytes> levels) {
    SceneImage image;
    image.name = name;
    image.format = format;
    image.extent = extent;
    image.mipLevels = static_cast<uint32_t>(levels.size());
    image.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    image.data = std::move(levels);
    return addImage(std::move(image));
}

uint32_t SceneRecorder::texture(SceneImage image) {
    image.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    return addImage(std::move(image));
}

uint32_t SceneRecorder::mipmappedTexture(std::string_view name, VkFormat format, VkExtent2D extent, Bytes level0) {
    SceneImage image;
    image.name = name;
    image.format = format;
    image.extent = extent;
    image.mipLevels = static_cast<uint32_t>(std::bit_width(std::max(extent.width, extent.height)));
    image.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    image.data.resize(image.mipLevels);
    image.data[0] = std::move(level0);
    const uint32_t index = addImage(std::move(image));
    scene_.steps.push_back(SceneGenerateMips{index});
    return index;
}

uint32_t SceneRecorder::sampler(const SceneSampler& sampler) {
    return append(scene_.samplers, sampler);
}

uint32_t SceneRecorder::sampler(VkFilter filter, VkSamplerAddressMode address) {
    SceneSampler state;
    state.magFilter = state.minFilter = filter;
    state.addressModeU = state.addressModeV = address;
    state.maxLod = 0;
    return sampler(state);
}

uint32_t SceneRecorder::shader(VkShaderStageFlagBits stage, std::string_view glsl, VnGlslTarget target) {
    SceneShader shader;
    shader.stage = stage;
    shader.glsl = glsl;
    const std::string name = scene_.name + "/shader" + std::to_string(scene_.shaders.size()) + endingOf(stage);
    Result<std::vector<uint32_t>> compiled = compileOnce(stage, shader.glsl, target, name);
    if (compiled) {
        shader.spirv = std::move(compiled).value();
    } else if (status_.ok()) {
        status_ = compiled.error();
    }
    return append(scene_.shaders, std::move(shader));
}

void SceneRecorder::specialize(uint32_t shader, uint32_t id, uint32_t value) {
    SceneShader& target = scene_.shaders[shader];
    const auto bytes = bytesOf(std::span<const uint32_t>(&value, 1));
    target.specialization.push_back({id, static_cast<uint32_t>(target.specializationData.size()), bytes.size()});
    target.specializationData.insert(target.specializationData.end(), bytes.begin(), bytes.end());
}

PipelineRecorder SceneRecorder::pipeline(uint32_t vertexShader, uint32_t fragmentShader) {
    ScenePipeline pipeline;
    pipeline.vertexShader = vertexShader;
    pipeline.fragmentShader = fragmentShader;
    return PipelineRecorder(scene_, append(scene_.pipelines, std::move(pipeline)))
        .targets(fragmentShader == kNone ? 0 : 1);
}

PassRecorder SceneRecorder::pass(VkExtent2D extent) {
    ScenePass pass;
    pass.extent = extent;
    scene_.steps.push_back(std::move(pass));
    return PassRecorder(scene_);
}

DrawRecorder SceneRecorder::draw(uint32_t pipeline, uint32_t count) {
    ScenePass& pass = std::get<ScenePass>(scene_.steps.back());
    SceneDraw draw;
    draw.pipeline = pipeline;
    draw.count = count;
    draw.viewport = {0, 0, static_cast<float>(pass.extent.width), static_cast<float>(pass.extent.height), 0, 1};
    draw.scissor = {{0, 0}, pass.extent};
    pass.draws.push_back(std::move(draw));
    return DrawRecorder(pass.draws.back());
}

void SceneRecorder::output(uint32_t image) {
    scene_.outputs.push_back(image);
}

Result<Scene> SceneRecorder::finish() {
    if (!status_.ok()) return status_.error();
    return std::move(scene_);
}

}  // namespace vernier::conformance
