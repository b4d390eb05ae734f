#include "conformance/hardcases/barycentric_case.h"

#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

// Two triangles through near plane and eye, and one of both facings beside them.
constexpr std::array<ClipPosition, 9> kPositions{{{-0.97f, -0.83f, 0.1f, 1},
                                                  {6.3f, -6.1f, 5.9f, 7},
                                                  {-2.7f, 2.9f, 1.9f, 3},
                                                  {0.9f, 0.93f, 0.1f, 1},
                                                  {-33.0f, 34.1f, 20.5f, 37.0f},
                                                  {0.33f, -0.31f, 0.02f, 0.41f},
                                                  {-0.05f, -0.9f, -0.4f, 0.2f},
                                                  {100.1f, 99.7f, 90.0f, 101.3f},
                                                  {-90.5f, 87.25f, 50, 101}}};

// In strong perspective, through near plane and eye: the weights, linear and in perspective, and what single vertices
// have.
Result<Scene> barycentricScene(bool provokingLast) {
    SceneRecorder record("I10", "Barycentric coordinates.");
    const uint32_t weights = record.colorTarget("weights", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
    const uint32_t linear = record.colorTarget("linear", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
    const uint32_t corners = record.colorTarget("corners", VK_FORMAT_R32G32B32A32_SFLOAT, kTarget);
    std::vector<ColorVertex> vertices;
    for (const ClipPosition& position : kPositions)
        vertices.push_back({position, {static_cast<float>(vertices.size()) + 0.1f, 0, 0, 1}});
    PipelineRecorder state = record
                                 .pipeline(record.vertex(kColorVertexGlsl), record.fragment(R"(#version 450
#extension GL_EXT_fragment_shader_barycentric : require
layout(location = 0) pervertexEXT in vec4 vColor[];
layout(location = 0) out vec4 weights;
layout(location = 1) out vec4 linear;
layout(location = 2) out vec4 corners;
void main() {
    weights = vec4(gl_BaryCoordEXT, 1.0);
    linear = vec4(gl_BaryCoordNoPerspEXT, 1.0);
    corners = vec4(vColor[0].x, vColor[1].x, vColor[2].x, 1.0);
}
)"))
                                 .binding(sizeof(ColorVertex))
                                 .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                 .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
                                 .targets(3);
    if (provokingLast) state.provokingVertexLast();
    record.pass(kTarget).color(weights, {}).color(linear, {}).color(corners, {});
    record.draw(state, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("vertices", vertices));
    for (const uint32_t target : {weights, linear, corners}) record.output(target);
    return record.finish();
}

}  // namespace

void barycentricCase(CaseInput& input) {
    for (const bool last : {false, true}) {
        const size_t scene = addForOracle(input, barycentricScene(last));
        for (const size_t output : {0, 1}) {
            judgePixels(input, scene, output, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
                for (uint32_t y = 0; y < kTarget.height; ++y) {
                    for (uint32_t x = 0; x < kTarget.width; ++x) {
                        if (pixels.number(x, y, 3) == 0) continue;
                        double sum = 0, least = 0;
                        for (uint8_t c = 0; c < 3; ++c) {
                            const double share = static_cast<double>(pixels.number(x, y, c));
                            sum += share;
                            least = std::min(least, share);
                        }
                        char text[96];
                        std::snprintf(text, sizeof text, ": the weights sum to 1 %+.3g, the least is %.3g", sum - 1,
                                      least);
                        // Two ULP of 1; snapping may have moved an edge over the sample.
                        if (std::abs(sum - 1) > 0x1p-22 || least < -0.02) return Verdict::wrong(pixelText(x, y) + text);
                    }
                }
                return {};
            });
        }
    }
}

}  // namespace vernier::conformance::hardcases
