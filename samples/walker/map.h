// The world of the walker: sectors, each a convex floor plan with a floor and a ceiling, joined by edges. Read from
// plain text, one record a line, fields parted by blanks or tabs, '#' starts a comment:
//
//   vertex Y X1 X2 ...               adds the vertices (X1, Y), (X2, Y), ...; they are counted from 0 over the whole
//   file sector FLOOR CEIL V1..Vn N1..Nn  n vertices around, then for the edge that ends at each of them (the first
//   begins at
//                                    the last) the sector on its other side; -1 or x: a wall
//   player X Y ANGLE SECTOR          where the walk starts; degrees, counter-clockwise from the x axis
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace samples {

struct Point {
    double x = 0, y = 0;
};

struct Sector {
    double floor = 0, ceiling = 0;
    std::vector<uint32_t> corners;  // counter-clockwise with x to the right and y up
    std::vector<int> neighbours;    // of the edge from corner i - 1 to corner i; -1: a wall

    size_t edgeCount() const { return corners.size(); }
};

struct Map {
    std::vector<Point> vertices;
    std::vector<Sector> sectors;
    Point start;
    double startAngle = 0;  // radians
    uint32_t startSector = 0;

    const Point& edgeStart(const Sector& sector, size_t edge) const {
        return vertices[sector.corners[edge ? edge - 1 : sector.corners.size() - 1]];
    }
    const Point& edgeEnd(const Sector& sector, size_t edge) const { return vertices[sector.corners[edge]]; }
    /// On the edges counts as inside.
    bool contains(uint32_t sector, const Point& point) const;
    Point center(uint32_t sector) const;
};

/// > 0 when `point` lies to the left of the way from `a` to `b`: twice the area of the three.
double sideOf(const Point& a, const Point& b, const Point& point);

/// Reads a map; `name` stands in messages. Returns false and an `error` of the form "name:line: what is wrong".
bool parseMap(const std::string& text, const std::string& name, Map& map, std::string& error);
bool loadMap(const std::string& path, Map& map, std::string& error);

}  // namespace samples
