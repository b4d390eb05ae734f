#include "conformance/oracle/triangle.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vernier::conformance::exact {

namespace {

// Beyond this many pixels the homogeneous test takes over: snapped coordinates would not fit the exact edge
// functions' declared range, and no implementation keeps such vertices unclipped.
constexpr double kFarAway = 0x1p22;
// Float rounding of clip coordinates and viewport transform, relative to the window coordinate.
constexpr double kPositionRounding = 0x1p-22;
// Float interpolation of depth relative to the largest depth of the triangle.
constexpr double kDepthRounding = 0x1p-21;
// Noise of the double evaluation itself.
constexpr double kNoise = 1e-13;
constexpr double kCutRounding = 1e-6;

struct Point {
    double x, y;
};

Point toPoint(const GridPoint& p, double subUnit) {
    return {static_cast<double>(p.x) * subUnit, static_cast<double>(p.y) * subUnit};
}

double distance(const std::array<double, 2>& a, const Point& p) {
    return std::abs(a[0] - p.x) + std::abs(a[1] - p.y);
}

double cross(const std::array<double, 2>& a, const std::array<double, 2>& b, const Point& p) {
    return (b[0] - a[0]) * (p.y - a[1]) - (b[1] - a[1]) * (p.x - a[0]);
}

}  // namespace

uint64_t hashNumbers(uint64_t seed, const double* numbers, size_t count) {
    uint64_t hash = seed ^ 0xcbf29ce484222325u;
    for (size_t i = 0; i < count; ++i) {
        const uint64_t bits = std::bit_cast<uint64_t>(numbers[i] + 0.0);  // -0 counts as 0
        for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 0xff)) * 0x100000001b3u;
    }
    return hash;
}

std::optional<Triangle> Triangle::create(const Setup& setup) {
    std::array<WindowVertex<double>, 3> v;
    bool inFront = true;
    for (size_t i = 0; i < 3; ++i) {
        for (const double c : setup.position[i]) {
            if (!std::isfinite(c))
                return std::nullopt;  // undefined position: dropping the primitive is the sane choice
        }
        v[i] = toWindow(setup.position[i], setup.viewport);
        inFront = inFront && v[i].w > 0;
    }
    Triangle t{HomogeneousTriangle<double>(v)};

    if (!t.addCuts(setup)) return std::nullopt;
    const auto& p = setup.position;
    t.subUnit_ = std::ldexp(1.0, -setup.subPixelBits);
    const double snapping = t.subUnit_ * setup.vertexFreedom;
    t.freedom_ = snapping;
    t.snapped_ = inFront;
    t.planesBehindEye_ = setup.planesBehindEye && !inFront;
    t.ties_ = setup.ties;
    for (size_t i = 0; i < 3 && t.snapped_; ++i) {
        t.window_[i] = {v[i].x / v[i].w, v[i].y / v[i].w};
        const double reach = std::max(std::abs(t.window_[i][0]), std::abs(t.window_[i][1]));
        t.snapped_ = reach < kFarAway;
        t.freedom_ = std::max(t.freedom_, snapping + kPositionRounding * reach);
    }
    const double determinant = t.shape_.determinant;
    t.side_ = determinant < 0 ? -1 : 1;
    t.orientation_ = determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
    if (t.snapped_) {
        for (size_t i = 0; i < 3; ++i) {
            t.grid_[i] = {static_cast<int64_t>(std::nearbyint(t.window_[i][0] / t.subUnit_)),
                          static_cast<int64_t>(std::nearbyint(t.window_[i][1] / t.subUnit_))};
        }
        t.orientation_ = exact::orientation(t.grid_);
        const auto& [a, b, c] = t.window_;
        const Point third{c[0], c[1]};
        const double area = std::abs(cross(a, b, third));
        const double reach = t.freedom_ * (distance(a, third) + distance(b, third) + distance(a, {b[0], b[1]})) +
                             6 * t.freedom_ * t.freedom_;
        t.orientationOpen_ = area <= reach;
        // Exactly coincident or exactly collinear on the grid: empty under every snapping rule that is a
        // function of the coordinates.
        bool onGrid = true;
        for (const auto& w : t.window_) {
            onGrid = onGrid && w[0] == std::nearbyint(w[0] / t.subUnit_) * t.subUnit_ &&
                     w[1] == std::nearbyint(w[1] / t.subUnit_) * t.subUnit_;
        }
        if (area == 0 && (onGrid || p[0] == p[1] || p[1] == p[2] || p[2] == p[0])) return std::nullopt;
    } else if (determinant == 0) {
        return std::nullopt;
    }

    for (size_t i = 0; i < 3; ++i) {
        const Clip<double>& a = setup.position[(i + 1) % 3];
        const Clip<double>& b = setup.position[(i + 2) % 3];
        t.edgeForward_[i] = a < b;
        const uint64_t first = hashNumbers(setup.context, std::min(a, b).data(), 4);
        t.edgeKey_[i] = hashNumbers(first, std::max(a, b).data(), 4);
    }
    t.findDepths(setup);
    return t;
}

/// Finds the planes that cut the triangle; false when one of them has it all outside.
bool Triangle::addCuts(const Setup& setup) {
    const auto& p = setup.position;
    std::vector<std::array<double, 3>> planes(setup.clipDistances);
    // The sides of the view volume: nothing is drawn outside the viewport, even where the scissor would allow
    // it.
    for (const size_t axis : {0, 1}) {
        planes.push_back({p[0][3] + p[0][axis], p[1][3] + p[1][axis], p[2][3] + p[2][axis]});
        planes.push_back({p[0][3] - p[0][axis], p[1][3] - p[1][axis], p[2][3] - p[2][axis]});
    }
    if (setup.depthClip) {
        planes.push_back({p[0][2], p[1][2], p[2][2]});
        planes.push_back({p[0][3] - p[0][2], p[1][3] - p[1][2], p[2][3] - p[2][2]});
    }
    for (const auto& plane : planes) {
        const auto outside = std::ranges::count_if(plane, [](double d) { return d < 0; });
        if (outside == 3) return false;
        if (outside != 0) cuts_.push_back(plane);
    }
    return true;
}

void Triangle::findDepths(const Setup& setup) {
    const std::array<WindowVertex<double>, 3>& v = shape_.vertex;
    identity_ = setup.context;
    for (const Clip<double>& position : setup.position) identity_ = hashNumbers(identity_, position.data(), 4);

    bool constantDepth = true;
    double largest = 0;
    for (size_t i = 0; i < 3; ++i) {
        constantDepth = constantDepth && v[i].z == v[0].z && v[i].w == v[0].w;
        largest = std::max(largest, std::abs(v[i].z / v[i].w));
    }
    if (!constantDepth && shape_.determinant != 0) {
        for (size_t i = 0; i < 3; ++i) {
            slopeX_ += shape_.edge[i][0] * v[i].z / shape_.determinant;
            slopeY_ += shape_.edge[i][1] * v[i].z / shape_.determinant;
        }
        depthSlack_ = freedom_ * (std::abs(slopeX_) + std::abs(slopeY_)) + kDepthRounding * std::min(largest, 1e6);
    }
}

std::optional<Triangle> Triangle::createCarrier(const Setup& setup, bool majorAxis) {
    std::array<WindowVertex<double>, 3> v;
    for (size_t i = 0; i < 2; ++i) {
        for (const double c : setup.position[i]) {
            if (!std::isfinite(c)) return std::nullopt;
        }
        v[i] = toWindow(setup.position[i], setup.viewport);
        if (!(v[i].w > 0)) return std::nullopt;
    }
    const double dx = v[1].x / v[1].w - v[0].x / v[0].w, dy = v[1].y / v[1].w - v[0].y / v[0].w;
    const double length = std::hypot(dx, dy);
    // A point has no direction: its second vertex lies beside it, with the same values.
    if (length == 0) v[1].x += v[1].w;
    v[2] = v[0];
    // Across: at a right angle to the line, or along its minor axis.
    std::array<double, 2> across = length == 0 ? std::array{0.0, 1.0} : std::array{-dy / length, dx / length};
    if (majorAxis) across = std::abs(dx) >= std::abs(dy) ? std::array{0.0, 1.0} : std::array{1.0, 0.0};
    v[2].x += v[0].w * across[0];
    v[2].y += v[0].w * across[1];
    Triangle t{HomogeneousTriangle<double>(v)};
    if (!t.addCuts(setup)) return std::nullopt;
    t.side_ = t.shape_.determinant < 0 ? -1 : 1;
    t.orientation_ = 1;
    t.subUnit_ = std::ldexp(1.0, -setup.subPixelBits);
    const double snapping = t.subUnit_ * setup.vertexFreedom;
    t.freedom_ = snapping;
    for (size_t i = 0; i < 2; ++i) {
        const double reach = std::max(std::abs(v[i].x), std::abs(v[i].y)) / v[i].w;
        t.freedom_ = std::max(t.freedom_, snapping + kPositionRounding * reach);
    }
    t.findDepths(setup);
    return t;
}

SampleVerdict Triangle::classifyCuts(const GridPoint& sample) const {
    SampleVerdict verdict;
    verdict.possible = true;
    if (!cuts_.empty()) applyCuts(sample, verdict);
    return verdict;
}

PixelBounds Triangle::bounds(const PixelBounds& within) const {
    if (!snapped_) return within;
    PixelBounds result = within;
    const auto [left, right] = std::minmax({window_[0][0], window_[1][0], window_[2][0]});
    const auto [top, bottom] = std::minmax({window_[0][1], window_[1][1], window_[2][1]});
    const double margin = freedom_ + subUnit_;
    result.x0 = std::max(result.x0, static_cast<int32_t>(std::floor(left - margin)));
    result.y0 = std::max(result.y0, static_cast<int32_t>(std::floor(top - margin)));
    result.x1 = std::min(result.x1, static_cast<int32_t>(std::ceil(right + margin)) + 1);
    result.y1 = std::min(result.y1, static_cast<int32_t>(std::ceil(bottom + margin)) + 1);
    return result;
}

OpenEdge Triangle::openEdge(size_t oppositeVertex, bool nominalInside, bool tie) const {
    return {edgeKey_[oppositeVertex], edgeForward_[oppositeVertex] == (side_ > 0), nominalInside, tie};
}

std::optional<bool> Triangle::tieForAll() const {
    if (ties_ == TieRule::both) return true;
    if (ties_ == TieRule::neither) return false;
    return std::nullopt;
}

SampleVerdict Triangle::classifySnapped(const GridPoint& sample) const {
    SampleVerdict verdict;
    const Point p = toPoint(sample, subUnit_);
    const auto [left, right] = std::minmax({window_[0][0], window_[1][0], window_[2][0]});
    const auto [top, bottom] = std::minmax({window_[0][1], window_[1][1], window_[2][1]});
    if (p.x < left - freedom_ || p.x > right + freedom_ || p.y < top - freedom_ || p.y > bottom + freedom_)
        return verdict;
    int outside = 0, inside = 0;
    for (size_t i = 0; i < 3; ++i) {
        const size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const double e = side_ * cross(window_[j], window_[k], p);
        const double support = freedom_ * (distance(window_[j], p) + distance(window_[k], p)) + 2 * freedom_ * freedom_;
        if (std::abs(e) > support) {
            outside += e < 0;
            inside += e > 0;
        } else {
            const GridPoint& a = side_ > 0 ? grid_[j] : grid_[k];
            const GridPoint& b = side_ > 0 ? grid_[k] : grid_[j];
            const Wide exactly = edgeFunction(a, b, sample);
            if (const std::optional<bool> in = tieForAll(); in && exactly == 0) {
                ++(*in ? inside : outside);
                continue;
            }
            verdict.edges[verdict.edgeCount++] =
                openEdge(i, exactly > 0 || (exactly == 0 && tieInside(isTopLeft(a, b))), exactly == 0);
        }
    }
    if (orientationOpen_) {
        verdict.possible = outside == 0 || inside == 0;
        verdict.edgeCount = 0;
        verdict.openAsWhole = true;
        verdict.nominalAsWhole = covers(grid_, sample);
    } else {
        verdict.possible = outside == 0;
    }
    return verdict;
}

SampleVerdict Triangle::classifyHomogeneous(const GridPoint& sample) const {
    SampleVerdict verdict;
    const Point p = toPoint(sample, subUnit_);
    for (size_t i = 0; i < 3; ++i) {
        const auto& [a, b, c] = shape_.edge[i];
        const double e = side_ * (a * p.x + b * p.y + c);
        const double support =
            freedom_ * (std::abs(a) + std::abs(b)) + kNoise * (std::abs(a * p.x) + std::abs(b * p.y) + std::abs(c));
        if (e < -support) return verdict;
        if (e > support) continue;
        if (const std::optional<bool> in = tieForAll(); in && e == 0) {
            if (!*in) return verdict;
            continue;
        }
        const double dx = side_ * a, dy = side_ * b;
        const bool topLeft = dx > 0 || (dx == 0 && dy > 0);
        verdict.edges[verdict.edgeCount++] = openEdge(i, e > 0 || (e == 0 && tieInside(topLeft)), e == 0);
    }
    verdict.possible = true;
    return verdict;
}

void Triangle::applyCuts(const GridPoint& sample, SampleVerdict& verdict) const {
    const Point p = toPoint(sample, subUnit_);
    const auto b = shape_.weights(p.x, p.y);
    verdict.cutNominal = true;
    for (const auto& cut : cuts_) {
        double value = 0, dx = 0, dy = 0, scale = 0;
        for (size_t i = 0; i < 3; ++i) {
            value += side_ * b[i] * cut[i];
            dx += shape_.edge[i][0] * cut[i];
            dy += shape_.edge[i][1] * cut[i];
            scale += std::abs(b[i] * cut[i]);
        }
        const double support = freedom_ * (std::abs(dx) + std::abs(dy)) + kCutRounding * scale;
        if (value < -support) {
            verdict.possible = false;
            return;
        }
        if (value <= support) {
            verdict.cutOpen = true;
            verdict.cutNominal = verdict.cutNominal && value >= 0;
        }
    }
}

SampleVerdict Triangle::classify(const GridPoint& sample) const {
    SampleVerdict verdict = snapped_ ? classifySnapped(sample) : classifyHomogeneous(sample);
    if (verdict.possible && !cuts_.empty()) applyCuts(sample, verdict);
    return verdict;
}

double Triangle::leverage(double x, double y) const {
    if (!planesBehindEye_) return 1;
    // The weights of the projected vertices, which sum to 1 and of which some are negative.
    const std::array<double, 3> b = shape_.weights(x, y);
    double sum = 0, magnitudes = 0;
    for (size_t i = 0; i < 3; ++i) {
        sum += b[i] * shape_.vertex[i].w;
        magnitudes += std::abs(b[i] * shape_.vertex[i].w);
    }
    return sum == 0 ? 1 : magnitudes / std::abs(sum);
}

Interval Triangle::depth(const GridPoint& sample) const {
    const WindowVertex<double>& v = shape_.vertex[0];
    if (slopeX_ == 0 && slopeY_ == 0 && depthSlack_ == 0) return v.z / v.w;
    const Point p = toPoint(sample, subUnit_);
    return Interval(shape_.depth(shape_.weights(p.x, p.y))).widened(depthSlack_ * leverage(p.x, p.y));
}

std::array<double, 3> Triangle::vertexDepths() const {
    std::array<double, 3> result;
    for (size_t i = 0; i < 3; ++i) result[i] = shape_.vertex[i].z / shape_.vertex[i].w;
    return result;
}

}  // namespace vernier::conformance::exact
