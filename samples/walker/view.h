// From the world to the picture, for both versions of the walker.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "samples/walker/map.h"

namespace samples {

/// What a pixel shows; the number of the sector stands above the lowest four bits.
enum Surface : uint32_t { kCeiling = 0, kFloor = 1, kWall = 2, kUpperStep = 3, kLowerStep = 4 };
constexpr uint32_t kSurfaceBits = 4, kSurfaceMask = 7;
constexpr uint32_t kDarkColumn = 8;  // the first or last column of a wall

inline uint32_t surfaceNumber(uint32_t sector, Surface surface) {
    return sector << kSurfaceBits | surface;
}

constexpr double kNearest = 0.02, kFarthest = 2000;

struct View {
    Point place;
    double eye = 0, angle = 0, shear = 0;
    uint32_t sector = 0;
    uint32_t width = 0, height = 0;  // pixels

    /// Pixels per unit of length at distance 1.
    double scale() const { return height * 0.8; }
};

/// A point seen from the player: `right` of him and at `distance` in the direction he looks in.
struct Seen {
    double right = 0, distance = 0;
};
Seen seenFrom(const View& view, const Point& point);

/// World (x, y, height, 1) to clip space, depth 0..1. Looking up and down shears: vertical edges stay vertical.
glm::mat4 clipTransform(const View& view);

}  // namespace samples
