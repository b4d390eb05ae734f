// Every conformance scene that the oracle does not refuse can be judged: it is rendered, nothing is left undecided, and
// what is called ambiguous is a small part of the picture.
#include "conformance/oracle/oracle.h"
#include "conformance/scenes/scenes.h"
#include "tests/oracle/rendered.h"

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>

namespace vernier::conformance {
namespace {

class EveryScene : public testing::TestWithParam<SceneEntry> {};

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
        EXPECT_LT(self.edges, image.pixels.size() / 10);
    }
}

INSTANTIATE_TEST_SUITE_P(All, EveryScene, testing::ValuesIn(allScenes().begin(), allScenes().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace vernier::conformance
