#include "conformance/oracle/texture_unit.h"

#include "conformance/oracle/cube.h"
#include "conformance/oracle/quantise.h"
#include "conformance/oracle/texel_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace vernier::conformance::exact {

namespace {

// 8 bits of weight (subTexelPrecisionBits of every driver compared). Derivatives may be coarse or fine, which moves
// lambda a little more on perspective surfaces.
constexpr double kWeightSlack = 0x1p-8;  // of blits
// Rounding of a compared reference value.
constexpr double kReferenceSlack = 0x1p-20;

// All that one lambda allows: magnification at or below 0, otherwise the minification filter over one or two
// levels.
void addAtLod(Box& box, const Sampler& s, double lambda, bool magnify, const Place& place) {
    if (magnify) {
        box.add(filterLevel(s, 0, s.state.magFilter, place));
        return;
    }
    const double last = s.image.mipLevels() - 1;
    const VkFilter filter = s.state.minFilter;
    const auto at = [&](double level) {
        return filterLevel(s, static_cast<uint32_t>(std::clamp(level, 0.0, last)), filter, place);
    };
    if (s.state.mipmapMode == VK_SAMPLER_MIPMAP_MODE_NEAREST) {
        box.add(at(std::ceil(lambda + 0.5) - 1));
        if (std::ceil(lambda + 0.5) - 1 != std::floor(lambda + 0.5)) box.add(at(std::floor(lambda + 0.5)));
        return;
    }
    const double clamped = std::clamp(lambda, 0.0, last), low = std::floor(clamped);
    box.add(clamped == low ? at(low) : mix(s, at(low), at(low + 1), clamped - low));
}

SampleResult filterLod(const Sampler& s, const Interval& lambda, const Place& place) {
    Box box;
    addAtLod(box, s, lambda.value, lambda.value <= 0, place);
    std::vector<double> candidates{lambda.low, lambda.high};
    const double first = std::max(lambda.low, -1.0), last = std::min(lambda.high, s.image.mipLevels() * 1.0);
    for (double k = std::ceil(first * 2); k / 2 <= last; ++k) candidates.push_back(k / 2);
    for (const double candidate : candidates) {
        if (candidate <= 0) addAtLod(box, s, candidate, true, place);
        if (candidate > 0 || (candidate == 0 && lambda.high > 0)) {
            addAtLod(box, s, candidate, false, place);
        }
    }
    return box.result();
}

// The declared value of an anisotropic filter: the mean of N samples evenly along the longer gradient, as Vulkan
// describes one scheme ("Texel Anisotropic Filtering"), where more samples than the gradient has texels add nothing.
std::array<double, 4> anisotropicMean(const Sampler& s, const SampleQuery& query) {
    const VkExtent2D extent = s.image.level(0, s.layer).extent;
    const double x = std::hypot(query.ddx[0] * extent.width, query.ddx[1] * extent.height);
    const double y = std::hypot(query.ddy[0] * extent.width, query.ddy[1] * extent.height);
    const double longer = std::max(x, y), shorter = std::min(x, y), most = s.state.maxAnisotropy;
    const double ratio = longer > shorter * most ? most : std::max(1.0, longer / shorter);
    const double samples = std::ceil(std::min(ratio, std::max(longer, 1.0)));
    SampleQuery narrowed = query;
    narrowed.bias -= std::log2(ratio);
    const double lambda = std::max(levelOfDetail(narrowed, s.state, extent).value, -1.0);
    const std::array<double, 3>& gradient = x > y ? query.ddx : query.ddy;
    std::array<double, 4> mean{};
    for (double i = 1; i <= samples; ++i) {
        const double along = i / (samples + 1) - 0.5;
        const SampleResult sample =
            filterLod(s, Interval(lambda), {query.s + along * gradient[0], query.t + along * gradient[1], query.r});
        for (size_t c = 0; c < 4; ++c) mean[c] += sample.color[c].value / samples;
    }
    return mean;
}

// Every texel that a sample within the footprint may touch, at the levels between the one of its shorter side and the
// isotropic one. Vulkan leaves number, places and weights of an anisotropic filter's samples open ("implementation-
// dependent"); as an average of samples along the footprint the result is between the smallest and the largest texel.
SampleResult filterFootprint(const Sampler& s, const SampleQuery& query, const Interval& lambda) {
    const double last = s.image.mipLevels() - 1;
    const double narrow = lambda.low - std::log2(std::max(1.0f, s.state.maxAnisotropy));
    Box box;
    box.add(filterLod(s, Interval(std::max(lambda.value, -1.0)), {query.s, query.t}));
    const auto levelAt = [&](double lod) { return static_cast<uint32_t>(std::clamp(lod, 0.0, last)); };
    for (uint32_t mip = levelAt(std::floor(narrow)); mip <= levelAt(std::ceil(lambda.high)); ++mip) {
        const VkExtent2D extent = s.image.level(mip, s.layer).extent;
        const auto range = [&s](double at, double reach, double size) {
            // A linear filter reaches half a texel further; more than all texels are all of them.
            const double half = std::min(reach + 0.5 + s.weightSlack + kCoordinateSlack * size, size);
            return std::pair(static_cast<int64_t>(std::floor(at - half)), static_cast<int64_t>(std::floor(at + half)));
        };
        const double width = extent.width, height = extent.height;
        const auto [left, right] =
            range(query.s * width, (std::abs(query.ddx[0]) + std::abs(query.ddy[0])) / 2 * width, width);
        const auto [top, bottom] =
            range(query.t * height, (std::abs(query.ddx[1]) + std::abs(query.ddy[1])) / 2 * height, height);
        for (int64_t y = top; y <= bottom; ++y) {
            for (int64_t x = left; x <= right; ++x) box.add(tap(s, mip, x, y, 0));
        }
    }
    SampleResult result = box.result();
    const std::array<double, 4> mean = anisotropicMean(s, query);
    for (size_t c = 0; c < 4; ++c)
        if (!result.color[c].isExact()) result.color[c] = Interval(mean[c]).united(result.color[c]);
    return result;
}

// A filter may work at the precision of the texture's codes: one code to either side of the box (but nothing
// where all texels agree, and never beyond the format). The nominal value stays exact.
void allowFilterRounding(const PixelFormat& format, SampleResult& result) {
    for (const Component& component : format.all()) {
        Interval& v = result.color[component.channel];
        if (v.isExact() || component.encoding == Encoding::sfloat || component.encoding == Encoding::ufloat) continue;
        v = v.united(quantise(component, v, 1));
    }
}

// Coordinates whose texels are known: not NaN, and not so large that no implementation's float has a fraction left.
bool isAddressable(const SampleQuery& query) {
    constexpr double kLimit = 0x1p30;
    return std::abs(query.s) < kLimit && std::abs(query.t) < kLimit && std::abs(query.r) < kLimit;
}

SampleResult unknownTexel() {
    SampleResult unknown;
    unknown.flags = kOracleUndefined;
    for (Interval& c : unknown.color) c = {0, -HUGE_VAL, HUGE_VAL};
    return unknown;
}

uint32_t selectLayer(const ImageStore& image, double layer) {
    const double last = image.arrayLayers() - 1;
    return std::isnan(layer) ? 0 : static_cast<uint32_t>(std::clamp(std::nearbyint(layer), 0.0, last));
}

Sampler prepare(const ImageStore& image, const SceneSampler& state, const SampleQuery& query) {
    Sampler s{image, state, selectLayer(image, query.layer), query.offset, std::nullopt, query.weightSlack, false};
    if (query.dref && state.compareEnable) {
        const double slack = kReferenceSlack * std::max(1.0, std::abs(*query.dref));
        Interval dref = Interval(*query.dref).widened(slack);
        if (image.format().components[0].encoding == Encoding::unorm) dref = dref.clamped(0, 1);
        s.dref = dref;
    }
    return s;
}

}  // namespace

bool SampleResult::isExact() const {
    return std::ranges::all_of(color, [](const Interval& c) { return c.isExact(); });
}

Interval levelOfDetail(const SampleQuery& query, const SceneSampler& sampler, VkExtent2D extent, uint32_t depth) {
    const double infinity = std::numeric_limits<double>::infinity();
    Interval lambda;
    if (query.lod) {
        lambda = Interval(*query.lod + sampler.mipLodBias);
        if (lambda.value != std::floor(lambda.value)) lambda = lambda.widened(query.levelSlack);
    } else {
        const double ux = query.ddx[0] * extent.width, vx = query.ddx[1] * extent.height;
        const double uy = query.ddy[0] * extent.width, vy = query.ddy[1] * extent.height;
        const double wx = depth > 1 ? query.ddx[2] * depth : 0, wy = depth > 1 ? query.ddy[2] * depth : 0;
        const double mu = std::max(std::abs(ux), std::abs(uy)), mv = std::max(std::abs(vx), std::abs(vy)),
                     mw = std::max(std::abs(wx), std::abs(wy));
        const double rho = std::max(std::hypot(ux, vx, wx), std::hypot(uy, vy, wy));
        if (!(rho > 0)) return {-infinity, -infinity, -infinity};
        lambda = {std::log2(rho), std::log2(std::max({mu, mv, mw})) - query.levelSlack,
                  std::log2(mu + mv + mw) + query.levelSlack};
        const double bias = query.bias + sampler.mipLodBias;
        lambda = lambda + Interval(bias);
    }
    const double low = std::max<double>(sampler.minLod, query.minLod);
    return lambda.clamped(low, std::max<double>(low, sampler.maxLod));
}

namespace {

// At one place of one layer, slice range or face.
SampleResult sampleFlat(const Sampler& s, const SampleQuery& query) {
    const ImageStore& image = s.image;
    const SceneSampler& sampler = s.state;
    Interval lambda = levelOfDetail(query, sampler, image.level(0, s.layer).extent, image.depth(0));
    if (std::isnan(lambda.value)) return unknownTexel();
    const double floorLod = -1;  // anything below magnifies alike
    lambda = lambda.clamped(floorLod, std::numeric_limits<double>::max());
    const Place place{query.s, query.t, query.r};
    const bool anisotropic = sampler.maxAnisotropy > 1 && !query.lod && image.kind() == ImageKind::flat;
    SampleResult result = anisotropic ? filterFootprint(s, query, lambda) : filterLod(s, lambda, place);
    if (!result.isExact()) {
        // Whatever one level of detail leaves open are weights; what others add is the level.
        const bool several = image.mipLevels() > 1 || sampler.magFilter != sampler.minFilter;
        const bool levels = anisotropic || (several && !lambda.isExact());
        const SampleResult there = levels && !anisotropic ? filterLod(s, Interval(lambda.value), place) : result;
        if (!there.isExact()) result.flags |= kOracleWeights;
        if (anisotropic || there.color != result.color) result.flags |= kOracleLevel;
    }
    return result;
}

/// The query as it is on one face of a cube.
SampleQuery onFace(const SampleQuery& query, const CubePlace& place) {
    SampleQuery result = query;
    result.s = place.s;
    result.t = place.t;
    result.r = 0;
    result.ddx = {place.ddx[0], place.ddx[1], 0};
    result.ddy = {place.ddy[0], place.ddy[1], 0};
    return result;
}

std::vector<CubePlace> placesOf(const SampleQuery& query) {
    return cubePlaces({query.s, query.t, query.r}, query.ddx, query.ddy, kCoordinateSlack);
}

}  // namespace

std::optional<Interval> queriedLevel(const ImageStore& image, const SceneSampler& sampler, const SampleQuery& asked) {
    SceneSampler unclamped = sampler;
    unclamped.minLod = -VK_LOD_CLAMP_NONE;
    SampleQuery query = asked;
    query.minLod = -VK_LOD_CLAMP_NONE;
    const VkExtent2D extent = image.level(0, 0).extent;
    if (image.kind() != ImageKind::cube) return levelOfDetail(query, unclamped, extent, image.depth(0));
    std::optional<Interval> level;
    for (const CubePlace& place : placesOf(query)) {
        const Interval there = levelOfDetail(onFace(query, place), unclamped, extent);
        level = level ? level->united(there) : there;
    }
    return level;
}

SampleResult sampleImage(const ImageStore& image, const SceneSampler& sampler, const SampleQuery& asked) {
    SampleQuery query = asked;
    if (!isAddressable(query)) return unknownTexel();
    if (sampler.unnormalized) {
        query.s /= image.level(0, 0).extent.width;
        query.t /= image.level(0, 0).extent.height;
    }
    Sampler s = prepare(image, sampler, query);
    SampleResult result;
    if (image.kind() == ImageKind::cube) {
        const uint32_t cubes = image.arrayLayers() / 6;
        const auto cube = static_cast<uint32_t>(
            std::isnan(query.layer) ? 0 : std::clamp(std::nearbyint(query.layer), 0.0, cubes - 1.0));
        Box box;
        const std::vector<CubePlace> places = placesOf(query);
        if (places.empty()) return unknownTexel();
        for (const CubePlace& place : places) {
            s.layer = cube * 6 + place.face;
            box.add(sampleFlat(s, onFace(query, place)));
        }
        result = box.result();
    } else {
        if (image.kind() == ImageKind::volume) s.layer = 0;
        result = sampleFlat(s, query);
    }
    if (!s.dref) allowFilterRounding(image.format(), result);
    return result;
}

SampleResult gatherImage(const ImageStore& image, const SceneSampler& sampler, const SampleQuery& query,
                         uint32_t channel) {
    if (!isAddressable(query)) return unknownTexel();
    const Sampler s = prepare(image, sampler, query);
    const VkExtent2D extent = image.level(0, s.layer).extent;
    const double u = query.s * extent.width - 0.5, v = query.t * extent.height - 0.5;
    SampleResult result;
    const std::array<std::array<int, 2>, 4> order{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    const auto at = [&](double x, double y, size_t i) {
        return tap(s, 0, static_cast<int64_t>(std::floor(x)) + order[i][0],
                   static_cast<int64_t>(std::floor(y)) + order[i][1], 0);
    };
    for (size_t i = 0; i < 4; ++i) {
        Box box;
        box.add(at(u, v, i));
        for (const double du : {-s.weightSlack, s.weightSlack}) {
            for (const double dv : {-s.weightSlack, s.weightSlack}) box.add(at(u + du, v + dv, i));
        }
        result.color[i] = box.result().color[s.dref ? 0 : channel];
        result.flags |= box.result().flags;
    }
    return result;
}

SampleResult fetchImage(const ImageStore& image, int64_t x, int64_t y, int64_t layer, int64_t mip, uint32_t sample) {
    if (mip < 0 || mip >= image.mipLevels() || layer < 0) return {};
    if (layer >= image.arrayLayers() * image.depth(static_cast<uint32_t>(mip))) return {};
    const ImageLevel& level = image.level(static_cast<uint32_t>(mip), static_cast<uint32_t>(layer));
    if (x < 0 || y < 0 || x >= level.extent.width || y >= level.extent.height || sample >= level.samples) return {};
    const StoredTexel& texel = level.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y), sample);
    return {texel.channels, texel.flags};
}

SampleResult blitTexel(const ImageStore& image, uint32_t mip, uint32_t layer, const std::array<double, 3>& at,
                       VkFilter filter, bool truncated) {
    SceneSampler state;
    state.addressModeU = state.addressModeV = state.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    // Texel centres map to dyadic positions in nearly all blits: a nearest blit has coordinate error only.
    const uint32_t of = image.kind() == ImageKind::volume ? 0 : layer;
    const Sampler s{image, state, of, {}, std::nullopt, filter == VK_FILTER_NEAREST ? 0 : kWeightSlack, truncated};
    const VkExtent2D extent = image.level(mip, of).extent;
    return filterLevel(s, mip, filter, {at[0] / extent.width, at[1] / extent.height, at[2] / image.depth(mip)});
}

}  // namespace vernier::conformance::exact
