// Sine and cosine from additions and multiplications alone. Those of a C library differ in their last bits from one
// library to the next; what reaches Vernier would differ with them, and so could a pixel. The samples call no
// transcendental function of the C library on the way to a picture; square roots and floor are exact everywhere.
#pragma once

namespace samples {

constexpr double kPi = 3.14159265358979323846;

/// Radians, |angle| <= 1e5; error below 1e-11 at the ends of that range, below 1e-15 within a few turns.
double sine(double angle);
double cosine(double angle);
double tangent(double angle);

/// The same rounded to float, for vertices and matrices.
inline float sineF(double angle) {
    return static_cast<float>(sine(angle));
}
inline float cosineF(double angle) {
    return static_cast<float>(cosine(angle));
}

}  // namespace samples
