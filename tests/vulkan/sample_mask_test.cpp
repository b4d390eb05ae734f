// The sample mask that fragments read: what was covered before the depth test, wherever the test stands, or what the
// test has left (VK_EXT_post_depth_coverage).
#include <array>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{32, 16};
constexpr VkSampleMask kHidden = 0x5;  // samples of the left half: a nearer triangle covers them

class SampleMaskTest : public DrawTest {
  protected:
    void SetUp() override {
        DrawTest::SetUp();
        color_ =
            makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
        depth_ = makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                           VK_SAMPLE_COUNT_4_BIT);
        resolved_ = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        pass_ = makePass(color_, &depth_, &resolved_);
    }

    PipelineDesc draw(const std::string& z) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.samples = VK_SAMPLE_COUNT_4_BIT;
        desc.depthTest = true;
        desc.vertex = fullScreen(z);
        return desc;
    }

    /// Red where a fragment reads all samples, green where it reads those that are not hidden: of the left half, two
    /// samples of which are hidden, and of the right one. `modes` are declarations of the fragment shader, `more`
    /// statements.
    std::array<uint32_t, 2> colors(const std::string& modes, const std::string& more) {
        PipelineDesc before = draw("0.25"), after = draw("0.5");
        before.fragment = constantColor("0, 0, 0, 1");
        before.change = [](const PipelineStates& states) {
            static const VkRect2D left{{0, 0}, {kExtent.width / 2, kExtent.height}};
            states.multisample.pSampleMask = &kHidden;
            states.viewport.pScissors = &left;
        };
        after.fragment =
            makeShader(VK_SHADER_STAGE_FRAGMENT_BIT,
                       "#version 450\n" + modes + "layout(location = 0) out vec4 o;\nvoid main() {\n" + more +
                           "    o = vec4(gl_SampleMaskIn[0] == 15, gl_SampleMaskIn[0] == 10, 0, 1);\n}");
        const VkPipeline first = makePipeline(pass_.pass, before), second = makePipeline(pass_.pass, after);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass_);
        for (const VkPipeline pipeline : {first, second}) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            vkCmdDraw(commands, 3, 1, 0, 0);
        }
        vkCmdEndRenderPass(commands);
        submit(commands);
        const auto texels = readImage(resolved_, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        const auto half = [&](uint32_t from) {
            const uint32_t one = pixelAt(texels, resolved_, from, 0);
            for (uint32_t x = from; x < from + kExtent.width / 2; ++x) {
                for (uint32_t y = 0; y < kExtent.height; ++y) EXPECT_EQ(pixelAt(texels, resolved_, x, y), one);
            }
            return one;
        };
        return {half(0), half(kExtent.width / 2)};
    }

    TestImage color_, depth_, resolved_;
    Pass pass_;
};

// Nothing, derivatives, and what lets a fragment be dropped: each has another way to the tests.
constexpr const char* kStatements[] = {"", "    float slope = dFdx(gl_FragCoord.x); if (slope != 1) return;\n",
                                       "    if (gl_FragCoord.x < 0) discard;\n"};
// Two of four samples that are 255 resolve to 128; alpha is 255 everywhere.
constexpr uint32_t kRed = 0xFF0000FFu, kHalfRed = 0xFF000080u, kHalfGreen = 0xFF008000u;

TEST_F(SampleMaskTest, isThatBeforeTests) {
    // Tested early because nobody can tell, because the program asks for it, and late.
    for (const char* const modes : {"", "layout(early_fragment_tests) in;\n"}) {
        for (const char* const more : kStatements) {
            SCOPED_TRACE(std::string(modes) + more);
            const auto [left, right] = colors(modes, more);
            EXPECT_EQ(left, kHalfRed);
            EXPECT_EQ(right, kRed);
        }
    }
}

class PostDepthCoverageTest : public SampleMaskTest {
  protected:
    std::vector<const char*> moreExtensions() override { return {VK_EXT_POST_DEPTH_COVERAGE_EXTENSION_NAME}; }
};

TEST_F(PostDepthCoverageTest, masksAreThoseAfterTests) {
    for (const char* const more : kStatements) {
        SCOPED_TRACE(more);
        const auto [left, right] = colors(
            "#extension GL_EXT_post_depth_coverage : require\nlayout(early_fragment_tests, post_depth_coverage) in;\n",
            more);
        EXPECT_EQ(left, kHalfGreen);
        EXPECT_EQ(right, kRed);
    }
}

}  // namespace
}  // namespace vernier::test
