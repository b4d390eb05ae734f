// What the specification leaves to tessellators shows in no scene: with other choices the oracle makes pictures that it
// permits.
#include "conformance/oracle/oracle.h"
#include "conformance/scenes/scenes.h"
#include "tests/oracle/rendered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

namespace vernier::conformance {
namespace {

/// Every scene of tessellation with each choice of an implementation.
class Freedom : public testing::TestWithParam<SceneEntry> {};

TEST_P(Freedom, DoesNotShow) {
    const auto scene = GetParam().build();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const auto declared = renderOracle(*scene);
    ASSERT_TRUE(declared.ok()) << declared.error().message;
    for (const TessellationChoices& choices :
         {TessellationChoices{true, false, false, false}, TessellationChoices{false, true, false, false},
          TessellationChoices{false, false, true, false}, TessellationChoices{false, false, false, true}}) {
        OracleRules rules;
        rules.tessellation = choices;
        const auto other = renderOracle(*scene, rules);
        ASSERT_TRUE(other.ok()) << other.error().message;
        for (size_t i = 0; i < declared->size(); ++i)
            EXPECT_EQ(compareWithOracle((*declared)[i], renderedFrom((*other)[i])).outside, 0u)
                << choices.shortInside << choices.outerFirst << choices.otherDiagonals << choices.turned;
    }
}

std::vector<SceneEntry> tessellationScenes() {
    std::vector<SceneEntry> scenes;
    std::ranges::copy_if(allScenes(), std::back_inserter(scenes),
                         [](const SceneEntry& entry) { return entry.name.starts_with("tessellation"); });
    return scenes;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Freedom, testing::ValuesIn(tessellationScenes()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace vernier::conformance
