#include "conformance/oracle/cube.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::exact {
namespace {

/// A signed axis.
struct Axis {
    size_t index;
    int sign;
};

/// The axes of a face: sc = dot(direction, s), tc = dot(direction, t), and the major one.
struct Face {
    Axis s, t, major;
};
constexpr Face kFaces[6] = {{{2, -1}, {1, -1}, {0, 1}}, {{2, 1}, {1, -1}, {0, -1}}, {{0, 1}, {2, 1}, {1, 1}},
                            {{0, 1}, {2, -1}, {1, -1}}, {{0, 1}, {1, -1}, {2, 1}},  {{0, -1}, {1, -1}, {2, -1}}};

template <class T>
T along(const std::array<T, 3>& v, const Axis& axis) {
    return v[axis.index] * static_cast<T>(axis.sign);
}

}  // namespace

std::vector<CubePlace> cubePlaces(const std::array<double, 3>& direction, const std::array<double, 3>& ddx,
                                  const std::array<double, 3>& ddy, double slack) {
    std::vector<CubePlace> places;
    double most = 0;
    for (const double c : direction) most = std::max(most, std::abs(c));
    if (!(most > 0) || !std::isfinite(most)) return places;
    std::vector<size_t> axes{2, 1, 0};
    // The declared face first, whatever else is near.
    std::ranges::stable_sort(axes, [&](size_t a, size_t b) { return std::abs(direction[a]) > std::abs(direction[b]); });
    for (const size_t axis : axes) {
        if (std::abs(direction[axis]) < most * (1 - slack)) continue;
        CubePlace place;
        place.face = static_cast<uint32_t>(axis * 2 + (direction[axis] < 0 ? 1 : 0));
        const Face& face = kFaces[place.face];
        const double major = along(direction, face.major);
        const auto project = [&](const Axis& minor) { return (along(direction, minor) / major + 1) / 2; };
        // The derivative of the quotient.
        const auto derive = [&](const Axis& minor, const std::array<double, 3>& d) {
            return (along(d, minor) * major - along(direction, minor) * along(d, face.major)) / (2 * major * major);
        };
        place.s = project(face.s);
        place.t = project(face.t);
        place.ddx = {derive(face.s, ddx), derive(face.t, ddx)};
        place.ddy = {derive(face.s, ddy), derive(face.t, ddy)};
        places.push_back(place);
    }
    return places;
}

std::optional<CubeTexel> cubeTexel(uint32_t face, int64_t x, int64_t y, int64_t n) {
    const auto inside = [n](int64_t c) { return c >= 0 && c < n; };
    if (inside(x) && inside(y)) return CubeTexel{face, x, y};
    if (!inside(x) && !inside(y)) return std::nullopt;
    // Centres of texels in units of 1/n from the middle of the face, whose plane lies n away; what reaches over the
    // edge is folded down along the neighbour.
    int64_t sc = 2 * x + 1 - n, tc = 2 * y + 1 - n;
    int64_t& over = inside(x) ? tc : sc;
    const int64_t beyond = std::abs(over) - n;
    over = over < 0 ? -n : n;
    const Face& from = kFaces[face];
    std::array<int64_t, 3> point{};
    point[from.s.index] = sc * from.s.sign;
    point[from.t.index] = tc * from.t.sign;
    point[from.major.index] = (n - beyond) * from.major.sign;
    const size_t axis = inside(x) ? from.t.index : from.s.index;
    const auto neighbour = static_cast<uint32_t>(axis * 2 + (point[axis] < 0 ? 1 : 0));
    const Face& to = kFaces[neighbour];
    return CubeTexel{neighbour, (along(point, to.s) + n - 1) / 2, (along(point, to.t) + n - 1) / 2};
}

}  // namespace vernier::conformance::exact
