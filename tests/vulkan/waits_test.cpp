// What the walk through the commands waits for: writers of the bytes that it reads, and of no others.
#include <atomic>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{4, 4};
/// The buffer that the walk reads from: all of its words are 0 but those that a dispatch is about to write.
constexpr VkDeviceSize kWrittenFrom = 256, kWritten = 16;

/// Whoever gets a message lets the dispatch end.
VkBool32 VKAPI_CALL raiseFlag(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT*, void* flag) {
    std::atomic_ref<uint32_t>(*static_cast<uint32_t*>(flag)) = 1;
    return VK_FALSE;
}

/// A dispatch that writes the end of a buffer does not end before the driver has told of a draw without descriptors
/// (VERNIER_VALIDATE): before the walk has come to that. Whoever waits for the dispatch first waits until its loop is
/// given up and the device is lost.
class WaitsTest : public ComputeTest {
  protected:
    void SetUp() override {
        setenv("VERNIER_VALIDATE", "1", 1);
        ComputeTest::SetUp();
        unsetenv("VERNIER_VALIDATE");
        flag = makeStorage(4);
        std::memset(flag.data, 0, 16);
        auto info = make<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
        info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        info.pfnUserCallback = raiseFlag;
        info.pUserData = flag.data;
        ASSERT_EQ(ofInstance<PFN_vkCreateDebugUtilsMessengerEXT>("vkCreateDebugUtilsMessengerEXT")(instance, &info,
                                                                                                   nullptr, &messenger),
                  VK_SUCCESS);
        shared = makeBuffer(kWrittenFrom + kWritten, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                         VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                                         VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT |
                                                         VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_COUNTER_BUFFER_BIT_EXT);
        std::memset(shared.data, 0, shared.size);
        auto bufferInfo = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        bufferInfo.size = kWritten;
        bufferInfo.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        ASSERT_EQ(vkCreateBuffer(device, &bufferInfo, nullptr, &written.buffer), VK_SUCCESS);
        defer([this] { vkDestroyBuffer(device, written.buffer, nullptr); });
        ASSERT_EQ(vkBindBufferMemory(device, written.buffer, shared.memory, kWrittenFrom), VK_SUCCESS);
    }
    void TearDown() override {
        const auto destroy = ofInstance<PFN_vkDestroyDebugUtilsMessengerEXT>("vkDestroyDebugUtilsMessengerEXT");
        if (device != VK_NULL_HANDLE) vkDeviceWaitIdle(device);
        destroy(instance, messenger, nullptr);
        ComputeTest::TearDown();
    }
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME, VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME,
                VK_KHR_DRAW_INDIRECT_COUNT_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        conditional.conditionalRendering = VK_TRUE;
        feedback.transformFeedback = VK_TRUE;
        conditional.pNext = &feedback;
        return &conditional;
    }

    /// Records the dispatch, a pass with `commands`, and in it the draw that is told of.
    void expectNoWait(const std::function<void(VkCommandBuffer)>& record) {
        VERNIER_SKIP_WHEN_VALIDATED();
        const Compute late = makeCompute(R"(#version 450
layout(binding = 0) buffer F { uint flag; };
layout(binding = 1) buffer W { uint word; };
void main() {
    while (atomicOr(flag, 0u) == 0u) {}
    word = 7u;
})",
                                         {storageBuffer(flag), storageBuffer(written)});
        const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        const Pass pass = makePass(color);
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        makeSet({storageBuffer(flag)}, &setLayout);
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.layout = makeLayout({setLayout}, 0);
        desc.vertex = fullScreen();
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(binding = 0) readonly buffer F { uint flag; };
layout(location = 0) out vec4 color;
void main() { color = vec4(flag); })");
        const VkPipeline pipeline = makePipeline(pass.pass, desc);

        const VkCommandBuffer commands = begin();
        bind(commands, late);
        vkCmdDispatch(commands, 1, 1, 1);
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        record(commands);
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        EXPECT_EQ(words(shared)[kWrittenFrom / 4], 7u);
        EXPECT_EQ(messages.size(), 1u);
    }

    TestBuffer flag, shared;
    TestBuffer written;  // the end of `shared`
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDeviceConditionalRenderingFeaturesEXT conditional = make<VkPhysicalDeviceConditionalRenderingFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONDITIONAL_RENDERING_FEATURES_EXT);
    VkPhysicalDeviceTransformFeedbackFeaturesEXT feedback = make<VkPhysicalDeviceTransformFeedbackFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_FEATURES_EXT);
};

TEST_F(WaitsTest, predicatesAreFourBytes) {
    expectNoWait([&](VkCommandBuffer commands) {
        auto info = make<VkConditionalRenderingBeginInfoEXT>(VK_STRUCTURE_TYPE_CONDITIONAL_RENDERING_BEGIN_INFO_EXT);
        info.buffer = shared.buffer;
        info.offset = kWrittenFrom - 4;
        command<PFN_vkCmdBeginConditionalRenderingEXT>("vkCmdBeginConditionalRenderingEXT")(commands, &info);
        command<PFN_vkCmdEndConditionalRenderingEXT>("vkCmdEndConditionalRenderingEXT")(commands);
    });
}

TEST_F(WaitsTest, argumentsEndWithTheLastDraw) {
    expectNoWait([&](VkCommandBuffer commands) {
        constexpr uint32_t kSize = sizeof(VkDrawIndirectCommand), kStride = 48;
        vkCmdDrawIndirect(commands, shared.buffer, kWrittenFrom - kSize - 2 * kStride, 3, kStride);
    });
}

/// The count, which is 0, is read first, and lies right in front of what is written.
TEST_F(WaitsTest, drawsThatAreNotCountedHaveNoArguments) {
    expectNoWait([&](VkCommandBuffer commands) {
        command<PFN_vkCmdDrawIndirectCountKHR>("vkCmdDrawIndirectCountKHR")(
            commands, shared.buffer, 0, shared.buffer, kWrittenFrom - 4, 17, sizeof(VkDrawIndirectCommand));
    });
}

TEST_F(WaitsTest, countersAreFourBytes) {
    expectNoWait([&](VkCommandBuffer commands) {
        command<PFN_vkCmdDrawIndirectByteCountEXT>("vkCmdDrawIndirectByteCountEXT")(commands, 1, 0, shared.buffer,
                                                                                    kWrittenFrom - 4, 0, 4);
    });
}

}  // namespace
}  // namespace vernier::test
