#include "conformance/oracle/quantise.h"

#include "conformance/oracle/encode.h"

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace vernier::conformance::exact {

namespace {

// The nearest, lower and upper code for numbers on a scale of codes from `first` to `last`.
Interval roundedCodes(const Interval& n, double budget, double first, double last) {
    double low = std::floor(n.low + kCodeTolerance), high = std::ceil(n.high - kCodeTolerance);
    if (budget > 0) {
        low = std::min(low, std::ceil(n.low - budget - kCodeTolerance));
        high = std::max(high, std::floor(n.high + budget + kCodeTolerance));
    }
    return Interval(std::nearbyint(n.value), low, high).clamped(first, last);
}

Interval quantiseFixed(const Interval& number, double minimum, double codes, double budget) {
    if (number.isNan()) return {0, minimum, 1};
    const Interval n = number.clamped(minimum, 1);
    const Interval c = roundedCodes({n.value * codes, n.low * codes, n.high * codes}, budget, minimum * codes, codes);
    return {c.value / codes, c.low / codes, c.high / codes};
}

// Direction: -1 down, 0 nearest even, +1 up.
double roundToFloat(double x, const FloatLayout& layout, int direction) {
    if (std::isnan(x) || x == 0) return x;
    const double quantaInTop = std::ldexp(1.0, layout.mantissaBits + 1);
    const double maxFinite = std::ldexp(quantaInTop - 1, layout.maxExponent() - layout.mantissaBits);
    const int exponent = std::isinf(x) ? layout.maxExponent() : std::max(std::ilogb(x), layout.minExponent());
    const double quantum = std::ldexp(1.0, std::min(exponent, layout.maxExponent()) - layout.mantissaBits);
    // Far below a float quantum, but above the noise of double arithmetic.
    constexpr double kTolerance = 1e-6;
    const double quanta = x / quantum;
    const double rounded = direction == 0  ? std::nearbyint(quanta)
                           : direction < 0 ? std::floor(quanta + kTolerance)
                                           : std::ceil(quanta - kTolerance);
    const double result = rounded * quantum;
    const double infinity = std::numeric_limits<double>::infinity();
    if (std::abs(result) <= maxFinite) return result;
    // Overflow may end at the largest finite value or at infinity.
    const bool towardsZero = (direction < 0 && x > 0) || (direction > 0 && x < 0);
    return std::copysign(towardsZero ? maxFinite : infinity, x);
}

const std::vector<double>& srgbTable() {
    static const std::vector<double> table = [] {
        std::vector<double> t;
        const Component component{0, 0, 8, Encoding::srgb};
        for (uint64_t code = 0; code < 256; ++code) t.push_back(decode(component, code)->get_d());
        return t;
    }();
    return table;
}

}  // namespace

double srgbEncode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double srgbDecode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Interval quantise(const Component& component, const Interval& number, double budget) {
    const double codes = std::ldexp(1.0, component.bits) - 1;
    switch (component.encoding) {
        case Encoding::unorm:
            return quantiseFixed(number, 0, codes, budget);
        case Encoding::snorm:
            return quantiseFixed(number, -1, std::ldexp(1.0, component.bits - 1) - 1, budget);
        case Encoding::srgb: {
            if (number.isNan()) return {0, 0, 1};
            const Interval n = number.clamped(0, 1);
            const Interval encoded(srgbEncode(n.value) * 255, srgbEncode(n.low) * 255, srgbEncode(n.high) * 255);
            const Interval c = roundedCodes(encoded, budget, 0, 255);
            const auto at = [](double code) { return srgbTable()[static_cast<size_t>(code)]; };
            return {at(c.value), at(c.low), at(c.high)};
        }
        case Encoding::uint:
        case Encoding::sint:
            return number.isNan() ? Interval(0.0) : number;
        default:
            break;
    }
    Interval n = number;
    if (component.encoding != Encoding::sfloat) {
        n = {std::max(n.value, 0.0), std::max(n.low, 0.0), std::max(n.high, 0.0)};
        if (std::isnan(number.value)) n.value = number.value;
    }
    const FloatLayout layout = floatLayout(component.bits);
    return {roundToFloat(n.value, layout, 0), roundToFloat(n.low, layout, -1), roundToFloat(n.high, layout, 1)};
}

double decodeNumber(const Component& component, uint64_t code) {
    const unsigned bits = component.bits;
    const auto signedCode = [&] {
        return static_cast<double>(static_cast<int64_t>(code << (64 - bits)) >> (64 - bits));
    };
    switch (component.encoding) {
        case Encoding::unorm:
            return static_cast<double>(code) / (std::ldexp(1.0, static_cast<int>(bits)) - 1);
        case Encoding::snorm:
            return std::max(-1.0, signedCode() / (std::ldexp(1.0, static_cast<int>(bits) - 1) - 1));
        case Encoding::srgb:
            return srgbTable()[code];
        case Encoding::uint:
            return static_cast<double>(code);
        case Encoding::sint:
            return signedCode();
        default:
            break;
    }
    if (bits == 32) return std::bit_cast<float>(static_cast<uint32_t>(code));
    const FloatLayout layout = floatLayout(static_cast<int>(bits));
    const uint64_t mantissa = code & ((uint64_t{1} << layout.mantissaBits) - 1);
    const int field = static_cast<int>(code >> layout.mantissaBits) & ((1 << layout.exponentBits) - 1);
    const bool negative =
        component.encoding == Encoding::sfloat && (code >> (layout.exponentBits + layout.mantissaBits));
    double result;
    if (field == (1 << layout.exponentBits) - 1) {
        result = mantissa ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
    } else {
        const double significand = static_cast<double>(mantissa) + (field ? std::ldexp(1.0, layout.mantissaBits) : 0);
        result = std::ldexp(significand, layout.minExponent() + std::max(field, 1) - 1 - layout.mantissaBits);
    }
    return negative ? -result : result;
}

std::array<double, 4> decodeTexel(const PixelFormat& format, const std::byte* texel) {
    std::array<double, 4> result{0, 0, 0, 1};
    if (format.components[0].encoding == Encoding::sharedExponent) {
        const auto rgb = decodeSharedExponent(static_cast<uint32_t>(extractBits(texel, 0, 32)));
        for (size_t i = 0; i < 3; ++i) result[i] = rgb[i].get_d();
        return result;
    }
    for (const Component& c : format.all()) result[c.channel] = decodeNumber(c, extractBits(texel, c.offset, c.bits));
    return result;
}

}  // namespace vernier::conformance::exact
