// The viewer's panel: everything that keys and switches set, and what was measured.
#pragma once

#include <memory>

#include "samples/viewer/camera_rig.h"
#include "samples/viewer/imgui_vernier.h"
#include "samples/viewer/legend.h"
#include "samples/viewer/scene.h"

namespace samples {

/// The last times of frames, in milliseconds.
class FrameTimes {
  public:
    void add(double milliseconds);
    bool empty() const { return count_ == 0; }
    double mean() const;
    const float* values() const { return values_; }
    int first() const { return count_ < kCount ? 0 : next_; }
    int count() const { return count_; }

  private:
    static constexpr int kCount = 120;
    float values_[kCount] = {};
    int next_ = 0, count_ = 0;
};

/// All the panel reads and changes.
struct UiModel {
    const Scene& scene;
    Dial& dial;
    ViewSettings& view;
    CameraSettings& camera;
    const ViewReport& report;
    const FrameTimes& times;
    const std::string& keys;     // a line each
    const std::string& message;  // of the last file, screenshot or turntable; "": none
};

struct UiActions {
    bool screenshot = false, turntable = false;
};

class Ui {
  public:
    /// `scale`: pixels per dot of a screen of common density.
    Ui(App& app, float scale);

    void begin(const Input& input, double elapsed) { imgui_.beginFrame(input, elapsed); }
    UiActions panel(const UiModel& model);
    /// The keys, in the middle.
    void help(const UiModel& model);
    void legend(const std::vector<LegendText>& texts);
    void end() { imgui_.endFrame(); }

    bool wantsMouse() const { return imgui_.wantsMouse(); }
    /// The height of a line of text, in pixels.
    float unit() const { return unit_; }

  private:
    App& app_;
    float unit_;
    ImguiVernier imgui_;
};

}  // namespace samples
