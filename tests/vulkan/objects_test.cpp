// Every kind of object is made and destroyed with allocation callbacks: they are used, they balance, and when
// one of them fails the command says so and leaves nothing behind.
#include <cstdlib>
#include <map>

#include "tests/vulkan/test_device.h"

namespace vernier::test {
namespace {

/// Counts live allocations and fails the allocation number `failAt`.
struct CountingAllocator {
    std::map<void*, size_t> live;
    int made = 0, failAt = -1;

    VkAllocationCallbacks callbacks() {
        VkAllocationCallbacks result{};
        result.pUserData = this;
        result.pfnAllocation = [](void* user, size_t size, size_t alignment, VkSystemAllocationScope) -> void* {
            auto* self = static_cast<CountingAllocator*>(user);
            if (self->made++ == self->failAt) return nullptr;
            const size_t step = std::max(alignment, sizeof(void*));
            void* memory = std::aligned_alloc(step, (size + step - 1) / step * step);
            self->live[memory] = size;
            return memory;
        };
        result.pfnReallocation = [](void*, void*, size_t, size_t, VkSystemAllocationScope) -> void* { return nullptr; };
        result.pfnFree = [](void* user, void* memory) {
            auto* self = static_cast<CountingAllocator*>(user);
            if (memory == nullptr) return;
            EXPECT_EQ(self->live.erase(memory), 1u) << "freed what was not allocated";
            std::free(memory);
        };
        return result;
    }
};

class ObjectsTest : public VulkanTest {
  protected:
    /// Creates with the callbacks, once with each allocation failing and once with none; destroys what was
    /// made.
    template <class Handle, class Create, class Destroy>
    void check(const char* name, Create create, Destroy destroy) {
        SCOPED_TRACE(name);
        for (int failAt = 0;; ++failAt) {
            CountingAllocator allocator;
            allocator.failAt = failAt;
            const VkAllocationCallbacks callbacks = allocator.callbacks();
            Handle handle = VK_NULL_HANDLE;
            const VkResult result = create(&callbacks, &handle);
            if (result == VK_SUCCESS) {
                EXPECT_GT(failAt, 0) << "the callbacks were not used";
                EXPECT_LE(allocator.made, failAt) << "a failed allocation went unnoticed";
                destroy(handle, &callbacks);
                EXPECT_TRUE(allocator.live.empty()) << "not everything was freed";
                destroy(VK_NULL_HANDLE, nullptr);
                return;
            }
            EXPECT_EQ(result, VK_ERROR_OUT_OF_HOST_MEMORY);
            EXPECT_TRUE(allocator.live.empty()) << "a failed creation left memory behind";
            ASSERT_LT(failAt, 64) << "never succeeds";
        }
    }

    /// The same for vkCreate*(device, info, ...) and vkDestroy*(device, ...).
    template <class Handle, class Info>
    void checkPair(const char* name, const Info& info,
                   VkResult (*create)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
                   void (*destroy)(VkDevice, Handle, const VkAllocationCallbacks*)) {
        check<Handle>(
            name, [&](const VkAllocationCallbacks* c, Handle* handle) { return create(device, &info, c, handle); },
            [&](Handle handle, const VkAllocationCallbacks* c) { destroy(device, handle, c); });
    }
};

TEST_F(ObjectsTest, memoryBuffersAndImages) {
    auto memory = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    memory.allocationSize = 4096;
    checkPair<VkDeviceMemory>("memory", memory, vkAllocateMemory, vkFreeMemory);
    auto buffer = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    buffer.size = 100;
    buffer.usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    checkPair<VkBuffer>("buffer", buffer, vkCreateBuffer, vkDestroyBuffer);
    auto image = make<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    image.imageType = VK_IMAGE_TYPE_2D;
    image.format = VK_FORMAT_R8G8B8A8_UNORM;
    image.extent = {16, 16, 1};
    image.mipLevels = 5;
    image.arrayLayers = 3;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    image.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    checkPair<VkImage>("image", image, vkCreateImage, vkDestroyImage);
    const TestImage existing = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 8}, VK_IMAGE_USAGE_SAMPLED_BIT);
    auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = existing.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = existing.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    checkPair<VkImageView>("image view", view, vkCreateImageView, vkDestroyImageView);
    const auto sampler = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    checkPair<VkSampler>("sampler", sampler, vkCreateSampler, vkDestroySampler);
}

TEST_F(ObjectsTest, synchronisationAndQueries) {
    checkPair<VkFence>("fence", make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO), vkCreateFence,
                       vkDestroyFence);
    checkPair<VkSemaphore>("semaphore", make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO),
                           vkCreateSemaphore, vkDestroySemaphore);
    checkPair<VkEvent>("event", make<VkEventCreateInfo>(VK_STRUCTURE_TYPE_EVENT_CREATE_INFO), vkCreateEvent,
                       vkDestroyEvent);
    auto queries = make<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    queries.queryType = VK_QUERY_TYPE_OCCLUSION;
    queries.queryCount = 3;
    checkPair<VkQueryPool>("query pool", queries, vkCreateQueryPool, vkDestroyQueryPool);
}

TEST_F(ObjectsTest, descriptorsAndPipelineParts) {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2, VK_SHADER_STAGE_ALL, nullptr};
    auto layout = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layout.bindingCount = 1;
    layout.pBindings = &binding;
    checkPair<VkDescriptorSetLayout>("set layout", layout, vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 4};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 2;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    checkPair<VkDescriptorPool>("descriptor pool", poolInfo, vkCreateDescriptorPool, vkDestroyDescriptorPool);
    checkPair<VkPipelineLayout>("pipeline layout",
                                make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO),
                                vkCreatePipelineLayout, vkDestroyPipelineLayout);
    checkPair<VkPipelineCache>("pipeline cache",
                               make<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO),
                               vkCreatePipelineCache, vkDestroyPipelineCache);
    auto commandPool = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    checkPair<VkCommandPool>("command pool", commandPool, vkCreateCommandPool, vkDestroyCommandPool);
    const auto words = compileGlsl(VK_SHADER_STAGE_VERTEX_BIT, "#version 450\nvoid main() { gl_Position = vec4(0); }");
    auto module = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    module.codeSize = words.size() * 4;
    module.pCode = words.data();
    checkPair<VkShaderModule>("shader module", module, vkCreateShaderModule, vkDestroyShaderModule);
    VkSubpassDescription subpass{};
    auto pass = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    pass.subpassCount = 1;
    pass.pSubpasses = &subpass;
    checkPair<VkRenderPass>("render pass", pass, vkCreateRenderPass, vkDestroyRenderPass);
}

TEST_F(ObjectsTest, poolsGiveOutNoMoreThanTheyHave) {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2, VK_SHADER_STAGE_ALL, nullptr};
    auto layoutInfo = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layoutInfo.bindingCount = 1;
    layoutInfo.pBindings = &binding;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorSetLayout(device, &layoutInfo, nullptr, &layout), VK_SUCCESS);
    CountingAllocator allocator;
    const VkAllocationCallbacks callbacks = allocator.callbacks();
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 5};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    poolInfo.maxSets = 3;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorPool(device, &poolInfo, &callbacks, &descriptors), VK_SUCCESS);
    auto info = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    const VkDescriptorSetLayout layouts[] = {layout, layout, layout};
    info.descriptorPool = descriptors;
    info.descriptorSetCount = 2;
    info.pSetLayouts = layouts;
    VkDescriptorSet sets[3] = {};
    ASSERT_EQ(vkAllocateDescriptorSets(device, &info, sets), VK_SUCCESS);
    vkDestroyDescriptorSetLayout(device, layout, nullptr);  // sets do not need it any more
    ASSERT_EQ(vkFreeDescriptorSets(device, descriptors, 1, sets), VK_SUCCESS);
    ASSERT_EQ(vkResetDescriptorPool(device, descriptors, 0), VK_SUCCESS);
    vkDestroyDescriptorPool(device, descriptors, &callbacks);
    EXPECT_TRUE(allocator.live.empty());
}

TEST_F(ObjectsTest, outOfPoolMemoryLeavesNothingAllocated) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2, VK_SHADER_STAGE_ALL, nullptr};
    auto layoutInfo = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layoutInfo.bindingCount = 1;
    layoutInfo.pBindings = &binding;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorSetLayout(device, &layoutInfo, nullptr, &layout), VK_SUCCESS);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 3};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 2;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorPool(device, &poolInfo, nullptr, &descriptors), VK_SUCCESS);
    auto info = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    const VkDescriptorSetLayout layouts[] = {layout, layout};
    info.descriptorPool = descriptors;
    info.descriptorSetCount = 2;
    info.pSetLayouts = layouts;
    VkDescriptorSet sets[2] = {};
    EXPECT_EQ(vkAllocateDescriptorSets(device, &info, sets), VK_ERROR_OUT_OF_POOL_MEMORY);
    EXPECT_EQ(sets[0], VkDescriptorSet{VK_NULL_HANDLE});
    info.descriptorSetCount = 1;
    EXPECT_EQ(vkAllocateDescriptorSets(device, &info, sets), VK_SUCCESS) << "the failed call gave everything back";
    vkDestroyDescriptorPool(device, descriptors, nullptr);
    vkDestroyDescriptorSetLayout(device, layout, nullptr);
}

TEST_F(ObjectsTest, bindingOutsideMemoryIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = 4096;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateBuffer(device, &info, nullptr, &buffer), VK_SUCCESS);
    auto allocation = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize = 4096;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    ASSERT_EQ(vkAllocateMemory(device, &allocation, nullptr, &memory), VK_SUCCESS);
    EXPECT_NE(vkBindBufferMemory(device, buffer, memory, 64), VK_SUCCESS);
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages.back().find("memoryOffset 64"), std::string::npos) << messages.back();
    EXPECT_EQ(vkBindBufferMemory(device, buffer, memory, 0), VK_SUCCESS);
    vkDestroyBuffer(device, buffer, nullptr);
    vkFreeMemory(device, memory, nullptr);
}

TEST_F(ObjectsTest, pipelineCacheHasAValidHeader) {
    const auto info = make<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    VkPipelineCache cache = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreatePipelineCache(device, &info, nullptr, &cache), VK_SUCCESS);
    size_t size = 0;
    ASSERT_EQ(vkGetPipelineCacheData(device, cache, &size, nullptr), VK_SUCCESS);
    ASSERT_EQ(size, sizeof(VkPipelineCacheHeaderVersionOne));
    VkPipelineCacheHeaderVersionOne header{};
    size_t small = size - 1;
    EXPECT_EQ(vkGetPipelineCacheData(device, cache, &small, &header), VK_INCOMPLETE);
    EXPECT_EQ(small, 0u);
    ASSERT_EQ(vkGetPipelineCacheData(device, cache, &size, &header), VK_SUCCESS);
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physicalDevice, &properties);
    EXPECT_EQ(header.headerVersion, VK_PIPELINE_CACHE_HEADER_VERSION_ONE);
    EXPECT_EQ(header.vendorID, properties.vendorID);
    EXPECT_EQ(memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE), 0);
    vkDestroyPipelineCache(device, cache, nullptr);
}

}  // namespace
}  // namespace vernier::test
