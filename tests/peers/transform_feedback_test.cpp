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

/// Captures on both drivers, and what was seen of them.
class TwoLabs {
  public:
    void expectSame(const FeedbackLab::Feedback& feedback, uint32_t seed) {
        const FeedbackLab::Captured ours = vernier_.capture(feedback), theirs = lavapipe_.capture(feedback);
        const std::string what = "seed " + std::to_string(seed) + ", topology " + std::to_string(feedback.topology) +
                                 (feedback.lastProvokes ? ", last" : ", first") + ", stream " +
                                 std::to_string(feedback.stream) + (feedback.indices.empty() ? "" : ", indexed") +
                                 (feedback.restart ? ", restart" : "") + "\n" + feedback.geometry;
        EXPECT_EQ(ours.primitives, theirs.primitives) << what;
        EXPECT_EQ(ours.generated, theirs.generated) << what;
        EXPECT_EQ(ours.counters, theirs.counters) << what;
        EXPECT_TRUE(ours.bytes == theirs.bytes) << what;
        written_ += ours.primitives[0];
        dropped_ += ours.primitives[1] - ours.primitives[0];
    }
    void expectMuch() const {
        EXPECT_GT(written_, 1000u);
        EXPECT_GT(dropped_, 1000u);
    }

  private:
    FeedbackLab vernier_{VERNIER_ICD_JSON}, lavapipe_{VERNIER_LAVAPIPE_JSON};
    uint64_t written_ = 0, dropped_ = 0;
};

constexpr VkPrimitiveTopology kTopologies[] = {
    VK_PRIMITIVE_TOPOLOGY_POINT_LIST,    VK_PRIMITIVE_TOPOLOGY_LINE_LIST,      VK_PRIMITIVE_TOPOLOGY_LINE_STRIP,
    VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN,
};

bool isList(VkPrimitiveTopology topology) {
    return topology == VK_PRIMITIVE_TOPOLOGY_POINT_LIST || topology == VK_PRIMITIVE_TOPOLOGY_LINE_LIST ||
           topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST ||
           topology == VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY ||
           topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY;
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
    TwoLabs labs;
    if (testing::Test::HasFatalFailure()) return;
    for (uint32_t seed = 0; seed < 300; ++seed) labs.expectSame(randomFeedback(seed), seed);
    labs.expectMuch();
}

/// What geometry shaders get and put out. Of adjacent vertices the topologies are in the order of the stage's inputs.
struct GeometryKind {
    VkPrimitiveTopology topology;
    const char* input;
    uint32_t vertices;
};
constexpr GeometryKind kGeometryKinds[] = {
    {VK_PRIMITIVE_TOPOLOGY_POINT_LIST, "points", 1},
    {VK_PRIMITIVE_TOPOLOGY_LINE_LIST, "lines", 2},
    {VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, "lines", 2},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, "triangles", 3},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, "triangles", 3},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, "triangles", 3},
    {VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, "lines_adjacency", 4},
    {VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, "lines_adjacency", 4},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, "triangles_adjacency", 6},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY, "triangles_adjacency", 6},
};

constexpr const char* kVertexBefore = R"(#version 450
layout(location = 0) flat out ivec2 numbers;
void main() {
    gl_Position = vec4(float(gl_VertexIndex % 13) - 6.0, float(gl_VertexIndex % 7) - 3.0, 0.5, 4.0);
    gl_PointSize = 1.0;
    numbers = ivec2(gl_VertexIndex, gl_InstanceIndex);
})";

/// A stage that puts out as many vertices, in as many strips, as numbers of its primitive say; with `streams` points
/// into several streams. Nothing in it is rounded.
std::string randomGeometry(std::mt19937& random, const GeometryKind& kind, bool streams) {
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    const auto number = [&](uint32_t end) { return std::to_string(1 + below(end)); };
    constexpr const char* kOutputs[] = {"points", "line_strip", "triangle_strip"};
    // Lavapipe falls over stages that end more strips than there is room for whole primitives.
    const uint32_t output = streams ? 0 : below(3), count = 1 + below(9);
    const std::string most = std::to_string(count), room = std::to_string(count * (output + 1));
    const std::string vertices = std::to_string(kind.vertices);
    const std::string stream = streams ? ", stream = 2" : "";
    return "#version 450\nlayout(" + std::string(kind.input) + ", invocations = " + number(3) + ") in;\nlayout(" +
           kOutputs[output] + ", max_vertices = " + (streams ? "18" : room) + R"() out;
layout(location = 0) flat in ivec2 numbers[];
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 28) flat out ivec3 what;
layout(xfb_buffer = 0) out gl_PerVertex { layout(xfb_offset = 12) vec4 gl_Position; float gl_PointSize; };
layout(location = 1, xfb_buffer = 1, xfb_offset = 4, xfb_stride = 12)" +
           stream + R"() out vec2 halves;
layout(location = 2) out vec4 color;
void main() {
    int key = gl_PrimitiveIDIn * )" +
           number(7) + " + gl_InvocationID * " + number(5) + " + numbers[" + std::to_string(below(kind.vertices)) +
           "].x * " + number(9) + R"(;
    int count = key % ()" +
           most + R"( + 1);
    for (int v = 0; v < count; ++v) {
        what = ivec3(numbers[(v + key) % )" +
           vertices + R"(].x, gl_PrimitiveIDIn, v);
        gl_Position = gl_in[(v + 1) % )" +
           vertices + R"(].gl_Position;
        gl_PointSize = 1.0;
        color = vec4(1.0);
)" + (streams ? "        EmitStreamVertex(0);\n" : "") +
           R"(        halves = vec2(float(numbers[v % )" + vertices + R"(].y), float(gl_InvocationID)) * 0.5;
)" +
           (streams ? "        if (v % 2 == 0) EmitStreamVertex(2);\n"
                    : "        EmitVertex();\n        if ((key + v) % " + number(6) + " == 0) EndPrimitive();\n") +
           "    }\n}\n";
}

TEST(TransformFeedbackPeers, randomGeometryShaders) {
    if (!std::filesystem::exists(VERNIER_LAVAPIPE_JSON)) GTEST_SKIP() << "no lavapipe here";
    TwoLabs labs;
    if (testing::Test::HasFatalFailure()) return;
    for (uint32_t seed = 0; seed < 120; ++seed) {
        std::mt19937 random(seed + 7000);
        const GeometryKind& kind = kGeometryKinds[random() % std::size(kGeometryKinds)];
        FeedbackLab::Feedback feedback = randomFeedback(seed);
        const bool streams = random() % 4 == 0;
        feedback.topology = kind.topology;
        feedback.restart = feedback.restart && !isList(kind.topology);
        // Where the last vertex provokes, lavapipe gives the stage every other triangle of a strip, and those of fans,
        // turned around, which is not as Vulkan defines these topologies.
        const bool turned = kind.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP ||
                            kind.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN ||
                            kind.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY;
        if (turned) feedback.lastProvokes = false;
        feedback.vertex = kVertexBefore;
        feedback.geometry = randomGeometry(random, kind, streams);
        feedback.stream = streams && random() % 2 == 0 ? 2 : 0;
        labs.expectSame(feedback, seed);
    }
    labs.expectMuch();
}

}  // namespace
}  // namespace vernier::test
