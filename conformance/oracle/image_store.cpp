#include "conformance/oracle/image_store.h"

#include "conformance/oracle/block_decode.h"
#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <span>
#include <string>

namespace vernier::conformance::exact {

namespace {

StoredTexel decodeStored(const PixelFormat& format, const std::byte* bytes) {
    StoredTexel texel;
    const std::array<double, 4> numbers = decodeTexel(format, bytes);
    for (size_t i = 0; i < 4; ++i) texel.channels[i] = numbers[i];
    return texel;
}

/// The format whose channels and precision stand for a block-compressed one.
const PixelFormat* decodedFormat(VkFormat format) {
    if (format >= VK_FORMAT_ASTC_4x4_UNORM_BLOCK && format <= VK_FORMAT_ASTC_12x12_SRGB_BLOCK) {
        const bool srgb = (format - VK_FORMAT_ASTC_4x4_UNORM_BLOCK) % 2 != 0;
        return findPixelFormat(srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R16G16B16A16_SFLOAT);
    }
    switch (format) {
        case VK_FORMAT_BC6H_UFLOAT_BLOCK:
        case VK_FORMAT_BC6H_SFLOAT_BLOCK:
            return findPixelFormat(VK_FORMAT_R16G16B16A16_SFLOAT);
        case VK_FORMAT_BC3_SRGB_BLOCK:
        case VK_FORMAT_BC7_SRGB_BLOCK:
            return findPixelFormat(VK_FORMAT_R8G8B8A8_SRGB);
        case VK_FORMAT_BC4_UNORM_BLOCK:
            return findPixelFormat(VK_FORMAT_R8_UNORM);
        case VK_FORMAT_BC4_SNORM_BLOCK:
            return findPixelFormat(VK_FORMAT_R8_SNORM);
        case VK_FORMAT_BC5_UNORM_BLOCK:
            return findPixelFormat(VK_FORMAT_R8G8_UNORM);
        case VK_FORMAT_BC5_SNORM_BLOCK:
            return findPixelFormat(VK_FORMAT_R8G8_SNORM);
        case VK_FORMAT_EAC_R11_UNORM_BLOCK:
            return findPixelFormat(VK_FORMAT_R16_UNORM);
        case VK_FORMAT_EAC_R11G11_UNORM_BLOCK:
            return findPixelFormat(VK_FORMAT_R16G16_UNORM);
        default:
            return findPixelFormat(VK_FORMAT_R8G8B8A8_UNORM);
    }
}

size_t levelBytes(VkFormat format, const PixelFormat& texel, VkExtent2D extent) {
    if (isDecodedBlockFormat(format)) {
        const VkExtent2D of = blockExtent(format);
        return size_t{(extent.width + of.width - 1) / of.width} * ((extent.height + of.height - 1) / of.height) *
               blockBytes(format);
    }
    return size_t{extent.width} * extent.height * texel.bytes;
}

/// Fills a level from its bytes, `first` bytes on; false when there are too few.
bool fillLevel(ImageLevel& level, VkFormat format, const PixelFormat& texel, const Bytes& data, size_t first) {
    const VkExtent2D extent = level.extent;
    if (isDecodedBlockFormat(format)) {
        const VkExtent2D of = blockExtent(format);
        const size_t columns = (extent.width + of.width - 1) / of.width, bytes = blockBytes(format);
        if (data.size() < first + levelBytes(format, texel, extent)) return false;
        for (uint32_t y = 0; y < extent.height; ++y) {
            for (uint32_t x = 0; x < extent.width; ++x) {
                const size_t block = first + (y / of.height * columns + x / of.width) * bytes;
                level.at(x, y).channels =
                    decodeBlockTexel(format, std::span(data).subspan(block, bytes), x % of.width, y % of.height);
            }
        }
        return true;
    }
    const size_t pixels = static_cast<size_t>(extent.width) * extent.height;
    if (data.size() < first + pixels * texel.bytes) return false;
    for (size_t i = 0; i < level.texels.size(); ++i)
        level.texels[i] = decodeStored(texel, data.data() + first + i / level.samples * texel.bytes);
    return true;
}

}  // namespace

Result<ImageStore> ImageStore::create(const SceneImage& image) {
    ImageStore store;
    store.format_ = isDecodedBlockFormat(image.format) ? decodedFormat(image.format) : findPixelFormat(image.format);
    if (!store.format_) {
        return unsupported("oracle: image '" + image.name + "' has format " + std::to_string(image.format) +
                           ", which is not in the oracle's table");
    }
    const bool cube = image.viewType == VK_IMAGE_VIEW_TYPE_CUBE || image.viewType == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    store.kind_ = image.viewType == VK_IMAGE_VIEW_TYPE_3D ? ImageKind::volume
                  : cube                                  ? ImageKind::cube
                                                          : ImageKind::flat;
    store.mipLevels_ = image.mipLevels;
    store.arrayLayers_ = image.arrayLayers;
    store.depth_ = image.depth;
    for (uint32_t mip = 0; mip < image.mipLevels; ++mip) {
        store.firstOfMip_.push_back(store.levels_.size());
        const uint32_t slices = store.depth(mip);
        for (uint32_t layer = 0; layer < image.arrayLayers * slices; ++layer) {
            ImageLevel level;
            level.extent = {std::max(1u, image.extent.width >> mip), std::max(1u, image.extent.height >> mip)};
            level.samples = image.samples;
            level.texels.resize(size_t{level.extent.width} * level.extent.height * level.samples);
            // All slices of a volume's level are one entry.
            const size_t index = size_t{mip} * image.arrayLayers + layer / slices;
            if (index < image.data.size() && !image.data[index].empty()) {
                const size_t bytes = levelBytes(image.format, *store.format_, level.extent);
                if (!fillLevel(level, image.format, *store.format_, image.data[index], layer % slices * bytes) ||
                    image.data[index].size() != bytes * slices) {
                    return invalidArgument("oracle: image '" + image.name + "', data[" + std::to_string(index) +
                                           "] has " + std::to_string(image.data[index].size()) + " bytes, not " +
                                           std::to_string(bytes * slices));
                }
            } else {
                for (StoredTexel& texel : level.texels) texel.flags = kOracleUnknown;
            }
            store.levels_.push_back(std::move(level));
        }
    }
    return store;
}

Color quantiseColor(const PixelFormat& format, const Color& color) {
    Color result{0.0, 0.0, 0.0, 1.0};
    for (const Component& component : format.all()) {
        result[component.channel] = quantise(component, color[component.channel]);
    }
    return result;
}

StoredTexel resolveSamples(const PixelFormat& format, const ImageLevel& source, uint32_t x, uint32_t y) {
    StoredTexel result = source.at(x, y, 0);
    const double count = source.samples;
    Color sum{}, encodedSum{};
    for (uint32_t s = 0; s < source.samples; ++s) {
        const StoredTexel& sample = source.at(x, y, s);
        result.flags |= sample.flags;
        for (size_t c = 0; c < 4; ++c) {
            const Interval& v = sample.channels[c];
            sum[c] = sum[c] + v;
            encodedSum[c] = encodedSum[c] + Interval(srgbEncode(v.value), srgbEncode(v.low), srgbEncode(v.high));
            if (format.isInteger()) result.channels[c] = result.channels[c].united(v);
        }
    }
    if (format.isInteger()) return result;
    for (const Component& component : format.all()) {
        const size_t c = component.channel;
        Interval average{sum[c].value / count, sum[c].low / count, sum[c].high / count};
        if (component.encoding == Encoding::srgb) {
            average =
                average.united({0, srgbDecode(encodedSum[c].low / count), srgbDecode(encodedSum[c].high / count)});
        }
        result.channels[c] = quantise(component, average);
    }
    return result;
}

StoredTexel resolveDepthStencil(const PixelFormat& format, const ImageLevel& source, uint32_t x, uint32_t y,
                                VkResolveModeFlagBits depthMode, VkResolveModeFlagBits stencilMode) {
    StoredTexel result = source.at(x, y, 0);
    const VkResolveModeFlagBits modes[] = {depthMode, stencilMode};
    for (size_t c = 0; c < 2; ++c) {
        Interval& into = result.channels[c];
        if (modes[c] == VK_RESOLVE_MODE_NONE) result.flags |= c == 0 || format.stencil ? kOracleUnknown : 0;
        for (uint32_t s = 1; s < source.samples; ++s) {
            const StoredTexel& sample = source.at(x, y, s);
            if (modes[c] == VK_RESOLVE_MODE_SAMPLE_ZERO_BIT || modes[c] == VK_RESOLVE_MODE_NONE) break;
            result.flags |= sample.flags;
            into = modes[c] == VK_RESOLVE_MODE_MIN_BIT   ? smaller(into, sample.channels[c])
                   : modes[c] == VK_RESOLVE_MODE_MAX_BIT ? larger(into, sample.channels[c])
                                                         : into + sample.channels[c];
        }
        if (modes[c] != VK_RESOLVE_MODE_AVERAGE_BIT) continue;
        const double count = source.samples;
        into = {into.value / count, into.low / count, into.high / count};
        if (c == 0 && format.depth) into = quantise(format.components[0], into, 1);
    }
    return result;
}

}  // namespace vernier::conformance::exact
