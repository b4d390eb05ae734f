#include "samples/walker/columns.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace samples {
namespace {

/// An eye in a doorway is as near to the edge between the sectors as can be, and must still look through.
constexpr double kNearestEdge = 1e-9, kNudge = 1e-6;

/// The view from a place a little nearer to the middle of its sector: never on an edge.
View insideOf(const Map& map, View view) {
    const Point center = map.center(view.sector);
    view.place.x += (center.x - view.place.x) * kNudge;
    view.place.y += (center.y - view.place.y) * kNudge;
    return view;
}

/// Columns from `first` up to `last`, which is not among them, of a sector seen through a portal.
struct Window {
    uint32_t sector;
    int first, last;
};

class ColumnDrawer {
  public:
    ColumnDrawer(const Map& map, const View& view)
        : map_(map),
          view_(insideOf(map, view)),
          top_(view.width, 0),
          bottom_(view.width, static_cast<int>(view.height)) {}

    std::vector<ColumnVertex> run(ColumnStatistics* statistics) {
        std::vector<uint32_t> visits(map_.sectors.size());
        ColumnStatistics counts;
        queue_.push_back({view_.sector, 0, static_cast<int>(view_.width)});
        while (!queue_.empty()) {
            counts.mostQueued = std::max(counts.mostQueued, static_cast<uint32_t>(queue_.size()));
            const Window window = queue_.front();
            queue_.pop_front();
            if (visits[window.sector]++ >= kMostVisits) continue;
            ++counts.windows;
            if (visits[window.sector] == 1) ++counts.sectors;
            for (size_t edge = 0; edge < map_.sectors[window.sector].edgeCount(); ++edge) drawEdge(window, edge);
        }
        if (statistics) *statistics = counts;
        return std::move(lines_);
    }

  private:
    /// The first pixel whose centre is at `position` or beyond, within low..high.
    static int firstCentre(double position, int low, int high) {
        return static_cast<int>(std::clamp(std::ceil(position - 0.5), double(low), double(high)));
    }

    void line(int column, int from, int to, uint32_t number, double depth) {
        if (from >= to) return;
        const float x = static_cast<float>(column) + 0.5f, z = static_cast<float>(depth);
        lines_.push_back({x, static_cast<float>(from), number, z});
        lines_.push_back({x, static_cast<float>(to), number, z});
    }

    void drawEdge(const Window& window, size_t edge) {
        const Sector& sector = map_.sectors[window.sector];
        // Seen from inside, an edge runs from right to left.
        Seen right = seenFrom(view_, map_.edgeStart(sector, edge)), left = seenFrom(view_, map_.edgeEnd(sector, edge));
        if (right.distance <= kNearestEdge && left.distance <= kNearestEdge) return;
        const auto clip = [](Seen& behind, const Seen& other) {
            const double t = (kNearestEdge - behind.distance) / (other.distance - behind.distance);
            behind = {behind.right + t * (other.right - behind.right), kNearestEdge};
        };
        if (right.distance < kNearestEdge) clip(right, left);
        if (left.distance < kNearestEdge) clip(left, right);
        const double scale = view_.scale(), middle = view_.width / 2.0;
        const double xLeft = middle + left.right * scale / left.distance;
        const double xRight = middle + right.right * scale / right.distance;
        if (!(xLeft < xRight)) return;  // seen from behind
        const int first = firstCentre(xLeft, window.first, window.last);
        const int last = firstCentre(xRight, window.first, window.last);
        const int width = static_cast<int>(view_.width);
        const int darkFirst = firstCentre(xLeft, -1, width), darkLast = firstCentre(xRight, -1, width) - 1;
        const int neighbour = sector.neighbours[edge];
        for (int column = first; column < last; ++column) {
            // 1 / distance is linear in the picture.
            const double t = (column + 0.5 - xLeft) / (xRight - xLeft);
            const double inverse = 1 / left.distance + t * (1 / right.distance - 1 / left.distance);
            const bool dark = column == darkFirst || column == darkLast;
            drawColumn(window.sector, neighbour, column, inverse, dark ? kDarkColumn : 0);
        }
        if (neighbour >= 0 && first < last && queue_.size() < kMostQueued)
            queue_.push_back({static_cast<uint32_t>(neighbour), first, last});
    }

    void drawColumn(uint32_t number, int neighbour, int column, double inverse, uint32_t dark) {
        const Sector& sector = map_.sectors[number];
        const auto at = static_cast<size_t>(column);
        int &top = top_[at], &bottom = bottom_[at];
        const auto rowOf = [&](double height, int low) {
            const double y = view_.height / 2.0 - ((height - view_.eye) * inverse + view_.shear) * view_.scale();
            return firstCentre(y, low, std::max(low, bottom));
        };
        const int wallTop = rowOf(sector.ceiling, top), wallBottom = rowOf(sector.floor, wallTop);
        const double distance = 1 / inverse;
        line(column, top, wallTop, surfaceNumber(number, kCeiling), sector.ceiling - view_.eye);
        line(column, wallBottom, bottom, surfaceNumber(number, kFloor), sector.floor - view_.eye);
        if (neighbour < 0) {
            line(column, wallTop, wallBottom, surfaceNumber(number, kWall) | dark, distance);
            top = bottom;
            return;
        }
        const Sector& other = map_.sectors[static_cast<size_t>(neighbour)];
        const int holeTop = std::min(rowOf(other.ceiling, wallTop), wallBottom);
        const int holeBottom = std::min(rowOf(other.floor, holeTop), wallBottom);
        line(column, wallTop, holeTop, surfaceNumber(number, kUpperStep) | dark, distance);
        line(column, holeBottom, wallBottom, surfaceNumber(number, kLowerStep) | dark, distance);
        top = holeTop;
        bottom = holeBottom;
    }

    const Map& map_;
    const View view_;
    std::vector<int> top_, bottom_;  // of each column: the rows still free, bottom_ not among them
    std::deque<Window> queue_;
    std::vector<ColumnVertex> lines_;
};

}  // namespace

std::vector<ColumnVertex> drawColumns(const Map& map, const View& view, ColumnStatistics* statistics) {
    return ColumnDrawer(map, view).run(statistics);
}

}  // namespace samples
