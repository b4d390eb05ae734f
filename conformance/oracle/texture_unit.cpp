#include "conformance/oracle/texture_unit.h"

#include "conformance/oracle/cube.h"
#include "conformance/oracle/filtering.h"
#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace vernier::conformance::exact {

namespace {

// CTS "high quality": 20 bits of coordinate; 8 bits of weight (subTexelPrecisionBits of every driver
// compared); 6 bits of level of detail. Derivatives may be coarse or fine, which moves lambda a little more
// on perspective surfaces.
constexpr double kCoordinateSlack = 0x1p-20;
constexpr double kWeightSlack = 0x1p-8;  // of blits
// Rounding of a compared reference value.
constexpr double kReferenceSlack = 0x1p-20;

struct Sampler {
    const ImageStore& image;
    const SceneSampler& state;
    uint32_t layer = 0;
    std::array<int32_t, 3> offset{};
    std::optional<Interval> dref;
    double weightSlack = 0;
    bool truncated = false;  // coordinates of linear filters go to the texel towards zero
};

Color borderColor(const SceneSampler& sampler) {
    switch (sampler.borderColor) {
        case VK_BORDER_COLOR_FLOAT_CUSTOM_EXT: {
            Color color;
            for (size_t c = 0; c < 4; ++c) color[c] = Interval(sampler.customBorderColor[c]);
            return color;
        }
        case VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE:
        case VK_BORDER_COLOR_INT_OPAQUE_WHITE:
            return {1.0, 1.0, 1.0, 1.0};
        case VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK:
        case VK_BORDER_COLOR_INT_OPAQUE_BLACK:
            return {0.0, 0.0, 0.0, 1.0};
        default:
            return {0.0, 0.0, 0.0, 0.0};
    }
}

// Result of comparing two ranges: 0 or 1, with both open when they overlap.
Interval compareRanges(VkCompareOp op, const Interval& a, const Interval& b) {
    const auto holds = [op](double x, double y) {
        switch (op) {
            case VK_COMPARE_OP_NEVER:
                return false;
            case VK_COMPARE_OP_LESS:
                return x < y;
            case VK_COMPARE_OP_EQUAL:
                return x == y;
            case VK_COMPARE_OP_LESS_OR_EQUAL:
                return x <= y;
            case VK_COMPARE_OP_GREATER:
                return x > y;
            case VK_COMPARE_OP_NOT_EQUAL:
                return x != y;
            case VK_COMPARE_OP_GREATER_OR_EQUAL:
                return x >= y;
            default:
                return true;
        }
    };
    const bool value = holds(a.value, b.value), oneWay = holds(a.low, b.high), otherWay = holds(a.high, b.low);
    const bool overlap = a.low <= b.high && b.low <= a.high && !(a.isExact() && b.isExact());
    const bool equality = op == VK_COMPARE_OP_EQUAL || op == VK_COMPARE_OP_NOT_EQUAL;
    const bool open = equality ? overlap : oneWay != otherWay;
    return open ? Interval(value, 0, 1) : Interval(value);
}

SampleResult averageOf(const std::array<SampleResult, 3>& texels) {
    // Vulkan, Cube Map Edge Handling: the average of the three is recommended; any mixture of them is what is certain.
    SampleResult result = texels[0];
    for (size_t c = 0; c < 4; ++c) {
        double sum = 0;
        for (const SampleResult& each : texels) {
            sum += each.color[c].value;
            result.color[c] = result.color[c].united(each.color[c]);
            result.flags |= each.flags;
        }
        result.color[c].value = sum / 3;
    }
    return result;
}

// The texel of a cube at integer coordinates of the sampler's face.
SampleResult cubeTap(const Sampler& s, uint32_t mip, int64_t x, int64_t y) {
    const int64_t n = s.image.level(mip, s.layer).extent.width;
    const uint32_t face = s.layer % 6, cube = s.layer - face;
    const auto read = [&](int64_t atX, int64_t atY) {
        // Further out than one texel only what a filter's freedom reaches.
        const auto near = [n](int64_t c) { return std::clamp<int64_t>(c, -1, n); };
        const CubeTexel where = *cubeTexel(face, near(atX), near(atY), n);
        const StoredTexel& texel =
            s.image.level(mip, cube + where.face).at(static_cast<uint32_t>(where.x), static_cast<uint32_t>(where.y));
        return SampleResult{texel.channels, texel.flags};
    };
    const int64_t insideX = std::clamp<int64_t>(x, 0, n - 1), insideY = std::clamp<int64_t>(y, 0, n - 1);
    if (x == insideX || y == insideY) return read(x, y);
    return averageOf({read(insideX, insideY), read(x, insideY), read(insideX, y)});
}

// The texel at integer coordinates after wrapping, compared if the sampler compares.
SampleResult tap(const Sampler& s, uint32_t mip, int64_t x, int64_t y, int64_t z) {
    SampleResult result;
    if (s.image.kind() == ImageKind::cube) {
        result = cubeTap(s, mip, x, y);
    } else {
        const VkExtent2D extent = s.image.level(mip, s.layer).extent;
        const auto column = wrapTexel(s.state.addressModeU, x + s.offset[0], extent.width);
        const auto row = wrapTexel(s.state.addressModeV, y + s.offset[1], extent.height);
        std::optional<int64_t> slice = s.layer;
        if (s.image.kind() == ImageKind::volume)
            slice = wrapTexel(s.state.addressModeW, z + s.offset[2], s.image.depth(mip));
        if (column && row && slice) {
            const StoredTexel& texel = s.image.level(mip, static_cast<uint32_t>(*slice))
                                           .at(static_cast<uint32_t>(*column), static_cast<uint32_t>(*row));
            result = {texel.channels, texel.flags};
        } else {
            // Vulkan, Texel Replacement and Conversion to RGBA: channels that the format lacks are 0, alpha is 1.
            const Color border = borderColor(s.state);
            const PixelFormat& format = s.image.format();
            for (uint8_t c = 0; c < 4; ++c)
                result.color[c] = format.channel(c) ? border[c] : Interval(c == 3 ? 1.0 : 0.0);
        }
    }
    if (s.dref) {
        result.color[0] = compareRanges(s.state.compareOp, *s.dref, result.color[0]);
        result.color[1] = result.color[2] = 0.0;
        result.color[3] = 1.0;
    }
    return result;
}

Interval mix(const Interval& a, const Interval& b, double t) {
    return {a.value + t * (b.value - a.value), a.low + t * (b.low - a.low), a.high + t * (b.high - a.high)};
}

// Two texels, or filtered values, of which the second has weight t: mixed, or the smaller or larger one
// (VK_EXT_sampler_filter_minmax), among those that have a weight at all.
SampleResult mix(const Sampler& s, const SampleResult& a, const SampleResult& b, double t) {
    SampleResult result;
    for (size_t c = 0; c < 4; ++c) {
        result.color[c] = s.state.reduction == VK_SAMPLER_REDUCTION_MODE_MIN   ? smaller(a.color[c], b.color[c])
                          : s.state.reduction == VK_SAMPLER_REDUCTION_MODE_MAX ? larger(a.color[c], b.color[c])
                                                                               : mix(a.color[c], b.color[c], t);
    }
    result.flags = a.flags | b.flags;
    return result;
}

/// A place in texels; of volumes with its third coordinate.
struct Place {
    double u = 0, v = 0, w = 0.5;
};

SampleResult linearAt(const Sampler& s, uint32_t mip, const Place& place) {
    const auto first = [&s](double c) { return s.truncated ? std::trunc(c - 0.5) : std::floor(c - 0.5); };
    const double x = first(place.u), y = first(place.v), z = first(place.w);
    const double a = place.u - 0.5 - x, b = place.v - 0.5 - y, c = place.w - 0.5 - z;
    const auto i = static_cast<int64_t>(x), j = static_cast<int64_t>(y), k = static_cast<int64_t>(z);
    // A tap without weight is not read: what lies beyond it must not leak in.
    const auto row = [&](int64_t atY, int64_t atZ) {
        return a == 0 ? tap(s, mip, i, atY, atZ) : mix(s, tap(s, mip, i, atY, atZ), tap(s, mip, i + 1, atY, atZ), a);
    };
    const auto slice = [&](int64_t atZ) { return b == 0 ? row(j, atZ) : mix(s, row(j, atZ), row(j + 1, atZ), b); };
    return c == 0 ? slice(k) : mix(s, slice(k), slice(k + 1), c);
}

/// The weights of a cubic filter's four texels (Vulkan, Texel Cubic Filtering), `a` beyond the second.
std::array<double, 4> cubicWeights(double a) {
    const double a2 = a * a, a3 = a2 * a;
    return {-a / 2 + a2 - a3 / 2, 1 - 2.5 * a2 + 1.5 * a3, a / 2 + 2 * a2 - 1.5 * a3, (a3 - a2) / 2};
}

SampleResult cubicAt(const Sampler& s, uint32_t mip, const Place& place) {
    const double x = std::floor(place.u - 0.5), y = std::floor(place.v - 0.5);
    const std::array<double, 4> across = cubicWeights(place.u - 0.5 - x), down = cubicWeights(place.v - 0.5 - y);
    SampleResult result;
    for (int64_t j = 0; j < 4; ++j) {
        for (int64_t i = 0; i < 4; ++i) {
            const double weight = across[static_cast<size_t>(i)] * down[static_cast<size_t>(j)];
            if (weight == 0) continue;
            const SampleResult texel = tap(s, mip, static_cast<int64_t>(x) + i - 1, static_cast<int64_t>(y) + j - 1, 0);
            for (size_t c = 0; c < 4; ++c) result.color[c] = result.color[c] + texel.color[c] * Interval(weight);
            result.flags |= texel.flags;
        }
    }
    return result;
}

// Accumulates the box over several evaluations; the first one is the nominal value.
class Box {
  public:
    void add(const SampleResult& r) {
        if (first_) {
            result_ = r;
            first_ = false;
            return;
        }
        for (size_t c = 0; c < 4; ++c) result_.color[c] = result_.color[c].united(r.color[c]);
        result_.flags |= r.flags;
    }
    const SampleResult& result() const { return result_; }

  private:
    SampleResult result_;
    bool first_ = true;
};

// The ends of [at - reach, at + reach] and the integers + `phase` between them.
std::vector<double> breaks(double at, double reach, double phase) {
    std::vector<double> result{at - reach, at + reach};
    for (double i = std::ceil(at - reach - phase); i + phase < at + reach; ++i) result.push_back(i + phase);
    return result;
}

SampleResult filterLevel(const Sampler& s, uint32_t mip, VkFilter filter, const Place& at) {
    const VkExtent2D extent = s.image.level(mip, s.layer).extent;
    const bool volume = s.image.kind() == ImageKind::volume, cube = s.image.kind() == ImageKind::cube;
    const double depth = s.image.depth(mip);
    const Place place{at.u * extent.width, at.v * extent.height, volume ? at.w * depth : 0.5};
    const auto reach = [&s](double size, double coordinate) {
        return s.weightSlack + kCoordinateSlack * size * std::max(1.0, std::abs(coordinate));
    };
    const double reachU = reach(extent.width, at.u), reachV = reach(extent.height, at.v),
                 reachW = volume ? reach(depth, at.w) : 0;
    Box box;
    if (filter == VK_FILTER_NEAREST) {
        const auto nearest = [&](double x, double y, double z) {
            const auto texel = [](double c) { return static_cast<int64_t>(std::floor(c)); };
            return tap(s, mip, texel(x), texel(y), texel(z));
        };
        // The far border of a face belongs to it.
        const auto within = [cube](double c, uint32_t size) { return cube ? std::min(c, size - 0.5) : c; };
        const double u = within(place.u, extent.width), v = within(place.v, extent.height);
        box.add(nearest(u, v, place.w));
        for (const double x : {u - reachU, u + reachU}) {
            for (const double y : {v - reachV, v + reachV}) {
                for (const double z : {place.w - reachW, place.w + reachW}) {
                    if (std::floor(x) != std::floor(u) || std::floor(y) != std::floor(v) ||
                        std::floor(z) != std::floor(place.w))
                        box.add(nearest(x, y, z));
                }
            }
        }
        return box.result();
    }
    if (filter == VK_FILTER_CUBIC_EXT) {
        // Weights turn within a fraction of a texel by far less than a code: the ends of the ranges are enough.
        box.add(cubicAt(s, mip, place));
        for (const double x : {place.u - reachU, place.u + reachU}) {
            for (const double y : {place.v - reachV, place.v + reachV}) box.add(cubicAt(s, mip, {x, y, 0.5}));
        }
        return box.result();
    }
    box.add(linearAt(s, mip, place));
    const std::vector<double> slices = volume ? breaks(place.w, reachW, 0.5) : std::vector<double>{0.5};
    for (const double x : breaks(place.u, reachU, 0.5)) {
        for (const double y : breaks(place.v, reachV, 0.5)) {
            for (const double z : slices) box.add(linearAt(s, mip, {x, y, z}));
        }
    }
    return box.result();
}

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
