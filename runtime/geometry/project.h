// Clip coordinates to window coordinates on the sub-pixel grid, for many vertices at once.
#pragma once

#include <cstdint>

#include "base/simd.h"
#include "runtime/geometry/prepared_draw.h"

namespace vernier {

/// What is known about a vertex. Bits of three vertices are and-ed (all outside one plane: nothing to draw)
/// and or-ed (something to clip).
enum VertexFlag : uint32_t {
    kOutsideLeft = 1,
    kOutsideRight = 2,
    kOutsideTop = 4,
    kOutsideBottom = 8,
    kOutsideNear = 16,
    kOutsideFar = 32,
    kOutsideGuard = 64,  // behind the eye or outside the guard band
    kNotFinite = 128,
    kOutsideUser = 256,  // first of kMaxClipDistances bits
};
/// The exponent of 1/w is far from 0.
inline constexpr uint32_t kUnusualW = kOutsideUser << kMaxClipDistances;
inline constexpr uint32_t kOutsideVolume = 63;
inline constexpr uint32_t kOutsideUserAll = ((1u << kMaxClipDistances) - 1) * kOutsideUser;

struct ProjectionInput {
    const float* clip[4];  // x, y, z, w
    uint32_t count;
    ViewportTransform viewport;
    uint32_t subPixelBits;
    bool depthClip;
    bool negativeOneToOne;  // the near plane is at z = -w
};

/// Arrays of `count` elements, padded to a multiple of 16.
struct ProjectionOutput {
    int32_t* x;  // sub-units, nearest with ties to even; meaningless when flagged kOutsideGuard or kNotFinite
    int32_t* y;
    float* z;
    double* inverseW;
    uint32_t* flags;
};

using ProjectFn = void (*)(const ProjectionInput&, const ProjectionOutput&);
ProjectFn projectFunction(Isa isa);

}  // namespace vernier
