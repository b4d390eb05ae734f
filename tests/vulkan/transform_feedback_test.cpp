// Transform feedback: what is captured, in which order, how far; counters, queries, and draws of what was captured.
#include "tests/vulkan/test_feedback.h"

#include <gmock/gmock.h>

namespace vernier::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class TransformFeedbackTest : public FeedbackTest {
  protected:
    /// One float a vertex: its index.
    static Feedback indices() {
        Feedback feedback;
        feedback.vertex = R"(#version 450
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 4) out float number;
void main() { gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1; number = float(gl_VertexIndex); })";
        return feedback;
    }
    std::vector<float> orderOf(VkPrimitiveTopology topology, bool last, uint32_t vertices, size_t captured) {
        Feedback feedback = indices();
        feedback.topology = topology;
        feedback.lastProvokes = last;
        feedback.draws = {{vertices}};
        const Captured result = capture(feedback);
        EXPECT_EQ(result.counters[0], 4 * captured);
        return result.as<float>(0, 0, captured);
    }
    static uint32_t untouchedBytes(const std::vector<uint8_t>& bytes, size_t from) {
        uint32_t count = 0;
        while (from + count < bytes.size() && bytes[from + count] == 0xEE) ++count;
        return count;
    }
};

TEST_F(TransformFeedbackTest, featuresAndLimits) {
    auto properties = make<VkPhysicalDeviceTransformFeedbackPropertiesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_PROPERTIES_EXT);
    auto all = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &properties);
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2KHR>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceProperties2KHR"));
    get(physicalDevice, &all);
    EXPECT_EQ(properties.maxTransformFeedbackBuffers, 4u);
    EXPECT_GE(properties.maxTransformFeedbackBufferSize, VkDeviceSize{1} << 27);
    EXPECT_GE(properties.maxTransformFeedbackBufferDataStride, 512u);
    EXPECT_EQ(properties.maxTransformFeedbackStreams, 4u);
    EXPECT_TRUE(properties.transformFeedbackQueries && properties.transformFeedbackDraw);
    EXPECT_FALSE(properties.transformFeedbackRasterizationStreamSelect);
}

TEST_F(TransformFeedbackTest, capturesEveryKindOfOutput) {
    Feedback feedback;
    feedback.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    feedback.sizes = {256, 256, 256, 256};
    feedback.draws = {{3}};
    feedback.vertex = R"(#version 450
layout(xfb_buffer = 0, xfb_offset = 4, xfb_stride = 32) out gl_PerVertex {
    vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2];
};
struct Pair { float a; ivec2 b; };
layout(location = 0, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 56) flat out Pair pair;
layout(location = 2, xfb_buffer = 1, xfb_offset = 16) out mat2x3 matrix;
layout(location = 4, xfb_buffer = 1, xfb_offset = 40) flat out dvec2 wide;
layout(location = 6, xfb_buffer = 2, xfb_stride = 12) out Block {
    layout(xfb_offset = 8) float late; layout(xfb_offset = 0) flat uvec2 early; float lost;
} block;
layout(location = 9, xfb_buffer = 3, xfb_offset = 0, xfb_stride = 16) out float row[4];
layout(location = 13) out vec4 unseen;
void main() {
    float n = float(gl_VertexIndex);
    gl_Position = vec4(n, -n, 0.5, 1);
    gl_PointSize = 3;
    gl_ClipDistance[0] = n + 10; gl_ClipDistance[1] = n + 20;
    pair = Pair(n + 0.25, ivec2(-gl_VertexIndex, 7));
    matrix = mat2x3(1, 2, 3, 4, 5, 6 + n);
    wide = dvec2(1.0LF / 3.0LF, double(n));
    block.late = n + 100; block.early = uvec2(0xFFFFFFFFu, gl_VertexIndex); block.lost = 5;
    for (int i = 0; i < 4; ++i) row[(i + gl_VertexIndex) % 4] = float(i);
    unseen = vec4(9);
})";
    const Captured result = capture(feedback);
    EXPECT_THAT(result.counters, ElementsAre(3 * 32, 3 * 56, 3 * 12, 3 * 16));
    for (uint32_t v = 0; v < 3; ++v) {
        const auto n = static_cast<float>(v);
        EXPECT_EQ(result.as<uint32_t>(0, 32 * v, 1)[0], 0xEEEEEEEEu) << "a gap";
        EXPECT_THAT(result.as<float>(0, 32 * v + 4, 7), ElementsAre(n, -n, 0.5f, 1, 3, n + 10, n + 20));
        EXPECT_EQ(result.as<float>(1, 56 * v, 1)[0], n + 0.25f);
        EXPECT_THAT(result.as<int32_t>(1, 56 * v + 4, 2), ElementsAre(-static_cast<int32_t>(v), 7));
        EXPECT_THAT(result.as<float>(1, 56 * v + 16, 6), ElementsAre(1, 2, 3, 4, 5, 6 + n));
        EXPECT_THAT(result.as<double>(1, 56 * v + 40, 2), ElementsAre(1.0 / 3.0, double{n}));
        EXPECT_THAT(result.as<uint32_t>(2, 12 * v, 2), ElementsAre(0xFFFFFFFFu, v));
        EXPECT_EQ(result.as<float>(2, 12 * v + 8, 1)[0], n + 100);
        for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(result.as<float>(3, 16 * v, 4)[(i + v) % 4], static_cast<float>(i));
    }
    EXPECT_EQ(result.primitives, (std::array<uint64_t, 2>{3, 3}));
}

// "Primitive Topologies", and with the last vertex provoking what transformFeedbackPreservesProvokingVertex promises.
TEST_F(TransformFeedbackTest, stripsAndFansComeApartInOrder) {
    EXPECT_THAT(orderOf(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, false, 4, 6), ElementsAre(0, 1, 1, 2, 2, 3));
    EXPECT_THAT(orderOf(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, true, 3, 4), ElementsAre(0, 1, 1, 2));
    EXPECT_THAT(orderOf(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, true, 8, 6), ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_THAT(orderOf(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, false, 5, 9), ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
    EXPECT_THAT(orderOf(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, true, 5, 9), ElementsAre(0, 1, 2, 2, 1, 3, 2, 3, 4));
    EXPECT_THAT(orderOf(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, false, 5, 9), ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
    EXPECT_THAT(orderOf(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, true, 5, 9), ElementsAre(0, 1, 2, 0, 2, 3, 0, 3, 4));
}

TEST_F(TransformFeedbackTest, overflowLeavesOutWholePrimitivesOfAllBuffers) {
    Feedback feedback;
    feedback.vertex = R"(#version 450
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 8) out float a;
layout(location = 1, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 4) out float b;
void main() { gl_Position = vec4(0, 0, 0, 1); a = float(gl_VertexIndex); b = a + 100; })";
    // Eleven vertices fit into the first buffer, with the last one's stride cut off, seven into the second.
    feedback.sizes = {10 * 8 + 4, 28};
    feedback.offset = 16;
    feedback.draws = {{5}, {3}, {300}};
    const Captured result = capture(feedback);
    EXPECT_EQ(result.primitives, (std::array<uint64_t, 2>{2, 102}));
    EXPECT_EQ(result.generated, 102u);
    EXPECT_THAT(result.counters, ElementsAre(6 * 8, 6 * 4));
    EXPECT_EQ(untouchedBytes(result.bytes[0], 0), 16u);
    for (uint32_t v = 0; v < 6; ++v) EXPECT_EQ(result.as<float>(0, 16 + 8 * v, 1)[0], static_cast<float>(v % 3)) << v;
    EXPECT_THAT(result.as<float>(1, 16, 6), ElementsAre(100, 101, 102, 100, 101, 102));
    EXPECT_EQ(untouchedBytes(result.bytes[1], 16 + 24), 4u + kMargin);
    // The second buffer is full to the byte.
    feedback.sizes[1] = 36;
    EXPECT_THAT(capture(feedback).counters, ElementsAre(9 * 8, 9 * 4));
}

// Of points 16 bytes apart the fourth would fit, but a counter could not tell where it ends.
TEST_F(TransformFeedbackTest, goesNoFurtherThanCountersCount) {
    constexpr VkDeviceSize kSize = 0xFFFFFFFCu;
    constexpr uint32_t kFrom = 0xFFFFFFC0u;
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
    if (memory.memoryHeaps[0].size < 2 * kSize) GTEST_SKIP() << "the heap is too small for buffers of 4 GiB";
    const Commands vk = feedbackCommands();
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {16, 16}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = {16, 16};
    desc.change = [](const PipelineStates& states) {
        states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
        states.raster.rasterizerDiscardEnable = VK_TRUE;
    };
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 16) out float number;
void main() { gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1; number = float(gl_VertexIndex + 1); })");
    const VkShaderModule geometry = makeShader(VK_SHADER_STAGE_GEOMETRY_BIT, R"(#version 450
layout(points) in;
layout(points, max_vertices = 1) out;
layout(location = 0) in float number[];
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 16) out float copy;
void main() { copy = number[0]; gl_PointSize = 1; EmitVertex(); })");
    for (const VkShaderModule stage : {VkShaderModule{VK_NULL_HANDLE}, geometry}) {
        desc.geometry = stage;
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const TestBuffer captured = makeBuffer(kSize, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT);
        const TestBuffer counter = makeBuffer(4, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_COUNTER_BUFFER_BIT_EXT);
        std::memcpy(counter.data, &kFrom, 4);
        const VkDeviceSize zero = 0;
        const VkCommandBuffer commands = begin();
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vk.bind(commands, 0, 1, &captured.buffer, &zero, &kSize);
        beginPass(commands, pass);
        vk.begin(commands, 0, 1, &counter.buffer, &zero);
        vkCmdDraw(commands, 6, 1, 0, 0);
        vk.end(commands, 0, 1, &counter.buffer, &zero);
        vkCmdEndRenderPass(commands);
        submit(commands);
        uint32_t end = 0;
        std::memcpy(&end, counter.data, 4);
        EXPECT_EQ(end, 0xFFFFFFF0u);
        std::array<float, 15> behind{};
        std::memcpy(behind.data(), static_cast<const std::byte*>(captured.data) + kFrom, sizeof behind);
        EXPECT_THAT(behind, ElementsAre(1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0));
    }
}

TEST_F(TransformFeedbackTest, pausesAndGoesOn) {
    Feedback feedback = indices();
    feedback.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
    feedback.sizes = {48};
    feedback.draws = {{3}, {2, 1, 7}, {3, 2, 10, 0, 0, true}, {3, 1, 20, 0, 0, true}};
    const Captured result = capture(feedback);
    EXPECT_THAT(result.as<float>(0, 0, 12), ElementsAre(0, 1, 1, 2, 7, 8, 10, 11, 11, 12, 10, 11));
    EXPECT_EQ(result.counters[0], 48u);
    EXPECT_EQ(result.primitives, (std::array<uint64_t, 2>{6, 9}));
}

// Many chunks and waves on all threads, and instances across them.
TEST_F(TransformFeedbackTest, largeDrawsKeepTheirOrder) {
    constexpr uint32_t kTriangles = 50000, kInstances = 3;
    Feedback feedback;
    feedback.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    feedback.discard = false;
    feedback.vertex = R"(#version 450
layout(location = 0) out vec4 color;
layout(location = 1, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 8) flat out ivec2 number;
void main() {
    gl_Position = vec4(gl_VertexIndex % 7 - 3, gl_VertexIndex % 5 - 2, 0.5, 3);
    color = vec4(1);
    number = ivec2(gl_VertexIndex, gl_InstanceIndex);
})";
    feedback.fragment = R"(#version 450
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = color; })";
    feedback.sizes = {VkDeviceSize{kTriangles} * kInstances * 3 * 8};
    feedback.draws = {{kTriangles + 2, kInstances, 11, 5}};
    const Captured result = capture(feedback);
    EXPECT_EQ(result.primitives[0], uint64_t{kTriangles} * kInstances);
    const std::vector<uint32_t> words = result.as<uint32_t>(0, 0, size_t{kTriangles} * kInstances * 6);
    size_t wrong = 0;
    for (uint32_t n = 0; n < kTriangles * kInstances; ++n) {
        const uint32_t p = n % kTriangles, odd = p % 2;
        const uint32_t numbers[3] = {p, p + 1 + odd, p + 2 - odd};
        for (uint32_t v = 0; v < 3; ++v) {
            wrong += words[6 * n + 2 * v] != 11 + numbers[v];
            wrong += words[6 * n + 2 * v + 1] != 5 + n / kTriangles;
        }
    }
    EXPECT_EQ(wrong, 0u);
}

// The primitives of a draw with restart follow from its indices, which other commands may have written just before.
TEST_F(TransformFeedbackTest, indicesThatWereJustCopied) {
    const Commands vk = feedbackCommands();
    constexpr uint32_t kIndices = 1 << 20;
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {16, 16}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    const Feedback feedback = indices();
    PipelineDesc desc;
    desc.extent = {16, 16};
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, feedback.vertex);
    desc.change = [](const PipelineStates& states) {
        states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
        states.assembly.primitiveRestartEnable = states.raster.rasterizerDiscardEnable = VK_TRUE;
    };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer from = makeBuffer(4 * kIndices, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const TestBuffer to = makeBuffer(4 * kIndices, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const TestBuffer captured = makeFeedbackBuffer(8 * kIndices);
    auto* numbers = static_cast<uint32_t*>(from.data);
    for (uint32_t n = 0; n < kIndices; ++n) numbers[n] = n % 4 == 3 ? ~0u : n;
    const VkQueryPool written = makeQueries(VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT);

    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, written, 0, 1);
    const VkBufferCopy all{0, 0, from.size};
    vkCmdCopyBuffer(commands, from.buffer, to.buffer, 1, &all);
    auto memory = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    memory.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_INDEX_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, 0, 1, &memory, 0,
                         nullptr, 0, nullptr);
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindIndexBuffer(commands, to.buffer, 0, VK_INDEX_TYPE_UINT32);
    const VkDeviceSize zero = 0;
    vk.bind(commands, 0, 1, &captured.buffer, &zero, nullptr);
    vk.beginQuery(commands, written, 0, 0, 0);
    vk.begin(commands, 0, 0, nullptr, nullptr);
    vkCmdDrawIndexed(commands, kIndices, 1, 0, 0, 0);
    vk.end(commands, 0, 0, nullptr, nullptr);
    vk.endQuery(commands, written, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    uint64_t primitives[2] = {};
    ASSERT_EQ(vkGetQueryPoolResults(device, written, 0, 1, 16, primitives, 16, VK_QUERY_RESULT_64_BIT), VK_SUCCESS);
    EXPECT_EQ(primitives[0], kIndices / 2);
    EXPECT_EQ(primitives[1], kIndices / 2);
    const auto* lines = static_cast<const float*>(captured.data);
    size_t wrong = 0;
    for (uint32_t n = 0; n < kIndices / 2; ++n) {
        const uint32_t first = 4 * (n / 2) + n % 2;
        wrong += lines[2 * n] != static_cast<float>(first) || lines[2 * n + 1] != static_cast<float>(first + 1);
    }
    EXPECT_EQ(wrong, 0u);
}

// Captures while it draws, then draws what was captured as vertices, as many as there are.
TEST_F(TransformFeedbackTest, drawsWhatWasCaptured) {
    const Commands vk = feedbackCommands();
    constexpr VkExtent2D kExtent{32, 32};
    const TestImage first = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const TestImage second = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass firstPass = makePass(first), secondPass = makePass(second);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) out vec2 shade;
layout(xfb_buffer = 1, xfb_offset = 0, xfb_stride = 24) out gl_PerVertex { vec4 gl_Position; };
layout(location = 1, xfb_buffer = 1, xfb_offset = 16) out vec2 kept;
void main() {
    int n = gl_VertexIndex;
    gl_Position = vec4((n % 3 == 1 ? 0.75 : -0.5) + 0.125 * gl_InstanceIndex, n % 3 == 2 ? 0.875 : -0.75, 0.5, 1);
    shade = kept = vec2(n == 0, n == 1);
})");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) in vec2 shade;
layout(location = 0) out vec4 color;
void main() { color = vec4(shade, 1, 1); })");
    const VkPipeline capturing = makePipeline(firstPass.pass, desc);
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 given;
layout(location = 0) out vec2 shade;
void main() { gl_Position = position; shade = given; })");
    desc.bindings = {{0, 24, VK_VERTEX_INPUT_RATE_VERTEX}};
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0}, {1, 0, VK_FORMAT_R32G32_SFLOAT, 16}};
    const VkPipeline drawing = makePipeline(secondPass.pass, desc);
    const TestBuffer captured = makeFeedbackBuffer(24 * 64, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    const TestBuffer counter =
        makeBuffer(16, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_COUNTER_BUFFER_BIT_EXT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    std::memset(counter.data, 0xEE, 16);
    const VkDeviceSize zero = 0, eight = 8;

    const VkCommandBuffer commands = begin();
    beginPass(commands, firstPass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, capturing);
    vk.bind(commands, 1, 1, &captured.buffer, &zero, nullptr);
    vk.begin(commands, 1, 0, nullptr, nullptr);
    vkCmdDraw(commands, 3, 2, 0, 0);
    vk.end(commands, 1, 1, &counter.buffer, &eight);
    vkCmdEndRenderPass(commands);
    auto memory = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    memory.srcAccessMask =
        VK_ACCESS_TRANSFORM_FEEDBACK_WRITE_BIT_EXT | VK_ACCESS_TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT;
    memory.dstAccessMask = VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFORM_FEEDBACK_BIT_EXT,
                         VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, 0, 1, &memory, 0,
                         nullptr, 0, nullptr);
    beginPass(commands, secondPass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing);
    vkCmdBindVertexBuffers(commands, 0, 1, &captured.buffer, &zero);
    vk.drawByteCount(commands, 1, 0, counter.buffer, 8, 0, 24);
    vkCmdEndRenderPass(commands);
    submit(commands);
    uint32_t words[4];
    std::memcpy(words, counter.data, 16);
    EXPECT_THAT(words, ElementsAre(0xEEEEEEEEu, 0xEEEEEEEEu, 6u * 24, 0xEEEEEEEEu));
    const auto texels = readImage(first, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    EXPECT_EQ(texels, readImage(second, VK_IMAGE_ASPECT_COLOR_BIT, 4));
    EXPECT_EQ(pixelAt(texels, first, 12, 8) >> 16, 0xFFFFu);
    EXPECT_EQ(pixelAt(texels, first, 31, 31), 0u);
}

// A pass draws twice into the same place: the later one stays, whatever the threads do.
TEST_F(TransformFeedbackTest, laterDrawsReplaceEarlierOnes) {
    VERNIER_SKIP_WHEN_VALIDATED();  // without barriers between
    const Commands vk = feedbackCommands();
    constexpr uint32_t kPoints = 100000;
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {16, 16}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = {16, 16};
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, indices().vertex);
    desc.change = [](const PipelineStates& states) {
        states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
        states.raster.rasterizerDiscardEnable = VK_TRUE;
    };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer captured = makeFeedbackBuffer(4 * kPoints);
    const VkDeviceSize zero = 0;
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vk.bind(commands, 0, 1, &captured.buffer, &zero, nullptr);
    for (uint32_t n = 0; n < 5; ++n) {
        vk.begin(commands, 0, 0, nullptr, nullptr);
        vkCmdDraw(commands, kPoints, 1, n, 0);
        vk.end(commands, 0, 0, nullptr, nullptr);
    }
    vkCmdEndRenderPass(commands);
    submit(commands);
    const auto* numbers = static_cast<const float*>(captured.data);
    size_t wrong = 0;
    for (uint32_t n = 0; n < kPoints; ++n) wrong += numbers[n] != static_cast<float>(n + 4);
    EXPECT_EQ(wrong, 0u);
}

TEST_F(TransformFeedbackTest, queriesCountWhatIsBetween) {
    const Commands vk = feedbackCommands();
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {16, 16}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = {16, 16};
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, indices().vertex);
    desc.change = [](const PipelineStates& states) { states.raster.rasterizerDiscardEnable = VK_TRUE; };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer captured = makeFeedbackBuffer(4 * 3 * 5);
    const TestBuffer results = makeBuffer(64, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkQueryPool written = makeQueries(VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT, 2);
    const VkQueryPool generated = makeQueries(VK_QUERY_TYPE_PRIMITIVES_GENERATED_EXT, 1);
    const VkDeviceSize zero = 0;
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, written, 0, 2);
    vkCmdResetQueryPool(commands, generated, 0, 1);
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vk.bind(commands, 0, 1, &captured.buffer, &zero, nullptr);
    vkCmdBeginQuery(commands, generated, 0, 0);
    vk.beginQuery(commands, written, 0, 0, 0);
    vkCmdDraw(commands, 30, 1, 0, 0);  // nothing is captured yet
    vk.begin(commands, 0, 0, nullptr, nullptr);
    vkCmdDraw(commands, 9, 1, 0, 0);
    vk.endQuery(commands, written, 0, 0);
    vk.beginQuery(commands, written, 1, 0, 0);
    vkCmdDraw(commands, 12, 1, 0, 0);
    vk.endQuery(commands, written, 1, 0);
    vk.end(commands, 0, 0, nullptr, nullptr);
    vkCmdEndQuery(commands, generated, 0);
    vkCmdDraw(commands, 30, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    vkCmdCopyQueryPoolResults(commands, written, 0, 2, results.buffer, 0, 16,
                              VK_QUERY_RESULT_WAIT_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
    submit(commands);
    const auto* words = static_cast<const uint32_t*>(results.data);
    EXPECT_THAT(std::vector<uint32_t>(words, words + 3), ElementsAre(3, 3, 1));
    EXPECT_THAT(std::vector<uint32_t>(words + 4, words + 7), ElementsAre(2, 4, 1));
    uint32_t count = 0;
    ASSERT_EQ(vkGetQueryPoolResults(device, generated, 0, 1, 4, &count, 4, 0), VK_SUCCESS);
    EXPECT_EQ(count, 10u + 3 + 4);
}

TEST_F(TransformFeedbackTest, misuseStaysInside) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const Commands vk = feedbackCommands();
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {16, 16}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = {16, 16};
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, indices().vertex);
    desc.fragment = constantColor("1");
    const VkPipeline capturing = makePipeline(pass.pass, desc);
    desc.vertex = fullScreen();
    const VkPipeline plain = makePipeline(pass.pass, desc);
    const TestBuffer captured = makeFeedbackBuffer(64);
    const TestBuffer counter = makeBuffer(8, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_COUNTER_BUFFER_BIT_EXT);
    const uint32_t far[2] = {0xFFFFFFF0u, 60};
    std::memcpy(counter.data, far, 8);
    const VkDeviceSize zero = 0, four = 4, behind = 1000;
    const VkBuffer none = VK_NULL_HANDLE;
    VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, capturing);
    vk.end(commands, 0, 1, &counter.buffer, &zero);  // of nothing
    const auto drawWith = [&](VkBuffer buffer, VkDeviceSize offset, VkBuffer from, VkDeviceSize at) {
        vk.bind(commands, 0, 1, &buffer, &offset, nullptr);
        vk.begin(commands, 0, 1, &from, &at);
        vkCmdDraw(commands, 6, 1, 0, 0);
        vk.end(commands, 0, 1, &from, &at);
    };
    drawWith(none, 0, none, 0);
    drawWith(captured.buffer, behind, none, 0);
    drawWith(captured.buffer, 0, counter.buffer, zero);  // far outside
    drawWith(captured.buffer, 0, counter.buffer, four);  // one vertex before the end
    drawWith(captured.buffer, 0, counter.buffer, behind);
    vk.begin(commands, 0, 0, nullptr, nullptr);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, plain);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, capturing);
    vk.drawByteCount(commands, 1, 0, counter.buffer, 0, 0, 0);
    vkCmdEndRenderPass(commands);  // with transform feedback on
    submit(commands);
    uint32_t words[2];
    std::memcpy(words, counter.data, 8);
    EXPECT_THAT(words, ElementsAre(0xFFFFFFF0u, 60u));
    // Of the counter that does not exist: from the begin.
    const auto* numbers = static_cast<const float*>(captured.data);
    EXPECT_THAT(std::vector<float>(numbers, numbers + 6), ElementsAre(0, 1, 2, 3, 4, 5));

    commands = begin();
    vk.bind(commands, 3, 2, &captured.buffer, &zero, nullptr);
    EXPECT_NE(vkEndCommandBuffer(commands), VK_SUCCESS);
    EXPECT_THAT(messages, Contains(HasSubstr("there are no such bindings")));
    commands = begin();
    vk.begin(commands, 5, 1, &counter.buffer, &zero);
    EXPECT_NE(vkEndCommandBuffer(commands), VK_SUCCESS);
    EXPECT_THAT(messages, Contains(HasSubstr("there are no such counter buffers")));
}

}  // namespace
}  // namespace vernier::test
