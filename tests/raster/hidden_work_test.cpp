// What is left out because later primitives hide it must not change an image: the same scenes with exact counts, where
// nothing is left out.
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kWidth = 200, kHeight = 150;
constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM;

struct Draw {
    PipelineOptions options;
    std::vector<Vertex> vertices;
};

struct Outcome {
    uint64_t color, depth, fragments;
};

class HiddenWorkTest : public testing::TestWithParam<VkFormat> {
  protected:
    GraphicsState state() const {
        GraphicsState state = plainState(kColor, GetParam());
        state.depthTest = state.depthWrite = true;
        state.depthCompare = VK_COMPARE_OP_LESS;
        return state;
    }

    Outcome run(const std::vector<Draw>& draws, bool exact, float clearDepth = 1,
                VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_CLEAR) {
        Surface color(kColor, kWidth, kHeight), depth(GetParam(), kWidth, kHeight);
        VkClearValue clear{};
        clear.depthStencil = {clearDepth, 7};
        Pass before(pool_, {color.cleared({})}, depth.cleared(clear), kWidth, kHeight);
        before.begin();
        before.end();
        RenderTarget depthTarget = depth.cleared(clear);
        depthTarget.loadOp = load;
        Pass pass(pool_, {color.cleared({})}, depthTarget, kWidth, kHeight);
        pass.begin();
        if (exact) pass.pass().countExactly();
        for (const Draw& draw : draws)
            pass.draw(makePipeline(draw.options), dynamicFor(kWidth, kHeight), draw.vertices);
        pass.end();
        return {color.hash(), depth.hash(), pass.pass().statistics().fragmentInvocations};
    }

    /// Two triangles over a rectangle; the depths of its corners.
    static std::vector<Vertex> quad(std::array<double, 4> rect, std::array<float, 4> z, std::array<float, 4> color) {
        const Vertex a = at(rect[0], rect[1], kWidth, kHeight, color, z[0]);
        const Vertex b = at(rect[2], rect[1], kWidth, kHeight, color, z[1]);
        const Vertex c = at(rect[0], rect[3], kWidth, kHeight, color, z[2]);
        const Vertex d = at(rect[2], rect[3], kWidth, kHeight, color, z[3]);
        return {a, b, c, c, b, d};
    }
    static std::vector<Vertex> full(float z, float red) {
        return quad({0, 0, kWidth, kHeight}, {z, z, z, z}, {red, 1 - red, 0.5f, 1});
    }

    ThreadPool pool_{2};
};

TEST_P(HiddenWorkTest, NearerLayersHideWhatIsBehind) {
    constexpr uint64_t kPixels = kWidth * kHeight;
    for (const bool reversed : {false, true}) {
        std::vector<Draw> draws;
        for (int n = 0; n < 5; ++n) {
            PipelineOptions options;
            options.state = state();
            options.state.depthCompare = reversed ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS;
            const float z = 0.8f - 0.1f * static_cast<float>(n);
            draws.push_back({options, full(reversed ? 1 - z : z, 0.2f * static_cast<float>(n))});
        }
        const float clear = reversed ? 0 : 1;
        const Outcome exact = run(draws, true, clear), hidden = run(draws, false, clear);
        EXPECT_EQ(hidden.color, exact.color);
        EXPECT_EQ(hidden.depth, exact.depth);
        EXPECT_EQ(exact.fragments, 5 * kPixels);
        // Not where a triangle covers little of a tile.
        EXPECT_LT(hidden.fragments, kPixels * 11 / 10);
        // Depths that are not known may be nearer.
        EXPECT_EQ(run(draws, false, clear, VK_ATTACHMENT_LOAD_OP_LOAD).fragments, 5 * kPixels);
    }
}

TEST_P(HiddenWorkTest, NothingThatShowsIsLeftOut) {
    std::mt19937 random(static_cast<uint32_t>(GetParam()));
    const auto oneOf = [&](uint32_t n) { return random() % n; };
    const auto unit = [&] { return static_cast<float>(random() % 1024) / 1023; };
    constexpr VkCompareOp kCompare[] = {VK_COMPARE_OP_LESS,    VK_COMPARE_OP_LESS,   VK_COMPARE_OP_LESS_OR_EQUAL,
                                        VK_COMPARE_OP_GREATER, VK_COMPARE_OP_ALWAYS, VK_COMPARE_OP_NOT_EQUAL};
    uint32_t saved = 0;
    for (int scene = 0; scene < 150; ++scene) {
        std::vector<Draw> draws;
        const uint32_t count = 2 + oneOf(7);
        // Most scenes go from back to front, with exceptions here and there.
        const VkCompareOp usual = kCompare[oneOf(5)];
        for (uint32_t n = 0; n < count; ++n) {
            PipelineOptions options;
            options.state = state();
            const bool odd = oneOf(6) == 0;
            options.state.depthCompare = odd ? kCompare[oneOf(6)] : usual;
            options.state.depthTest = oneOf(8) != 0;
            options.state.depthWrite = oneOf(6) != 0;
            if (oneOf(8) == 0) setAdditive(options.state);
            if (oneOf(10) == 0) options.state.blend[0].colorWriteMask = 5;
            if (oneOf(10) == 0) options.fragment = oneOf(2) == 0 ? "discard_frag" : "fragdepth_frag";
            const float step = static_cast<float>(n + 1) / static_cast<float>(count + 1);
            const float z = odd ? unit() : usual == VK_COMPARE_OP_GREATER ? step : 1 - step;
            const auto near = [&] { return std::clamp(z + 0.1f * (unit() - 0.5f), 0.0f, 1.0f); };
            std::array<float, 4> corners{z, z, z, z};
            if (oneOf(2) == 0) corners = {near(), near(), near(), near()};
            const std::array<double, 4> part{double(oneOf(kWidth)), double(oneOf(kHeight)), double(oneOf(kWidth)),
                                             double(oneOf(kHeight))};
            const std::array<double, 4> whole{-1, -1, kWidth + 1, kHeight + 1};
            draws.push_back({options, quad(oneOf(3) == 0 ? part : whole, corners, {unit(), unit(), unit(), unit()})});
        }
        const float clear = oneOf(2) == 0 ? unit() : usual == VK_COMPARE_OP_GREATER ? 0.0f : 1.0f;
        const Outcome exact = run(draws, true, clear), hidden = run(draws, false, clear);
        ASSERT_EQ(hidden.color, exact.color) << scene;
        ASSERT_EQ(hidden.depth, exact.depth) << scene;
        saved += hidden.fragments < exact.fragments ? 1 : 0;
    }
    EXPECT_GT(saved, 40u);
}

INSTANTIATE_TEST_SUITE_P(Formats, HiddenWorkTest,
                         testing::Values(VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT,
                                         VK_FORMAT_D32_SFLOAT_S8_UINT));

}  // namespace
}  // namespace vernier::raster_test
