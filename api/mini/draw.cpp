// Draws: the plan for what is bound, the descriptor sets for what is bound, and the draw commands themselves.
#include <algorithm>

#include "api/mini/context_guard.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

VkCompareOp compareOf(VkCompareOp op, VkCompareOp whenDefault) {
    if (op == VN_COMPARE_OP_NEVER) return VK_COMPARE_OP_NEVER;
    return op == VK_COMPARE_OP_NEVER ? whenDefault : op;
}

VkStencilOpState stencilOf(const VnStencilFace& face) {
    VkStencilOpState state{};
    state.failOp = face.failOp;
    state.passOp = face.passOp;
    state.depthFailOp = face.depthFailOp;
    state.compareOp = compareOf(face.compareOp, VK_COMPARE_OP_ALWAYS);
    return state;
}

VkPipelineColorBlendAttachmentState blendOf(const VnBlendAttachment& from) {
    constexpr VkColorComponentFlags kAll = 0xF;
    VkPipelineColorBlendAttachmentState to{};
    to.blendEnable = from.enable != 0;
    to.srcColorBlendFactor = from.srcColor;
    to.dstColorBlendFactor = from.dstColor;
    to.srcAlphaBlendFactor = from.srcAlpha;
    to.dstAlphaBlendFactor = from.dstAlpha;
    if (!from.srcColor && !from.dstColor && !from.srcAlpha && !from.dstAlpha) {
        to.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
        to.dstColorBlendFactor = to.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        to.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    }
    to.colorBlendOp = from.colorOp;
    to.alphaBlendOp = from.alphaOp;
    to.colorWriteMask = kAll & ~from.writeMaskOff;
    return to;
}

/// The state of vernier.h in the runtime's terms.
GraphicsState graphicsStateOf(const VnContext_T& context) {
    GraphicsState state;
    if (context.vertexLayout) {
        state.vertexAttributes = context.vertexLayout->attributes;
        state.vertexBindings = context.vertexLayout->bindings;
    }
    state.topology = context.key.topology;
    state.patchControlPoints = context.key.patchVertices;
    state.primitiveRestart = context.key.primitiveRestart;
    const VnRasterStateDesc raster = context.raster ? context.raster->desc : VnRasterStateDesc{};
    state.polygonMode = raster.polygonMode;
    state.cullMode = raster.cullMode;
    state.frontFace = raster.frontFace;
    state.depthClampEnable = raster.depthClamp != 0;
    state.depthClipEnable = raster.depthClip == 0 ? !state.depthClampEnable : raster.depthClip > 0;
    state.depthBiasEnable = raster.depthBias != 0;
    state.provokingVertexLast = raster.provokingVertexLast != 0;
    state.samples = context.key.samples;
    state.sampleMask = ~raster.sampleMaskOff;
    state.alphaToCoverage = raster.alphaToCoverage != 0;
    state.alphaToOne = raster.alphaToOne != 0;
    state.sampleShading = raster.minSampleShading > 0;
    state.minSampleShading = raster.minSampleShading;
    state.negativeOneToOne = raster.depthNegativeOneToOne != 0;
    state.domainLowerLeft = raster.domainLowerLeft != 0;
    state.lineMode = raster.lineMode;
    state.stippledLine = raster.lineStippleFactor != 0;
    state.sampleLocations = raster.programmableSamples != 0;
    const VnDepthStencilStateDesc depth = context.depthStencil ? context.depthStencil->desc : VnDepthStencilStateDesc{};
    state.depthTest = depth.depthTest != 0;
    state.depthWrite = depth.depthWrite != 0;
    state.depthCompare = compareOf(depth.depthCompare, VK_COMPARE_OP_LESS);
    state.stencilTest = depth.stencilTest != 0;
    state.depthBoundsTest = depth.depthBoundsTest != 0;
    state.stencilFront = stencilOf(depth.front);
    state.stencilBack = stencilOf(depth.back);
    const VnBlendStateDesc blend = context.blend ? context.blend->desc : VnBlendStateDesc{};
    state.logicOpEnable = blend.logicOpEnable != 0;
    state.logicOp = blend.logicOp;
    for (uint32_t i = 0; i < kMaxColorAttachments; ++i)
        state.blend[i] = blendOf(blend.attachments[blend.independent ? i : 0]);
    state.colorCount = context.key.colorCount;
    state.colorFormats = context.key.colorFormats;
    state.depthStencilFormat = context.key.depthStencilFormat;
    return state;
}

VnResult recordDrawResources(VnContext context, const char* function) {
    const GraphicsPipeline& pipeline = *context->pipeline;
    std::vector<const ir::Program*> programs;
    for (const StageProgram& stage : pipeline.program().stages()) programs.push_back(&stage.program->source());
    programs.push_back(pipeline.fragmentIr());
    if (VnResult result = recordResources(context, function, command::BindPoint::graphics, programs)) return result;
    context->resourcesChanged = false;
    return VN_SUCCESS;
}

command::BufferRange rangeOf(VnContext context, const VnContext_T::BoundRange& bound) {
    return {bound.buffer ? &context->recording->keep(bound.buffer).buffer : nullptr, bound.offset};
}

void recordBuffers(VnContext context) {
    CommandBuffer& commands = context->recording->commands;
    for (uint32_t binding = 0; binding < kMaxVertexBindings; ++binding) {
        if (!(context->vertexBuffersChanged >> binding & 1u)) continue;
        const command::BufferRange range = rangeOf(context, context->vertexBuffers[binding]);
        commands.record(command::BindVertexBuffers{binding, commands.copy(std::span(&range, 1))});
    }
    context->vertexBuffersChanged = 0;
    if (context->indexBufferChanged)
        commands.record(command::BindIndexBuffer{rangeOf(context, context->indexBuffer), context->indexType});
    context->indexBufferChanged = false;
    if (context->pushConstantsChanged)
        commands.record(command::PushConstants{VK_SHADER_STAGE_ALL_GRAPHICS, 0,
                                               commands.copy(std::span<const std::byte>(context->pushConstants))});
    context->pushConstantsChanged = false;
}

/// Whether none of the objects that a plan is made of is destroyed.
bool allAlive(const VnDevice_T& device, const PipelineKey& key) {
    const auto alive = [](const auto& table, uint64_t id) { return id == 0 || table.find(id) != nullptr; };
    return alive(device.programs, key.program) && alive(device.vertexLayouts, key.vertexLayout) &&
           alive(device.rasterStates, key.raster) && alive(device.depthStencilStates, key.depthStencil) &&
           alive(device.blendStates, key.blend);
}

VnResult checkIndexed(VnContext context, const char* function) {
    return context->indexBuffer.buffer ? VN_SUCCESS : wrongState(context, function, "no index buffer is bound");
}

VnResult drawIndirect(VnContext context, const char* function, VnBuffer buffer, uint64_t offset, uint32_t drawCount,
                      uint32_t stride, bool indexed) {
    if (indexed)
        if (VnResult result = checkIndexed(context, function)) return result;
    const uint32_t size = indexed ? sizeof(VkDrawIndexedIndirectCommand) : sizeof(VkDrawIndirectCommand);
    if (stride == 0) stride = size;
    const auto object = context->device->buffers.find(buffer.id);
    if (!object) return badHandle(context->device, function, "buffer");
    const uint64_t needed = drawCount ? uint64_t{drawCount - 1} * stride + size : 0;
    if (offset % 4 != 0 || stride % 4 != 0 || stride < size || offset > object->buffer.size() ||
        needed > object->buffer.size() - offset)
        return invalid(context->device, function,
                       std::to_string(drawCount) + " draws of stride " + std::to_string(stride) + " at offset " +
                           std::to_string(offset) + " are not inside the buffer's " +
                           std::to_string(object->buffer.size()) + " bytes, or no multiples of 4");
    if (VnResult result = prepareDraw(context, function)) return result;
    command::DrawIndirect draw;
    draw.indexed = indexed;
    draw.arguments = {&context->recording->keep(object).buffer, offset};
    draw.drawCount = drawCount;
    draw.stride = stride;
    context->recording->commands.record(draw);
    context->draws += drawCount;
    return VN_SUCCESS;
}

}  // namespace

namespace vernier::mini {

DynamicState dynamicStateOf(const VnContext_T& context) {
    DynamicState state;
    state.viewports = context.viewports;
    state.scissors = context.scissors;
    state.viewportCount = kMaxViewports;
    state.blendConstants = context.blendConstants;
    if (context.raster) {
        const VnRasterStateDesc& raster = context.raster->desc;
        state.lineWidth = raster.lineWidth == 0 ? 1 : raster.lineWidth;
        state.depthBiasConstant = raster.depthBiasConstant;
        state.depthBiasSlope = raster.depthBiasSlope;
        state.depthBiasClamp = raster.depthBiasClamp;
        state.lineStippleFactor = raster.lineStippleFactor;
        state.lineStipplePattern = raster.lineStipplePattern;
        for (size_t s = 0; s < kMaxSamples; ++s)
            state.sampleLocations[s] = {raster.sampleLocations[s][0], raster.sampleLocations[s][1]};
    }
    const VnDepthStencilStateDesc depth = context.depthStencil ? context.depthStencil->desc : VnDepthStencilStateDesc{};
    state.minDepthBounds = depth.minDepth;
    state.maxDepthBounds = depth.maxDepth;
    state.stencilFront = {0xFFu & ~depth.front.compareMaskOff, 0xFFu & ~depth.front.writeMaskOff, context.stencilFront};
    state.stencilBack = {0xFFu & ~depth.back.compareMaskOff, 0xFFu & ~depth.back.writeMaskOff, context.stencilBack};
    return state;
}

VnResult preparePipeline(VnContext context, const char* function) {
    if (!context->inPass) return wrongState(context, function, "no pass is open");
    if (!context->program) return wrongState(context, function, "no program is bound");
    VnDevice device = context->device;
    const std::lock_guard lock(device->pipelineMutex);
    const auto found = device->pipelines.find(context->key);
    if (found != device->pipelines.end()) {
        context->pipeline = found->second;
        return VN_SUCCESS;
    }
    auto made = GraphicsPipeline::create({graphicsStateOf(*context), context->program->program});
    if (!made) return fail(device, function, made.error());
    context->pipeline = std::move(made).value();
    ++context->plans;
    // With an object that is destroyed and still bound nobody else can ask for this plan, nor would it be forgotten.
    if (allAlive(*device, context->key)) device->pipelines.emplace(context->key, context->pipeline);
    return VN_SUCCESS;
}

VnResult prepareDraw(VnContext context, const char* function) {
    CommandBuffer& commands = context->recording->commands;
    if (!context->inPass) return wrongState(context, function, "no pass is open");
    const bool newPipeline = context->pipelineChanged;
    if (newPipeline) {
        if (VnResult result = preparePipeline(context, function)) return result;
        context->recording->keep(context->pipeline);
    }
    if (newPipeline || context->resourcesChanged)
        if (VnResult result = recordDrawResources(context, function)) return result;
    if (newPipeline || context->dynamicChanged) {
        const DynamicState* fixed = commands.arena().create(dynamicStateOf(*context));
        commands.record(command::BindPipeline{context->pipeline.get(), fixed, 0});
        context->pipelineChanged = context->dynamicChanged = false;
    }
    recordBuffers(context);
    return VN_SUCCESS;
}

}  // namespace vernier::mini

VnResult vnDraw(VnContext context, uint32_t vertexCount, uint32_t instanceCount, uint32_t firstVertex,
                uint32_t firstInstance) {
    return guardedContext(context, __func__, [&] {
        if (VnResult result = prepareDraw(context, "vnDraw")) return result;
        context->recording->commands.record(
            command::Draw{false, vertexCount, instanceCount, firstVertex, firstInstance, 0});
        ++context->draws;
        return VN_SUCCESS;
    });
}

VnResult vnDrawIndexed(VnContext context, uint32_t indexCount, uint32_t instanceCount, uint32_t firstIndex,
                       int32_t vertexOffset, uint32_t firstInstance) {
    return guardedContext(context, __func__, [&] {
        if (VnResult result = checkIndexed(context, "vnDrawIndexed")) return result;
        if (VnResult result = prepareDraw(context, "vnDrawIndexed")) return result;
        context->recording->commands.record(
            command::Draw{true, indexCount, instanceCount, firstIndex, firstInstance, vertexOffset});
        ++context->draws;
        return VN_SUCCESS;
    });
}

VnResult vnDrawIndirect(VnContext context, VnBuffer buffer, uint64_t offset, uint32_t drawCount, uint32_t stride) {
    return guardedContext(context, __func__, [&] {
        return drawIndirect(context, "vnDrawIndirect", buffer, offset, drawCount, stride, false);
    });
}

VnResult vnDrawIndexedIndirect(VnContext context, VnBuffer buffer, uint64_t offset, uint32_t drawCount,
                               uint32_t stride) {
    return guardedContext(context, __func__, [&] {
        return drawIndirect(context, "vnDrawIndexedIndirect", buffer, offset, drawCount, stride, true);
    });
}
