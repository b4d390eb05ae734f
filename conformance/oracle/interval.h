// A number together with the range that the specification permits for it: the currency of the whole-scene
// oracle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace vernier::conformance::exact {

struct Interval {
    double value = 0, low = 0, high = 0;

    Interval() = default;
    Interval(double exactly) : value(exactly), low(exactly), high(exactly) {}
    Interval(double value_, double low_, double high_) : value(value_), low(low_), high(high_) {}

    friend bool operator==(const Interval&, const Interval&) = default;

    bool isExact() const { return low == high; }
    bool isNan() const { return std::isnan(value) || std::isnan(low) || std::isnan(high); }

    /// Wider by `slack` on both sides.
    Interval widened(double slack) const { return {value, low - slack, high + slack}; }
    /// The same value, with room for the other's range.
    Interval united(const Interval& other) const {
        return {value, std::min(low, other.low), std::max(high, other.high)};
    }
    Interval clamped(double minimum, double maximum) const {
        return {std::clamp(value, minimum, maximum), std::clamp(low, minimum, maximum),
                std::clamp(high, minimum, maximum)};
    }

    friend Interval operator+(const Interval& a, const Interval& b) {
        return {a.value + b.value, a.low + b.low, a.high + b.high};
    }
    friend Interval operator-(const Interval& a, const Interval& b) {
        return {a.value - b.value, a.low - b.high, a.high - b.low};
    }
    friend Interval operator*(const Interval& a, const Interval& b) {
        const auto [least, most] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
        return {a.value * b.value, least, most};
    }
};

inline Interval smaller(const Interval& a, const Interval& b) {
    return {std::min(a.value, b.value), std::min(a.low, b.low), std::min(a.high, b.high)};
}
inline Interval larger(const Interval& a, const Interval& b) {
    return {std::max(a.value, b.value), std::max(a.low, b.low), std::max(a.high, b.high)};
}

using Color = std::array<Interval, 4>;

}  // namespace vernier::conformance::exact
