// The two versions of the walker show the same surface of the same sector in every pixel, but for those at the edges
// between surfaces: there the column version decides with the edge itself, the rasteriser with the edge snapped to a
// 256th of a pixel and vertices rounded to float. So a pixel may differ where one of the eight around it shows, in one
// of the pictures, what the other picture has in this one (surfaces thinner than a pixel are in one picture alone); and
// few pixels may.
#include <gtest/gtest.h>

#include "samples/walker/maze.h"
#include "samples/walker/player.h"
#include "samples/walker/renderer.h"

namespace samples {
namespace {

constexpr uint32_t kWidth = 320, kHeight = 200;

AppOptions options() {
    AppOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.headless = "nothing is written";
    return options;
}

class Comparison {
  public:
    explicit Comparison(const Map& map) : app_(options()), renderer_(app_, map) {
        numbers_ = app_.target(VK_FORMAT_R32_UINT, kWidth, kHeight);
    }

    void compare(const Player& player, double shear) {
        View view;
        view.place = player.place();
        view.eye = player.eye();
        view.angle = player.angle();
        view.shear = shear;
        view.sector = player.sector();
        view.width = kWidth;
        view.height = kHeight;
        renderer_.drawColumns(view, &numbers_);
        const std::vector<uint32_t> columns = read();
        ASSERT_LT(renderer_.statistics().mostQueued, kMostQueued);
        renderer_.drawSolid(view, &numbers_);
        const std::vector<uint32_t> solid = read();
        uint32_t different = 0, shown = 0;
        uint32_t last = 0;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                const uint32_t a = columns[y * kWidth + x], b = solid[y * kWidth + x];
                ASSERT_NE(a, 0u) << "a hole at " << x << ", " << y;
                if (a != last) ++shown, last = a;
                if (a == b) continue;
                ++different;
                EXPECT_TRUE(near(solid, x, y, a) || near(columns, x, y, b))
                    << "pixel " << x << ", " << y << ": columns " << a << ", triangles " << b << "; player at "
                    << view.place.x << ", " << view.place.y << " in sector " << view.sector;
            }
        EXPECT_LT(different, kWidth * kHeight / 200);
        EXPECT_GT(shown, 3u);
    }

  private:
    std::vector<uint32_t> read() {
        std::vector<uint32_t> pixels(size_t{kWidth} * kHeight);
        must(vnReadImage(app_.context(), numbers_.image, nullptr, pixels.data(), pixels.size() * 4));
        return pixels;
    }
    static bool near(const std::vector<uint32_t>& picture, uint32_t x, uint32_t y, uint32_t number) {
        for (uint32_t v = y ? y - 1 : 0; v <= std::min(y + 1, kHeight - 1); ++v)
            for (uint32_t u = x ? x - 1 : 0; u <= std::min(x + 1, kWidth - 1); ++u)
                if (picture[v * kWidth + u] == number) return true;
        return false;
    }

    App app_;
    WalkerRenderer renderer_;
    Target numbers_;
};

void walkAndCompare(const Map& map, int pictures, int stepsBetween) {
    Comparison comparison(map);
    Player player(map);
    Guide guide(map);
    for (int i = 0; i < pictures && !::testing::Test::HasFailure(); ++i) {
        comparison.compare(player, (i % 5 - 2) * 0.3);
        for (int step = 0; step < stepsBetween; ++step) player.step(guide.intent(player));
    }
}

TEST(WalkerVisibility, Castle) {
    Map map;
    std::string error;
    ASSERT_TRUE(loadMap(WALKER_MAPS "/castle.map", map, error)) << error;
    walkAndCompare(map, 60, 37);
}

TEST(WalkerVisibility, Pillars) {
    Map map;
    std::string error;
    ASSERT_TRUE(loadMap(WALKER_MAPS "/pillars.map", map, error)) << error;
    walkAndCompare(map, 40, 23);
}

TEST(WalkerVisibility, Maze) {
    Map map;
    std::string error;
    ASSERT_TRUE(parseMap(mazeMap(25, 20, 1), "maze", map, error)) << error;
    walkAndCompare(map, 30, 60);
}

// In a doorway, on the very edge, and as near to it as numbers come.
TEST(WalkerVisibility, OnTheEdge) {
    const std::string rooms =
        "vertex 0 0 10 20\nvertex 10 0 10 20\n"
        "sector 0 10  0 1 4 3  x x 1 x\nsector 1 9  1 2 5 4  0 x x x\n";
    const auto start = [&](const char* x, const char* angle) {
        Map map;
        std::string error;
        EXPECT_TRUE(parseMap(rooms + "player " + x + " 5 " + angle + " 0\n", "rooms", map, error)) << error;
        return map;
    };
    const Map map = start("5", "0");
    Comparison comparison(map);
    for (const char* x : {"10", "9.999999999999", "9.99"})
        for (const char* angle : {"0", "90", "180", "30"}) {
            const Map here = start(x, angle);
            comparison.compare(Player(here), 0.1);
        }
}

}  // namespace
}  // namespace samples
