// The driver on lavapipe, where the machine has it: known pixels of known scenes, with the validation layer
// watching.
#include "conformance/drivers/vulkan_driver.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <filesystem>

namespace vernier::conformance {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kManifest = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";

std::array<int, 4> pixel(const RenderedImage& image, uint32_t x, uint32_t y) {
    std::array<int, 4> result{};
    for (size_t i = 0; i < 4; ++i) {
        result[i] = std::to_integer<int>(image.texels[(size_t{y} * image.extent.width + x) * 4 + i]);
    }
    return result;
}

class VulkanDriverTest : public ::testing::Test {
  protected:
    // What the driver and the layer keep in their globals looks leaked once they are unloaded: they stay.
    static void SetUpTestSuite() {
        for (const char* library : {"libvulkan_lvp.so", "libVkLayer_khronos_validation.so"}) {
            ::dlopen(library, RTLD_NOW | RTLD_NODELETE);
        }
    }

    void SetUp() override {
        if (!std::filesystem::exists(kManifest)) GTEST_SKIP() << kManifest << " is not here";
        ::setenv("VK_DRIVER_FILES", kManifest, 1);
        ::setenv("VK_ICD_FILENAMES", kManifest, 1);
        VulkanOptions options;
        options.validate = true;
        Result<std::unique_ptr<VulkanDriver>> driver = VulkanDriver::create(options);
        if (!driver && driver.error().message.find("LAYER_NOT_PRESENT") != std::string::npos) {
            GTEST_SKIP() << "no validation layer";
        }
        ASSERT_TRUE(driver.ok()) << driver.error().message;
        driver_ = std::move(driver).value();
    }

    std::vector<RenderedImage> render(const Scene& scene, Timing* timing = nullptr) {
        Result<std::vector<RenderedImage>> images = driver_->render(scene, timing);
        EXPECT_TRUE(images.ok()) << (images.ok() ? "" : images.error().message);
        return images.ok() ? std::move(images).value() : std::vector<RenderedImage>{};
    }

    std::unique_ptr<VulkanDriver> driver_;
};

TEST_F(VulkanDriverTest, SaysWhoItIs) {
    EXPECT_THAT(driver_->name(), HasSubstr("llvmpipe"));
    EXPECT_THAT(driver_->version(), HasSubstr("Vulkan 1."));
    EXPECT_THAT(driver_->limits(), HasSubstr("subPixelPrecisionBits 8\n"));
}

TEST_F(VulkanDriverTest, DrawsKnownPixels) {
    const Result<Scene> scene = scenes::solid();
    ASSERT_TRUE(scene.ok());
    Timing timing;
    const std::vector<RenderedImage> images = render(scene.value(), &timing);
    ASSERT_EQ(images.size(), 1u);
    EXPECT_THAT(pixel(images[0], 128, 120), ElementsAre(244, 139, 50, 255));
    EXPECT_THAT(pixel(images[0], 2, 250), ElementsAre(23, 28, 51, 255));
    EXPECT_GT(timing.frame, 0);
    EXPECT_GE(timing.frames, 5u);
    EXPECT_GT(timing.pipelines, 0);
    EXPECT_GT(timing.firstImage, timing.startUp);
}

TEST_F(VulkanDriverTest, SharedEdgesCountOneEverywhere) {
    const Result<Scene> scene = scenes::shared_edges();
    ASSERT_TRUE(scene.ok());
    const std::vector<RenderedImage> images = render(scene.value());
    ASSERT_EQ(images.size(), 2u);
    uint32_t wrong = 0;
    for (uint32_t y = 0; y < 256; ++y) {
        for (uint32_t x = 0; x < 256; ++x) wrong += pixel(images[1], x, y)[0] != 1;
    }
    EXPECT_EQ(wrong, 0u);
}

TEST_F(VulkanDriverTest, SrgbCodesSurviveTheRoundTrip) {
    const Result<Scene> scene = scenes::srgb();
    ASSERT_TRUE(scene.ok());
    const std::vector<RenderedImage> images = render(scene.value());
    ASSERT_EQ(images.size(), 1u);
    for (uint32_t x = 0; x < 256; ++x) {
        EXPECT_EQ(pixel(images[0], x, 4)[0], static_cast<int>(x));
        EXPECT_EQ(pixel(images[0], x, 4)[1], static_cast<int>(255 - x));
    }
}

TEST_F(VulkanDriverTest, SeveralScenesRunOneAfterAnother) {
    for (const char* name : {"msaa_resolve", "multiple_targets", "texture_trilinear", "stencil_winding",
                             "copy_and_blit", "shadow_map", "scissor_viewport"}) {
        const Result<Scene> scene = findScene(name)->build();
        ASSERT_TRUE(scene.ok()) << name;
        const std::vector<RenderedImage> images = render(scene.value());
        EXPECT_EQ(images.size(), scene.value().outputs.size()) << name;
    }
}

TEST_F(VulkanDriverTest, ABrokenRuleFailsTheRun) {
    Result<Scene> built = scenes::solid();
    ASSERT_TRUE(built.ok());
    Scene& scene = built.value();
    std::get<ScenePass>(scene.steps[0]).draws[0].scissor.offset.x = -1;
    const Result<std::vector<RenderedImage>> images = driver_->render(scene, nullptr);
    ASSERT_FALSE(images.ok());
    EXPECT_THAT(images.error().message, HasSubstr("VUID-vkCmdSetScissor-x-00595"));
}

TEST_F(VulkanDriverTest, AnInvalidSceneIsRefused) {
    Result<Scene> built = scenes::solid();
    ASSERT_TRUE(built.ok());
    built.value().outputs = {77};
    const Result<std::vector<RenderedImage>> images = driver_->render(built.value(), nullptr);
    ASSERT_FALSE(images.ok());
    EXPECT_THAT(images.error().message, HasSubstr("outputs is 77"));
}

TEST_F(VulkanDriverTest, MissingDevicesAreNamed) {
    VulkanOptions options;
    options.deviceIndex = 99;
    const Result<std::unique_ptr<VulkanDriver>> driver = VulkanDriver::create(options);
    ASSERT_FALSE(driver.ok());
    EXPECT_THAT(driver.error().message, HasSubstr("physical device 99"));
}

}  // namespace
}  // namespace vernier::conformance
