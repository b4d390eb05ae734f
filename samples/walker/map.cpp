#include "samples/walker/map.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "samples/common/trigonometry.h"

namespace samples {
namespace {

struct Failure {
    size_t line;
    std::string text;
};

std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream stream(line.substr(0, line.find('#')));
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

class Parser {
  public:
    explicit Parser(Map& map) : map_(map) {}

    void run(const std::string& text) {
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);) {
            ++line_;
            const std::vector<std::string> words = wordsOf(line);
            if (words.empty()) continue;
            if (words[0] == "vertex")
                readVertices(words);
            else if (words[0] == "sector")
                readSector(words);
            else if (words[0] == "player")
                readPlayer(words);
            else
                fail("unknown word \"" + words[0] + "\": a line starts with vertex, sector or player");
        }
        if (map_.sectors.empty()) fail("the map has no sector");
        if (!playerLine_) fail("the map has no player");
        // Sectors and vertices may be named before they are there.
        for (uint32_t i = 0; i < map_.sectors.size(); ++i) checkCorners(i);
        for (uint32_t i = 0; i < map_.sectors.size(); ++i) checkNeighbours(i);
        line_ = playerLine_;
        if (playerSector_ >= map_.sectors.size())
            fail("sector " + std::to_string(playerSector_) + " does not exist; there are " +
                 std::to_string(map_.sectors.size()));
        map_.startSector = playerSector_;
        if (!map_.contains(map_.startSector, map_.start))
            fail("the player does not stand in sector " + std::to_string(playerSector_));
    }

  private:
    [[noreturn]] void fail(const std::string& text) { throw Failure{line_, text}; }

    double number(const std::string& word) {
        double value = 0;
        const char* end = word.data() + word.size();
        const auto [rest, status] = std::from_chars(word.data(), end, value);
        if (status != std::errc() || rest != end || !(value >= -1e6 && value <= 1e6))
            fail("\"" + word + "\" is no number from -1000000 to 1000000");
        return value;
    }

    uint32_t index(const std::string& word, const char* of) {
        uint32_t value = 0;
        const char* end = word.data() + word.size();
        const auto [rest, status] = std::from_chars(word.data(), end, value);
        if (status != std::errc() || rest != end) fail("\"" + word + "\" is no index of a " + of);
        return value;
    }

    void readVertices(const std::vector<std::string>& words) {
        if (words.size() < 3) fail("vertex needs Y and at least one X");
        const double y = number(words[1]);
        for (size_t i = 2; i < words.size(); ++i) map_.vertices.push_back({number(words[i]), y});
    }

    void readSector(const std::vector<std::string>& words) {
        Sector sector;
        const size_t count = words.size() < 3 ? 0 : words.size() - 3;
        if (count % 2)
            fail("sector has " + std::to_string(count) +
                 " numbers after its heights: as many vertices as neighbours make " + "an even count");
        if (count < 6) fail("sector needs FLOOR, CEIL, at least 3 vertices and as many neighbours");
        sector.floor = number(words[1]);
        sector.ceiling = number(words[2]);
        if (!(sector.floor < sector.ceiling)) fail("the floor is not below the ceiling");
        for (size_t i = 0; i < count / 2; ++i) sector.corners.push_back(index(words[3 + i], "vertex"));
        for (size_t i = 0; i < count / 2; ++i) {
            const std::string& word = words[3 + count / 2 + i];
            const bool wall = word == "x" || word == "-1";
            sector.neighbours.push_back(wall ? -1 : static_cast<int>(std::min(index(word, "sector"), 0x7FFFFFFFu)));
        }
        map_.sectors.push_back(sector);
        lines_.push_back(line_);
    }

    void readPlayer(const std::vector<std::string>& words) {
        if (words.size() != 5) fail("player needs X, Y, ANGLE and SECTOR");
        if (playerLine_) fail("a second player; the first is in line " + std::to_string(playerLine_));
        map_.start = {number(words[1]), number(words[2])};
        map_.startAngle = number(words[3]) * (kPi / 180);
        playerSector_ = index(words[4], "sector");
        playerLine_ = line_;
    }

    void checkCorners(uint32_t number) {
        line_ = lines_[number];
        Sector& sector = map_.sectors[number];
        for (const uint32_t corner : sector.corners)
            if (corner >= map_.vertices.size())
                fail("vertex " + std::to_string(corner) + " does not exist; there are " +
                     std::to_string(map_.vertices.size()));
        double area = 0;
        const size_t count = sector.edgeCount();
        for (size_t i = 0; i < count; ++i)
            area += sideOf(map_.vertices[sector.corners[0]], map_.edgeStart(sector, i), map_.edgeEnd(sector, i));
        if (area < 0) {
            // Turned round: the edge that ends at the first corner now is the one that started there, hence the + 1.
            std::reverse(sector.corners.begin(), sector.corners.end());
            std::reverse(sector.neighbours.begin() + 1, sector.neighbours.end());
        }
        for (size_t i = 0; i < count; ++i) {
            const Point &a = map_.edgeStart(sector, i), &b = map_.edgeEnd(sector, i);
            if (a.x == b.x && a.y == b.y)
                fail("the edge that ends at vertex " + std::to_string(sector.corners[i]) + " has no length");
            for (const uint32_t corner : sector.corners)
                if (sideOf(a, b, map_.vertices[corner]) < 0)
                    fail("the sector is not convex at vertex " + std::to_string(sector.corners[i]));
        }
        if (area == 0) fail("the sector has no area");
    }

    void checkNeighbours(uint32_t number) {
        line_ = lines_[number];
        const Sector& sector = map_.sectors[number];
        for (size_t i = 0; i < sector.edgeCount(); ++i) {
            const int neighbour = sector.neighbours[i];
            if (neighbour < 0) continue;
            if (static_cast<size_t>(neighbour) >= map_.sectors.size())
                fail("neighbour " + std::to_string(neighbour) + " does not exist; there are " +
                     std::to_string(map_.sectors.size()) + " sectors");
            if (static_cast<uint32_t>(neighbour) == number)
                fail("sector " + std::to_string(number) + " is its own neighbour");
            const uint32_t from = sector.corners[i ? i - 1 : sector.edgeCount() - 1], to = sector.corners[i];
            const Sector& other = map_.sectors[static_cast<size_t>(neighbour)];
            bool back = false;
            for (size_t k = 0; k < other.edgeCount(); ++k)
                back = back || (other.corners[k] == from && other.corners[k ? k - 1 : other.edgeCount() - 1] == to &&
                                other.neighbours[k] == static_cast<int>(number));
            if (!back)
                fail("sector " + std::to_string(neighbour) + " does not point back over the edge between vertices " +
                     std::to_string(from) + " and " + std::to_string(to));
        }
    }

    Map& map_;
    size_t line_ = 0, playerLine_ = 0;
    uint32_t playerSector_ = 0;
    std::vector<size_t> lines_;  // of each sector
};

}  // namespace

double sideOf(const Point& a, const Point& b, const Point& point) {
    return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
}

bool Map::contains(uint32_t number, const Point& point) const {
    const Sector& sector = sectors[number];
    for (size_t i = 0; i < sector.edgeCount(); ++i)
        if (sideOf(edgeStart(sector, i), edgeEnd(sector, i), point) < 0) return false;
    return true;
}

Point Map::center(uint32_t number) const {
    Point sum;
    for (const uint32_t corner : sectors[number].corners) {
        sum.x += vertices[corner].x;
        sum.y += vertices[corner].y;
    }
    const auto count = static_cast<double>(sectors[number].corners.size());
    return {sum.x / count, sum.y / count};
}

bool parseMap(const std::string& text, const std::string& name, Map& map, std::string& error) {
    map = Map();
    try {
        Parser(map).run(text);
        return true;
    } catch (const Failure& failure) {
        error = name + ":" + std::to_string(failure.line) + ": " + failure.text;
        return false;
    }
}

bool loadMap(const std::string& path, Map& map, std::string& error) {
    std::ifstream file(path);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf())) {
        error = path + ": the map could not be read";
        return false;
    }
    return parseMap(text.str(), path, map, error);
}

}  // namespace samples
