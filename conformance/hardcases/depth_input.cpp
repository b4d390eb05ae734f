#include "conformance/hardcases/depth_input.h"

#include "conformance/hardcases/judges.h"
#include "conformance/oracle/depth_exact.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <cstdio>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget = kDepthExtent;

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

const char* const kDepthFragmentGlsl = R"(#version 450
layout(push_constant) uniform Bits { uint bits; };
void main() { gl_FragDepth = uintBitsToFloat(bits); }
)";

}  // namespace

Result<Scene> depthScene(std::string_view name, const std::vector<ClipPosition>& positions, const DepthDraw& how) {
    SceneRecorder record(name, "Depth alone.");
    const uint32_t depth = record.depthTarget("depth", how.format, kTarget);
    const uint32_t vertices = record.vertexBuffer("positions", positions);
    auto pipeline = record.pipeline(record.vertex(kPositionVertexGlsl), kNone)
                        .binding(sizeof(ClipPosition))
                        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                        .depth(VK_COMPARE_OP_ALWAYS);
    if (how.bias) pipeline.depthBias(how.biasConstant, how.biasSlope, how.biasClamp);
    if (how.clamp) pipeline.depthClamp();
    record.pass(kTarget).depthStencil(depth, how.clear);
    record.draw(pipeline, static_cast<uint32_t>(positions.size()))
        .vertices(vertices)
        .viewport(0, 0, 64, 64, how.minDepth, how.maxDepth);
    record.output(depth);
    return record.finish();
}

std::vector<ClipPosition> depthPlane(float z0, float z1, float z2) {
    return {{-1, -1, z0, 1}, {3, -1, z1, 1}, {-1, 3, z2, 1}};
}

void judgeBias(CaseInput& input, std::string_view name, const std::vector<ClipPosition>& positions, DepthDraw how,
               double low, double high, double slack, const std::string& rule) {
    how.bias = false;
    const size_t without = input.scene(depthScene(name, positions, how));
    how.bias = true;
    const size_t with = input.scene(depthScene(name, positions, how));
    const VkFormat format = how.format;
    input.judge({without, with}, [=](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        const PixelReader before(images[0]->at(0)), after(images[1]->at(0));
        if (!before.valid() || !after.valid()) return Verdict::wrong("an image has the wrong format, extent or size");
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                const double from = exact::decodeDepth(format, before.code(x, y, 0)).get_d();
                const double to = exact::decodeDepth(format, after.code(x, y, 0)).get_d();
                if (to - from >= low - slack && to - from <= high + slack) continue;
                return Verdict::wrong(pixelText(x, y) + " is shifted by " + number(to - from) + ", exactly " +
                                      number(low) + " to " + number(high) + "; " + rule);
            }
        }
        return {};
    });
}

Result<Scene> fragDepthScene(std::string_view name, VkFormat format, uint32_t bits, float clear, VkCompareOp op,
                             bool clamp) {
    SceneRecorder record(name, "A depth written by the fragment shader.");
    const uint32_t depth = record.depthTarget("depth", format, kTarget);
    auto pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(kDepthFragmentGlsl))
                        .targets(0)
                        .depth(op)
                        .pushConstants(4);
    if (clamp) pipeline.depthClamp();
    record.pass(kTarget).depthStencil(depth, clear);
    record.draw(pipeline, 3).push(bits);
    record.output(depth);
    return record.finish();
}

}  // namespace vernier::conformance::hardcases
