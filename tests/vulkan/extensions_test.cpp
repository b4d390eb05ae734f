// Extensions that add a command or a state each: what they do, seen in images.
#include <array>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{64, 64};
using Texels = std::vector<uint8_t>;

class ExtensionsTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_COLOR_WRITE_ENABLE_EXTENSION_NAME,       VK_EXT_HOST_QUERY_RESET_EXTENSION_NAME,
                VK_EXT_INDEX_TYPE_UINT8_EXTENSION_NAME,         VK_EXT_PRIMITIVE_TOPOLOGY_LIST_RESTART_EXTENSION_NAME,
                VK_EXT_VERTEX_ATTRIBUTE_DIVISOR_EXTENSION_NAME, VK_EXT_MULTI_DRAW_EXTENSION_NAME,
                VK_KHR_DRAW_INDIRECT_COUNT_EXTENSION_NAME,      VK_KHR_COPY_COMMANDS_2_EXTENSION_NAME,
                VK_KHR_SHADER_DRAW_PARAMETERS_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        writes_.colorWriteEnable = resets_.hostQueryReset = indices_.indexTypeUint8 = VK_TRUE;
        restarts_.primitiveTopologyListRestart = draws_.multiDraw = VK_TRUE;
        divisors_.vertexAttributeInstanceRateDivisor = divisors_.vertexAttributeInstanceRateZeroDivisor = VK_TRUE;
        writes_.pNext = &resets_;
        resets_.pNext = &indices_;
        indices_.pNext = &restarts_;
        restarts_.pNext = &draws_;
        draws_.pNext = &divisors_;
        return &writes_;
    }
    void SetUp() override {
        DrawTest::SetUp();
        color = makeImage(
            VK_FORMAT_R8G8B8A8_UNORM, kExtent,
            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        pass = makePass(color);
    }
    PipelineDesc defaults(VkShaderModule vertex, const std::string& rgba = "1, 1, 1, 1") {
        PipelineDesc desc;
        desc.vertex = vertex;
        desc.fragment = constantColor(rgba);
        desc.extent = kExtent;
        return desc;
    }
    /// Columns of 8 pixels: column gl_DrawID of those that the draws of a command fill.
    VkShaderModule columns() {
        return makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 460
void main() {
    vec2 corner = vec2(gl_VertexIndex % 3 == 1 ? 2 : 0, gl_VertexIndex % 3 == 2 ? 2 : 0);
    gl_Position = vec4(corner * vec2(0.25, 4) + vec2(float(gl_DrawID * 2) * 0.25 - 1.0, -1), 0.5, 1);
})");
    }
    Texels render(const std::function<void(VkCommandBuffer)>& record) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        record(commands);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    }
    /// Which columns of 16 pixels are drawn in row 1, a bit each.
    uint32_t drawnColumns(const Texels& texels) const {
        uint32_t result = 0;
        for (uint32_t n = 0; n < 4; ++n) result |= (pixelAt(texels, color, n * 16 + 1, 1) != 0 ? 1u : 0u) << n;
        return result;
    }

    TestImage color;
    Pass pass;

  private:
    VkPhysicalDeviceColorWriteEnableFeaturesEXT writes_ = make<VkPhysicalDeviceColorWriteEnableFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_COLOR_WRITE_ENABLE_FEATURES_EXT);
    VkPhysicalDeviceHostQueryResetFeatures resets_ =
        make<VkPhysicalDeviceHostQueryResetFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES);
    VkPhysicalDeviceIndexTypeUint8FeaturesEXT indices_ = make<VkPhysicalDeviceIndexTypeUint8FeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_INDEX_TYPE_UINT8_FEATURES_EXT);
    VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT restarts_ =
        make<VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PRIMITIVE_TOPOLOGY_LIST_RESTART_FEATURES_EXT);
    VkPhysicalDeviceMultiDrawFeaturesEXT draws_ =
        make<VkPhysicalDeviceMultiDrawFeaturesEXT>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTI_DRAW_FEATURES_EXT);
    VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT divisors_ =
        make<VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VERTEX_ATTRIBUTE_DIVISOR_FEATURES_EXT);
};

TEST_F(ExtensionsTest, colorWritesAreFixedOrDynamic) {
    PipelineDesc green = defaults(fullScreen(), "0, 1, 0, 1");
    const VkPipeline before = makePipeline(pass.pass, green);
    for (const bool dynamic : {false, true})
        for (const VkBool32 enabled : {VK_TRUE, VK_FALSE}) {
            PipelineDesc desc = defaults(fullScreen(), "1, 0, 0, 1");
            auto writes =
                make<VkPipelineColorWriteCreateInfoEXT>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_WRITE_CREATE_INFO_EXT);
            const VkBool32 given = dynamic ? !enabled : enabled;
            writes.attachmentCount = 1;
            writes.pColorWriteEnables = &given;
            desc.change = [&](const PipelineStates& states) { states.colors.pNext = &writes; };
            if (dynamic) desc.dynamic = {VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT};
            const VkPipeline pipeline = makePipeline(pass.pass, desc);
            const Texels texels = render([&](VkCommandBuffer commands) {
                vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, before);
                vkCmdDraw(commands, 3, 1, 0, 0);
                vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
                if (dynamic)
                    command<PFN_vkCmdSetColorWriteEnableEXT>("vkCmdSetColorWriteEnableEXT")(commands, 1, &enabled);
                vkCmdDraw(commands, 3, 1, 0, 0);
            });
            EXPECT_EQ(pixelAt(texels, color, 30, 30), enabled ? 0xFF0000FFu : 0xFF00FF00u) << dynamic;
        }
}

TEST_F(ExtensionsTest, indicesOfEightBitsRestartLists) {
    const TestBuffer indices = makeBuffer(8, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    // One vertex, then 0xFF: the list begins anew, so that the triangle is 0, 1, 2 and not 1, 0, 1.
    const std::array<uint8_t, 5> values{1, 0xFF, 0, 1, 2};
    std::memcpy(indices.data, values.data(), values.size());
    PipelineDesc desc = defaults(fullScreen());
    desc.change = [](const PipelineStates& states) { states.assembly.primitiveRestartEnable = VK_TRUE; };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const Texels texels = render([&](VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT8_EXT);
        vkCmdDrawIndexed(commands, 5, 1, 0, 0, 0);
    });
    EXPECT_EQ(pixelAt(texels, color, 63, 63), ~0u);
}

TEST_F(ExtensionsTest, divisorsRepeatInstances) {
    const TestBuffer places = makeBuffer(16, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    const std::array<float, 4> values{0, 1, 2, 3};
    std::memcpy(places.data, values.data(), sizeof values);
    for (const uint32_t divisor : {0u, 1u, 2u, 5u}) {
        // Bars of 4 rows by the instance; the attribute chooses the column.
        PipelineDesc desc = defaults(makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) in float column;
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4((vec2(column, gl_InstanceIndex) + corner) / vec2(2, 8) - 1.0, 0.5, 1);
})"));
        desc.bindings = {{0, 4, VK_VERTEX_INPUT_RATE_INSTANCE}};
        desc.attributes = {{0, 0, VK_FORMAT_R32_SFLOAT, 0}};
        const VkVertexInputBindingDivisorDescriptionEXT entry{0, divisor};
        auto state = make<VkPipelineVertexInputDivisorStateCreateInfoEXT>(
            VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_DIVISOR_STATE_CREATE_INFO_EXT);
        state.vertexBindingDivisorCount = 1;
        state.pVertexBindingDivisors = &entry;
        desc.change = [&](const PipelineStates& states) {
            states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
            states.input.pNext = &state;
        };
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        // firstInstance other than 0 with a divisor other than 1 is for another extension.
        const Texels texels = render([&](VkCommandBuffer commands) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            const VkDeviceSize offset = 0;
            vkCmdBindVertexBuffers(commands, 0, 1, &places.buffer, &offset);
            vkCmdDraw(commands, 4, 4, 0, 0);
        });
        for (uint32_t bar = 0; bar < 4; ++bar)
            for (uint32_t column = 0; column < 4; ++column)
                EXPECT_EQ(pixelAt(texels, color, column * 16 + 5, bar * 4 + 2) != 0,
                          column == (divisor == 0 ? 0 : bar / divisor))
                    << divisor << " " << bar << " " << column;
    }
}

TEST_F(ExtensionsTest, indirectDrawsTakeTheirCountFromABuffer) {
    const TestBuffer arguments = makeBuffer(256, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    const TestBuffer indices = makeBuffer(16, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const std::array<uint16_t, 3> order{0, 1, 2};
    std::memcpy(indices.data, order.data(), sizeof order);
    const VkPipeline pipeline = makePipeline(pass.pass, defaults(columns()));
    constexpr VkDeviceSize kCountAt = 192;
    for (const bool indexed : {false, true})
        for (const uint32_t count : {0u, 1u, 3u, 9u}) {
            auto* bytes = static_cast<std::byte*>(arguments.data);
            std::memcpy(bytes + kCountAt, &count, 4);
            for (size_t n = 0; n < 4; ++n) {
                const VkDrawIndexedIndirectCommand wanted{3, 1, 0, 0, 0};
                const VkDrawIndirectCommand plain{3, 1, 0, 0};
                std::memcpy(bytes + n * 32, indexed ? static_cast<const void*>(&wanted) : &plain,
                            indexed ? sizeof wanted : sizeof plain);
            }
            const Texels texels = render([&](VkCommandBuffer commands) {
                vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
                vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
                const auto draw = indexed ? command<PFN_vkCmdDrawIndirectCountKHR>("vkCmdDrawIndexedIndirectCountKHR")
                                          : command<PFN_vkCmdDrawIndirectCountKHR>("vkCmdDrawIndirectCountKHR");
                draw(commands, arguments.buffer, 0, arguments.buffer, kCountAt, 4, 32);
            });
            EXPECT_EQ(drawnColumns(texels), (1u << std::min(count, 4u)) - 1) << indexed << " " << count;
        }
}

TEST_F(ExtensionsTest, severalDrawsInOneCommand) {
    const TestBuffer indices = makeBuffer(32, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const std::array<uint16_t, 9> order{3, 4, 5, 0, 1, 2, 3, 4, 5};
    std::memcpy(indices.data, order.data(), sizeof order);
    const VkPipeline pipeline = makePipeline(pass.pass, defaults(columns()));
    const std::array<VkMultiDrawInfoEXT, 3> plain{{{0, 3}, {0, 0}, {3, 3}}};
    const std::array<VkMultiDrawIndexedInfoEXT, 3> indexed{{{0, 3, -3}, {3, 0, 0}, {3, 3, 0}}};
    for (const bool withIndices : {false, true}) {
        const Texels texels = render([&](VkCommandBuffer commands) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
            if (withIndices) {
                command<PFN_vkCmdDrawMultiIndexedEXT>("vkCmdDrawMultiIndexedEXT")(commands, 3, indexed.data(), 1, 0,
                                                                                  sizeof indexed[0], nullptr);
            } else {
                command<PFN_vkCmdDrawMultiEXT>("vkCmdDrawMultiEXT")(commands, 3, plain.data(), 1, 0, sizeof plain[0]);
            }
        });
        EXPECT_EQ(drawnColumns(texels), 0b101u) << withIndices;
    }
}

TEST_F(ExtensionsTest, theHostResetsQueries) {
    const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_TIMESTAMP, 2);
    const auto reset = command<PFN_vkResetQueryPoolEXT>("vkResetQueryPoolEXT");
    reset(device, queries, 0, 2);
    const VkCommandBuffer commands = begin();
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 1);
    submit(commands);
    uint64_t time = 0;
    const auto result = [&](uint32_t query) {
        return vkGetQueryPoolResults(device, queries, query, 1, sizeof time, &time, sizeof time,
                                     VK_QUERY_RESULT_64_BIT);
    };
    EXPECT_EQ(result(0), VK_NOT_READY);
    EXPECT_EQ(result(1), VK_SUCCESS);
    reset(device, queries, 1, 1);
    EXPECT_EQ(result(1), VK_NOT_READY);
}

TEST_F(ExtensionsTest, copyCommandsTakeChains) {
    const TestBuffer from = makeBuffer(kExtent.width * kExtent.height * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const TestBuffer to = makeBuffer(from.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    auto* words = static_cast<uint32_t*>(from.data);
    for (uint32_t n = 0; n < kExtent.width * kExtent.height; ++n) words[n] = n * 2654435761u;
    const TestImage image =
        makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent,
                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const VkCommandBuffer commands = begin();
    const auto barrier = [&](VkImage of, VkImageLayout old = VK_IMAGE_LAYOUT_GENERAL) {
        changeLayout(commands, of, VK_IMAGE_ASPECT_COLOR_BIT, old, VK_IMAGE_LAYOUT_GENERAL);
    };
    const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    barrier(image.image, VK_IMAGE_LAYOUT_UNDEFINED);
    barrier(color.image, VK_IMAGE_LAYOUT_UNDEFINED);

    auto fill = make<VkBufferImageCopy2>(VK_STRUCTURE_TYPE_BUFFER_IMAGE_COPY_2);
    fill.imageSubresource = layers;
    fill.imageExtent = {kExtent.width, kExtent.height, 1};
    auto fillInfo = make<VkCopyBufferToImageInfo2>(VK_STRUCTURE_TYPE_COPY_BUFFER_TO_IMAGE_INFO_2);
    fillInfo.srcBuffer = from.buffer;
    fillInfo.dstImage = image.image;
    fillInfo.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    fillInfo.regionCount = 1;
    fillInfo.pRegions = &fill;
    command<PFN_vkCmdCopyBufferToImage2KHR>("vkCmdCopyBufferToImage2KHR")(commands, &fillInfo);
    barrier(image.image);

    // Turned round by a blit; its upper half then replaces the lower half of the first image.
    auto blit = make<VkImageBlit2>(VK_STRUCTURE_TYPE_IMAGE_BLIT_2);
    blit.srcSubresource = blit.dstSubresource = layers;
    blit.srcOffsets[1] = {64, 64, 1};
    blit.dstOffsets[0] = {64, 64, 0};
    blit.dstOffsets[1] = {0, 0, 1};
    auto blitInfo = make<VkBlitImageInfo2>(VK_STRUCTURE_TYPE_BLIT_IMAGE_INFO_2);
    blitInfo.srcImage = image.image;
    blitInfo.dstImage = color.image;
    blitInfo.srcImageLayout = blitInfo.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    blitInfo.regionCount = 1;
    blitInfo.pRegions = &blit;
    command<PFN_vkCmdBlitImage2KHR>("vkCmdBlitImage2KHR")(commands, &blitInfo);
    barrier(color.image);
    barrier(image.image);

    auto copy = make<VkImageCopy2>(VK_STRUCTURE_TYPE_IMAGE_COPY_2);
    copy.srcSubresource = copy.dstSubresource = layers;
    copy.dstOffset = {0, 32, 0};
    copy.extent = {64, 32, 1};
    auto copyInfo = make<VkCopyImageInfo2>(VK_STRUCTURE_TYPE_COPY_IMAGE_INFO_2);
    copyInfo.srcImage = color.image;
    copyInfo.dstImage = image.image;
    copyInfo.srcImageLayout = copyInfo.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    copyInfo.regionCount = 1;
    copyInfo.pRegions = &copy;
    command<PFN_vkCmdCopyImage2KHR>("vkCmdCopyImage2KHR")(commands, &copyInfo);
    barrier(image.image);

    auto readInfo = make<VkCopyImageToBufferInfo2>(VK_STRUCTURE_TYPE_COPY_IMAGE_TO_BUFFER_INFO_2);
    readInfo.srcImage = image.image;
    readInfo.srcImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    readInfo.dstBuffer = to.buffer;
    readInfo.regionCount = 1;
    readInfo.pRegions = &fill;
    command<PFN_vkCmdCopyImageToBuffer2KHR>("vkCmdCopyImageToBuffer2KHR")(commands, &readInfo);
    submit(commands);
    const auto* result = static_cast<const uint32_t*>(to.data);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x)
            ASSERT_EQ(result[y * 64 + x], words[y < 32 ? y * 64 + x : (63 - (y - 32)) * 64 + 63 - x]) << x << ", " << y;
}

TEST_F(ExtensionsTest, bufferCopiesTakeChains) {
    const TestBuffer from = makeBuffer(64, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const TestBuffer to = makeBuffer(64, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    auto* source = static_cast<uint8_t*>(from.data);
    for (uint8_t n = 0; n < 64; ++n) source[n] = static_cast<uint8_t>(n + 100);
    std::memset(to.data, 0, 64);
    std::array<VkBufferCopy2, 3> regions{};
    for (VkBufferCopy2& region : regions) region.sType = VK_STRUCTURE_TYPE_BUFFER_COPY_2;
    // The ends, crossed, and a byte in between.
    regions[0].dstOffset = 40;
    regions[0].size = 24;
    regions[1].srcOffset = 47;
    regions[1].size = 17;
    regions[2].srcOffset = 31;
    regions[2].dstOffset = 33;
    regions[2].size = 1;
    auto info = make<VkCopyBufferInfo2>(VK_STRUCTURE_TYPE_COPY_BUFFER_INFO_2);
    info.srcBuffer = from.buffer;
    info.dstBuffer = to.buffer;
    info.regionCount = regions.size();
    info.pRegions = regions.data();
    const VkCommandBuffer commands = begin();
    command<PFN_vkCmdCopyBuffer2KHR>("vkCmdCopyBuffer2KHR")(commands, &info);
    submit(commands);
    const auto* result = static_cast<const uint8_t*>(to.data);
    for (size_t n = 0; n < 64; ++n) {
        const size_t expected = n < 17 ? n + 147 : n == 33 ? 131 : n >= 40 ? n + 60 : 0;
        EXPECT_EQ(result[n], expected) << n;
    }
}

TEST_F(ExtensionsTest, resolvesTakeChains) {
    // Two of four samples are white; a region of the image, moved, gets their average.
    const TestImage samples =
        makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent,
                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_SAMPLE_COUNT_4_BIT);
    const TestImage resolved = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass sampled = makePass(samples, nullptr, &resolved);
    PipelineDesc desc = defaults(fullScreen());
    desc.samples = VK_SAMPLE_COUNT_4_BIT;
    const VkSampleMask mask = 0b0101;
    desc.change = [&mask](const PipelineStates& states) { states.multisample.pSampleMask = &mask; };
    const VkPipeline pipeline = makePipeline(sampled.pass, desc);
    auto region = make<VkImageResolve2>(VK_STRUCTURE_TYPE_IMAGE_RESOLVE_2);
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffset = {8, 4, 0};
    region.dstOffset = {30, 50, 0};
    region.extent = {20, 10, 1};
    auto info = make<VkResolveImageInfo2>(VK_STRUCTURE_TYPE_RESOLVE_IMAGE_INFO_2);
    info.srcImage = samples.image;
    info.srcImageLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    info.dstImage = color.image;
    info.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.regionCount = 1;
    info.pRegions = &region;
    const VkCommandBuffer commands = begin();
    const auto barrier = [&](VkImage of, VkImageLayout from, VkImageLayout to) {
        changeLayout(commands, of, VK_IMAGE_ASPECT_COLOR_BIT, from, to);
    };
    beginPass(commands, sampled);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    barrier(samples.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    barrier(color.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    const VkClearColorValue black{};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, color.image, VK_IMAGE_LAYOUT_GENERAL, &black, 1, &all);
    barrier(color.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
    command<PFN_vkCmdResolveImage2KHR>("vkCmdResolveImage2KHR")(commands, &info);
    barrier(color.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    submit(commands);
    const Texels texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t y = 0; y < kExtent.height; ++y)
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            const bool inside = x >= 30 && x < 50 && y >= 50 && y < 60;
            ASSERT_EQ(pixelAt(texels, color, x, y), inside ? 0x80808080u : 0u) << x << ", " << y;
        }
}

}  // namespace
}  // namespace vernier::test
