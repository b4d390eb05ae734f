// Descriptors beyond sets that are written before they are bound: pushed, inline, indexed at will, and updated late.
#include <array>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr uint32_t kArray = 1000;

class DescriptorIndexingTest : public ComputeTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_DESCRIPTOR_INDEXING_EXTENSION_NAME, VK_EXT_INLINE_UNIFORM_BLOCK_EXTENSION_NAME,
                VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        auto query = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &indexing_);
        indexing_.pNext = &inline_;
        vkGetPhysicalDeviceFeatures2(physicalDevice, &query);
        EXPECT_TRUE(indexing_.runtimeDescriptorArray);
        EXPECT_TRUE(indexing_.descriptorBindingPartiallyBound);
        EXPECT_TRUE(inline_.inlineUniformBlock);
        return &indexing_;
    }

    struct Binding {
        VkDescriptorType type;
        uint32_t count = 1;
        VkDescriptorBindingFlags flags = 0;
    };
    VkDescriptorSetLayout makeSetLayout(const std::vector<Binding>& bindings, VkDescriptorSetLayoutCreateFlags flags) {
        std::vector<VkDescriptorSetLayoutBinding> infos;
        std::vector<VkDescriptorBindingFlags> flagsOf;
        for (const Binding& binding : bindings) {
            infos.push_back(
                {static_cast<uint32_t>(infos.size()), binding.type, binding.count, VK_SHADER_STAGE_ALL, nullptr});
            flagsOf.push_back(binding.flags);
        }
        auto more = make<VkDescriptorSetLayoutBindingFlagsCreateInfo>(
            VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO);
        more.bindingCount = static_cast<uint32_t>(flagsOf.size());
        more.pBindingFlags = flagsOf.data();
        auto info = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &more);
        info.flags = flags;
        info.bindingCount = more.bindingCount;
        info.pBindings = infos.data();
        VkDescriptorSetLayout layout = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), VK_SUCCESS);
        defer([this, layout] { vkDestroyDescriptorSetLayout(device, layout, nullptr); });
        return layout;
    }
    VkDescriptorPool makePool(const std::vector<VkDescriptorPoolSize>& sizes, uint32_t blocks = 0) {
        auto inlineBlocks = make<VkDescriptorPoolInlineUniformBlockCreateInfo>(
            VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_INLINE_UNIFORM_BLOCK_CREATE_INFO);
        inlineBlocks.maxInlineUniformBlockBindings = blocks;
        auto info = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, &inlineBlocks);
        info.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
        info.maxSets = 8;
        info.poolSizeCount = static_cast<uint32_t>(sizes.size());
        info.pPoolSizes = sizes.data();
        VkDescriptorPool made = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateDescriptorPool(device, &info, nullptr, &made), VK_SUCCESS);
        defer([this, made] { vkDestroyDescriptorPool(device, made, nullptr); });
        return made;
    }
    VkDescriptorSet allocate(VkDescriptorPool from, VkDescriptorSetLayout layout, const uint32_t* variable = nullptr,
                             VkResult expected = VK_SUCCESS) {
        auto counts = make<VkDescriptorSetVariableDescriptorCountAllocateInfo>(
            VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_ALLOCATE_INFO);
        counts.descriptorSetCount = 1;
        counts.pDescriptorCounts = variable;
        auto info = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                      variable != nullptr ? &counts : nullptr);
        info.descriptorPool = from;
        info.descriptorSetCount = 1;
        info.pSetLayouts = &layout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        EXPECT_EQ(vkAllocateDescriptorSets(device, &info, &set), expected);
        return set;
    }
    Compute makePipelineOf(const std::string& glsl, VkDescriptorSetLayout layout, VkDescriptorSet set) {
        const VkPipelineLayout pipelineLayout = makeLayout({layout}, 0);
        return {pipelineLayout, makeComputePipeline(pipelineLayout, glsl), set};
    }
    /// An image of two planes; its view is the caller's. None where the validation layer stands between.
    void makePlanar(TestImage& made) {
        if (validated()) return;
        made = makeImage(flatImage(VK_FORMAT_G8_B8R8_2PLANE_420_UNORM, {4, 4}, VK_IMAGE_USAGE_SAMPLED_BIT));
        auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
        view.image = made.image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = made.format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        ASSERT_EQ(vkCreateImageView(device, &view, nullptr, &made.view), VK_SUCCESS);
    }
    static VkWriteDescriptorSet writeOf(VkDescriptorSet set, uint32_t binding, uint32_t element,
                                        const VkDescriptorBufferInfo& buffer) {
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.dstBinding = binding;
        write.dstArrayElement = element;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &buffer;
        return write;
    }
    void writeBuffer(VkDescriptorSet set, uint32_t binding, uint32_t element, const TestBuffer& buffer) {
        const VkDescriptorBufferInfo info{buffer.buffer, 0, VK_WHOLE_SIZE};
        const VkWriteDescriptorSet write = writeOf(set, binding, element, info);
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    void writeBlock(VkDescriptorSet set, uint32_t offset, const std::vector<uint32_t>& values) {
        auto data =
            make<VkWriteDescriptorSetInlineUniformBlock>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_INLINE_UNIFORM_BLOCK);
        data.dataSize = static_cast<uint32_t>(values.size() * 4);
        data.pData = values.data();
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, &data);
        write.dstSet = set;
        write.dstBinding = 1;
        write.dstArrayElement = offset;
        write.descriptorCount = data.dataSize;
        write.descriptorType = VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }

  private:
    VkPhysicalDeviceDescriptorIndexingFeatures indexing_ = make<VkPhysicalDeviceDescriptorIndexingFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES);
    VkPhysicalDeviceInlineUniformBlockFeatures inline_ = make<VkPhysicalDeviceInlineUniformBlockFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_INLINE_UNIFORM_BLOCK_FEATURES);
};

TEST_F(DescriptorIndexingTest, inlineUniformBlocks) {
    const VkDescriptorSetLayout layout =
        makeSetLayout({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                       {VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, 32, VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT}},
                      VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT);
    const VkDescriptorPool from =
        makePool({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8}, {VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, 96}}, 2);
    const std::array<VkDescriptorSet, 2> sets{allocate(from, layout), allocate(from, layout)};
    const TestBuffer out = makeStorage(8);
    for (const VkDescriptorSet set : sets) writeBuffer(set, 0, 0, out);
    const Compute compute = makePipelineOf(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uvec4 v[2]; };
layout(set = 0, binding = 1) uniform Block { uvec4 a, b; };
void main() { v[0] = a; v[1] = b; })",
                                           layout, sets[0]);
    writeBlock(sets[0], 0, {1, 2, 3, 4, 5, 6, 7, 8});
    const VkCommandBuffer commands = begin();
    dispatch(commands, compute, 1);
    writeBlock(sets[0], 12, {40, 50});  // after it is bound
    submit(commands);
    EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 8), (std::vector<uint32_t>{1, 2, 3, 40, 50, 6, 7, 8}));
    // Copied, with another part written through a template.
    auto copy = make<VkCopyDescriptorSet>(VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET);
    copy.srcSet = sets[0];
    copy.dstSet = sets[1];
    copy.srcBinding = copy.dstBinding = 1;
    copy.srcArrayElement = 8;
    copy.dstArrayElement = 4;
    copy.descriptorCount = 16;
    writeBlock(sets[1], 0, {0, 0, 0, 0, 0, 0, 0, 0});
    vkUpdateDescriptorSets(device, 0, nullptr, 1, &copy);
    const VkDescriptorUpdateTemplateEntry entry{1, 28, 4, VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK, 4, 0};
    auto templateInfo =
        make<VkDescriptorUpdateTemplateCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_UPDATE_TEMPLATE_CREATE_INFO);
    templateInfo.descriptorUpdateEntryCount = 1;
    templateInfo.pDescriptorUpdateEntries = &entry;
    templateInfo.templateType = VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_DESCRIPTOR_SET;
    templateInfo.descriptorSetLayout = layout;
    VkDescriptorUpdateTemplate made = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorUpdateTemplate(device, &templateInfo, nullptr, &made), VK_SUCCESS);
    const std::array<uint32_t, 2> data{0, 99};
    vkUpdateDescriptorSetWithTemplate(device, sets[1], made, data.data());
    vkDestroyDescriptorUpdateTemplate(device, made, nullptr);
    Compute other = compute;
    other.set = sets[1];
    run(other, 1);
    EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 8), (std::vector<uint32_t>{0, 3, 40, 50, 6, 0, 0, 99}));
    if (validated()) return;
    (void)allocate(from, layout, nullptr, VK_ERROR_OUT_OF_POOL_MEMORY);  // bytes are left, but no block
    writeBlock(sets[0], 28, {1, 2, 3});                                  // stays inside
    writeBlock(sets[0], 4000, {1});
    run(compute, 1);
    EXPECT_EQ(words(out)[7], 1u);
}

// Each dispatch sees what was pushed before it, and what was not pushed again stays.
TEST_F(DescriptorIndexingTest, pushedDescriptors) {
    const VkDescriptorSetLayout layout =
        makeSetLayout({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
                      VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR);
    const Compute compute = makePipelineOf(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint to; };
layout(set = 0, binding = 1) buffer In { uint from; };
void main() { to = to * 10 + from; })",
                                           layout, VK_NULL_HANDLE);
    std::array<TestBuffer, 2> outs{makeStorage(1), makeStorage(1)};
    std::array<TestBuffer, 3> ins{makeStorage(1), makeStorage(1), makeStorage(1)};
    for (uint32_t n = 0; n < 3; ++n) *words(ins[n]) = n + 1;
    const auto push = command<PFN_vkCmdPushDescriptorSetKHR>("vkCmdPushDescriptorSetKHR");
    const auto pushTemplate =
        command<PFN_vkCmdPushDescriptorSetWithTemplateKHR>("vkCmdPushDescriptorSetWithTemplateKHR");
    ASSERT_NE(push, nullptr);
    ASSERT_NE(pushTemplate, nullptr);
    const VkDescriptorUpdateTemplateEntry entry{1, 0, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 0, 0};
    auto templateInfo =
        make<VkDescriptorUpdateTemplateCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_UPDATE_TEMPLATE_CREATE_INFO);
    templateInfo.descriptorUpdateEntryCount = 1;
    templateInfo.pDescriptorUpdateEntries = &entry;
    templateInfo.templateType = VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_PUSH_DESCRIPTORS_KHR;
    templateInfo.pipelineBindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    templateInfo.pipelineLayout = compute.layout;
    VkDescriptorUpdateTemplate made = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateDescriptorUpdateTemplate(device, &templateInfo, nullptr, &made), VK_SUCCESS);

    const VkCommandBuffer commands = begin();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.pipeline);
    const auto pushOne = [&](uint32_t binding, const TestBuffer& buffer) {
        const VkDescriptorBufferInfo info{buffer.buffer, 0, VK_WHOLE_SIZE};
        const VkWriteDescriptorSet write = writeOf(VK_NULL_HANDLE, binding, 0, info);
        push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.layout, 0, 1, &write);
    };
    const auto dispatchOnce = [&] {
        vkCmdDispatch(commands, 1, 1, 1);
        makeVisible(commands);
    };
    pushOne(0, outs[0]);
    pushOne(1, ins[0]);
    dispatchOnce();
    pushOne(1, ins[1]);
    dispatchOnce();
    pushOne(0, outs[1]);
    dispatchOnce();
    const VkDescriptorBufferInfo third{ins[2].buffer, 0, VK_WHOLE_SIZE};
    pushTemplate(commands, made, compute.layout, 0, &third);
    dispatchOnce();
    submit(commands);
    vkDestroyDescriptorUpdateTemplate(device, made, nullptr);
    EXPECT_EQ(*words(outs[0]), 12u);
    EXPECT_EQ(*words(outs[1]), 23u);
}

TEST_F(DescriptorIndexingTest, setsOfTheirOwnSize) {
    const VkDescriptorSetLayout layout = makeSetLayout(
        {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
         {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kArray,
          VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT | VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT}},
        0);
    const VkDescriptorPool from = makePool({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 10}});
    const uint32_t count = 7;
    const VkDescriptorSet set = allocate(from, layout, &count);
    const TestBuffer out = makeStorage(64);
    writeBuffer(set, 0, 0, out);
    std::vector<TestBuffer> buffers;
    for (uint32_t n = 0; n < count; ++n) {
        buffers.push_back(makeStorage(4));
        words(buffers.back())[1] = n + 100;
        if (n != 2) writeBuffer(set, 1, n, buffers.back());
    }
    // Every invocation looks into another buffer.
    const Compute compute = makePipelineOf(R"(#version 450
#extension GL_EXT_nonuniform_qualifier : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { uint v[64]; };
layout(set = 0, binding = 1) buffer Each { uint a, b; } each[];
void main() {
    uint n = gl_LocalInvocationIndex % 7;
    v[gl_LocalInvocationIndex] = n == 2 ? 1000u : each[nonuniformEXT(n)].b;
})",
                                           layout, set);
    run(compute, 1);
    for (uint32_t n = 0; n < 64; ++n) EXPECT_EQ(words(out)[n], n % 7 == 2 ? 1000 : n % 7 + 100) << n;
    if (!validated()) (void)allocate(from, layout, &count, VK_ERROR_OUT_OF_POOL_MEMORY);

    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kArray, VK_SHADER_STAGE_ALL,
                                               nullptr};
    const VkDescriptorBindingFlags flags = VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT;
    auto more = make<VkDescriptorSetLayoutBindingFlagsCreateInfo>(
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO);
    more.bindingCount = 1;
    more.pBindingFlags = &flags;
    auto info = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &more);
    info.bindingCount = 1;
    info.pBindings = &binding;
    auto most = make<VkDescriptorSetVariableDescriptorCountLayoutSupport>(
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_LAYOUT_SUPPORT);
    auto support = make<VkDescriptorSetLayoutSupport>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_SUPPORT, &most);
    vkGetDescriptorSetLayoutSupport(device, &info, &support);
    EXPECT_TRUE(support.supported);
    EXPECT_GE(most.maxVariableDescriptorCount, 500000u);
}

// Descriptors of a set that is bound are written until it is submitted; those that nothing uses name what is gone.
TEST_F(DescriptorIndexingTest, lateUpdatesAndStaleDescriptors) {
    constexpr VkDescriptorBindingFlags kLate = VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT |
                                               VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT |
                                               VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT;
    const VkDescriptorSetLayout layout = makeSetLayout(
        {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kLate}, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8, kLate}},
        VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT);
    const VkDescriptorPool from =
        makePool({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4}, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16}});
    const std::array<VkDescriptorSet, 2> sets{allocate(from, layout), allocate(from, layout)};
    const TestBuffer out = makeStorage(64);
    const Compute compute = makePipelineOf(R"(#version 450
#extension GL_EXT_nonuniform_qualifier : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { float v[64]; };
layout(set = 0, binding = 1) uniform sampler2D images[8];
void main() {
    uint n = 2 * (gl_LocalInvocationIndex % 4) + 1;
    v[gl_LocalInvocationIndex] = textureLod(images[nonuniformEXT(n)], vec2(0.5), 0.0).x;
})",
                                           layout, sets[0]);
    std::vector<TestImage> images;
    const VkCommandBuffer fill = begin();
    for (uint32_t n = 0; n < 8; ++n) {
        images.push_back(makeImage(VK_FORMAT_R32_SFLOAT, {4, 4}, VK_IMAGE_USAGE_SAMPLED_BIT));
        toGeneral(fill, images.back());
        const VkClearColorValue value{{static_cast<float>(n), 0, 0, 0}};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(fill, images.back().image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
    }
    makeVisible(fill);
    submit(fill);
    const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE, gone = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &gone), VK_SUCCESS);
    defer([=, this] { vkDestroySampler(device, sampler, nullptr); });
    const auto writeImage = [&](VkDescriptorSet set, uint32_t element, VkImageView view, VkSampler with) {
        const VkDescriptorImageInfo info{with, view, VK_IMAGE_LAYOUT_GENERAL};
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.dstBinding = 1;
        write.dstArrayElement = element;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        write.pImageInfo = &info;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    };
    // Even descriptors are not used: their image, view and sampler die before the dispatch.
    auto viewInfo = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = VK_FORMAT_R32_SFLOAT;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    viewInfo.image = images[0].image;
    VkImageView stale = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateImageView(device, &viewInfo, nullptr, &stale), VK_SUCCESS);
    TestImage planar;
    makePlanar(planar);
    for (uint32_t n = 0; n < 8; n += 2) writeImage(sets[0], n, stale, gone);
    if (!validated()) writeImage(sets[0], 4, planar.view, gone);  // the layer wants a conversion with it
    const VkCommandBuffer commands = begin();
    dispatch(commands, compute, 1);
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    writeBuffer(sets[0], 0, 0, out);
    for (uint32_t n = 1; n < 8; n += 2) writeImage(sets[0], n, images[n].view, sampler);
    vkDestroyImageView(device, stale, nullptr);
    vkDestroyImageView(device, planar.view, nullptr);
    vkDestroySampler(device, gone, nullptr);
    auto submission = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submission.commandBufferCount = 1;
    submission.pCommandBuffers = &commands;
    ASSERT_EQ(vkQueueSubmit(queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
    // Meanwhile, what is not used is written.
    for (uint32_t round = 0; round < 100; ++round)
        for (uint32_t n = 0; n < 8; n += 2) writeImage(sets[0], n, images[(n + round) % 8].view, sampler);
    ASSERT_EQ(vkQueueWaitIdle(queue), VK_SUCCESS);
    const auto* values = static_cast<const float*>(out.data);
    for (uint32_t n = 0; n < 64; ++n) EXPECT_EQ(values[n], static_cast<float>(2 * (n % 4) + 1)) << n;
    // A copy of a set holds what it names by itself.
    std::memset(out.data, 0, out.size);
    writeBuffer(sets[1], 0, 0, out);
    auto copy = make<VkCopyDescriptorSet>(VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET);
    copy.srcSet = sets[0];
    copy.dstSet = sets[1];
    copy.srcBinding = copy.dstBinding = 1;
    copy.descriptorCount = 8;
    vkUpdateDescriptorSets(device, 0, nullptr, 1, &copy);
    for (uint32_t n = 1; n < 8; n += 2) writeImage(sets[0], n, images[0].view, sampler);
    Compute other = compute;
    other.set = sets[1];
    run(other, 1);
    for (uint32_t n = 0; n < 64; ++n) EXPECT_EQ(values[n], static_cast<float>(2 * (n % 4) + 1)) << n;
}

// As many descriptors in a set as may be updated after it is bound; all but two of them are never written.
TEST_F(DescriptorIndexingTest, updatesAfterBindingByTheMillion) {
    const auto limits = properties<VkPhysicalDeviceDescriptorIndexingProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_PROPERTIES);
    const uint32_t count = limits.maxPerStageUpdateAfterBindResources;
    for (const uint32_t other :
         {limits.maxPerStageDescriptorUpdateAfterBindSamplers,
          limits.maxPerStageDescriptorUpdateAfterBindUniformBuffers,
          limits.maxPerStageDescriptorUpdateAfterBindStorageBuffers,
          limits.maxPerStageDescriptorUpdateAfterBindSampledImages,
          limits.maxPerStageDescriptorUpdateAfterBindStorageImages, limits.maxDescriptorSetUpdateAfterBindSamplers,
          limits.maxDescriptorSetUpdateAfterBindUniformBuffers, limits.maxDescriptorSetUpdateAfterBindStorageBuffers,
          limits.maxDescriptorSetUpdateAfterBindSampledImages, limits.maxDescriptorSetUpdateAfterBindStorageImages}) {
        ASSERT_EQ(other, count);
    }
    ASSERT_GE(limits.maxUpdateAfterBindDescriptorsInAllPools, count);
    const VkDescriptorSetLayout layout =
        makeSetLayout({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count,
                        VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT | VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT}},
                      VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT);
    const VkDescriptorSet set = allocate(makePool({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count}}), layout);
    const Compute compute = makePipelineOf(R"(#version 450
#extension GL_EXT_nonuniform_qualifier : require
layout(set = 0, binding = 0) buffer Words { uint word; } words[];
void main() { words[words[0].word].word = 7u; })",
                                           layout, set);
    const TestBuffer first = makeStorage(4), last = makeStorage(4);
    words(first)[0] = count - 1;
    const VkCommandBuffer commands = begin();
    dispatch(commands, compute, 1);
    writeBuffer(set, 0, 0, first);
    writeBuffer(set, 0, count - 1, last);
    submit(commands);
    EXPECT_EQ(words(last)[0], 7u);
}

}  // namespace
}  // namespace vernier::test
