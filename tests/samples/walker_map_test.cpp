// The walker's maps: what is right is read, what is wrong is refused with the line it stands in.
#include "samples/walker/map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "samples/walker/maze.h"
#include "samples/walker/player.h"

namespace samples {
namespace {

using ::testing::HasSubstr;

// Two squares side by side; sector 1 goes round the other way.
const std::string kGood =
    "# two rooms\n"
    "vertex 0 0 10 20\n"
    "vertex 10 0 10 20  # counted on: 3, 4, 5\n"
    "sector 0 10  0 1 4 3  x x 1 -1\n"
    "sector 1 9\t1 4 5 2  x 0 x x\n"
    "player 5 5 90 0\n";

std::string errorOf(const std::string& text) {
    Map map;
    std::string error;
    EXPECT_FALSE(parseMap(text, "test.map", map, error));
    return error;
}

std::string with(const std::string& from, const std::string& to) {
    std::string text = kGood;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    return text.replace(at, from.size(), to);
}

TEST(WalkerMap, ReadsBothDirections) {
    Map map;
    std::string error;
    ASSERT_TRUE(parseMap(kGood, "test.map", map, error)) << error;
    ASSERT_EQ(map.sectors.size(), 2u);
    EXPECT_EQ(map.vertices.size(), 6u);
    EXPECT_EQ(map.sectors[0].neighbours[2], 1);
    // Turned round, the edge over which sector 0 lies still joins vertices 1 and 4.
    const Sector& turned = map.sectors[1];
    for (size_t edge = 0; edge < 4; ++edge) {
        const Point &a = map.edgeStart(turned, edge), &b = map.edgeEnd(turned, edge);
        EXPECT_EQ(turned.neighbours[edge], a.x == 10 && b.x == 10 ? 0 : -1);
        EXPECT_GE(sideOf(a, b, map.center(1)), 0);
    }
    EXPECT_EQ(map.startSector, 0u);
    EXPECT_NEAR(map.startAngle, 1.5707963267948966, 1e-15);
}

TEST(WalkerMap, MissingFile) {
    Map map;
    std::string error;
    EXPECT_FALSE(loadMap("no/such.map", map, error));
    EXPECT_EQ(error, "no/such.map: the map could not be read");
}

TEST(WalkerMap, EveryKindOfError) {
    const struct {
        std::string text, error;
    } cases[] = {
        {with("player 5", "plyer 5"), "test.map:6: unknown word \"plyer\""},
        {with("0 1 4 3  x x 1 -1", "0 1 4 9  x x 1 -1"), "test.map:4: vertex 9 does not exist; there are 6"},
        {with("x x 1 -1", "x x 7 -1"), "test.map:4: neighbour 7 does not exist"},
        {with("x x 1 -1", "x x 1"), "test.map:4: sector has 7 numbers after its heights"},
        {with("x x 1 -1", "x x 0 -1"), "test.map:4: sector 0 is its own neighbour"},
        {with("x 0 x x", "x x x x"), "test.map:4: sector 1 does not point back over the edge between vertices 1 and 4"},
        {with("x 0 x x", "0 x x x"), "test.map:4: sector 1 does not point back"},
        {with("5 5 90 0", "5 5 90 3"), "test.map:6: sector 3 does not exist; there are 2"},
        {with("5 5 90 0", "15 5 90 0"), "test.map:6: the player does not stand in sector 0"},
        {with("5 5 90 0", "5 5 90"), "test.map:6: player needs X, Y, ANGLE and SECTOR"},
        {kGood + "player 5 5 0 0\n", "test.map:7: a second player; the first is in line 6"},
        {with("player 5 5 90 0\n", ""), "the map has no player"},
        {"player 0 0 0 0\n", "the map has no sector"},
        {with("vertex 0 0 10 20", "vertex 0 0 ten 20"), "test.map:2: \"ten\" is no number"},
        {with("vertex 0 0 10 20", "vertex 0 0 nan 20"), "test.map:2: \"nan\" is no number"},
        {with("vertex 0 0 10 20", "vertex 0 0 1e9 20"), "test.map:2: \"1e9\" is no number"},
        {with("vertex 0 0 10 20", "vertex 0"), "test.map:2: vertex needs Y and at least one X"},
        {with("0 1 4 3  x", "0 -1 4 3  x"), "test.map:4: \"-1\" is no index of a vertex"},
        {with("x x 1 -1", "x x 99999999999 -1"), "test.map:4: \"99999999999\" is no index of a sector"},
        {with("sector 0 10 ", "sector 10 10 "), "test.map:4: the floor is not below the ceiling"},
        {with("0 1 4 3  x x 1 -1", "0 1  x x"), "test.map:4: sector needs FLOOR, CEIL, at least 3 vertices"},
        {with("0 1 4 3  x x 1 -1", "0 4 1 3  x x 1 -1"), "test.map:4: the sector"},
        {with("0 1 4 3  x x 1 -1", "0 1 4 4  x x 1 -1"), "test.map:4: the edge that ends at vertex 4 has no length"},
        {with("0 1 4 3  x x 1 -1", "0 1 2  x x x"), "test.map:4: the sector has no area"},
    };
    for (const auto& one : cases) EXPECT_THAT(errorOf(one.text), HasSubstr(one.error)) << one.text;
}

TEST(WalkerMap, MapsOfTheHouse) {
    for (const char* name : {"castle.map", "pillars.map"}) {
        Map map;
        std::string error;
        ASSERT_TRUE(loadMap(std::string(WALKER_MAPS "/") + name, map, error)) << error;
        EXPECT_GE(map.sectors.size(), 20u);
        EXPECT_GE(Guide(map).route().size(), 8u);
    }
}

TEST(WalkerMaze, FiveHundredSectorsInOnePiece) {
    Map map;
    std::string error;
    ASSERT_TRUE(parseMap(mazeMap(25, 20, 3), "maze", map, error)) << error;
    ASSERT_EQ(map.sectors.size(), 500u);
    std::vector<bool> reached(500);
    std::vector<uint32_t> open{0};
    reached[0] = true;
    for (size_t i = 0; i < open.size(); ++i)
        for (const int n : map.sectors[open[i]].neighbours)
            if (n >= 0 && !reached[static_cast<size_t>(n)]) {
                reached[static_cast<size_t>(n)] = true;
                open.push_back(static_cast<uint32_t>(n));
            }
    EXPECT_EQ(open.size(), 500u);
}

/// Rooms in a row along x, 10 wide: floor and ceiling of each.
Map corridor(const std::vector<std::pair<int, int>>& rooms) {
    std::string text = "vertex 0", top = "vertex 10", sectors;
    const size_t count = rooms.size();
    for (size_t i = 0; i <= count; ++i) {
        text += " " + std::to_string(i * 10);
        top += " " + std::to_string(i * 10);
    }
    for (size_t i = 0; i < count; ++i) {
        const auto index = [](size_t n) { return " " + std::to_string(n); };
        sectors += "sector " + std::to_string(rooms[i].first) + " " + std::to_string(rooms[i].second) + index(i) +
                   index(i + 1) + index(count + 2 + i) + index(count + 1 + i);
        sectors += (i ? index(i - 1) : " x") + " x" + (i + 1 < count ? index(i + 1) : " x") + " x\n";
    }
    Map map;
    std::string error;
    EXPECT_TRUE(parseMap(text + "\n" + top + "\n" + sectors + "player 5 5 0 0\n", "corridor", map, error)) << error;
    return map;
}

Player walk(const Map& map, const Intent& intent, int steps) {
    Player player(map);
    for (int i = 0; i < steps; ++i) player.step(intent);
    return player;
}

Intent forward() {
    Intent intent;
    intent.forward = 1;
    return intent;
}

TEST(WalkerPlayer, ClimbsAStepOfAKneeAndNoHigher) {
    const Map low = corridor({{0, 20}, {2, 20}}), high = corridor({{0, 20}, {3, 20}});
    const Player climbed = walk(low, forward(), 120);
    EXPECT_EQ(climbed.sector(), 1u);
    EXPECT_EQ(climbed.feet(), 2);
    const Player stopped = walk(high, forward(), 120);
    EXPECT_EQ(stopped.sector(), 0u);
    EXPECT_NEAR(stopped.place().x, 10 - kBodyRadius, 1e-9);
}

TEST(WalkerPlayer, JumpsOntoWhatIsTooHighToClimb) {
    const Map map = corridor({{0, 30}, {4, 30}});
    Intent intent = forward();
    intent.jump = true;
    EXPECT_EQ(walk(map, intent, 240).sector(), 1u);
}

TEST(WalkerPlayer, DucksUnderALowCeiling) {
    const Map map = corridor({{0, 20}, {0, 5}, {0, 20}});
    EXPECT_EQ(walk(map, forward(), 240).sector(), 0u);
    Intent ducked = forward();
    ducked.duck = true;
    EXPECT_EQ(walk(map, ducked, 400).sector(), 2u);
    // Does not stand up where there is no room.
    Player player(map);
    while (player.sector() != 1) player.step(ducked);
    for (int i = 0; i < 60; ++i) player.step(Intent());
    EXPECT_LT(player.eye(), 5);
}

TEST(WalkerPlayer, FallsIntoAPitWithGravity) {
    const Map map = corridor({{0, 20}, {-50, 20}});
    Player player(map);
    while (player.sector() == 0) player.step(forward());
    EXPECT_GT(player.feet(), -1);
    double before = player.feet(), fastest = 0;
    for (int i = 0; i < 60; ++i) {
        player.step(Intent());
        fastest = std::max(fastest, before - player.feet());
        before = player.feet();
    }
    EXPECT_GT(fastest, 0.3);
    for (int i = 0; i < 120; ++i) player.step(Intent());
    EXPECT_EQ(player.feet(), -50);
    EXPECT_TRUE(player.onGround());
}

TEST(WalkerPlayer, SlidesAlongAWall) {
    const Map map = corridor({{0, 20}, {0, 20}, {0, 20}});
    Player player(map);
    Intent intent = forward();
    intent.turn = 0.5;  // towards the wall at y = 10
    player.step(intent);
    intent.turn = 0;
    for (int i = 0; i < 90; ++i) player.step(intent);
    EXPECT_NEAR(player.place().y, 10 - kBodyRadius, 1e-6);
    EXPECT_GT(player.place().x, 15);
}

TEST(WalkerPlayer, NeverLeavesTheMap) {
    Map map;
    std::string error;
    ASSERT_TRUE(loadMap(WALKER_MAPS "/castle.map", map, error)) << error;
    Player player(map);
    uint32_t random = 1;
    Intent intent;
    for (int i = 0; i < 60000; ++i) {
        random = random * 1664525u + 1013904223u;
        if (i % 23 == 0) {
            intent.forward = (random >> 28 & 3) ? 1 : -1;
            intent.right = static_cast<double>(random >> 26 & 3) - 1;
            intent.turn = (static_cast<double>(random >> 16 & 255) - 127) * 0.0004;
            intent.jump = random >> 15 & 1;
            intent.duck = random >> 14 & 1;
        }
        player.step(intent);
        ASSERT_TRUE(map.contains(player.sector(), player.place())) << "step " << i;
        ASSERT_GE(player.feet(), map.sectors[player.sector()].floor);
    }
}

TEST(WalkerPlayer, TheGuideArrives) {
    Map map;
    std::string error;
    ASSERT_TRUE(loadMap(WALKER_MAPS "/castle.map", map, error)) << error;
    Guide guide(map);
    Player player(map);
    const Point farthest = guide.route()[guide.route().size() / 2];
    bool there = false;
    for (int i = 0; i < 60 * 60; ++i) {
        player.step(guide.intent(player));
        there = there || (std::abs(player.place().x - farthest.x) < 2 && std::abs(player.place().y - farthest.y) < 2);
    }
    EXPECT_TRUE(there);
}

}  // namespace
}  // namespace samples
