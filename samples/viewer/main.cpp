// Shows a model, how exact its picture is at each position of the accuracy dial, and what it costs:
//   vernier-viewer [MODEL.obj|.gltf|.glb] [--profile draft] [--view error] [--headless OUT.png]
// Everything that keys and the panel set is a switch, too: --help. Models can be dropped on the window. The panel is
// Dear ImGui's, drawn by Vernier (imgui_vernier.h).
#include <cmath>
#include <cstdio>

#include "samples/common/trigonometry.h"
#include "samples/viewer/exporter.h"
#include "samples/viewer/ui.h"

namespace {

struct Settings {
    std::string file;
    samples::Dial dial;
    samples::ViewSettings view;
    samples::CameraSettings camera;
    bool panel = false, hidden = false, animate = true;
    int animation = 1;
    double uiScale = 0;
    int turntable = 0;
};

std::vector<samples::Option> optionsOf(Settings& settings) {
    std::vector<samples::Option> options{{"model", "an OBJ or glTF file; without: a scene of its own", &settings.file}};
    const auto add = [&](const std::vector<samples::Option>& more) {
        options.insert(options.end(), more.begin(), more.end());
    };
    add(settings.dial.options());
    add(samples::viewOptions(settings.view));
    add(samples::cameraOptions(settings.camera));
    add({{"--panel", "the panel, without a window too", &settings.panel},
         {"--hide", "no panel", &settings.hidden, 'h'},
         {"--animate", "the model's animation is played", &settings.animate, 'm'},
         {"--animation", "which, from 1 on", &settings.animation},
         {"--ui-scale", "size of letters (0: as the screen has it)", &settings.uiScale},
         {"--turntable", "write so many pictures once round to --out, without a window", &settings.turntable}});
    return options;
}

constexpr const char* kOtherKeys =
    "F1  these keys\nF11  turntable: 36 pictures to --out or here\nF12  screenshot, to there, too\n"
    "arrows, drag, wheel  camera; dragging the line of the split screen moves it\nescape  ends\n";

class Viewer {
  public:
    Viewer(samples::App& app, Settings& settings, samples::Scene scene)
        : app_(app),
          settings_(settings),
          scene_(std::move(scene)),
          model_(app),
          views_(app),
          rig_(settings.camera),
          keys_(samples::keyHelp(optionsOf(settings)) + kOtherKeys) {
        model_.setScene(scene_);
    }

    void frame(const samples::Frame& frame) {
        needUi(frame.pixelRatio);
        if (frame.elapsed > 0) times_.add(frame.elapsed * 1000);
        for (const std::string& path : frame.input.dropped) open(path);
        samples::UiActions actions;
        for (const int key : frame.input.pressed) {
            help_ ^= key == samples::kKeyF1;
            actions.turntable |= key == samples::kKeyF11;
            actions.screenshot |= key == samples::kKeyF12;
        }
        samples::Input input = frame.input;
        if (ui_->wantsMouse()) {
            input.dragging = false;
            input.wheel = 0;
        }
        if (moveDivide(input)) input.dragging = false;
        rig_.update(input, frame.elapsed, settings_.camera.fly != 0);
        animate(frame.seconds);
        const bool panel = app_.hasWindow() ? !settings_.hidden : settings_.panel;
        drawView();
        const samples::UiActions clicked = drawUi(frame, panel);
        const std::string& folder = app_.options().out;
        if (actions.screenshot || clicked.screenshot)
            message_ = samples::exportScreenshot(app_, folder, [&] { drawClean(); }).message;
        if (actions.turntable || clicked.turntable) message_ = turntable(36).message;
    }

    /// Once round, in so many pictures.
    samples::Exported turntable(int count) {
        needUi(1);
        double at = 0;
        const samples::Exported result = samples::exportTurntable(app_, app_.options().out, count, [&](double angle) {
            rig_.turn(angle - at);
            at = angle;
            drawClean();
        });
        rig_.turn(-at);
        return result;
    }

    const samples::ViewReport& report() const { return views_.report(); }

  private:
    /// Letters follow the density of the screen that the window is on.
    void needUi(float pixelRatio) {
        const float scale = settings_.uiScale > 0 ? static_cast<float>(settings_.uiScale) : pixelRatio;
        if (ui_ && scale == uiScale_) return;
        uiScale_ = scale;
        ui_.reset();
        ui_ = std::make_unique<samples::Ui>(app_, scale);
    }

    void open(const std::string& path) {
        std::string error;
        if (samples::loadScene(path, scene_, error)) {
            model_.setScene(scene_);
            message_.clear();
        } else {
            message_ = error;
        }
    }

    void animate(double seconds) {
        const bool chosen = scene_.motion && settings_.animation >= 1 &&
                            static_cast<size_t>(settings_.animation) <= scene_.motion->animations();
        if (!chosen || !settings_.animate) return;
        samples::poseScene(scene_, static_cast<size_t>(settings_.animation) - 1, seconds);
        model_.moveParts(scene_);
    }

    /// The line of the split screen can be taken hold of. Whether it is.
    bool moveDivide(const samples::Input& input) {
        const double width = app_.width(), line = settings_.view.divide * width;
        const bool over = std::abs(double{input.mouse.x - input.mouseMove.x} - line) < double{ui_->unit()};
        const bool begins = input.dragging && !dragged_;
        dragged_ = input.dragging;
        if (begins) holdsDivide_ = settings_.view.kind() == samples::ViewKind::kSplit && over;
        holdsDivide_ = holdsDivide_ && input.dragging;
        if (holdsDivide_) settings_.view.divide = glm::clamp(double{input.mouse.x} / width, 0.0, 1.0);
        return holdsDivide_;
    }

    VkExtent2D size() const { return {app_.width(), app_.height()}; }

    void drawView() {
        const samples::ViewSettings& view = settings_.view;
        views_.draw(model_, rig_.look(app_.aspect(), settings_.camera.fly != 0), samples::CameraRig::planes(),
                    settings_.dial, view, samples::legendBar(view.kind(), size(), ui_->unit()));
    }

    samples::UiActions drawUi(const samples::Frame& frame, bool panel) {
        const samples::UiModel model{scene_,          settings_.dial, settings_.view, settings_.camera,
                                     views_.report(), times_,         keys_,          message_};
        samples::UiActions actions;
        ui_->begin(frame.input, frame.elapsed);
        ui_->legend(samples::legendTexts(settings_.view, settings_.dial, views_.report(), size(), ui_->unit()));
        if (panel) actions = ui_->panel(model);
        if (help_) ui_->help(model);
        ui_->end();
        return actions;
    }

    /// What is exported: the view and its legend.
    void drawClean() {
        drawView();
        drawUi({}, false);
    }

    samples::App& app_;
    Settings& settings_;
    samples::Scene scene_;
    samples::ModelRenderer model_;
    samples::Views views_;
    samples::CameraRig rig_;
    std::unique_ptr<samples::Ui> ui_;
    float uiScale_ = 0;
    samples::FrameTimes times_;
    std::string keys_, message_;
    bool help_ = false, dragged_ = false, holdsDivide_ = false;
};

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    const samples::AppOptions options = samples::parseOptions(argc, argv, "Vernier viewer", optionsOf(settings));
    samples::Scene scene = samples::builtInScene();
    std::string error;
    if (!settings.file.empty() && !samples::loadScene(settings.file, scene, error)) {
        std::fprintf(stderr, "%s\n", error.c_str());
        return 1;
    }
    for (const std::string& note : scene.notes) std::fprintf(stdout, "%s\n", note.c_str());
    if (!(settings.view.divide >= 0 && settings.view.divide <= 1)) {
        std::fprintf(stderr, "--divide is %g, but must be 0 to 1\n", settings.view.divide);
        return 1;
    }
    samples::App app(options);
    Viewer viewer(app, settings, std::move(scene));
    if (settings.turntable > 0) {
        const samples::Exported result = viewer.turntable(settings.turntable);
        std::fprintf(result.written ? stdout : stderr, "%s\n", result.message.c_str());
        return result.written ? 0 : 1;
    }
    const int status = app.run([&](const samples::Frame& frame) { viewer.frame(frame); });
    if (settings.view.explain && !app.hasWindow()) std::fputs(viewer.report().explanation.c_str(), stdout);
    return status;
}
