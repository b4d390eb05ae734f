#include "conformance/oracle/texel_filter.h"

#include "conformance/oracle/cube.h"
#include "conformance/oracle/filtering.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vernier::conformance::exact {
namespace {

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

}  // namespace

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

namespace {

Interval mix(const Interval& a, const Interval& b, double t) {
    return {a.value + t * (b.value - a.value), a.low + t * (b.low - a.low), a.high + t * (b.high - a.high)};
}

}  // namespace

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

namespace {

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

// The ends of [at - reach, at + reach] and the integers + `phase` between them.
std::vector<double> breaks(double at, double reach, double phase) {
    std::vector<double> result{at - reach, at + reach};
    for (double i = std::ceil(at - reach - phase); i + phase < at + reach; ++i) result.push_back(i + phase);
    return result;
}

}  // namespace

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

}  // namespace vernier::conformance::exact
