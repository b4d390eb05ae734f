#include "samples/walker/player.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "samples/common/trigonometry.h"

namespace samples {
namespace {

constexpr double kSpeed = 14, kDuckSpeed = 6, kGravity = 45, kJumpSpeed = 16;
constexpr double kTurnPerStep = 0.05, kSteepestShear = 1.2;

bool rangesOverlap(double a0, double a1, double b0, double b1) {
    return std::min(a0, a1) <= std::max(b0, b1) && std::min(b0, b1) <= std::max(a0, a1);
}

/// Whether the ways a0-a1 and b0-b1 share a point of the plane, up to touching boxes.
bool boxesOverlap(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
    return rangesOverlap(a0.x, a1.x, b0.x, b1.x) && rangesOverlap(a0.y, a1.y, b0.y, b1.y);
}

double length(const Point& a, const Point& b) {
    return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
}

}  // namespace

Player::Player(const Map& map)
    : map_(map),
      place_(map.start),
      feet_(map.sectors[map.startSector].floor),
      angle_(map.startAngle),
      sector_(map.startSector) {}

bool Player::canPass(const Sector& sector, size_t edge) const {
    if (sector.neighbours[edge] < 0) return false;
    const Sector& other = map_.sectors[static_cast<size_t>(sector.neighbours[edge])];
    const double low = std::max(sector.floor, other.floor), high = std::min(sector.ceiling, other.ceiling);
    return low - feet_ <= kKneeHeight && high - std::max(feet_, low) >= bodyHeight_ + kHeadMargin;
}

/// Pushes the target away from what cannot be passed: what remains of the motion runs along it.
Point Player::slide(Point target) const {
    const Sector& sector = map_.sectors[sector_];
    for (int round = 0; round < 3; ++round)
        for (size_t edge = 0; edge < sector.edgeCount(); ++edge) {
            if (canPass(sector, edge)) continue;
            const Point &a = map_.edgeStart(sector, edge), &b = map_.edgeEnd(sector, edge);
            const double wall = length(a, b), dx = (b.x - a.x) / wall, dy = (b.y - a.y) / wall;
            const double along = (target.x - a.x) * dx + (target.y - a.y) * dy;
            if (along >= 0 && along <= wall) {
                // The normal to the left of an edge points inside.
                const double distance = sideOf(a, b, target) / wall;
                if (distance >= kBodyRadius) continue;
                target.x -= dy * (kBodyRadius - distance);
                target.y += dx * (kBodyRadius - distance);
            } else {
                const Point& corner = along < 0 ? a : b;
                const double distance = length(corner, target);
                if (distance >= kBodyRadius || distance == 0) continue;
                target.x += (target.x - corner.x) * (kBodyRadius / distance - 1);
                target.y += (target.y - corner.y) * (kBodyRadius / distance - 1);
            }
        }
    return target;
}

/// Goes to `target`, through as many sectors as lie between. False, and nothing happens, when the way leaves the map.
bool Player::follow(const Point& target) {
    uint32_t sector = sector_;
    for (int crossed = 0; crossed < 8; ++crossed) {
        if (map_.contains(sector, target)) {
            sector_ = sector;
            place_ = target;
            return true;
        }
        const Sector& here = map_.sectors[sector];
        const uint32_t before = sector;
        for (size_t edge = 0; edge < here.edgeCount() && sector == before; ++edge) {
            const Point &a = map_.edgeStart(here, edge), &b = map_.edgeEnd(here, edge);
            if (canPass(here, edge) && boxesOverlap(place_, target, a, b) && sideOf(a, b, target) < 0)
                sector = static_cast<uint32_t>(here.neighbours[edge]);
        }
        if (sector == before) return false;
    }
    return false;
}

void Player::fall(bool jump) {
    const Sector& sector = map_.sectors[sector_];
    if (onGround_ && jump) fallSpeed_ = -kJumpSpeed;
    onGround_ = false;
    fallSpeed_ += kGravity * kPlayerStep;
    feet_ -= fallSpeed_ * kPlayerStep;
    if (feet_ <= sector.floor) {
        feet_ = sector.floor;
        fallSpeed_ = 0;
        onGround_ = true;
    } else if (eye() + kHeadMargin > sector.ceiling) {
        feet_ = std::max(sector.floor, sector.ceiling - kHeadMargin - bodyHeight_);
        fallSpeed_ = std::max(fallSpeed_, 0.0);
    }
}

void Player::step(const Intent& intent) {
    angle_ += intent.turn;
    shear_ = std::clamp(shear_ + intent.look, -kSteepestShear, kSteepestShear);
    // Ducked until there is room to stand up.
    const Sector& sector = map_.sectors[sector_];
    const bool low = sector.ceiling - feet_ < kEyeHeight + kHeadMargin;
    const double wanted = intent.duck || low ? kDuckHeight : kEyeHeight;
    bodyHeight_ += std::clamp(wanted - bodyHeight_, -0.25, 0.25);

    const double c = cosine(angle_), s = sine(angle_), speed = intent.duck || low ? kDuckSpeed : kSpeed;
    const double size = std::sqrt(intent.forward * intent.forward + intent.right * intent.right);
    const double scale = size > 1 ? speed / size : speed;
    const Point wish{(c * intent.forward + s * intent.right) * scale, (s * intent.forward - c * intent.right) * scale};
    // Feet on the ground hold better than air.
    const double grip = onGround_ ? 0.25 : 0.06;
    velocity_.x += (wish.x - velocity_.x) * grip;
    velocity_.y += (wish.y - velocity_.y) * grip;

    const Point target = slide({place_.x + velocity_.x * kPlayerStep, place_.y + velocity_.y * kPlayerStep}),
                old = place_;
    if (!follow(target)) velocity_ = {0, 0};
    // Sliding takes away what ran into the wall.
    velocity_ = {(place_.x - old.x) / kPlayerStep, (place_.y - old.y) / kPlayerStep};
    // In the new sector its walls keep their distance, too.
    follow(slide(place_));
    fall(intent.jump);
}

Guide::Guide(const Map& map) : map_(map) {
    // Breadth first over what a knee can climb and a ducked body fits through.
    std::vector<int> from(map.sectors.size(), -1);
    std::vector<Point> through(map.sectors.size());
    std::queue<uint32_t> queue;
    queue.push(map.startSector);
    from[map.startSector] = static_cast<int>(map.startSector);
    uint32_t last = map.startSector;
    while (!queue.empty()) {
        last = queue.front();
        queue.pop();
        const Sector& sector = map.sectors[last];
        for (size_t edge = 0; edge < sector.edgeCount(); ++edge) {
            const int neighbour = sector.neighbours[edge];
            if (neighbour < 0 || from[static_cast<size_t>(neighbour)] >= 0) continue;
            const Sector& other = map.sectors[static_cast<size_t>(neighbour)];
            const double room = std::min(sector.ceiling, other.ceiling) - std::max(sector.floor, other.floor);
            if (other.floor - sector.floor > kKneeHeight || room < kDuckHeight + kHeadMargin) continue;
            const Point &a = map.edgeStart(sector, edge), &b = map.edgeEnd(sector, edge);
            from[static_cast<size_t>(neighbour)] = static_cast<int>(last);
            through[static_cast<size_t>(neighbour)] = {(a.x + b.x) / 2, (a.y + b.y) / 2};
            queue.push(static_cast<uint32_t>(neighbour));
        }
    }
    for (uint32_t sector = last; sector != map.startSector; sector = static_cast<uint32_t>(from[sector])) {
        route_.push_back(map.center(sector));
        route_.push_back(through[sector]);
    }
    std::reverse(route_.begin(), route_.end());
    // And back, as long as the steps up allow it.
    for (size_t i = route_.size(); i-- > 0;) route_.push_back(route_[i]);
}

Intent Guide::intent(const Player& player) {
    Intent intent;
    while (next_ < route_.size() && length(player.place(), route_[next_]) < 1.2) ++next_, waited_ = 0;
    if (next_ == route_.size()) return intent;
    ++waited_;
    const double dx = route_[next_].x - player.place().x, dy = route_[next_].y - player.place().y;
    const double c = cosine(player.angle()), s = sine(player.angle());
    const double ahead = dx * c + dy * s, left = dy * c - dx * s, distance = std::sqrt(dx * dx + dy * dy);
    // The sine of the angle that is left, as a turn of limited speed; when it lies behind, at full speed.
    const double turn = ahead < 0 ? (left < 0 ? -1 : 1) : left / distance;
    intent.turn = std::clamp(turn * 0.15, -kTurnPerStep, kTurnPerStep);
    intent.forward = ahead > 0.7 * distance ? 1 : 0.1;
    // Where it is low the next sector asks for it, or the way through it takes too long.
    const Sector& sector = map_.sectors[player.sector()];
    for (const int neighbour : sector.neighbours)
        if (neighbour >= 0) {
            const Sector& other = map_.sectors[static_cast<size_t>(neighbour)];
            if (std::min(sector.ceiling, other.ceiling) - std::max(sector.floor, other.floor) <
                kEyeHeight + kHeadMargin)
                intent.duck = true;
        }
    intent.jump = waited_ % 120 == 119;
    return intent;
}

}  // namespace samples
