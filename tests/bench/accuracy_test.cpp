// The scenes of accuracy are what they say, and what is concluded from figures is right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/accuracy/accuracy_scene.h"
#include "bench/accuracy/chart.h"
#include "bench/accuracy/choose.h"
#include "bench/accuracy/figures.h"
#include "bench/accuracy/page.h"
#include "bench/accuracy/removed.h"
#include "conformance/drivers/api_driver.h"
#include "conformance/tool/driver_choice.h"

namespace vernier::bench {
namespace {

using namespace conformance;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(AccuracyScenes, AreManyAndSound) {
    std::set<std::string> names;
    for (const AccuracyScene& scene : accuracySceneTable())
        for (const SceneUse use : {SceneUse::judged, SceneUse::timed, SceneUse::counted}) {
            EXPECT_TRUE(names.insert(variantName(scene, use)).second) << scene.name;
            const Result<Scene> built = accuracySceneNamed(variantName(scene, use));
            ASSERT_TRUE(built.ok()) << built.error().message;
            EXPECT_TRUE(validateScene(*built).ok()) << variantName(scene, use);
        }
    EXPECT_GE(accuracySceneTable().size(), 12u);
    EXPECT_FALSE(accuracySceneNamed("far_triangles:").ok());
    EXPECT_FALSE(accuracySceneNamed("shoes").ok());
}

/// Meshes are partitions at every position of the dial: neither a hole nor a double.
TEST(AccuracyScenes, CoverEveryPixelExactlySoOften) {
    for (const VnProfile profile : {VN_PROFILE_DRAFT, VN_PROFILE_STANDARD, VN_PROFILE_REFERENCE}) {
        Result<std::unique_ptr<ApiDriver>> driver = ApiDriver::create({profile, 2, nullptr, nullptr});
        ASSERT_TRUE(driver.ok()) << driver.error().message;
        for (const AccuracyScene& scene : accuracySceneTable()) {
            const Result<Scene> counted = buildAccuracyScene(scene, SceneUse::counted);
            ASSERT_TRUE(counted.ok()) << counted.error().message;
            const Result<std::vector<RenderedImage>> images = (*driver)->render(*counted, nullptr);
            ASSERT_TRUE(images.ok()) << scene.name << ": " << images.error().message;
            AccuracyFigures figures;
            countCover((*images)[0], scene.cover, figures);
            EXPECT_EQ(figures.holes, 0u) << scene.name << " at profile " << profile;
            EXPECT_EQ(figures.doubles, 0u) << scene.name << " at profile " << profile;
        }
    }
}

/// Pixels of a scene at standard with `axes` that are outside what `rules` permit, of those that are judged.
std::pair<uint64_t, uint64_t> outsideOf(const AccuracyScene& scene, const char* axes, const OracleRules& rules) {
    const Result<Scene> built = buildAccuracyScene(scene, SceneUse::judged);
    const Result<std::vector<OracleImage>> oracle = judgeScene(*built, rules);
    EXPECT_TRUE(oracle.ok()) << scene.name << ": " << oracle.error().message;
    const Result<std::unique_ptr<ApiDriver>> driver = ApiDriver::create({VN_PROFILE_STANDARD, 2, nullptr, axes});
    EXPECT_TRUE(driver.ok()) << driver.error().message;
    const Result<std::vector<RenderedImage>> images = (*driver)->render(*built, nullptr);
    EXPECT_TRUE(images.ok()) << scene.name << ": " << images.error().message;
    AccuracyFigures figures;
    judgeImage((*images)[0], (*oracle)[0], (*oracle)[0], figures);
    return {figures.outside, figures.judged};
}

/// Less accurate is never unverified: what fragments of 2x2 pixels are to show, the oracle says pixel by pixel.
TEST(AccuracyScenes, CoarseShadingIsWhatTheOracleDeclares) {
    for (const char* name : {"plasma", "specular", "perspective_mesh", "magnified_ramp", "minified", "gradient"}) {
        const auto table = accuracySceneTable();
        const auto scene = std::find_if(table.begin(), table.end(),
                                        [&](const AccuracyScene& each) { return each.name == std::string(name); });
        ASSERT_NE(scene, table.end()) << name;
        OracleRules coarse;
        coarse.coarseShading = true;
        const auto [wrong, judged] = outsideOf(*scene, "shading=2x2", coarse);
        EXPECT_EQ(wrong, 0u) << name;
        EXPECT_GT(judged, 1000u) << name;
        EXPECT_GT(outsideOf(*scene, "shading=2x2", {}).first, judged / 4)
            << name << ": the same as a fragment for each pixel";
    }
}

RenderedImage imageOf(const std::vector<std::array<float, 4>>& pixels) {
    RenderedImage image{VK_FORMAT_R32G32B32A32_SFLOAT, {static_cast<uint32_t>(pixels.size()), 1}, {}};
    image.texels.resize(pixels.size() * 16);
    std::memcpy(image.texels.data(), pixels.data(), image.texels.size());
    return image;
}

OracleImage oracleOf(const std::vector<std::pair<double, uint8_t>>& pixels) {
    OracleImage image{VK_FORMAT_R32G32B32A32_SFLOAT, {static_cast<uint32_t>(pixels.size()), 1}, {}};
    for (const auto& [value, flags] : pixels)
        image.pixels.push_back(
            {{value, value, value, value}, {value, value, value, value}, {value, value, value, value}, flags});
    return image;
}

constexpr std::array<float, 4> grey(float value) {
    return {value, value, value, value};
}

TEST(AccuracyFigures, MeasureValuesAwayFromEdgesAndSurfacesAtThem) {
    const OracleImage declared =
        oracleOf({{0.5, 0}, {0.5, 0}, {0.5, kOracleEdge}, {0.5, kOracleEdge}, {0.5, kOracleUnknown}});
    const OracleImage exact = oracleOf({{0.5, 0}, {0.5, 0}, {0.5, 0}, {0.5, 0}, {0.5, kOracleUnknown}});
    const RenderedImage image = imageOf({grey(0.5f), grey(0.75f), grey(0.0f), grey(0.501f), grey(0.0f)});
    AccuracyFigures figures;
    judgeImage(image, declared, exact, figures);
    EXPECT_EQ(figures.judged, 2u);
    EXPECT_EQ(figures.undecided, 1u);
    EXPECT_EQ(figures.outside, 1u);
    EXPECT_DOUBLE_EQ(figures.worst, 0.25 * 255);
    EXPECT_DOUBLE_EQ(figures.mean, 0.125 * 255);
    EXPECT_EQ(figures.worstX, 1u);
    EXPECT_EQ(figures.misplaced, 1u) << "the third pixel shows another surface, the fourth the same with an error";
    EXPECT_THAT(signedErrors(image, declared), ElementsAre(0, 0.25 * 255, 0, 0, 0));
}

TEST(AccuracyFigures, NanIsInfinitelyWrong) {
    AccuracyFigures figures;
    judgeImage(imageOf({grey(std::nanf(""))}), oracleOf({{0.5, 0}}), oracleOf({{0.5, 0}}), figures);
    EXPECT_TRUE(std::isinf(figures.worst));
    EXPECT_EQ(figures.outside, 1u);
    const Result<AccuracyFigures> back = figuresFromJson(nlohmann::json::parse(figuresJson(figures).dump()));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_TRUE(std::isinf(back->worst));
}

TEST(AccuracyFigures, CountHolesAndDoubles) {
    AccuracyFigures figures;
    countCover(imageOf({grey(2), grey(1), grey(3), grey(0), grey(2)}), 2, figures);
    EXPECT_EQ(figures.holes, 2u);
    EXPECT_EQ(figures.doubles, 1u);
}

TEST(AccuracyFigures, RefuseJsonThatIsNotTheirs) {
    EXPECT_FALSE(figuresFromJson(nlohmann::json::parse(R"({"frame_ms": 1})")).ok());
    EXPECT_FALSE(figuresFromJson(nlohmann::json::parse(R"([1, 2])")).ok());
}

/// Positions by label, milliseconds and mean error.
AccuracyRun runOf(const std::vector<std::tuple<std::string, double, double>>& entries) {
    AccuracyRun run;
    MeasuredScene& scene = run.scenes.emplace_back();
    scene.scene = &accuracySceneTable()[0];
    scene.oracle = oracleOf({{0.5, 0}});
    for (const auto& [label, frame, mean] : entries) {
        AccuracyPosition& position = run.positions.emplace_back();
        position.label = label;
        position.driver = label == "lavapipe" ? "lavapipe" : "api";
        position.belowVulkan = label == "draft";
        if (const size_t equals = label.find('='); equals != std::string::npos) {
            position.axis = label.substr(0, equals);
            position.axes = label;
            position.exactest = true;
        }
        AccuracyFigures figures;
        figures.frame = frame;
        figures.worst = figures.mean = mean;
        scene.figures[label] = figures;
        scene.images[label] = imageOf({grey(0.25f)});
    }
    return run;
}

AccuracyRun sampleRun() {
    return runOf({{"draft", 1, 0.5},
                  {"fast", 2, 0.2},
                  {"standard", 3, 0.1},
                  {"fine", 3.02, 0.04},
                  {"reference", 8, 0.04},
                  {"math=fine", 2.5, 0.3},
                  {"lavapipe", 0.5, 0.01}});
}

TEST(AccuracyChoice, FrontIsWhatNothingOfOursBeats) {
    const AccuracyRun run = sampleRun();
    // `fine` is as fast as `standard` within the noise, and more exact; lavapipe is no position of ours.
    EXPECT_THAT(paretoFront(run, run.scenes[0]), ElementsAre("draft", "fast", "fine"));
}

std::vector<std::string> namesOf(const std::vector<Standing>& all, bool (*picks)(const Standing&)) {
    std::vector<std::string> names;
    for (const Standing& standing : all)
        if (picks(standing)) names.push_back(standing.axis + "=" + standing.position);
    return names;
}
bool standsAlone(const Standing& standing) {
    return !standing.alone.empty();
}
bool standsWithOthers(const Standing& standing) {
    return !standing.shared.empty();
}

TEST(AccuracyChoice, PositionsAreEarnedAgainstTheirAxis) {
    AccuracyRun run = runOf({{"standard", 3, 0.1},
                             {"subpixel=4", 2.98, 0.2},
                             {"subpixel=12", 3.02, 0.1},
                             {"math=fast", 2, 0.3},
                             {"math=fine", 3.01, 0.05},
                             {"lavapipe", 0.5, 0.01}});
    // 4 is no faster than 8, 12 no more exact; and finer maths costs nothing, so that standard is beaten there.
    EXPECT_THAT(namesOf(standings(run), standsAlone), ElementsAre("profile=standard", "math=fast", "math=fine"));
    EXPECT_THAT(namesOf(standings(run), standsWithOthers), ElementsAre("subpixel=8", "subpixel=12"));
    // Clearly slower, and no more exact; clearly faster.
    run.scenes[0].figures["subpixel=12"].frame = 3.2;
    run.scenes[0].figures["subpixel=4"].frame = 2.8;
    EXPECT_THAT(namesOf(standings(run), standsAlone),
                ElementsAre("profile=standard", "subpixel=4", "subpixel=8", "math=fast", "math=fine"));
    EXPECT_THAT(standingsText(run), HasSubstr("| subpixel | 8 (standard) | 1 | far_triangles | 0 |\n"));
    EXPECT_THAT(standingsText(run), HasSubstr("| subpixel | 12 | 0 |  | 0 |\n"));
    EXPECT_THAT(*accuracyPage(run),
                HasSubstr("<td>subpixel<td>8 (standard)<td>1<td style='text-align:left'>far_triangles<td>0"));
    EXPECT_THAT(runJson(run), HasSubstr("\"standings\""));
}

TEST(AccuracyChoice, NoiseIsWhatRoundsOfOnePositionDifferBy) {
    AccuracyRun run = runOf({{"standard", 3, 0.1}, {"subpixel=4", 2.9, 0.2}, {"lavapipe", 1, 0.01}});
    MeasuredScene& scene = run.scenes[0];
    EXPECT_DOUBLE_EQ(timeNoise(run, scene), kLeastNoise) << "nothing was drawn twice";
    EXPECT_THAT(namesOf(standings(run), standsAlone), ElementsAre("profile=standard", "subpixel=4", "subpixel=8"));
    addRound(3.3, scene.figures["standard"]);
    addRound(3.0, scene.figures["standard"]);
    addRound(5.0, scene.figures["standard"]);
    addRound(7.0, scene.figures["lavapipe"]);
    addRound(1.0, scene.figures["lavapipe"]);
    EXPECT_NEAR(timeNoise(run, scene), 0.1, 1e-9) << "the two fastest rounds, of Vernier";
    EXPECT_THAT(namesOf(standings(run), standsAlone), ElementsAre("profile=standard", "subpixel=8"))
        << "4 is as fast as 8";
    const Result<AccuracyFigures> back =
        figuresFromJson(nlohmann::json::parse(figuresJson(scene.figures["standard"]).dump()));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_THAT(back->rounds, ElementsAre(3.3, 3.0, 5.0));
    EXPECT_DOUBLE_EQ(back->frame, 3.0);
}

TEST(AccuracyChoice, BudgetsPickByTimeAndByError) {
    const AccuracyRun run = sampleRun();
    const MeasuredScene& scene = run.scenes[0];
    EXPECT_EQ(mostExactWithin(run, scene, 2.2), "fast");
    EXPECT_EQ(mostExactWithin(run, scene, 100), "fine");
    EXPECT_EQ(mostExactWithin(run, scene, 1.5), "") << "draft is below what Vulkan asks for";
    EXPECT_EQ(fastestWithin(run, scene, 0.25), "fast");
    EXPECT_EQ(fastestWithin(run, scene, 0.001), "");
}

TEST(AccuracyChoice, ErrorIsSplitByAxis) {
    const AccuracyRun run =
        runOf({{"standard", 3, 0.1}, {"reference", 9, 0.01}, {"math=reference", 5, 0.03}, {"subpixel=16", 3, 0.1}});
    const auto parts = errorByAxis(run, run.scenes[0]);
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].first, "math");
    EXPECT_NEAR(parts[0].second, 0.07, 1e-12);
    EXPECT_NEAR(parts[1].second, 0, 1e-12);
    EXPECT_EQ(parts[2].first, "all");
    EXPECT_NEAR(parts[2].second, 0.09, 1e-12);
}

TEST(AccuracyPage, ShowsEveryPositionOfEveryScene) {
    AccuracyRun run = sampleRun();
    run.scenes[0].figures["fast"].failure = "no <end> after 120 s";
    run.scenes[0].images.erase("fast");
    const Result<std::string> page = accuracyPage(run);
    ASSERT_TRUE(page.ok()) << page.error().message;
    for (const AccuracyPosition& position : run.positions) EXPECT_THAT(*page, HasSubstr(position.label));
    EXPECT_THAT(*page, HasSubstr("no &lt;end&gt; after 120 s"));
    for (const RemovedPosition& position : removedPositions()) {
        EXPECT_THAT(*page, HasSubstr(position.verdict));
        EXPECT_THAT(runJson(run), HasSubstr(position.axis));
    }
    EXPECT_THAT(runCsv(run), HasSubstr("far_triangles,math=fine,api,2.5,0.3,0.3,0,0,0,0,0,0\n"));
    EXPECT_THAT(runCsv(run), Not(HasSubstr("fast")));
}

}  // namespace
}  // namespace vernier::bench
