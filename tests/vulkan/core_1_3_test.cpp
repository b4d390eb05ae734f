// Vulkan 1.2 and 1.3 as core versions: what they make mandatory, their structures, their commands by their own names.
#include <array>

#include "tests/vulkan/test_assembly.h"

namespace vernier::test {
namespace {

class Core13Test : public AssemblyTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_3; }
    std::vector<const char*> moreExtensions() override { return {}; }
    void* moreFeatures() override {
        // timelineSemaphore comes in a structure of its own from the fixture: not also in that of Vulkan 1.2.
        thirteen_.synchronization2 = thirteen_.dynamicRendering = thirteen_.maintenance4 = VK_TRUE;
        return &thirteen_;
    }

  private:
    VkPhysicalDeviceVulkan13Features thirteen_ =
        make<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
};

// "Feature Requirements" of the specification, as far as 1.1 to 1.3 add to them.
TEST_F(Core13Test, mandatoryFeatures) {
    const auto eleven =
        features<VkPhysicalDeviceVulkan11Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES);
    EXPECT_TRUE(eleven.multiview);
    EXPECT_TRUE(eleven.storageBuffer16BitAccess);
    EXPECT_FALSE(eleven.protectedMemory);
    const auto twelve =
        features<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    EXPECT_TRUE(twelve.imagelessFramebuffer);
    EXPECT_TRUE(twelve.uniformBufferStandardLayout);
    EXPECT_TRUE(twelve.shaderSubgroupExtendedTypes);
    EXPECT_TRUE(twelve.separateDepthStencilLayouts);
    EXPECT_TRUE(twelve.hostQueryReset);
    EXPECT_TRUE(twelve.timelineSemaphore);
    EXPECT_TRUE(twelve.subgroupBroadcastDynamicId);
    EXPECT_TRUE(twelve.bufferDeviceAddress);
    EXPECT_TRUE(twelve.vulkanMemoryModel);
    EXPECT_TRUE(twelve.vulkanMemoryModelDeviceScope);
    EXPECT_TRUE(twelve.descriptorIndexing);
    EXPECT_FALSE(twelve.bufferDeviceAddressCaptureReplay);
    const auto thirteen =
        features<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    EXPECT_TRUE(thirteen.robustImageAccess);
    EXPECT_TRUE(thirteen.inlineUniformBlock);
    EXPECT_TRUE(thirteen.descriptorBindingInlineUniformBlockUpdateAfterBind);
    EXPECT_TRUE(thirteen.pipelineCreationCacheControl);
    EXPECT_TRUE(thirteen.privateData);
    EXPECT_TRUE(thirteen.shaderDemoteToHelperInvocation);
    EXPECT_TRUE(thirteen.shaderTerminateInvocation);
    EXPECT_TRUE(thirteen.subgroupSizeControl);
    EXPECT_TRUE(thirteen.computeFullSubgroups);
    EXPECT_TRUE(thirteen.synchronization2);
    EXPECT_TRUE(thirteen.shaderZeroInitializeWorkgroupMemory);
    EXPECT_TRUE(thirteen.dynamicRendering);
    EXPECT_TRUE(thirteen.shaderIntegerDotProduct);
    EXPECT_TRUE(thirteen.maintenance4);
    EXPECT_FALSE(thirteen.textureCompressionASTC_HDR);
}

// The structures of core versions and those of the extensions that went into them say the same.
TEST_F(Core13Test, propertiesAreThoseOfTheExtensions) {
    const auto eleven =
        properties<VkPhysicalDeviceVulkan11Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES);
    const auto twelve =
        properties<VkPhysicalDeviceVulkan12Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES);
    const auto thirteen =
        properties<VkPhysicalDeviceVulkan13Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES);
    const auto ids = properties<VkPhysicalDeviceIDProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES);
    EXPECT_EQ(std::memcmp(eleven.driverUUID, ids.driverUUID, VK_UUID_SIZE), 0);
    const auto subgroups =
        properties<VkPhysicalDeviceSubgroupProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES);
    EXPECT_EQ(eleven.subgroupSize, subgroups.subgroupSize);
    EXPECT_EQ(eleven.subgroupSupportedOperations, subgroups.supportedOperations);
    EXPECT_EQ(eleven.subgroupQuadOperationsInAllStages, subgroups.quadOperationsInAllStages);
    EXPECT_EQ(eleven.pointClippingBehavior, VK_POINT_CLIPPING_BEHAVIOR_ALL_CLIP_PLANES);
    EXPECT_GE(eleven.maxMultiviewViewCount, 6u);
    EXPECT_GE(eleven.maxPerSetDescriptors, 1024u);
    EXPECT_GE(eleven.maxMemoryAllocationSize, VkDeviceSize{1} << 30);
    const auto driver =
        properties<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    EXPECT_STREQ(driver.driverName, "Vernier");
    EXPECT_STREQ(twelve.driverName, driver.driverName);
    EXPECT_STREQ(twelve.driverInfo, driver.driverInfo);
    EXPECT_EQ(twelve.driverID, driver.driverID);
    EXPECT_EQ(twelve.conformanceVersion.major, 0);
    EXPECT_TRUE(twelve.shaderDenormPreserveFloat32);
    EXPECT_TRUE(twelve.shaderRoundingModeRTEFloat64);
    EXPECT_FALSE(twelve.shaderRoundingModeRTZFloat64);
    // "Required Limits" of descriptors that are updated after they are bound.
    EXPECT_GE(twelve.maxUpdateAfterBindDescriptorsInAllPools, 500000u);
    EXPECT_GE(twelve.maxPerStageDescriptorUpdateAfterBindSamplers, 500000u);
    EXPECT_GE(twelve.maxPerStageUpdateAfterBindResources, 500000u);
    EXPECT_GE(twelve.maxDescriptorSetUpdateAfterBindUniformBuffersDynamic, 8u);
    EXPECT_GE(twelve.maxDescriptorSetUpdateAfterBindStorageBuffersDynamic, 4u);
    EXPECT_TRUE(twelve.robustBufferAccessUpdateAfterBind);
    EXPECT_TRUE(twelve.supportedDepthResolveModes & VK_RESOLVE_MODE_SAMPLE_ZERO_BIT);
    EXPECT_TRUE(twelve.independentResolve);
    EXPECT_TRUE(twelve.filterMinmaxSingleComponentFormats);
    EXPECT_GE(twelve.maxTimelineSemaphoreValueDifference, (uint64_t{1} << 31) - 1);
    EXPECT_TRUE(twelve.framebufferIntegerColorSampleCounts & VK_SAMPLE_COUNT_1_BIT);
    EXPECT_EQ(thirteen.minSubgroupSize, subgroups.subgroupSize);
    EXPECT_TRUE(thirteen.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT);
    EXPECT_GE(thirteen.maxInlineUniformBlockSize, 256u);
    EXPECT_GE(thirteen.maxDescriptorSetUpdateAfterBindInlineUniformBlocks, 4u);
    EXPECT_GE(thirteen.maxInlineUniformTotalSize, 256u);
    EXPECT_FALSE(thirteen.integerDotProduct64BitSignedAccelerated);
    const auto texels = properties<VkPhysicalDeviceTexelBufferAlignmentProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TEXEL_BUFFER_ALIGNMENT_PROPERTIES);
    EXPECT_EQ(thirteen.storageTexelBufferOffsetAlignmentBytes, texels.storageTexelBufferOffsetAlignmentBytes);
    EXPECT_EQ(thirteen.uniformTexelBufferOffsetSingleTexelAlignment,
              texels.uniformTexelBufferOffsetSingleTexelAlignment);
    EXPECT_GE(thirteen.maxBufferSize, VkDeviceSize{1} << 30);
}

TEST_F(Core13Test, featuresOfCoreVersionsAreChecked) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const float priority = 1;
    auto queueInfo = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    auto twelve = make<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    auto info = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &twelve);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    VkDevice made = VK_NULL_HANDLE;
    twelve.descriptorIndexing = twelve.hostQueryReset = VK_TRUE;
    ASSERT_EQ(vkCreateDevice(physicalDevice, &info, nullptr, &made), VK_SUCCESS);
    vkDestroyDevice(made, nullptr);
    twelve.bufferDeviceAddressCaptureReplay = VK_TRUE;
    EXPECT_EQ(vkCreateDevice(physicalDevice, &info, nullptr, &made), VK_ERROR_FEATURE_NOT_PRESENT);
}

TEST_F(Core13Test, commandsHaveTheirCoreNames) {
    for (const char* name : {"vkCmdBeginRendering", "vkQueueSubmit2", "vkCmdSetCullMode", "vkCmdBindVertexBuffers2",
                             "vkGetBufferDeviceAddress", "vkResetQueryPool", "vkCreatePrivateDataSlot",
                             "vkGetDeviceImageMemoryRequirements", "vkCmdCopyImage2", "vkWaitSemaphores"}) {
        EXPECT_NE(vkGetDeviceProcAddr(device, name), nullptr) << name;
    }
    EXPECT_EQ(vkGetDeviceProcAddr(device, "vkCmdBeginRenderingKHR"), nullptr) << "its extension is not enabled";
    uint32_t count = 9;
    EXPECT_EQ(vkGetPhysicalDeviceToolProperties(physicalDevice, &count, nullptr), VK_SUCCESS);
}

// The fragment stage may take fewer components than the stage before gives (maintenance4).
TEST_F(Core13Test, stagesTakeTheFirstComponents) {
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) out vec4 four;
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0.5, 1);
    four = vec4(0.2, 0.4, 0.6, 0.8);
})");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) in vec2 two;
layout(location = 0) out vec4 o;
void main() { o = vec4(two, 0, 1); })");
    desc.extent = color.extent;
    drawTriangle(pass, makePipeline(pass.pass, desc));
    EXPECT_EQ(pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 2, 1), 0xFF006633u);
}

// Work groups as large as constants say (maintenance4).
TEST_F(Core13Test, localSizesByConstants) {
    TwoBufferModule module;
    module.constants = R"(
%c1 = OpConstant %uint 1
%size = OpSpecConstant %uint 4
)";
    module.body = R"(
%pb = OpAccessChain %pu %b %c0 %i
%next = OpIAdd %uint %i %c1
OpStore %pb %next
)";
    std::string text = module.text();
    const std::string fixed = "OpExecutionMode %main LocalSize 1 1 1";
    text.replace(text.find(fixed), fixed.size(), "OpExecutionModeId %main LocalSizeId %size %c1 %c1");
    const TestBuffer a = makeStorage(1), b = makeStorage(8);
    std::memset(b.data, 0, b.size);
    run(makeAssembled(text, SPV_ENV_UNIVERSAL_1_5, {storageBuffer(a), storageBuffer(b)}), 1);
    EXPECT_EQ(std::vector<uint32_t>(words(b), words(b) + 8), (std::vector<uint32_t>{1, 2, 3, 4, 0, 0, 0, 0}));
}

// The core commands of the extended dynamic state need no feature.
TEST_F(Core13Test, dynamicStateIsCore) {
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {16, 16}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.vertex = fullScreen();
    desc.fragment = constantColor("1, 0, 0, 1");
    desc.extent = {16, 16};
    desc.dynamic = {VK_DYNAMIC_STATE_RASTERIZER_DISCARD_ENABLE, VK_DYNAMIC_STATE_CULL_MODE};
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    for (const VkBool32 discard : {VK_TRUE, VK_FALSE}) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdSetRasterizerDiscardEnable(commands, discard);
        vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        EXPECT_EQ(pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 5, 5),
                  discard != VK_FALSE ? 0u : 0xFF0000FFu);
    }
}

// Loads outside an image give zeros, with an alpha of one where the format has none (robustImageAccess).
TEST_F(Core13Test, loadsOutsideImages) {
    const TestImage image = makeImage(VK_FORMAT_R32_UINT, {4, 4}, VK_IMAGE_USAGE_STORAGE_BIT);
    const TestBuffer out = makeStorage(16);
    const Compute compute = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uvec4 v[4]; };
layout(set = 0, binding = 1, r32ui) uniform uimage2D image;
void main() {
    imageStore(image, ivec2(-1, 0), uvec4(9));
    imageStore(image, ivec2(4, 3), uvec4(9));
    v[0] = imageLoad(image, ivec2(3, 3));
    v[1] = imageLoad(image, ivec2(4, 3));
    v[2] = imageLoad(image, ivec2(-1, 0));
    v[3] = imageLoad(image, ivec2(0, 0x7FFFFFFF));
})",
                                        {storageBuffer(out), storageImage(image)});
    const VkCommandBuffer commands = begin();
    toGeneral(commands, image);
    const VkClearColorValue value{.uint32 = {5, 5, 5, 5}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
    makeVisible(commands);
    dispatch(commands, compute, 1);
    submit(commands);
    EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 4), (std::vector<uint32_t>{5, 0, 0, 1}));
    for (uint32_t n = 1; n < 4; ++n) {
        EXPECT_EQ(words(out)[4 * n], 0u) << n;
        EXPECT_LE(words(out)[4 * n + 3], 1u) << n;
    }
}

}  // namespace
}  // namespace vernier::test
