#include "conformance/oracle/filtering.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vernier::conformance::exact {

namespace {

int64_t floorModulo(int64_t value, int64_t divisor) {
    const int64_t rest = value % divisor;
    return rest < 0 ? rest + divisor : rest;
}

Rational lerp(const Rational& a, const Rational& b, const Rational& t) {
    return a + t * (b - a);
}

Rational bilinearAt(const std::function<Rational(int64_t, int64_t)>& texel, int64_t x, int64_t y, const Rational& a,
                    const Rational& b) {
    return lerp(lerp(texel(x, y), texel(x + 1, y), a), lerp(texel(x, y + 1), texel(x + 1, y + 1), a), b);
}

// Positions along one axis at which a piecewise linear filter can have an extreme: the ends and the texel
// centres between.
std::vector<Rational> breakpoints(const Rational& u, const Rational& reach) {
    const Rational low = u - reach, high = u + reach;
    std::vector<Rational> result{low, high};
    const Rational half = fraction(1, 2);
    for (Integer i = ceilOf(low - half); Rational(i) <= high - half; ++i) result.push_back(Rational(i) + half);
    return result;
}

}  // namespace

std::optional<int64_t> wrapTexel(VkSamplerAddressMode mode, int64_t coordinate, int64_t size) {
    const auto mirror = [](int64_t n) { return n >= 0 ? n : -(1 + n); };
    switch (mode) {
        case VK_SAMPLER_ADDRESS_MODE_REPEAT:
            return floorModulo(coordinate, size);
        case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT:
            return (size - 1) - mirror(floorModulo(coordinate, 2 * size) - size);
        case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE:
            return std::clamp<int64_t>(coordinate, 0, size - 1);
        case VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE:
            return std::clamp<int64_t>(mirror(coordinate), 0, size - 1);
        default:
            break;  // clamp to border
    }
    if (coordinate < 0 || coordinate >= size) return std::nullopt;
    return coordinate;
}

AxisTaps linearTaps(const Rational& u, int weightBits) {
    const Rational shifted = u - fraction(1, 2);
    const Integer first = floorOf(shifted);
    Rational weight = shifted - Rational(first);
    if (weightBits >= 0) weight = Rational(roundHalfEven(weight * powerOfTwo(weightBits))) / powerOfTwo(weightBits);
    return {toInt64(first), weight};
}

int64_t nearestTexel(const Rational& u) {
    return toInt64(floorOf(u));
}

Rational bilinear(const std::function<Rational(int64_t, int64_t)>& texel, const Rational& u, const Rational& v,
                  int weightBits) {
    const AxisTaps x = linearTaps(u, weightBits), y = linearTaps(v, weightBits);
    return bilinearAt(texel, x.first, y.first, x.weight, y.weight);
}

FilterRange bilinearRange(const std::function<Rational(int64_t, int64_t)>& texel, const Rational& u, const Rational& v,
                          int weightBits, const Rational& slack) {
    const Rational reach = slack + powerOfTwo(-weightBits);
    std::optional<FilterRange> range;
    for (const Rational& x : breakpoints(u, reach)) {
        for (const Rational& y : breakpoints(v, reach)) {
            const Rational value = bilinear(texel, x, y);
            if (!range) range = FilterRange{value, value};
            range->low = std::min(range->low, value);
            range->high = std::max(range->high, value);
        }
    }
    return *range;
}

Rational squaredScale(const TexelDerivatives& d) {
    return std::max(Rational(d.ux * d.ux + d.vx * d.vx), Rational(d.uy * d.uy + d.vy * d.vy));
}

SquaredScaleRange squaredScaleRange(const TexelDerivatives& d) {
    const Rational u = std::max(Rational(abs(d.ux)), Rational(abs(d.uy)));
    const Rational v = std::max(Rational(abs(d.vx)), Rational(abs(d.vy)));
    const Rational low = std::max(u, v), high = u + v;
    return {low * low, high * high};
}

std::optional<Enclosure> levelOfDetail(const Rational& squaredRho, double bias) {
    if (squaredRho <= 0) return std::nullopt;
    const Enclosure twice = log2Enclosure(squaredRho);
    return Enclosure{std::nextafter(twice.low / 2 + bias, -HUGE_VAL), std::nextafter(twice.high / 2 + bias, HUGE_VAL)};
}

NearestLevel nearestLevel(const Rational& squaredRho) {
    // lambda lies in (k - 1/2, k + 1/2] exactly when rho^2 lies in (2^(2k-1), 2^(2k+1)].
    const int e = floorLog2(squaredRho);  // 2^e <= rho^2 < 2^(e+1)
    const bool odd = (e % 2) != 0;
    const bool tie = odd && squaredRho == powerOfTwo(e);
    const int above = odd ? (e + 1) / 2 : e / 2;  // floor(lambda + 1/2); e + 1 is even when e is odd
    return {tie ? above - 1 : above, above};
}

}  // namespace vernier::conformance::exact
