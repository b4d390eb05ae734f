// Texels beyond the edge of a cube face ("Cube Map Edge Handling" of the Vulkan specification), in exact
// integers.
#pragma once

#include <cstdint>

namespace vernier {

struct CubeTexel {
    int32_t face, x, y;
};

/// Axis and sign of the face's s coordinate, t coordinate and major axis in (x, y, z), by "Cube Map Face
/// Selection".
struct CubeFace {
    int8_t sAxis, sSign, tAxis, tSign, majorAxis, majorSign;
};

inline constexpr CubeFace kCubeFaces[6] = {
    {2, -1, 1, -1, 0, +1}, {2, +1, 1, -1, 0, -1},  // +X, -X
    {0, +1, 2, +1, 1, +1}, {0, +1, 2, -1, 1, -1},  // +Y, -Y
    {0, +1, 1, -1, 2, +1}, {0, -1, 1, -1, 2, -1},  // +Z, -Z
};

/// The texel one step beyond an edge: exactly one of x and y is -1 or `size`, the other inside. Works on the
/// cube of edge 2 * size centred on the origin, where texel centres have odd coordinates on a face: the texel
/// is folded over the edge.
constexpr CubeTexel foldOverEdge(CubeTexel texel, int32_t size) {
    const CubeFace& from = kCubeFaces[texel.face];
    int32_t s = 2 * texel.x + 1 - size, t = 2 * texel.y + 1 - size, major = size;
    if (s < -size || s > size) {
        s = s < 0 ? -size : size;
        --major;
    } else if (t < -size || t > size) {
        t = t < 0 ? -size : size;
        --major;
    }
    int32_t point[3] = {};
    point[from.sAxis] = s * from.sSign;
    point[from.tAxis] = t * from.tSign;
    point[from.majorAxis] = major * from.majorSign;
    for (int32_t face = 0; face < 6; ++face) {
        const CubeFace& to = kCubeFaces[face];
        if (point[to.majorAxis] * to.majorSign != size) continue;
        return {face, (point[to.sAxis] * to.sSign + size - 1) / 2, (point[to.tAxis] * to.tSign + size - 1) / 2};
    }
    return texel;
}

}  // namespace vernier
