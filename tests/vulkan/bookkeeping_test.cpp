// Questions and bookkeeping that Vulkan 1.3 made core: private data, tools, requirements of what does not exist yet,
// formats in 64 bits, how long pipelines took, synchronisation with 64-bit flags.
#include <array>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class BookkeepingTest : public ComputeTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_PRIVATE_DATA_EXTENSION_NAME,
                VK_EXT_TOOLING_INFO_EXTENSION_NAME,
                VK_KHR_MAINTENANCE_4_EXTENSION_NAME,
                VK_KHR_FORMAT_FEATURE_FLAGS_2_EXTENSION_NAME,
                VK_EXT_PIPELINE_CREATION_FEEDBACK_EXTENSION_NAME,
                VK_EXT_PIPELINE_CREATION_CACHE_CONTROL_EXTENSION_NAME,
                VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME,
                VK_EXT_TEXEL_BUFFER_ALIGNMENT_EXTENSION_NAME,
                VK_KHR_ZERO_INITIALIZE_WORKGROUP_MEMORY_EXTENSION_NAME,
                VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME,
                VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME,
                VK_EXT_SHADER_SUBGROUP_BALLOT_EXTENSION_NAME,
                VK_EXT_SHADER_SUBGROUP_VOTE_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        private_.privateData = maintenance_.maintenance4 = cache_.pipelineCreationCacheControl = VK_TRUE;
        subgroups_.subgroupSizeControl = subgroups_.computeFullSubgroups = VK_TRUE;
        alignment_.texelBufferAlignment = zero_.shaderZeroInitializeWorkgroupMemory = sync_.synchronization2 = VK_TRUE;
        private_.pNext = &maintenance_;
        maintenance_.pNext = &cache_;
        cache_.pNext = &subgroups_;
        subgroups_.pNext = &alignment_;
        alignment_.pNext = &zero_;
        zero_.pNext = &sync_;
        return &private_;
    }

  private:
    VkPhysicalDevicePrivateDataFeatures private_ =
        make<VkPhysicalDevicePrivateDataFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PRIVATE_DATA_FEATURES);
    VkPhysicalDeviceMaintenance4Features maintenance_ =
        make<VkPhysicalDeviceMaintenance4Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES);
    VkPhysicalDevicePipelineCreationCacheControlFeatures cache_ =
        make<VkPhysicalDevicePipelineCreationCacheControlFeatures>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_CREATION_CACHE_CONTROL_FEATURES);
    VkPhysicalDeviceSubgroupSizeControlFeatures subgroups_ = make<VkPhysicalDeviceSubgroupSizeControlFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES);
    VkPhysicalDeviceTexelBufferAlignmentFeaturesEXT alignment_ = make<VkPhysicalDeviceTexelBufferAlignmentFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TEXEL_BUFFER_ALIGNMENT_FEATURES_EXT);
    VkPhysicalDeviceZeroInitializeWorkgroupMemoryFeatures zero_ =
        make<VkPhysicalDeviceZeroInitializeWorkgroupMemoryFeatures>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ZERO_INITIALIZE_WORKGROUP_MEMORY_FEATURES);
    VkPhysicalDeviceSynchronization2Features sync_ =
        make<VkPhysicalDeviceSynchronization2Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES);
};

// A number per object and slot; a new object starts with none, wherever it lies.
TEST_F(BookkeepingTest, privateDataStaysWithItsObject) {
    const auto create = command<PFN_vkCreatePrivateDataSlotEXT>("vkCreatePrivateDataSlotEXT");
    const auto destroy = command<PFN_vkDestroyPrivateDataSlotEXT>("vkDestroyPrivateDataSlotEXT");
    const auto set = command<PFN_vkSetPrivateDataEXT>("vkSetPrivateDataEXT");
    const auto get = command<PFN_vkGetPrivateDataEXT>("vkGetPrivateDataEXT");
    const auto info = make<VkPrivateDataSlotCreateInfo>(VK_STRUCTURE_TYPE_PRIVATE_DATA_SLOT_CREATE_INFO);
    std::array<VkPrivateDataSlot, 2> slots{};
    for (VkPrivateDataSlot& slot : slots) ASSERT_EQ(create(device, &info, nullptr, &slot), VK_SUCCESS);
    const auto read = [&](VkObjectType type, uint64_t object, uint32_t slot) {
        uint64_t value = ~uint64_t{0};
        get(device, type, object, slots[slot], &value);
        return value;
    };
    const auto handle = [](auto object) { return reinterpret_cast<uint64_t>(object); };
    const auto fenceInfo = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    for (int round = 0; round < 50; ++round) {
        std::array<VkFence, 3> fences{};
        for (VkFence& fence : fences) {
            ASSERT_EQ(vkCreateFence(device, &fenceInfo, nullptr, &fence), VK_SUCCESS);
            for (const uint32_t slot : {0u, 1u}) EXPECT_EQ(read(VK_OBJECT_TYPE_FENCE, handle(fence), slot), 0u);
        }
        for (uint32_t n = 0; n < 3; ++n)
            ASSERT_EQ(set(device, VK_OBJECT_TYPE_FENCE, handle(fences[n]), slots[n % 2], n + 10), VK_SUCCESS);
        EXPECT_EQ(read(VK_OBJECT_TYPE_FENCE, handle(fences[0]), 0), 10u);
        EXPECT_EQ(read(VK_OBJECT_TYPE_FENCE, handle(fences[0]), 1), 0u);
        EXPECT_EQ(read(VK_OBJECT_TYPE_FENCE, handle(fences[1]), 1), 11u);
        for (const VkFence fence : fences) vkDestroyFence(device, fence, nullptr);
    }
    // Objects that the driver makes in its own ways.
    const VkCommandBuffer commands = begin();
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    for (const auto& [type, object] :
         {std::pair{VK_OBJECT_TYPE_QUEUE, handle(queue)}, std::pair{VK_OBJECT_TYPE_DEVICE, handle(device)},
          std::pair{VK_OBJECT_TYPE_COMMAND_BUFFER, handle(commands)}}) {
        ASSERT_EQ(set(device, type, object, slots[0], 77), VK_SUCCESS);
        EXPECT_EQ(read(type, object, 0), 77u);
    }
    destroy(device, slots[0], nullptr);
    ASSERT_EQ(create(device, &info, nullptr, &slots[0]), VK_SUCCESS);
    EXPECT_EQ(read(VK_OBJECT_TYPE_DEVICE, handle(device), 0), 0u);
    for (const VkPrivateDataSlot slot : slots) destroy(device, slot, nullptr);
}

TEST_F(BookkeepingTest, theDriverIsNoTool) {
    const auto tools = reinterpret_cast<PFN_vkGetPhysicalDeviceToolPropertiesEXT>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceToolPropertiesEXT"));
    ASSERT_NE(tools, nullptr);
    uint32_t count = 99;
    ASSERT_EQ(tools(physicalDevice, &count, nullptr), VK_SUCCESS);
    EXPECT_EQ(count, validated() ? 1u : 0u);
}

TEST_F(BookkeepingTest, requirementsOfWhatDoesNotExistYet) {
    auto bufferInfo = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    bufferInfo.size = 1234;
    bufferInfo.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateBuffer(device, &bufferInfo, nullptr, &buffer), VK_SUCCESS);
    VkMemoryRequirements made{};
    vkGetBufferMemoryRequirements(device, buffer, &made);
    vkDestroyBuffer(device, buffer, nullptr);
    auto about = make<VkDeviceBufferMemoryRequirements>(VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS);
    about.pCreateInfo = &bufferInfo;
    auto told = make<VkMemoryRequirements2>(VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2);
    command<PFN_vkGetDeviceBufferMemoryRequirementsKHR>("vkGetDeviceBufferMemoryRequirementsKHR")(device, &about,
                                                                                                  &told);
    EXPECT_EQ(told.memoryRequirements.size, made.size);
    EXPECT_EQ(told.memoryRequirements.alignment, made.alignment);

    auto imageInfo = flatImage(VK_FORMAT_R8G8B8A8_UNORM, {100, 50}, VK_IMAGE_USAGE_SAMPLED_BIT);
    imageInfo.mipLevels = 3;
    imageInfo.arrayLayers = 2;
    VkImage image = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateImage(device, &imageInfo, nullptr, &image), VK_SUCCESS);
    vkGetImageMemoryRequirements(device, image, &made);
    vkDestroyImage(device, image, nullptr);
    auto aboutImage = make<VkDeviceImageMemoryRequirements>(VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS);
    aboutImage.pCreateInfo = &imageInfo;
    command<PFN_vkGetDeviceImageMemoryRequirementsKHR>("vkGetDeviceImageMemoryRequirementsKHR")(device, &aboutImage,
                                                                                                &told);
    EXPECT_EQ(told.memoryRequirements.size, made.size);
    uint32_t count = 5;
    command<PFN_vkGetDeviceImageSparseMemoryRequirementsKHR>("vkGetDeviceImageSparseMemoryRequirementsKHR")(
        device, &aboutImage, &count, nullptr);
    EXPECT_EQ(count, 0u);
    EXPECT_GE(
        properties<VkPhysicalDeviceMaintenance4Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES)
            .maxBufferSize,
        VkDeviceSize{1} << 30);
}

TEST_F(BookkeepingTest, formatsInSixtyFourBits) {
    const auto ask = [&](VkFormat format) {
        auto wide = make<VkFormatProperties3>(VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3);
        auto properties = make<VkFormatProperties2>(VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2, &wide);
        vkGetPhysicalDeviceFormatProperties2(physicalDevice, format, &properties);
        EXPECT_EQ(wide.optimalTilingFeatures & 0x7FFFFFFF, properties.formatProperties.optimalTilingFeatures);
        EXPECT_EQ(wide.linearTilingFeatures & 0x7FFFFFFF, properties.formatProperties.linearTilingFeatures);
        EXPECT_EQ(wide.bufferFeatures & 0x7FFFFFFF, properties.formatProperties.bufferFeatures);
        return wide;
    };
    constexpr VkFormatFeatureFlags2 kWithoutFormat =
        VK_FORMAT_FEATURE_2_STORAGE_READ_WITHOUT_FORMAT_BIT | VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;
    EXPECT_EQ(ask(VK_FORMAT_R32_UINT).optimalTilingFeatures & kWithoutFormat, kWithoutFormat);
    EXPECT_EQ(ask(VK_FORMAT_R8G8B8A8_SRGB).optimalTilingFeatures & kWithoutFormat, 0u);
    constexpr VkFormatFeatureFlags2 kCompare = VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_DEPTH_COMPARISON_BIT;
    EXPECT_EQ(ask(VK_FORMAT_D32_SFLOAT).optimalTilingFeatures & kCompare, kCompare);
    EXPECT_EQ(ask(VK_FORMAT_R32_SFLOAT).optimalTilingFeatures & kCompare, 0u);
    EXPECT_EQ(ask(VK_FORMAT_S8_UINT).optimalTilingFeatures & kCompare, 0u);
}

TEST_F(BookkeepingTest, pipelinesTellOfTheirMaking) {
    auto info = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = makeShader(VK_SHADER_STAGE_COMPUTE_BIT, "#version 450\nvoid main() {}");
    info.stage.pName = "main";
    info.layout = makeLayout({}, 0);
    VkPipelineCreationFeedback whole{}, stage{~0u, 5};
    auto feedback =
        make<VkPipelineCreationFeedbackCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO);
    feedback.pPipelineCreationFeedback = &whole;
    feedback.pipelineStageCreationFeedbackCount = 1;
    feedback.pPipelineStageCreationFeedbacks = &stage;
    info.pNext = &feedback;
    std::array<VkComputePipelineCreateInfo, 3> three{info, info, info};
    std::array<VkPipeline, 3> pipelines{};
    auto cacheInfo = make<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    cacheInfo.flags = VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT;
    VkPipelineCache cache = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreatePipelineCache(device, &cacheInfo, nullptr, &cache), VK_SUCCESS);
    ASSERT_EQ(vkCreateComputePipelines(device, cache, 1, &info, nullptr, pipelines.data()), VK_SUCCESS);
    vkDestroyPipelineCache(device, cache, nullptr);
    EXPECT_EQ(whole.flags, VkPipelineCreationFeedbackFlags{VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT});
    EXPECT_GT(whole.duration, 0u);
    EXPECT_EQ(stage.flags, 0u);
    vkDestroyPipeline(device, pipelines[0], nullptr);
    // One that may not be compiled is not made; the others are, unless it ends the call.
    three[1].flags = VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
    for (const bool early : {false, true}) {
        if (early) three[1].flags |= VK_PIPELINE_CREATE_EARLY_RETURN_ON_FAILURE_BIT;
        EXPECT_EQ(vkCreateComputePipelines(device, VK_NULL_HANDLE, 3, three.data(), nullptr, pipelines.data()),
                  VK_PIPELINE_COMPILE_REQUIRED);
        EXPECT_NE(pipelines[0], VK_NULL_HANDLE);
        EXPECT_EQ(pipelines[1], VK_NULL_HANDLE);
        EXPECT_EQ(pipelines[2] == VK_NULL_HANDLE, early);
        for (const VkPipeline pipeline : pipelines) vkDestroyPipeline(device, pipeline, nullptr);
    }
}

TEST_F(BookkeepingTest, subgroupsHaveOneSize) {
    const auto sizes = properties<VkPhysicalDeviceSubgroupSizeControlProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES);
    EXPECT_EQ(sizes.minSubgroupSize, sizes.maxSubgroupSize);
    EXPECT_EQ(sizes.maxComputeWorkgroupSubgroups * sizes.maxSubgroupSize, 1024u);
    const TestBuffer out = makeStorage(2);
    const std::string glsl = R"(#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { uint size, present; };
void main() {
    uint all = subgroupAdd(1u);
    size = gl_SubgroupSize;
    if (gl_LocalInvocationIndex == 40) present = all;
})";
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeSet({storageBuffer(out)}, &layout);
    auto size = make<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO);
    size.requiredSubgroupSize = sizes.maxSubgroupSize;
    auto info = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, &size);
    info.stage.flags = VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = makeShader(VK_SHADER_STAGE_COMPUTE_BIT, glsl);
    info.stage.pName = "main";
    info.layout = makeLayout({layout}, 0);
    Compute compute{info.layout, VK_NULL_HANDLE, set};
    ASSERT_EQ(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &compute.pipeline), VK_SUCCESS);
    run(compute, 1);
    EXPECT_EQ(words(out)[0], sizes.maxSubgroupSize);
    EXPECT_EQ(words(out)[1], sizes.maxSubgroupSize);
    vkDestroyPipeline(device, compute.pipeline, nullptr);
    if (validated()) return;
    size.requiredSubgroupSize = sizes.maxSubgroupSize * 2;
    EXPECT_EQ(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &compute.pipeline),
              VK_ERROR_FEATURE_NOT_PRESENT);
}

TEST_F(BookkeepingTest, clocksOfHostAndDevice) {
    const auto domains = reinterpret_cast<PFN_vkGetPhysicalDeviceCalibrateableTimeDomainsEXT>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT"));
    uint32_t count = 0;
    ASSERT_EQ(domains(physicalDevice, &count, nullptr), VK_SUCCESS);
    std::vector<VkTimeDomainEXT> all(count);
    ASSERT_EQ(domains(physicalDevice, &count, all.data()), VK_SUCCESS);
    ASSERT_GE(count, 2u);
    EXPECT_EQ(all[0], VK_TIME_DOMAIN_DEVICE_EXT);
    EXPECT_EQ(all[1], VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT);
    auto info = make<VkCalibratedTimestampInfoEXT>(VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT);
    std::array<VkCalibratedTimestampInfoEXT, 2> infos{info, info};
    infos[0].timeDomain = all[0];
    infos[1].timeDomain = all[1];
    std::array<uint64_t, 2> times{};
    uint64_t deviation = 0;
    // A time stamp that the queue takes lies between two that the host takes.
    const auto now = [&] {
        EXPECT_EQ(command<PFN_vkGetCalibratedTimestampsEXT>("vkGetCalibratedTimestampsEXT")(device, 2, infos.data(),
                                                                                            times.data(), &deviation),
                  VK_SUCCESS);
        EXPECT_LE(times[1] - times[0], deviation);
        return times[0];
    };
    const VkQueryPool stamps = makeQueries(VK_QUERY_TYPE_TIMESTAMP);
    const uint64_t before = now();
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, stamps, 0, 1);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, stamps, 0);
    submit(commands);
    const uint64_t after = now();
    uint64_t stamp = 0;
    ASSERT_EQ(vkGetQueryPoolResults(device, stamps, 0, 1, sizeof stamp, &stamp, sizeof stamp, VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    EXPECT_LE(before, stamp);
    EXPECT_LE(stamp, after);
}

// The older extensions of subgroups, as shaders for OpenGL's write them.
TEST_F(BookkeepingTest, olderBallotsAndVotes) {
    const TestBuffer out = makeStorage(64 * 4);
    run(makeCompute(R"(#version 450
#extension GL_ARB_shader_ballot : require
#extension GL_ARB_shader_group_vote : require
#extension GL_ARB_gpu_shader_int64 : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { uvec4 v[64]; };
void main() {
    uint n = gl_LocalInvocationIndex;
    uint64_t odd = ballotARB(n % 2 == 1);
    v[n] = uvec4(unpackUint2x32(odd).x, readInvocationARB(n, 3), readFirstInvocationARB(n),
                 (anyInvocationARB(n == 40) ? 1 : 0) + (allInvocationsARB(n < 40) ? 2 : 0) +
                 (allInvocationsEqualARB(n < 32) ? 4 : 0));
})",
                    {storageBuffer(out)}),
        1);
    for (uint32_t n = 0; n < 64; ++n) {
        const uint32_t first = n / 32 * 32;
        EXPECT_EQ(words(out)[4 * n], 0xAAAAAAAAu) << n;
        EXPECT_EQ(words(out)[4 * n + 1], first + 3) << n;
        EXPECT_EQ(words(out)[4 * n + 2], first) << n;
        EXPECT_EQ(words(out)[4 * n + 3], n < 32 ? 6u : 5u) << n;
    }
}

// Views may begin at any texel.
TEST_F(BookkeepingTest, texelBuffersAtAnyTexel) {
    const auto alignment = properties<VkPhysicalDeviceTexelBufferAlignmentProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TEXEL_BUFFER_ALIGNMENT_PROPERTIES);
    EXPECT_TRUE(alignment.uniformTexelBufferOffsetSingleTexelAlignment);
    EXPECT_TRUE(alignment.storageTexelBufferOffsetSingleTexelAlignment);
    const TestBuffer texels = makeBuffer(256, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    for (uint32_t i = 0; i < 256; ++i) static_cast<uint8_t*>(texels.data)[i] = static_cast<uint8_t>(i);
    const TestBuffer out = makeStorage(16);
    const std::string glsl = R"(#version 450
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) buffer Out { uint v[]; };
layout(set = 0, binding = 1) uniform usamplerBuffer from;
void main() { v[gl_LocalInvocationIndex] = texelFetch(from, int(gl_LocalInvocationIndex)).x; })";
    const std::array<uint32_t, 16>* result = static_cast<const std::array<uint32_t, 16>*>(out.data);
    run(makeCompute(glsl, {storageBuffer(out), texelBuffer(makeTexels(texels, VK_FORMAT_R8_UINT, 7), false)}), 1);
    EXPECT_EQ((*result)[0], 7u);
    EXPECT_EQ((*result)[3], 10u);
    run(makeCompute(glsl, {storageBuffer(out), texelBuffer(makeTexels(texels, VK_FORMAT_R32_UINT, 12), false)}), 1);
    EXPECT_EQ((*result)[0], 0x0F0E0D0Cu);
    EXPECT_EQ((*result)[2], 0x17161514u);
}

TEST_F(BookkeepingTest, workGroupMemoryOfZeros) {
    const TestBuffer out = makeStorage(2);
    const std::string glsl = R"(#version 450
#extension GL_EXT_null_initializer : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { uint sum, groups; };
shared uint values[256] = {};
void main() {
    uint n = gl_LocalInvocationIndex, mine = 0;
    for (uint i = n; i < 256; i += 64) mine |= values[i];
    barrier();
    for (uint i = n; i < 256; i += 64) values[i] = 0xFFFFFFFFu;
    atomicOr(sum, mine);
    if (n == 0) atomicAdd(groups, 1);
})";
    run(makeCompute(glsl, {storageBuffer(out)}), 200);
    EXPECT_EQ(words(out)[0], 0u);
    EXPECT_EQ(words(out)[1], 200u);
}

// Work handed over with vkQueueSubmit2, in order by a timeline; an event, a barrier and a time stamp on the way.
TEST_F(BookkeepingTest, synchronisationInSixtyFourBits) {
    const TestBuffer out = makeStorage(4);
    const Compute compute = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint v; };
void main() { v = v * 3 + 1; })",
                                        {storageBuffer(out)});
    auto type = make<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    const auto semaphoreInfo = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type);
    VkSemaphore timeline = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSemaphore(device, &semaphoreInfo, nullptr, &timeline), VK_SUCCESS);
    const auto eventInfo = make<VkEventCreateInfo>(VK_STRUCTURE_TYPE_EVENT_CREATE_INFO);
    VkEvent event = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateEvent(device, &eventInfo, nullptr, &event), VK_SUCCESS);
    const VkQueryPool stamps = makeQueries(VK_QUERY_TYPE_TIMESTAMP);
    defer([=, this] {
        vkDestroySemaphore(device, timeline, nullptr);
        vkDestroyEvent(device, event, nullptr);
    });

    auto barrier = make<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    auto dependency = make<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, stamps, 0, 1);
    command<PFN_vkCmdResetEvent2KHR>("vkCmdResetEvent2KHR")(commands, event, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    bind(commands, compute);
    vkCmdDispatch(commands, 1, 1, 1);
    command<PFN_vkCmdPipelineBarrier2KHR>("vkCmdPipelineBarrier2KHR")(commands, &dependency);
    vkCmdDispatch(commands, 1, 1, 1);
    command<PFN_vkCmdSetEvent2KHR>("vkCmdSetEvent2KHR")(commands, event, &dependency);
    command<PFN_vkCmdWaitEvents2KHR>("vkCmdWaitEvents2KHR")(commands, 1, &event, &dependency);
    vkCmdDispatch(commands, 1, 1, 1);
    command<PFN_vkCmdWriteTimestamp2KHR>("vkCmdWriteTimestamp2KHR")(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                                                    stamps, 0);
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);

    auto wait = make<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
    wait.semaphore = timeline;
    wait.value = 5;
    wait.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSemaphoreSubmitInfo signal = wait;
    signal.value = 6;
    auto buffer = make<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
    buffer.commandBuffer = commands;
    auto submission = make<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    submission.waitSemaphoreInfoCount = submission.signalSemaphoreInfoCount = submission.commandBufferInfoCount = 1;
    submission.pWaitSemaphoreInfos = &wait;
    submission.pSignalSemaphoreInfos = &signal;
    submission.pCommandBufferInfos = &buffer;
    const auto submit2 = command<PFN_vkQueueSubmit2KHR>("vkQueueSubmit2KHR");
    ASSERT_EQ(submit2(queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
    EXPECT_EQ(words(out)[0], 0u) << "it waits for the timeline";
    auto go = make<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
    go.semaphore = timeline;
    go.value = 5;
    ASSERT_EQ(command<PFN_vkSignalSemaphoreKHR>("vkSignalSemaphoreKHR")(device, &go), VK_SUCCESS);
    ASSERT_EQ(vkQueueWaitIdle(queue), VK_SUCCESS);
    EXPECT_EQ(words(out)[0], 13u);
    uint64_t value = 0;
    ASSERT_EQ(command<PFN_vkGetSemaphoreCounterValueKHR>("vkGetSemaphoreCounterValueKHR")(device, timeline, &value),
              VK_SUCCESS);
    EXPECT_EQ(value, 6u);
    ASSERT_EQ(vkGetQueryPoolResults(device, stamps, 0, 1, sizeof value, &value, sizeof value, VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    EXPECT_GT(value, 0u);
    if (validated()) return;
    const VkCommandBuffer unfinished = begin();
    buffer.commandBuffer = unfinished;
    EXPECT_NE(submit2(queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
