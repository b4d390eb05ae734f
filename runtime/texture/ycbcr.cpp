#include "runtime/texture/ycbcr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "runtime/texture/routing.h"

namespace vernier {
namespace {

using Color = std::array<double, 4>;  // R (Cr), G (Y), B (Cb), A, before and after the conversion

/// The code of component `part` (0 or 1) of a texel of a plane.
double codeAt(const TextureView& plane, uint32_t bits, uint32_t part, uint32_t x, uint32_t y) {
    const TextureLevel& level = plane.levels[0];
    const std::byte* texel = level.data + uint64_t{y} * level.rowPitch + uint64_t{x} * plane.texelPitch;
    if (bits == 8) return static_cast<double>(std::to_integer<uint32_t>(texel[part]));
    uint16_t code = 0;
    std::memcpy(&code, texel + part * sizeof code, sizeof code);
    return code;
}

/// The two chroma samples of an axis that make the chroma at a texel of luma ("Explicit Reconstruction").
struct ChromaTaps {
    uint32_t index[2];
    double weight[2];
};

ChromaTaps chromaTaps(uint32_t texel, uint32_t divisor, uint32_t chromaSize, VkFilter filter, VkChromaLocation offset) {
    if (divisor == 1) return {{texel, texel}, {1, 0}};
    const auto at = [chromaSize](int64_t i) {
        return static_cast<uint32_t>(std::clamp<int64_t>(i, 0, int64_t{chromaSize} - 1));
    };
    const int64_t half = texel / 2;
    const bool even = texel % 2 == 0;
    if (filter == VK_FILTER_NEAREST) return {{at(half), at(half)}, {1, 0}};
    if (offset == VK_CHROMA_LOCATION_COSITED_EVEN) {
        return even ? ChromaTaps{{at(half), at(half)}, {1, 0}} : ChromaTaps{{at(half), at(half + 1)}, {0.5, 0.5}};
    }
    return even ? ChromaTaps{{at(half - 1), at(half)}, {0.25, 0.75}}
                : ChromaTaps{{at(half), at(half + 1)}, {0.75, 0.25}};
}

/// The coefficients of the model conversions, as the specification writes them: of Cr in R, of Cb and Cr in G, of Cb in
/// B.
struct Model {
    double redCr, greenCb, greenCr, blueCb;
};

Model modelOf(VkSamplerYcbcrModelConversion model) {
    switch (model) {
        case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_709:
            return {1.5748, 0.13397432 / 0.7152, 0.33480248 / 0.7152, 1.8556};
        case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_2020:
            return {1.4746, 0.11156702 / 0.6780, 0.38737742 / 0.6780, 1.8814};
        default:
            return {1.402, 0.202008 / 0.587, 0.419198 / 0.587, 1.772};
    }
}

/// Texels of one view, converted with one sampler.
class Converter {
  public:
    Converter(const PlanarView& view, const YcbcrConversion& conversion)
        : view_(view),
          conversion_(conversion),
          model_(modelOf(conversion.model)),
          width_(view.planes[0].levels[0].width),
          height_(view.planes[0].levels[0].height) {
        for (uint32_t c = 0; c < 4; ++c) routes_[c] = routeOf(conversion.components, c);
    }

    Color nearest(double u, double v) const {
        return texel(static_cast<int64_t>(std::floor(u)), static_cast<int64_t>(std::floor(v)));
    }

    Color linear(double u, double v) const {
        const double x = std::floor(u - 0.5), y = std::floor(v - 0.5);
        const double wx = u - 0.5 - x, wy = v - 0.5 - y;
        const auto i = static_cast<int64_t>(x), j = static_cast<int64_t>(y);
        const Color a = texel(i, j), b = texel(i + 1, j), c = texel(i, j + 1), d = texel(i + 1, j + 1);
        Color result;
        for (size_t k = 0; k < 4; ++k) {
            const double top = a[k] + wx * (b[k] - a[k]), bottom = c[k] + wx * (d[k] - c[k]);
            result[k] = top + wy * (bottom - top);
        }
        return result;
    }

    /// A normalised coordinate in texels, at most one outside; not a number: 0.
    static double place(float coordinate, uint32_t size) {
        const double at = static_cast<double>(coordinate) * size;
        return at >= -1 ? std::min(at, size + 1.0) : at < -1 ? -1 : 0;
    }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

  private:
    /// Samplers that convert clamp to the edge.
    Color texel(int64_t i, int64_t j) const {
        const auto x = static_cast<uint32_t>(std::clamp<int64_t>(i, 0, int64_t{width_} - 1));
        const auto y = static_cast<uint32_t>(std::clamp<int64_t>(j, 0, int64_t{height_} - 1));
        const MultiPlanarFormat& format = *view_.format;
        const TextureLevel& chroma = view_.planes[1].levels[0];
        const ChromaTaps across =
            chromaTaps(x, format.chromaWidthDivisor, chroma.width, conversion_.chromaFilter, conversion_.xChromaOffset);
        const ChromaTaps down = chromaTaps(y, format.chromaHeightDivisor, chroma.height, conversion_.chromaFilter,
                                           conversion_.yChromaOffset);
        const double most = static_cast<double>((1u << format.bits) - 1);
        const double luma = codeAt(view_.planes[0], format.bits, 0, x, y) / most;
        // B comes first: in plane 1; R in plane 2, or beside it.
        const bool apart = format.planeCount == 3;
        const double blue = chromaAt(view_.planes[1], 0, across, down) / most;
        const double red = chromaAt(view_.planes[apart ? 2 : 1], apart ? 0 : 1, across, down) / most;
        return convert({red, luma, blue, 1});
    }

    /// The sums of codes and weights, which are multiples of 1/16, are exact.
    double chromaAt(const TextureView& plane, uint32_t part, const ChromaTaps& across, const ChromaTaps& down) const {
        double sum = 0;
        for (int j = 0; j < 2; ++j) {
            for (int i = 0; i < 2; ++i) {
                const double weight = across.weight[i] * down.weight[j];
                if (weight == 0) continue;
                sum += weight * codeAt(plane, view_.format->bits, part, across.index[i], down.index[j]);
            }
        }
        return sum;
    }

    /// "Component swizzle", "Sampler Y'CbCr Range Expansion" and "Sampler Y'CbCr Model Conversion".
    Color convert(const Color& raw) const {
        Color c;
        for (size_t k = 0; k < 4; ++k) {
            c[k] = routes_[k] <= Route::a ? raw[static_cast<size_t>(routes_[k])] : routes_[k] == Route::one ? 1.0 : 0.0;
        }
        if (conversion_.model == VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY) return c;
        const uint32_t bits = view_.format->bits;
        const double most = static_cast<double>((1u << bits) - 1), unit = static_cast<double>(1u << (bits - 8));
        double y = c[1], cb = c[2], cr = c[0];
        if (conversion_.range == VK_SAMPLER_YCBCR_RANGE_ITU_NARROW) {
            y = (y * most - 16 * unit) / (219 * unit);
            cb = (cb * most - 128 * unit) / (224 * unit);
            cr = (cr * most - 128 * unit) / (224 * unit);
        } else {
            const double middle = static_cast<double>(1u << (bits - 1)) / most;
            cb -= middle;
            cr -= middle;
        }
        if (conversion_.model == VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_IDENTITY) return {cr, y, cb, c[3]};
        return {y + model_.redCr * cr, y - model_.greenCb * cb - model_.greenCr * cr, y + model_.blueCb * cb, c[3]};
    }

    const PlanarView& view_;
    const YcbcrConversion& conversion_;
    Model model_;
    uint32_t width_, height_;
    Route routes_[4];
};

}  // namespace

Status checkYcbcr(const TextureView& view, const SamplerState& sampler) {
    const YcbcrConversion& conversion = sampler.ycbcr;
    const auto refuse = [](const std::string& what) {
        return invalidArgument("a sampler with conversion from Y'CbCr " + what);
    };
    if (conversion.format != view.planar->format->format)
        return refuse("is for format " + std::to_string(conversion.format) + ", the view has another one");
    if (conversion.model > VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_2020 ||
        conversion.range > VK_SAMPLER_YCBCR_RANGE_ITU_NARROW ||
        conversion.xChromaOffset > VK_CHROMA_LOCATION_MIDPOINT ||
        conversion.yChromaOffset > VK_CHROMA_LOCATION_MIDPOINT || conversion.chromaFilter > VK_FILTER_LINEAR)
        return refuse("has a model, range, location or chroma filter that does not exist");
    const VkSamplerAddressMode* const modes = sampler.addressMode;
    if (modes[0] != VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE || modes[1] != VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE)
        return refuse("must clamp coordinates to the edge");
    if (sampler.magFilter > VK_FILTER_LINEAR || sampler.minFilter > VK_FILTER_LINEAR || sampler.maxAnisotropy > 1 ||
        sampler.unnormalizedCoordinates || sampler.compareEnable ||
        sampler.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE)
        return refuse("takes normalised coordinates and a nearest or linear filter, no more");
    return {};
}

void sampleYcbcr(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    const Converter converter(*view.planar, sampler.ycbcr);
    float lambdas[kMaxSampleLanes] = {};
    if (sampler.magFilter != sampler.minFilter) {
        float levels[kMaxSampleLanes];
        SampleRequest ask = request;
        ask.out[0] = levels;
        ask.out[1] = lambdas;
        ask.out[2] = ask.out[3] = nullptr;
        view.planar->queryLod(view, sampler, ask);
    }
    for (uint32_t lane = 0; lane < request.lanes; ++lane) {
        if (request.mask != nullptr && request.mask[lane] == 0) continue;
        const auto coordinate = [&](int axis) {
            return request.coord[axis] != nullptr ? request.coord[axis][lane] : 0;
        };
        const double u = Converter::place(coordinate(0), converter.width());
        const double v = Converter::place(coordinate(1), converter.height());
        float lambda = std::clamp(lambdas[lane], sampler.minLod, std::max(sampler.minLod, sampler.maxLod));
        if (request.minLod != nullptr) lambda = std::max(lambda, request.minLod[lane]);
        const VkFilter filter = lambda <= 0 ? sampler.magFilter : sampler.minFilter;
        const Color color = filter == VK_FILTER_LINEAR ? converter.linear(u, v) : converter.nearest(u, v);
        for (size_t c = 0; c < 4; ++c) {
            if (request.out[c] != nullptr) request.out[c][lane] = static_cast<float>(color[c]);
        }
    }
}

}  // namespace vernier
