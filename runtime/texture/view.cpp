// Checks of views and samplers, and what can be asked of them without sampling.
#include <algorithm>
#include <string>

#include "runtime/texture/texture.h"

namespace vernier {
namespace {

std::string fieldError(const char* object, const char* field, uint64_t value, const char* rule) {
    return std::string(object) + "." + field + " is " + std::to_string(value) + ": " + rule;
}

bool isCube(VkImageViewType type) {
    return type == VK_IMAGE_VIEW_TYPE_CUBE || type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
}

bool isOneDimensional(VkImageViewType type) {
    return type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
}

Status checkLevel(const TextureView& view, const TextureLevel& level, uint32_t index) {
    const std::string name = "TextureView.levels[" + std::to_string(index) + "]";
    if (level.data == nullptr) return invalidArgument(name + ".data is null");
    const uint32_t sizes[3] = {level.width, level.height, level.depth};
    constexpr const char* kSizeNames[3] = {"width", "height", "depth"};
    for (int i = 0; i < 3; ++i) {
        if (sizes[i] >= 1 && sizes[i] <= kMaxTextureSize) continue;
        return invalidArgument(fieldError(name.c_str(), kSizeNames[i], sizes[i], "must be from 1 to 32768"));
    }
    if (isOneDimensional(view.type) && level.height != 1) {
        return invalidArgument(fieldError(name.c_str(), "height", level.height, "must be 1 in a 1D view"));
    }
    if (view.type != VK_IMAGE_VIEW_TYPE_3D && level.depth != 1) {
        return invalidArgument(fieldError(name.c_str(), "depth", level.depth, "must be 1 unless the view is 3D"));
    }
    if (isCube(view.type) && level.width != level.height) {
        return invalidArgument(fieldError(name.c_str(), "height", level.height, "must equal the width in a cube view"));
    }
    const FormatInfo& format = *findFormat(view.format);
    const uint64_t rowBytes = uint64_t{format.columns(level.width) - 1} * view.texelPitch + format.bytesPerTexel;
    const uint32_t rows = format.rows(level.height);
    if (rows > 1 && level.rowPitch < rowBytes) {
        return invalidArgument(fieldError(name.c_str(), "rowPitch", level.rowPitch, "must hold a row of texels"));
    }
    const uint64_t slices = view.type == VK_IMAGE_VIEW_TYPE_3D ? level.depth : view.layerCount;
    if (slices > 1 && level.slicePitch < uint64_t{rows - 1} * level.rowPitch + rowBytes) {
        return invalidArgument(
            fieldError(name.c_str(), "slicePitch", level.slicePitch, "must hold all rows of a slice"));
    }
    return {};
}

}  // namespace

SamplerState makeSamplerState(const VkSamplerCreateInfo& info) {
    SamplerState state;
    state.magFilter = info.magFilter;
    state.minFilter = info.minFilter;
    state.mipmapMode = info.mipmapMode;
    state.addressMode[0] = info.addressModeU;
    state.addressMode[1] = info.addressModeV;
    state.addressMode[2] = info.addressModeW;
    state.mipLodBias = info.mipLodBias;
    state.minLod = info.minLod;
    state.maxLod = info.maxLod;
    state.compareEnable = info.compareEnable == VK_TRUE;
    state.compareOp = info.compareOp;
    state.unnormalizedCoordinates = info.unnormalizedCoordinates == VK_TRUE;
    state.nonSeamlessCube = (info.flags & VK_SAMPLER_CREATE_NON_SEAMLESS_CUBE_MAP_BIT_EXT) != 0;
    if (info.anisotropyEnable == VK_TRUE) {
        state.maxAnisotropy = info.maxAnisotropy > 1.0f ? std::min(info.maxAnisotropy, kMaxSamplerAnisotropy) : 1.0f;
    }
    const bool customBorder =
        info.borderColor == VK_BORDER_COLOR_FLOAT_CUSTOM_EXT || info.borderColor == VK_BORDER_COLOR_INT_CUSTOM_EXT;
    for (auto* s = static_cast<const VkBaseInStructure*>(info.pNext); s != nullptr; s = s->pNext) {
        if (s->sType == VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT && customBorder) {
            state.borderColor = reinterpret_cast<const VkSamplerCustomBorderColorCreateInfoEXT*>(s)->customBorderColor;
        } else if (s->sType == VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO) {
            state.reduction = reinterpret_cast<const VkSamplerReductionModeCreateInfo*>(s)->reductionMode;
        }
    }
    switch (info.borderColor) {
        case VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK:
            state.borderColor = {.float32 = {0, 0, 0, 1}};
            break;
        case VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE:
            state.borderColor = {.float32 = {1, 1, 1, 1}};
            break;
        case VK_BORDER_COLOR_INT_OPAQUE_BLACK:
            state.borderColor = {.uint32 = {0, 0, 0, 1}};
            break;
        case VK_BORDER_COLOR_INT_OPAQUE_WHITE:
            state.borderColor = {.uint32 = {1, 1, 1, 1}};
            break;
        default:
            break;  // the two transparent blacks are zero; custom colours have been set
    }
    return state;
}

Status checkView(const TextureView& view) {
    const FormatInfo* const info = findFormat(view.format);
    if (info == nullptr) {
        return unsupported(fieldError("TextureView", "format", static_cast<uint32_t>(view.format), "unknown format"));
    }
    if ((info->optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) == 0) {
        return unsupported(std::string("TextureView.format is ") + info->name + ": cannot be sampled");
    }
    const bool oneAspect = view.aspect == VK_IMAGE_ASPECT_COLOR_BIT || view.aspect == VK_IMAGE_ASPECT_DEPTH_BIT ||
                           view.aspect == VK_IMAGE_ASPECT_STENCIL_BIT;
    if (!oneAspect || (info->aspects & view.aspect) == 0) {
        return invalidArgument(fieldError("TextureView", "aspect", view.aspect, "must be one aspect of the format"));
    }
    if (view.ops.unpackFn == nullptr || view.ops.layout.bytes != info->layout(view.aspect).bytes ||
        view.block != info->block) {
        return invalidArgument("TextureView.ops or TextureView.block is not that of TextureView.format");
    }
    if (view.type > VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) {
        return unsupported(fieldError("TextureView", "type", static_cast<uint32_t>(view.type), "unknown view type"));
    }
    if (view.levelCount < 1 || view.levelCount > kMaxTextureLevels) {
        return invalidArgument(fieldError("TextureView", "levelCount", view.levelCount, "must be from 1 to 16"));
    }
    if (view.layerCount < 1 || (isCube(view.type) && view.layerCount % 6 != 0)) {
        return invalidArgument(fieldError("TextureView", "layerCount", view.layerCount,
                                          isCube(view.type) ? "must be a multiple of 6" : "must not be 0"));
    }
    if (view.samples < 1 || view.texelPitch < info->bytesPerTexel) {
        return invalidArgument(fieldError("TextureView", "texelPitch", view.texelPitch, "must hold a texel"));
    }
    for (uint32_t i = 0; i < view.levelCount; ++i) {
        if (Status status = checkLevel(view, view.levels[i], i); !status) return status;
    }
    return {};
}

Status checkSampling(const TextureView& view, const SamplerState& sampler) {
    if (Status status = checkView(view); !status) return status;
    const FormatInfo& info = *findFormat(view.format);
    const bool linear = sampler.magFilter == VK_FILTER_LINEAR || sampler.minFilter == VK_FILTER_LINEAR ||
                        (sampler.mipmapMode == VK_SAMPLER_MIPMAP_MODE_LINEAR && view.levelCount > 1);
    if (view.samples != 1) {
        return invalidArgument(
            fieldError("TextureView", "samples", view.samples, "only fetches read multisampled images"));
    }
    for (const VkFilter filter : {sampler.magFilter, sampler.minFilter}) {
        if (filter == VK_FILTER_NEAREST || filter == VK_FILTER_LINEAR || filter == VK_FILTER_CUBIC_EXT) continue;
        return unsupported(fieldError("SamplerState", "magFilter/minFilter", static_cast<uint32_t>(filter),
                                      "only nearest, linear and cubic filters exist"));
    }
    const bool cubic = sampler.magFilter == VK_FILTER_CUBIC_EXT || sampler.minFilter == VK_FILTER_CUBIC_EXT;
    if (cubic && ((view.type != VK_IMAGE_VIEW_TYPE_2D && view.type != VK_IMAGE_VIEW_TYPE_2D_ARRAY) ||
                  (info.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT) == 0 ||
                  sampler.maxAnisotropy > 1 || sampler.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE)) {
        return unsupported(std::string("SamplerState asks for a cubic filter of ") + info.name +
                           ": only colours of 2D views have one, without anisotropy and reduction");
    }
    for (const VkSamplerAddressMode mode : sampler.addressMode) {
        if (mode <= VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE) continue;
        return unsupported(
            fieldError("SamplerState", "addressMode", static_cast<uint32_t>(mode), "unknown address mode"));
    }
    const bool filterable = (info.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0 &&
                            view.ops.layout.type == ValueType::floating;
    if (linear && !filterable) {
        return invalidArgument(std::string("SamplerState asks for linear filtering of ") + info.name +
                               ", which cannot be filtered");
    }
    if (sampler.compareEnable && view.aspect != VK_IMAGE_ASPECT_DEPTH_BIT) {
        return invalidArgument(std::string("SamplerState.compareEnable is set for ") + info.name +
                               ": only depth can be compared");
    }
    if (sampler.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE &&
        (sampler.reduction > VK_SAMPLER_REDUCTION_MODE_MAX || sampler.compareEnable)) {
        return invalidArgument(fieldError("SamplerState", "reduction", static_cast<uint32_t>(sampler.reduction),
                                          "must be one that exists, and an average when the sampler compares"));
    }
    if (sampler.unnormalizedCoordinates) {
        const bool flat = view.type == VK_IMAGE_VIEW_TYPE_1D || view.type == VK_IMAGE_VIEW_TYPE_2D;
        if (!flat || view.levelCount != 1 || sampler.magFilter != sampler.minFilter || sampler.compareEnable) {
            return invalidArgument(
                "SamplerState.unnormalizedCoordinates needs a 1D or 2D view of one level, equal filters "
                "and no comparison");
        }
    }
    return {};
}

std::array<uint32_t, 4> querySize(const TextureView& view, uint32_t level) {
    if (level >= view.levelCount) return {};
    const TextureLevel& l = view.levels[level];
    switch (view.type) {
        case VK_IMAGE_VIEW_TYPE_1D:
            return {l.width, 0, 0, 0};
        case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
            return {l.width, view.layerCount, 0, 0};
        case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
            return {l.width, l.height, view.layerCount, 0};
        case VK_IMAGE_VIEW_TYPE_3D:
            return {l.width, l.height, l.depth, 0};
        case VK_IMAGE_VIEW_TYPE_CUBE_ARRAY:
            return {l.width, l.height, view.layerCount / 6, 0};
        default:
            return {l.width, l.height, 0, 0};
    }
}

}  // namespace vernier
