// VK_EXT_conditional_rendering: what is left out while a predicate in a buffer says so, and what is not.
#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{8, 4};
constexpr uint32_t kGreen = 0xFF00FF00u, kRed = 0xFF0000FFu;

class ConditionalRenderingTest : public ComputeTest {
  protected:
    void SetUp() override {
        ComputeTest::SetUp();
        color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        pass = makePass(color);
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = fullScreen();
        desc.fragment = constantColor("0, 1, 0, 1");
        pipeline = makePipeline(pass.pass, desc);
        predicates = makeBuffer(16, VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        const uint32_t values[] = {0, 1, 0x80000000u, 0};
        std::memcpy(predicates.data, values, sizeof values);
    }
    std::vector<const char*> moreExtensions() override { return {VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME}; }
    void* moreFeatures() override {
        features.conditionalRendering = features.inheritedConditionalRendering = VK_TRUE;
        return &features;
    }

    void beginConditional(VkCommandBuffer commands, uint32_t predicate, bool inverted = false) {
        auto info = make<VkConditionalRenderingBeginInfoEXT>(VK_STRUCTURE_TYPE_CONDITIONAL_RENDERING_BEGIN_INFO_EXT);
        info.buffer = predicates.buffer;
        info.offset = VkDeviceSize{predicate} * 4;
        info.flags = inverted ? VK_CONDITIONAL_RENDERING_INVERTED_BIT_EXT : 0;
        command<PFN_vkCmdBeginConditionalRenderingEXT>("vkCmdBeginConditionalRenderingEXT")(commands, &info);
    }
    void endConditional(VkCommandBuffer commands) {
        command<PFN_vkCmdEndConditionalRenderingEXT>("vkCmdEndConditionalRenderingEXT")(commands);
    }
    void draw(VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, 0);
    }
    uint32_t firstPixel() { return pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 0, 0); }

    VkPhysicalDeviceConditionalRenderingFeaturesEXT features = make<VkPhysicalDeviceConditionalRenderingFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONDITIONAL_RENDERING_FEATURES_EXT);
    TestImage color;
    Pass pass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    TestBuffer predicates;
};

TEST_F(ConditionalRenderingTest, drawsAndClearsFollowThePredicate) {
    const VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, 0, {{{1, 0, 0, 1}}}};
    const VkClearRect everywhere{{{0, 0}, kExtent}, 0, 1};
    for (uint32_t predicate = 0; predicate < 3; ++predicate) {
        for (const bool inverted : {false, true}) {
            for (const bool clears : {false, true}) {
                const VkCommandBuffer commands = begin();
                beginPass(commands, pass);
                beginConditional(commands, predicate, inverted);
                if (clears) {
                    vkCmdClearAttachments(commands, 1, &clear, 1, &everywhere);
                } else {
                    draw(commands);
                }
                endConditional(commands);
                vkCmdEndRenderPass(commands);
                submit(commands);
                const bool runs = (predicate != 0) != inverted;  // any bit of the 32 counts
                EXPECT_EQ(firstPixel(), !runs    ? 0u
                                        : clears ? kRed
                                                 : kGreen)
                    << "predicate " << predicate << " inverted " << inverted;
            }
        }
    }
}

/// The predicate is written by the dispatch before, in the same submission; what comes after the end runs again.
TEST_F(ConditionalRenderingTest, dispatchesWaitForThePredicate) {
    const TestBuffer results = makeStorage(4);
    std::memset(results.data, 0, 16);
    const Compute decide = makeCompute(R"(#version 450
layout(binding = 0) buffer B { uint predicates[]; };
void main() { predicates[0] = 7u; predicates[1] = 0u; })",
                                       {storageBuffer(predicates)});
    const Compute count = makeCompute(R"(#version 450
layout(binding = 0) buffer B { uint results[]; };
layout(push_constant) uniform P { uint place; };
void main() { results[place] += 1u; })",
                                      {storageBuffer(results)}, 4);
    const VkCommandBuffer commands = begin();
    dispatch(commands, decide, 1);
    auto barrier = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_CONDITIONAL_RENDERING_READ_BIT_EXT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_CONDITIONAL_RENDERING_BIT_EXT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    bind(commands, count);
    for (uint32_t place = 0; place < 3; ++place) {
        if (place < 2) beginConditional(commands, place);
        vkCmdPushConstants(commands, count.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 4, &place);
        vkCmdDispatch(commands, 1, 1, 1);
        if (place < 2) endConditional(commands);
    }
    submit(commands);
    EXPECT_EQ(words(results)[0], 1u);
    EXPECT_EQ(words(results)[1], 0u);
    EXPECT_EQ(words(results)[2], 1u);
}

TEST_F(ConditionalRenderingTest, secondaryBuffersInherit) {
    const VkCommandBuffer secondary = makeCommands(VK_COMMAND_BUFFER_LEVEL_SECONDARY);
    auto conditional = make<VkCommandBufferInheritanceConditionalRenderingInfoEXT>(
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_CONDITIONAL_RENDERING_INFO_EXT);
    conditional.conditionalRenderingEnable = VK_TRUE;
    auto inheritance = make<VkCommandBufferInheritanceInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO);
    inheritance.pNext = &conditional;
    inheritance.renderPass = pass.pass;
    auto info = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT | VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT;
    info.pInheritanceInfo = &inheritance;
    ASSERT_EQ(vkBeginCommandBuffer(secondary, &info), VK_SUCCESS);
    draw(secondary);
    ASSERT_EQ(vkEndCommandBuffer(secondary), VK_SUCCESS);
    for (uint32_t predicate = 0; predicate < 2; ++predicate) {
        const VkCommandBuffer commands = begin();
        beginConditional(commands, predicate);  // around the pass, whose clear still happens
        beginPass(commands, pass, VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS);
        vkCmdExecuteCommands(commands, 1, &secondary);
        vkCmdEndRenderPass(commands);
        endConditional(commands);
        submit(commands);
        EXPECT_EQ(firstPixel(), predicate == 1 ? kGreen : 0u);
    }
}

}  // namespace
}  // namespace vernier::test
