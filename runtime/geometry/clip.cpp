#include "runtime/geometry/clip.h"

#include <cmath>

namespace vernier {
namespace {

/// A clip plane: signed distance of a vertex, positive inside.
struct ClipPlane {
    std::array<double, 4> coefficients{};
    uint32_t user = kMaxClipDistances;  // below: the clip distance to take instead

    double distance(const ClipVertex& v) const {
        if (user < kMaxClipDistances) return v.distances[user];
        return (coefficients[0] * v.position[0] + coefficients[1] * v.position[1]) +
               (coefficients[2] * v.position[2] + coefficients[3] * v.position[3]);
    }
};

/// window <= limit, that is scale * c / w + offset <= limit, times w; and the same from below.
ClipPlane guardPlane(const ViewportTransform& viewport, uint32_t axis, double limit, double sign) {
    ClipPlane plane;
    plane.coefficients[axis] = -sign * viewport.scale[axis];
    plane.coefficients[3] = sign * (limit - viewport.offset[axis]);
    return plane;
}

uint32_t collectPlanes(const PreparedDraw& draw, const ViewportTransform& viewport, bool isLine,
                       std::array<ClipPlane, kMaxClipPlanes>& planes) {
    uint32_t count = 0;
    planes[count++].coefficients = {0, 0, 0, 1};
    if (draw.state->depthClipEnable) {
        planes[count++].coefficients = {0, 0, 1, draw.state->negativeOneToOne ? 1.0 : 0.0};
        planes[count++].coefficients = {0, 0, -1, 1};
    }
    for (size_t axis = 0; isLine && axis < 2; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            planes[count].coefficients[axis] = sign;
            planes[count++].coefficients[3] = 1;
        }
    }
    for (uint32_t axis = 0; axis < 2; ++axis) {
        planes[count++] = guardPlane(viewport, axis, kGuardBandMax, 1);
        planes[count++] = guardPlane(viewport, axis, kGuardBandMin, -1);
    }
    for (uint32_t k = 0; k < draw.plan->clipDistanceSlots.size(); ++k) planes[count++].user = k;
    return count;
}

/// The point of the line a-b where the plane's distance is zero. Commutative in (a, da), (b, db): symmetric
/// sums of the two products, so that complementary clips meet exactly.
double meet(double a, double da, double b, double db) {
    const double weightA = std::fabs(db), weightB = std::fabs(da);
    return (a * weightA + b * weightB) / (weightA + weightB);
}

ClipVertex cutEdge(const PreparedDraw& draw, const ClipPlane& plane, const ClipVertex& inside, double dInside,
                   const ClipVertex& outside, double dOutside, Chunk& chunk) {
    ClipVertex v;
    for (uint32_t c = 0; c < 4; ++c) v.position[c] = meet(inside.position[c], dInside, outside.position[c], dOutside);
    for (uint32_t k = 0; k < draw.plan->clipDistanceSlots.size(); ++k)
        v.distances[k] = meet(inside.distances[k], dInside, outside.distances[k], dOutside);
    if (plane.user < kMaxClipDistances) v.distances[plane.user] = 0;

    // Attributes as value plus difference: equal ends give an equal middle, to the bit.
    const Plan& plan = *draw.plan;
    const double t = dInside / (dInside - dOutside);
    // Linear on the screen: the parameter of the projected segment (specification, "Clipping Shader
    // Outputs").
    const double linear = v.position[3] != 0 ? t * outside.position[3] / v.position[3] : t;
    v.pointSize =
        static_cast<float>(double{inside.pointSize} + t * (double{outside.pointSize} - double{inside.pointSize}));
    v.attributes = static_cast<uint32_t>(chunk.attributes.size());
    const uint32_t interpolated = plan.smoothCount + plan.linearCount;
    chunk.attributes.resize(chunk.attributes.size() + plan.varyings.size());
    const float* a = chunk.attributes.data() + inside.attributes;
    const float* b = chunk.attributes.data() + outside.attributes;
    float* out = chunk.attributes.data() + v.attributes;
    for (uint32_t k = 0; k < interpolated; ++k) {
        const double parameter = k < plan.smoothCount ? t : linear;
        out[k] = static_cast<float>(double{a[k]} + parameter * (double{b[k]} - double{a[k]}));
    }
    return v;
}

}  // namespace

bool clipPolygon(const PreparedDraw& draw, const ViewportTransform& viewport, ClipPolygon& polygon, Chunk& chunk) {
    std::array<ClipPlane, kMaxClipPlanes> planes;
    const bool isLine = polygon.count == 2;
    const uint32_t planeCount = collectPlanes(draw, viewport, isLine, planes);
    bool cut = false;
    for (uint32_t p = 0; p < planeCount && polygon.count > 0; ++p) {
        std::array<double, kMaxPolygonVertices> distance;
        bool anyOutside = false;
        for (uint32_t n = 0; n < polygon.count; ++n) {
            distance[n] = planes[p].distance(polygon.vertices[n]);
            anyOutside |= distance[n] < 0;
        }
        if (!anyOutside) continue;
        cut = true;
        ClipPolygon result;
        for (uint32_t n = 0; n < polygon.count; ++n) {
            const uint32_t next = n + 1 == polygon.count ? 0 : n + 1;
            const bool in = distance[n] >= 0, nextIn = distance[next] >= 0;
            // Rounding can make a polygon cross a plane more than twice; what exceeds the bound would be a
            // sliver of rounding errors.
            if (in && result.count < kMaxPolygonVertices) result.vertices[result.count++] = polygon.vertices[n];
            const bool closing = isLine && next == 0;
            if (in == nextIn || closing || result.count == kMaxPolygonVertices) continue;
            const uint32_t i = in ? n : next, o = in ? next : n;
            result.vertices[result.count] =
                cutEdge(draw, planes[p], polygon.vertices[i], distance[i], polygon.vertices[o], distance[o], chunk);
            // Where the polygon leaves, an edge along the plane follows; where it comes back, the rest of its own.
            result.vertices[result.count++].hiddenEdge =
                in ? planes[p].user == kMaxClipDistances : polygon.vertices[n].hiddenEdge;
        }
        polygon = result;
        if (polygon.count < (isLine ? 2u : 3u)) polygon.count = 0;
    }
    return cut;
}

}  // namespace vernier
