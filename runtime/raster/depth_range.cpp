#include "runtime/raster/depth_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vernier {
namespace {

/// The rounding of a plane's evaluation, relative to the sum of its terms' sizes: three float operations, with room to
/// spare.
constexpr double kEvaluation = 0x1p-20;

/// [low, high] widened by what evaluation and format may move depths by. Clamping comes before rounding to the format.
DepthRange widened(DepthStorage storage, double low, double high, double size, float zLow, float zHigh) {
    const double quantum = depthQuantum(storage), margin = size * kEvaluation + quantum;
    const auto clamped = [&](double z) { return std::clamp(z, double{zLow}, double{zHigh}); };
    return {clamped(low - margin) - quantum, clamped(high + margin) + quantum};
}

}  // namespace

double depthQuantum(DepthStorage storage) {
    switch (storage) {
        case DepthStorage::d16:
            return 1.0 / 65535;
        case DepthStorage::d24:
            return 1.0 / 16777215;
        default:
            return 0;
    }
}

DepthRange clearedDepths(DepthStorage storage, float depth) {
    if (isFixedPoint(storage)) depth = depth >= 0 ? std::min(depth, 1.0f) : 0.0f;
    const double step = depthQuantum(storage);
    return {double{depth} - step, double{depth} + step};
}

DepthRange blockDepths(DepthStorage storage, const TrianglePlanes& p, int32_t x, int32_t y) {
    // The plane at the block's corners.
    const double dx0 = static_cast<double>(x - p.anchorX) - double{p.fractionX}, dx1 = dx0 + kBlockSize;
    const double dy0 = static_cast<double>(y - p.anchorY) - double{p.fractionY}, dy1 = dy0 + kBlockSize;
    const double x0 = p.d.zx * dx0, x1 = p.d.zx * dx1, y0 = p.d.zy * dy0, y1 = p.d.zy * dy1;
    const double size =
        std::fabs(p.d.z0) + std::max(std::fabs(x0), std::fabs(x1)) + std::max(std::fabs(y0), std::fabs(y1));
    return widened(storage, p.d.z0 + std::min(x0, x1) + std::min(y0, y1), p.d.z0 + std::max(x0, x1) + std::max(y0, y1),
                   size, p.zLow, p.zHigh);
}

DepthRange primitiveDepths(DepthStorage storage, const Primitive& p, float zLow, float zHigh) {
    const double z0 = double{p.z[0]} + double{p.depthBias};
    const double dz1 = double{p.z[1]} - double{p.z[0]}, dz2 = double{p.z[2]} - double{p.z[0]};
    // A line can cover pixels beyond its ends.
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (p.shape != kNoShape && dz1 != 0) return {-kInfinity, kInfinity};
    // The terms of a lambda that cancel more than this are evaluated in double.
    const double size = std::fabs(z0) + kThinTriangle * (std::fabs(dz1) + std::fabs(dz2));
    return widened(storage, z0 + std::min({0.0, dz1, dz2}), z0 + std::max({0.0, dz1, dz2}), size, zLow, zHigh);
}

}  // namespace vernier
