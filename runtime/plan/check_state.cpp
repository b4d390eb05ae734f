#include "runtime/plan/check_state.h"

#include <algorithm>
#include <string>

#include "runtime/format/format.h"
#include "runtime/plan/sample_positions.h"

namespace vernier {
namespace {

std::string number(uint64_t value) {
    return std::to_string(value);
}

std::string formatName(VkFormat format) {
    const FormatInfo* info = findFormat(format);
    return info != nullptr ? info->name : "VkFormat " + number(format);
}

Status checkVertexInput(const GraphicsState& state) {
    for (const auto& binding : state.vertexBindings)
        if (binding.binding >= kMaxVertexBindings)
            return invalidArgument("vertexBindings: binding " + number(binding.binding) + " is not below " +
                                   number(kMaxVertexBindings));
    for (const auto& attribute : state.vertexAttributes) {
        const std::string name = "vertex attribute of location " + number(attribute.location);
        const FormatInfo* info = findFormat(attribute.format);
        if (info == nullptr || (info->bufferFeatures & VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT) == 0)
            return unsupported(name + ": " + formatName(attribute.format) + " is not a vertex format");
        const bool found = std::any_of(state.vertexBindings.begin(), state.vertexBindings.end(),
                                       [&](const auto& binding) { return binding.binding == attribute.binding; });
        if (!found) return invalidArgument(name + ": binding " + number(attribute.binding) + " is not described");
    }
    return {};
}

Status checkRasterization(const GraphicsState& state) {
    switch (state.topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN:
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
            break;
        default:
            return unsupported("topology: VkPrimitiveTopology " + number(state.topology) +
                               " (patches) is not supported");
    }
    if (state.lineMode > VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT)
        return unsupported("lineMode: VkLineRasterizationModeEXT " + number(state.lineMode) + " is not supported");
    if (state.polygonMode > VK_POLYGON_MODE_POINT)
        return unsupported("polygonMode: VkPolygonMode " + number(state.polygonMode) + " is not supported");
    if (!isSampleCount(state.samples))
        return unsupported("samples: " + number(state.samples) + " samples are not supported (1, 2, 4, 8, 16 are)");
    return {};
}

Status checkAttachments(const GraphicsState& state) {
    if (state.colorCount > kMaxColorAttachments)
        return invalidArgument("colorCount: " + number(state.colorCount) + " is above " + number(kMaxColorAttachments));
    for (uint32_t n = 0; n < state.colorCount; ++n) {
        const VkFormat format = state.colorFormats[n];
        if (format == VK_FORMAT_UNDEFINED) continue;
        const FormatInfo* info = findFormat(format);
        const std::string name = "colorFormats[" + number(n) + "]: " + formatName(format);
        if (info == nullptr || (info->optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) == 0)
            return unsupported(name + " cannot be a colour attachment");
        if (state.blend[n].blendEnable && !state.logicOpEnable) {
            if ((info->optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) == 0)
                return invalidArgument(name + " cannot be blended");
            for (const VkBlendOp op : {state.blend[n].colorBlendOp, state.blend[n].alphaBlendOp})
                if (op > VK_BLEND_OP_MAX)
                    return unsupported("blend[" + number(n) + "]: VkBlendOp " + number(static_cast<uint64_t>(op)) +
                                       " is not supported");
        }
    }
    if (state.depthStencilFormat == VK_FORMAT_UNDEFINED) return {};
    const FormatInfo* info = findFormat(state.depthStencilFormat);
    if (info == nullptr || (info->optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) == 0)
        return unsupported("depthStencilFormat: " + formatName(state.depthStencilFormat) +
                           " cannot be a depth/stencil attachment");
    return {};
}

Status checkDistances(const ir::Program& program) {
    for (const ir::InterfaceSlot& slot : program.outputs) {
        const bool distance = slot.builtin == ir::Builtin::clipDistance || slot.builtin == ir::Builtin::cullDistance;
        if (distance && slot.component >= kMaxClipDistances)
            return unsupported("vertex shader: more than " + number(kMaxClipDistances) + " clip or cull distances");
    }
    return {};
}

}  // namespace

Status checkGraphicsState(const GraphicsState& state, const Accuracy& accuracy) {
    const uint32_t bits = accuracy.subPixelBits;
    if (bits != 4 && bits != 8 && bits != 12 && bits != 16)
        return invalidArgument("Accuracy::subPixelBits: " + number(bits) + " is none of 4, 8, 12, 16");
    for (const auto check : {checkVertexInput, checkRasterization, checkAttachments})
        if (Status status = check(state); !status) return status;
    return {};
}

Status checkInterfaces(const GraphicsState& state, const ir::Program& vertex) {
    if (Status status = checkDistances(vertex); !status) return status;
    for (const ir::InterfaceSlot& slot : vertex.inputs) {
        if (slot.builtin != ir::Builtin::user) continue;
        const bool found = std::any_of(state.vertexAttributes.begin(), state.vertexAttributes.end(),
                                       [&](const auto& attribute) { return attribute.location == slot.location; });
        if (!found)
            return invalidArgument("vertex shader: input location " + number(slot.location) +
                                   " has no vertex attribute");
    }
    return {};
}

}  // namespace vernier
