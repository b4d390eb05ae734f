// Memory runs out at every allocation of a small Vulkan program, one after the other, once for a moment and once for
// good: the command says so, and destroying what was made gives everything back. The driver is loaded without the
// loader, which is not under test; malloc is replaced, for the driver brings its own C++ library.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "tests/vulkan/failing_malloc.h"
#include "tests/vulkan/pipeline_states.h"

namespace vernier::test {
namespace {

/// Every command of the program, by name.
// Formatting would move every line further in than the one before.
// clang-format off
#define VERNIER_COMMANDS(X) \
    X(EnumeratePhysicalDevices) X(CreateDevice) X(DestroyInstance) X(DestroyDevice) X(GetDeviceQueue) \
    X(CreateBuffer) X(DestroyBuffer) X(GetBufferMemoryRequirements) X(AllocateMemory) X(FreeMemory) \
    X(BindBufferMemory) X(MapMemory) X(CreateImage) X(DestroyImage) X(GetImageMemoryRequirements) X(BindImageMemory) \
    X(CreateImageView) X(DestroyImageView) X(CreateShaderModule) X(DestroyShaderModule) X(CreateRenderPass) \
    X(DestroyRenderPass) X(CreateFramebuffer) X(DestroyFramebuffer) X(CreatePipelineLayout) X(DestroyPipelineLayout) \
    X(CreateGraphicsPipelines) X(DestroyPipeline) X(CreateDescriptorSetLayout) X(DestroyDescriptorSetLayout) \
    X(CreateDescriptorPool) X(DestroyDescriptorPool) X(AllocateDescriptorSets) X(UpdateDescriptorSets) \
    X(CreateCommandPool) X(DestroyCommandPool) X(AllocateCommandBuffers) X(BeginCommandBuffer) X(EndCommandBuffer) \
    X(CmdBeginRenderPass) X(CmdBindPipeline) X(CmdBindDescriptorSets) X(CmdDraw) X(CmdEndRenderPass) \
    X(CmdCopyImageToBuffer) X(CmdFillBuffer) X(CreateFence) X(DestroyFence) X(QueueSubmit) X(WaitForFences) \
    X(DeviceWaitIdle) X(CreateHeadlessSurfaceEXT) X(DestroySurfaceKHR) X(GetPhysicalDeviceSurfaceFormatsKHR) \
    X(CreateSwapchainKHR) X(DestroySwapchainKHR) X(GetSwapchainImagesKHR) X(AcquireNextImageKHR) X(QueuePresentKHR)
// clang-format on

PFN_vkGetInstanceProcAddr getProc = nullptr;

struct Api {
    explicit Api(VkInstance instance) {
#define VERNIER_LOAD(name) name = reinterpret_cast<PFN_vk##name>(getProc(instance, "vk" #name));
        VERNIER_COMMANDS(VERNIER_LOAD)
#undef VERNIER_LOAD
    }
#define VERNIER_MEMBER(name) PFN_vk##name name = nullptr;
    VERNIER_COMMANDS(VERNIER_MEMBER)
#undef VERNIER_MEMBER
};

std::vector<uint32_t> compile(VkShaderStageFlagBits stage, const char* source) {
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = source;
    desc.target = VN_GLSL_TARGET_VULKAN_1_0;
    VnGlslOutput* output = nullptr;
    EXPECT_EQ(vnCompileGlsl(&desc, &output), VN_GLSL_SUCCESS);
    std::vector<uint32_t> words(output->words, output->words + output->wordCount);
    vnFreeGlslOutput(output);
    return words;
}

struct Parts {
    std::vector<uint32_t> vertex = compile(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1), 0.5, 1);
})");
    std::vector<uint32_t> fragment = compile(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(set = 0, binding = 0) uniform Block { vec4 tint; };
layout(location = 0) out vec4 color;
void main() { color = tint; })");
};

constexpr uint32_t kSize = 70;  // more than one tile

struct Outcome {
    VkResult result = VK_SUCCESS;
    bool drawn = false;
    bool inShader = false;  // it failed in vkCreateShaderModule
};

class SmallProgram {
  public:
    explicit SmallProgram(const Parts& parts) : parts_(parts) {}

    Outcome operator()() {
        Outcome outcome;
        outcome.result = all();
        outcome.inShader = inShader_;
        if (outcome.result == VK_SUCCESS) {
            const auto* pixels = static_cast<const uint32_t*>(mapped_);
            outcome.drawn = true;
            for (uint32_t i = 0; i < kSize * kSize; ++i) outcome.drawn = outcome.drawn && pixels[i] == 0xFFFFFFFFu;
        }
        destroy();
        return outcome;
    }

    /// Presents an image twice in one command, which refuses the second, until there is memory enough to say so. What
    /// fails for want of memory leaves the image acquired.
    void presentWithoutMemory() {
        ASSERT_EQ(all(), VK_SUCCESS);
        uint32_t index = 0;
        VkResult results[2] = {};
        const VkSwapchainKHR swapchains[2] = {swapchain_, swapchain_};
        VkResult result = VK_ERROR_OUT_OF_HOST_MEMORY;
        int64_t failures = -1;
        while (result == VK_ERROR_OUT_OF_HOST_MEMORY) {
            ASSERT_EQ(acquire(&index), VK_SUCCESS);
            ASSERT_EQ(api_.DeviceWaitIdle(device_), VK_SUCCESS);
            const uint32_t indices[2] = {index, index};
            auto twice = make<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
            twice.swapchainCount = 2;
            twice.pSwapchains = swapchains;
            twice.pImageIndices = indices;
            twice.pResults = results;
            countdown = ++failures;
            armed = true;
            result = api_.QueuePresentKHR(queue_, &twice);
            armed = false;
            if (result == VK_ERROR_OUT_OF_HOST_MEMORY) {
                ASSERT_EQ(show(index), VK_SUCCESS) << failures;
            }
        }
        // What fails next is in the queue, whose device is lost then.
        EXPECT_THAT(result, testing::AnyOf(VK_ERROR_UNKNOWN, VK_ERROR_DEVICE_LOST));
        EXPECT_EQ(results[0], VK_SUCCESS);
        EXPECT_EQ(results[1], VK_ERROR_UNKNOWN);
        EXPECT_GT(failures, 3);
        destroy();
    }

  private:
#define TRY(call) \
    if (const VkResult tried = (call); tried != VK_SUCCESS) return tried
    VkResult all() {
        const auto create = reinterpret_cast<PFN_vkCreateInstance>(getProc(nullptr, "vkCreateInstance"));
        auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
        const char* const surfaces[] = {VK_KHR_SURFACE_EXTENSION_NAME, VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME};
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = surfaces;
        TRY(create(&info, nullptr, &instance_));
        api_ = Api(instance_);
        uint32_t count = 1;
        VkPhysicalDevice physical = nullptr;
        TRY(api_.EnumeratePhysicalDevices(instance_, &count, &physical));
        const float priority = 1;
        auto queue = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        auto device = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
        device.queueCreateInfoCount = 1;
        device.pQueueCreateInfos = &queue;
        const char* const swapchains[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
        device.enabledExtensionCount = 1;
        device.ppEnabledExtensionNames = swapchains;
        TRY(api_.CreateDevice(physical, &device, nullptr, &device_));
        api_.GetDeviceQueue(device_, 0, 0, &queue_);
        TRY(makeResources());
        TRY(makePass());
        TRY(makePipeline());
        TRY(draw());
        return present(physical);
    }

    VkResult allocate(const VkMemoryRequirements& needs, VkDeviceMemory* memory) {
        auto info = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        info.allocationSize = needs.size;
        return api_.AllocateMemory(device_, &info, nullptr, memory);
    }

    VkResult makeBuffer(VkDeviceSize size, VkBufferUsageFlags usage, VkBuffer* buffer, VkDeviceMemory* memory,
                        void** data) {
        auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        info.size = size;
        info.usage = usage;
        TRY(api_.CreateBuffer(device_, &info, nullptr, buffer));
        VkMemoryRequirements needs{};
        api_.GetBufferMemoryRequirements(device_, *buffer, &needs);
        TRY(allocate(needs, memory));
        TRY(api_.BindBufferMemory(device_, *buffer, *memory, 0));
        return api_.MapMemory(device_, *memory, 0, VK_WHOLE_SIZE, 0, data);
    }

    VkResult makeResources() {
        void* tint = nullptr;
        TRY(makeBuffer(kSize * kSize * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, &result_, &resultMemory_, &mapped_));
        TRY(makeBuffer(16, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, &tint_, &tintMemory_, &tint));
        const float white[4] = {1, 1, 1, 1};
        std::memcpy(tint, white, sizeof white);
        const auto info = flatImage(VK_FORMAT_R8G8B8A8_UNORM, {kSize, kSize},
                                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        TRY(api_.CreateImage(device_, &info, nullptr, &image_));
        VkMemoryRequirements needs{};
        api_.GetImageMemoryRequirements(device_, image_, &needs);
        TRY(allocate(needs, &imageMemory_));
        TRY(api_.BindImageMemory(device_, image_, imageMemory_, 0));
        auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
        view.image = image_;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = info.format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        return api_.CreateImageView(device_, &view, nullptr, &view_);
    }

    VkResult makePass() {
        VkAttachmentDescription attachment{};
        attachment.format = VK_FORMAT_R8G8B8A8_UNORM;
        attachment.samples = VK_SAMPLE_COUNT_1_BIT;
        attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        attachment.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &color;
        auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        info.attachmentCount = info.subpassCount = 1;
        info.pAttachments = &attachment;
        info.pSubpasses = &subpass;
        TRY(api_.CreateRenderPass(device_, &info, nullptr, &pass_));
        auto framebuffer = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
        framebuffer.renderPass = pass_;
        framebuffer.attachmentCount = 1;
        framebuffer.pAttachments = &view_;
        framebuffer.width = framebuffer.height = kSize;
        framebuffer.layers = 1;
        return api_.CreateFramebuffer(device_, &framebuffer, nullptr, &framebuffer_);
    }

    VkResult makeModule(const std::vector<uint32_t>& words, VkShaderModule* module) {
        auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = words.size() * 4;
        info.pCode = words.data();
        const VkResult result = api_.CreateShaderModule(device_, &info, nullptr, module);
        inShader_ = result != VK_SUCCESS;
        return result;
    }

    VkResult makeLayouts() {
        const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL,
                                                   nullptr};
        auto set = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
        set.bindingCount = 1;
        set.pBindings = &binding;
        TRY(api_.CreateDescriptorSetLayout(device_, &set, nullptr, &setLayout_));
        auto layout = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &setLayout_;
        TRY(api_.CreatePipelineLayout(device_, &layout, nullptr, &layout_));
        const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1};
        auto pool = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
        pool.maxSets = pool.poolSizeCount = 1;
        pool.pPoolSizes = &size;
        TRY(api_.CreateDescriptorPool(device_, &pool, nullptr, &descriptors_));
        auto allocate = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        allocate.descriptorPool = descriptors_;
        allocate.descriptorSetCount = 1;
        allocate.pSetLayouts = &setLayout_;
        TRY(api_.AllocateDescriptorSets(device_, &allocate, &set_));
        const VkDescriptorBufferInfo buffer{tint_, 0, VK_WHOLE_SIZE};
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set_;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        write.pBufferInfo = &buffer;
        api_.UpdateDescriptorSets(device_, 1, &write, 0, nullptr);
        return VK_SUCCESS;
    }

    VkResult makePipeline() {
        TRY(makeLayouts());
        TRY(makeModule(parts_.vertex, &vertex_));
        TRY(makeModule(parts_.fragment, &fragment_));
        const VkPipelineShaderStageCreateInfo stages[] = {stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex_),
                                                          stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment_)};
        const PlainStates states({kSize, kSize});
        auto info = states.with(stages, layout_, pass_);
        TRY(api_.CreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &whole_));
        // The same again, from libraries of both sides of the rasteriser.
        auto parts =
            make<VkGraphicsPipelineLibraryCreateInfoEXT>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_LIBRARY_CREATE_INFO_EXT);
        for (size_t n = 0; n < libraries_.size(); ++n) {
            parts.flags = n == 0 ? VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT |
                                       VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT
                                 : VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT |
                                       VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT;
            info.pNext = &parts;
            info.flags = VK_PIPELINE_CREATE_LIBRARY_BIT_KHR;
            TRY(api_.CreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &libraries_[n]));
        }
        auto linked = make<VkPipelineLibraryCreateInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_LIBRARY_CREATE_INFO_KHR);
        linked.libraryCount = static_cast<uint32_t>(libraries_.size());
        linked.pLibraries = libraries_.data();
        info.pNext = &linked;
        info.flags = 0;
        return api_.CreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    }

    VkResult draw() {
        const auto pool = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        TRY(api_.CreateCommandPool(device_, &pool, nullptr, &commands_));
        auto allocate = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        allocate.commandPool = commands_;
        allocate.commandBufferCount = 1;
        VkCommandBuffer commands = nullptr;
        TRY(api_.AllocateCommandBuffers(device_, &allocate, &commands));
        const auto begin = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        TRY(api_.BeginCommandBuffer(commands, &begin));
        api_.CmdFillBuffer(commands, result_, 0, VK_WHOLE_SIZE, 0);
        const VkClearValue clear{};
        auto pass = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
        pass.renderPass = pass_;
        pass.framebuffer = framebuffer_;
        pass.renderArea.extent = {kSize, kSize};
        pass.clearValueCount = 1;
        pass.pClearValues = &clear;
        api_.CmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
        api_.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
        api_.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
        for (uint32_t n = 0; n < 300; ++n) api_.CmdDraw(commands, 3, 1, 0, 0);
        api_.CmdEndRenderPass(commands);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = {kSize, kSize, 1};
        api_.CmdCopyImageToBuffer(commands, image_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, result_, 1, &copy);
        TRY(api_.EndCommandBuffer(commands));
        const auto fence = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        TRY(api_.CreateFence(device_, &fence, nullptr, &fence_));
        auto submit = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &commands;
        TRY(api_.QueueSubmit(queue_, 1, &submit, fence_));
        return api_.WaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX);
    }

    /// Shows an image of a swapchain, as it is.
    VkResult present(VkPhysicalDevice physical) {
        const auto headless = make<VkHeadlessSurfaceCreateInfoEXT>(VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT);
        TRY(api_.CreateHeadlessSurfaceEXT(instance_, &headless, nullptr, &surface_));
        uint32_t count = 1;
        VkSurfaceFormatKHR format{};
        const VkResult listed = api_.GetPhysicalDeviceSurfaceFormatsKHR(physical, surface_, &count, &format);
        if (listed != VK_SUCCESS && listed != VK_INCOMPLETE) return listed;
        auto info = make<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
        info.surface = surface_;
        info.minImageCount = 3;
        info.imageFormat = format.format;
        info.imageExtent = {kSize, kSize};
        info.imageArrayLayers = 1;
        info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
        info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
        info.presentMode = VK_PRESENT_MODE_IMMEDIATE_KHR;
        TRY(api_.CreateSwapchainKHR(device_, &info, nullptr, &swapchain_));
        for (int frame = 0; frame < 4; ++frame) {
            uint32_t index = 0;
            TRY(acquire(&index));
            TRY(show(index));
        }
        return VK_SUCCESS;
    }
    VkResult acquire(uint32_t* index) {
        return api_.AcquireNextImageKHR(device_, swapchain_, UINT64_MAX, VK_NULL_HANDLE, VK_NULL_HANDLE, index);
    }
    VkResult show(uint32_t index) {
        auto shown = make<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
        shown.swapchainCount = 1;
        shown.pSwapchains = &swapchain_;
        shown.pImageIndices = &index;
        return api_.QueuePresentKHR(queue_, &shown);
    }
#undef TRY

    void destroy() {
        if (!instance_) return;
        if (device_) {
            api_.DeviceWaitIdle(device_);
            api_.DestroySwapchainKHR(device_, swapchain_, nullptr);
            api_.DestroyFence(device_, fence_, nullptr);
            api_.DestroyCommandPool(device_, commands_, nullptr);
            for (const VkPipeline pipeline : {pipeline_, whole_, libraries_[0], libraries_[1]})
                api_.DestroyPipeline(device_, pipeline, nullptr);
            api_.DestroyShaderModule(device_, vertex_, nullptr);
            api_.DestroyShaderModule(device_, fragment_, nullptr);
            api_.DestroyDescriptorPool(device_, descriptors_, nullptr);
            api_.DestroyPipelineLayout(device_, layout_, nullptr);
            api_.DestroyDescriptorSetLayout(device_, setLayout_, nullptr);
            api_.DestroyFramebuffer(device_, framebuffer_, nullptr);
            api_.DestroyRenderPass(device_, pass_, nullptr);
            api_.DestroyImageView(device_, view_, nullptr);
            api_.DestroyImage(device_, image_, nullptr);
            for (const VkBuffer buffer : {result_, tint_}) api_.DestroyBuffer(device_, buffer, nullptr);
            for (const VkDeviceMemory memory : {resultMemory_, tintMemory_, imageMemory_})
                api_.FreeMemory(device_, memory, nullptr);
            api_.DestroyDevice(device_, nullptr);
        }
        api_.DestroySurfaceKHR(instance_, surface_, nullptr);
        api_.DestroyInstance(instance_, nullptr);
    }

    const Parts& parts_;
    Api api_{nullptr};
    VkInstance instance_ = nullptr;
    VkDevice device_ = nullptr;
    VkQueue queue_ = nullptr;
    VkBuffer result_ = VK_NULL_HANDLE, tint_ = VK_NULL_HANDLE;
    VkDeviceMemory resultMemory_ = VK_NULL_HANDLE, tintMemory_ = VK_NULL_HANDLE, imageMemory_ = VK_NULL_HANDLE;
    void* mapped_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkShaderModule vertex_ = VK_NULL_HANDLE, fragment_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE, whole_ = VK_NULL_HANDLE;
    std::array<VkPipeline, 2> libraries_{};
    VkCommandPool commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    bool inShader_ = false;
};

class MemoryFailure : public testing::TestWithParam<bool> {
  protected:
    static void SetUpTestSuite() {
        ASSERT_TRUE(findDynamicLinker());
        setenv("VERNIER_THREADS", "3", 1);
        void* library = dlopen(VERNIER_ICD_LIBRARY, RTLD_NOW | RTLD_LOCAL);
        ASSERT_NE(library, nullptr) << dlerror();
        getProc = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vk_icdGetInstanceProcAddr"));
        ASSERT_NE(getProc, nullptr);
    }
};

TEST_P(MemoryFailure, AtEveryAllocation) {
    const Parts parts;
    EXPECT_TRUE(SmallProgram(parts)().drawn);  // what is made once for the process is made now
    forGood = GetParam();
    constexpr int64_t kMost = int64_t{1} << 40, kStride = 5;
    countdown = kMost;
    armed = true;
    const bool drawn = SmallProgram(parts)().drawn;
    armed = false;
    EXPECT_TRUE(drawn);
    const int64_t total = kMost - countdown.load();
    ASSERT_GT(total, 500);
    int64_t failures = 0;
    for (int64_t n = 0; n < total; n += kStride) {
        const std::string where = "allocation " + std::to_string(n) + " of " + std::to_string(total);
        const int64_t before = live.load();
        countdown = n;
        armed = true;
        const Outcome outcome = SmallProgram(parts)();
        armed = false;
        // SPIRV-Tools is built without exceptions: what it holds while one passes through it is lost.
        if (!outcome.inShader) {
            ASSERT_LE(live.load(), before) << where << " left blocks behind";
        }
        failures += outcome.result != VK_SUCCESS;
        if (outcome.result == VK_SUCCESS) {
            ASSERT_TRUE(outcome.drawn) << where;
        } else {
            ASSERT_THAT(outcome.result, testing::AnyOf(VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY,
                                                       VK_ERROR_DEVICE_LOST))
                << where;
        }
    }
    EXPECT_GT(failures, total / kStride * 8 / 10);
}

TEST_P(MemoryFailure, PresentsAllOrNothing) {
    const Parts parts;
    forGood = GetParam();
    SmallProgram(parts).presentWithoutMemory();
}

INSTANTIATE_TEST_SUITE_P(Memory, MemoryFailure, testing::Values(false, true),
                         [](const auto& param) { return param.param ? "ForGood" : "ForAMoment"; });

}  // namespace
}  // namespace vernier::test
