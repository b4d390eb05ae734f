// What the specification leaves to implementations as a choice of several answers: pieces of stippled rectangles, and
// fragments that stand for some of a pixel's samples.
#include <gtest/gtest.h>

#include <vector>

#include "conformance/oracle/line_shape.h"
#include "tests/oracle/small_scene.h"

namespace vernier::conformance {
namespace {

using namespace small_scene;
using exact::GridPoint;
using exact::LineShape;
using exact::SampleVerdict;

LineShape::Setup fromOneToFourteen() {
    LineShape::Setup setup;
    setup.ends = {{{1, 8}, {14, 8}}};
    setup.width = 3;
    setup.stippleFactor = 2;
    setup.stipplePattern = 0xf0f6;  // from the lowest bit: 0 11 0 1111 ...
    return setup;
}

SampleVerdict verdictAt(const LineShape& line, double x, double y) {
    return line.classify(GridPoint{std::lround(x * 256), std::lround(y * 256)});
}

TEST(StippledRectangles, AreCutIntoPiecesOfUnitLength) {
    const LineShape line(fromOneToFourteen());
    // Two pixels a bit: none of pixels 1 and 2, all of 3 to 6, none of 7 and 8, all of 9 on.
    for (const double x : {1.5, 2.5, 7.5, 8.5}) EXPECT_FALSE(verdictAt(line, x, 8.5).possible) << x;
    for (const double x : {3.5, 4.5, 5.5, 6.5, 9.5, 13.5}) {
        EXPECT_TRUE(verdictAt(line, x, 8.5).isCertain()) << x;
        EXPECT_FALSE(verdictAt(line, x, 11.5).possible) << "beside the line";
    }
    const SampleVerdict border = verdictAt(line, 3.0 + 1 / 256.0, 8.5);
    EXPECT_TRUE(border.possible);
    EXPECT_TRUE(border.openAsWhole) << "where the end is snapped to moves the border";
    EXPECT_TRUE(border.nominalAsWhole);
    EXPECT_NEAR(line.stippleCount(), 13, 1e-9);
}

TEST(StippledRectangles, MayCountAnEndAsAPiece) {
    LineShape::Setup setup = fromOneToFourteen();
    setup.stippleStart = 2.5;
    setup.stippleFreedom = 1;
    const LineShape line(setup);
    // The count at 2.5 is 4: bit 2, or one bit on either side when one more or less was counted.
    EXPECT_TRUE(verdictAt(line, 2.5, 8.5).isNominal());
    EXPECT_FALSE(verdictAt(line, 5.0, 8.5).isNominal()) << "bit 3";
    EXPECT_TRUE(verdictAt(line, 5.0, 8.5).possible) << "bit 2, counted from one less";
}

/// A wide horizontal line, stippled.
Scene stippledLine(uint16_t pattern, uint32_t factor = 2) {
    return drawScene({vertex(1, 8, kRed), vertex(14, 8, kRed)}, kFlat, [=](Scene& scene) {
        ScenePipeline& pipeline = scene.pipelines[0];
        pipeline.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        pipeline.lineWidth = 3;
        pipeline.stippleFactor = factor;
        pipeline.stipplePattern = pattern;
    });
}

TEST(StippledRectangles, FaultsAreCaught) {
    const Scene right = stippledLine(0x00f6);
    EXPECT_EQ(judge(right, right).outside, 0u);
    EXPECT_EQ(judge(right, stippledLine(0x00f4)).outside, 2u * 2)
        << "a bit of the pattern is lost; outer rows are ties";
    EXPECT_GT(judge(right, stippledLine(0x00f6, 1)).outside, 0u) << "the factor is";
    EXPECT_GT(judge(right, stippledLine(0x6f00)).outside, 0u) << "bits in the other order";
}

constexpr const char* kStripes = R"(#version 450
layout(location = 0) in vec4 smoothColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(smoothColor.r, 0.0, 0.0, 1.0); }
)";

/// A ramp over all pixels into four samples, `least` of which are shaded; resolved.
Scene ramp(float least, float steepness = 1, float start = 0) {
    SceneRecorder record("ramp", "");
    const uint32_t samples = record.colorTarget("samples", VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_SAMPLE_COUNT_4_BIT);
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
    const auto at = [&](float x, float y) { return vertex(x, y, {start + steepness * (x + 8) / 64, 0, 0, 1}); };
    const uint32_t buffer = record.vertexBuffer("vertices", std::vector<Vertex>{at(-8, -8), at(56, -8), at(-8, 56)});
    const uint32_t pipeline = record.pipeline(record.vertex(kVertex), record.fragment(kStripes))
                                  .binding(sizeof(Vertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 16)
                                  .samples(VK_SAMPLE_COUNT_4_BIT)
                                  .sampleShading(least);
    record.pass(kExtent).color(samples, {0, 0, 0, 1}, target);
    record.draw(pipeline, 3).vertices(buffer);
    record.output(target);
    auto scene = record.finish();
    EXPECT_TRUE(scene.ok());
    return *scene;
}

TEST(SampleShading, OfSomeSamplesPermitsWhatAnySampleHas) {
    const OraclePixel all = at(render(ramp(1, 4)), 5, 5), half = at(render(ramp(0.5f, 4)), 5, 5);
    EXPECT_EQ(all.value[0], half.value[0]) << "all samples are shaded by the declared rule";
    // The steep ramp goes through 16 codes a pixel: samples are up to 6 of them from its centre.
    EXPECT_GT((half.high[0] - half.low[0]) * 255, 10);
    EXPECT_LT((half.high[0] - half.low[0]) * 255, 16);
    EXPECT_LT((all.high[0] - all.low[0]) * 255, 14) << "inputs at the centre alone";
}

TEST(SampleShading, FaultsAreCaught) {
    const Scene right = ramp(0.5f, 4);
    EXPECT_EQ(judge(right, right).outside, 0u);
    EXPECT_EQ(judge(right, ramp(0, 4)).outside, 0u) << "the centre's value is legal for inputs";
    EXPECT_EQ(judge(right, ramp(0.5f, 4, 4.0f / 64)).outside, 128u)
        << "inputs of the next pixel, where the ramp is below 1";
}

}  // namespace
}  // namespace vernier::conformance
