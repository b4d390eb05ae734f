// Binding resources and state, and setting what is set directly. Nothing is recorded here: a draw records what changed.
#include <algorithm>
#include <cmath>

#include "api/mini/context_guard.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

constexpr uint32_t kMaxBindings = 256, kMaxElements = 256;

/// Binds a state object; {0} binds none, which stands for the default.
template <class Object>
VnResult bindState(VnContext context, const char* function, const char* kind, HandleTable<Object>& table, uint64_t id,
                   std::shared_ptr<Object>& slot, uint64_t& keyField) {
    std::shared_ptr<Object> object = table.find(id);
    if (id && !object) return badHandle(context->device, function, kind);
    slot = std::move(object);
    if (keyField != id) context->pipelineChanged = true;
    keyField = id;
    // Raster and depth-stencil states carry values that travel with the dynamic state.
    context->dynamicChanged = true;
    return VN_SUCCESS;
}

/// The element of the table, made if new; nullptr after an error about its place.
BoundResource* elementAt(VnContext context, const char* function, uint32_t set, uint32_t binding, uint32_t element) {
    if (set >= kMaxDescriptorSets || binding >= kMaxBindings || element >= kMaxElements) {
        invalid(context->device, function,
                "set " + std::to_string(set) + ", binding " + std::to_string(binding) + ", element " +
                    std::to_string(element) + " is out of range");
        return nullptr;
    }
    auto& elements = context->resources[{set, binding}];
    if (elements.size() <= element) elements.resize(element + 1);
    context->resourcesChanged = context->computeResourcesChanged = true;
    return &elements[element];
}

VnResult checkViewport(VnContext context, const VkViewport& viewport) {
    const float fields[] = {viewport.x, viewport.y, viewport.width, viewport.height};
    constexpr float kLimit = 32768;
    for (const float field : fields)
        if (!(std::abs(field) <= kLimit))
            return invalid(context->device, "vnSetViewports",
                           "x, y, width or height is " + std::to_string(field) + ", beyond +-32768");
    if (!(viewport.width >= 0))
        return invalid(context->device, "vnSetViewports", "width is " + std::to_string(viewport.width));
    if (!(viewport.minDepth >= 0 && viewport.minDepth <= 1 && viewport.maxDepth >= 0 && viewport.maxDepth <= 1))
        return invalid(context->device, "vnSetViewports",
                       "depth range " + std::to_string(viewport.minDepth) + " .. " + std::to_string(viewport.maxDepth) +
                           " is not inside 0 .. 1");
    return VN_SUCCESS;
}

VnResult checkViewportRange(VnContext context, const char* function, uint32_t first, uint32_t count,
                            const void* values) {
    if (!values && count) return invalid(context->device, function, "the array is NULL");
    if (first > kMaxViewports || count > kMaxViewports - first)
        return invalid(context->device, function,
                       std::to_string(first) + " + " + std::to_string(count) + " are not inside the " +
                           std::to_string(kMaxViewports) + " there are");
    return VN_SUCCESS;
}

}  // namespace

VnResult vnBindProgram(VnContext context, VnProgram program) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ProgramObject> object = context->device->programs.find(program.id);
        if (object && object->compute) {
            context->computeProgram = std::move(object);
            context->computeProgramChanged = context->computeResourcesChanged = true;
            return VN_SUCCESS;
        }
        if (program.id == 0) context->computeProgram = nullptr;
        context->resourcesChanged = true;
        return bindState(context, "vnBindProgram", "program", context->device->programs, program.id, context->program,
                         context->key.program);
    });
}

VnResult vnBindVertexLayout(VnContext context, VnVertexLayout layout) {
    return guardedContext(context, __func__, [&] {
        return bindState(context, "vnBindVertexLayout", "vertex layout", context->device->vertexLayouts, layout.id,
                         context->vertexLayout, context->key.vertexLayout);
    });
}

VnResult vnBindRasterState(VnContext context, VnRasterState state) {
    return guardedContext(context, __func__, [&] {
        return bindState(context, "vnBindRasterState", "raster state", context->device->rasterStates, state.id,
                         context->raster, context->key.raster);
    });
}

VnResult vnBindDepthStencilState(VnContext context, VnDepthStencilState state) {
    return guardedContext(context, __func__, [&] {
        return bindState(context, "vnBindDepthStencilState", "depth-stencil state", context->device->depthStencilStates,
                         state.id, context->depthStencil, context->key.depthStencil);
    });
}

VnResult vnBindBlendState(VnContext context, VnBlendState state) {
    return guardedContext(context, __func__, [&] {
        return bindState(context, "vnBindBlendState", "blend state", context->device->blendStates, state.id,
                         context->blend, context->key.blend);
    });
}

VnResult vnBindVertexBuffer(VnContext context, uint32_t binding, VnBuffer buffer, uint64_t offset) {
    return guardedContext(context, __func__, [&] {
        if (binding >= kMaxVertexBindings)
            return invalid(context->device, "vnBindVertexBuffer", "binding is " + std::to_string(binding));
        const auto object = context->device->buffers.find(buffer.id);
        if (buffer.id && !object) return badHandle(context->device, "vnBindVertexBuffer", "buffer");
        if (object && offset > object->buffer.size())
            return invalid(context->device, "vnBindVertexBuffer",
                           "offset " + std::to_string(offset) + " is beyond the buffer's " +
                               std::to_string(object->buffer.size()) + " bytes");
        context->vertexBuffers[binding] = {object, offset};
        context->vertexBuffersChanged |= 1u << binding;
        return VN_SUCCESS;
    });
}

VnResult vnBindIndexBuffer(VnContext context, VnBuffer buffer, uint64_t offset, VkIndexType type) {
    return guardedContext(context, __func__, [&] {
        if (type != VK_INDEX_TYPE_UINT8_EXT && type != VK_INDEX_TYPE_UINT16 && type != VK_INDEX_TYPE_UINT32)
            return invalid(context->device, "vnBindIndexBuffer", "type is " + std::to_string(type));
        const auto object = context->device->buffers.find(buffer.id);
        if (buffer.id && !object) return badHandle(context->device, "vnBindIndexBuffer", "buffer");
        const uint64_t size = type == VK_INDEX_TYPE_UINT8_EXT ? 1 : type == VK_INDEX_TYPE_UINT16 ? 2 : 4;
        if (object && (offset > object->buffer.size() || offset % size != 0))
            return invalid(
                context->device, "vnBindIndexBuffer",
                "offset " + std::to_string(offset) + " is beyond the buffer or no multiple of the index size");
        context->indexBuffer = {object, offset};
        context->indexType = type;
        context->indexBufferChanged = true;
        return VN_SUCCESS;
    });
}

VnResult vnBindBuffer(VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnBuffer buffer,
                      uint64_t offset, uint64_t size) {
    return guardedContext(context, __func__, [&] {
        const auto object = context->device->buffers.find(buffer.id);
        if (buffer.id && !object) return badHandle(context->device, "vnBindBuffer", "buffer");
        if (object && (offset > object->buffer.size() || offset % 4 != 0 || size > object->buffer.size() - offset))
            return invalid(context->device, "vnBindBuffer",
                           "offset " + std::to_string(offset) + " with size " + std::to_string(size) +
                               " is not inside the buffer's " + std::to_string(object->buffer.size()) +
                               " bytes or no multiple of 4");
        BoundResource* resource = elementAt(context, "vnBindBuffer", set, binding, element);
        if (!resource) return VN_ERROR_INVALID_ARGUMENT;
        *resource = {};
        resource->buffer = object;
        resource->offset = offset;
        resource->size = size;
        return VN_SUCCESS;
    });
}

VnResult vnBindTexture(VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnView view,
                       VnSampler sampler) {
    return guardedContext(context, __func__, [&] {
        const auto viewObject = context->device->views.find(view.id);
        if (view.id && !viewObject) return badHandle(context->device, "vnBindTexture", "view");
        const auto samplerObject = context->device->samplers.find(sampler.id);
        if (sampler.id && !samplerObject) return badHandle(context->device, "vnBindTexture", "sampler");
        if (viewObject && samplerObject) {
            if (Status status = checkSampling(viewObject->view.texture(), samplerObject->state); !status)
                return fail(context->device, "vnBindTexture", status.error());
        }
        BoundResource* resource = elementAt(context, "vnBindTexture", set, binding, element);
        if (!resource) return VN_ERROR_INVALID_ARGUMENT;
        *resource = {};
        resource->view = viewObject;
        resource->sampler = samplerObject;
        return VN_SUCCESS;
    });
}

VnResult vnBindTexelBuffer(VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnBuffer buffer,
                           VkFormat format, uint64_t offset, uint64_t size) {
    return guardedContext(context, __func__, [&] {
        const auto object = context->device->buffers.find(buffer.id);
        if (buffer.id && !object) return badHandle(context->device, "vnBindTexelBuffer", "buffer");
        std::shared_ptr<BufferView> texels;
        if (object) {
            const BufferViewInfo info{format, offset, size ? size : VK_WHOLE_SIZE};
            Result<BufferView> view = BufferView::create(object->buffer, info, context->device->runtime->isa());
            if (!view) return fail(context->device, "vnBindTexelBuffer", view.error());
            texels = std::make_shared<BufferView>(std::move(view).value());
        }
        BoundResource* resource = elementAt(context, "vnBindTexelBuffer", set, binding, element);
        if (!resource) return VN_ERROR_INVALID_ARGUMENT;
        *resource = {};
        resource->buffer = object;
        resource->texels = std::move(texels);
        return VN_SUCCESS;
    });
}

VnResult vnPushConstants(VnContext context, uint32_t offset, const void* data, uint32_t size) {
    return guardedContext(context, __func__, [&] {
        if (!data && size) return invalid(context->device, "vnPushConstants", "data is NULL");
        if (offset % 4 != 0 || size % 4 != 0 || offset > kMaxPushConstantBytes || size > kMaxPushConstantBytes - offset)
            return invalid(context->device, "vnPushConstants",
                           "offset " + std::to_string(offset) + ", size " + std::to_string(size) +
                               ": must be multiples of 4 inside " + std::to_string(kMaxPushConstantBytes) + " bytes");
        const auto* bytes = static_cast<const std::byte*>(data);
        std::copy_n(bytes, size, context->pushConstants.data() + offset);
        context->pushConstantsChanged = context->computePushConstantsChanged = true;
        return VN_SUCCESS;
    });
}

VnResult vnSetViewports(VnContext context, uint32_t first, uint32_t count, const VkViewport* viewports) {
    return guardedContext(context, __func__, [&] {
        if (VnResult result = checkViewportRange(context, "vnSetViewports", first, count, viewports)) return result;
        for (uint32_t n = 0; n < count; ++n)
            if (VnResult result = checkViewport(context, viewports[n])) return result;
        std::copy_n(viewports, count, context->viewports.begin() + first);
        context->dynamicChanged = true;
        return VN_SUCCESS;
    });
}

VnResult vnSetViewport(VnContext context, const VkViewport* viewport) {
    return vnSetViewports(context, 0, 1, viewport);
}

VnResult vnSetScissors(VnContext context, uint32_t first, uint32_t count, const VkRect2D* scissors) {
    return guardedContext(context, __func__, [&] {
        if (VnResult result = checkViewportRange(context, "vnSetScissors", first, count, scissors)) return result;
        for (uint32_t n = 0; n < count; ++n)
            if (scissors[n].offset.x < 0 || scissors[n].offset.y < 0)
                return invalid(context->device, "vnSetScissors",
                               "offset is (" + std::to_string(scissors[n].offset.x) + ", " +
                                   std::to_string(scissors[n].offset.y) + ")");
        std::copy_n(scissors, count, context->scissors.begin() + first);
        context->dynamicChanged = true;
        return VN_SUCCESS;
    });
}

VnResult vnSetScissor(VnContext context, const VkRect2D* scissor) {
    return vnSetScissors(context, 0, 1, scissor);
}

VnResult vnSetTopology(VnContext context, VkPrimitiveTopology topology, int primitiveRestart) {
    return guardedContext(context, __func__, [&] {
        if (topology < VK_PRIMITIVE_TOPOLOGY_POINT_LIST || topology > VK_PRIMITIVE_TOPOLOGY_PATCH_LIST)
            return invalid(context->device, "vnSetTopology", "topology is " + std::to_string(topology));
        context->key.topology = topology;
        context->key.primitiveRestart = primitiveRestart != 0;
        context->pipelineChanged = true;
        return VN_SUCCESS;
    });
}

VnResult vnSetPatchVertices(VnContext context, uint32_t vertices) {
    return guardedContext(context, __func__, [&] {
        if (vertices == 0 || vertices > kMaxPatchVertices)
            return invalid(context->device, "vnSetPatchVertices",
                           "vertices is " + std::to_string(vertices) + "; 1 to " + std::to_string(kMaxPatchVertices));
        context->key.patchVertices = vertices;
        context->pipelineChanged = true;
        return VN_SUCCESS;
    });
}

VnResult vnSetBlendConstants(VnContext context, const float rgba[4]) {
    return guardedContext(context, __func__, [&] {
        if (!rgba) return invalid(context->device, "vnSetBlendConstants", "rgba is NULL");
        std::copy_n(rgba, 4, context->blendConstants.begin());
        context->dynamicChanged = true;
        return VN_SUCCESS;
    });
}

VnResult vnSetStencilReference(VnContext context, uint32_t front, uint32_t back) {
    return guardedContext(context, __func__, [&] {
        context->stencilFront = front & 0xFFu;
        context->stencilBack = back & 0xFFu;
        context->dynamicChanged = true;
        return VN_SUCCESS;
    });
}
