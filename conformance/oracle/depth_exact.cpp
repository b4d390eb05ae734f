#include "conformance/oracle/depth_exact.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::exact {

namespace {

const Component& depthComponent(VkFormat format) {
    static const Component none{};
    const PixelFormat* found = findPixelFormat(format);
    return found && found->depth ? found->components[0] : none;
}

}  // namespace

CodeSet encodeDepth(VkFormat format, const Rational& depth) {
    return encode(depthComponent(format), depth);
}

Rational decodeDepth(VkFormat format, uint64_t code) {
    return decode(depthComponent(format), code).value_or(Rational(0));
}

BiasUnit biasUnit(VkFormat format, const std::array<Rational, 3>& vertexDepths) {
    const Component& component = depthComponent(format);
    if (component.encoding == Encoding::unorm) {
        const Rational unit = powerOfTwo(-component.bits);
        return {unit, unit * 2};
    }
    Rational largest = 0;
    for (const Rational& z : vertexDepths) largest = std::max(largest, Rational(abs(z)));
    const FloatLayout layout = floatLayout(component.bits);
    const int exponent = largest == 0 ? layout.minExponent() : std::max(floorLog2(largest), layout.minExponent());
    const Rational unit = powerOfTwo(exponent - layout.mantissaBits);
    return {unit, unit};
}

BiasRange depthBias(VkFormat format, const std::array<Rational, 3>& vertexDepths, const Rational& slopeX,
                    const Rational& slopeY, float constantFactor, float clamp, float slopeFactor) {
    const BiasUnit unit = biasUnit(format, vertexDepths);
    const double steepest = Rational(std::max(Rational(abs(slopeX)), Rational(abs(slopeY)))).get_d();
    const double slope = sqrtEnclosure(slopeX * slopeX + slopeY * slopeY).high;
    const auto [constantLow, constantHigh] =
        std::minmax({constantFactor * unit.low.get_d(), constantFactor * unit.high.get_d()});
    const auto [slopeLow, slopeHigh] = std::minmax({slopeFactor * steepest, slopeFactor * slope});
    BiasRange range{constantLow + slopeLow, constantHigh + slopeHigh};
    if (clamp > 0) range = {std::min<double>(range.low, clamp), std::min<double>(range.high, clamp)};
    if (clamp < 0) range = {std::max<double>(range.low, clamp), std::max<double>(range.high, clamp)};
    return range;
}

}  // namespace vernier::conformance::exact
