// D: depth precision, bias, clamp.
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

std::string writes(const char* color) {
    return std::string("#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = ") + color + "; }\n";
}

// Steep triangles with all kinds of depths and w, far beyond the target and across the near plane.
std::vector<ClipPosition> steepTriangles() {
    std::vector<ClipPosition> result;
    size_t i = 0;
    for (const WindowTriangle& t : jitteredTiling(6, 10.5, 4, 0x1p12, 3)) {
        for (const WindowPoint& p : t) {
            const float w = 0.5f + static_cast<float>(i * 7 % 11) * 0.3f;
            const float z = static_cast<float>(i * 5 % 13) / 13.0f * 0.99f + 0.003f;
            result.push_back(clipAt(p, viewportOf(kTarget), z, w));
            ++i;
        }
    }
    result.push_back({-9, -7, -2, 1.5f});
    result.push_back({11, -3, 4, 5});
    result.push_back({0.5f, 12, 3, 6});
    return result;
}

Result<Scene> twiceScene(VkFormat format) {
    SceneRecorder record("D03", "Drawn twice, the second time with an EQUAL depth test.");
    const uint32_t color = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const uint32_t depth = record.depthTarget("depth", format, kTarget);
    const std::vector<ClipPosition> data = steepTriangles();
    const uint32_t vertices = record.vertexBuffer("vertices", data);
    const uint32_t vertex = record.vertex(kPositionVertexGlsl);
    const auto pipeline = [&](const char* written) {
        return record.pipeline(vertex, record.fragment(writes(written)))
            .binding(sizeof(ClipPosition))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
    };
    const uint32_t first = pipeline("vec4(1.0, 0.0, 0.0, 1.0)").depth(VK_COMPARE_OP_LESS);
    const uint32_t second = pipeline("vec4(0.0, 1.0, 0.0, 1.0)").depth(VK_COMPARE_OP_EQUAL);
    record.pass(kTarget).color(color, {0, 0, 0, 1}).depthStencil(depth);
    record.draw(first, static_cast<uint32_t>(data.size())).vertices(vertices);
    record.draw(second, static_cast<uint32_t>(data.size())).vertices(vertices);
    record.output(color);
    return record.finish();
}

void d03(CaseInput& input) {
    for (const VkFormat format : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM}) {
        const size_t scene = input.scene(twiceScene(format));
        judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
            size_t passed = 0;
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    passed += pixels.code(x, y, 1) == 255;
                    if (pixels.code(x, y, 0) == 0) continue;
                    return Verdict::wrong(pixelText(x, y) +
                                          ": the second draw of the same triangles failed EQUAL against the first");
                }
            }
            return passed < 2000 ? Verdict::wrong("only " + std::to_string(passed) + " pixels are covered") : Verdict{};
        });
    }
}

const std::vector<HardCase> kCases{
    {"D03",
     "The same triangles drawn again with an EQUAL depth test, D32 and D16",
     "Same vertices in the same order have the same depths: every fragment passes.",
     "Vulkan, Invariance",
     d03,
     {},
     {{"lavapipe", "z may differ for the same primitive when its origin rotation triggers"}}},
};

}  // namespace

std::span<const HardCase> depthCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
