#include "conformance/drivers/api_objects.h"

#include "conformance/drivers/try.h"
#include "conformance/scene/scene_format.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace vernier::conformance {
namespace {

/// The API's zero stands for a default: NEVER, which is Vulkan's zero, has a name of its own there.
VkCompareOp explicitCompare(VkCompareOp op) {
    return op == VK_COMPARE_OP_NEVER ? VN_COMPARE_OP_NEVER : op;
}

VnStencilFace stencilFace(const VkStencilOpState& state) {
    return {state.failOp,
            state.passOp,
            state.depthFailOp,
            explicitCompare(state.compareOp),
            ~state.compareMask & 0xff,
            ~state.writeMask & 0xff};
}

bool allFactorsZero(const VkPipelineColorBlendAttachmentState& state) {
    constexpr auto kZero = VK_BLEND_FACTOR_ZERO;
    return state.srcColorBlendFactor == kZero && state.dstColorBlendFactor == kZero &&
           state.srcAlphaBlendFactor == kZero && state.dstAlphaBlendFactor == kZero;
}

VnRasterStateDesc rasterState(const ScenePipeline& scene) {
    VnRasterStateDesc raster{};
    raster.polygonMode = scene.polygonMode;
    raster.cullMode = scene.cullMode;
    raster.frontFace = scene.frontFace;
    raster.lineWidth = scene.lineWidth;
    raster.depthClamp = scene.depthClamp;
    raster.depthClip = !scene.depthClip ? 0 : *scene.depthClip ? 1 : -1;
    raster.depthBias = scene.depthBias;
    raster.depthBiasConstant = scene.depthBiasConstant;
    raster.depthBiasSlope = scene.depthBiasSlope;
    raster.depthBiasClamp = scene.depthBiasClamp;
    raster.sampleMaskOff = ~scene.sampleMask;
    raster.alphaToCoverage = scene.alphaToCoverage;
    raster.alphaToOne = scene.alphaToOne;
    raster.minSampleShading = scene.sampleShading ? scene.minSampleShading : 0;
    raster.provokingVertexLast = scene.provokingVertexLast;
    raster.depthNegativeOneToOne = scene.depthNegativeOneToOne;
    raster.domainLowerLeft = scene.domainLowerLeft;
    raster.lineMode = scene.lineMode;
    raster.lineStippleFactor = scene.stippleFactor;
    raster.lineStipplePattern = scene.stipplePattern;
    raster.programmableSamples = !scene.sampleLocations.empty();
    for (size_t i = 0; i < scene.sampleLocations.size(); ++i) {
        std::copy_n(scene.sampleLocations[i].begin(), 2, std::begin(raster.sampleLocations[i]));
    }
    return raster;
}

VnDepthStencilStateDesc depthStencilState(const ScenePipeline& scene) {
    VnDepthStencilStateDesc depth{};
    depth.depthTest = scene.depthTest;
    depth.depthWrite = scene.depthTest && scene.depthWrite;  // Vulkan ignores the second without the first
    depth.depthCompare = explicitCompare(scene.depthCompare);
    depth.depthBoundsTest = scene.depthBoundsTest;
    depth.minDepth = scene.minDepthBounds;
    depth.maxDepth = scene.maxDepthBounds;
    depth.stencilTest = scene.stencilTest;
    depth.front = stencilFace(scene.front);
    depth.back = stencilFace(scene.back);
    return depth;
}

Result<VnBlendStateDesc> blendState(const ScenePipeline& scene) {
    VnBlendStateDesc blend{};
    blend.independent = 1;
    blend.logicOpEnable = scene.logicOpEnable;
    blend.logicOp = scene.logicOp;
    for (size_t i = 0; i < scene.blend.size(); ++i) {
        const VkPipelineColorBlendAttachmentState& from = scene.blend[i];
        if (from.blendEnable == VK_TRUE && allFactorsZero(from)) {
            return unsupported("blending with four factors ZERO cannot be said in the API");
        }
        blend.attachments[i] = {from.blendEnable == VK_TRUE, from.srcColorBlendFactor,  from.dstColorBlendFactor,
                                from.colorBlendOp,           from.srcAlphaBlendFactor,  from.dstAlphaBlendFactor,
                                from.alphaBlendOp,           ~from.colorWriteMask & 0xf};
    }
    return blend;
}

}  // namespace

Error apiError(VnDevice device, std::string_view call, VnResult result) {
    std::string text(device != nullptr ? vnGetError(device, nullptr, 0) : 0, '\0');
    if (!text.empty()) vnGetError(device, text.data(), text.size() + 1);
    const ErrorCode code = result == VN_ERROR_UNSUPPORTED     ? ErrorCode::unsupported
                           : result == VN_ERROR_OUT_OF_MEMORY ? ErrorCode::outOfDeviceMemory
                           : result == VN_ERROR_DEVICE_LOST   ? ErrorCode::deviceLost
                                                              : ErrorCode::invalidArgument;
    return {code, std::string(call.substr(0, call.find('('))) + ": VnResult " +
                      std::to_string(static_cast<int>(result)) + ": " + text};
}

ApiObjects::~ApiObjects() {
    for (const auto& [desc, view] : views_) vnDestroyView(device_, view);
    for (const ApiPipeline& pipeline : pipelines_) {
        vnDestroyProgram(device_, pipeline.program);
        vnDestroyVertexLayout(device_, pipeline.layout);
        vnDestroyRasterState(device_, pipeline.raster);
        vnDestroyDepthStencilState(device_, pipeline.depthStencil);
        vnDestroyBlendState(device_, pipeline.blend);
    }
    for (const VnShader shader : shaders_) vnDestroyShader(device_, shader);
    for (const VnSampler sampler : samplers_) vnDestroySampler(device_, sampler);
    for (const VnImage image : images_) vnDestroyImage(device_, image);
    for (const VnBuffer buffer : buffers_) vnDestroyBuffer(device_, buffer);
}

Status ApiObjects::createResources(const Scene& scene) {
    for (const SceneBuffer& each : scene.buffers) {
        VnBufferDesc desc{};
        desc.size = each.data.size();
        desc.data = each.data.data();
        VnBuffer buffer{};
        VERNIER_TRY_API(vnCreateBuffer(device_, &desc, &buffer));
        buffers_.push_back(buffer);
    }
    for (const SceneImage& each : scene.images) {
        if (Status status = createImage(each); !status) return status;
    }
    for (const SceneSampler& each : scene.samplers) {
        if (Status status = createSampler(each); !status) return status;
    }
    return {};
}

Status ApiObjects::createImage(const SceneImage& scene) {
    VnImageDesc desc{};
    desc.format = scene.format;
    desc.width = scene.extent.width;
    desc.height = scene.extent.height;
    desc.depth = scene.depth;
    switch (scene.viewType) {
        case VK_IMAGE_VIEW_TYPE_1D:
        case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
            desc.dimensions = 1;
            break;
        case VK_IMAGE_VIEW_TYPE_3D:
            desc.dimensions = 3;
            break;
        case VK_IMAGE_VIEW_TYPE_CUBE:
        case VK_IMAGE_VIEW_TYPE_CUBE_ARRAY:
            desc.cube = 1;
            break;
        default:
            break;
    }
    desc.mipLevels = scene.mipLevels;
    desc.layers = scene.arrayLayers;
    desc.samples = scene.samples;
    VnImage image{};
    VERNIER_TRY_API(vnCreateImage(device_, &desc, &image));
    images_.push_back(image);
    for (size_t i = 0; i < scene.data.size(); ++i) {
        if (scene.data[i].empty()) continue;
        VnRegion region{};
        region.mip = static_cast<uint32_t>(i / scene.arrayLayers);
        region.layer = static_cast<uint32_t>(i % scene.arrayLayers);
        VERNIER_TRY_API(vnUpdateImage(context_, image, &region, scene.data[i].data(), scene.data[i].size()));
    }
    return {};
}

Status ApiObjects::createSampler(const SceneSampler& scene) {
    // With a highest level of 0 Vulkan always magnifies; the API says it by a view of one level, which may
    // minify.
    if (scene.maxLod == 0 && scene.magFilter != scene.minFilter) {
        return unsupported("a sampler of maxLod 0 with two filters cannot be said in the API");
    }
    VnSamplerDesc desc{};
    desc.magFilter = scene.magFilter;
    desc.minFilter = scene.minFilter;
    desc.mipmapMode = scene.mipmapMode;
    desc.addressU = scene.addressModeU;
    desc.addressV = scene.addressModeV;
    desc.addressW = scene.addressModeW;
    desc.lodBias = scene.mipLodBias;
    desc.minLod = scene.minLod;
    desc.maxLod = scene.maxLod == VK_LOD_CLAMP_NONE ? 0 : scene.maxLod;
    desc.maxAnisotropy = scene.maxAnisotropy;
    desc.compareEnable = scene.compareEnable;
    desc.compareOp = scene.compareOp;
    desc.borderColor = scene.borderColor;
    std::copy(scene.customBorderColor.begin(), scene.customBorderColor.end(), desc.customBorderColor.float32);
    desc.reduction = scene.reduction;
    desc.unnormalized = scene.unnormalized;
    VnSampler sampler{};
    VERNIER_TRY_API(vnCreateSampler(device_, &desc, &sampler));
    samplers_.push_back(sampler);
    return {};
}

Status ApiObjects::createPipelines(const Scene& scene) {
    for (const SceneShader& each : scene.shaders) {
        if (Status status = createShader(each); !status) return status;
    }
    for (const ScenePipeline& each : scene.pipelines) {
        const Result<ApiPipeline> pipeline = createPipeline(each);
        if (!pipeline) return pipeline.error();
        pipelines_.push_back(pipeline.value());
    }
    return {};
}

Status ApiObjects::createShader(const SceneShader& scene) {
    std::vector<VnSpecialization> constants;
    for (const VkSpecializationMapEntry& entry : scene.specialization) {
        if (entry.size != sizeof(uint32_t)) {
            return unsupported("specialization constant " + std::to_string(entry.constantID) + " has " +
                               std::to_string(entry.size) + " bytes; the API takes 4");
        }
        VnSpecialization constant{entry.constantID, 0};
        std::memcpy(&constant.bits, scene.specializationData.data() + entry.offset, sizeof constant.bits);
        constants.push_back(constant);
    }
    VnShaderDesc desc{};
    desc.stage = scene.stage;
    desc.words = scene.spirv.data();
    desc.wordCount = scene.spirv.size();
    desc.specializations = constants.data();
    desc.specializationCount = static_cast<uint32_t>(constants.size());
    VnShader shader{};
    VERNIER_TRY_API(vnCreateShader(device_, &desc, &shader));
    shaders_.push_back(shader);
    return {};
}

Result<ApiPipeline> ApiObjects::createPipeline(const ScenePipeline& scene) {
    ApiPipeline pipeline;
    VnProgramDesc program{};
    program.vertex = shaders_[scene.vertexShader];
    if (scene.controlShader != kNone) program.control = shaders_[scene.controlShader];
    if (scene.evaluationShader != kNone) program.evaluation = shaders_[scene.evaluationShader];
    if (scene.geometryShader != kNone) program.geometry = shaders_[scene.geometryShader];
    if (scene.fragmentShader != kNone) program.fragment = shaders_[scene.fragmentShader];
    VERNIER_TRY_API(vnCreateProgram(device_, &program, &pipeline.program));
    VERNIER_TRY(createVertexLayout(scene, pipeline.layout));
    const VnRasterStateDesc raster = rasterState(scene);
    VERNIER_TRY_API(vnCreateRasterState(device_, &raster, &pipeline.raster));
    const VnDepthStencilStateDesc depth = depthStencilState(scene);
    VERNIER_TRY_API(vnCreateDepthStencilState(device_, &depth, &pipeline.depthStencil));
    const Result<VnBlendStateDesc> blend = blendState(scene);
    if (!blend) return blend.error();
    VERNIER_TRY_API(vnCreateBlendState(device_, &*blend, &pipeline.blend));
    return pipeline;
}

Status ApiObjects::createVertexLayout(const ScenePipeline& scene, VnVertexLayout& made) {
    std::vector<VnVertexBinding> bindings;
    for (const VkVertexInputBindingDescription& each : scene.vertexBindings) {
        if (bindings.size() <= each.binding) bindings.resize(each.binding + 1);
        bindings[each.binding] = {each.stride, each.inputRate == VK_VERTEX_INPUT_RATE_INSTANCE};
    }
    std::vector<VnVertexAttribute> attributes;
    for (const VkVertexInputAttributeDescription& each : scene.vertexAttributes) {
        attributes.push_back({each.location, each.binding, each.format, each.offset});
    }
    VnVertexLayoutDesc layout{};
    layout.attributes = attributes.data();
    layout.attributeCount = static_cast<uint32_t>(attributes.size());
    layout.bindings = bindings.data();
    layout.bindingCount = static_cast<uint32_t>(bindings.size());
    VERNIER_TRY_API(vnCreateVertexLayout(device_, &layout, &made));
    return {};
}

Result<VnView> ApiObjects::attachmentView(const Scene& scene, uint32_t image, uint32_t mipLevel, uint32_t layer,
                                          uint32_t layerCount) {
    VnViewDesc desc{};
    desc.image = images_[image];
    desc.aspect = sceneFormat(scene.images[image].format)->aspects;
    desc.baseMip = mipLevel;
    desc.mipCount = 1;
    desc.baseLayer = layer;
    desc.layerCount = layerCount;
    return view(desc);
}

Result<VnView> ApiObjects::sampledView(const Scene& scene, const SceneBinding& binding) {
    VnViewDesc desc{};
    desc.image = images_[binding.image];
    desc.mipCount = binding.sampler == kNone || scene.samplers[binding.sampler].maxLod == 0 ? 1 : 0;
    const VkImageViewType type = scene.images[binding.image].viewType;
    desc.array = type == VK_IMAGE_VIEW_TYPE_1D_ARRAY || type == VK_IMAGE_VIEW_TYPE_2D_ARRAY ||
                 type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    return view(desc);
}

Result<VnView> ApiObjects::view(const VnViewDesc& desc) {
    const auto known = std::find_if(views_.begin(), views_.end(), [&](const auto& each) {
        return each.first.image.id == desc.image.id && each.first.aspect == desc.aspect &&
               each.first.baseMip == desc.baseMip && each.first.mipCount == desc.mipCount &&
               each.first.baseLayer == desc.baseLayer && each.first.layerCount == desc.layerCount &&
               each.first.array == desc.array;
    });
    if (known != views_.end()) return known->second;
    VnView view{};
    VERNIER_TRY_API(vnCreateView(device_, &desc, &view));
    views_.emplace_back(desc, view);
    return view;
}

}  // namespace vernier::conformance
