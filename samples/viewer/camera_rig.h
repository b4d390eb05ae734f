// The viewer's two cameras and what the command line says of them.
#pragma once

#include "samples/common/camera.h"
#include "samples/common/options.h"
#include "samples/viewer/model_renderer.h"
#include "samples/viewer/views.h"

namespace samples {

struct CameraSettings {
    int fly = 0;                                    // 0: circles the model
    double turn = 25, pitch = -20, distance = 1.8;  // degrees; radii of the model
};

/// --camera, --turn, --pitch, --distance.
std::vector<Option> cameraOptions(CameraSettings& settings);

class CameraRig {
  public:
    explicit CameraRig(const CameraSettings& settings);

    /// Once a frame. Keys and mouse go to the camera in use.
    void update(const Input& input, double elapsed, bool fly);
    /// Turns the orbit by `radians`: for turntables.
    void turn(double radians) { orbit_.turn(radians); }
    ModelLook look(float aspect, bool fly) const;
    static Views::Planes planes() { return {0.02f, 40}; }

  private:
    OrbitCamera orbit_;
    FlyCamera fly_;
};

}  // namespace samples
