// Transform feedback of random draws on Vernier and on lavapipe: the same bytes, counters and counts.
#include "tests/vulkan/test_feedback.h"

#include <algorithm>
#include <filesystem>
#include <random>

namespace vernier::test {
namespace {

/// The fixture as an object, on one driver.
class FeedbackLab : public FeedbackTest {
  public:
    explicit FeedbackLab(const char* manifest) : manifest_(manifest) { SetUp(); }
    ~FeedbackLab() override { TearDown(); }
    using FeedbackTest::capture;
    using FeedbackTest::Captured;
    using FeedbackTest::Feedback;
    using FeedbackTest::FeedbackDraw;

  private:
    const char* driver() override { return manifest_; }
    void TestBody() override {}
    const char* manifest_;
};

constexpr VkPrimitiveTopology kTopologies[] = {
    VK_PRIMITIVE_TOPOLOGY_POINT_LIST,    VK_PRIMITIVE_TOPOLOGY_LINE_LIST,      VK_PRIMITIVE_TOPOLOGY_LINE_STRIP,
    VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN,
};

bool isList(VkPrimitiveTopology topology) {
    return topology == VK_PRIMITIVE_TOPOLOGY_POINT_LIST || topology == VK_PRIMITIVE_TOPOLOGY_LINE_LIST ||
           topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
}

/// Nothing in it is rounded.
constexpr const char* kVertex = R"(#version 450
layout(xfb_buffer = 0, xfb_offset = 8, xfb_stride = 28) out gl_PerVertex { vec4 gl_Position; float gl_PointSize; };
layout(location = 0, xfb_buffer = 0, xfb_offset = 0) flat out ivec2 numbers;
layout(location = 1, xfb_buffer = 1, xfb_offset = 4, xfb_stride = 20) out vec3 kept;
layout(location = 2) out vec4 color;
void main() {
    gl_Position = vec4(float(gl_VertexIndex % 13) - 6.0, float(gl_VertexIndex % 7) - 3.0, 0.5, 4.0);
    gl_PointSize = 1.0;
    numbers = ivec2(gl_VertexIndex, gl_InstanceIndex);
    kept = vec3(float(gl_VertexIndex) * 0.5, -float(gl_InstanceIndex), 3.0);
    color = vec4(1.0);
})";
constexpr const char* kFragment = R"(#version 450
layout(location = 2) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = color; })";

FeedbackLab::Feedback randomFeedback(uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    FeedbackLab::Feedback feedback;
    feedback.topology = kTopologies[below(std::size(kTopologies))];
    feedback.lastProvokes = below(2) == 0;
    feedback.discard = below(2) == 0;
    feedback.vertex = kVertex;
    feedback.fragment = kFragment;
    feedback.offset = 4 * below(5);
    const uint32_t room = below(3) == 0 ? 5000 : 100;  // vertices
    feedback.sizes = {4 * VkDeviceSize{1 + below(room * 7)}, 4 * VkDeviceSize{1 + below(room * 5)}};
    const bool indexed = below(2) == 0;
    feedback.restart = indexed && !isList(feedback.topology) && below(2) == 0;
    for (uint32_t n = 0; indexed && n < 200; ++n) {
        const bool cut = feedback.restart && below(6) == 0;
        feedback.indices.push_back(static_cast<uint16_t>(cut ? 0xFFFF : below(1000)));
    }
    for (uint32_t n = 1 + below(5); n != 0; --n) {
        FeedbackLab::FeedbackDraw draw;
        draw.count = below(60);
        draw.instances = 1 + below(3);
        draw.first = below(140);
        draw.firstInstance = below(4);
        draw.vertexOffset = indexed ? static_cast<int32_t>(below(100)) : 0;
        draw.resumes = below(3) == 0;
        feedback.draws.push_back(draw);
    }
    return feedback;
}

TEST(TransformFeedbackPeers, randomDraws) {
    if (!std::filesystem::exists(VERNIER_LAVAPIPE_JSON)) GTEST_SKIP() << "no lavapipe here";
    FeedbackLab vernier(VERNIER_ICD_JSON), lavapipe(VERNIER_LAVAPIPE_JSON);
    if (testing::Test::HasFatalFailure()) return;
    uint64_t written = 0, dropped = 0;
    for (uint32_t seed = 0; seed < 300; ++seed) {
        const FeedbackLab::Feedback feedback = randomFeedback(seed);
        const FeedbackLab::Captured ours = vernier.capture(feedback), theirs = lavapipe.capture(feedback);
        const std::string what = "seed " + std::to_string(seed) + ", topology " + std::to_string(feedback.topology) +
                                 (feedback.lastProvokes ? ", last" : ", first") +
                                 (feedback.indices.empty() ? "" : ", indexed") + (feedback.restart ? ", restart" : "");
        EXPECT_EQ(ours.primitives, theirs.primitives) << what;
        EXPECT_EQ(ours.generated, theirs.generated) << what;
        EXPECT_EQ(ours.counters, theirs.counters) << what;
        EXPECT_TRUE(ours.bytes == theirs.bytes) << what;
        written += ours.primitives[0];
        dropped += ours.primitives[1] - ours.primitives[0];
    }
    // What the comparison saw.
    EXPECT_GT(written, 1000u);
    EXPECT_GT(dropped, 1000u);
}

}  // namespace
}  // namespace vernier::test
