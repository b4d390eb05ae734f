// The states of a pipeline that is recorded.
#include "conformance/scenes/recorder.h"

namespace vernier::conformance {
namespace {

constexpr VkColorComponentFlags kAllComponents =
    VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;

VkPipelineColorBlendAttachmentState unblended() {
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask = kAllComponents;
    return state;
}

}  // namespace

PipelineRecorder& PipelineRecorder::binding(uint32_t stride, VkVertexInputRate rate) {
    const uint32_t number = static_cast<uint32_t>(state().vertexBindings.size());
    state().vertexBindings.push_back({number, stride, rate});
    return *this;
}

PipelineRecorder& PipelineRecorder::attribute(VkFormat format, uint32_t offset) {
    const uint32_t location = static_cast<uint32_t>(state().vertexAttributes.size());
    state().vertexAttributes.push_back({location, state().vertexBindings.back().binding, format, offset});
    return *this;
}

PipelineRecorder& PipelineRecorder::topology(VkPrimitiveTopology topology, bool primitiveRestart) {
    state().topology = topology;
    state().primitiveRestart = primitiveRestart;
    return *this;
}

PipelineRecorder& PipelineRecorder::cull(VkCullModeFlags mode, VkFrontFace frontFace) {
    state().cullMode = mode;
    state().frontFace = frontFace;
    return *this;
}

PipelineRecorder& PipelineRecorder::depth(VkCompareOp compare, bool write) {
    state().depthTest = true;
    state().depthWrite = write;
    state().depthCompare = compare;
    return *this;
}

PipelineRecorder& PipelineRecorder::polygonMode(VkPolygonMode mode) {
    state().polygonMode = mode;
    return *this;
}

PipelineRecorder& PipelineRecorder::lineWidth(float width) {
    state().lineWidth = width;
    return *this;
}

PipelineRecorder& PipelineRecorder::lineMode(VkLineRasterizationModeEXT mode) {
    state().lineMode = mode;
    return *this;
}

PipelineRecorder& PipelineRecorder::stipple(uint32_t factor, uint16_t pattern) {
    state().stippleFactor = factor;
    state().stipplePattern = pattern;
    return *this;
}

PipelineRecorder& PipelineRecorder::geometry(uint32_t shader) {
    state().geometryShader = shader;
    return *this;
}

PipelineRecorder& PipelineRecorder::patches(uint32_t vertices, uint32_t control, uint32_t evaluation) {
    state().topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
    state().patchVertices = vertices;
    state().controlShader = control;
    state().evaluationShader = evaluation;
    return *this;
}

PipelineRecorder& PipelineRecorder::domainLowerLeft() {
    state().domainLowerLeft = true;
    return *this;
}

PipelineRecorder& PipelineRecorder::provokingVertexLast() {
    state().provokingVertexLast = true;
    return *this;
}

PipelineRecorder& PipelineRecorder::depthNegativeOneToOne() {
    state().depthNegativeOneToOne = true;
    return *this;
}

PipelineRecorder& PipelineRecorder::depthClamp() {
    state().depthClamp = true;
    return *this;
}

PipelineRecorder& PipelineRecorder::depthClip(bool clip) {
    state().depthClip = clip;
    return *this;
}

PipelineRecorder& PipelineRecorder::depthBounds(float min, float max) {
    state().depthBoundsTest = true;
    state().minDepthBounds = min;
    state().maxDepthBounds = max;
    return *this;
}

PipelineRecorder& PipelineRecorder::depthBias(float constant, float slope, float clamp) {
    state().depthBias = true;
    state().depthBiasConstant = constant;
    state().depthBiasSlope = slope;
    state().depthBiasClamp = clamp;
    return *this;
}

PipelineRecorder& PipelineRecorder::stencil(const VkStencilOpState& front, const VkStencilOpState& back) {
    state().stencilTest = true;
    state().front = front;
    state().back = back;
    return *this;
}

PipelineRecorder& PipelineRecorder::samples(VkSampleCountFlagBits samples) {
    state().samples = samples;
    return *this;
}

PipelineRecorder& PipelineRecorder::sampleMask(uint32_t mask) {
    state().sampleMask = mask;
    return *this;
}

PipelineRecorder& PipelineRecorder::sampleLocations(std::vector<std::array<uint8_t, 2>> locations) {
    state().sampleLocations = std::move(locations);
    return *this;
}

PipelineRecorder& PipelineRecorder::sampleShading(float least) {
    state().sampleShading = true;
    state().minSampleShading = least;
    return *this;
}

PipelineRecorder& PipelineRecorder::alphaToCoverage() {
    state().alphaToCoverage = true;
    return *this;
}

PipelineRecorder& PipelineRecorder::alphaToOne() {
    state().alphaToOne = true;
    return *this;
}

PipelineRecorder& PipelineRecorder::targets(uint32_t count) {
    state().blend.assign(count, unblended());
    return *this;
}

PipelineRecorder& PipelineRecorder::blend(const VkPipelineColorBlendAttachmentState& blend, uint32_t target) {
    state().blend[target] = blend;
    return *this;
}

PipelineRecorder& PipelineRecorder::blendConstants(const std::array<float, 4>& constants) {
    state().blendConstants = constants;
    return *this;
}

PipelineRecorder& PipelineRecorder::logicOp(VkLogicOp op) {
    state().logicOpEnable = true;
    state().logicOp = op;
    return *this;
}

PipelineRecorder& PipelineRecorder::writeMask(VkColorComponentFlags mask, uint32_t target) {
    state().blend[target].colorWriteMask = mask;
    return *this;
}

PipelineRecorder& PipelineRecorder::pushConstants(uint32_t bytes) {
    state().pushConstantBytes = bytes;
    return *this;
}

}  // namespace vernier::conformance
