#include "runtime/raster/triangle_planes.h"

#include <algorithm>
#include <cmath>

#include "runtime/geometry/primitive_setup.h"

namespace vernier {
namespace {

/// Everything that follows from the gradients of the lambdas. `extent`: pixels from the anchor to the farthest covered
/// place, both axes added up.
void finishPlanes(const Primitive& p, const float* attributes, uint32_t subPixelBits, bool precise, double extent,
                  float zLow, float zHigh, TrianglePlanes& planes) {
    auto& d = planes.d;
    const double dz1 = double{p.z[1]} - double{p.z[0]}, dz2 = double{p.z[2]} - double{p.z[0]};
    d.z0 = double{p.z[0]} + double{p.depthBias};
    d.zx = dz1 * d.l1x + dz2 * d.l2x;
    d.zy = dz1 * d.l1y + dz2 * d.l2y;

    planes.anchorX = p.x[0] >> subPixelBits;
    planes.anchorY = p.y[0] >> subPixelBits;
    const int32_t fractionMask = (1 << subPixelBits) - 1;
    const auto inverse = static_cast<float>(1 / static_cast<double>(1u << subPixelBits));
    planes.fractionX = static_cast<float>(p.x[0] & fractionMask) * inverse;
    planes.fractionY = static_cast<float>(p.y[0] & fractionMask) * inverse;
    planes.l1x = static_cast<float>(d.l1x);
    planes.l1y = static_cast<float>(d.l1y);
    planes.l2x = static_cast<float>(d.l2x);
    planes.l2y = static_cast<float>(d.l2y);
    planes.z0 = static_cast<float>(d.z0);
    planes.zx = static_cast<float>(d.zx);
    planes.zy = static_cast<float>(d.zy);
    planes.zLow = zLow;
    planes.zHigh = zHigh;
    planes.w0 = p.w[0];
    planes.w1 = p.w[1];
    planes.w2 = p.w[2];
    planes.wScale = p.wExponent == 0 ? 1.0f : std::ldexp(1.0f, p.wExponent);
    planes.affine = p.affine;
    const double steepest = std::max({std::fabs(d.l1x), std::fabs(d.l1y), std::fabs(d.l2x), std::fabs(d.l2y)});
    planes.precise = precise || steepest * extent > kThinTriangle;
    for (int n = 0; n < 3; ++n) planes.attributes[n] = attributes + p.attributes[n];
    planes.flat = attributes + p.flat;
    planes.primitive = &p;
}

}  // namespace

TileEdges tileEdges(const Primitive& p, int32_t tileX, int32_t tileY, uint32_t subPixelBits, uint32_t samples,
                    const SamplePosition* positions) {
    TileEdges edges;
    edges.samples = samples;
    edges.smallEdges = p.smallEdges;
    edges.fourEdges = false;
    edges.x0 = std::max(p.bounds[0] - tileX, 0);
    edges.y0 = std::max(p.bounds[1] - tileY, 0);
    edges.x1 = std::min(p.bounds[2] - tileX, kTileSize - 1);
    edges.y1 = std::min(p.bounds[3] - tileY, kTileSize - 1);
    const int64_t originX = int64_t{tileX} << subPixelBits, originY = int64_t{tileY} << subPixelBits;
    const uint32_t sixteenth = subPixelBits - 4;
    for (size_t e = 0; e < 3; ++e) {
        const size_t next = e == 2 ? 0 : e + 1;
        const int64_t dx = int64_t{p.x[next]} - p.x[e], dy = int64_t{p.y[next]} - p.y[e];
        edges.a[e] = -dy;
        edges.b[e] = dx;
        const int64_t corner = dx * (originY - p.y[e]) - dy * (originX - p.x[e]) - (isTopLeft(dx, dy) ? 0 : 1);
        for (uint32_t s = 0; s < samples; ++s) {
            const int64_t sx = int64_t{positions[s].x16} << sixteenth, sy = int64_t{positions[s].y16} << sixteenth;
            edges.c[e][s] = (corner + dx * sy - dy * sx) >> subPixelBits;
        }
    }
    return edges;
}

void makePlanes(const Primitive& p, const float* attributes, uint32_t subPixelBits, bool precise, float zLow,
                float zHigh, TrianglePlanes& planes) {
    const auto x1 = static_cast<double>(int64_t{p.x[1]} - p.x[0]), y1 = static_cast<double>(int64_t{p.y[1]} - p.y[0]);
    const auto x2 = static_cast<double>(int64_t{p.x[2]} - p.x[0]), y2 = static_cast<double>(int64_t{p.y[2]} - p.y[0]);
    const double area = x1 * y2 - y1 * x2;
    const auto subUnits = static_cast<double>(1u << subPixelBits);
    const double perPixel = subUnits / area;
    auto& d = planes.d;
    d.l1x = y2 * perPixel;
    d.l1y = -x2 * perPixel;
    d.l2x = -y1 * perPixel;
    d.l2y = x1 * perPixel;
    // The farthest a covered pixel can be from the anchor.
    const double extent = (std::max({std::fabs(x1), std::fabs(x2), std::fabs(x1 - x2)}) +
                           std::max({std::fabs(y1), std::fabs(y2), std::fabs(y1 - y2)})) /
                          subUnits;
    planes.shape = nullptr;
    finishPlanes(p, attributes, subPixelBits, precise, extent, zLow, zHigh, planes);
}

void makeShapePlanes(const Primitive& p, const Shape& shape, const float* attributes, uint32_t subPixelBits,
                     bool precise, float zLow, float zHigh, TrianglePlanes& planes) {
    const auto x = static_cast<double>(int64_t{p.x[1]} - p.x[0]), y = static_cast<double>(int64_t{p.y[1]} - p.y[0]);
    const auto subUnits = static_cast<double>(1u << subPixelBits);
    const double square = x * x + y * y, perPixel = square > 0 ? subUnits / square : 0;
    planes.d.l1x = x * perPixel;
    planes.d.l1y = y * perPixel;
    planes.d.l2x = planes.d.l2y = 0;
    planes.shape = &shape;
    const double extent = (std::fabs(x) + std::fabs(y)) / subUnits + kMaxLineWidth;
    finishPlanes(p, attributes, subPixelBits, precise, extent, zLow, zHigh, planes);
}

float depthAt(const TrianglePlanes& planes, int32_t x, int32_t y, float offsetX, float offsetY) {
    float z;
    if (planes.precise) {
        const double dx = static_cast<double>(x - planes.anchorX) + double{offsetX - planes.fractionX};
        const double dy = static_cast<double>(y - planes.anchorY) + double{offsetY - planes.fractionY};
        z = static_cast<float>(planes.d.z0 + (planes.d.zx * dx + planes.d.zy * dy));
    } else {
        const float dx = static_cast<float>(x - planes.anchorX) + (offsetX - planes.fractionX);
        const float dy = static_cast<float>(y - planes.anchorY) + (offsetY - planes.fractionY);
        z = planes.z0 + (planes.zx * dx + planes.zy * dy);
    }
    return std::max(std::min(z, planes.zHigh), planes.zLow);
}

Barycentrics barycentricsAt(const TrianglePlanes& planes, int32_t x, int32_t y, float offsetX, float offsetY) {
    const double dx = static_cast<double>(x - planes.anchorX) + double{offsetX - planes.fractionX};
    const double dy = static_cast<double>(y - planes.anchorY) + double{offsetY - planes.fractionY};
    Barycentrics result;
    result.l1 = planes.d.l1x * dx + planes.d.l1y * dy;
    result.l2 = planes.d.l2x * dx + planes.d.l2y * dy;
    const double q1 = result.l1 * double{planes.w1}, q2 = result.l2 * double{planes.w2};
    const double sum = ((1 - result.l1 - result.l2) * double{planes.w0} + q1) + q2;
    result.b1 = planes.affine ? result.l1 : q1 / sum;
    result.b2 = planes.affine ? result.l2 : q2 / sum;
    return result;
}

}  // namespace vernier
