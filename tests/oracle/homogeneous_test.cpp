// Hand-computed clipping, viewport, facing and interpolation, in rationals.
#include "conformance/oracle/homogeneous.h"
#include "conformance/oracle/coverage.h"
#include "conformance/oracle/exact.h"

#include <gtest/gtest.h>

namespace vernier::conformance::exact {
namespace {

using Q = Rational;
constexpr VkViewport kViewport{0, 0, 8, 8, 0, 1};

HomogeneousTriangle<Q> triangle(const std::array<Clip<Q>, 3>& p, const VkViewport& viewport = kViewport) {
    return HomogeneousTriangle<Q>({toWindow(p[0], viewport), toWindow(p[1], viewport), toWindow(p[2], viewport)});
}

TEST(Viewport, CornersAndNegativeHeight) {
    const WindowVertex<Q> v = toWindow<Q>({-1, -1, 0, 1}, kViewport);
    EXPECT_EQ(v.x, 0);
    EXPECT_EQ(v.y, 0);
    const WindowVertex<Q> flipped = toWindow<Q>({-1, -1, fraction(1, 2), 1}, {0, 8, 8, -8, 0.25f, 0.75f});
    EXPECT_EQ(flipped.y, 8);
    EXPECT_EQ(flipped.z, fraction(1, 2));
    const WindowVertex<Q> far = toWindow<Q>({1, 1, 2, 2}, kViewport);
    EXPECT_EQ(far.x / far.w, 6);
    EXPECT_EQ(far.z / far.w, 1);
}

TEST(Facing, SignsOnAScreenWithYDown) {
    // (-1,-1) (1,-1) (-1,1): right, then down: clockwise on the screen.
    const auto t = triangle({Clip<Q>{-1, -1, 0, 1}, Clip<Q>{1, -1, 0, 1}, Clip<Q>{-1, 1, 0, 1}});
    EXPECT_GT(t.determinant, 0);
    EXPECT_EQ(orientation({GridPoint{0, 0}, GridPoint{2048, 0}, GridPoint{0, 2048}}), 1);
    EXPECT_FALSE(isFrontFacing(1, VK_FRONT_FACE_COUNTER_CLOCKWISE));
    EXPECT_TRUE(isFrontFacing(1, VK_FRONT_FACE_CLOCKWISE));
    EXPECT_FALSE(isFrontFacing(0, VK_FRONT_FACE_CLOCKWISE));
    EXPECT_FALSE(isFrontFacing(0, VK_FRONT_FACE_COUNTER_CLOCKWISE));
}

// I01: constant in, constant out, in perspective.
TEST(Interpolation, ConstantStaysConstant) {
    const auto t = triangle({Clip<Q>{-1, -1, 0, 1}, Clip<Q>{3, -3, 1, 3}, Clip<Q>{-7, 7, 2, 7}});
    const auto b = t.weights(fraction(5, 2), fraction(7, 2));
    EXPECT_EQ(t.perspective(b, {1, 1, 1}), 1);
    EXPECT_EQ(t.linear(b, {1, 1, 1}), 1);
}

// I05 by hand: an edge from w = 1 at x = 0 to w = 3 at x = 8; half-way on the screen the attribute 0..1 is
// 1/4.
TEST(Interpolation, PerspectiveAndLinear) {
    const auto t = triangle({Clip<Q>{-1, -1, 0, 1}, Clip<Q>{3, -3, 3, 3}, Clip<Q>{-1, 1, 0, 1}});
    const auto b = t.weights(4, 0);
    EXPECT_EQ(t.perspective(b, {0, 1, 0}), fraction(1, 4));
    EXPECT_EQ(t.linear(b, {0, 1, 0}), fraction(1, 2));
    EXPECT_EQ(t.depth(b), fraction(1, 2));
    // 1/w is linear: (1 + 1/3) / 2.
    EXPECT_EQ(t.inverseW(b), fraction(2, 3));
}

// W06: scaling the clip coordinates by a power of two changes nothing.
TEST(Interpolation, HomogeneousScaling) {
    const std::array<Clip<Q>, 3> p{Clip<Q>{-1, -1, 0, 1}, Clip<Q>{3, -2, 1, 3}, Clip<Q>{-1, 2, 1, 2}};
    std::array<Clip<Q>, 3> scaled = p;
    for (auto& v : scaled) {
        for (Q& c : v) c *= powerOfTwo(-100);
    }
    const auto a = triangle(p), s = triangle(scaled);
    EXPECT_EQ(a.perspective(a.weights(3, 3), {1, 5, 9}), s.perspective(s.weights(3, 3), {1, 5, 9}));
    EXPECT_EQ(a.depth(a.weights(3, 3)), s.depth(s.weights(3, 3)));
}

// C02: both triangles at a clipped shared edge introduce the same vertex.
TEST(Clipping, SharedEdgeGetsTheSameNewVertex) {
    const Clip<Q> a{-1, 0, fraction(-1, 3), 1}, b{fraction(1, 2), fraction(1, 7), fraction(5, 7), 2},
        c{0, -1, fraction(1, 2), 1}, d{0, 1, fraction(1, 3), 1};
    const auto first = clipNearFar<Q>({a, b, c}), second = clipNearFar<Q>({b, a, d});
    int common = 0;
    for (const auto& v : first) {
        for (const auto& u : second) common += v.position == u.position;
    }
    EXPECT_EQ(common, 2) << "b, and the new vertex on a-b";
    for (const auto& v : first) {
        EXPECT_GE(v.position[2], 0);
        EXPECT_EQ(v.weight[0] + v.weight[1] + v.weight[2], 1);
    }
}

// C07: vertices on the planes are inside; W03: behind the eye is nothing.
TEST(Clipping, PlanesAreInside) {
    EXPECT_EQ(clipNearFar<Q>({Clip<Q>{0, 0, 0, 1}, Clip<Q>{1, 0, 1, 1}, Clip<Q>{0, 1, 0, 1}}).size(), 3u);
    EXPECT_TRUE(clipNearFar<Q>({Clip<Q>{0, 0, -1, -1}, Clip<Q>{1, 0, -1, -2}, Clip<Q>{0, 1, -1, -1}}).empty());
    const auto cut =
        clipBehindEye<Q>({Clip<Q>{0, 0, 0, 1}, Clip<Q>{4, 0, 0, -1}, Clip<Q>{0, 4, 0, 1}}, powerOfTwo(-20));
    EXPECT_EQ(cut.size(), 4u);
    for (const auto& v : cut) EXPECT_GT(v.position[3], 0);
}

// W04: an external triangle keeps the facing of its visible part.
TEST(Clipping, ExternalTriangleFacing) {
    const std::array<Clip<Q>, 3> p{Clip<Q>{-1, -1, fraction(1, 2), 1}, Clip<Q>{1, -1, fraction(1, 2), 1},
                                   Clip<Q>{0, -5, fraction(-1, 2), -1}};
    const auto whole = triangle(p);
    const auto part = clipNearFar<Q>(p);
    ASSERT_GE(part.size(), 3u);
    const auto visible = triangle({part[0].position, part[1].position, part[2].position});
    EXPECT_EQ(sgn(whole.determinant), sgn(visible.determinant));
}

}  // namespace
}  // namespace vernier::conformance::exact
