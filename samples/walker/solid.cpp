#include "samples/walker/solid.h"

#include <algorithm>
#include <cmath>

#include "samples/walker/view.h"

namespace samples {

std::vector<SolidVertex> solidOf(const Map& map) {
    std::vector<SolidVertex> vertices;
    const auto at = [](const Point& p, double height) {
        return glm::vec3(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(height));
    };
    for (uint32_t number = 0; number < map.sectors.size(); ++number) {
        const Sector& sector = map.sectors[number];
        const auto corner = [&](size_t i, double height) { return at(map.vertices[sector.corners[i]], height); };
        // Fans; the corners run counter-clockwise seen from above.
        for (size_t i = 1; i + 1 < sector.edgeCount(); ++i) {
            for (const size_t k : {size_t{0}, i + 1, i})
                vertices.push_back({corner(k, sector.floor), surfaceNumber(number, kFloor), {0, 0}});
            for (const size_t k : {size_t{0}, i, i + 1})
                vertices.push_back({corner(k, sector.ceiling), surfaceNumber(number, kCeiling), {0, 0}});
        }
        for (size_t edge = 0; edge < sector.edgeCount(); ++edge) {
            const Point &a = map.edgeStart(sector, edge), &b = map.edgeEnd(sector, edge);
            const auto length = static_cast<float>(std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y)));
            const auto wall = [&](double low, double high, Surface surface) {
                if (!(low < high)) return;
                const uint32_t name = surfaceNumber(number, surface);
                // Seen from inside a is to the right.
                const SolidVertex corners[4] = {{at(b, high), name, {length, length}},
                                                {at(a, high), name, {0, length}},
                                                {at(a, low), name, {0, length}},
                                                {at(b, low), name, {length, length}}};
                for (const int k : {0, 1, 2, 0, 2, 3}) vertices.push_back(corners[k]);
            };
            if (sector.neighbours[edge] < 0) {
                wall(sector.floor, sector.ceiling, kWall);
                continue;
            }
            const Sector& other = map.sectors[static_cast<size_t>(sector.neighbours[edge])];
            wall(std::max(other.ceiling, sector.floor), sector.ceiling, kUpperStep);
            wall(sector.floor, std::min(other.floor, sector.ceiling), kLowerStep);
        }
    }
    return vertices;
}

}  // namespace samples
