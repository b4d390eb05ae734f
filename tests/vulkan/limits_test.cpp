// Resources, descriptors and dispatches as large, and as many, as the limits of the device allow.
#include <numeric>
#include <spirv/unified1/spirv.hpp>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class LimitsTest : public ComputeTest {
  protected:
    void SetUp() override {
        ComputeTest::SetUp();
        VkPhysicalDeviceProperties properties{};
        vkGetPhysicalDeviceProperties(physicalDevice, &properties);
        limits_ = properties.limits;
    }

    /// Writes the last texel of the last layer of an R8 image and reads it back.
    void useFarCorner(VkImageType type, VkExtent3D extent, uint32_t layers, VkImageCreateFlags flags) {
        auto info = flatImage(VK_FORMAT_R8_UNORM, {extent.width, extent.height},
                              VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        info.flags = flags;
        info.imageType = type;
        info.extent.depth = extent.depth;
        info.arrayLayers = layers;
        TestImage image;
        ASSERT_EQ(vkCreateImage(device, &info, nullptr, &image.image), VK_SUCCESS);
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device, image.image, &needs);
        auto allocation = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        allocation.allocationSize = needs.size;
        ASSERT_EQ(vkAllocateMemory(device, &allocation, nullptr, &image.memory), VK_SUCCESS);
        ASSERT_EQ(vkBindImageMemory(device, image.image, image.memory, 0), VK_SUCCESS);
        const TestBuffer from = makeBuffer(4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        const TestBuffer to = makeBuffer(4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        *static_cast<uint8_t*>(from.data) = 77;
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layers - 1, 1};
        region.imageOffset = {static_cast<int32_t>(extent.width - 1), static_cast<int32_t>(extent.height - 1),
                              static_cast<int32_t>(extent.depth - 1)};
        region.imageExtent = {1, 1, 1};
        const VkCommandBuffer commands = begin();
        toGeneral(commands, image);
        vkCmdCopyBufferToImage(commands, from.buffer, image.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
        makeVisible(commands);
        vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, to.buffer, 1, &region);
        makeVisible(commands);
        submit(commands);
        EXPECT_EQ(*static_cast<uint8_t*>(to.data), 77);
        vkDestroyImage(device, image.image, nullptr);
        vkFreeMemory(device, image.memory, nullptr);
    }

    /// A pipeline of one shader with one set, whose descriptors are written by `write`. The capabilities are declared
    /// besides those that the compiler declares.
    void runWith(const std::string& glsl, const std::vector<VkDescriptorSetLayoutBinding>& bindings,
                 const std::function<std::vector<VkWriteDescriptorSet>(VkDescriptorSet)>& write,
                 const std::vector<uint32_t>& dynamicOffsets = {},
                 const std::vector<spv::Capability>& capabilities = {}) {
        const VkDescriptorSetLayout setLayout = makeSetLayout(bindings);
        std::vector<VkDescriptorPoolSize> sizes;
        for (const auto& binding : bindings) sizes.push_back({binding.descriptorType, binding.descriptorCount});
        const VkDescriptorSet set = makeEmptySet(setLayout, sizes);
        const std::vector<VkWriteDescriptorSet> writes = write(set);
        vkUpdateDescriptorSets(device, static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);

        const VkPipelineLayout layout = makeLayout({setLayout}, 0);
        std::vector<uint32_t> shader = compileGlsl(VK_SHADER_STAGE_COMPUTE_BIT, glsl);
        for (const spv::Capability capability : capabilities) {
            constexpr uint32_t kHeaderWords = 5, kWordCount = 2 << spv::WordCountShift;
            shader.insert(shader.begin() + kHeaderWords, {kWordCount | spv::OpCapability, capability});
        }
        const VkPipeline pipeline = makeComputePipeline(layout, makeShader(shader));
        const VkCommandBuffer commands = begin();
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set,
                                static_cast<uint32_t>(dynamicOffsets.size()), dynamicOffsets.data());
        vkCmdDispatch(commands, 1, 1, 1);
        makeVisible(commands);
        submit(commands);
    }
    static VkWriteDescriptorSet writeOf(VkDescriptorSet set, uint32_t binding, VkDescriptorType type, size_t count) {
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.dstBinding = binding;
        write.descriptorType = type;
        write.descriptorCount = static_cast<uint32_t>(count);
        return write;
    }

    VkPhysicalDeviceLimits limits_{};
};

TEST_F(LimitsTest, imagesOfTheLargestSizes) {
    useFarCorner(VK_IMAGE_TYPE_1D, {limits_.maxImageDimension1D, 1, 1}, 1, 0);
    useFarCorner(VK_IMAGE_TYPE_2D, {limits_.maxImageDimension2D, limits_.maxImageDimension2D, 1}, 1, 0);
    useFarCorner(VK_IMAGE_TYPE_2D, {limits_.maxImageDimensionCube, limits_.maxImageDimensionCube, 1}, 6,
                 VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT);
    useFarCorner(VK_IMAGE_TYPE_3D, {limits_.maxImageDimension3D, 1, 2}, 1, 0);
    useFarCorner(VK_IMAGE_TYPE_3D, {1, limits_.maxImageDimension3D, limits_.maxImageDimension3D}, 1, 0);
    useFarCorner(VK_IMAGE_TYPE_2D, {3, 3, 1}, limits_.maxImageArrayLayers, 0);
}

TEST_F(LimitsTest, buffersOfTheLargestRanges) {
    const TestBuffer out = makeStorage(4);
    const TestBuffer uniform = makeBuffer(limits_.maxUniformBufferRange, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const TestBuffer storage = makeBuffer(limits_.maxStorageBufferRange, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const TestBuffer texels = makeBuffer(limits_.maxTexelBufferElements, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    words(uniform)[limits_.maxUniformBufferRange / 4 - 1] = 11;
    words(storage)[limits_.maxStorageBufferRange / 4 - 1] = 22;
    static_cast<uint8_t*>(texels.data)[limits_.maxTexelBufferElements - 1] = 33;
    TestDescriptor uniforms = storageBuffer(uniform);
    uniforms.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const Compute compute = makeCompute(
        R"(#version 450
        layout(set = 0, binding = 0) buffer Out { uint values[4]; };
        layout(set = 0, binding = 1) uniform Uniforms { uvec4 uniforms[4096]; };
        layout(set = 0, binding = 2) buffer Storage { uint storages[]; };
        layout(set = 0, binding = 3) uniform usamplerBuffer texels;
        layout(push_constant) uniform Constants { uint constants[)" +
            std::to_string(limits_.maxPushConstantsSize / 4) + R"(]; };
        void main() {
            values[0] = uniforms[4095].w;
            values[1] = storages[storages.length() - 1];
            values[2] = texelFetch(texels, textureSize(texels) - 1).x;
            values[3] = constants[constants.length() - 1];
        })",
        {storageBuffer(out), uniforms, storageBuffer(storage),
         texelBuffer(makeTexels(texels, VK_FORMAT_R8_UINT), false)},
        limits_.maxPushConstantsSize);
    std::vector<uint32_t> constants(limits_.maxPushConstantsSize / 4);
    constants.back() = 44;
    const VkCommandBuffer commands = begin();
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, limits_.maxPushConstantsSize,
                       constants.data());
    dispatch(commands, compute, 1);
    submit(commands);
    ASSERT_EQ(limits_.maxUniformBufferRange, 65536u);
    for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(words(out)[i], 11 * (i + 1));
}

TEST_F(LimitsTest, descriptorsByTheThousand) {
    const uint32_t count = limits_.maxPerStageDescriptorStorageBuffers;
    for (const uint32_t other : {limits_.maxPerStageDescriptorUniformBuffers, limits_.maxPerStageDescriptorSamplers,
                                 limits_.maxPerStageDescriptorSampledImages, limits_.maxPerStageDescriptorStorageImages,
                                 limits_.maxDescriptorSetUniformBuffers, limits_.maxDescriptorSetStorageBuffers,
                                 limits_.maxDescriptorSetSamplers, limits_.maxDescriptorSetSampledImages,
                                 limits_.maxDescriptorSetStorageImages}) {
        ASSERT_EQ(other, count);
    }
    ASSERT_GE(limits_.maxPerStageResources, 4 * count + 1);
    ASSERT_GE(limits_.maxFragmentCombinedOutputResources, 1u);
    const TestBuffer few = makeStorage(4), last = makeStorage(4);
    const TestBuffer uniform = makeBuffer(16, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    words(uniform)[0] = 5;
    const TestImage image =
        makeImage(VK_FORMAT_R32_UINT, {1, 1}, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
    const VkCommandBuffer commands = begin();
    toGeneral(commands, image);
    const VkClearColorValue seven{.uint32 = {7}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &seven, 1, &range);
    makeVisible(commands);
    submit(commands);
    const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    std::vector<VkDescriptorBufferInfo> buffers(count, {few.buffer, 0, VK_WHOLE_SIZE});
    buffers.back().buffer = last.buffer;
    const std::vector<VkDescriptorBufferInfo> uniforms(count, {uniform.buffer, 0, VK_WHOLE_SIZE});
    const std::vector<VkDescriptorImageInfo> images(count, {sampler, image.view, VK_IMAGE_LAYOUT_GENERAL});
    constexpr VkShaderStageFlags kCompute = VK_SHADER_STAGE_COMPUTE_BIT;
    const std::string n = std::to_string(count);
    runWith(
        "#version 450\n"
        "layout(set = 0, binding = 0) buffer Out { uint value; } outs[" +
            n + "];\nlayout(set = 0, binding = 1) uniform In { uint value; } ins[" + n +
            "];\nlayout(set = 0, binding = 2) uniform usampler2D textures[" + n +
            "];\nlayout(set = 0, binding = 3, r32ui) uniform uimage2D images[" + n +
            "];\nvoid main() { uint last = " + n +
            " - 1 + outs[0].value; outs[last].value = ins[last].value * 100 + "
            "texelFetch(textures[last], ivec2(0), 0).x * 10 + imageLoad(images[last], ivec2(0)).x; }",
        {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count, kCompute, nullptr},
         {1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count, kCompute, nullptr},
         {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count, kCompute, nullptr},
         {3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, count, kCompute, nullptr}},
        [&](VkDescriptorSet set) {
            std::vector<VkWriteDescriptorSet> writes = {
                writeOf(set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count),
                writeOf(set, 1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count),
                writeOf(set, 2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count),
                writeOf(set, 3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, count)};
            writes[0].pBufferInfo = buffers.data();
            writes[1].pBufferInfo = uniforms.data();
            writes[2].pImageInfo = writes[3].pImageInfo = images.data();
            return writes;
        },
        {},
        // Glslang leaves out what indices that are not constant need (SPIR-V, Capability).
        {spv::CapabilityStorageBufferArrayDynamicIndexing, spv::CapabilityUniformBufferArrayDynamicIndexing,
         spv::CapabilitySampledImageArrayDynamicIndexing, spv::CapabilityStorageImageArrayDynamicIndexing});
    EXPECT_EQ(words(last)[0], 577u);
}

TEST_F(LimitsTest, dynamicBuffersAtTheSmallestAlignments) {
    const uint32_t uniforms = limits_.maxDescriptorSetUniformBuffersDynamic;
    const uint32_t storages = limits_.maxDescriptorSetStorageBuffersDynamic;
    const auto uniformStep = static_cast<uint32_t>(limits_.minUniformBufferOffsetAlignment);
    const auto storageStep = static_cast<uint32_t>(limits_.minStorageBufferOffsetAlignment);
    const TestBuffer in = makeBuffer(VkDeviceSize{uniformStep} * uniforms + 16, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const TestBuffer out = makeBuffer(VkDeviceSize{storageStep} * storages + 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    std::vector<uint32_t> offsets;
    for (uint32_t i = 0; i < uniforms; ++i) {
        words(in)[i * uniformStep / 4] = 1000 + i;
        offsets.push_back(i * uniformStep);
    }
    for (uint32_t i = 0; i < storages; ++i) offsets.push_back(i * storageStep);
    const std::vector<VkDescriptorBufferInfo> ins(uniforms, {in.buffer, 0, 4}), outs(storages, {out.buffer, 0, 4});
    ASSERT_EQ(uniforms, storages);
    const std::string n = std::to_string(uniforms);
    runWith(
        "#version 450\nlayout(set = 0, binding = 0) uniform In { uint value; } ins[" + n +
            "];\nlayout(set = 0, binding = 1) buffer Out { uint value; } outs[" + n +
            "];\nvoid main() { for (uint i = 0; i < " + n + "; ++i) outs[i].value = ins[i].value; }",
        {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, uniforms, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
         {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, storages, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}},
        [&](VkDescriptorSet set) {
            std::vector<VkWriteDescriptorSet> writes = {
                writeOf(set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, uniforms),
                writeOf(set, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, storages)};
            writes[0].pBufferInfo = ins.data();
            writes[1].pBufferInfo = outs.data();
            return writes;
        },
        offsets);
    for (uint32_t i = 0; i < storages; ++i) EXPECT_EQ(words(out)[i * storageStep / 4], 1000 + i);
}

TEST_F(LimitsTest, texelBuffersAtTheSmallestAlignment) {
    const VkDeviceSize step = limits_.minTexelBufferOffsetAlignment;
    const TestBuffer buffer = makeBuffer(step + 64, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    static_cast<uint8_t*>(buffer.data)[step] = 99;
    const TestBuffer out = makeStorage(1);
    run(makeCompute(R"(#version 450
        layout(set = 0, binding = 0) buffer Out { uint value; };
        layout(set = 0, binding = 1) uniform usamplerBuffer texels;
        void main() { value = texelFetch(texels, 0).x; })",
                    {storageBuffer(out), texelBuffer(makeTexels(buffer, VK_FORMAT_R8_UINT, step), false)}),
        1);
    EXPECT_EQ(words(out)[0], 99u);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(buffer.data) % limits_.minMemoryMapAlignment, 0u);
}

TEST_F(LimitsTest, descriptorSetsOfAllNumbers) {
    const uint32_t sets = limits_.maxBoundDescriptorSets;
    std::string glsl = "#version 450\n", sum = "0";
    std::vector<VkDescriptorSetLayout> layouts(sets);
    std::vector<VkDescriptorSet> bound;
    std::vector<TestBuffer> buffers;
    for (uint32_t i = 0; i < sets; ++i) {
        buffers.push_back(makeStorage(1));
        words(buffers[i])[0] = 1u << i;
        bound.push_back(makeSet({storageBuffer(buffers[i])}, &layouts[i]));
        const std::string n = std::to_string(i);
        glsl += "layout(set = " + n + ", binding = 0) buffer B" + n + " { uint value" + n + "; };\n";
        sum += " + value" + n;
    }
    const VkPipelineLayout layout = makeLayout(layouts, 0);
    const VkPipeline pipeline = makeComputePipeline(layout, glsl + "void main() { value0 = " + sum + "; }");
    const VkCommandBuffer commands = begin();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, sets, bound.data(), 0, nullptr);
    vkCmdDispatch(commands, 1, 1, 1);
    makeVisible(commands);
    submit(commands);
    EXPECT_EQ(words(buffers[0])[0], (1u << sets) - 1);
}

TEST_F(LimitsTest, groupsOfAllCountsAndSizes) {
    const TestBuffer out = makeStorage(4);
    const Compute counts = makeCompute(R"(#version 450
        layout(set = 0, binding = 0) buffer Out { uint count, most[3]; };
        void main() {
            uvec3 id = gl_WorkGroupID;
            if (id == gl_NumWorkGroups - 1) { atomicAdd(count, 1); for (int i = 0; i < 3; ++i) atomicMax(most[i], id[i]); }
        })",
                                       {storageBuffer(out)});
    const uint32_t* most = limits_.maxComputeWorkGroupCount;
    run(counts, most[0]);
    run(counts, 1, most[1]);
    run(counts, 1, 1, most[2]);
    EXPECT_EQ(words(out)[0], 3u);
    for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(words(out)[1 + i], most[i] - 1);
    const uint32_t* sizes = limits_.maxComputeWorkGroupSize;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        const TestBuffer sum = makeStorage(1);
        const char* const names[] = {"x", "y", "z"};
        run(makeCompute("#version 450\nlayout(local_size_" + std::string(names[axis]) + " = " +
                            std::to_string(sizes[axis]) +
                            ") in;\nlayout(set = 0, binding = 0) buffer Out { uint sum; };\n"
                            "void main() { atomicAdd(sum, gl_LocalInvocationIndex); }",
                        {storageBuffer(sum)}),
            1);
        EXPECT_EQ(words(sum)[0], sizes[axis] * (sizes[axis] - 1) / 2);
    }
}

// The limits on the numbers of objects are those of the memory: many at once are no trouble.
TEST_F(LimitsTest, allocationsAndSamplersByTheThousand) {
    constexpr uint32_t kMany = 6000;
    ASSERT_GE(limits_.maxMemoryAllocationCount, kMany);
    ASSERT_GE(limits_.maxSamplerAllocationCount, kMany);
    const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    for (uint32_t i = 0; i < kMany; ++i) {
        (void)allocate(64);
        VkSampler sampler = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    }
}

// Buffers and images side by side in one allocation, as near as bufferImageGranularity and alignments let them be.
TEST_F(LimitsTest, buffersAndImagesAreNeighbours) {
    ASSERT_EQ(limits_.bufferImageGranularity, 1u);
    auto bufferInfo = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    bufferInfo.size = 64;
    bufferInfo.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateBuffer(device, &bufferInfo, nullptr, &buffer), VK_SUCCESS);
    const auto imageInfo =
        flatImage(VK_FORMAT_R8_UINT, {5, 5}, VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    TestImage image;
    image.extent = {5, 5};
    ASSERT_EQ(vkCreateImage(device, &imageInfo, nullptr, &image.image), VK_SUCCESS);
    defer([this, buffer, image] {
        vkDestroyBuffer(device, buffer, nullptr);
        vkDestroyImage(device, image.image, nullptr);
    });
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device, image.image, &needs);
    ASSERT_LE(needs.alignment, 64u);
    const VkDeviceMemory memory = allocate(128 + needs.size);
    ASSERT_EQ(vkBindBufferMemory(device, buffer, memory, 0), VK_SUCCESS);
    ASSERT_EQ(vkBindImageMemory(device, image.image, memory, 64), VK_SUCCESS);
    void* data = nullptr;
    ASSERT_EQ(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    const VkCommandBuffer commands = begin();
    toGeneral(commands, image);
    const VkClearColorValue nine{.uint32 = {9}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &nine, 1, &range);
    vkCmdFillBuffer(commands, buffer, 0, 64, 0x08080808);
    makeVisible(commands);
    submit(commands);
    const auto* bytes = static_cast<const uint8_t*>(data);
    EXPECT_EQ(bytes[0], 8);
    EXPECT_EQ(bytes[63], 8);
    EXPECT_EQ(bytes[64], 9);
    // The host sees and writes single bytes: nonCoherentAtomSize is 1, and the memory coherent.
    ASSERT_EQ(limits_.nonCoherentAtomSize, 1u);
    auto mapped = make<VkMappedMemoryRange>(VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE);
    mapped.memory = memory;
    mapped.offset = 63;
    mapped.size = 1;
    EXPECT_EQ(vkFlushMappedMemoryRanges(device, 1, &mapped), VK_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
