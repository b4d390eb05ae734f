// Two cameras for y-up worlds: one that circles a point, one that flies.
#pragma once

#include "samples/common/input.h"
#include "samples/common/transform.h"

namespace samples {

/// Dragging with the left button and the arrows turn, the wheel comes nearer.
class OrbitCamera {
  public:
    OrbitCamera(const glm::vec3& target, float distance, double yaw, double pitch)
        : target_(target), distance_(distance), yaw_(yaw), pitch_(pitch) {}
    void update(const Input& input);
    void turn(double yaw) { yaw_ += yaw; }
    glm::vec3 position() const;
    glm::mat4 view() const { return glm::lookAt(position(), target_, glm::vec3(0, 1, 0)); }

  private:
    glm::vec3 target_;
    float distance_;
    double yaw_, pitch_;  // radians; yaw 0 looks along -z
};

/// W, A, S, D and the arrows move, Q and E sink and rise, drag looks around.
class FlyCamera {
  public:
    FlyCamera(const glm::vec3& position, double yaw, double pitch) : position_(position), yaw_(yaw), pitch_(pitch) {}
    void update(const Input& input, double seconds, float speed);
    const glm::vec3& position() const { return position_; }
    glm::vec3 direction() const;
    glm::mat4 view() const { return glm::lookAt(position_, position_ + direction(), glm::vec3(0, 1, 0)); }

  private:
    glm::vec3 position_;
    double yaw_, pitch_;
};

}  // namespace samples
