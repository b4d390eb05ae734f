#include "tests/vulkan/test_feedback.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{16, 16};

void barrier(VkCommandBuffer commands) {
    auto memory = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    memory.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1,
                         &memory, 0, nullptr, 0, nullptr);
}

}  // namespace

std::vector<const char*> FeedbackTest::moreExtensions() {
    return {VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME, VK_EXT_PROVOKING_VERTEX_EXTENSION_NAME,
            VK_EXT_PRIMITIVES_GENERATED_QUERY_EXTENSION_NAME};
}

void* FeedbackTest::moreFeatures() {
    feedback_.transformFeedback = feedback_.geometryStreams = VK_TRUE;
    provoking_.provokingVertexLast = provoking_.transformFeedbackPreservesProvokingVertex = VK_TRUE;
    generated_.primitivesGeneratedQuery = generated_.primitivesGeneratedQueryWithRasterizerDiscard =
        generated_.primitivesGeneratedQueryWithNonZeroStreams = VK_TRUE;
    feedback_.pNext = &provoking_;
    provoking_.pNext = &generated_;
    return &feedback_;
}

FeedbackTest::Commands FeedbackTest::feedbackCommands() const {
    return {command<PFN_vkCmdBindTransformFeedbackBuffersEXT>("vkCmdBindTransformFeedbackBuffersEXT"),
            command<PFN_vkCmdBeginTransformFeedbackEXT>("vkCmdBeginTransformFeedbackEXT"),
            command<PFN_vkCmdEndTransformFeedbackEXT>("vkCmdEndTransformFeedbackEXT"),
            command<PFN_vkCmdBeginQueryIndexedEXT>("vkCmdBeginQueryIndexedEXT"),
            command<PFN_vkCmdEndQueryIndexedEXT>("vkCmdEndQueryIndexedEXT"),
            command<PFN_vkCmdDrawIndirectByteCountEXT>("vkCmdDrawIndirectByteCountEXT")};
}

TestBuffer FeedbackTest::makeFeedbackBuffer(VkDeviceSize size, VkBufferUsageFlags more) {
    const TestBuffer buffer = makeBuffer(size, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT | more);
    std::memset(buffer.data, 0xEE, size);
    return buffer;
}

FeedbackTest::Captured FeedbackTest::capture(const Feedback& feedback) {
    const Commands vk = feedbackCommands();
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    auto provoking = make<VkPipelineRasterizationProvokingVertexStateCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT);
    provoking.provokingVertexMode =
        feedback.lastProvokes ? VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT : VK_PROVOKING_VERTEX_MODE_FIRST_VERTEX_EXT;
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, feedback.vertex);
    if (!feedback.control.empty()) {
        desc.control = makeShader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, feedback.control);
        desc.evaluation = makeShader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, feedback.evaluation);
        desc.patchControlPoints = feedback.patchControlPoints;
        desc.domainLowerLeft = feedback.domainLowerLeft;
    }
    if (!feedback.geometry.empty()) desc.geometry = makeShader(VK_SHADER_STAGE_GEOMETRY_BIT, feedback.geometry);
    if (!feedback.discard) desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, feedback.fragment);
    desc.change = [&](const PipelineStates& states) {
        states.assembly.topology = feedback.topology;
        states.assembly.primitiveRestartEnable = feedback.restart ? VK_TRUE : VK_FALSE;
        states.raster.rasterizerDiscardEnable = feedback.discard ? VK_TRUE : VK_FALSE;
        states.raster.pNext = &provoking;
    };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);

    const auto count = static_cast<uint32_t>(feedback.sizes.size());
    std::vector<TestBuffer> buffers;
    std::vector<VkBuffer> handles, counterHandles;
    std::vector<VkDeviceSize> counterOffsets;
    const std::vector<VkDeviceSize> offsets(count, feedback.offset);
    const TestBuffer counters = makeBuffer(4 * count, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_COUNTER_BUFFER_BIT_EXT);
    std::memset(counters.data, 0, 4 * count);
    for (uint32_t b = 0; b < count; ++b) {
        buffers.push_back(makeFeedbackBuffer(feedback.offset + feedback.sizes[b] + kMargin));
        handles.push_back(buffers.back().buffer);
        counterHandles.push_back(counters.buffer);
        counterOffsets.push_back(4 * b);
    }
    const VkQueryPool written = makeQueries(VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT);
    const VkQueryPool generated = makeQueries(VK_QUERY_TYPE_PRIMITIVES_GENERATED_EXT);

    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, written, 0, 1);
    vkCmdResetQueryPool(commands, generated, 0, 1);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vk.bind(commands, 0, count, handles.data(), offsets.data(), feedback.sizes.data());
    if (!feedback.indices.empty()) {
        const TestBuffer indices = makeBuffer(2 * feedback.indices.size(), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
        std::memcpy(indices.data, feedback.indices.data(), indices.size);
        vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
    }
    vk.beginQuery(commands, written, 0, 0, feedback.stream);
    vk.beginQuery(commands, generated, 0, 0, feedback.stream);
    bool active = false, resumes = false;
    const auto pause = [&] {
        if (!active) return;
        vk.end(commands, 0, count, counterHandles.data(), counterOffsets.data());
        vkCmdEndRenderPass(commands);
        barrier(commands);
        active = false;
        resumes = true;
    };
    for (const FeedbackDraw& draw : feedback.draws) {
        if (draw.resumes) pause();
        if (!active) {
            beginPass(commands, pass);
            vk.begin(commands, 0, resumes ? count : 0, resumes ? counterHandles.data() : nullptr,
                     resumes ? counterOffsets.data() : nullptr);
            active = true;
        }
        if (feedback.indices.empty()) {
            vkCmdDraw(commands, draw.count, draw.instances, draw.first, draw.firstInstance);
        } else {
            vkCmdDrawIndexed(commands, draw.count, draw.instances, draw.first, draw.vertexOffset, draw.firstInstance);
        }
    }
    pause();
    vk.endQuery(commands, generated, 0, feedback.stream);
    vk.endQuery(commands, written, 0, feedback.stream);
    submit(commands);

    Captured result;
    for (const TestBuffer& buffer : buffers) {
        const auto* bytes = static_cast<const uint8_t*>(buffer.data);
        result.bytes.emplace_back(bytes, bytes + buffer.size);
    }
    result.counters.resize(count);
    std::memcpy(result.counters.data(), counters.data, 4 * count);
    EXPECT_EQ(vkGetQueryPoolResults(device, written, 0, 1, 16, result.primitives.data(), 16, VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    EXPECT_EQ(vkGetQueryPoolResults(device, generated, 0, 1, 8, &result.generated, 8, VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    return result;
}

}  // namespace vernier::test
