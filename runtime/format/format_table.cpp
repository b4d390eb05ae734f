// The table of formats: the tables of "Required Format Support" in the Vulkan specification, plus what comes for free
// with the general conversions.
#include <algorithm>
#include <array>

#include "runtime/format/format.h"

namespace vernier {
namespace {

using enum ComponentKind;

/// Where the components lie, the same for all numeric kinds.
struct Shape {
    uint8_t bytes;
    bool packed;
    struct {
        uint8_t bits, offset;
    } rgba[4];
};

constexpr Shape kR8{1, false, {{8, 0}}};
constexpr Shape kRg8{2, false, {{8, 0}, {8, 8}}};
constexpr Shape kRgb8{3, false, {{8, 0}, {8, 8}, {8, 16}}};
constexpr Shape kBgr8{3, false, {{8, 16}, {8, 8}, {8, 0}}};
constexpr Shape kRgba8{4, false, {{8, 0}, {8, 8}, {8, 16}, {8, 24}}};
constexpr Shape kBgra8{4, false, {{8, 16}, {8, 8}, {8, 0}, {8, 24}}};
constexpr Shape kAbgr8Pack32{4, true, {{8, 0}, {8, 8}, {8, 16}, {8, 24}}};
constexpr Shape kR16{2, false, {{16, 0}}};
constexpr Shape kRg16{4, false, {{16, 0}, {16, 16}}};
constexpr Shape kRgb16{6, false, {{16, 0}, {16, 16}, {16, 32}}};
constexpr Shape kRgba16{8, false, {{16, 0}, {16, 16}, {16, 32}, {16, 48}}};
constexpr Shape kR32{4, false, {{32, 0}}};
constexpr Shape kRg32{8, false, {{32, 0}, {32, 32}}};
constexpr Shape kRgb32{12, false, {{32, 0}, {32, 32}, {32, 64}}};
constexpr Shape kRgba32{16, false, {{32, 0}, {32, 32}, {32, 64}, {32, 96}}};
// Decoded blocks of formats without A: its place is there, but nothing reads it.
constexpr Shape kRgbx8{4, false, {{8, 0}, {8, 8}, {8, 16}}};
constexpr Shape kRgbx16{8, false, {{16, 0}, {16, 16}, {16, 32}}};
constexpr Shape kRgbx32{16, false, {{32, 0}, {32, 32}, {32, 64}}};
constexpr Shape kRgba4{2, true, {{4, 12}, {4, 8}, {4, 4}, {4, 0}}};
constexpr Shape kBgra4{2, true, {{4, 4}, {4, 8}, {4, 12}, {4, 0}}};
constexpr Shape kArgb4{2, true, {{4, 8}, {4, 4}, {4, 0}, {4, 12}}};
constexpr Shape kAbgr4{2, true, {{4, 0}, {4, 4}, {4, 8}, {4, 12}}};
constexpr Shape kR5g6b5{2, true, {{5, 11}, {6, 5}, {5, 0}}};
constexpr Shape kB5g6r5{2, true, {{5, 0}, {6, 5}, {5, 11}}};
constexpr Shape kRgb5a1{2, true, {{5, 11}, {5, 6}, {5, 1}, {1, 0}}};
constexpr Shape kBgr5a1{2, true, {{5, 1}, {5, 6}, {5, 11}, {1, 0}}};
constexpr Shape kA1rgb5{2, true, {{5, 10}, {5, 5}, {5, 0}, {1, 15}}};
constexpr Shape kA2rgb10{4, true, {{10, 20}, {10, 10}, {10, 0}, {2, 30}}};
constexpr Shape kA2bgr10{4, true, {{10, 0}, {10, 10}, {10, 20}, {2, 30}}};
constexpr Shape kB10gr11{4, true, {{11, 0}, {11, 11}, {10, 22}}};
constexpr Shape kE5bgr9{4, true, {{9, 0}, {9, 9}, {9, 18}}};

struct Uses {
    VkFormatFeatureFlags image, buffer;
};

constexpr VkFormatFeatureFlags kReadable = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_BLIT_SRC_BIT |
                                           VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
constexpr VkFormatFeatureFlags kTarget = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
constexpr VkFormatFeatureFlags kFiltered = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                           VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_MINMAX_BIT |
                                           VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT;
constexpr VkFormatFeatureFlags kBlend = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
constexpr VkFormatFeatureFlags kStorage = VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
constexpr VkFormatFeatureFlags kVertex = VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT;
constexpr VkFormatFeatureFlags kTexelBuffer = VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT;
constexpr VkFormatFeatureFlags kStorageBuffer = VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT;
constexpr VkFormatFeatureFlags kBuffer = kVertex | kTexelBuffer;

constexpr Uses kVertexOnly{0, kVertex};
constexpr Uses kBufferOnly{0, kBuffer};
constexpr Uses kTexelsOnly{0, kTexelBuffer};
constexpr Uses kTexture{kReadable | kFiltered, kBuffer};
constexpr Uses kColor{kReadable | kFiltered | kTarget | kBlend, kBuffer};
constexpr Uses kColorSrgb{kColor.image, kTexelBuffer};
constexpr Uses kColorStorage{kColor.image | kStorage, kBuffer | kStorageBuffer};
constexpr Uses kInteger{kReadable | kTarget, kBuffer};
constexpr Uses kIntegerTexture{kReadable, kBuffer};
constexpr Uses kIntegerStorage{kInteger.image | kStorage, kBuffer | kStorageBuffer};
constexpr Uses kIntegerAtomic{kIntegerStorage.image | VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT,
                              kIntegerStorage.buffer | VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_ATOMIC_BIT};
constexpr Uses kColorAtomic{kColorStorage.image | VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT,
                            kColorStorage.buffer | VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_ATOMIC_BIT};
constexpr VkFormatFeatureFlags kDepthStencil =
    kReadable | VK_FORMAT_FEATURE_BLIT_DST_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;

constexpr ValueType valueType(ComponentKind kind) {
    return kind == uint ? ValueType::uint : kind == sint ? ValueType::sint : ValueType::floating;
}

constexpr FormatInfo colorFormat(VkFormat format, const char* name, const Shape& shape, ComponentKind kind, Uses uses) {
    FormatInfo info{};
    info.format = format;
    info.name = name;
    info.bytesPerTexel = shape.bytes;
    info.packed = shape.packed;
    info.aspects = VK_IMAGE_ASPECT_COLOR_BIT;
    info.color.bytes = shape.bytes;
    info.color.type = valueType(kind);
    info.color.sharedExponent = format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
    for (int c = 0; c < 4; ++c) {
        const auto& place = shape.rgba[c];
        if (place.bits == 0) continue;
        ++info.componentCount;
        info.color.rgba[c] = {place.bits, place.offset, kind == srgb && c == 3 ? unorm : kind};
    }
    info.optimalTilingFeatures = uses.image;
    info.linearTilingFeatures = uses.image;  // all images are rows of texels
    info.bufferFeatures = uses.buffer;
    return info;
}

constexpr FormatInfo blockFormat(VkFormat format, const char* name, const BlockCodec& codec, const Shape& shape,
                                 ComponentKind kind) {
    FormatInfo info = colorFormat(codec.decoded, name, shape, kind, Uses{kReadable | kFiltered, 0});
    info.format = format;
    info.bytesPerTexel = codec.bytes;
    info.linearTilingFeatures = 0;
    info.block = &codec;
    return info;
}

constexpr FormatInfo depthStencilFormat(VkFormat format, const char* name, uint8_t bytes, Component depth,
                                        Component stencil, bool packed) {
    FormatInfo info{};
    info.format = format;
    info.name = name;
    info.bytesPerTexel = bytes;
    info.packed = packed;
    const bool both = depth.bits != 0 && stencil.bits != 0;
    info.componentCount = both ? 2 : 1;
    info.optimalTilingFeatures = kDepthStencil;
    if (depth.bits != 0) {
        info.aspects |= VK_IMAGE_ASPECT_DEPTH_BIT;
        info.depth = {.bytes = bytes, .keepOtherBits = both, .type = ValueType::floating, .rgba = {depth}};
        info.optimalTilingFeatures |= kFiltered;
    }
    if (stencil.bits != 0) {
        info.aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
        info.stencil = {.bytes = bytes, .keepOtherBits = both, .type = ValueType::uint, .rgba = {stencil}};
    }
    return info;
}

#define COLOR(NAME, SHAPE, KIND, USES) colorFormat(VK_FORMAT_##NAME, #NAME, SHAPE, KIND, USES)
#define SCALED(NAME, SHAPE, SUFFIX)                             \
    COLOR(NAME##_USCALED##SUFFIX, SHAPE, uscaled, kVertexOnly), \
        COLOR(NAME##_SSCALED##SUFFIX, SHAPE, sscaled, kVertexOnly)
#define NORM(NAME, SHAPE, SUFFIX, UNORM_USES, SNORM_USES)                                                         \
    COLOR(NAME##_UNORM##SUFFIX, SHAPE, unorm, UNORM_USES), COLOR(NAME##_SNORM##SUFFIX, SHAPE, snorm, SNORM_USES), \
        SCALED(NAME, SHAPE, SUFFIX)
#define INT(NAME, SHAPE, SUFFIX, USES) \
    COLOR(NAME##_UINT##SUFFIX, SHAPE, uint, USES), COLOR(NAME##_SINT##SUFFIX, SHAPE, sint, USES)
constexpr Component part(uint8_t bits, uint8_t offset, ComponentKind kind) {
    return {bits, offset, kind};
}
constexpr Component kNoPart{};

#define DEPTH_STENCIL(NAME, BYTES, DEPTH, STENCIL, PACKED) \
    depthStencilFormat(VK_FORMAT_##NAME, #NAME, BYTES, DEPTH, STENCIL, PACKED)

// What blocks decode to: a format, and the shape and kind of its components that count.
#define VERNIER_R32F VK_FORMAT_R32_SFLOAT, kR32, sfloat
#define VERNIER_RG32F VK_FORMAT_R32G32_SFLOAT, kRg32, sfloat
#define VERNIER_RGBX32F VK_FORMAT_R32G32B32A32_SFLOAT, kRgbx32, sfloat
#define VERNIER_RGBA32F VK_FORMAT_R32G32B32A32_SFLOAT, kRgba32, sfloat
#define VERNIER_RGBX16F VK_FORMAT_R16G16B16A16_SFLOAT, kRgbx16, sfloat
#define VERNIER_RGBA16F VK_FORMAT_R16G16B16A16_SFLOAT, kRgba16, sfloat
#define VERNIER_RGBX8 VK_FORMAT_R8G8B8A8_UNORM, kRgbx8, unorm
#define VERNIER_RGBX8S VK_FORMAT_R8G8B8A8_SRGB, kRgbx8, srgb
#define VERNIER_RGBA8 VK_FORMAT_R8G8B8A8_UNORM, kRgba8, unorm
#define VERNIER_RGBA8S VK_FORMAT_R8G8B8A8_SRGB, kRgba8, srgb

// X(name, width, height, bytes, decoded, decoder), in the order of the format numbers.
#define VERNIER_BLOCK_FORMATS(X)                                           \
    X(BC1_RGB_UNORM_BLOCK, 4, 4, 8, VERNIER_RGBX32F, decodeBc1Rgb)         \
    X(BC1_RGB_SRGB_BLOCK, 4, 4, 8, VERNIER_RGBX32F, decodeBc1RgbSrgb)      \
    X(BC1_RGBA_UNORM_BLOCK, 4, 4, 8, VERNIER_RGBA32F, decodeBc1Rgba)       \
    X(BC1_RGBA_SRGB_BLOCK, 4, 4, 8, VERNIER_RGBA32F, decodeBc1RgbaSrgb)    \
    X(BC2_UNORM_BLOCK, 4, 4, 16, VERNIER_RGBA32F, decodeBc2)               \
    X(BC2_SRGB_BLOCK, 4, 4, 16, VERNIER_RGBA32F, decodeBc2Srgb)            \
    X(BC3_UNORM_BLOCK, 4, 4, 16, VERNIER_RGBA32F, decodeBc3)               \
    X(BC3_SRGB_BLOCK, 4, 4, 16, VERNIER_RGBA32F, decodeBc3Srgb)            \
    X(BC4_UNORM_BLOCK, 4, 4, 8, VERNIER_R32F, decodeBc4Unorm)              \
    X(BC4_SNORM_BLOCK, 4, 4, 8, VERNIER_R32F, decodeBc4Snorm)              \
    X(BC5_UNORM_BLOCK, 4, 4, 16, VERNIER_RG32F, decodeBc5Unorm)            \
    X(BC5_SNORM_BLOCK, 4, 4, 16, VERNIER_RG32F, decodeBc5Snorm)            \
    X(BC6H_UFLOAT_BLOCK, 4, 4, 16, VERNIER_RGBX16F, decodeBc6Ufloat)       \
    X(BC6H_SFLOAT_BLOCK, 4, 4, 16, VERNIER_RGBX16F, decodeBc6Sfloat)       \
    X(BC7_UNORM_BLOCK, 4, 4, 16, VERNIER_RGBA8, decodeBc7)                 \
    X(BC7_SRGB_BLOCK, 4, 4, 16, VERNIER_RGBA8S, decodeBc7)                 \
    X(ETC2_R8G8B8_UNORM_BLOCK, 4, 4, 8, VERNIER_RGBX8, decodeEtc2Rgb)      \
    X(ETC2_R8G8B8_SRGB_BLOCK, 4, 4, 8, VERNIER_RGBX8S, decodeEtc2Rgb)      \
    X(ETC2_R8G8B8A1_UNORM_BLOCK, 4, 4, 8, VERNIER_RGBA8, decodeEtc2RgbA1)  \
    X(ETC2_R8G8B8A1_SRGB_BLOCK, 4, 4, 8, VERNIER_RGBA8S, decodeEtc2RgbA1)  \
    X(ETC2_R8G8B8A8_UNORM_BLOCK, 4, 4, 16, VERNIER_RGBA8, decodeEtc2Rgba)  \
    X(ETC2_R8G8B8A8_SRGB_BLOCK, 4, 4, 16, VERNIER_RGBA8S, decodeEtc2Rgba)  \
    X(EAC_R11_UNORM_BLOCK, 4, 4, 8, VERNIER_R32F, decodeEacR11Unorm)       \
    X(EAC_R11_SNORM_BLOCK, 4, 4, 8, VERNIER_R32F, decodeEacR11Snorm)       \
    X(EAC_R11G11_UNORM_BLOCK, 4, 4, 16, VERNIER_RG32F, decodeEacRg11Unorm) \
    X(EAC_R11G11_SNORM_BLOCK, 4, 4, 16, VERNIER_RG32F, decodeEacRg11Snorm) \
    VERNIER_ASTC_FORMAT(X, 4, 4)                                           \
    VERNIER_ASTC_FORMAT(X, 5, 4)                                           \
    VERNIER_ASTC_FORMAT(X, 5, 5)                                           \
    VERNIER_ASTC_FORMAT(X, 6, 5)                                           \
    VERNIER_ASTC_FORMAT(X, 6, 6)                                           \
    VERNIER_ASTC_FORMAT(X, 8, 5)                                           \
    VERNIER_ASTC_FORMAT(X, 8, 6)                                           \
    VERNIER_ASTC_FORMAT(X, 8, 8)                                           \
    VERNIER_ASTC_FORMAT(X, 10, 5)                                          \
    VERNIER_ASTC_FORMAT(X, 10, 6)                                          \
    VERNIER_ASTC_FORMAT(X, 10, 8)                                          \
    VERNIER_ASTC_FORMAT(X, 10, 10)                                         \
    VERNIER_ASTC_FORMAT(X, 12, 10)                                         \
    VERNIER_ASTC_FORMAT(X, 12, 12)
#define VERNIER_ASTC_FORMAT(X, W, H)                                                      \
    X(ASTC_##W##x##H##_UNORM_BLOCK, W, H, 16, VERNIER_RGBA16F, (decodeAstc<W, H, false>)) \
    X(ASTC_##W##x##H##_SRGB_BLOCK, W, H, 16, VERNIER_RGBA32F, (decodeAstc<W, H, true>))

#define VERNIER_CODEC_OF(NAME, W, H, BYTES, DECODED, SHAPE, KIND, DECODER) \
    constexpr BlockCodec k##NAME{W, H, BYTES, DECODED, DECODER};
#define VERNIER_BLOCK_CODEC(...) VERNIER_CODEC_OF(__VA_ARGS__)
VERNIER_BLOCK_FORMATS(VERNIER_BLOCK_CODEC)
#define VERNIER_ROW_OF(NAME, W, H, BYTES, DECODED, SHAPE, KIND, DECODER) \
    blockFormat(VK_FORMAT_##NAME, #NAME, k##NAME, SHAPE, KIND),
#define VERNIER_BLOCK_ROW(...) VERNIER_ROW_OF(__VA_ARGS__)

constexpr std::array kPlainFormats{
    COLOR(R4G4B4A4_UNORM_PACK16, kRgba4, unorm, kColor),
    COLOR(B4G4R4A4_UNORM_PACK16, kBgra4, unorm, kColor),
    COLOR(A4R4G4B4_UNORM_PACK16, kArgb4, unorm, kColor),
    COLOR(A4B4G4R4_UNORM_PACK16, kAbgr4, unorm, kColor),
    COLOR(R5G6B5_UNORM_PACK16, kR5g6b5, unorm, kColor),
    COLOR(B5G6R5_UNORM_PACK16, kB5g6r5, unorm, kColor),
    COLOR(R5G5B5A1_UNORM_PACK16, kRgb5a1, unorm, kColor),
    COLOR(B5G5R5A1_UNORM_PACK16, kBgr5a1, unorm, kColor),
    COLOR(A1R5G5B5_UNORM_PACK16, kA1rgb5, unorm, kColor),
    NORM(R8, kR8, , kColorStorage, kColorStorage),
    INT(R8, kR8, , kIntegerStorage),
    COLOR(R8_SRGB, kR8, srgb, kColorSrgb),
    NORM(R8G8, kRg8, , kColorStorage, kColorStorage),
    INT(R8G8, kRg8, , kIntegerStorage),
    COLOR(R8G8_SRGB, kRg8, srgb, kColorSrgb),
    NORM(R8G8B8, kRgb8, , kBufferOnly, kBufferOnly),
    INT(R8G8B8, kRgb8, , kBufferOnly),
    NORM(B8G8R8, kBgr8, , kBufferOnly, kBufferOnly),
    INT(B8G8R8, kBgr8, , kBufferOnly),
    COLOR(R8G8B8_SRGB, kRgb8, srgb, kTexelsOnly),
    COLOR(B8G8R8_SRGB, kBgr8, srgb, kTexelsOnly),
    NORM(R8G8B8A8, kRgba8, , kColorStorage, kColorStorage),
    INT(R8G8B8A8, kRgba8, , kIntegerStorage),
    COLOR(R8G8B8A8_SRGB, kRgba8, srgb, kColorSrgb),
    NORM(B8G8R8A8, kBgra8, , kColorStorage, kColorStorage),
    INT(B8G8R8A8, kBgra8, , kIntegerStorage),
    COLOR(B8G8R8A8_SRGB, kBgra8, srgb, kColorSrgb),
    NORM(A8B8G8R8, kAbgr8Pack32, _PACK32, kColorStorage, kColorStorage),
    INT(A8B8G8R8, kAbgr8Pack32, _PACK32, kIntegerStorage),
    COLOR(A8B8G8R8_SRGB_PACK32, kAbgr8Pack32, srgb, kColorSrgb),
    NORM(A2R10G10B10, kA2rgb10, _PACK32, kColor, kColor),
    INT(A2R10G10B10, kA2rgb10, _PACK32, kInteger),
    NORM(A2B10G10R10, kA2bgr10, _PACK32, kColorStorage, kColor),
    INT(A2B10G10R10, kA2bgr10, _PACK32, kIntegerStorage),
    NORM(R16, kR16, , kColorStorage, kColorStorage),
    INT(R16, kR16, , kIntegerStorage),
    COLOR(R16_SFLOAT, kR16, sfloat, kColorStorage),
    NORM(R16G16, kRg16, , kColorStorage, kColorStorage),
    INT(R16G16, kRg16, , kIntegerStorage),
    COLOR(R16G16_SFLOAT, kRg16, sfloat, kColorStorage),
    NORM(R16G16B16, kRgb16, , kBufferOnly, kBufferOnly),
    INT(R16G16B16, kRgb16, , kBufferOnly),
    COLOR(R16G16B16_SFLOAT, kRgb16, sfloat, kBufferOnly),
    NORM(R16G16B16A16, kRgba16, , kColorStorage, kColorStorage),
    INT(R16G16B16A16, kRgba16, , kIntegerStorage),
    COLOR(R16G16B16A16_SFLOAT, kRgba16, sfloat, kColorStorage),
    INT(R32, kR32, , kIntegerAtomic),
    COLOR(R32_SFLOAT, kR32, sfloat, kColorAtomic),
    INT(R32G32, kRg32, , kIntegerStorage),
    COLOR(R32G32_SFLOAT, kRg32, sfloat, kColorStorage),
    INT(R32G32B32, kRgb32, , kIntegerTexture),
    COLOR(R32G32B32_SFLOAT, kRgb32, sfloat, kTexture),
    INT(R32G32B32A32, kRgba32, , kIntegerStorage),
    COLOR(R32G32B32A32_SFLOAT, kRgba32, sfloat, kColorStorage),
    COLOR(B10G11R11_UFLOAT_PACK32, kB10gr11, ufloat, kColorStorage),
    COLOR(E5B9G9R9_UFLOAT_PACK32, kE5bgr9, ufloat, kTexture),
    DEPTH_STENCIL(D16_UNORM, 2, part(16, 0, unorm), kNoPart, false),
    DEPTH_STENCIL(X8_D24_UNORM_PACK32, 4, part(24, 0, unorm), kNoPart, true),
    DEPTH_STENCIL(D32_SFLOAT, 4, part(32, 0, sfloat), kNoPart, false),
    DEPTH_STENCIL(S8_UINT, 1, kNoPart, part(8, 0, uint), false),
    DEPTH_STENCIL(D24_UNORM_S8_UINT, 4, part(24, 0, unorm), part(8, 24, uint), false),
    DEPTH_STENCIL(D32_SFLOAT_S8_UINT, 8, part(32, 0, sfloat), part(8, 32, uint), false),
};

constexpr std::array kBlockFormats{VERNIER_BLOCK_FORMATS(VERNIER_BLOCK_ROW)};

constexpr auto kFormats = [] {
    std::array<FormatInfo, kPlainFormats.size() + kBlockFormats.size()> all{};
    std::copy(kPlainFormats.begin(), kPlainFormats.end(), all.begin());
    std::copy(kBlockFormats.begin(), kBlockFormats.end(), all.begin() + kPlainFormats.size());
    return all;
}();
static_assert(kFormats.size() < 256);

constexpr size_t kHighestFormat = VK_FORMAT_ASTC_12x12_SRGB_BLOCK;

/// Where a format's place in kIndex is: those of extensions follow those of Vulkan 1.0.
constexpr size_t slotOf(uint32_t number) {
    if (number <= kHighestFormat) return number;
    if (number == VK_FORMAT_A4R4G4B4_UNORM_PACK16) return kHighestFormat + 1;
    if (number == VK_FORMAT_A4B4G4R4_UNORM_PACK16) return kHighestFormat + 2;
    return 0;  // VK_FORMAT_UNDEFINED
}

/// Index into kFormats plus one; 0 = absent.
constexpr auto kIndex = [] {
    std::array<uint8_t, kHighestFormat + 3> index{};
    for (size_t i = 0; i < kFormats.size(); ++i) {
        index[slotOf(static_cast<uint32_t>(kFormats[i].format))] = static_cast<uint8_t>(i + 1);
    }
    return index;
}();

}  // namespace

const FormatInfo* findFormat(VkFormat format) {
    const uint8_t index = kIndex[slotOf(static_cast<uint32_t>(format))];
    return index == 0 ? nullptr : &kFormats[index - 1u];
}

FormatRange allFormats() {
    return {kFormats.data(), kFormats.data() + kFormats.size()};
}

VkImageAspectFlags defaultAspect(const FormatInfo& info) {
    if ((info.aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) return VK_IMAGE_ASPECT_DEPTH_BIT;
    return info.aspects;
}

}  // namespace vernier
