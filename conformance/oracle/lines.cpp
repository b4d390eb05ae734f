#include "conformance/oracle/lines.h"

#include <algorithm>

namespace vernier::conformance::exact {
namespace {

Integer wide(int64_t value) {
    return Integer(static_cast<long>(value));
}

/// The sign of value - factor * sqrt(square), for square >= 0.
int compareWithRoot(const Rational& value, const Rational& factor, const Rational& square) {
    const Rational left = value * value, right = factor * factor * square;
    if (sgn(value) >= 0 && sgn(factor) >= 0) return cmp(left, right);
    if (sgn(value) < 0 && sgn(factor) < 0) return cmp(right, left);
    return sgn(value) < 0 ? -1 : sgn(factor) < 0 ? 1 : cmp(left, right);
}

/// How a sample lies to a segment: how far across it and along it, both times the segment's length; and on which side
/// across, the positive one being that of the direction (-dy, dx).
struct LinePlace {
    Rational across, along, lengthSquared;
    int side;
};

LinePlace placeOf(const GridLine& line, const GridPoint& p) {
    const Integer dx = wide(line.b.x - line.a.x), dy = wide(line.b.y - line.a.y);
    const Integer px = wide(p.x - line.a.x), py = wide(p.y - line.a.y);
    const Integer across = dx * py - dy * px;
    return {Rational(abs(across)), Rational(Integer(dx * px + dy * py)), Rational(Integer(dx * dx + dy * dy)),
            sgn(across)};
}

/// Whether a sample lies in the rectangle grown by `margin` on all sides.
bool within(const LinePlace& place, const Rational& width, const Rational& margin) {
    const Rational half = width / 2 + margin;
    return compareWithRoot(place.across, half, place.lengthSquared) <= 0 &&
           compareWithRoot(place.along, -margin, place.lengthSquared) >= 0 &&
           compareWithRoot(place.along - place.lengthSquared, margin, place.lengthSquared) <= 0;
}

/// A number with an infinitesimal part: value + first e + second e^2.
struct Perturbed {
    Rational value, first, second;

    int sign() const { return sgn(value) != 0 ? sgn(value) : sgn(first) != 0 ? sgn(first) : sgn(second); }
};

Perturbed operator-(const Perturbed& a, const Perturbed& b) {
    return {a.value - b.value, a.first - b.first, a.second - b.second};
}
Perturbed operator+(const Perturbed& a, const Perturbed& b) {
    return {a.value + b.value, a.first + b.first, a.second + b.second};
}
Perturbed magnitude(const Perturbed& a) {
    return a.sign() < 0 ? Perturbed{-a.value, -a.first, -a.second} : a;
}

/// Whether a point lies in the diamond |x| + |y| < 1/2 around a pixel's centre.
bool inDiamond(const std::array<Perturbed, 2>& p, const PixelIndex& pixel) {
    const Perturbed x = p[0] - Perturbed{pixel.x + fraction(1, 2), 0, 0};
    const Perturbed y = p[1] - Perturbed{pixel.y + fraction(1, 2), 0, 0};
    return (magnitude(x) + magnitude(y) - Perturbed{fraction(1, 2), 0, 0}).sign() < 0;
}

}  // namespace

Coverage classifyLine(const GridLine& line, const GridPoint& sample, int64_t slack) {
    const LinePlace place = placeOf(line, sample);
    if (sgn(place.lengthSquared) == 0) return Coverage::mustNot;
    const Rational margin = fraction(slack, 1);
    if (!within(place, line.width, margin)) return Coverage::mustNot;
    const bool certain = line.width > 2 * margin && within(place, line.width, -margin);
    return certain ? Coverage::must : Coverage::may;
}

bool lineCovers(const GridLine& line, const GridPoint& sample) {
    const LinePlace place = placeOf(line, sample);
    if (sgn(place.lengthSquared) == 0) return false;
    const int64_t dx = line.b.x - line.a.x, dy = line.b.y - line.a.y;
    const Rational half = line.width / 2, across = place.across * place.side;
    // The sample's side of each border, positive inside; and the border's normal, which points inwards.
    const struct {
        int side;
        int64_t normalX, normalY;
    } borders[] = {{sgn(place.along), dx, dy},
                   {-cmp(place.along, place.lengthSquared), -dx, -dy},
                   {-compareWithRoot(-across, half, place.lengthSquared), -dy, dx},
                   {-compareWithRoot(across, half, place.lengthSquared), dy, -dx}};
    return std::ranges::all_of(borders, [](const auto& border) {
        const bool topLeft = border.normalX > 0 || (border.normalX == 0 && border.normalY > 0);
        return border.side > 0 || (border.side == 0 && topLeft);
    });
}

std::vector<PixelIndex> bresenhamPixels(const std::array<Rational, 2>& a, const std::array<Rational, 2>& b) {
    const std::array<Rational, 2> d{b[0] - a[0], b[1] - a[1]};
    if (sgn(d[0]) == 0 && sgn(d[1]) == 0) return {};
    const size_t major = abs(d[0]) >= abs(d[1]) ? 0 : 1, minor = 1 - major;
    const Rational slope = d[minor] / d[major];
    // Both ends move by (-e, -e^2): the line keeps its slope.
    const auto moved = [](const std::array<Rational, 2>& p) {
        return std::array<Perturbed, 2>{Perturbed{p[0], -1, 0}, Perturbed{p[1], 0, -1}};
    };
    const std::array<Perturbed, 2> start = moved(a), end = moved(b);
    const int step = sgn(d[major]);
    std::vector<PixelIndex> result;
    // A line crosses the middle of a column inside exactly one diamond; it has left that diamond unless it ends there.
    const int64_t first = toInt64(floorOf(a[major])) - step, last = toInt64(floorOf(b[major])) + step;
    for (int64_t column = first; column != last + step; column += step) {
        const Rational middle = column + fraction(1, 2);
        // Where the perturbed line is in the middle of the column.
        Perturbed at{a[minor] + slope * (middle - a[major]), 0, 0};
        (major == 0 ? at.first : at.second) += slope;
        (major == 0 ? at.second : at.first) -= 1;
        int64_t across = toInt64(floorOf(at.value));
        if (at.value == Rational(wide(across)) && Perturbed{0, at.first, at.second}.sign() < 0) --across;
        const PixelIndex pixel = major == 0 ? PixelIndex{column, across} : PixelIndex{across, column};
        const Perturbed centre{middle, 0, 0};
        const bool startsBefore = (centre - start[major]).sign() * step >= 0,
                   endsBehind = (end[major] - centre).sign() * step >= 0;
        const bool startsInside = inDiamond(start, pixel), endsInside = inDiamond(end, pixel);
        const bool enters = startsInside || (startsBefore && endsBehind);
        if (enters && !endsInside && (startsInside || startsBefore)) result.push_back(pixel);
    }
    return result;
}

Coverage classifySquare(const GridSquare& square, const GridPoint& sample, int64_t slack) {
    const Rational half = square.size / 2;
    const Rational x = abs(Rational(wide(sample.x)) - square.x), y = abs(Rational(wide(sample.y)) - square.y);
    const Rational margin = fraction(slack, 1);
    if (x > half + margin || y > half + margin) return Coverage::mustNot;
    return x < half - margin && y < half - margin ? Coverage::must : Coverage::may;
}

bool squareCovers(const GridSquare& square, const GridPoint& sample) {
    const Rational half = square.size / 2;
    const auto covers = [&half](const Rational& centre, int64_t at) {
        const Integer low = roundHalfEven(centre - half), high = roundHalfEven(centre + half), p = wide(at);
        return p >= low && p < high;
    };
    return covers(square.x, sample.x) && covers(square.y, sample.y);
}

}  // namespace vernier::conformance::exact
