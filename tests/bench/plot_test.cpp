#include "bench/speed/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vernier::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(FittedExponent, IsThatOfAPowerLaw) {
    EXPECT_NEAR(fittedExponent({{1, 3}, {10, 30}, {1000, 3000}}), 1, 1e-12);
    EXPECT_NEAR(fittedExponent({{2, 12}, {4, 48}, {32, 3072}}), 2, 1e-12);
    EXPECT_NEAR(fittedExponent({{1, 8}, {2, 4}}), -1, 1e-12);
}

TEST(FittedExponent, NeedsTwoAmounts) {
    EXPECT_TRUE(std::isnan(fittedExponent({})));
    EXPECT_TRUE(std::isnan(fittedExponent({{5, 1}})));
    EXPECT_TRUE(std::isnan(fittedExponent({{5, 1}, {5, 2}})));
}

TEST(PlotSvg, PutsAPowerOfTenAtEvenDistances) {
    // From 1/1.15 to 100 * 1.15 over 64 to 460: the middle of both is 10.
    const std::string svg = plotSvg({"title", "amount", "ms", {{"one", {{1, 1}, {10, 10}, {100, 100}}}}});
    EXPECT_THAT(svg, HasSubstr("<circle cx='262.0' cy='195.0'"));
    EXPECT_THAT(svg, HasSubstr(">100</text>"));
}

TEST(PlotSvg, EscapesTextAndStandsMissingPoints) {
    const std::string svg = plotSvg({"a < b & c", "x", "y", {{"none", {}}, {"<i>", {{1, 1}}}}});
    EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
    EXPECT_THAT(svg, HasSubstr("&lt;i&gt;"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, HasSubstr("</svg>"));
}

}  // namespace
}  // namespace vernier::bench
