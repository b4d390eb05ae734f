// A conformance scene as plain data: what is uploaded, what is drawn, what is read back. A scene is written
// once (conformance/scenes) and executed by every driver (conformance/drivers) and by the reference renderer
// (conformance/oracle). All state uses Vulkan's own enums and structs, so that no driver has to guess a
// meaning.
//
// Conventions: Vulkan clip space (y down, depth 0..1); indices into the vectors below name resources; kNone =
// absent.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vernier::conformance {

using Bytes = std::vector<std::byte>;
inline constexpr uint32_t kNone = ~0u;

struct SceneBuffer {
    std::string name;
    VkBufferUsageFlags usage = 0;  // transfer usage is added by the drivers
    Bytes data;                    // initial contents; its size is the buffer's size
};

struct SceneImage {
    std::string name;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkExtent2D extent{};
    uint32_t depth = 1;  // slices of a 3D image
    uint32_t mipLevels = 1;
    uint32_t arrayLayers = 1;
    // As which it is sampled, and with it its dimensions. MAX_ENUM: 2D, or a 2D array when there are several layers.
    VkImageViewType viewType = VK_IMAGE_VIEW_TYPE_MAX_ENUM;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkImageUsageFlags usage = 0;  // transfer usage is added by the drivers
    // Tightly packed initial contents, level-major: data[mip * arrayLayers + layer], of a 3D image all slices; no
    // entries, or an empty entry for a subresource: undefined contents.
    std::vector<Bytes> data;
};

struct SceneSampler {
    VkFilter magFilter = VK_FILTER_NEAREST;
    VkFilter minFilter = VK_FILTER_NEAREST;
    VkSamplerMipmapMode mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    VkSamplerAddressMode addressModeU = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    float mipLodBias = 0;
    float minLod = 0;
    float maxLod = VK_LOD_CLAMP_NONE;
    float maxAnisotropy = 0;  // 0: off
    VkBorderColor borderColor = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    std::array<float, 4> customBorderColor{};  // of VK_BORDER_COLOR_FLOAT_CUSTOM_EXT
    bool compareEnable = false;
    VkCompareOp compareOp = VK_COMPARE_OP_ALWAYS;
    VkSamplerReductionMode reduction = VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
    bool unnormalized = false;  // coordinates in texels, under the rules of VkSamplerCreateInfo
};

struct SceneShader {
    VkShaderStageFlagBits stage = VK_SHADER_STAGE_VERTEX_BIT;
    std::string glsl;             // source, kept for the report
    std::vector<uint32_t> spirv;  // entry point "main"
    std::vector<VkSpecializationMapEntry> specialization;
    Bytes specializationData;
};

struct ScenePipeline {
    uint32_t vertexShader = kNone;
    // Both or neither; with them the topology is a list of patches.
    uint32_t controlShader = kNone, evaluationShader = kNone;
    uint32_t patchVertices = 3;
    bool domainLowerLeft = false;     // VkPipelineTessellationDomainOriginStateCreateInfo
    uint32_t geometryShader = kNone;  // kNone: no such stage
    uint32_t fragmentShader = kNone;  // kNone: depth-only
    std::vector<VkVertexInputBindingDescription> vertexBindings;
    std::vector<VkVertexInputAttributeDescription> vertexAttributes;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    bool primitiveRestart = false;
    VkPolygonMode polygonMode = VK_POLYGON_MODE_FILL;
    VkCullModeFlags cullMode = VK_CULL_MODE_NONE;
    VkFrontFace frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    float lineWidth = 1;
    VkLineRasterizationModeEXT lineMode = VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;  // VK_EXT_line_rasterization
    uint32_t stippleFactor = 0;                                                    // 0: lines are not stippled
    uint16_t stipplePattern = 0;
    bool provokingVertexLast = false;    // VK_EXT_provoking_vertex
    bool depthNegativeOneToOne = false;  // VK_EXT_depth_clip_control
    bool depthClamp = false;
    std::optional<bool> depthClip;  // at near and far (VK_EXT_depth_clip_enable); none: unless depthClamp
    bool depthBias = false;
    float depthBiasConstant = 0, depthBiasClamp = 0, depthBiasSlope = 0;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    bool alphaToCoverage = false, alphaToOne = false;
    uint32_t sampleMask = ~0u;
    // One per sample, in sixteenths of a pixel from its upper left corner (0..15); none: the standard positions
    // (VK_EXT_sample_locations). All pipelines of a pass agree.
    std::vector<std::array<uint8_t, 2>> sampleLocations;
    bool sampleShading = false;
    float minSampleShading = 0;
    bool depthTest = false, depthWrite = false;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS;
    bool depthBoundsTest = false;
    float minDepthBounds = 0, maxDepthBounds = 1;
    bool stencilTest = false;
    VkStencilOpState front{}, back{};
    // One per colour attachment of the pass; blendEnable and colorWriteMask included.
    std::vector<VkPipelineColorBlendAttachmentState> blend;
    std::array<float, 4> blendConstants{};
    bool logicOpEnable = false;
    VkLogicOp logicOp = VK_LOGIC_OP_COPY;
    uint32_t pushConstantBytes = 0;  // visible to all stages, from offset 0
};

struct SceneBinding {
    uint32_t set = 0, binding = 0;
    // UNIFORM_BUFFER, STORAGE_BUFFER: buffer, offset, range. COMBINED_IMAGE_SAMPLER: image, sampler (all mips
    // and layers, by SceneImage::viewType). STORAGE_IMAGE: image, level 0 alone. UNIFORM_TEXEL_BUFFER,
    // STORAGE_TEXEL_BUFFER: buffer, offset, range, texelFormat.
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    uint32_t buffer = kNone;
    VkDeviceSize offset = 0;
    VkDeviceSize range = VK_WHOLE_SIZE;
    uint32_t image = kNone;
    uint32_t sampler = kNone;
    VkFormat texelFormat = VK_FORMAT_UNDEFINED;
};

struct SceneVertexBuffer {
    uint32_t binding = 0;
    uint32_t buffer = kNone;
    VkDeviceSize offset = 0;
};

/// A viewport with its scissor.
struct SceneView {
    VkViewport viewport{};
    VkRect2D scissor{};
};

struct SceneDraw {
    uint32_t pipeline = kNone;
    std::vector<SceneBinding> bindings;
    Bytes pushConstants;
    std::vector<SceneVertexBuffer> vertexBuffers;
    uint32_t indexBuffer = kNone;  // kNone: a non-indexed draw
    VkDeviceSize indexOffset = 0;
    VkIndexType indexType = VK_INDEX_TYPE_UINT16;
    VkViewport viewport{};
    VkRect2D scissor{};
    std::vector<SceneView> moreViews;  // those after the first, which a shader chooses by ViewportIndex
    uint32_t count = 0;                // vertices or indices
    uint32_t instances = 1;
    uint32_t first = 0;  // first vertex or first index
    int32_t vertexOffset = 0;
    uint32_t firstInstance = 0;
};

struct SceneAttachment {
    uint32_t image = kNone;
    uint32_t mipLevel = 0, layer = 0;
    uint32_t layerCount = 1;  // of layered and multiview passes; in each of its attachments the same
    VkAttachmentLoadOp loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    VkClearValue clear{};
    uint32_t resolveImage = kNone;  // single-sampled; resolved at the end of the pass: colours as averages
    // How a depth/stencil attachment is resolved (VK_KHR_depth_stencil_resolve); NONE leaves it undefined.
    VkResolveModeFlagBits depthResolve = VK_RESOLVE_MODE_NONE, stencilResolve = VK_RESOLVE_MODE_NONE;
};

struct ScenePass {
    std::vector<SceneAttachment> colors;
    SceneAttachment depthStencil;  // image == kNone: none
    VkExtent2D extent{};           // render area from (0, 0)
    uint32_t viewMask = 0;         // not 0: every draw goes to each of these layers (VK_KHR_multiview)
    std::vector<SceneDraw> draws;
};

struct SceneGenerateMips {
    uint32_t image = kNone;  // level 0 to all others, each by a linear 2:1 blit of the one before
};

struct SceneCopyImage {
    uint32_t source = kNone, destination = kNone;
    VkImageCopy region{};
};

struct SceneBlitImage {
    uint32_t source = kNone, destination = kNone;
    VkImageBlit region{};
    VkFilter filter = VK_FILTER_NEAREST;
};

using SceneStep = std::variant<ScenePass, SceneGenerateMips, SceneCopyImage, SceneBlitImage>;

struct Scene {
    std::string name;         // file-name safe, e.g. "texture_bilinear"
    std::string description;  // one or two sentences for the report
    std::vector<SceneBuffer> buffers;
    std::vector<SceneImage> images;
    std::vector<SceneSampler> samplers;
    std::vector<SceneShader> shaders;
    std::vector<ScenePipeline> pipelines;
    std::vector<SceneStep> steps;
    std::vector<uint32_t>
        outputs;  // images read back at the end (level 0, layer 0, single-sampled), the main one first
    bool robustBufferAccess = false;  // shaders or indices reach outside of buffers: the feature must be on
};

// What a driver hands back for one output image: level 0, layer 0, rows tightly packed, texels in the image's
// format (for combined depth/stencil formats: the depth aspect, in the packing of vkCmdCopyImageToBuffer).
struct RenderedImage {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    Bytes texels;
};

}  // namespace vernier::conformance
