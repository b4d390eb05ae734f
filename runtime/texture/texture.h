// Sampling: texel addressing, filtering, level of detail, comparison, for many lanes at a time. Follows the
// chapter "Image Operations" of the Vulkan specification; knows nothing of shaders or of the device.
//
// Choices where the specification leaves one:
//   derivatives   one pair per 2x2 quad: lane 1 - lane 0 and lane 2 - lane 0
//   rho           the longer of the two gradients (Euclidean length, in texels of the base level); log2
//   within 2^-13 nearest level ceil(lambda + 0.5) - 1, the preferred rule layer         rounded to nearest
//   even weights       full float precision; equal texels give that texel, bit for bit; a texel of weight 0
//   has no influence RGBA8/BGRA8 unorm filters codes and divides by 255 once; other formats filter decoded
//   values; sRGB before filtering border        replaces texels before the component swizzle, and enters
//   linear filters with its weight cube          ties of the largest axis: z, then y; texels beyond an edge
//   come from the neighbouring face, the one
//                 beyond a corner is the mean of the corner's three
//   anisotropy    N samples evenly along the longer gradient, N = ceil(min(longer / shorter, the sampler's maximum)),
//                 but at most ceil(longer gradient in texels of the base level); lambda = log2(longer / that ratio);
//                 integer formats and explicit levels of detail take one
//   reduction     minimum and maximum over the texels of the average that have a weight, of both levels
//   out of range  texel fetches outside the image give 0, with alpha 1 where the format has no alpha
//   huge, infinite or NaN coordinates give some texel of the image, never an access outside it
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/result.h"
#include "base/simd.h"
#include "runtime/format/format.h"
#include "runtime/format/multi_planar.h"

namespace vernier {

inline constexpr uint32_t kMaxTextureLevels = 16;  // 2^15 texels on a side
inline constexpr uint32_t kMaxTextureSize = 1u << 15;
inline constexpr uint32_t kMaxSampleLanes = 128;

struct TextureLevel {
    const std::byte* data = nullptr;            // texel (0, 0) of the view's first layer (z = 0 of a 3D image)
    uint32_t width = 1, height = 1, depth = 1;  // in texels, of this level
    uint32_t rowPitch = 0;                      // bytes from a row (of blocks, if compressed) to the next
    uint64_t slicePitch = 0;                    // bytes from an array layer, cube face or z slice to the next
};

struct PlanarView;

/// An image view, filled when it is written into a descriptor. Plain data; refers to the image's memory.
struct TextureView {
    VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;  // exactly one
    VkComponentMapping swizzle{};
    uint32_t levelCount = 1;
    uint32_t layerCount = 1;  // array layers of the view; 6 per cube
    uint32_t samples = 1;
    uint32_t texelPitch = 0;             // bytes from a texel to its right neighbour: bytesPerTexel unless samples are
                                         // interleaved; of a compressed format from a block to the next
    const BlockCodec* block = nullptr;   // of a compressed format
    uint64_t samplePitch = 0;            // bytes from a sample of a texel to the next
    const PlanarView* planar = nullptr;  // of all planes of a multi-planar format: the view itself is plane 0
    float minLod = 0;  // levels below are not sampled; a fetch of a level below floor(minLod) reads nothing
    std::array<TextureLevel, kMaxTextureLevels> levels;  // [0] is the view's base level
    FormatOps ops;  // formatOps(format, aspect, isa), the isa given to the select functions
};

/// VkSamplerYcbcrConversionCreateInfo.
struct YcbcrConversion {
    VkFormat format = VK_FORMAT_UNDEFINED;  // none: nothing is converted
    VkSamplerYcbcrModelConversion model = VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY;
    VkSamplerYcbcrRange range = VK_SAMPLER_YCBCR_RANGE_ITU_FULL;
    VkComponentMapping components{};
    VkChromaLocation xChromaOffset = VK_CHROMA_LOCATION_COSITED_EVEN;
    VkChromaLocation yChromaOffset = VK_CHROMA_LOCATION_COSITED_EVEN;
    VkFilter chromaFilter = VK_FILTER_NEAREST;
};

/// The fields of VkSamplerCreateInfo that matter here.
struct SamplerState {
    VkFilter magFilter = VK_FILTER_NEAREST;
    VkFilter minFilter = VK_FILTER_NEAREST;
    VkSamplerMipmapMode mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    VkSamplerAddressMode addressMode[3] = {};  // U, V, W
    float mipLodBias = 0;
    float minLod = 0;
    float maxLod = VK_LOD_CLAMP_NONE;
    bool compareEnable = false;
    VkCompareOp compareOp = VK_COMPARE_OP_ALWAYS;
    VkClearColorValue borderColor{};
    bool unnormalizedCoordinates = false;
    float maxAnisotropy = 1;  // more than 1: anisotropic filtering; at most kMaxSamplerAnisotropy
    VkSamplerReductionMode reduction = VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
    YcbcrConversion ycbcr;
    bool nonSeamlessCube = false;  // the faces of a cube are wrapped by the address modes, as if each were alone
};

inline constexpr float kMaxSamplerLodBias = 15.0f;     // limits.maxSamplerLodBias
inline constexpr float kMaxSamplerAnisotropy = 16.0f;  // limits.maxSamplerAnisotropy

/// With the structures of its pNext chain: custom border colour, reduction mode. A custom border colour without its
/// structure is zero.
SamplerState makeSamplerState(const VkSamplerCreateInfo& info);

enum class LodMode : uint8_t {
    implicitLod,  // from the derivatives of coord over quads, plus `lod` as a bias when it is not null
    explicitLod,  // `lod`
    gradients,    // gradX, gradY
    base,         // level of detail 0 before the sampler's clamp: lambda = 0
};

/// One sampling instruction for up to kMaxSampleLanes lanes. Lanes 4q .. 4q+3 are the pixels (0,0), (1,0),
/// (0,1), (1,1) of a quad. Every array has `lanes` values. Plain data.
struct SampleRequest {
    uint32_t lanes = 0;              // a multiple of 4
    const uint32_t* mask = nullptr;  // 0 or ~0 per lane, null = all active; out of inactive lanes is unspecified
    const float* coord[4] = {};      // s, t, r, layer; null = 0
    const float* dref = nullptr;     // comparison value, read when the sampler compares; null = 0
    LodMode lodMode = LodMode::implicitLod;
    const float* lod = nullptr;
    const float* minLod = nullptr;  // bounds the level of detail from below, as the sampler's does; null = no bound
    const float* gradX[3] = {};     // null = 0
    const float* gradY[3] = {};
    int32_t offset[3] = {};  // texels
    uint32_t component = 0;  // gather: 0..3, after the view's swizzle has its say
    // Receives floats, or the bits of uint32/int32 values for integer formats; null = not wanted. A
    // comparison gives its result in out[0] alone (gather: in all four). May be the arrays of coordinates or of dref.
    float* out[4] = {};
};

using SampleFn = void (*)(const TextureView&, const SamplerState&, const SampleRequest&);

/// A texel fetch (OpImageFetch) for up to kMaxSampleLanes lanes.
struct FetchRequest {
    uint32_t lanes = 0;
    const uint32_t* mask = nullptr;
    const int32_t* coord[4] = {};     // x, y, z, layer; of cubes the face counts as the layer
    const int32_t* lod = nullptr;     // null = 0
    const int32_t* sample = nullptr;  // null = 0
    int32_t offset[3] = {};
    float* out[4] = {};
};

using FetchFn = void (*)(const TextureView&, const FetchRequest&);

/// The planes of a view of a multi-planar format, each a 2D view of one level and layer.
struct PlanarView {
    const MultiPlanarFormat* format = nullptr;
    std::array<TextureView, kMaxPlanes> planes;
    SampleFn queryLod = nullptr;  // selectQueryLod() of plane 0
};

/// What of a view and a sampler cannot be sampled, in words. Call when a descriptor is written.
Status checkView(const TextureView& view);
Status checkSampling(const TextureView& view, const SamplerState& sampler);

// Resolve once per descriptor. The view and the sampler passed to the function later must equal the ones it
// was chosen for, and have passed the checks above.
SampleFn selectSampler(const TextureView& view, const SamplerState& sampler, Isa isa);
/// textureGather: `component` of the four texels of the linear footprint at the level of detail that lodMode
/// gives (normally LodMode::base), in the order (0,1), (1,1), (1,0), (0,0).
SampleFn selectGather(const TextureView& view, const SamplerState& sampler, Isa isa);
FetchFn selectFetch(const TextureView& view, Isa isa);

/// OpImageQueryLod: out[0] = the level that would be accessed, out[1] = lambda prime before the sampler's
/// clamp.
SampleFn selectQueryLod(const TextureView& view, const SamplerState& sampler, Isa isa);

/// OpImageQuerySizeLod: width, height, depth in texels as far as the view type has them, then array layers
/// (cubes for cube arrays); unused ones are 0. Levels that do not exist have size 0.
std::array<uint32_t, 4> querySize(const TextureView& view, uint32_t level);

}  // namespace vernier
