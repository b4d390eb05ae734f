// Who walks: gravity, jumping, ducking, steps, sliding along walls.
#pragma once

#include <vector>

#include "samples/walker/map.h"

namespace samples {

constexpr double kEyeHeight = 6, kDuckHeight = 2.5, kHeadMargin = 1, kKneeHeight = 2;
constexpr double kBodyRadius = 0.5;       // how near a wall comes
constexpr double kPlayerStep = 1.0 / 60;  // seconds of one call of Player::step()

/// What the player wants in one step.
struct Intent {
    double forward = 0, right = 0;  // -1 .. 1
    double turn = 0;                // radians, to the left
    double look = 0;                // added to the shear
    bool jump = false, duck = false;
};

class Player {
  public:
    explicit Player(const Map& map);

    /// Moves on by kPlayerStep seconds.
    void step(const Intent& intent);

    const Point& place() const { return place_; }
    double eye() const { return feet_ + bodyHeight_; }
    double feet() const { return feet_; }
    double angle() const { return angle_; }  // radians
    /// Looking up and down is a shear of the picture: what stands `shear` lower per unit of distance is in its middle.
    double shear() const { return shear_; }
    uint32_t sector() const { return sector_; }
    bool onGround() const { return onGround_; }

    /// Whether a body at this height fits through the edge: not a wall, a step of at most a knee, room for the head.
    bool canPass(const Sector& sector, size_t edge) const;

  private:
    Point slide(Point target) const;
    bool follow(const Point& target);
    void fall(bool jump);

    const Map& map_;
    Point place_, velocity_;
    double feet_ = 0, fallSpeed_ = 0, bodyHeight_ = kEyeHeight, angle_ = 0, shear_ = 0;
    uint32_t sector_ = 0;
    bool onGround_ = true;
};

/// Walks by itself from the start to the sector that is farthest away, through portals that can be passed, and back.
class Guide {
  public:
    explicit Guide(const Map& map);
    Intent intent(const Player& player);
    const std::vector<Point>& route() const { return route_; }

  private:
    const Map& map_;
    std::vector<Point> route_;
    size_t next_ = 0;
    int waited_ = 0;  // steps since the last point was reached
};

}  // namespace samples
