#include "runtime/plan/check_state.h"

#include <algorithm>
#include <optional>
#include <string>

#include "runtime/format/format.h"
#include "runtime/plan/sample_positions.h"
#include "spirv_interp/ir/names.h"

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
        case VK_PRIMITIVE_TOPOLOGY_PATCH_LIST:
            break;
        default:
            return unsupported("topology: VkPrimitiveTopology " + number(state.topology) + " is not supported");
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
            return unsupported(std::string(ir::nameOf(program.stage)) + " shader: more than " +
                               number(kMaxClipDistances) + " clip or cull distances");
    }
    return {};
}

/// The primitives that topologies are made of, as geometry stages get them.
std::optional<ir::GeometryInput> primitiveOf(VkPrimitiveTopology topology) {
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            return ir::GeometryInput::points;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
            return ir::GeometryInput::lines;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN:
            return ir::GeometryInput::triangles;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            return ir::GeometryInput::linesAdjacency;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
            return ir::GeometryInput::trianglesAdjacency;
        default:
            return std::nullopt;
    }
}

/// Patches are for tessellation stages, and these for patches (VUID-VkGraphicsPipelineCreateInfo-pStages-08888 and
/// -topology-08889).
Status checkTessellation(const GraphicsState& state, const ShaderProgram& program) {
    const bool patches = state.topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
    if ((program.stage(ir::Stage::control) != nullptr) != patches)
        return invalidArgument(patches ? "topology: patches need tessellation shaders"
                                       : "tessellation shaders: the topology is not of patches");
    if (patches && (state.patchControlPoints == 0 || state.patchControlPoints > kMaxPatchVertices))
        return invalidArgument("patchControlPoints is " + number(state.patchControlPoints) + "; 1 to " +
                               number(kMaxPatchVertices) + " are supported");
    return {};
}

/// A geometry stage gets the primitives that it declares (VUID-VkGraphicsPipelineCreateInfo-pStages-00738).
Status checkGeometryStage(const GraphicsState& state, const ShaderProgram& program) {
    const std::shared_ptr<const BatchProgram> geometry = program.stage(ir::Stage::geometry);
    if (geometry == nullptr) return {};
    const ir::GeometryInput wanted = geometry->source().geometry.input;
    const bool tessellates = program.stage(ir::Stage::evaluation) != nullptr;
    const std::optional<ir::GeometryInput> drawn =
        primitiveOf(tessellates ? topologyOf(program.tessellation()) : state.topology);
    if (drawn == wanted) return {};
    return invalidArgument("geometry shader: it takes " + std::string(ir::nameOf(wanted)) + ", the topology is of " +
                           (drawn ? std::string(ir::nameOf(*drawn)) : std::string("something else")));
}

}  // namespace

VkPrimitiveTopology topologyOf(ir::GeometryOutput output) {
    switch (output) {
        case ir::GeometryOutput::points:
            return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
        case ir::GeometryOutput::lineStrip:
            return VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
        default:
            return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    }
}

VkPrimitiveTopology topologyOf(ir::GeometryInput input) {
    switch (input) {
        case ir::GeometryInput::points:
            return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
        case ir::GeometryInput::lines:
            return VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        case ir::GeometryInput::linesAdjacency:
            return VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY;
        case ir::GeometryInput::trianglesAdjacency:
            return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY;
        default:
            return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    }
}

VkPrimitiveTopology topologyOf(const TessellationModes& modes) {
    if (modes.pointMode) return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    return modes.domain == TessellationDomain::isolines ? VK_PRIMITIVE_TOPOLOGY_LINE_LIST
                                                        : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
}

Status checkGraphicsState(const GraphicsState& state, const Accuracy& accuracy) {
    const uint32_t bits = accuracy.subPixelBits;
    if (bits != 4 && bits != 8 && bits != 12 && bits != 16)
        return invalidArgument("Accuracy::subPixelBits: " + number(bits) + " is none of 4, 8, 12, 16");
    for (const auto check : {checkVertexInput, checkRasterization, checkAttachments})
        if (Status status = check(state); !status) return status;
    return {};
}

Status checkInterfaces(const GraphicsState& state, const ShaderProgram& program) {
    if (Status status = checkDistances(program.lastIr()); !status) return status;
    if (Status status = checkTessellation(state, program); !status) return status;
    if (Status status = checkGeometryStage(state, program); !status) return status;
    for (const ir::InterfaceSlot& slot : program.vertexIr().inputs) {
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
