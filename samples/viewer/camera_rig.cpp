#include "samples/viewer/camera_rig.h"

#include "samples/common/trigonometry.h"

namespace samples {
namespace {

constexpr double kRadians = kPi / 180, kFieldOfView = 0.8;

}  // namespace

std::vector<Option> cameraOptions(CameraSettings& settings) {
    return {{"--camera", "circles the model, or flies: W A S D, Q and E", &settings.fly, 'c', {"orbit", "fly"}},
            {"--turn", "degrees around the model (25)", &settings.turn},
            {"--pitch", "degrees up (-20: looks down)", &settings.pitch},
            {"--distance", "in radii of the model (1.8)", &settings.distance}};
}

CameraRig::CameraRig(const CameraSettings& settings)
    : orbit_(glm::vec3(0), static_cast<float>(settings.distance), settings.turn * kRadians, settings.pitch * kRadians),
      fly_(orbit_.position(), settings.turn * kRadians, settings.pitch * kRadians) {}

void CameraRig::update(const Input& input, double elapsed, bool fly) {
    if (fly)
        fly_.update(input, elapsed, 0.8f);
    else
        orbit_.update(input);
}

ModelLook CameraRig::look(float aspect, bool fly) const {
    const glm::mat4 view = fly ? fly_.view() : orbit_.view();
    return {perspective(kFieldOfView, aspect, planes().nearest, planes().farthest) * view,
            fly ? fly_.position() : orbit_.position()};
}

}  // namespace samples
