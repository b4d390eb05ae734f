// State objects: vertex layout, raster, depth-stencil, blend. Checked when created, so that binding is cheap.
#include <cmath>

#include "api/mini/errors.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

/// Creates an immutable copy of a checked descriptor.
template <class Object, class Desc, class Handle>
VnResult createState(VnDevice device, const char* function, HandleTable<Object>& table, const Desc* desc,
                     Handle* handle, VnResult (*check)(VnDevice, const char*, const Desc&)) {
    return guarded(device, function, [&] {
        if (VnResult result = checkDesc(device, function, desc, handle)) return result;
        handle->id = 0;
        if (VnResult result = check(device, function, *desc)) return result;
        handle->id = table.insert(std::make_shared<Object>(Object{*desc}));
        return VN_SUCCESS;
    });
}

VnResult checkFinite(VnDevice device, const char* function, const char* field, float value) {
    if (std::isfinite(value)) return VN_SUCCESS;
    return invalid(device, function, std::string(field) + " is not a finite number");
}

VnResult checkRaster(VnDevice device, const char* function, const VnRasterStateDesc& desc) {
    if (VnResult r = checkEnum(device, function, "polygonMode", desc.polygonMode, VK_POLYGON_MODE_POINT)) return r;
    if (VnResult r = checkEnum(device, function, "cullMode", desc.cullMode, VK_CULL_MODE_FRONT_AND_BACK)) return r;
    if (VnResult r = checkEnum(device, function, "frontFace", desc.frontFace, VK_FRONT_FACE_CLOCKWISE)) return r;
    if (VnResult r = checkFinite(device, function, "depthBiasConstant", desc.depthBiasConstant)) return r;
    if (VnResult r = checkFinite(device, function, "depthBiasSlope", desc.depthBiasSlope)) return r;
    if (VnResult r = checkFinite(device, function, "depthBiasClamp", desc.depthBiasClamp)) return r;
    if (desc.depthClip < -1 || desc.depthClip > 1)
        return invalid(device, function, "depthClip is " + std::to_string(desc.depthClip));
    if (!(desc.lineWidth >= 0) || std::isinf(desc.lineWidth))
        return invalid(device, function, "lineWidth is " + std::to_string(desc.lineWidth));
    if (VnResult r =
            checkEnum(device, function, "lineMode", desc.lineMode, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT))
        return r;
    if (desc.lineStippleFactor > 256)
        return invalid(device, function, "lineStippleFactor is " + std::to_string(desc.lineStippleFactor));
    if (!(desc.minSampleShading >= 0 && desc.minSampleShading <= 1))
        return invalid(device, function, "minSampleShading is " + std::to_string(desc.minSampleShading));
    for (const auto& location : desc.sampleLocations)
        for (const uint8_t sixteenths : location)
            if (desc.programmableSamples && sixteenths > 15)
                return invalid(device, function, "a sample location is " + std::to_string(sixteenths) + " / 16");
    return VN_SUCCESS;
}

VnResult checkCompare(VnDevice device, const char* function, const char* field, VkCompareOp op) {
    return op == VN_COMPARE_OP_NEVER ? VN_SUCCESS : checkEnum(device, function, field, op, VK_COMPARE_OP_ALWAYS);
}

VnResult checkFace(VnDevice device, const char* function, const VnStencilFace& face) {
    constexpr int64_t kLast = VK_STENCIL_OP_DECREMENT_AND_WRAP;
    if (VnResult r = checkEnum(device, function, "stencil failOp", face.failOp, kLast)) return r;
    if (VnResult r = checkEnum(device, function, "stencil passOp", face.passOp, kLast)) return r;
    if (VnResult r = checkEnum(device, function, "stencil depthFailOp", face.depthFailOp, kLast)) return r;
    return checkCompare(device, function, "stencil compareOp", face.compareOp);
}

VnResult checkDepthStencil(VnDevice device, const char* function, const VnDepthStencilStateDesc& desc) {
    if (desc.depthWrite && !desc.depthTest) return invalid(device, function, "depthWrite needs depthTest");
    if (VnResult r = checkFinite(device, function, "minDepth", desc.minDepth)) return r;
    if (VnResult r = checkFinite(device, function, "maxDepth", desc.maxDepth)) return r;
    if (VnResult r = checkCompare(device, function, "depthCompare", desc.depthCompare)) return r;
    if (VnResult r = checkFace(device, function, desc.front)) return r;
    return checkFace(device, function, desc.back);
}

VnResult checkBlend(VnDevice device, const char* function, const VnBlendStateDesc& desc) {
    if (VnResult r = checkEnum(device, function, "logicOp", desc.logicOp, VK_LOGIC_OP_SET)) return r;
    for (const VnBlendAttachment& a : desc.attachments) {
        for (const VkBlendFactor factor : {a.srcColor, a.dstColor, a.srcAlpha, a.dstAlpha})
            if (VnResult r =
                    checkEnum(device, function, "a blend factor", factor, VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA))
                return r;
        for (const VkBlendOp op : {a.colorOp, a.alphaOp})
            if (VnResult r = checkEnum(device, function, "a blend op", op, VK_BLEND_OP_MAX)) return r;
    }
    return VN_SUCCESS;
}

VnResult checkAttribute(VnDevice device, const VnVertexLayoutDesc& desc, const VnVertexAttribute& attribute) {
    const FormatInfo* format = findFormat(attribute.format);
    if (!format || !(format->bufferFeatures & VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT))
        return fail(device, VN_ERROR_UNSUPPORTED,
                    "vnCreateVertexLayout: format " + std::to_string(attribute.format) + " of location " +
                        std::to_string(attribute.location) + " is no vertex format");
    if (attribute.location >= kMaxVertexAttributes)
        return invalid(device, "vnCreateVertexLayout", "location is " + std::to_string(attribute.location));
    if (attribute.binding >= desc.bindingCount)
        return invalid(device, "vnCreateVertexLayout",
                       "binding " + std::to_string(attribute.binding) + " of location " +
                           std::to_string(attribute.location) + " is not below bindingCount " +
                           std::to_string(desc.bindingCount));
    return VN_SUCCESS;
}

}  // namespace

VnResult vnCreateVertexLayout(VnDevice device, const VnVertexLayoutDesc* desc, VnVertexLayout* layout) {
    return guarded(device, __func__, [&] {
        if (VnResult result = checkDesc(device, "vnCreateVertexLayout", desc, layout)) return result;
        layout->id = 0;
        if ((desc->attributeCount && !desc->attributes) || (desc->bindingCount && !desc->bindings))
            return invalid(device, "vnCreateVertexLayout", "attributes or bindings is NULL");
        if (desc->bindingCount > kMaxVertexBindings || desc->attributeCount > kMaxVertexAttributes)
            return invalid(device, "vnCreateVertexLayout", "more than 32 attributes or bindings");
        auto object = std::make_shared<VertexLayoutObject>();
        uint32_t seen = 0;
        for (uint32_t i = 0; i < desc->attributeCount; ++i) {
            const VnVertexAttribute& a = desc->attributes[i];
            if (VnResult result = checkAttribute(device, *desc, a)) return result;
            if (seen >> a.location & 1u)
                return invalid(device, "vnCreateVertexLayout",
                               "location " + std::to_string(a.location) + " comes twice");
            seen |= 1u << a.location;
            object->attributes.push_back({a.location, a.binding, a.format, a.offset});
        }
        for (uint32_t i = 0; i < desc->bindingCount; ++i)
            object->bindings.push_back(
                {i, desc->bindings[i].stride,
                 desc->bindings[i].perInstance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
        layout->id = device->vertexLayouts.insert(std::move(object));
        return VN_SUCCESS;
    });
}

VnResult vnCreateRasterState(VnDevice device, const VnRasterStateDesc* desc, VnRasterState* state) {
    return device ? createState(device, __func__, device->rasterStates, desc, state, checkRaster)
                  : VN_ERROR_INVALID_HANDLE;
}

VnResult vnCreateDepthStencilState(VnDevice device, const VnDepthStencilStateDesc* desc, VnDepthStencilState* state) {
    return device ? createState(device, __func__, device->depthStencilStates, desc, state, checkDepthStencil)
                  : VN_ERROR_INVALID_HANDLE;
}

VnResult vnCreateBlendState(VnDevice device, const VnBlendStateDesc* desc, VnBlendState* state) {
    return device ? createState(device, __func__, device->blendStates, desc, state, checkBlend)
                  : VN_ERROR_INVALID_HANDLE;
}

// Destroying a state object also forgets the plans made with it, so that a later object's handle never meets an old
// plan.
#define VERNIER_DESTROY_STATE(Name, Handle, table, keyField, kind)                                                    \
    VnResult vnDestroy##Name(VnDevice device, Handle state) {                                                         \
        return guarded(device, __func__, [&] {                                                                        \
            if (VnResult result = destroyIn(device, "vnDestroy" #Name, kind, device->table, state.id)) return result; \
            const std::lock_guard lock(device->pipelineMutex);                                                        \
            std::erase_if(device->pipelines, [&](const auto& entry) { return entry.first.keyField == state.id; });    \
            return VN_SUCCESS;                                                                                        \
        });                                                                                                           \
    }
VERNIER_DESTROY_STATE(VertexLayout, VnVertexLayout, vertexLayouts, vertexLayout, "vertex layout")
VERNIER_DESTROY_STATE(RasterState, VnRasterState, rasterStates, raster, "raster state")
VERNIER_DESTROY_STATE(DepthStencilState, VnDepthStencilState, depthStencilStates, depthStencil, "depth-stencil state")
VERNIER_DESTROY_STATE(BlendState, VnBlendState, blendStates, blend, "blend state")
#undef VERNIER_DESTROY_STATE
