#include "samples/common/camera.h"

#include <algorithm>

#include "samples/common/trigonometry.h"

namespace samples {
namespace {

constexpr double kRadiansPerPixel = 0.006, kRadiansPerFrame = 0.03, kSteepest = 1.55;

glm::vec3 directionOf(double yaw, double pitch) {
    const float across = cosineF(pitch);
    return {-sineF(yaw) * across, sineF(pitch), -cosineF(yaw) * across};
}

}  // namespace

void OrbitCamera::update(const Input& input) {
    yaw_ -= input.axis(kKeyLeft, kKeyRight) * kRadiansPerFrame;
    pitch_ = std::clamp(pitch_ + input.axis(kKeyDown, kKeyUp) * kRadiansPerFrame, -kSteepest, kSteepest);
    if (input.dragging) {
        yaw_ -= input.mouseMove.x * kRadiansPerPixel;
        pitch_ = std::clamp(pitch_ - input.mouseMove.y * kRadiansPerPixel, -kSteepest, kSteepest);
    }
    for (float notches = input.wheel; notches > 0; --notches) distance_ *= 0.9f;
    for (float notches = input.wheel; notches < 0; ++notches) distance_ /= 0.9f;
}

glm::vec3 OrbitCamera::position() const {
    return target_ - directionOf(yaw_, pitch_) * distance_;
}

glm::vec3 FlyCamera::direction() const {
    return directionOf(yaw_, pitch_);
}

void FlyCamera::update(const Input& input, double seconds, float speed) {
    if (input.dragging) {
        yaw_ -= input.mouseMove.x * kRadiansPerPixel;
        pitch_ = std::clamp(pitch_ - input.mouseMove.y * kRadiansPerPixel, -kSteepest, kSteepest);
    }
    const auto one = [&](int a, int b, int c, int d) {
        return glm::clamp(input.axis(a, b) + input.axis(c, d), -1.f, 1.f);
    };
    const glm::vec3 forward = direction(), right = directionOf(yaw_ - kPi / 2, 0);
    position_ += (forward * one('s', 'w', kKeyDown, kKeyUp) + right * one('a', 'd', kKeyLeft, kKeyRight) +
                  glm::vec3(0, input.axis('q', 'e'), 0)) *
                 static_cast<float>(seconds * speed);
}

}  // namespace samples
