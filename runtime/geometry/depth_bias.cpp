#include "runtime/geometry/depth_bias.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vernier {
namespace {

/// The smallest difference that a fixed-point attachment resolves; for a float one, 2^(e - 23) with e the
/// largest exponent of the primitive's depths.
double resolvableDifference(DepthStorage storage, std::span<const WindowVertex> polygon) {
    switch (storage) {
        case DepthStorage::d16:
            return 1.0 / 65535.0;
        case DepthStorage::d24:
            return 1.0 / 16777215.0;
        case DepthStorage::none:
            return 0;
        default:
            break;
    }
    float largest = 0;
    for (const WindowVertex& v : polygon) largest = std::max(largest, std::fabs(v.z));
    const int exponent = static_cast<int>(std::bit_cast<uint32_t>(largest) >> 23) - 127;
    return std::ldexp(1.0, std::max(exponent, -126) - 23);
}

}  // namespace

float depthBias(const PreparedDraw& draw, std::span<const WindowVertex> polygon, const WindowVertex& a,
                const WindowVertex& b, const WindowVertex& c) {
    const DynamicState& dynamic = *draw.call.dynamic;
    // The slope per pixel in its exact form, the length of the gradient.
    const auto area = static_cast<double>(doubleArea(a, b, c));
    const double subUnits = static_cast<double>(1u << draw.subPixelBits);
    const double zb = double{b.z} - double{a.z}, zc = double{c.z} - double{a.z};
    const double abx = double(b.x) - a.x, aby = double(b.y) - a.y, acx = double(c.x) - a.x, acy = double(c.y) - a.y;
    const double zx = (zb * acy - zc * aby) * subUnits / area, zy = (zc * abx - zb * acx) * subUnits / area;
    const double slope = std::sqrt(zx * zx + zy * zy);
    double bias = slope * double{dynamic.depthBiasSlope} +
                  resolvableDifference(draw.plan->depth.storage, polygon) * double{dynamic.depthBiasConstant};
    const double limit = double{dynamic.depthBiasClamp};
    if (limit > 0) bias = std::min(bias, limit);
    if (limit < 0) bias = std::max(bias, limit);
    return bias == bias ? static_cast<float>(bias) : 0.0f;
}

}  // namespace vernier
