// What no application should hand to the driver, and one with a mistake does: commands that reach outside their
// resources, resources without memory, descriptors of the wrong kind. Each is refused or does something that stays
// inside. The memory of everything under test is followed by a canary.
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr uint8_t kCanary = 0xA5;

class HostileTest : public ComputeTest {
  protected:
    void SetUp() override {
        VERNIER_SKIP_WHEN_VALIDATED();
        ComputeTest::SetUp();
    }

    struct Guarded {
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        const uint8_t* memory = nullptr;
        VkDeviceSize used = 0, size = 0;
        bool intact() const {
            return std::all_of(memory + used, memory + size, [](uint8_t byte) { return byte == kCanary; });
        }
    };
    /// An image whose memory goes on behind it.
    Guarded guarded(VkImageType type, VkFormat format, VkExtent3D extent, uint32_t mips, uint32_t layers,
                    VkImageViewType viewType, VkImageUsageFlags usage) {
        Guarded made;
        auto info = flatImage(format, {extent.width, extent.height},
                              usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        info.flags = viewType == VK_IMAGE_VIEW_TYPE_CUBE ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
        info.imageType = type;
        info.extent.depth = extent.depth;
        info.mipLevels = mips;
        info.arrayLayers = layers;
        EXPECT_EQ(vkCreateImage(device, &info, nullptr, &made.image), VK_SUCCESS);
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device, made.image, &needs);
        made.used = needs.size;
        made.size = needs.size + 65536;
        const VkDeviceMemory memory = allocate(made.size);
        EXPECT_EQ(vkBindImageMemory(device, made.image, memory, 0), VK_SUCCESS);
        void* data = nullptr;
        EXPECT_EQ(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
        std::memset(static_cast<uint8_t*>(data) + made.used, kCanary, made.size - made.used);
        made.memory = static_cast<const uint8_t*>(data);
        defer([this, made] { vkDestroyImage(device, made.image, nullptr); });
        made.view = makeView(made.image, viewType, format,
                             {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                              type == VK_IMAGE_TYPE_3D ? 1u : VK_REMAINING_ARRAY_LAYERS});
        return made;
    }
    Guarded guardedFlat(VkImageUsageFlags usage, uint32_t mips = 1, uint32_t layers = 1) {
        return guarded(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {13, 9, 1}, mips, layers,
                       layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, usage);
    }

    /// Ends a command buffer that must have failed with a message.
    void expectFailure(VkCommandBuffer commands, const std::string& text) {
        EXPECT_EQ(vkEndCommandBuffer(commands), VK_ERROR_UNKNOWN) << text;
        ASSERT_FALSE(messages.empty()) << text;
        EXPECT_NE(messages.back().find(text), std::string::npos) << messages.back();
    }
};

TEST_F(HostileTest, clearsOfLayersThatTheFramebufferHasNot) {
    const Guarded target = guardedFlat(VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    TestImage image;
    image.view = target.view;
    image.format = VK_FORMAT_R8G8B8A8_UNORM;
    image.extent = {13, 9};
    const Pass pass = makePass(image);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, 0, {}};
    clear.clearValue.color.float32[0] = 1;
    constexpr int32_t kLow = std::numeric_limits<int32_t>::min(), kHigh = std::numeric_limits<int32_t>::max();
    const VkClearRect rects[] = {{{{0, 0}, {13, 9}}, 0, 500},
                                 {{{0, 0}, {13, 9}}, 1, 1},
                                 {{{0, 0}, {13, 9}}, 0xFFFFFFFF, 0xFFFFFFFF},
                                 {{{kLow, kLow}, {0xFFFFFFFF, 0xFFFFFFFF}}, 0, 1},
                                 {{{kHigh, kHigh}, {0xFFFFFFFF, 0xFFFFFFFF}}, 0, 1}};
    vkCmdClearAttachments(commands, 1, &clear, 5, rects);
    clear.colorAttachment = 7;
    vkCmdClearAttachments(commands, 1, &clear, 1, rects);
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_TRUE(target.intact());
    EXPECT_EQ(target.memory[0], 255);
}

TEST_F(HostileTest, renderPassesOfUnequalSamplesAreRefused) {
    const auto create = [&](VkFormat format, VkSampleCountFlagBits first, VkSampleCountFlagBits second, bool resolve) {
        std::array<VkAttachmentDescription, 2> attachments{};
        attachments[0].format = VK_FORMAT_R8G8B8A8_UNORM;
        attachments[0].samples = first;
        attachments[1].format = format;
        attachments[1].samples = second;
        const VkAttachmentReference references[2] = {{0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}};
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = resolve ? 1 : 2;
        subpass.pColorAttachments = references;
        subpass.pResolveAttachments = resolve ? references + 1 : nullptr;
        auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        info.attachmentCount = 2;
        info.pAttachments = attachments.data();
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        VkRenderPass pass = VK_NULL_HANDLE;
        const VkResult result = vkCreateRenderPass(device, &info, nullptr, &pass);
        if (result == VK_SUCCESS) vkDestroyRenderPass(device, pass, nullptr);
        return result;
    };
    constexpr auto kOne = VK_SAMPLE_COUNT_1_BIT, kFour = VK_SAMPLE_COUNT_4_BIT;
    EXPECT_EQ(create(VK_FORMAT_R8G8B8A8_UNORM, kOne, kOne, false), VK_SUCCESS);
    EXPECT_EQ(create(VK_FORMAT_R8G8B8A8_UNORM, kFour, kOne, true), VK_SUCCESS);
    EXPECT_NE(create(VK_FORMAT_R8G8B8A8_UNORM, kFour, kOne, false), VK_SUCCESS);
    EXPECT_NE(create(VK_FORMAT_R8G8B8A8_UNORM, kFour, kFour, true), VK_SUCCESS);
    EXPECT_NE(create(VK_FORMAT_R32G32B32A32_SFLOAT, kFour, kOne, true), VK_SUCCESS);
}

TEST_F(HostileTest, resourcesWithoutMemoryAreRefused) {
    auto bufferInfo = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    bufferInfo.size = 64;
    bufferInfo.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    VkBuffer empty = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateBuffer(device, &bufferInfo, nullptr, &empty), VK_SUCCESS);
    defer([this, empty] { vkDestroyBuffer(device, empty, nullptr); });
    const auto imageInfo =
        flatImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    VkImage bare = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateImage(device, &imageInfo, nullptr, &bare), VK_SUCCESS);
    defer([this, bare] { vkDestroyImage(device, bare, nullptr); });
    const TestBuffer full = makeBuffer(64, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);

    const auto refused = [&](const std::function<void(VkCommandBuffer)>& record) {
        const VkCommandBuffer commands = begin();
        record(commands);
        expectFailure(commands, "no memory bound");
    };
    constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_GENERAL;
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {4, 4, 1};
    const VkBufferCopy bytes{0, 0, 16};
    const VkClearColorValue black{};
    const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_OCCLUSION);
    refused([&](VkCommandBuffer c) { vkCmdFillBuffer(c, empty, 0, 64, 1); });
    refused([&](VkCommandBuffer c) { vkCmdUpdateBuffer(c, empty, 0, 16, full.data); });
    refused([&](VkCommandBuffer c) { vkCmdCopyBuffer(c, empty, full.buffer, 1, &bytes); });
    refused([&](VkCommandBuffer c) { vkCmdCopyBuffer(c, full.buffer, empty, 1, &bytes); });
    refused([&](VkCommandBuffer c) { vkCmdCopyBufferToImage(c, full.buffer, bare, kLayout, 1, &copy); });
    refused([&](VkCommandBuffer c) { vkCmdClearColorImage(c, bare, kLayout, &black, 1, &range); });
    refused([&](VkCommandBuffer c) { vkCmdCopyQueryPoolResults(c, queries, 0, 1, empty, 0, 4, 0); });
    const VkCommandBuffer large = begin();
    vkCmdUpdateBuffer(large, full.buffer, 0, ~VkDeviceSize{0} - 7, full.data);
    expectFailure(large, "dataSize");
}

TEST_F(HostileTest, transfersOutsideTheirResourcesStayInside) {
    const Guarded flat = guardedFlat(0, 4), array = guardedFlat(0, 1, 3);
    const Guarded volume = guarded(VK_IMAGE_TYPE_3D, VK_FORMAT_R8G8B8A8_UNORM, {5, 4, 3}, 1, 1, VK_IMAGE_VIEW_TYPE_3D,
                                   VK_IMAGE_USAGE_SAMPLED_BIT);
    const TestBuffer buffer = makeBuffer(1024, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    constexpr int32_t kLow = std::numeric_limits<int32_t>::min(), kHigh = std::numeric_limits<int32_t>::max();
    const VkOffset3D offsets[] = {{0, 0, 0}, {12, 8, 2}, {13, 9, 3}, {-1, -1, -1}, {kHigh, kHigh, kHigh}, {kLow, 0, 0}};
    const VkExtent3D extents[] = {{1, 1, 1}, {14, 1, 1}, {13, 9, 4}, {0, 0, 0}, {0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF}};
    const VkImageSubresourceLayers places[] = {{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                               {VK_IMAGE_ASPECT_COLOR_BIT, 3, 0, 1},
                                               {VK_IMAGE_ASPECT_COLOR_BIT, 77, 0, 1},
                                               {VK_IMAGE_ASPECT_COLOR_BIT, 0, 2, 9},
                                               {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0xFFFFFFFF, 0xFFFFFFFF},
                                               {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1},
                                               {0, 0, 0, 0}};
    constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_GENERAL;
    const VkImage images[] = {flat.image, array.image, volume.image};
    const VkCommandBuffer commands = begin();
    for (const VkImageSubresourceLayers& place : places) {
        for (const VkOffset3D& offset : offsets) {
            for (const VkExtent3D& extent : extents) {
                for (uint32_t i = 0; i < 3; ++i) {
                    const VkImage from = images[i], to = images[(i + 1) % 3];
                    for (const uint32_t row : {0u, 1u, 0xFFFFFFFFu}) {
                        for (const VkDeviceSize first : {VkDeviceSize{0}, VkDeviceSize{1020}, ~VkDeviceSize{3}}) {
                            const VkBufferImageCopy copy{first, row, row, place, offset, extent};
                            vkCmdCopyBufferToImage(commands, buffer.buffer, from, kLayout, 1, &copy);
                            vkCmdCopyImageToBuffer(commands, from, kLayout, buffer.buffer, 1, &copy);
                        }
                    }
                    const VkImageCopy copy{places[0], offsets[0], place, offset, extent};
                    const VkImageCopy back{place, offset, places[0], offsets[0], extent};
                    vkCmdCopyImage(commands, from, kLayout, to, kLayout, 1, &copy);
                    vkCmdCopyImage(commands, from, kLayout, to, kLayout, 1, &back);
                    const VkImageResolve resolve{place, offset, place, offset, extent};
                    vkCmdResolveImage(commands, from, kLayout, to, kLayout, 1, &resolve);
                }
            }
        }
    }
    submit(commands);
    const VkCommandBuffer more = begin();
    for (const VkImageSubresourceLayers& place : places) {
        for (const VkOffset3D& a : offsets) {
            for (const VkOffset3D& b : offsets) {
                for (uint32_t i = 0; i < 3; ++i) {
                    const VkImageBlit blit{places[0], {a, b}, place, {b, a}};
                    const VkImageBlit turned{place, {a, b}, places[0], {{0, 0, 0}, {4, 4, 1}}};
                    vkCmdBlitImage(more, images[i], kLayout, images[(i + 1) % 3], kLayout, 1, &blit, VK_FILTER_LINEAR);
                    vkCmdBlitImage(more, images[i], kLayout, images[(i + 1) % 3], kLayout, 1, &turned,
                                   VK_FILTER_NEAREST);
                }
            }
        }
        const VkImageSubresourceRange range{place.aspectMask, place.mipLevel, 0xFFFFFFFE, place.baseArrayLayer,
                                            place.layerCount};
        const VkClearColorValue white{{1, 1, 1, 1}};
        const VkClearDepthStencilValue depth{1, 1};
        for (const VkImage image : images) {
            vkCmdClearColorImage(more, image, kLayout, &white, 1, &range);
            vkCmdClearDepthStencilImage(more, image, kLayout, &depth, 1, &range);
        }
    }
    for (const VkDeviceSize offset : {VkDeviceSize{0}, VkDeviceSize{1020}, VkDeviceSize{1024}, ~VkDeviceSize{3}}) {
        vkCmdFillBuffer(more, buffer.buffer, offset, ~VkDeviceSize{0} - 3, 1);
        vkCmdUpdateBuffer(more, buffer.buffer, offset, 1024, buffer.data);
        const VkBufferCopy copies[] = {{offset, 0, ~VkDeviceSize{0}}, {0, offset, 1024}, {offset, offset, 64}};
        vkCmdCopyBuffer(more, buffer.buffer, buffer.buffer, 3, copies);
    }
    submit(more);
    EXPECT_TRUE(flat.intact());
    EXPECT_TRUE(array.intact());
    EXPECT_TRUE(volume.intact());
}

TEST_F(HostileTest, viewsOfAnotherDimensionThanTheShadersStayInside) {
    const Guarded flat = guardedFlat(VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT, 3);
    const Guarded array = guardedFlat(VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT, 1, 3);
    const Guarded cube = guarded(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {8, 8, 1}, 1, 6, VK_IMAGE_VIEW_TYPE_CUBE,
                                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
    const Guarded volume = guarded(VK_IMAGE_TYPE_3D, VK_FORMAT_R8G8B8A8_UNORM, {5, 4, 3}, 1, 1, VK_IMAGE_VIEW_TYPE_3D,
                                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
    auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    samplerInfo.magFilter = samplerInfo.minFilter = VK_FILTER_LINEAR;
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    const TestBuffer result = makeStorage(64);
    const char* bodies[] = {
        "layout(set=0,binding=0) uniform sampler1D t; vec4 f(float x) { return textureLod(t, x, 0.0) + "
        "textureGrad(t, x, 0.1, 0.1); }",
        "layout(set=0,binding=0) uniform sampler2D t; vec4 f(float x) { return textureLod(t, vec2(x), x) + "
        "textureGrad(t, vec2(x), vec2(0.1), vec2(0.1)) + texelFetch(t, ivec2(x * 4.0), 0) + textureGather(t, vec2(x)); "
        "}",
        "layout(set=0,binding=0) uniform sampler3D t; vec4 f(float x) { return textureLod(t, vec3(x), 0.0) + "
        "texelFetch(t, ivec3(x), 0) + textureGrad(t, vec3(x), vec3(0.1), vec3(0.1)); }",
        "layout(set=0,binding=0) uniform samplerCube t; vec4 f(float x) { return textureLod(t, vec3(x, 1.0, 0.2), 0.0) "
        "+ textureGrad(t, vec3(x), vec3(0.1), vec3(0.1)); }",
        "layout(set=0,binding=0) uniform sampler2DArray t; vec4 f(float x) { return textureLod(t, vec3(x), 0.0) + "
        "texelFetch(t, ivec3(x), 0) + vec4(textureSize(t, 0), 0); }",
    };
    const auto runWithEach = [&](const Compute& compute, VkDescriptorType type) {
        for (const Guarded* with : {&flat, &array, &cube, &volume}) {
            const VkDescriptorImageInfo image{sampler, with->view, VK_IMAGE_LAYOUT_GENERAL};
            auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
            write.dstSet = compute.set;
            write.descriptorCount = 1;
            write.descriptorType = type;
            write.pImageInfo = &image;
            vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
            run(compute, 1);
            EXPECT_TRUE(with->intact());
        }
    };
    for (const char* body : bodies) {
        runWithEach(makeCompute("#version 450\nlayout(local_size_x = 16) in;\n"
                                "layout(set = 0, binding = 1) buffer R { vec4 r[]; };\n" +
                                    std::string(body) +
                                    "\nvoid main() { r[gl_LocalInvocationIndex] = "
                                    "f(float(gl_LocalInvocationIndex) / 3.0); }",
                                {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, storageBuffer(result)}),
                    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    }
    const char* stores[] = {
        "layout(set=0,binding=0,rgba8) uniform image1D t; void s(int i) { imageStore(t, i, vec4(1)); }",
        "layout(set=0,binding=0,rgba8) uniform image2D t; void s(int i) { imageStore(t, ivec2(i), vec4(1)); }",
        "layout(set=0,binding=0,rgba8) uniform image3D t; void s(int i) { imageStore(t, ivec3(i), vec4(1)); }",
        "layout(set=0,binding=0,rgba8) uniform imageCube t; void s(int i) { imageStore(t, ivec3(i), vec4(1)); }",
        "layout(set=0,binding=0,rgba8) uniform image2DArray t; void s(int i) { imageStore(t, ivec3(0,0,i), vec4(1)); }",
    };
    for (const char* body : stores) {
        runWithEach(makeCompute("#version 450\nlayout(local_size_x = 64) in;\n" + std::string(body) +
                                    "\nvoid main() { s(int(gl_LocalInvocationIndex) - 16); "
                                    "s(int(0x7FFFFFF0 + gl_LocalInvocationIndex)); }",
                                {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}),
                    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    }
}

TEST_F(HostileTest, descriptorsThatAreMissingOrOfAnotherTypeReadAsZero) {
    const char* source = R"(#version 450
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) buffer R { uint r[]; };
layout(set = 0, binding = 1) buffer A { uint a[]; };
layout(set = 0, binding = 2) uniform B { uvec4 b[4]; };
layout(set = 0, binding = 3) uniform sampler2D c;
layout(set = 0, binding = 4, r32ui) uniform uimage2D d;
layout(set = 3, binding = 200) buffer E { uint e[]; };
layout(push_constant) uniform P { uint p[32]; };
void main() {
    uint i = gl_LocalInvocationIndex;
    r[i] = a[i] + b[i].x + uint(textureLod(c, vec2(0.5), 0.0).a) + imageLoad(d, ivec2(0)).x + e[i] + p[i] + 7u;
    a[i] = 5u;
    e[i] = 5u;
    imageStore(d, ivec2(i), uvec4(1u));
    imageAtomicAdd(d, ivec2(0), 1u);
})";
    const TestBuffer result = makeStorage(4);
    // The other bindings exist with other types, and nothing was ever written to them.
    const Compute compute = makeCompute(source, {storageBuffer(result),
                                                 {VK_DESCRIPTOR_TYPE_SAMPLER},
                                                 {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                                                 {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                                 {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}});
    run(compute, 1);
    for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(words(result)[i], 7u);
    // No set is bound at all.
    const VkCommandBuffer commands = begin();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.pipeline);
    vkCmdDispatch(commands, 1, 1, 1);
    const uint32_t pushed[64] = {};
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 252, 8, pushed);
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0xFFFFFFF0, 256, pushed);
    const VkDescriptorSet sets[10] = {compute.set, compute.set};
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.layout, 6, 10, sets, 0, nullptr);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.layout, 0xFFFFFFFF, 2, sets, 0, nullptr);
    vkCmdDispatch(commands, 1, 1, 1);
    submit(commands);
}

TEST_F(HostileTest, dynamicOffsetsBehindTheBufferReadZeros) {
    const TestBuffer source = makeStorage(64), result = makeStorage(4);
    std::fill_n(words(source), 64, 9u);
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set =
        makeSet({{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, source.buffer}, storageBuffer(result)}, &setLayout);
    const Compute compute = makeCompute(R"(#version 450
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer A { uint a[]; };
layout(set = 0, binding = 1) buffer R { uint r[]; };
void main() { r[0] = a[0]; r[1] = a[63]; r[2] = uint(a.length()); a[0] = 1u; })",
                                        {storageBuffer(source), storageBuffer(result)});
    for (const uint32_t offset : {0u, 252u, 256u, 260u, 0x80000000u, 0xFFFFFFFCu}) {
        std::fill_n(words(source), 64, 9u);
        const VkCommandBuffer commands = begin();
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compute.layout, 0, 1, &set, 1, &offset);
        vkCmdDispatch(commands, 1, 1, 1);
        makeVisible(commands);
        submit(commands);
        EXPECT_EQ(words(result)[0], offset < 256 ? 9u : 0u) << offset;
        EXPECT_EQ(words(result)[1], offset == 0 ? 9u : 0u) << offset;
        EXPECT_EQ(words(result)[2], offset < 256 ? 64 - offset / 4 : 0u) << offset;
        EXPECT_EQ(std::accumulate(words(source), words(source) + 64, 0u), offset < 256 ? 64 * 9 - 8 : 64 * 9u);
    }
}

TEST_F(HostileTest, drawsWithExtremeStateAndBuffersStayInside) {
    const Guarded target = guardedFlat(VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    TestImage image;
    image.view = target.view;
    image.format = VK_FORMAT_R8G8B8A8_UNORM;
    image.extent = {13, 9};
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) in vec4 position;
void main() { gl_Position = position + vec4(gl_VertexIndex & 1, gl_VertexIndex & 2, 0.5, 1); })");
    desc.fragment = constantColor("1, 1, 1, 1");
    desc.bindings = {{0, 16, VK_VERTEX_INPUT_RATE_VERTEX}};
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0}};
    desc.dynamic = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    desc.extent = image.extent;
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer small = makeBuffer(
        40, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    for (uint32_t i = 0; i < 10; ++i) words(small)[i] = i + 1;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const VkViewport viewports[] = {{0, 0, 13, 9, 0, 1},       {kNan, kNan, kNan, kNan, kNan, kNan},
                                    {0, 0, kInf, -kInf, 0, 1}, {-1e30f, 1e30f, 1e30f, 1e30f, 0, 1},
                                    {0, 0, 0, 0, 0, 0},        {0, 0, -13, -9, 5, -7}};
    constexpr int32_t kLow = std::numeric_limits<int32_t>::min(), kHigh = std::numeric_limits<int32_t>::max();
    const VkRect2D scissors[] = {{{0, 0}, {13, 9}},
                                 {{kLow, kLow}, {0xFFFFFFFF, 0xFFFFFFFF}},
                                 {{kHigh, kHigh}, {0xFFFFFFFF, 0xFFFFFFFF}},
                                 {{-5, -5}, {100, 100}},
                                 {{0, 0}, {0, 0}}};
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    for (const VkViewport& viewport : viewports) {
        for (const VkRect2D& scissor : scissors) {
            vkCmdSetViewport(commands, 0, 1, &viewport);
            vkCmdSetViewport(commands, 15, 3, viewports);
            vkCmdSetViewport(commands, 0xFFFFFFFF, 1, &viewport);
            vkCmdSetScissor(commands, 0, 1, &scissor);
            vkCmdSetScissor(commands, 0xFFFFFFFF, 2, scissors);
            for (const VkDeviceSize offset :
                 {VkDeviceSize{0}, VkDeviceSize{3}, VkDeviceSize{39}, VkDeviceSize{40}, ~VkDeviceSize{0}}) {
                vkCmdBindVertexBuffers(commands, 0, 1, &small.buffer, &offset);
                vkCmdBindVertexBuffers(commands, 0xFFFFFFFF, 1, &small.buffer, &offset);
                vkCmdBindIndexBuffer(commands, small.buffer, offset, VK_INDEX_TYPE_UINT32);
                vkCmdDraw(commands, 7, 2, 0xFFFFFFFE, 0xFFFFFFFF);
                vkCmdDrawIndexed(commands, 30, 1, 0xFFFFFFF0, kLow, 5);
                if (offset == 3) continue;  // the counts would be large
                vkCmdDrawIndirect(commands, small.buffer, offset, 2, 16);
                vkCmdDrawIndexedIndirect(commands, small.buffer, offset, 1000, 0xFFFFFFFF);
                vkCmdDrawIndexedIndirect(commands, small.buffer, offset, 1, 0);
            }
        }
    }
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_TRUE(target.intact());
    // As many draws as there are numbers, all of the same arguments.
    const VkCommandBuffer endless = begin();
    beginPass(endless, pass);
    vkCmdBindPipeline(endless, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDrawIndexedIndirect(endless, small.buffer, 0, 0xFFFFFFFF, 0);
    vkCmdEndRenderPass(endless);
    expectFailure(endless, "stride 0");
}

TEST_F(HostileTest, specializationsWithWrongSizesAndOffsets) {
    const VkSpecializationMapEntry entries[] = {{0, 0, 4},          {0, 2, 4}, {1, 0, 0},          {1, 0, 3},
                                                {0, 0xFFFFFFFF, 4}, {0, 4, 1}, {1, 0, ~size_t{0}}, {99, 0, 4}};
    const uint32_t data = 21;
    const VkShaderModule module = makeShader(VK_SHADER_STAGE_COMPUTE_BIT, R"(#version 450
layout(local_size_x = 1) in;
layout(constant_id = 0) const uint first = 3u;
layout(constant_id = 1) const bool second = false;
layout(set = 0, binding = 0) buffer R { uint r[]; };
void main() { r[0] = first; r[1] = uint(second); })");
    for (const VkSpecializationMapEntry& entry : entries) {
        const VkSpecializationInfo info{1, &entry, 4, &data};
        messages.clear();
        auto create = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
        create.stage = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
        create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        create.stage.module = module;
        create.stage.pName = "main";
        create.stage.pSpecializationInfo = &info;
        create.layout = makeLayout({}, 0);
        VkPipeline pipeline = VK_NULL_HANDLE;
        const VkResult made = vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &create, nullptr, &pipeline);
        EXPECT_EQ(made == VK_SUCCESS, pipeline != VK_NULL_HANDLE);
        EXPECT_EQ(made == VK_SUCCESS, messages.empty()) << "a refusal comes with a message";
        vkDestroyPipeline(device, pipeline, nullptr);
    }
}

}  // namespace
}  // namespace vernier::test
