// The state of a graphics pipeline as plain data in Vulkan's own terms, and the state that may change between draws.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/limits.h"
#include "runtime/plan/sample_positions.h"

namespace vernier {

/// How the fragment program may read attachments that the same draws write, each fragment what those before it have
/// left: VK_EXT_rasterization_order_attachment_access and VK_EXT_attachment_feedback_loop_layout.
struct AttachmentReads {
    bool asInputs = false, asTextures = false;
};

/// Everything fixed when a pipeline is created, shaders aside. Values that a draw takes from DynamicState are not here.
struct GraphicsState {
    std::vector<VkVertexInputBindingDescription> vertexBindings;
    std::array<uint32_t, kMaxVertexBindings> instanceDivisors = allOnes();  // by binding
    std::vector<VkVertexInputAttributeDescription> vertexAttributes;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    uint32_t patchControlPoints = 1;  // vertices of a patch: 1 to kMaxPatchVertices
    bool domainLowerLeft = false;     // the origin of tessellated domains: winding is as seen with v upwards
    bool primitiveRestart = false;

    bool depthClampEnable = false;
    bool depthUnrestricted = false;  // depths of float formats may lie outside 0..1 (VK_EXT_depth_range_unrestricted)
    bool negativeOneToOne = false;   // clip depths from -w to w instead of 0 to w (VK_EXT_depth_clip_control)
    bool depthClipEnable = true;     // the specification's default: the opposite of depthClampEnable
    bool rasterizerDiscard = false;
    VkPolygonMode polygonMode = VK_POLYGON_MODE_FILL;
    VkCullModeFlags cullMode = VK_CULL_MODE_NONE;
    VkFrontFace frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    bool depthBiasEnable = false;
    bool provokingVertexLast = false;
    VkLineRasterizationModeEXT lineMode = VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;  // the default is rectangular
    bool stippledLine = false;

    uint32_t samples = 1;
    uint32_t sampleMask = ~0u;
    bool sampleLocations = false;  // DynamicState::sampleLocations instead of the standard ones
    bool sampleShading = false;
    float minSampleShading = 0;
    bool alphaToCoverage = false;
    bool alphaToOne = false;

    bool depthTest = false;
    bool depthWrite = false;
    VkCompareOp depthCompare = VK_COMPARE_OP_ALWAYS;
    bool depthBoundsTest = false;
    bool stencilTest = false;
    VkStencilOpState stencilFront{}, stencilBack{};  // operations; masks and reference are dynamic

    bool logicOpEnable = false;
    VkLogicOp logicOp = VK_LOGIC_OP_COPY;
    std::array<VkPipelineColorBlendAttachmentState, kMaxColorAttachments> blend{};

    AttachmentReads readsColors, readsDepthStencil;

    uint32_t colorCount = 0;
    std::array<VkFormat, kMaxColorAttachments> colorFormats{};  // VK_FORMAT_UNDEFINED: unused
    VkFormat depthStencilFormat = VK_FORMAT_UNDEFINED;

  private:
    static constexpr std::array<uint32_t, kMaxVertexBindings> allOnes() {
        std::array<uint32_t, kMaxVertexBindings> ones{};
        ones.fill(1);
        return ones;
    }
};

/// A bit for each VkDynamicState that is supported; 0 for the others.
constexpr uint32_t dynamicStateBit(VkDynamicState state) {
    if (state <= VK_DYNAMIC_STATE_STENCIL_REFERENCE) return 1u << state;
    switch (state) {
        case VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT:
            return 1u << 9;
        case VK_DYNAMIC_STATE_LINE_STIPPLE_EXT:
            return 1u << 10;
        case VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT:
            return 1u << 11;
        default:
            return 0;
    }
}

/// State that a command may set between draws. A pipeline that fixes some of it copies its values in here when bound.
struct DynamicState {
    std::array<VkViewport, kMaxViewports> viewports{};
    std::array<VkRect2D, kMaxViewports> scissors{};
    uint32_t viewportCount = 1;
    float lineWidth = 1;
    uint32_t lineStippleFactor = 1;
    uint16_t lineStipplePattern = 0xFFFF;
    float depthBiasConstant = 0, depthBiasClamp = 0, depthBiasSlope = 0;
    std::array<float, 4> blendConstants{};
    uint32_t colorWrites = ~0u;  // a bit per attachment: 0 leaves it as it is
    float minDepthBounds = 0, maxDepthBounds = 1;
    std::array<SamplePosition, kMaxSamples> sampleLocations{};  // where GraphicsState::sampleLocations asks for them
    struct StencilFace {
        uint32_t compareMask = 0xFF, writeMask = 0xFF, reference = 0;
    };
    StencilFace stencilFront, stencilBack;
};

}  // namespace vernier
