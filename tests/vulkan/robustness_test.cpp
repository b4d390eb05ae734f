// Null descriptors, and the edges of buffers and images: VK_EXT_robustness2, VK_EXT_image_robustness.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class RobustnessTest : public ComputeTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_ROBUSTNESS_2_EXTENSION_NAME, VK_EXT_IMAGE_ROBUSTNESS_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        image_ =
            make<VkPhysicalDeviceImageRobustnessFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES);
        image_.robustImageAccess = VK_TRUE;
        robust_ =
            make<VkPhysicalDeviceRobustness2FeaturesEXT>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT);
        robust_.pNext = &image_;
        robust_.robustBufferAccess2 = robust_.robustImageAccess2 = robust_.nullDescriptor = VK_TRUE;
        return &robust_;
    }
    VkSampler makeSampler() {
        const auto info = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
        VkSampler sampler = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSampler(device, &info, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
        return sampler;
    }
    static TestDescriptor nothing(VkDescriptorType type) {
        TestDescriptor descriptor;
        descriptor.type = type;
        return descriptor;
    }

  private:
    VkPhysicalDeviceImageRobustnessFeatures image_{};
    VkPhysicalDeviceRobustness2FeaturesEXT robust_{};
};

TEST_F(RobustnessTest, nullDescriptorsReadZerosAndDropWrites) {
    constexpr uint32_t kResults = 15;
    const TestBuffer out = makeStorage(kResults);
    std::memset(out.data, 0xFF, kResults * 4);
    const Compute compute = makeCompute(
        R"(#version 450
        #extension GL_EXT_shader_image_load_formatted : require
        layout(set = 0, binding = 0) buffer Out { uint values[]; };
        layout(set = 0, binding = 1) uniform Uniform { uvec4 uniforms[4]; };
        layout(set = 0, binding = 2) buffer Storage { uint storages[]; };
        layout(set = 0, binding = 3) uniform usampler2D sampled;
        layout(set = 0, binding = 4) uniform uimage2D stored;
        layout(set = 0, binding = 5) uniform usamplerBuffer texels;
        layout(set = 0, binding = 6) uniform uimageBuffer storedTexels;
        void main() {
            values[0] = uniforms[2].y;
            storages[1] = 5;
            values[1] = storages[1];
            values[2] = storages.length();
            values[3] = atomicAdd(storages[0], 3);
            uvec4 texel = textureLod(sampled, vec2(0.5), 0);
            values[4] = texel.x | texel.y | texel.z | texel.w;
            texel = texelFetch(sampled, ivec2(0), 0);
            values[5] = texel.x | texel.y | texel.z | texel.w;
            values[6] = textureSize(sampled, 0).x + textureQueryLevels(sampled);
            imageStore(stored, ivec2(0), uvec4(1));
            texel = imageLoad(stored, ivec2(0));
            values[7] = texel.x | texel.y | texel.z | texel.w;
            values[8] = imageSize(stored).y;
            texel = texelFetch(texels, 0);
            values[9] = texel.x | texel.y | texel.z | texel.w;
            values[10] = textureSize(texels);
            imageStore(storedTexels, 0, uvec4(1));
            texel = imageLoad(storedTexels, 0);
            values[11] = texel.x | texel.y | texel.z | texel.w;
            values[12] = imageSize(storedTexels);
            values[13] = textureGather(sampled, vec2(0.5)).x;
            values[14] = 77;
        })",
        {storageBuffer(out), nothing(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER), nothing(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
         sampledImage(VK_NULL_HANDLE, makeSampler()), nothing(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE),
         nothing(VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER), nothing(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER)});
    run(compute, 1);
    for (uint32_t i = 0; i + 1 < kResults; ++i) EXPECT_EQ(words(out)[i], 0u) << i;
    EXPECT_EQ(words(out)[kResults - 1], 77u);
}

TEST_F(RobustnessTest, nullVertexBuffersReadZeros) {
    const TestBuffer out = makeStorage(8);
    std::memset(out.data, 0xFF, 32);
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeSet({storageBuffer(out)}, &setLayout);
    const TestImage image = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
        layout(location = 0) in vec4 wide;
        layout(location = 1) in uvec2 narrow;
        layout(set = 0, binding = 0) buffer Out { vec4 first; uvec4 second; };
        void main() {
            first = wide;
            second = uvec4(narrow, 7, 7);
            gl_Position = vec4(0);
            gl_PointSize = 1;
        })");
    desc.fragment = constantColor("1");
    desc.layout = makeLayout({setLayout}, 0);
    desc.extent = image.extent;
    desc.bindings = {{0, 16, VK_VERTEX_INPUT_RATE_VERTEX}};
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0}, {1, 0, VK_FORMAT_R32G32_UINT, 0}};
    desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST; };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
    const VkBuffer none = VK_NULL_HANDLE;
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &none, &offset);
    vkCmdDraw(commands, 1, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    makeVisible(commands);
    submit(commands);
    for (uint32_t i = 0; i < 6; ++i) EXPECT_EQ(words(out)[i], 0u) << i;
    EXPECT_EQ(words(out)[7], 7u);
}

// What lies behind the range of a descriptor, in the same buffer, is neither read nor written.
TEST_F(RobustnessTest, buffersEndWhereTheirRangesEnd) {
    const TestBuffer out = makeStorage(4);
    const TestBuffer in = makeBuffer(64, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    for (uint32_t i = 0; i < 16; ++i) words(in)[i] = 100 + i;
    TestDescriptor uniform = storageBuffer(in), storage = storageBuffer(in);
    uniform.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    uniform.range = storage.range = 20;
    const Compute compute = makeCompute(R"(#version 450
        layout(set = 0, binding = 0) buffer Out { uint values[4]; };
        layout(set = 0, binding = 1) uniform Uniform { uvec4 uniforms[4]; };
        layout(set = 0, binding = 2) buffer Storage { uint storages[16]; };
        layout(push_constant) uniform Index { uint five; };
        void main() {
            values[0] = storages[five - 1];
            values[1] = storages[five];
            values[2] = uniforms[1].x;
            values[3] = uniforms[five - 4].y;
            storages[five] = 1;
            storages[five + 3] = 1;
        })",
                                        {storageBuffer(out), uniform, storage}, 4);
    const uint32_t five = 5;
    const VkCommandBuffer commands = begin();
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 4, &five);
    dispatch(commands, compute, 1);
    submit(commands);
    EXPECT_EQ(words(out)[0], 104u);
    EXPECT_EQ(words(out)[1], 0u);
    EXPECT_EQ(words(out)[2], 104u);
    EXPECT_EQ(words(out)[3], 0u);
    EXPECT_EQ(words(in)[5], 105u);
    EXPECT_EQ(words(in)[8], 108u);
}

// Texels outside are zeros, and formats without alpha have an alpha of 1 there as everywhere.
TEST_F(RobustnessTest, texelsOutsideAreZeros) {
    const TestImage four =
        makeImage(VK_FORMAT_R8G8B8A8_UNORM, {3, 3}, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const TestImage one =
        makeImage(VK_FORMAT_R32_SFLOAT, {3, 3}, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const VkCommandBuffer clear = begin();
    const VkClearColorValue white{.float32 = {1, 1, 1, 1}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    for (const TestImage* image : {&four, &one}) {
        toGeneral(clear, *image);
        vkCmdClearColorImage(clear, image->image, VK_IMAGE_LAYOUT_GENERAL, &white, 1, &range);
    }
    makeVisible(clear);
    submit(clear);
    const TestBuffer out = makeStorage(8 * 4);
    const VkSampler sampler = makeSampler();
    run(makeCompute(R"(#version 450
        #extension GL_EXT_shader_image_load_formatted : require
        layout(set = 0, binding = 0) buffer Out { vec4 values[8]; };
        layout(set = 0, binding = 1) uniform image2D four;
        layout(set = 0, binding = 2) uniform image2D one;
        layout(set = 0, binding = 3) uniform sampler2D fourSampled;
        layout(set = 0, binding = 4) uniform sampler2D oneSampled;
        void main() {
            values[0] = imageLoad(four, ivec2(3, 0));
            values[1] = imageLoad(one, ivec2(0, -1));
            values[2] = texelFetch(fourSampled, ivec2(-1, 2), 0);
            values[3] = texelFetch(oneSampled, ivec2(2, 3), 0);
            values[4] = texelFetch(fourSampled, ivec2(0), 1);
            values[5] = texelFetch(oneSampled, ivec2(0), -1);
            values[6] = imageLoad(four, ivec2(2));
            imageStore(four, ivec2(3, 1), vec4(0));
            imageStore(four, ivec2(-1, 1), vec4(0));
            imageStore(four, ivec2(1, 3), vec4(0));
            memoryBarrierImage();
            values[7] = imageLoad(four, ivec2(0, 2)) + imageLoad(four, ivec2(2, 0)) + imageLoad(four, ivec2(2, 1));
        })",
                    {storageBuffer(out), storageImage(four), storageImage(one), sampledImage(four.view, sampler),
                     sampledImage(one.view, sampler)}),
        1);
    const auto* values = static_cast<const float*>(out.data);
    for (int i = 0; i < 6; ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_EQ(values[4 * i + c], 0.0f) << i;
        EXPECT_EQ(values[4 * i + 3], i % 2 == 1 ? 1.0f : 0.0f) << i;
    }
    for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(values[4 * 6 + c], 1.0f);
        EXPECT_EQ(values[4 * 7 + c], 3.0f);
    }
}

/// With VERNIER_VALIDATE.
class ValidateTest : public ComputeTest {
  protected:
    void SetUp() override {
        setenv("VERNIER_VALIDATE", "1", 1);
        ComputeTest::SetUp();
        unsetenv("VERNIER_VALIDATE");
    }
    bool told(const std::string& text) const {
        return std::any_of(messages.begin(), messages.end(),
                           [&](const std::string& message) { return message.find(text) != std::string::npos; });
    }
};

TEST_F(ValidateTest, harmlessMisuseIsTold) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestBuffer buffer = makeStorage(4);  // which is mapped
    const Compute compute = makeCompute(R"(#version 450
        layout(set = 0, binding = 0) buffer Out { uint value; };
        void main() { value = 5; })",
                                        {storageBuffer(buffer)});
    run(compute, 1);
    EXPECT_TRUE(messages.empty());
    EXPECT_EQ(words(buffer)[0], 5u);
    const VkCommandBuffer commands = begin();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.pipeline);
    vkCmdDispatch(commands, 1, 1, 1);
    submit(commands);
    EXPECT_TRUE(told("set 0, binding 0, but no descriptor set is bound"));
    void* again = nullptr;
    EXPECT_EQ(vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &again), VK_SUCCESS);
    EXPECT_TRUE(told("mapped already"));
    vkUnmapMemory(device, buffer.memory);
    messages.clear();
    EXPECT_EQ(vkMapMemory(device, buffer.memory, 4096, VK_WHOLE_SIZE, 0, &again), VK_ERROR_MEMORY_MAP_FAILED);
    EXPECT_EQ(vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &again), VK_SUCCESS);
    EXPECT_FALSE(told("mapped already")) << "the first mapping failed";
    vkUnmapMemory(device, buffer.memory);
    vkUnmapMemory(device, buffer.memory);
    EXPECT_TRUE(told("not mapped"));
    auto info = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    VkFence fence = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateFence(device, &info, nullptr, &fence), VK_SUCCESS);
    defer([this, fence] { vkDestroyFence(device, fence, nullptr); });
    EXPECT_EQ(vkQueueSubmit(queue, 0, nullptr, fence), VK_SUCCESS);
    EXPECT_TRUE(told("signalled already"));
}

std::vector<uint32_t> withoutCapabilities(const std::vector<uint32_t>& words, const std::vector<uint32_t>& which) {
    constexpr size_t kHeader = 5;
    std::vector<uint32_t> less(words.begin(), words.begin() + kHeader);
    for (size_t at = kHeader; at < words.size(); at += words[at] >> 16) {
        const bool capability = (words[at] & 0xFFFF) == 17;  // OpCapability
        if (capability && std::find(which.begin(), which.end(), words[at + 1]) != which.end()) continue;
        less.insert(less.end(), words.begin() + static_cast<ptrdiff_t>(at),
                    words.begin() + static_cast<ptrdiff_t>(at + (words[at] >> 16)));
    }
    return less;
}

// Mesa's Zink 22.3 does so; other drivers take it.
TEST_F(ValidateTest, builtInVariablesWithoutTheirCapabilities) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const auto create = [&](const std::vector<uint32_t>& words, VkShaderModule& module) {
        auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = 4 * words.size();
        info.pCode = words.data();
        const VkResult result = vkCreateShaderModule(device, &info, nullptr, &module);
        if (result == VK_SUCCESS) defer([this, made = module] { vkDestroyShaderModule(device, made, nullptr); });
        return result;
    };
    const std::vector<uint32_t> whole = compileGlsl(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
        layout(location = 0) out vec4 color;
        void main() {
            color = vec4(gl_SampleID + 1, gl_ViewportIndex + 2, gl_Layer + 3, gl_PrimitiveID + 4) / 255.0;
        })");
    constexpr uint32_t kGeometry = 2, kFloat64 = 10, kSampleRateShading = 35, kMultiViewport = 57;
    const std::vector<uint32_t> words = withoutCapabilities(whole, {kGeometry, kSampleRateShading, kMultiViewport});
    ASSERT_EQ(words.size(), whole.size() - 6);
    PipelineDesc desc;
    ASSERT_EQ(create(words, desc.fragment), VK_SUCCESS);
    EXPECT_TRUE(told("whose capability it does not declare"));
    messages.clear();
    ASSERT_EQ(create(whole, desc.fragment), VK_SUCCESS);
    EXPECT_TRUE(messages.empty());
    ASSERT_EQ(create(words, desc.fragment), VK_SUCCESS);

    const TestImage image = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    desc.extent = image.extent;
    desc.vertex = fullScreen();
    drawTriangle(pass, makePipeline(pass.pass, desc));
    EXPECT_EQ(pixelAt(readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4), image, 2, 1), 0x04030201u);

    const std::vector<uint32_t> doubles = compileGlsl(VK_SHADER_STAGE_COMPUTE_BIT, R"(#version 450
        layout(set = 0, binding = 0) buffer Out { double value; };
        void main() { value = 5; })");
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_NE(create(withoutCapabilities(doubles, {kFloat64}), module), VK_SUCCESS) << "types need theirs";
}

/// A callback that does not return before its messenger is destroyed, or that takes long.
struct SlowCallback {
    std::mutex mutex;
    std::condition_variable changed;
    bool called = false, destroyed = false, outlived = false;

    static VkBool32 VKAPI_CALL call(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT*, void* user) {
        auto& self = *static_cast<SlowCallback*>(user);
        std::unique_lock lock(self.mutex);
        self.called = true;
        self.changed.notify_all();
        self.outlived = self.changed.wait_for(lock, std::chrono::milliseconds(100), [&] { return self.destroyed; });
        return VK_FALSE;
    }
};

TEST_F(ValidateTest, aMessengerGoesWhenItsCallbackHasReturned) {
    VERNIER_SKIP_WHEN_VALIDATED();
    SlowCallback callback;
    auto info = make<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    info.pfnUserCallback = SlowCallback::call;
    info.pUserData = &callback;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    ASSERT_EQ(ofInstance<PFN_vkCreateDebugUtilsMessengerEXT>("vkCreateDebugUtilsMessengerEXT")(instance, &info, nullptr,
                                                                                               &messenger),
              VK_SUCCESS);
    const Compute compute = makeCompute(R"(#version 450
        layout(set = 0, binding = 0) buffer Out { uint value; };
        void main() { value = 5; })",
                                        {storageBuffer(makeStorage(4))});
    const VkCommandBuffer commands = begin();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.pipeline);
    vkCmdDispatch(commands, 1, 1, 1);  // without a descriptor set
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    auto submission = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submission.commandBufferCount = 1;
    submission.pCommandBuffers = &commands;
    ASSERT_EQ(vkQueueSubmit(queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
    {
        std::unique_lock lock(callback.mutex);
        callback.changed.wait(lock, [&] { return callback.called; });
    }
    ofInstance<PFN_vkDestroyDebugUtilsMessengerEXT>("vkDestroyDebugUtilsMessengerEXT")(instance, messenger, nullptr);
    {
        const std::lock_guard lock(callback.mutex);
        callback.destroyed = true;
        callback.changed.notify_all();
    }
    ASSERT_EQ(vkQueueWaitIdle(queue), VK_SUCCESS);
    EXPECT_FALSE(callback.outlived) << "the messenger was destroyed while its callback ran";
}

}  // namespace
}  // namespace vernier::test
