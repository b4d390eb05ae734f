// What of a model is shown: the picture itself, what is wrong with it, or what it costs.
#pragma once

#include "samples/viewer/model_renderer.h"

namespace samples {

enum class ViewKind { kShaded, kSplit, kError, kWireframe, kDepth, kOverdraw, kRate, kTiles };

struct ViewSettings {
    int view = 0;         // a ViewKind
    int sign = 0;         // errors: 0 their size, 1 with their sign
    double scale = 0;     // what the right end of the legend stands for; 0: the view's own
    double divide = 0.5;  // where the split screen is parted, 0..1
    bool edges = false;   // triangles' edges over the picture
    bool explain = false;

    ViewKind kind() const { return static_cast<ViewKind>(view); }
};

/// --view, --error, --scale, --divide, --edges, --explain and their keys.
std::vector<Option> viewOptions(ViewSettings& settings);

/// What was found out while drawing.
struct ViewReport {
    double scale = 0;  // that was used
    // Errors of the picture against `reference`, in 1/255 of the full range of a linear colour.
    double worst = 0, mean = 0, differing = 0;  // differing: share of the pixels
    // Counts: the largest, and the mean of pixels (tiles) that have any.
    double most = 0, usual = 0;
    std::vector<float> tiles;  // cost of each, in thousand additions
    uint32_t tileColumns = 0;
    VnStatistics statistics{};  // of the picture
    std::string explanation;    // of its first draw
};

class Views {
  public:
    explicit Views(App& app);

    struct Planes {
        float nearest, farthest;  // distances of the clip planes
    };
    /// Draws to App::color(). `bar` is where the legend's bar goes, in pixels.
    void draw(ModelRenderer& model, const ModelLook& look, const Planes& planes, const Dial& dial,
              const ViewSettings& settings, const glm::vec4& bar);
    const ViewReport& report() const { return report_; }

  private:
    void drawPicture(ModelRenderer& model, const ModelLook& look, const DialPosition& dial,
                     const ViewSettings& settings, const Target& target);
    void drawCounts(ModelRenderer& model, const ModelLook& look, const DialPosition& dial, ModelRenderer::Count count);
    void sumTiles();
    void show(VnProgram program, const Target* first, const Target* second);
    void judgeErrors();
    void judgeCounts(const Target& target, double unit, std::vector<float>& values);

    App& app_;
    VnProgram split_, error_, depth_, count_, tiles_, sum_;
    VnSampler nearest_;
    const Target &seen_, &reference_, &counts_, &tileSums_;
    viewer_shaders::ShowPush push_{};
    ViewReport report_;
};

}  // namespace samples
