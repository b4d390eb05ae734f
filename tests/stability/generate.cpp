#include "tests/stability/generate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace vernier::stability {
namespace {

class Random {
  public:
    explicit Random(uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15u + 1) {}
    /// 0 .. limit - 1.
    int64_t below(int64_t limit) { return static_cast<int64_t>(engine_() % static_cast<uint64_t>(limit)); }
    int64_t between(int64_t low, int64_t high) { return low + below(high - low + 1); }
    bool flip() { return below(2) != 0; }
    /// In [0, 1), of 24 bits.
    double unit() { return static_cast<double>(engine_() >> 40) * 0x1p-24; }
    double within(double low, double high) { return low + (high - low) * unit(); }
    std::mt19937_64& engine() { return engine_; }

  private:
    std::mt19937_64 engine_;
};

struct GridPoint {
    int64_t x, y;
};
using GridTriangle = std::array<size_t, 3>;  // clockwise on the screen

int64_t cross(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

struct GridMesh {
    std::vector<GridPoint> points;
    std::vector<GridTriangle> triangles;
};

/// Gives the edge that two triangles share to their other two corners, where the four make a convex figure.
void flipEdge(GridMesh& mesh, Random& random) {
    const auto first = static_cast<size_t>(random.below(static_cast<int64_t>(mesh.triangles.size())));
    const auto side = static_cast<size_t>(random.below(3));
    GridTriangle& t = mesh.triangles[first];
    const size_t a = t[side], b = t[(side + 1) % 3], c = t[(side + 2) % 3];
    for (GridTriangle& other : mesh.triangles) {
        for (size_t k = 0; k < 3; ++k) {
            if (other[k] != b || other[(k + 1) % 3] != a) continue;
            const size_t d = other[(k + 2) % 3];
            const auto& p = mesh.points;
            if (cross(p[c], p[a], p[d]) <= 0 || cross(p[d], p[b], p[c]) <= 0) return;
            t = {c, a, d};
            other = {d, b, c};
            return;
        }
    }
}

/// Points in steps of 1/16 pixel inside [4, 60] x [4, 60].
GridMesh gridMesh(Random& random) {
    constexpr int64_t kLow = 64, kHigh = 960;
    GridMesh mesh{{{kLow, kLow}, {kHigh, kLow}, {kLow, kHigh}, {kHigh, kHigh}}, {{0, 1, 2}, {3, 2, 1}}};
    const int64_t count = random.between(1, 40);
    const bool clustered = random.flip();
    for (int64_t n = 0; n < count; ++n) {
        GridPoint p{random.between(kLow + 1, kHigh - 1), random.between(kLow + 1, kHigh - 1)};
        if (clustered) p = {512 + random.between(-40, 40), 512 + random.between(-40, 40)};
        // Centres and edges of pixels more often than chance has it.
        if (random.below(3) == 0) p = {p.x / 16 * 16 + 8, p.y / 16 * 16 + 8};
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const GridTriangle t = mesh.triangles[i];
            const auto& v = mesh.points;
            if (cross(v[t[0]], v[t[1]], p) <= 0 || cross(v[t[1]], v[t[2]], p) <= 0 || cross(v[t[2]], v[t[0]], p) <= 0)
                continue;
            const size_t own = mesh.points.size();
            mesh.points.push_back(p);
            mesh.triangles[i] = {t[0], t[1], own};
            mesh.triangles.push_back({t[1], t[2], own});
            mesh.triangles.push_back({t[2], t[0], own});
            break;
        }
    }
    for (int64_t n = random.between(0, 60); n > 0; --n) flipEdge(mesh, random);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random.engine());
    return mesh;
}

template <class Place>
Soup soupOf(const GridMesh& mesh, Random& random, Place place) {
    std::vector<Position> positions;
    for (const GridPoint& p : mesh.points) positions.push_back(place(p));
    Soup soup;
    for (const GridTriangle& t : mesh.triangles) {
        const auto turn = static_cast<size_t>(random.below(3));
        soup.push_back({positions[t[turn]], positions[t[(turn + 1) % 3]], positions[t[(turn + 2) % 3]]});
        if (random.below(4) == 0) std::swap(soup.back()[0], soup.back()[1]);
    }
    return soup;
}

/// Of any magnitude between 2^-low and 2^high, and either sign.
float magnitude(Random& random, int low, int high) {
    const double size = std::exp2(static_cast<double>(random.between(low, high))) * random.within(1, 2);
    return static_cast<float>(random.flip() ? size : -size);
}

Position somewhere(Random& random) {
    switch (random.below(6)) {
        case 0:  // near the middle, in perspective
        case 1:
        case 2: {
            const auto w = static_cast<float>(random.within(0.25, 8));
            return {static_cast<float>(random.within(-1.4, 1.4)) * w, static_cast<float>(random.within(-1.4, 1.4)) * w,
                    static_cast<float>(random.within(-0.2, 1.2)) * w, w};
        }
        case 3:  // far outside, or behind the eye
            return {magnitude(random, -4, 20), magnitude(random, -4, 20), magnitude(random, -4, 4),
                    magnitude(random, -10, 10)};
        case 4:  // almost at the eye
            return {magnitude(random, -30, 0), magnitude(random, -30, 0), magnitude(random, -30, 0),
                    std::abs(magnitude(random, -40, -1))};
        default:  // on the grid
            return atWindow(static_cast<double>(random.between(0, 1024)) / 16,
                            static_cast<double>(random.between(0, 1024)) / 16);
    }
}

}  // namespace

Soup triangulation(uint64_t seed) {
    Random random(seed);
    const GridMesh mesh = gridMesh(random);
    return soupOf(mesh, random, [](const GridPoint& p) {
        return atWindow(static_cast<double>(p.x) / 16, static_cast<double>(p.y) / 16);
    });
}

Soup offGrid(uint64_t seed) {
    Random random(seed);
    const GridMesh mesh = gridMesh(random);
    return soupOf(mesh, random, [&random](const GridPoint& p) {
        return atWindow(static_cast<double>(p.x) / 16 + random.within(-0.03, 0.03),
                        static_cast<double>(p.y) / 16 + random.within(-0.03, 0.03));
    });
}

Soup fan(uint64_t seed) {
    Random random(seed);
    const GridPoint hub =
        random.flip() ? GridPoint{520, 520} : GridPoint{random.between(400, 600), random.between(400, 600)};
    const int64_t count = random.between(3, 64);
    GridMesh mesh{{hub}, {}};
    double angle = random.within(0, 6);
    for (int64_t i = 0; i < count; ++i) {
        const double radius = random.within(60, 380);
        mesh.points.push_back(
            {hub.x + std::llround(radius * std::cos(angle)), hub.y + std::llround(radius * std::sin(angle))});
        angle += 6.283185307179586 / static_cast<double>(count);
    }
    for (int64_t i = 0; i < count; ++i) {
        const size_t a = 1 + static_cast<size_t>(i), b = 1 + static_cast<size_t>((i + 1) % count);
        if (cross(hub, mesh.points[a], mesh.points[b]) > 0) mesh.triangles.push_back({0, a, b});
    }
    return soupOf(mesh, random, [](const GridPoint& p) {
        return atWindow(static_cast<double>(p.x) / 16, static_cast<double>(p.y) / 16);
    });
}

Soup slivers(uint64_t seed) {
    Random random(seed);
    // In steps of 1/16 pixel; the lines are one to five of them apart.
    const GridPoint from{random.between(20, 300), random.between(20, 1000)},
        to{random.between(700, 1000), random.between(20, 1000)};
    const int64_t gap = random.between(1, 5), count = random.between(2, 20);
    GridMesh mesh;
    for (int64_t i = 0; i <= count; ++i) {
        const GridPoint p{from.x + (to.x - from.x) * i / count, from.y + (to.y - from.y) * i / count};
        mesh.points.push_back(p);
        mesh.points.push_back({p.x, p.y + gap});
    }
    for (size_t i = 0; i + 3 < mesh.points.size(); i += 2) {
        mesh.triangles.push_back({i, i + 2, i + 1});
        mesh.triangles.push_back({i + 2, i + 3, i + 1});
    }
    return soupOf(mesh, random, [](const GridPoint& p) {
        return atWindow(static_cast<double>(p.x) / 16, static_cast<double>(p.y) / 16);
    });
}

Soup clippedSheet(uint64_t seed) {
    Random random(seed);
    const GridMesh mesh = gridMesh(random);
    // Three vectors of clip space span the sheet: a corner before the eye, and edges that may lead behind it.
    const auto vector = [&random](double size, double w) {
        return std::array<double, 4>{random.within(-size, size), random.within(-size, size), random.within(-1, 1) * w,
                                     random.within(-1, 1) * w};
    };
    std::array<double, 4> corner = vector(0.8, 0.2), u = vector(2.5, 2), v = vector(2.5, 2);
    corner[3] = random.within(0.5, 2);
    corner[2] = corner[3] * random.within(0.1, 0.9);
    if (random.below(3) == 0) u[3] = v[3] = 0;  // level: cut by near and far alone
    return soupOf(mesh, random, [&](const GridPoint& p) {
        const double s = static_cast<double>(p.x - 64) / 896, t = static_cast<double>(p.y - 64) / 896;
        Position result;
        for (size_t c = 0; c < 4; ++c) result[c] = static_cast<float>(corner[c] + s * u[c] + t * v[c]);
        return result;
    });
}

Soup heap(uint64_t seed) {
    Random random(seed);
    Soup soup(static_cast<size_t>(random.between(1, 60)));
    for (Triangle& triangle : soup) {
        for (Position& p : triangle) p = somewhere(random);
    }
    return soup;
}

Soup degenerate(uint64_t seed) {
    Random random(seed);
    Soup soup = heap(seed ^ 0x5555);
    for (Triangle& triangle : soup) {
        switch (random.below(5)) {
            case 0:
                triangle[2] = triangle[0];
                break;
            case 1:
                triangle[1] = triangle[2] = triangle[0];
                break;
            case 2:
                for (size_t c = 0; c < 4; ++c) triangle[2][c] = (triangle[0][c] + triangle[1][c]) / 2;
                break;
            case 3:
                triangle[2] = triangle[0];
                triangle[2][random.flip() ? 0 : 1] = std::nextafter(triangle[0][0], 9.0f);
                break;
            default:
                break;
        }
    }
    return soup;
}

Soup poisoned(uint64_t seed) {
    Random random(seed);
    Soup soup = heap(seed ^ 0xAAAA);
    constexpr float kSpecial[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                                  -std::numeric_limits<float>::infinity()};
    for (Triangle& triangle : soup) {
        if (random.below(3) != 0) continue;
        triangle[static_cast<size_t>(random.below(3))][static_cast<size_t>(random.below(4))] =
            kSpecial[random.below(3)];
    }
    return soup;
}

}  // namespace vernier::stability
