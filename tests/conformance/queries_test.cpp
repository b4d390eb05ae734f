// What queries count, against numbers that follow from the specification (chapter "Queries"): on Vernier exactly, on
// lavapipe for the record.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "conformance/drivers/vulkan_driver.h"
#include "conformance/scenes/recorder.h"
#include "conformance/tool/driver_choice.h"

namespace vernier::conformance {
namespace {

using Point = std::array<float, 3>;

constexpr VkExtent2D kExtent{64, 64};

/// Places in pixels of the target, and a depth.
Point at(float x, float y, float z = 0.5f) {
    return {x / 32 - 1, y / 32 - 1, z};
}

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec3 position;
void main() { gl_Position = vec4(position, 1.0); gl_PointSize = 1.0; })";
constexpr const char* kRed = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0, 0.0, 0.0, 1.0); })";

/// A scene of draws into one colour and one depth attachment, cleared to 1.
class Counted {
  public:
    explicit Counted(VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT) : record_("counted", "For queries.") {
        output_ = record_.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
        const uint32_t color = samples == VK_SAMPLE_COUNT_1_BIT
                                   ? output_
                                   : record_.colorTarget("samples", VK_FORMAT_R8G8B8A8_UNORM, kExtent, samples);
        const uint32_t depth = record_.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kExtent, samples);
        record_.pass(kExtent)
            .color(color, {0, 0, 0, 1}, samples == VK_SAMPLE_COUNT_1_BIT ? kNone : output_)
            .depthStencil(depth);
        samples_ = samples;
    }

    PipelineRecorder pipeline(VkPrimitiveTopology topology, const char* fragment = kRed, const char* vertex = kVertex) {
        PipelineRecorder made = record_.pipeline(record_.vertex(vertex), record_.fragment(fragment));
        made.binding(sizeof(Point)).attribute(VK_FORMAT_R32G32B32_SFLOAT, 0).topology(topology).samples(samples_);
        return made;
    }
    DrawRecorder draw(uint32_t pipeline, const std::vector<Point>& points, const std::vector<uint16_t>& indices = {}) {
        const auto count = indices.empty() ? points.size() : indices.size();
        DrawRecorder draw = record_.draw(pipeline, static_cast<uint32_t>(count));
        draw.vertices(record_.vertexBuffer("points", points));
        if (!indices.empty()) draw.indices(record_.indexBuffer("indices", indices), VK_INDEX_TYPE_UINT16);
        return draw;
    }
    /// Two triangles over x0..x1, y0..y1 at one depth.
    DrawRecorder rectangle(uint32_t pipeline, float x0, float y0, float x1, float y1, float z = 0.5f) {
        return draw(pipeline, {at(x0, y0, z), at(x1, y0, z), at(x0, y1, z), at(x1, y1, z)}, {0, 1, 2, 2, 1, 3});
    }
    SceneRecorder& record() { return record_; }
    Result<Scene> finish() {
        record_.output(output_);
        return record_.finish();
    }

  private:
    SceneRecorder record_;
    uint32_t output_ = 0;
    VkSampleCountFlagBits samples_ = VK_SAMPLE_COUNT_1_BIT;
};

constexpr VkPrimitiveTopology kList = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;

/// What is expected: a number, or nothing where the specification leaves it open.
using Expected = std::optional<uint64_t>;
struct Numbers {
    Expected samples, inputVertices, inputPrimitives, vertexInvocations, clippingInvocations, clippingPrimitives,
        fragmentInvocations;
};

struct QueryCase {
    const char* name;
    Result<Scene> (*build)();
    Numbers numbers;
};

Result<Scene> rectangleOfTwo() {
    Counted scene;
    scene.rectangle(scene.pipeline(kList), 3, 5, 13, 25);
    return scene.finish();
}

Result<Scene> hiddenByLater() {
    // The first is hidden by the second altogether; both have passed their tests when they were drawn.
    Counted scene;
    const uint32_t pipeline = scene.pipeline(kList);
    scene.rectangle(pipeline, 0, 0, 64, 64);
    scene.rectangle(pipeline, 0, 0, 64, 64);
    return scene.finish();
}

Result<Scene> behind() {
    Counted scene;
    const uint32_t pipeline = scene.pipeline(kList).depth(VK_COMPARE_OP_LESS);
    scene.rectangle(pipeline, 0, 0, 64, 32, 0.25f);
    scene.rectangle(pipeline, 0, 0, 64, 64, 0.75f);
    return scene.finish();
}

Result<Scene> culled() {
    // Culling comes after clipping: culled triangles have passed the clipping stage.
    Counted scene;
    const uint32_t pipeline = scene.pipeline(kList).cull(VK_CULL_MODE_FRONT_AND_BACK, VK_FRONT_FACE_CLOCKWISE);
    scene.rectangle(pipeline, 0, 0, 64, 64);
    return scene.finish();
}

Result<Scene> outside() {
    Counted scene;
    scene.rectangle(scene.pipeline(kList), 70, 0, 90, 64);
    return scene.finish();
}

Result<Scene> degenerate() {
    // Without area: rasterised to nothing, but inside the clip volume.
    Counted scene;
    scene.draw(scene.pipeline(kList), {at(3, 3), at(30, 30), at(3, 3)});
    return scene.finish();
}

Result<Scene> missesAllCentres() {
    Counted scene;
    scene.draw(scene.pipeline(kList), {at(3.6f, 3.6f), at(3.9f, 3.6f), at(3.6f, 3.9f)});
    return scene.finish();
}

Result<Scene> scissored() {
    Counted scene;
    scene.rectangle(scene.pipeline(kList), 0, 0, 64, 64).scissor(10, 10, 3, 7);
    return scene.finish();
}

Result<Scene> strips() {
    // Two strips of three and two triangles: seven and four vertices' worth, and an index that restarts. Two squares of
    // 64 pixels, and half a square without the 8 pixels on its diagonal, which is a right edge: 28.
    Counted scene;
    const uint32_t pipeline =
        scene.pipeline(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP).topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, true);
    scene.draw(pipeline,
               {at(0, 0), at(0, 8), at(8, 0), at(8, 8), at(16, 0), at(32, 0), at(32, 8), at(40, 0), at(40, 8)},
               {0, 1, 2, 3, 4, 0xFFFF, 5, 6, 7, 8});
    return scene.finish();
}

Result<Scene> pointsAndLines() {
    Counted scene;
    scene.draw(scene.pipeline(VK_PRIMITIVE_TOPOLOGY_POINT_LIST),
               {at(1.5f, 1.5f), at(3.5f, 1.5f), at(5.5f, 1.5f), at(80, 1)});
    scene.draw(scene.pipeline(VK_PRIMITIVE_TOPOLOGY_LINE_LIST), {at(2.5f, 10.5f), at(12.5f, 10.5f)});
    return scene.finish();
}

Result<Scene> instanced() {
    Counted scene;
    scene.rectangle(scene.pipeline(kList), 0, 0, 4, 4).instances(5);
    return scene.finish();
}

Result<Scene> discarded() {
    // Half the pixels are dropped by the program, after it has run.
    Counted scene;
    const uint32_t pipeline = scene.pipeline(kList, R"(#version 450
layout(location = 0) out vec4 color;
void main() { if (gl_FragCoord.x < 32.0) discard; color = vec4(1.0); })");
    scene.rectangle(pipeline, 0, 0, 64, 64);
    return scene.finish();
}

Result<Scene> discardedAfterTests() {
    // Early tests: samples are counted before the program drops them.
    Counted scene;
    const uint32_t pipeline = scene
                                  .pipeline(kList, R"(#version 450
layout(early_fragment_tests) in;
layout(location = 0) out vec4 color;
void main() { if (gl_FragCoord.x < 32.0) discard; color = vec4(1.0); })")
                                  .depth(VK_COMPARE_OP_LESS);
    scene.rectangle(pipeline, 0, 0, 64, 64);
    return scene.finish();
}

Result<Scene> fourSamples() {
    Counted scene(VK_SAMPLE_COUNT_4_BIT);
    scene.rectangle(scene.pipeline(kList), 0, 0, 16, 16);
    return scene.finish();
}

Result<Scene> maskedSamples() {
    Counted scene(VK_SAMPLE_COUNT_4_BIT);
    scene.rectangle(scene.pipeline(kList).sampleMask(0x5), 0, 0, 16, 16);
    return scene.finish();
}

Result<Scene> nothingWritten() {
    // No attachment changes; samples are counted all the same.
    Counted scene;
    scene.rectangle(scene.pipeline(kList).writeMask(0), 0, 0, 16, 16);
    return scene.finish();
}

Result<Scene> clipped() {
    // A rectangle reaching out of the volume on all sides but lying inside the guard band is one primitive each.
    Counted scene;
    scene.rectangle(scene.pipeline(kList), -10, -10, 74, 74);
    return scene.finish();
}

const QueryCase kCases[] = {
    {"rectangle", rectangleOfTwo, {200, 6, 2, 4, 2, 2, 200}},
    {"hidden by a later one", hiddenByLater, {2 * 4096, 12, 4, 8, 4, 4, 2 * 4096}},
    {"behind", behind, {2048 + 2048, 12, 4, 8, 4, 4, 2048 + 2048}},
    {"culled", culled, {0, 6, 2, 4, 2, 2, 0}},
    {"outside", outside, {0, 6, 2, 4, 2, 0, 0}},
    {"degenerate", degenerate, {0, 3, 1, 3, 1, 1, 0}},
    {"misses all centres", missesAllCentres, {0, 3, 1, 3, 1, 1, 0}},
    {"scissored", scissored, {21, 6, 2, 4, 2, {}, 21}},
    {"strips with a restart", strips, {156, 9, 5, 9, 5, 5, 156}},
    {"points and lines", pointsAndLines, {3 + 10, 4 + 2, 4 + 1, 6, 5, 4, 3 + 10}},
    {"instanced", instanced, {5 * 16, 30, 10, 20, 10, 10, 5 * 16}},
    {"discarded", discarded, {2048, 6, 2, 4, 2, 2, 4096}},
    {"discarded after early tests", discardedAfterTests, {4096, 6, 2, 4, 2, 2, 4096}},
    {"four samples", fourSamples, {4 * 256, 6, 2, 4, 2, 2, {}}},
    {"two of four samples", maskedSamples, {2 * 256, 6, 2, 4, 2, 2, {}}},
    {"nothing written", nothingWritten, {256, 6, 2, 4, 2, 2, {}}},
    {"beyond the edges", clipped, {4096, 6, 2, 4, 2, {}, 4096}},
};

struct Line {
    const char* what;
    Expected expected;
    uint64_t counted;
};

std::vector<Line> linesOf(const Numbers& numbers, const SceneCounts& counts) {
    return {{"samples passed", numbers.samples, counts.samplesPassed},
            {"input vertices", numbers.inputVertices, counts.inputVertices},
            {"input primitives", numbers.inputPrimitives, counts.inputPrimitives},
            {"vertex invocations", numbers.vertexInvocations, counts.vertexInvocations},
            {"clipping invocations", numbers.clippingInvocations, counts.clippingInvocations},
            {"clipping primitives", numbers.clippingPrimitives, counts.clippingPrimitives},
            {"fragment invocations", numbers.fragmentInvocations, counts.fragmentInvocations}};
}

/// The driver of that name: one at a time, for the loader looks for drivers whenever an instance is created.
Result<std::unique_ptr<VulkanDriver>> useDriver(std::string_view name) {
    const DriverPaths paths;
    for (const DriverChoice& choice : driverChoices(paths)) {
        if (choice.name != name) continue;
        if (!choice.present()) return unsupported(choice.absence);
        if (Status status = selectVulkanDriver(choice); !status) return status.error();
        return VulkanDriver::create({});
    }
    return unsupported("no such driver");
}

TEST(Queries, CountWhatTheSpecificationSays) {
    const auto driver = useDriver("icd");
    ASSERT_TRUE(driver.ok()) << driver.error().message;
    for (const QueryCase& each : kCases) {
        SCOPED_TRACE(each.name);
        const Result<Scene> scene = each.build();
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        const Result<SceneCounts> counts = (*driver)->count(*scene, true);
        ASSERT_TRUE(counts.ok()) << counts.error().message;
        for (const Line& line : linesOf(each.numbers, *counts)) {
            if (line.expected) {
                EXPECT_EQ(line.counted, *line.expected) << line.what;
            }
        }
        const Result<SceneCounts> again = (*driver)->count(*scene, false);
        ASSERT_TRUE(again.ok()) << again.error().message;
        EXPECT_EQ(again->samplesPassed != 0, counts->samplesPassed != 0) << "an imprecise query says whether";
    }
}

TEST(Queries, TimeStampsRise) {
    const auto driver = useDriver("icd");
    ASSERT_TRUE(driver.ok()) << driver.error().message;
    const Result<Scene> scene = rectangleOfTwo();
    ASSERT_TRUE(scene.ok());
    const Result<SceneCounts> counts = (*driver)->count(*scene, true);
    ASSERT_TRUE(counts.ok()) << counts.error().message;
    EXPECT_GT(counts->ticks, 0u);
    EXPECT_LT(counts->ticks, uint64_t{1} << 62) << "the second is the later one";
}

TEST(QueriesRecord, OfLavapipe) {
    const auto driver = useDriver("lavapipe");
    if (!driver) GTEST_SKIP() << driver.error().message;
    for (const QueryCase& each : kCases) {
        const Result<Scene> scene = each.build();
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        const Result<SceneCounts> counts = (*driver)->count(*scene, true);
        ASSERT_TRUE(counts.ok()) << counts.error().message;
        for (const Line& line : linesOf(each.numbers, *counts))
            if (line.expected && line.counted != *line.expected)
                std::printf("lavapipe, %s: %s %llu, by the specification %llu\n", each.name, line.what,
                            static_cast<unsigned long long>(line.counted),
                            static_cast<unsigned long long>(*line.expected));
    }
}

}  // namespace
}  // namespace vernier::conformance
