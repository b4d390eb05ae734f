// One scene gives one image: the same bytes with any number of threads and on every instruction set.
#include <gtest/gtest.h>

#include "conformance/drivers/api_driver.h"
#include "conformance/scenes/scenes.h"

namespace vernier::conformance {
namespace {

class SameBits : public testing::TestWithParam<const char*> {};

std::vector<RenderedImage> renderWith(const Scene& scene, uint32_t threads, const char* isa) {
    ApiOptions options;
    options.threads = threads;
    options.maxIsa = isa;
    auto driver = ApiDriver::create(options);
    EXPECT_TRUE(driver.ok()) << (driver.ok() ? "" : driver.error().message);
    auto images = driver.value()->render(scene, nullptr);
    EXPECT_TRUE(images.ok()) << (images.ok() ? "" : images.error().message);
    return images.ok() ? std::move(images).value() : std::vector<RenderedImage>{};
}

/// On a CPU without an instruction set the device takes the next lower one, and the comparison still holds.
TEST_P(SameBits, WithAnyThreadsAndInstructionSet) {
    const Result<Scene> scene = findScene(GetParam())->build();
    ASSERT_TRUE(scene.ok());
    const std::vector<RenderedImage> expected = renderWith(*scene, 1, "sse4");
    ASSERT_FALSE(expected.empty());
    for (const uint32_t threads : {1u, 2u, 5u})
        for (const char* isa : {"sse4", "avx2", "avx512"}) {
            const std::vector<RenderedImage> images = renderWith(*scene, threads, isa);
            ASSERT_EQ(images.size(), expected.size());
            for (size_t i = 0; i < images.size(); ++i)
                EXPECT_TRUE(images[i].texels == expected[i].texels)
                    << "output " << i << " with " << threads << " threads on " << isa;
        }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SameBits,
                         testing::Values("gouraud", "near_plane", "blend_modes", "msaa_resolve", "texture_trilinear",
                                         "lit_model", "julia", "shadow_map"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace vernier::conformance
