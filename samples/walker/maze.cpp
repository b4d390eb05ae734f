#include "samples/walker/maze.h"

#include <cstdio>
#include <vector>

#include "samples/common/random.h"

namespace samples {

std::string mazeMap(uint32_t columns, uint32_t rows, uint64_t seed) {
    constexpr int kDx[4] = {0, 1, 0, -1}, kDy[4] = {-1, 0, 1, 0};
    constexpr double kSize = 10;
    Random random(seed);
    const auto cellAt = [&](uint32_t x, uint32_t y) { return size_t{y} * columns + x; };
    std::vector<uint8_t> open(size_t{columns} * rows);  // bit d: no wall towards kDx[d], kDy[d]
    std::vector<int> height(open.size());
    std::vector<bool> seen(open.size());
    std::vector<std::pair<uint32_t, uint32_t>> path{{0, 0}};
    seen[0] = true;
    const auto neighbour = [&](uint32_t x, uint32_t y, uint32_t d, uint32_t& nx, uint32_t& ny) {
        nx = x + static_cast<uint32_t>(kDx[d]);
        ny = y + static_cast<uint32_t>(kDy[d]);
        return nx < columns && ny < rows;
    };
    const auto join = [&](uint32_t x, uint32_t y, uint32_t d, uint32_t nx, uint32_t ny) {
        open[cellAt(x, y)] |= static_cast<uint8_t>(1 << d);
        open[cellAt(nx, ny)] |= static_cast<uint8_t>(1 << (d ^ 2));
    };
    while (!path.empty()) {
        const auto [x, y] = path.back();
        uint32_t ways[4], count = 0, nx = 0, ny = 0;
        for (uint32_t d = 0; d < 4; ++d)
            if (neighbour(x, y, d, nx, ny) && !seen[cellAt(nx, ny)]) ways[count++] = d;
        if (!count) {
            path.pop_back();
            continue;
        }
        const uint32_t d = ways[random.below(count)];
        neighbour(x, y, d, nx, ny);
        join(x, y, d, nx, ny);
        height[cellAt(nx, ny)] = height[cellAt(x, y)] + static_cast<int>(random.below(3)) - 1;
        seen[cellAt(nx, ny)] = true;
        path.push_back({nx, ny});
    }
    for (uint32_t i = 0; i < open.size() / 8; ++i) {
        const uint32_t x = random.below(columns), y = random.below(rows), d = random.below(4);
        uint32_t nx = 0, ny = 0;
        if (neighbour(x, y, d, nx, ny)) join(x, y, d, nx, ny);
    }

    std::string text = "# A maze of " + std::to_string(columns) + " x " + std::to_string(rows) + ".\n";
    for (uint32_t y = 0; y <= rows; ++y) {
        text += "vertex " + std::to_string(y * static_cast<uint32_t>(kSize));
        for (uint32_t x = 0; x <= columns; ++x) text += " " + std::to_string(x * static_cast<uint32_t>(kSize));
        text += "\n";
    }
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t low = y * (columns + 1) + x, high = low + columns + 1;
            const int floor = height[cellAt(x, y)];
            text += "sector " + std::to_string(floor) + " " +
                    std::to_string(floor + 10 + static_cast<int>(random.below(8)));
            for (const uint32_t corner : {low, low + 1, high + 1, high}) text += " " + std::to_string(corner);
            // The edge that ends at the first corner is the left one, then those below, to the right and above.
            for (const uint32_t d : {3u, 0u, 1u, 2u}) {
                uint32_t nx = 0, ny = 0;
                const bool inside = neighbour(x, y, d, nx, ny);
                text += inside && (open[cellAt(x, y)] & 1 << d) ? " " + std::to_string(cellAt(nx, ny)) : " x";
            }
            text += "\n";
        }
    return text + "player 5 5 45 0\n";
}

}  // namespace samples
