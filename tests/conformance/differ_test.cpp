#include "conformance/differ/classify.h"
#include "conformance/differ/known_gaps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace vernier::conformance {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr uint32_t kWidth = 5, kHeight = 3;

/// An RGBA8 image of one colour.
RenderedImage flat(uint8_t r, uint8_t g, uint8_t b) {
    RenderedImage image{VK_FORMAT_R8G8B8A8_UNORM, {kWidth, kHeight}, {}};
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
        for (const int value : {int{r}, int{g}, int{b}, 255}) image.texels.push_back(static_cast<std::byte>(value));
    }
    return image;
}

void set(RenderedImage& image, uint32_t x, uint32_t y, size_t component, int code) {
    image.texels[(size_t{y} * kWidth + x) * 4 + component] = static_cast<std::byte>(code);
}

/// An oracle that permits exactly one real value per component.
OracleImage exactly(double r, double g, double b) {
    const std::array<double, 4> value{r, g, b, 1};
    return {VK_FORMAT_R8G8B8A8_UNORM, {kWidth, kHeight}, {kWidth * kHeight, OraclePixel{value, value, value, 0}}};
}

OraclePixel& at(OracleImage& oracle, uint32_t x, uint32_t y) {
    return oracle.pixels[size_t{y} * kWidth + x];
}

PixelClass classAt(const ImageDiff& diff, uint32_t x, uint32_t y) {
    return diff.pixels[size_t{y} * diff.extent.width + x].pixelClass;
}

ImageDiff compare(const RenderedImage& ours, const RenderedImage& other, const OracleImage* oracle = nullptr) {
    Result<ImageDiff> diff = compareImages(ours, other, oracle);
    EXPECT_TRUE(diff.ok()) << (diff.ok() ? "" : diff.error().message);
    return diff.ok() ? std::move(diff).value() : ImageDiff{};
}

TEST(Differ, EqualImages) {
    const RenderedImage image = flat(10, 20, 30);
    const ImageDiff diff = compare(image, image);
    EXPECT_EQ(diff.count(PixelClass::equal), kWidth * kHeight);
    EXPECT_EQ(diff.failures(), 0u);
    EXPECT_EQ(diff.worstClass, PixelClass::equal);
    EXPECT_THAT(diff.worstError, ElementsAre(0, 0, 0, 0));
}

TEST(Differ, WithoutOracleOneCodeIsRoundingAndMoreIsUnexplained) {
    const RenderedImage other = flat(10, 20, 30);
    RenderedImage ours = other;
    set(ours, 1, 0, 0, 11);
    set(ours, 2, 1, 1, 18);
    set(ours, 4, 2, 2, 39);
    const ImageDiff diff = compare(ours, other);
    EXPECT_FALSE(diff.hasOracle);
    EXPECT_EQ(diff.count(PixelClass::equal), kWidth * kHeight - 3);
    EXPECT_EQ(classAt(diff, 1, 0), PixelClass::rounding);
    EXPECT_EQ(classAt(diff, 2, 1), PixelClass::unexplained);
    EXPECT_EQ(diff.failures(), 2u);
    EXPECT_THAT(diff.worstError, ElementsAre(1, -2, 9, 0)) << "signed, per component";
    EXPECT_EQ(diff.worstX, 4u);
    EXPECT_EQ(diff.worstY, 2u);
}

TEST(Differ, BothNeighboursOfTheExactValueAreLegal) {
    const OracleImage oracle = exactly(10.4 / 255, 20.0 / 255, 30.6 / 255);
    RenderedImage ours = flat(10, 20, 30), other = flat(11, 20, 31);
    EXPECT_EQ(compare(ours, other, &oracle).count(PixelClass::rounding), kWidth * kHeight);
    // 20 / 255 is a code itself: nothing else is legal.
    set(other, 0, 0, 1, 21);
    EXPECT_EQ(classAt(compare(ours, other, &oracle), 0, 0), PixelClass::otherWrong);
    set(ours, 3, 0, 0, 12);
    EXPECT_EQ(classAt(compare(ours, other, &oracle), 3, 0), PixelClass::oursWrong);
}

TEST(Differ, ToleranceAndEdge) {
    OracleImage oracle = exactly(0.5, 0.5, 0.5);
    at(oracle, 1, 1).low = {0.4, 0.5, 0.5, 1};
    at(oracle, 1, 1).high = {0.6, 0.5, 0.5, 1};
    at(oracle, 2, 1) = {{0.5, 0.5, 0.5, 1}, {0, 0, 0, 1}, {1, 1, 1, 1}, kOracleEdge};
    RenderedImage ours = flat(127, 127, 127), other = flat(127, 127, 127);
    set(other, 1, 1, 0, 150);
    set(ours, 2, 1, 2, 0);
    const ImageDiff diff = compare(ours, other, &oracle);
    EXPECT_EQ(classAt(diff, 1, 1), PixelClass::interpolation);
    EXPECT_EQ(classAt(diff, 2, 1), PixelClass::snap);
    EXPECT_EQ(diff.failures(), 0u);
    set(other, 1, 1, 0, 160);  // beyond the interval
    EXPECT_EQ(classAt(compare(ours, other, &oracle), 1, 1), PixelClass::otherWrong);
}

TEST(Differ, LegalDifferencesHaveACause) {
    const std::pair<int, PixelClass> causes[] = {{kOracleEdge | kOracleSnap, PixelClass::snap},
                                                 {kOracleEdge | kOracleTie, PixelClass::tie},
                                                 {kOracleEdge | kOracleOrder, PixelClass::order},
                                                 {kOracleEdge | kOraclePattern, PixelClass::pattern},
                                                 {kOracleTie | kOracleWeights, PixelClass::weights},
                                                 {kOracleLevel | kOracleWeights, PixelClass::level},
                                                 {0, PixelClass::interpolation},
                                                 {kOracleUndefined, PixelClass::undefined},
                                                 {kOracleEdge | kOracleTie | kOracleSnap, PixelClass::snap}};
    for (const auto& [flags, cause] : causes) {
        OracleImage oracle = exactly(0.5, 0.5, 0.5);
        at(oracle, 1, 1) = {{0.5, 0.5, 0.5, 1}, {0, 0, 0, 1}, {1, 1, 1, 1}, static_cast<OracleFlags>(flags)};
        RenderedImage ours = flat(127, 127, 127), other = flat(127, 127, 127);
        set(other, 1, 1, 0, 150);
        const ImageDiff diff = compare(ours, other, &oracle);
        EXPECT_EQ(classAt(diff, 1, 1), cause) << flags;
        EXPECT_EQ(diff.failures(), 0u);
    }
}

TEST(Differ, NeitherLegalIsUnexplainedEvenWhenEqual) {
    const OracleImage oracle = exactly(0.5, 0.5, 0.5);
    const RenderedImage wrong = flat(10, 127, 127);
    const ImageDiff diff = compare(wrong, wrong, &oracle);
    EXPECT_EQ(diff.count(PixelClass::unexplained), kWidth * kHeight);
}

TEST(Differ, UndecidedPixelsAreCountedAndFailWhenTheyDiffer) {
    OracleImage oracle = exactly(0.5, 0.5, 0.5);
    at(oracle, 0, 2).flags = kOracleUnknown;
    at(oracle, 1, 2).flags = kOracleUnknown;
    const RenderedImage ours = flat(127, 127, 127);
    RenderedImage other = ours;
    set(other, 0, 2, 0, 128);
    const ImageDiff diff = compare(ours, other, &oracle);
    EXPECT_EQ(diff.unknownPixels, 2u);
    EXPECT_EQ(classAt(diff, 0, 2), PixelClass::undecided) << "one code is no excuse where nobody knows the value";
    EXPECT_EQ(classAt(diff, 1, 2), PixelClass::equal);
    EXPECT_EQ(diff.failures(), 1u);
}

// Every single change of a component of a legal image beyond its neighbours must be noticed.
TEST(Differ, EveryMutationIsCaught) {
    const OracleImage oracle = exactly(100.5 / 255, 50.0 / 255, 200.25 / 255);
    const RenderedImage good = flat(100, 50, 200);
    for (uint32_t y = 0; y < kHeight; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            for (size_t component = 0; component < 4; ++component) {
                const int code = std::to_integer<int>(good.texels[component]);
                for (const int change : {-3, -2, 2, 3, -code, 255 - code}) {
                    if (std::abs(change) < 2 || code + change < 0 || code + change > 255) continue;
                    RenderedImage mutated = good;
                    set(mutated, x, y, component, code + change);
                    const ImageDiff diff = compare(mutated, good, &oracle);
                    ASSERT_EQ(diff.failures(), 1u) << x << " " << y << " " << component << " " << change;
                    ASSERT_EQ(classAt(diff, x, y), PixelClass::oursWrong);
                    ASSERT_EQ(diff.worstError[component], change);
                    ASSERT_EQ(diff.worstX, x);
                    ASSERT_EQ(diff.worstY, y);
                    Result<ImageDiff> alone = compareWithOracle(mutated, oracle);
                    ASSERT_TRUE(alone.ok());
                    ASSERT_EQ(alone.value().failures(), 1u);
                }
            }
        }
    }
}

TEST(Differ, ValuesBeyondTheScaleSaturate) {
    const OracleImage oracle = exactly(1.5, -0.5, 1.0);
    const RenderedImage image = flat(255, 0, 255);
    EXPECT_EQ(compare(image, image, &oracle).failures(), 0u);
    EXPECT_EQ(compare(flat(254, 0, 255), image, &oracle).count(PixelClass::oursWrong), kWidth * kHeight);
}

RenderedImage floats(std::initializer_list<float> values) {
    RenderedImage image{VK_FORMAT_R32_SFLOAT, {static_cast<uint32_t>(values.size()), 1}, {}};
    image.texels.resize(values.size() * 4);
    std::memcpy(image.texels.data(), std::data(values), image.texels.size());
    return image;
}

TEST(Differ, FloatsAreComparedInUlpAndNanIsAClassOfItsOwn) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float otherNan = std::bit_cast<float>(0x7fc12345u);
    const RenderedImage ours = floats({1, nan, nan, 0.0f, 1e-40f, 1});
    const RenderedImage other = floats({std::nextafter(1.0f, 2.0f), otherNan, 3, -0.0f, -1e-40f, 1 + 4e-7f});
    const ImageDiff diff = compare(ours, other);
    EXPECT_EQ(classAt(diff, 0, 0), PixelClass::rounding);
    EXPECT_EQ(classAt(diff, 1, 0), PixelClass::equal) << "any NaN is like any other";
    EXPECT_EQ(classAt(diff, 2, 0), PixelClass::unexplained);
    EXPECT_EQ(classAt(diff, 3, 0), PixelClass::equal) << "-0 is 0";
    EXPECT_EQ(classAt(diff, 4, 0), PixelClass::unexplained);
    EXPECT_EQ(classAt(diff, 5, 0), PixelClass::unexplained);
    EXPECT_EQ(diff.nanPixels, 1u);
}

TEST(Differ, NanIsLegalOnlyWhereTheOracleSaysSo) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    OracleImage oracle{VK_FORMAT_R32_SFLOAT, {2, 1}, {}};
    oracle.pixels = {{{nan}, {nan}, {nan}, 0}, {{1}, {1}, {1}, 0}};
    const float value = std::numeric_limits<float>::quiet_NaN();
    const ImageDiff diff = compare(floats({value, value}), floats({value, 1}), &oracle);
    EXPECT_EQ(classAt(diff, 0, 0), PixelClass::equal);
    EXPECT_EQ(classAt(diff, 1, 0), PixelClass::oursWrong);
}

TEST(Differ, AgainstTheOracleAlone) {
    OracleImage oracle = exactly(100.25 / 255, 50.0 / 255, 200.0 / 255);
    at(oracle, 2, 0).low = {90.0 / 255, 50.0 / 255, 200.0 / 255, 1};
    at(oracle, 3, 0) = {{0, 0, 0, 1}, {0, 0, 0, 1}, {1, 1, 1, 1}, kOracleEdge};
    RenderedImage image = flat(100, 50, 200);
    set(image, 1, 0, 0, 101);
    set(image, 2, 0, 0, 92);
    set(image, 4, 0, 2, 202);
    Result<ImageDiff> diff = compareWithOracle(image, oracle);
    ASSERT_TRUE(diff.ok());
    EXPECT_EQ(classAt(diff.value(), 0, 0), PixelClass::equal);
    EXPECT_EQ(classAt(diff.value(), 1, 0), PixelClass::rounding);
    EXPECT_EQ(classAt(diff.value(), 2, 0), PixelClass::interpolation);
    EXPECT_EQ(classAt(diff.value(), 3, 0), PixelClass::snap);
    EXPECT_EQ(classAt(diff.value(), 4, 0), PixelClass::oursWrong);
    EXPECT_EQ(diff.value().pixels[4].error, 2);
}

TEST(Differ, ImagesThatDoNotMatchAreRefused) {
    const RenderedImage image = flat(1, 2, 3);
    RenderedImage other = image;
    other.extent = {kHeight, kWidth};
    EXPECT_THAT(compareImages(image, other, nullptr).error().message, HasSubstr("do not match"));
    other = image;
    other.format = VK_FORMAT_B8G8R8A8_UNORM;
    EXPECT_THAT(compareImages(image, other, nullptr).error().message, HasSubstr("format 44"));
    other = image;
    other.texels.pop_back();
    EXPECT_THAT(compareImages(image, other, nullptr).error().message, HasSubstr("59 bytes"));
    OracleImage oracle = exactly(0, 0, 0);
    oracle.pixels.pop_back();
    EXPECT_THAT(compareImages(image, image, &oracle).error().message, HasSubstr("OracleImage::pixels"));
    EXPECT_FALSE(compareWithOracle(image, oracle).ok());
}

TEST(KnownGaps, AreReadAndChecked) {
    const auto gaps = parseKnownGaps(
        R"({"gaps": [{"scene": "srgb", "driver": "icd", "against": "lavapipe", "class": "unexplained", "max": 12,
                      "reason": "because"}]})");
    ASSERT_TRUE(gaps.ok()) << gaps.error().message;
    ASSERT_THAT(gaps.value(), SizeIs(1));
    EXPECT_EQ(gaps.value()[0].maxCount, 12u);
    const auto message = [](const char* json) { return parseKnownGaps(json).error().message; };
    EXPECT_THAT(message("{"), HasSubstr("known gaps"));
    EXPECT_THAT(message(R"({"gaps": [{"scene": "srgb"}]})"), HasSubstr("driver"));
    EXPECT_THAT(message(R"({"gaps": [{"scene": "a", "driver": "b", "class": "snap", "max": 1, "reason": "c"}]})"),
                HasSubstr("'snap'"));
    EXPECT_THAT(message(R"({"gaps": [{"scene": "a", "driver": "b", "class": "oursWrong", "max": 0, "reason": "c"}]})"),
                HasSubstr("max is 0"));
    EXPECT_THAT(message(R"({"gaps": [{"scene": "a", "driver": "b", "class": "oursWrong", "max": 1, "reason": ""}]})"),
                HasSubstr("reason is empty"));
}

TEST(KnownGaps, CoverFindingsUpToTheirSizeAndGoStale) {
    const std::vector<KnownGap> gaps{{"a", "icd", "lavapipe", "unexplained", 5, "why"},
                                     {"b", "api", "", "notRendered", 1, "not yet"}};
    const RunExtent all{{"a", "b"}, {"icd", "api", "lavapipe"}};
    const std::vector<Finding> known{{"a", "icd", "lavapipe", "unexplained", 5}, {"b", "api", "", "notRendered", 1}};
    GapJudgement judgement = judgeFindings(known, gaps, all);
    EXPECT_TRUE(judgement.passed());
    EXPECT_THAT(judgement.covered, SizeIs(2));

    judgement = judgeFindings(std::vector<Finding>{{"a", "icd", "lavapipe", "unexplained", 6}, known[1]}, gaps, all);
    EXPECT_THAT(judgement.violations, ElementsAre(HasSubstr("6 unexplained"))) << "grown";
    EXPECT_THAT(judgement.stale, IsEmpty());

    judgement = judgeFindings(std::vector<Finding>{known[0]}, gaps, all);
    EXPECT_THAT(judgement.stale, ElementsAre(HasSubstr("b, api")));
    EXPECT_FALSE(judgement.passed());

    judgement = judgeFindings(std::vector<Finding>{known[0]}, gaps, RunExtent{{"a"}, {"icd", "lavapipe"}});
    EXPECT_TRUE(judgement.passed()) << "scene b was not run";

    judgement = judgeFindings(std::vector<Finding>{{"a", "icd", "swiftshader", "unexplained", 1}, known[0], known[1]},
                              gaps, all);
    EXPECT_THAT(judgement.violations, SizeIs(1)) << "another driver is another finding";
}

TEST(PixelClasses, HaveNamesTextsAndThoseThatFail) {
    for (size_t i = 0; i < kPixelClassCount; ++i) {
        EXPECT_FALSE(pixelClassName(static_cast<PixelClass>(i)).empty());
        EXPECT_FALSE(pixelClassText(static_cast<PixelClass>(i)).empty());
    }
    EXPECT_TRUE(isFailure(PixelClass::unexplained));
    EXPECT_TRUE(isFailure(PixelClass::oursWrong));
    EXPECT_TRUE(isFailure(PixelClass::undecided));
    EXPECT_FALSE(isFailure(PixelClass::otherWrong));
    EXPECT_FALSE(isFailure(PixelClass::snap));
}

}  // namespace
}  // namespace vernier::conformance
