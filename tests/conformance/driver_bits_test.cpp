// Every conformance scene has the same bits through the Vulkan driver as through vernier.h: one backend is behind both.
// With VK_INSTANCE_LAYERS naming the Khronos validation layer, it must have nothing to say, either.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "conformance/drivers/api_driver.h"
#include "conformance/drivers/vulkan_driver.h"
#include "conformance/scenes/scenes.h"
#include "conformance/tool/driver_choice.h"
#include "tests/vulkan/validated.h"

namespace vernier::conformance {
namespace {

/// The first byte in which two images differ, in words; empty: none.
std::string difference(const RenderedImage& one, const RenderedImage& other) {
    if (one.format != other.format) return "formats differ";
    if (one.extent.width != other.extent.width || one.extent.height != other.extent.height) return "extents differ";
    if (one.texels.size() != other.texels.size()) return "sizes differ";
    const auto [left, right] = std::mismatch(one.texels.begin(), one.texels.end(), other.texels.begin());
    if (left == one.texels.end()) return {};
    return "byte " + std::to_string(left - one.texels.begin()) + " is " + std::to_string(std::to_integer<int>(*left)) +
           " and " + std::to_string(std::to_integer<int>(*right));
}

class DriverBits : public testing::TestWithParam<SceneEntry> {};

TEST_P(DriverBits, areThoseOfTheApi) {
    const std::vector<DriverChoice> choices = driverChoices({});
    const auto own = std::find_if(choices.begin(), choices.end(), [](const auto& each) { return each.name == "icd"; });
    ASSERT_TRUE(selectVulkanDriver(*own).ok());
    VulkanOptions options;
    options.validate = test::validated();
    const auto driver = VulkanDriver::create(options);
    if (!driver && driver.error().message.find("LAYER_NOT_PRESENT") != std::string::npos) {
        GTEST_SKIP() << "no validation layer";
    }
    ASSERT_TRUE(driver.ok()) << driver.error().message;
    const auto api = ApiDriver::create({});
    ASSERT_TRUE(api.ok()) << api.error().message;
    const Result<Scene> scene = GetParam().build();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const auto throughApi = (*api)->render(*scene, nullptr);
    const auto throughDriver = (*driver)->render(*scene, nullptr);
    ASSERT_TRUE(throughApi.ok()) << throughApi.error().message;
    ASSERT_TRUE(throughDriver.ok()) << throughDriver.error().message;
    ASSERT_EQ(throughApi->size(), throughDriver->size());
    ASSERT_FALSE(throughApi->empty());
    for (size_t i = 0; i < throughApi->size(); ++i) {
        EXPECT_EQ(difference((*throughApi)[i], (*throughDriver)[i]), "") << "output " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DriverBits, testing::ValuesIn(allScenes().begin(), allScenes().end()),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace vernier::conformance
