#include "samples/viewer/views.h"

#include <algorithm>
#include <cmath>

namespace samples {
namespace {

constexpr glm::vec4 kBackground(0.012f, 0.016f, 0.024f, 1);
constexpr uint32_t kTile = 64;  // pixels on a side, as the renderer has them

/// The right end of the legend where nothing else is asked for.
double ownScale(ViewKind view) {
    switch (view) {
        case ViewKind::kError:
            return 16;  // of 255
        case ViewKind::kDepth:
            return 5;  // radii of the model
        case ViewKind::kOverdraw:
            return 10;  // surfaces
        case ViewKind::kRate:
            return 5;  // runs
        case ViewKind::kTiles:
            return 2000;  // thousand additions
        default:
            return 0;
    }
}

VkExtent2D tilesOf(VkExtent2D size) {
    return {(size.width + kTile - 1) / kTile, (size.height + kTile - 1) / kTile};
}

}  // namespace

std::vector<Option> viewOptions(ViewSettings& settings) {
    return {{"--view",
             "what is shown",
             &settings.view,
             'v',
             {"shaded", "split", "error", "wireframe", "depth", "overdraw", "rate", "tiles"}},
            {"--error", "errors by their size or with their sign", &settings.sign, 'g', {"size", "signed"}},
            {"--scale", "what the right end of the legend stands for (0: the view's own)", &settings.scale},
            {"--divide", "where the split screen is parted, 0 to 1 (0.5)", &settings.divide},
            {"--edges", "edges of the triangles", &settings.edges, 'x'},
            {"--explain", "what a draw runs and leaves out", &settings.explain, 'n'}};
}

Views::Views(App& app)
    : app_(app),
      nearest_(app.sampler(VK_FILTER_NEAREST)),
      seen_(app.windowTarget(VK_FORMAT_R32G32B32A32_SFLOAT)),
      reference_(app.windowTarget(VK_FORMAT_R32G32B32A32_SFLOAT)),
      counts_(app.windowTarget(VK_FORMAT_R32_SFLOAT)),
      tileSums_(app.windowTarget(VK_FORMAT_R32_SFLOAT, tilesOf)) {
    using namespace viewer_shaders;
    split_ = app.program(kFullScreenVertex, kShowSplit);
    error_ = app.program(kFullScreenVertex, kShowError);
    depth_ = app.program(kFullScreenVertex, kShowDepth);
    count_ = app.program(kFullScreenVertex, kShowCount);
    tiles_ = app.program(kFullScreenVertex, kShowTiles);
    sum_ = app.computeProgram(kSumTiles);
}

void Views::drawPicture(ModelRenderer& model, const ModelLook& look, const DialPosition& dial,
                        const ViewSettings& settings, const Target& target) {
    app_.beginPass({target}, app_.depth(), kBackground);
    model.drawLit(look, dial, settings.explain ? &report_.explanation : nullptr);
    if (settings.edges) model.drawEdges(look, dial, {1, 0.75f, 0.1f});
    app_.endPass();
}

void Views::drawCounts(ModelRenderer& model, const ModelLook& look, const DialPosition& dial,
                       ModelRenderer::Count count) {
    app_.beginPass({counts_}, app_.depth(), glm::vec4(0));
    model.drawCounts(look, dial, count);
    app_.endPass();
}

void Views::sumTiles() {
    VnContext context = app_.context();
    vnBindProgram(context, sum_);
    vnBindTexture(context, 0, 0, 0, counts_.view, nearest_);
    vnBindTexture(context, 0, 1, 0, tileSums_.view, VnSampler{});
    must(vnDispatch(context, tileSums_.width, tileSums_.height, 1));
}

void Views::show(VnProgram program, const Target* first, const Target* second) {
    VnContext context = app_.context();
    app_.beginPass({app_.color()}, {}, glm::vec4(0));
    vnBindProgram(context, program);
    vnBindVertexLayout(context, VnVertexLayout{});
    vnBindRasterState(context, VnRasterState{});
    vnBindDepthStencilState(context, VnDepthStencilState{});
    vnBindTexture(context, 0, 0, 0, first->view, nearest_);
    if (second) vnBindTexture(context, 0, 1, 0, second->view, nearest_);
    app_.push(push_);
    must(vnDraw(context, 3, 1, 0, 0));
    app_.endPass();
}

void Views::judgeErrors() {
    const size_t pixels = size_t{seen_.width} * seen_.height;
    std::vector<glm::vec4> seen(pixels), reference(pixels);
    must(vnReadImage(app_.context(), seen_.image, nullptr, seen.data(), pixels * sizeof(glm::vec4)));
    must(vnReadImage(app_.context(), reference_.image, nullptr, reference.data(), pixels * sizeof(glm::vec4)));
    size_t differing = 0;
    double sum = 0;
    for (size_t i = 0; i < pixels; ++i) {
        double worst = 0;
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(double{seen[i][c]} - double{reference[i][c]}) * 255);
        differing += worst > 0;
        sum += worst;
        report_.worst = std::max(report_.worst, worst);
    }
    report_.mean = sum / static_cast<double>(pixels);
    report_.differing = static_cast<double>(differing) / static_cast<double>(pixels);
}

void Views::judgeCounts(const Target& target, double unit, std::vector<float>& values) {
    values.resize(size_t{target.width} * target.height);
    must(vnReadImage(app_.context(), target.image, nullptr, values.data(), values.size() * sizeof(float)));
    size_t filled = 0;
    double sum = 0;
    for (float& value : values) {
        value = static_cast<float>(value / unit);
        filled += value > 0;
        sum += value;
        report_.most = std::max(report_.most, double{value});
    }
    report_.usual = filled ? sum / static_cast<double>(filled) : 0;
}

void Views::draw(ModelRenderer& model, const ModelLook& look, const Planes& planes, const Dial& dial,
                 const ViewSettings& settings, const glm::vec4& bar) {
    const ViewKind view = settings.kind();
    const DialPosition here = dial.position(), exact{VN_PROFILE_REFERENCE, ""};
    ViewSettings plain = settings;  // no edges where they would be judged
    plain.edges = settings.edges && view == ViewKind::kSplit;
    report_ = {};
    report_.scale = settings.scale > 0 ? settings.scale : ownScale(view);
    push_ = {bar,
             static_cast<float>(report_.scale),
             static_cast<float>(settings.divide * app_.width()),
             settings.sign,
             planes.nearest,
             planes.farthest};
    std::vector<float> values;
    must(vnResetStatistics(app_.context()));
    switch (view) {
        case ViewKind::kShaded:
            drawPicture(model, look, here, settings, app_.color());
            must(vnGetStatistics(app_.context(), &report_.statistics));
            break;
        case ViewKind::kSplit:
        case ViewKind::kError:
            drawPicture(model, look, here, plain, seen_);
            must(vnGetStatistics(app_.context(), &report_.statistics));
            plain.explain = false;
            drawPicture(model, look, exact, plain, reference_);
            show(view == ViewKind::kSplit ? split_ : error_, &seen_, &reference_);
            if (view == ViewKind::kError) judgeErrors();
            break;
        case ViewKind::kWireframe:
            app_.beginPass({app_.color()}, app_.depth(), kBackground);
            model.drawPlain(look, here, {0.02f, 0.025f, 0.035f});
            model.drawEdges(look, here, {0.55f, 0.85f, 1});
            app_.endPass();
            must(vnGetStatistics(app_.context(), &report_.statistics));
            break;
        case ViewKind::kDepth:
            drawPicture(model, look, here, plain, seen_);
            must(vnGetStatistics(app_.context(), &report_.statistics));
            show(depth_, &app_.depth(), nullptr);
            break;
        case ViewKind::kOverdraw:
        case ViewKind::kRate:
            drawPicture(model, look, here, plain, seen_);
            must(vnGetStatistics(app_.context(), &report_.statistics));
            drawCounts(model, look, here,
                       view == ViewKind::kRate ? ModelRenderer::Count::kRuns : ModelRenderer::Count::kSurfaces);
            show(count_, &counts_, nullptr);
            judgeCounts(counts_, 1, values);
            break;
        case ViewKind::kTiles:
            drawPicture(model, look, here, plain, seen_);
            must(vnGetStatistics(app_.context(), &report_.statistics));
            drawCounts(model, look, here, ModelRenderer::Count::kCost);
            sumTiles();
            push_.scale *= 1000;
            show(tiles_, &tileSums_, &seen_);
            judgeCounts(tileSums_, 1000, report_.tiles);
            report_.tileColumns = tileSums_.width;
            break;
    }
}

}  // namespace samples
