#include "samples/common/trigonometry.h"

#include <cmath>

namespace samples {
namespace {

/// Taylor series to the 17th power; |r| <= pi/4, where the first term left out is below 1e-18.
double sineNearZero(double r) {
    const double s = r * r;
    double sum = 0;
    for (int n = 17; n >= 3; n -= 2) sum = (sum + 1) * (-s / (n * (n - 1)));
    return r + r * sum;
}

double cosineNearZero(double r) {
    const double s = r * r;
    double sum = 0;
    for (int n = 18; n >= 2; n -= 2) sum = (sum + 1) * (-s / (n * (n - 1)));
    return 1 + sum;
}

/// sin(angle + quarter turns), reduced to |r| <= pi/4 with pi/2 in two parts (Cody and Waite): the first has 33 bits,
/// so that its multiples are exact.
double quarterTurns(double angle, int shift) {
    const double quarters = std::floor(angle * (2 / kPi) + 0.5);
    const double r = (angle - quarters * 1.57079632673412561417) - quarters * 6.07710050650619224932e-11;
    switch ((static_cast<long long>(quarters) + shift) & 3) {
        case 0:
            return sineNearZero(r);
        case 1:
            return cosineNearZero(r);
        case 2:
            return -sineNearZero(r);
        default:
            return -cosineNearZero(r);
    }
}

}  // namespace

double sine(double angle) {
    return quarterTurns(angle, 0);
}

double cosine(double angle) {
    return quarterTurns(angle, 1);
}

double tangent(double angle) {
    return sine(angle) / cosine(angle);
}

}  // namespace samples
