#include "bench/capture/capture.h"

#include <algorithm>
#include <cstring>

#include "conformance/scene/scene_format.h"

namespace vernier::bench {
namespace {

using namespace conformance;

/// Which bindings a module declares, by OpVariable, OpTypePointer and OpDecorate (SPIR-V specification, 2.3 and 3.42).
std::map<std::pair<uint32_t, uint32_t>, bool> bindingsOf(const std::vector<uint32_t>& words) {
    constexpr uint32_t kHeader = 5, kVariable = 59, kDecorate = 71, kBinding = 33, kSet = 34, kStorageBuffer = 12;
    std::map<uint32_t, std::pair<uint32_t, uint32_t>> places;
    std::map<uint32_t, bool> variables;
    for (size_t at = kHeader; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16) {
        const uint32_t operation = words[at] & 0xFFFF;
        if (operation == kDecorate && words[at + 2] == kBinding) places[words[at + 1]].second = words[at + 3];
        if (operation == kDecorate && words[at + 2] == kSet) places[words[at + 1]].first = words[at + 3];
        if (operation == kVariable) variables[words[at + 2]] = words[at + 3] == kStorageBuffer;
    }
    std::map<std::pair<uint32_t, uint32_t>, bool> bindings;
    for (const auto& [id, place] : places)
        if (const auto found = variables.find(id); found != variables.end()) bindings[place] = found->second;
    return bindings;
}

template <class T>
T orDefault(T value, T otherwise) {
    return value == T{} ? otherwise : value;
}

/// A region in Vulkan's terms.
struct Box {
    VkImageSubresourceLayers layers;
    VkOffset3D low, high;
};

Box boxOf(const VnRegion* region, VkExtent2D size) {
    const VnRegion all{}, &r = region ? *region : all;
    Box box{{VK_IMAGE_ASPECT_COLOR_BIT, r.mip, r.layer, 1},
            {static_cast<int32_t>(r.x), static_cast<int32_t>(r.y), 0},
            {static_cast<int32_t>(r.width ? r.x + r.width : size.width),
             static_cast<int32_t>(r.height ? r.y + r.height : size.height), 1}};
    if (r.mirror & 1) std::swap(box.low.x, box.high.x);
    if (r.mirror & 2) std::swap(box.low.y, box.high.y);
    return box;
}

}  // namespace

void Capture::shader(VnShader shader, const VnShaderDesc& desc) {
    Shader& made = shaders_[shader.id];
    made.stage = desc.stage;
    made.words.assign(desc.words, desc.words + desc.wordCount);
    if (desc.specializationCount)
        made.constants.assign(desc.specializations, desc.specializations + desc.specializationCount);
    made.bindings = bindingsOf(made.words);
}

void Capture::layout(VnVertexLayout layout, const VnVertexLayoutDesc& desc) {
    Layout& made = layouts_[layout.id];
    made.attributes.assign(desc.attributes, desc.attributes + desc.attributeCount);
    made.bindings.assign(desc.bindings, desc.bindings + desc.bindingCount);
}

void Capture::startFrame() {
    scene_ = {};
    imageIndex_.clear();
    bufferIndex_.clear();
    samplerIndex_.clear();
    shaderIndex_.clear();
    written_.clear();
    updated_.clear();
    pass_.reset();
    reason_.clear();
}

VkExtent2D Capture::sizeOf(VnImage image, uint32_t mip) const {
    const VnImageDesc& desc = images_.at(image.id);
    return {std::max(1u, desc.width >> mip), std::max(1u, desc.height >> mip)};
}

uint32_t Capture::sceneImage(VnImage image, VkImageUsageFlags usage) {
    const auto [found, isNew] = imageIndex_.try_emplace(image.id, static_cast<uint32_t>(scene_.images.size()));
    if (isNew) {
        const VnImageDesc& desc = images_.at(image.id);
        SceneImage made;
        made.name = "image " + std::to_string(found->second);
        made.format = orDefault(desc.format, VK_FORMAT_R8G8B8A8_UNORM);
        made.extent = {desc.width, std::max(1u, desc.height)};
        made.mipLevels = desc.mipLevels ? desc.mipLevels : 1;
        if (desc.mipLevels == VN_ALL_MIPS)
            for (made.mipLevels = 1; std::max(desc.width, desc.height) >> made.mipLevels; ++made.mipLevels) {
            }
        made.samples = static_cast<VkSampleCountFlagBits>(std::max(1u, desc.samples));
        if (desc.dimensions == 1 || desc.dimensions == 3 || desc.layers > 1 || desc.cube)
            cannot("images that are not plain 2D ones");
        scene_.images.push_back(made);
    }
    scene_.images[found->second].usage |= usage;
    return found->second;
}

uint32_t Capture::sceneBuffer(VnBuffer buffer, VkBufferUsageFlags usage) {
    const auto [found, isNew] = bufferIndex_.try_emplace(buffer.id, static_cast<uint32_t>(scene_.buffers.size()));
    if (isNew) scene_.buffers.push_back({"buffer " + std::to_string(found->second), 0, Bytes(buffers_.at(buffer.id))});
    scene_.buffers[found->second].usage |= usage;
    return found->second;
}

uint32_t Capture::sceneSampler(VnSampler sampler) {
    const auto [found, isNew] = samplerIndex_.try_emplace(sampler.id, static_cast<uint32_t>(scene_.samplers.size()));
    if (isNew) {
        const VnSamplerDesc& desc = samplers_.at(sampler.id);
        SceneSampler made;
        made.magFilter = desc.magFilter;
        made.minFilter = desc.minFilter;
        made.mipmapMode = desc.mipmapMode;
        made.addressModeU = desc.addressU;
        made.addressModeV = desc.addressV;
        made.addressModeW = desc.addressW;
        made.mipLodBias = desc.lodBias;
        made.minLod = desc.minLod;
        made.maxLod = desc.maxLod > 0 ? desc.maxLod : VK_LOD_CLAMP_NONE;
        made.maxAnisotropy = desc.maxAnisotropy;
        made.borderColor = desc.borderColor;
        made.compareEnable = desc.compareEnable != 0;
        made.compareOp = desc.compareOp;
        scene_.samplers.push_back(made);
    }
    return found->second;
}

uint32_t Capture::sceneShader(VnShader shader) {
    const auto [found, isNew] = shaderIndex_.try_emplace(shader.id, static_cast<uint32_t>(scene_.shaders.size()));
    if (isNew) {
        const Shader& from = shaders_.at(shader.id);
        SceneShader made;
        made.stage = from.stage;
        made.spirv = from.words;
        if (!from.constants.empty()) cannot("specialisation constants");
        scene_.shaders.push_back(made);
    }
    return found->second;
}

SceneAttachment Capture::attachmentOf(const VnAttachment& from) {
    SceneAttachment made;
    if (from.view.id == 0) return made;
    const VnViewDesc& view = views_.at(from.view.id);
    const VkFormat format = orDefault(images_.at(view.image.id).format, VK_FORMAT_R8G8B8A8_UNORM);
    if (view.format != VK_FORMAT_UNDEFINED && view.format != format) cannot("attachments in another format");
    if (from.resolve.id) cannot("resolving attachments");
    const bool depth = (sceneFormat(format)->aspects & VK_IMAGE_ASPECT_COLOR_BIT) == 0;
    made.image = sceneImage(view.image,
                            depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    made.mipLevel = view.baseMip;
    made.loadOp = from.loadOp;
    made.clear = from.clear;
    // What was there before the frame cannot be known.
    if (made.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD && !written_.count(view.image.id))
        cannot("pictures of frames before");
    written_.insert(view.image.id);
    return made;
}

void Capture::beginPass(const VnPassDesc& desc) {
    pass_.emplace();
    if (desc.viewMask || desc.renderArea.extent.width) cannot("passes over a part, or over views");
    for (const VnAttachment& color : desc.colors) {
        if (color.view.id == 0) break;
        pass_->colors.push_back(attachmentOf(color));
    }
    pass_->depthStencil = attachmentOf(desc.depthStencil);
    const VnView any = pass_->colors.empty() ? desc.depthStencil.view : desc.colors[0].view;
    const VnViewDesc& view = views_.at(any.id);
    pass_->extent = sizeOf(view.image, view.baseMip);
    bound.viewport = {0, 0, static_cast<float>(pass_->extent.width), static_cast<float>(pass_->extent.height), 0, 1};
    bound.scissor = {{0, 0}, pass_->extent};
}

void Capture::endPass() {
    if (!pass_) return;
    scene_.steps.emplace_back(std::move(*pass_));
    pass_.reset();
}

ScenePipeline Capture::pipelineOf() {
    ScenePipeline made;
    const VnProgramDesc& program = programs_.at(bound.program.id);
    made.vertexShader = sceneShader(program.vertex);
    if (program.control.id) made.controlShader = sceneShader(program.control);
    if (program.evaluation.id) made.evaluationShader = sceneShader(program.evaluation);
    made.patchVertices = bound.patchVertices;
    if (program.geometry.id) made.geometryShader = sceneShader(program.geometry);
    if (program.fragment.id) made.fragmentShader = sceneShader(program.fragment);
    const Layout& layout = layouts_[bound.layout.id];
    for (uint32_t i = 0; i < layout.bindings.size(); ++i)
        made.vertexBindings.push_back(
            {i, layout.bindings[i].stride,
             layout.bindings[i].perInstance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
    for (const VnVertexAttribute& a : layout.attributes)
        made.vertexAttributes.push_back({a.location, a.binding, a.format, a.offset});
    made.topology = bound.topology;
    made.primitiveRestart = bound.restart;
    const VnRasterStateDesc& raster = rasters_[bound.raster.id];
    made.polygonMode = raster.polygonMode;
    made.cullMode = raster.cullMode;
    made.frontFace = raster.frontFace;
    made.lineWidth = raster.lineWidth > 0 ? raster.lineWidth : 1;
    made.lineMode = raster.lineMode;
    made.provokingVertexLast = raster.provokingVertexLast != 0;
    made.depthNegativeOneToOne = raster.depthNegativeOneToOne != 0;
    made.domainLowerLeft = raster.domainLowerLeft != 0;
    made.depthClamp = raster.depthClamp != 0;
    made.depthBias = raster.depthBias != 0;
    made.depthBiasConstant = raster.depthBiasConstant;
    made.depthBiasSlope = raster.depthBiasSlope;
    made.depthBiasClamp = raster.depthBiasClamp;
    const VnDepthStencilStateDesc& depth = depths_[bound.depthStencil.id];
    made.depthTest = depth.depthTest != 0;
    made.depthWrite = depth.depthWrite != 0;
    made.depthCompare = depth.depthCompare == VN_COMPARE_OP_NEVER ? VK_COMPARE_OP_NEVER
                                                                  : orDefault(depth.depthCompare, VK_COMPARE_OP_LESS);
    if (depth.stencilTest) cannot("stencil tests");
    const VnBlendStateDesc& blend = blends_[bound.blend.id];
    if (blend.logicOpEnable) cannot("logic operations");
    for (size_t i = 0; i < pass_->colors.size(); ++i) {
        const VnBlendAttachment& from = blend.attachments[blend.independent ? i : 0];
        VkPipelineColorBlendAttachmentState to{from.enable != 0, from.srcColor,           from.dstColor,
                                               from.colorOp,     from.srcAlpha,           from.dstAlpha,
                                               from.alphaOp,     ~from.writeMaskOff & 0xF};
        const bool none = !from.srcColor && !from.dstColor && !from.srcAlpha && !from.dstAlpha;
        if (from.enable && none) {
            to.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
            to.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
            to.dstColorBlendFactor = to.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        }
        made.blend.push_back(to);
    }
    made.pushConstantBytes = static_cast<uint32_t>(bound.push.size());
    return made;
}

void Capture::bindResources(SceneDraw& draw, const VnProgramDesc& program) {
    std::map<std::pair<uint32_t, uint32_t>, bool> wanted = shaders_.at(program.vertex.id).bindings;
    for (const VnShader stage : {program.control, program.evaluation, program.geometry, program.fragment})
        if (stage.id)
            for (const auto& entry : shaders_.at(stage.id).bindings) wanted.insert(entry);
    for (const auto& entry : wanted) {
        const State::Bound& resource = bound.bindings[entry.first];
        SceneBinding made;
        made.set = entry.first.first;
        made.binding = entry.first.second;
        if (resource.view.id) {
            const VnViewDesc& view = views_.at(resource.view.id);
            const VkComponentMapping& s = view.swizzle;
            if (s.r || s.g || s.b || s.a || !resource.sampler.id)
                cannot("textures in another order, or without a sampler");
            made.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            made.image = sceneImage(view.image, VK_IMAGE_USAGE_SAMPLED_BIT);
            made.sampler = sceneSampler(resource.sampler);
        } else if (resource.buffer.id) {
            made.type = entry.second ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
            made.buffer = sceneBuffer(resource.buffer, entry.second ? VK_BUFFER_USAGE_STORAGE_BUFFER_BIT
                                                                    : VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
            made.offset = resource.offset;
            if (resource.size) made.range = resource.size;
        } else {
            cannot("bindings that nothing is bound to");
            continue;
        }
        draw.bindings.push_back(made);
    }
}

void Capture::draw(uint32_t count, uint32_t instances, uint32_t first, int32_t vertexOffset, uint32_t firstInstance,
                   bool indexed) {
    const auto found = programs_.find(bound.program.id);
    if (!pass_ || found == programs_.end()) return;
    SceneDraw made;
    made.pipeline = static_cast<uint32_t>(scene_.pipelines.size());
    scene_.pipelines.push_back(pipelineOf());
    bindResources(made, found->second);
    made.pushConstants = bound.push;
    for (uint32_t i = 0; i < layouts_[bound.layout.id].bindings.size(); ++i) {
        const auto& [buffer, offset] = bound.vertexBuffers[i];
        if (buffer.id)
            made.vertexBuffers.push_back({i, sceneBuffer(buffer, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT), offset});
    }
    if (indexed) {
        made.indexBuffer = sceneBuffer(bound.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
        made.indexOffset = bound.indexOffset;
        made.indexType = bound.indexType;
    }
    made.viewport = bound.viewport;
    made.scissor = bound.scissor;
    made.count = count;
    made.instances = instances;
    made.first = first;
    made.vertexOffset = vertexOffset;
    made.firstInstance = firstInstance;
    pass_->draws.push_back(std::move(made));
}

void Capture::generateMips(VnImage image) {
    scene_.steps.emplace_back(SceneGenerateMips{sceneImage(image, 0)});
    written_.insert(image.id);
}

void Capture::copyImage(VnImage from, const VnRegion* fromRegion, VnImage to, const VnRegion* toRegion) {
    const Box source = boxOf(fromRegion, sizeOf(from, 0)), target = boxOf(toRegion, sizeOf(to, 0));
    SceneCopyImage step{sceneImage(from, 0), sceneImage(to, 0), {}};
    step.region = {
        source.layers,
        source.low,
        target.layers,
        target.low,
        {static_cast<uint32_t>(source.high.x - source.low.x), static_cast<uint32_t>(source.high.y - source.low.y), 1}};
    scene_.steps.emplace_back(step);
    written_.insert(to.id);
}

void Capture::blitImage(VnImage from, const VnRegion* fromRegion, VnImage to, const VnRegion* toRegion,
                        VkFilter filter) {
    const Box source = boxOf(fromRegion, sizeOf(from, 0)), target = boxOf(toRegion, sizeOf(to, 0));
    SceneBlitImage step{sceneImage(from, 0), sceneImage(to, 0), {}, filter};
    step.region = {source.layers, {source.low, source.high}, target.layers, {target.low, target.high}};
    scene_.steps.emplace_back(step);
    written_.insert(to.id);
}

void Capture::updateBuffer(VnBuffer buffer) {
    // The scene has one content for all of the frame: that of its end.
    if (bufferIndex_.count(buffer.id) || !updated_.insert(buffer.id).second)
        cannot("buffers that change within a frame");
}

void Capture::readContents(VnContext context, Scene& scene) {
    for (const auto& entry : bufferIndex_) {
        Bytes& data = scene.buffers[entry.second].data;
        if (vnReadBuffer(context, VnBuffer{entry.first}, 0, data.data(), data.size()) != VN_SUCCESS)
            cannot("a buffer that cannot be read");
    }
    for (const auto& entry : imageIndex_) {
        if (written_.count(entry.first)) continue;
        SceneImage& image = scene.images[entry.second];
        image.data.resize(image.mipLevels);
        for (uint32_t mip = 0; mip < image.mipLevels; ++mip) {
            const VkExtent2D size = sizeOf(VnImage{entry.first}, mip);
            image.data[mip].resize(sceneFormat(image.format)->imageBytes(size.width, size.height));
            VnRegion region{};
            region.mip = mip;
            if (vnReadImage(context, VnImage{entry.first}, &region, image.data[mip].data(), image.data[mip].size()) !=
                VN_SUCCESS)
                cannot("an image that cannot be read");
        }
    }
}

std::string Capture::finish(VnContext context, VnImage shown, Scene& scene) {
    if (scene_.steps.empty()) cannot("nothing is drawn");
    if (!written_.count(shown.id)) cannot("the picture is not drawn by the frame");
    if (!reason_.empty()) return reason_;
    scene_.name = "captured";
    scene_.outputs = {sceneImage(shown, 0)};
    readContents(context, scene_);
    scene = scene_;
    return reason_;
}

}  // namespace vernier::bench
