#include "conformance/report/report.h"
#include "conformance/report/heat_map.h"
#include "conformance/report/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace vernier::conformance {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

RenderedImage image(uint8_t red) {
    RenderedImage result{VK_FORMAT_R8G8B8A8_UNORM, {4, 2}, {}};
    for (int i = 0; i < 8; ++i) {
        for (const int value : {int{red}, 10 * i, 30, 255}) result.texels.push_back(static_cast<std::byte>(value));
    }
    return result;
}

/// Two drivers, one scene that they draw as given.
struct TestReport {
    Report report;

    TestReport(uint8_t oursRed, uint8_t otherRed) {
        report.facts = {{"Machine", "a <test> machine"}};
        report.drivers = {{"icd", "Vernier ICD", true, "device", "1.0", "limits 1\n", {}},
                          {"lavapipe", "lavapipe", false, "llvmpipe", "2.0", "", {}},
                          {"swiftshader", "SwiftShader", false, "", "", "", "not here"}};
        ReportScene scene;
        scene.scene.name = "test_scene";
        scene.scene.description = "One & only.";
        SceneImage target;
        target.name = "color";
        target.extent = {4, 2};
        scene.scene.images = {target};
        scene.scene.outputs = {0};
        SceneShader shader;
        shader.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
        shader.glsl = "if (a < b) discard;";
        scene.scene.shaders = {shader};
        scene.renderings["icd"].images = {image(oursRed)};
        scene.renderings["icd"].timing = {.startUp = 1, .pipelines = 2, .firstImage = 3, .frame = 4, .frames = 5};
        scene.renderings["lavapipe"].images = {image(otherRed)};
        scene.renderings["lavapipe"].timing = {.startUp = 1, .pipelines = 2, .firstImage = 3, .frame = 8, .frames = 5};
        scene.oracleAbsence = "none in this test";
        scene.judged = true;
        report.scenes.push_back(std::move(scene));
    }

    std::vector<Finding> compare() {
        const Status status = compareScene(report.scenes[0], report.drivers);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        const std::vector<Finding> findings = findingsOf(report.scenes[0], report.drivers);
        report.judgement = judgeFindings(findings, {}, {{"test_scene"}, {"icd", "lavapipe"}});
        report.scenes[0].failed = !report.judgement.violations.empty();
        return findings;
    }
};

TEST(Findings, EqualImagesGiveNone) {
    TestReport test(100, 100);
    EXPECT_THAT(test.compare(), IsEmpty());
    EXPECT_TRUE(test.report.judgement.passed());
}

TEST(Findings, UnexplainedPixelsAndMissingImagesAreFound) {
    TestReport test(100, 105);
    std::vector<Finding> findings = test.compare();
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].kind, "unexplained");
    EXPECT_EQ(findings[0].count, 8u);
    EXPECT_EQ(findings[0].driver, "icd");
    EXPECT_FALSE(test.report.judgement.passed());

    TestReport crashed(100, 100);
    crashed.report.scenes[0].renderings["icd"] = {{}, {}, "signal 11", {}};
    findings = crashed.compare();
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].kind, kNotRendered);

    TestReport otherCrashed(100, 100);
    otherCrashed.report.scenes[0].renderings["lavapipe"] = {{}, {}, "signal 11", {}};
    EXPECT_THAT(otherCrashed.compare(), IsEmpty()) << "another driver's crash is not ours";
}

TEST(Findings, WhatOthersDoWrongMustHaveACause) {
    const auto judged = [](std::optional<Explanation> why) {
        TestReport test(100, 100);
        test.report.scenes[0].verdicts["lavapipe"] = {7, std::move(why)};
        return test.compare();
    };
    const std::vector<Finding> none = judged(std::nullopt);
    ASSERT_THAT(none, SizeIs(1));
    EXPECT_EQ(none[0].driver, "lavapipe");
    EXPECT_EQ(none[0].kind, "unexplained");
    EXPECT_EQ(none[0].count, 7u);
    const Hypotheses some{findHypothesis("snap4")};
    EXPECT_THAT(judged(Explanation{some, 7, 7, 0}), IsEmpty());
    ASSERT_THAT(judged(Explanation{some, 7, 6, 0}), SizeIs(1)) << "a straggler";
    EXPECT_EQ(judged(Explanation{some, 7, 6, 0})[0].count, 1u);
    EXPECT_THAT(judged(Explanation{some, 7, 7, 3}), SizeIs(1)) << "others would be wrong instead";
}

TEST(Findings, LeavingOutMustChangeNoBit) {
    TestReport test(100, 100);
    test.report.scenes[0].everything = ReportRendering{};
    EXPECT_THAT(test.compare(), IsEmpty());
    test.report.scenes[0].everything->failure = "the pictures differ";
    const std::vector<Finding> findings = test.compare();
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].kind, kLeavingOutChangesBits);
}

TEST(Findings, TheOracleJudgesEvenWithoutAnotherDriver) {
    TestReport test(100, 100);
    test.report.scenes[0].renderings.erase("lavapipe");
    OracleImage oracle{VK_FORMAT_R8G8B8A8_UNORM, {4, 2}, {}};
    for (int i = 0; i < 8; ++i) {
        const std::array<double, 4> value{103.0 / 255, 10.0 * i / 255, 30.0 / 255, 1};
        oracle.pixels.push_back({value, value, value, 0});
    }
    test.report.scenes[0].oracle = {oracle};
    const std::vector<Finding> findings = test.compare();
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].against, "oracle");
    EXPECT_EQ(findings[0].kind, "oursWrong");
}

TEST(Report, PagesTellWhatHappened) {
    TestReport test(100, 105);
    test.compare();
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "vernier_report_test";
    std::filesystem::remove_all(folder);
    const Status status = writeReport(test.report, folder);
    ASSERT_TRUE(status.ok()) << status.error().message;
    const auto text = [&](const char* name) {
        std::ifstream file(folder / name);
        std::ostringstream all;
        all << file.rdbuf();
        return all.str();
    };
    const std::string index = text("index.html");
    EXPECT_THAT(index, HasSubstr("a &lt;test&gt; machine"));
    EXPECT_THAT(index, HasSubstr("test_scene.html"));
    EXPECT_THAT(index, HasSubstr("Skipped: not here"));
    EXPECT_THAT(index, HasSubstr("One &amp; only."));
    EXPECT_THAT(index, HasSubstr("pill bad"));
    EXPECT_THAT(index, HasSubstr("\u00d7\u20090.50")) << "4 ms against lavapipe's 8 ms";
    EXPECT_THAT(index, HasSubstr("data:image/png;base64,"));
    EXPECT_THAT(index, Not(HasSubstr("src=\"http"))) << "self-contained";
    const std::string scene = text("test_scene.html");
    EXPECT_THAT(scene, HasSubstr("if (a &lt; b) discard;"));
    EXPECT_THAT(scene, HasSubstr("Worst pixel: <b>(0, 0)</b>"));
    const nlohmann::json json = nlohmann::json::parse(text("report.json"));
    EXPECT_FALSE(json.at("passed").get<bool>());
    EXPECT_EQ(json.at("scenes")[0].at("comparisons")[0].at("counts").at("unexplained"), 8);
    std::filesystem::remove_all(folder);
}

TEST(Picture, PngHoldsThePixels) {
    Picture picture(3, 2);
    for (uint32_t i = 0; i < 6; ++i)
        picture.pixels[i] = {static_cast<uint8_t>(40 * i), 7, static_cast<uint8_t>(255 - i)};
    const Result<std::string> file = encodePng(picture, "a comment");
    ASSERT_TRUE(file.ok());
    png_image reader{};
    reader.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_memory(&reader, file.value().data(), file.value().size()));
    reader.format = PNG_FORMAT_RGB;
    std::vector<Rgb8> pixels(6);
    ASSERT_EQ(PNG_IMAGE_SIZE(reader), 18u);
    ASSERT_TRUE(png_image_finish_read(&reader, nullptr, pixels.data(), 0, nullptr));
    EXPECT_EQ(pixels, picture.pixels);
    EXPECT_FALSE(encodePng(Picture()).ok()) << "nothing is no picture";
}

TEST(Picture, MagnifiedPutsThePixelInTheMiddle) {
    Picture picture(4, 4, {1, 2, 3});
    picture.at(1, 2) = {200, 100, 50};
    const Picture crop = magnified(picture, 1, 2, 5, 8);
    EXPECT_EQ(crop.width, 40u);
    EXPECT_EQ(crop.at(20, 20), (Rgb8{200, 100, 50}));
    EXPECT_EQ(crop.at(0, 0), (Rgb8{128, 128, 128})) << "outside";
    EXPECT_EQ(crop.at(12, 20), (Rgb8{1, 2, 3}));
}

TEST(Picture, HeatIsSignedAndOnAFixedScale) {
    EXPECT_GT(heatColor(4, false).r, heatColor(4, false).b);
    EXPECT_GT(heatColor(-4, false).b, heatColor(-4, false).r);
    EXPECT_GT(heatColor(64, false).r, heatColor(2, false).r);
    EXPECT_LT(heatColor(64, true).r, heatColor(64, false).r);
    EXPECT_EQ(heatColor(128, false), heatColor(2000000000, false));
    ImageDiff diff;
    diff.extent = {5, 5};
    diff.pixels.resize(25);
    diff.pixels[12] = {PixelClass::unexplained, -9};
    EXPECT_EQ(heatMap(diff).at(2, 2), heatColor(-9, false));
    EXPECT_EQ(heatMap(diff).at(1, 2), heatColor(0, false));
    EXPECT_EQ(heatMap(diff, 1).at(1, 1), heatColor(-9, false));
    EXPECT_EQ(heatMap(diff, 1).at(0, 2), heatColor(0, false));
}

TEST(Html, SmallPieces) {
    EXPECT_EQ(escapeHtml("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
    EXPECT_EQ(grouped(0), "0");
    EXPECT_EQ(grouped(1234567), "1\u2009234\u2009567");
    EXPECT_EQ(duration(0.0421), "0.042 ms");
    EXPECT_EQ(duration(12.34), "12.3 ms");
    EXPECT_EQ(duration(1500), "1.50 s");
    EXPECT_EQ(ratio(1, 0), "");
}

}  // namespace
}  // namespace vernier::conformance
