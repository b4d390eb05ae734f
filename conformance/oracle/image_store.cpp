#include "conformance/oracle/image_store.h"

#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <string>

namespace vernier::conformance::exact {

namespace {

StoredTexel decodeStored(const PixelFormat& format, const std::byte* bytes) {
    StoredTexel texel;
    const std::array<double, 4> numbers = decodeTexel(format, bytes);
    for (size_t i = 0; i < 4; ++i) texel.channels[i] = numbers[i];
    return texel;
}

}  // namespace

Result<ImageStore> ImageStore::create(const SceneImage& image) {
    ImageStore store;
    store.format_ = findPixelFormat(image.format);
    if (!store.format_) {
        return unsupported("oracle: image '" + image.name + "' has format " + std::to_string(image.format) +
                           ", which is not in the oracle's table");
    }
    const bool flat = image.viewType == VK_IMAGE_VIEW_TYPE_MAX_ENUM || image.viewType == VK_IMAGE_VIEW_TYPE_2D ||
                      image.viewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    if (!flat) {
        return unsupported("oracle: image '" + image.name + "' has view type " + std::to_string(image.viewType) +
                           "; only 2D images are judged");
    }
    store.mipLevels_ = image.mipLevels;
    store.arrayLayers_ = image.arrayLayers;
    for (uint32_t mip = 0; mip < image.mipLevels; ++mip) {
        for (uint32_t layer = 0; layer < image.arrayLayers; ++layer) {
            ImageLevel level;
            level.extent = {std::max(1u, image.extent.width >> mip), std::max(1u, image.extent.height >> mip)};
            level.samples = image.samples;
            const size_t pixels = static_cast<size_t>(level.extent.width) * level.extent.height;
            level.texels.resize(pixels * level.samples);
            const size_t index = static_cast<size_t>(mip) * image.arrayLayers + layer;
            const size_t bytes = store.format_->bytes;
            const bool given = index < image.data.size() && !image.data[index].empty();
            if (given && image.data[index].size() != pixels * bytes) {
                return invalidArgument("oracle: image '" + image.name + "', data[" + std::to_string(index) + "] has " +
                                       std::to_string(image.data[index].size()) + " bytes, not " +
                                       std::to_string(pixels * bytes));
            }
            for (size_t i = 0; i < level.texels.size(); ++i) {
                if (given) {
                    level.texels[i] =
                        decodeStored(*store.format_, image.data[index].data() + i / level.samples * bytes);
                } else {
                    level.texels[i].flags = kOracleUnknown;
                }
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
