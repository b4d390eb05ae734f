#include "bench/scenes/bench_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "bench/scenes/growth_scenes.h"
#include "conformance/drivers/driver.h"

namespace vernier::bench {
namespace {

using ::testing::HasSubstr;

void expectSound(const std::string& name) {
    const Result<conformance::Scene> scene = buildBenchScene(name);
    ASSERT_TRUE(scene.ok()) << name << ": " << scene.error().message;
    EXPECT_EQ(scene->name, name);
    const Status status = conformance::validateScene(*scene);
    EXPECT_TRUE(status.ok()) << name << ": " << (status.ok() ? "" : status.error().message);
    EXPECT_FALSE(scene->outputs.empty()) << name;
}

TEST(BenchScenes, AreSoundAndNamedOnce) {
    std::set<std::string_view> names;
    for (const auto list : {speedScenes(), transferScenes()})
        for (const conformance::SceneEntry& entry : list) {
            EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
            expectSound(std::string(entry.name));
        }
}

TEST(GrowthScenes, ExistForTheSmallestAmounts) {
    for (const GrowthAxis& axis : growthAxes())
        expectSound(std::string(axis.name) + ":" + std::to_string(axis.amounts.front()));
}

TEST(GrowthScenes, DoWhatTheirAmountSays) {
    const auto draws = [](const char* name) {
        const Result<conformance::Scene> scene = buildBenchScene(name);
        return std::get<conformance::ScenePass>(scene->steps[0]).draws;
    };
    EXPECT_EQ(draws("triangles:2048")[0].count, 2048u * 3);
    EXPECT_EQ(draws("overdraw:8").size(), 8u);
    const Result<conformance::Scene> pixels = buildBenchScene("pixels:65536");
    EXPECT_EQ(pixels->images[0].extent.width * pixels->images[0].extent.height, 65536u);
}

TEST(GrowthScenes, RefuseNamesThatAreNone) {
    for (const char* name : {"", "triangles", "triangles:", "triangles:x", "triangles:-4", "triangles:99999999999",
                             "triangles:4000000000", "pixels:0", "shoes:4", ":4", "overdraw:8x"}) {
        const Result<conformance::Scene> scene = buildBenchScene(name);
        ASSERT_FALSE(scene.ok()) << name;
        EXPECT_THAT(scene.error().message, HasSubstr(std::string("'") + name + "'"));
    }
}

}  // namespace
}  // namespace vernier::bench
