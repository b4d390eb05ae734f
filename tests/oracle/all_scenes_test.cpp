// Every conformance scene that the oracle does not refuse can be judged: it is rendered, nothing is left undecided, and
// what is called ambiguous is a small part of the picture.
#include "conformance/oracle/oracle.h"
#include "conformance/scenes/scenes.h"
#include "tests/oracle/rendered.h"

#include <gtest/gtest.h>
#include <algorithm>

#include <chrono>
#include <iostream>

namespace vernier::conformance {
namespace {

class EveryScene : public testing::TestWithParam<SceneEntry> {};

/// Where the specification itself leaves much open: Bresenham lines may be a pixel off, smooth lines have any alpha,
/// stipples and depth bias are cut at places that depend on it, and which samples an alpha covers is nobody's rule.
bool isLoose(std::string_view scene) {
    constexpr std::string_view kLoose[] = {"lines_bresenham",     "lines_smooth", "lines_stippled",
                                           "lines_stippled_wide", "depth_bias",   "alpha_to_coverage"};
    return std::find(std::begin(kLoose), std::end(kLoose), scene) != std::end(kLoose);
}

TEST_P(EveryScene, IsDecided) {
    const auto scene = GetParam().build();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const auto start = std::chrono::steady_clock::now();
    const auto images = renderOracle(*scene);
    if (!images.ok() && images.error().code == ErrorCode::unsupported) GTEST_SKIP() << images.error().message;
    ASSERT_TRUE(images.ok()) << images.error().message;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    for (size_t i = 0; i < images->size(); ++i) {
        const OracleImage& image = (*images)[i];
        const Comparison self = compareWithOracle(image, renderedFrom(image));
        double widest = 0, sum = 0;
        for (const OraclePixel& p : image.pixels) {
            if (p.flags) continue;
            for (size_t c = 0; c < 4; ++c) {
                widest = std::max(widest, p.high[c] - p.low[c]);
                sum += p.high[c] - p.low[c];
            }
        }
        std::cout << GetParam().name << " output " << i << ": " << seconds.count() << " s, " << image.pixels.size()
                  << " pixels, " << self.edges << " edge, " << self.unknown << " unknown, mean width "
                  << sum / (4.0 * static_cast<double>(image.pixels.size())) << ", widest " << widest << "\n";
        EXPECT_EQ(self.outside, 0u) << "the declared value is always permitted";
        EXPECT_EQ(self.unknown, 0u);
        EXPECT_LT(self.edges, image.pixels.size() / (isLoose(GetParam().name) ? 3 : 10));
    }
}

INSTANTIATE_TEST_SUITE_P(All, EveryScene, testing::ValuesIn(allScenes().begin(), allScenes().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace vernier::conformance
