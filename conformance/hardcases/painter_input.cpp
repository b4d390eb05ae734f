#include "conformance/hardcases/painter_input.h"

#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>

namespace vernier::conformance::hardcases {

const char* const kCodeFragmentGlsl = R"(#version 450
layout(location = 0) flat in float vCode;
layout(location = 0) out vec4 color;
void main() { color = vec4(vCode / 255.0, 0.0, 0.0, 1.0); }
)";

namespace {

const char* const kVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in float code;
layout(location = 0) flat out float vCode;
void main() {
    gl_Position = position;
    vCode = code;
}
)";

struct Vertex {
    ClipPosition position;
    float code;
};

Result<Scene> painterScene(std::string_view name, const WindowTriangles& triangles, const PainterOptions& options) {
    SceneRecorder record(name, "Triangles of one code each.");
    const uint32_t target = record.colorTarget("codes", VK_FORMAT_R8G8B8A8_UNORM, options.extent);
    std::vector<Vertex> vertices;
    for (size_t i = 0; i < triangles.size(); ++i) {
        for (const WindowPoint& p : triangles[i])
            vertices.push_back({clipAt(p, viewportOf(options.extent)), static_cast<float>(i + 1)});
    }
    const uint32_t buffer = record.vertexBuffer("vertices", vertices);
    auto pipeline = record.pipeline(record.vertex(kVertexGlsl), record.fragment(kCodeFragmentGlsl))
                        .binding(sizeof(Vertex))
                        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                        .attribute(VK_FORMAT_R32_SFLOAT, sizeof(ClipPosition));
    auto pass = record.pass(options.extent).color(target, {0, 0, 0, 1});
    if (options.firstWins || options.depthTest) {
        pipeline.depth(options.firstWins ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_LESS_OR_EQUAL);
        pass.depthStencil(record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, options.extent));
    }
    const auto count = static_cast<uint32_t>(vertices.size());
    const uint32_t step = options.perDraw != 0 ? options.perDraw * 3 : count;
    for (uint32_t first = 0; first < count; first += step) {
        record.draw(pipeline, std::min(step, count - first)).vertices(buffer).first(first);
    }
    record.output(target);
    return record.finish();
}

}  // namespace

void judgePainter(CaseInput& input, size_t scene, const WindowTriangles& triangles, const PainterOptions& options) {
    judgePixels(input, scene, 0, options.extent, [=](const PixelReader& pixels, const Declared& declared) -> Verdict {
        const std::vector<exact::GridTriangle> grid = snapped(triangles, declared.subPixelBits);
        const exact::SampleGrid samples{
            options.extent,
            declared.subPixelBits,
            {int64_t{1} << (declared.subPixelBits - 1), int64_t{1} << (declared.subPixelBits - 1)}};
        Verdict worst;
        for (uint32_t y = 0; y < options.extent.height; ++y) {
            for (uint32_t x = 0; x < options.extent.width; ++x) {
                const exact::GridPoint p = samples.sample(x, y);
                uint64_t declaredCode = 0;
                bool decided = false, closed = false;
                const uint64_t seen = pixels.code(x, y, 0);
                bool legal = false;
                for (size_t k = 0; k < grid.size() && !closed; ++k) {
                    const size_t i = options.firstWins ? k : grid.size() - 1 - k;
                    const exact::Coverage coverage = exact::classify(grid[i], p);
                    if (coverage == exact::Coverage::mustNot) continue;
                    legal = legal || seen == i + 1;
                    closed = coverage == exact::Coverage::must;
                    if (!decided && exact::covers(grid[i], p)) {
                        declaredCode = i + 1;
                        decided = true;
                    }
                }
                legal = legal || (!closed && seen == 0);
                if (seen == declaredCode) continue;
                const std::string text = pixelText(x, y) + " shows triangle " + std::to_string(seen) + ", exactly " +
                                         std::to_string(declaredCode) + " (0: none); " +
                                         (options.firstWins ? "the first" : "the last") + " in API order is seen";
                worst = worst.worse(Verdict::inexact(legal, text));
            }
        }
        return worst;
    });
}

size_t addPainter(CaseInput& input, std::string_view name, const WindowTriangles& triangles,
                  const PainterOptions& options) {
    const size_t scene = input.scene(painterScene(name, triangles, options));
    judgePainter(input, scene, triangles, options);
    return scene;
}

}  // namespace vernier::conformance::hardcases
