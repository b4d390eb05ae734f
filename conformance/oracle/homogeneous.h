// Clip space to window space, clipping, facing and interpolation, in any number type: rationals for the exact
// checks, double inside the whole-scene oracle.
//
// Interpolation follows Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates" (1997):
// with vertices v_i = (w x, w y, w) in homogeneous window coordinates, E_i(p) = p . (v_j x v_k) are, up to a
// common factor, the perspective-correct weights of the *unclipped* triangle. No division by w and no new
// vertex is needed, so that clipping by the sides of the view volume is invisible by construction (Vulkan,
// Primitive Clipping).
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <vector>

namespace vernier::conformance::exact {

template <class T>
using Clip = std::array<T, 4>;  // x, y, z, w as the vertex shader wrote them

/// A vertex in homogeneous window coordinates: pixels and depth times w.
template <class T>
struct WindowVertex {
    T x, y, z, w;
};

/// Vulkan, Controlling the Viewport: x_f = (width/2) x_d + x + width/2; z_f = (maxDepth - minDepth) z_d +
/// minDepth.
template <class T>
WindowVertex<T> toWindow(const Clip<T>& p, const VkViewport& viewport) {
    const T halfWidth = T(viewport.width) / T(2), halfHeight = T(viewport.height) / T(2);
    WindowVertex<T> v;
    v.x = p[0] * halfWidth + p[3] * (T(viewport.x) + halfWidth);
    v.y = p[1] * halfHeight + p[3] * (T(viewport.y) + halfHeight);
    v.z = p[2] * (T(viewport.maxDepth) - T(viewport.minDepth)) + p[3] * T(viewport.minDepth);
    v.w = p[3];
    return v;
}

template <class T>
struct HomogeneousTriangle {
    std::array<WindowVertex<T>, 3> vertex;
    std::array<std::array<T, 3>, 3> edge;  // edge[i]: coefficients of x, y, 1 of the weight of vertex i
    T determinant;                         // sign: facing; positive = clockwise on the screen

    explicit HomogeneousTriangle(const std::array<WindowVertex<T>, 3>& vertices) : vertex(vertices) {
        for (size_t i = 0; i < 3; ++i) {
            const WindowVertex<T>& a = vertex[(i + 1) % 3];
            const WindowVertex<T>& b = vertex[(i + 2) % 3];
            edge[i] = {T(a.y * b.w - a.w * b.y), T(a.w * b.x - a.x * b.w), T(a.x * b.y - a.y * b.x)};
        }
        determinant = vertex[0].x * edge[0][0] + vertex[0].y * edge[0][1] + vertex[0].w * edge[0][2];
    }

    /// Perspective weights at a point, up to a common factor whose sign is that of the determinant inside the
    /// visible part.
    std::array<T, 3> weights(const T& x, const T& y) const {
        std::array<T, 3> result;
        for (size_t i = 0; i < 3; ++i) result[i] = edge[i][0] * x + edge[i][1] * y + edge[i][2];
        return result;
    }

    /// sum(b_i f_i) / sum(b_i): smooth (perspective) interpolation, anchored at vertex 0 so that a constant
    /// attribute stays constant in rounded number types too.
    T perspective(const std::array<T, 3>& b, const std::array<T, 3>& f) const {
        return f[0] + T(b[1] * (f[1] - f[0]) + b[2] * (f[2] - f[0])) / T(b[0] + b[1] + b[2]);
    }

    /// Linear in window space: noperspective attributes. The weights are b_i w_i.
    T linear(const std::array<T, 3>& b, const std::array<T, 3>& f) const {
        const T b0 = b[0] * vertex[0].w, b1 = b[1] * vertex[1].w, b2 = b[2] * vertex[2].w;
        return f[0] + T(b1 * (f[1] - f[0]) + b2 * (f[2] - f[0])) / T(b0 + b1 + b2);
    }

    /// Window depth: linear in window space.
    T depth(const std::array<T, 3>& b) const {
        return T(b[0] * vertex[0].z + b[1] * vertex[1].z + b[2] * vertex[2].z) /
               T(b[0] * vertex[0].w + b[1] * vertex[1].w + b[2] * vertex[2].w);
    }

    /// FragCoord.w: the interpolated 1/w.
    T inverseW(const std::array<T, 3>& b) const {
        return T(b[0] + b[1] + b[2]) / T(b[0] * vertex[0].w + b[1] * vertex[1].w + b[2] * vertex[2].w);
    }
};

/// Front or back (Vulkan, Basic Polygon Rasterization): a = -1/2 sum(x_i y_i+1 - x_i+1 y_i) is positive for
/// counter-clockwise on a y-down screen; zero area is back-facing.
inline bool isFrontFacing(int orientation, VkFrontFace frontFace) {
    return frontFace == VK_FRONT_FACE_COUNTER_CLOCKWISE ? orientation < 0 : orientation > 0;
}

/// A vertex of a clipped polygon: its position and what it is made of.
template <class T>
struct ClippedVertex {
    Clip<T> position;
    std::array<T, 3> weight;  // of the triangle's three vertices; they sum to 1
};

/// Keeps the part with distance(position) >= 0. A new vertex is always computed from the inside end to the
/// outside end, so that both triangles at a shared edge get the same one.
template <class T, class Distance>
std::vector<ClippedVertex<T>> clipPolygon(const std::vector<ClippedVertex<T>>& polygon, Distance distance) {
    std::vector<ClippedVertex<T>> result;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const ClippedVertex<T>& a = polygon[i];
        const ClippedVertex<T>& b = polygon[(i + 1) % polygon.size()];
        const T da = distance(a.position), db = distance(b.position);
        const bool aIn = da >= T(0), bIn = db >= T(0);
        if (aIn) result.push_back(a);
        if (aIn == bIn) continue;
        const ClippedVertex<T>& in = aIn ? a : b;
        const ClippedVertex<T>& out = aIn ? b : a;
        const T t = (aIn ? da : db) / T((aIn ? da : db) - (aIn ? db : da));
        ClippedVertex<T> cut;
        for (size_t c = 0; c < 4; ++c) cut.position[c] = in.position[c] + t * (out.position[c] - in.position[c]);
        for (size_t c = 0; c < 3; ++c) cut.weight[c] = in.weight[c] + t * (out.weight[c] - in.weight[c]);
        result.push_back(cut);
    }
    return result;
}

template <class T>
std::vector<ClippedVertex<T>> wholeTriangle(const std::array<Clip<T>, 3>& p) {
    const T zero(0), one(1);
    return {{p[0], {one, zero, zero}}, {p[1], {zero, one, zero}}, {p[2], {zero, zero, one}}};
}

/// The part of a triangle with 0 <= z <= w, planes included. The sides need no clipping.
template <class T>
std::vector<ClippedVertex<T>> clipNearFar(const std::array<Clip<T>, 3>& p) {
    auto polygon = clipPolygon(wholeTriangle(p), [](const Clip<T>& v) { return v[2]; });
    return clipPolygon(polygon, [](const Clip<T>& v) { return T(v[3] - v[2]); });
}

/// The part in front of the eye, w >= minimum with minimum > 0: for depth clamping, where near and far do not
/// clip.
template <class T>
std::vector<ClippedVertex<T>> clipBehindEye(const std::array<Clip<T>, 3>& p, const T& minimum) {
    return clipPolygon(wholeTriangle(p), [&minimum](const Clip<T>& v) { return T(v[3] - minimum); });
}

}  // namespace vernier::conformance::exact
