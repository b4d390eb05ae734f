// Draws as large, and with as much, as the limits of the device allow.
#include <array>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class DrawLimitsTest : public ComputeTest {
  protected:
    void SetUp() override {
        ComputeTest::SetUp();
        VkPhysicalDeviceProperties properties{};
        vkGetPhysicalDeviceProperties(physicalDevice, &properties);
        limits_ = properties.limits;
    }
    TestImage target(VkExtent2D extent, uint32_t layers = 1) {
        return makeImage(VK_FORMAT_R8G8B8A8_UNORM, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_1_BIT,
                         layers);
    }
    /// Draws `vertices` of a vertex shader in white and counts the white pixels.
    uint32_t whitePixels(VkPrimitiveTopology topology, const std::string& vertexMain, uint32_t vertices,
                         float lineWidth) {
        const TestImage image = target({300, 300});
        const Pass pass = makePass(image);
        PipelineDesc desc;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, "#version 450\nvoid main() { " + vertexMain + " }");
        desc.fragment = constantColor("1");
        desc.extent = image.extent;
        desc.change = [&](const PipelineStates& states) {
            states.assembly.topology = topology;
            states.raster.lineWidth = lineWidth;
        };
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, vertices, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        uint32_t count = 0;
        for (uint32_t i = 0; i < 300 * 300; ++i) count += pixelAt(texels, image, i % 300, i / 300) == ~0u ? 1 : 0;
        return count;
    }

    VkPhysicalDeviceLimits limits_{};
};

TEST_F(DrawLimitsTest, verticesOfAllAttributesAndBindings) {
    const uint32_t count = limits_.maxVertexInputAttributes;
    ASSERT_EQ(limits_.maxVertexInputBindings, count);
    const uint32_t stride = limits_.maxVertexInputBindingStride;
    const TestBuffer in = makeBuffer(VkDeviceSize{4} * stride + 4, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    const TestBuffer out = makeStorage(2 * count);
    PipelineDesc desc;
    std::string glsl = "#version 450\nlayout(set = 0, binding = 0) buffer Out { uint values[]; };\n", body;
    for (uint32_t i = 0; i < count; ++i) {
        // A byte at the end of each stride, or with the farthest offset.
        const uint32_t offset = i % 2 == 0 ? limits_.maxVertexInputAttributeOffset : i;
        desc.bindings.push_back({i, stride, VK_VERTEX_INPUT_RATE_VERTEX});
        desc.attributes.push_back({i, i, VK_FORMAT_R8_UINT, offset});
        static_cast<uint8_t*>(in.data)[offset] = static_cast<uint8_t>(100 + offset % 97);
        static_cast<uint8_t*>(in.data)[stride + offset] = static_cast<uint8_t>(150 + offset % 97);
        const std::string n = std::to_string(i);
        glsl += "layout(location = " + n + ") in uint a" + n + ";\n";
        body += "values[gl_VertexIndex * " + std::to_string(count) + " + " + n + "] = a" + n + ";\n";
    }
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT,
                             glsl + "void main() { gl_Position = vec4(0); gl_PointSize = 1;\n" + body + "}");
    desc.fragment = constantColor("1");
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeSet({storageBuffer(out)}, &setLayout);
    desc.layout = makeLayout({setLayout}, 0);
    const TestImage image = target({4, 4});
    const Pass pass = makePass(image);
    desc.extent = image.extent;
    desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST; };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
    const std::vector<VkBuffer> buffers(count, in.buffer);
    const std::vector<VkDeviceSize> offsets(count, 0);
    vkCmdBindVertexBuffers(commands, 0, count, buffers.data(), offsets.data());
    vkCmdDraw(commands, 2, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    makeVisible(commands);
    submit(commands);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t offset = desc.attributes[i].offset;
        EXPECT_EQ(words(out)[i], 100 + offset % 97);
        EXPECT_EQ(words(out)[count + i], 150 + offset % 97);
    }
}

TEST_F(DrawLimitsTest, interfacesOfAllComponents) {
    const uint32_t components = limits_.maxVertexOutputComponents;
    ASSERT_EQ(limits_.maxFragmentInputComponents, components);
    std::string outputs = "#version 450\n", inputs = outputs, writes, sum = "0";
    // gl_Position counts, too.
    const uint32_t locations = components / 4 - 1;
    for (uint32_t i = 0; i < locations; ++i) {
        const std::string n = std::to_string(i);
        outputs += "layout(location = " + n + ") out vec4 v" + n + ";\n";
        inputs += "layout(location = " + n + ") in vec4 v" + n + ";\n";
        writes += "v" + n + " = vec4(" + n + ", 1, 2, 3);\n";
        sum += " + dot(v" + n + ", vec4(1))";
    }
    const TestImage image = makeImage(VK_FORMAT_R32_SFLOAT, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex =
        makeShader(VK_SHADER_STAGE_VERTEX_BIT, outputs +
                                                   "out gl_PerVertex { vec4 gl_Position; };\n"
                                                   "void main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1,"
                                                   " gl_VertexIndex == 2 ? 3 : -1, 0, 1);\n" +
                                                   writes + "}");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT,
                               inputs + "layout(location = 0) out float color;\nvoid main() { color = " + sum + "; }");
    desc.extent = image.extent;
    drawTriangle(pass, makePipeline(pass.pass, desc));
    const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    float found = 0;
    std::memcpy(&found, texels.data(), sizeof found);
    EXPECT_EQ(found, static_cast<float>(locations * (locations - 1) / 2 + 6 * locations));
}

// All colour attachments are drawn to, and then all of them are input attachments of a second subpass.
TEST_F(DrawLimitsTest, attachmentsOfAllNumbers) {
    const uint32_t count = limits_.maxColorAttachments;
    ASSERT_EQ(limits_.maxFragmentOutputAttachments, count);
    ASSERT_EQ(limits_.maxPerStageDescriptorInputAttachments, count);
    ASSERT_EQ(limits_.maxDescriptorSetInputAttachments, count);
    std::vector<TestImage> images;
    std::vector<VkAttachmentDescription> attachments;
    std::vector<VkAttachmentReference> outputs, inputs;
    std::vector<VkImageView> views;
    std::vector<TestDescriptor> descriptors;
    std::string writes = "#version 450\n", writeBody, reads = writes, sum = "0";
    for (uint32_t i = 0; i <= count; ++i) {
        images.push_back(makeImage(VK_FORMAT_R32_UINT, {8, 8},
                                   VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT));
        attachments.push_back({0, VK_FORMAT_R32_UINT, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_CLEAR,
                               VK_ATTACHMENT_STORE_OP_STORE, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                               VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_UNDEFINED,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
        views.push_back(images[i].view);
        if (i == count) break;
        outputs.push_back({i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
        inputs.push_back({i, VK_IMAGE_LAYOUT_GENERAL});
        descriptors.push_back({VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_NULL_HANDLE, VK_NULL_HANDLE, images[i].view,
                               VK_NULL_HANDLE, VK_SHADER_STAGE_FRAGMENT_BIT, VK_WHOLE_SIZE});
        const std::string n = std::to_string(i);
        writes += "layout(location = " + n + ") out uint o" + n + ";\n";
        writeBody += "o" + n + " = 1u << " + n + ";\n";
        reads += "layout(input_attachment_index = " + n + ", set = 0, binding = " + n + ") uniform usubpassInput i" +
                 n + ";\n";
        sum += " + subpassLoad(i" + n + ").x";
    }
    const VkAttachmentReference last{count, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpasses[2] = {};
    subpasses[0].colorAttachmentCount = subpasses[1].inputAttachmentCount = count;
    subpasses[0].pColorAttachments = outputs.data();
    subpasses[1].pInputAttachments = inputs.data();
    subpasses[1].colorAttachmentCount = 1;
    subpasses[1].pColorAttachments = &last;
    const VkSubpassDependency dependency{0,
                                         1,
                                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                         VK_ACCESS_INPUT_ATTACHMENT_READ_BIT,
                                         VK_DEPENDENCY_BY_REGION_BIT};
    auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount = count + 1;
    info.pAttachments = attachments.data();
    info.subpassCount = 2;
    info.pSubpasses = subpasses;
    info.dependencyCount = 1;
    info.pDependencies = &dependency;
    Pass pass;
    pass.extent = {8, 8};
    pass.clears.resize(count + 1);
    ASSERT_EQ(vkCreateRenderPass(device, &info, nullptr, &pass.pass), VK_SUCCESS);
    makeFramebuffer(pass, views);
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeSet(descriptors, &setLayout);
    PipelineDesc desc;
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, writes + "void main() { " + writeBody + " }");
    desc.colorCount = count;
    desc.extent = pass.extent;
    const VkPipeline first = makePipeline(pass.pass, desc);
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT,
                               reads + "layout(location = 0) out uint color;\nvoid main() { color = " + sum + "; }");
    desc.colorCount = 1;
    desc.subpass = 1;
    desc.layout = makeLayout({setLayout}, 0);
    const VkPipeline second = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, first);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, second);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    const std::vector<uint8_t> texels = readImage(images[count], VK_IMAGE_ASPECT_COLOR_BIT, 4);
    EXPECT_EQ(pixelAt(texels, images[count], 7, 7), (1u << count) - 1);
}

// Each counts against the limit of combined output resources; one is written, by a number that the shader reads.
TEST_F(DrawLimitsTest, fragmentsWriteToBuffersByTheThousand) {
    constexpr uint32_t kBuffers = 4096;
    ASSERT_GE(limits_.maxFragmentCombinedOutputResources, kBuffers + 1);
    const TestBuffer few = makeStorage(1), last = makeStorage(1);
    const VkDescriptorSetLayout setLayout =
        makeSetLayout({{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBuffers, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}});
    const VkDescriptorSet set = makeEmptySet(setLayout, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBuffers}});
    std::vector<VkDescriptorBufferInfo> buffers(kBuffers, {few.buffer, 0, VK_WHOLE_SIZE});
    buffers.back().buffer = last.buffer;
    auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.descriptorCount = kBuffers;
    write.pBufferInfo = buffers.data();
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    const TestImage image = target({8, 8});
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
        layout(set = 0, binding = 0) buffer Out { uint count; } outs[4096];
        layout(location = 0) out vec4 color;
        void main() { color = vec4(1); atomicAdd(outs[4095 + outs[0].count].count, 1); })");
    desc.layout = makeLayout({setLayout}, 0);
    desc.extent = image.extent;
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    makeVisible(commands);
    submit(commands);
    EXPECT_EQ(words(last)[0], 64u);
}

TEST_F(DrawLimitsTest, indicesOfAllBits) {
    ASSERT_EQ(limits_.maxDrawIndexedIndexValue, UINT32_MAX);
    const TestImage image = target({8, 8});
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.extent = image.extent;
    desc.fragment = constantColor("1");
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    uint n = uint(gl_VertexIndex);
    gl_Position = vec4(n == 0xFFFFFFFEu ? 3 : -1, n == 0xFFFFFFFFu ? 3 : -1, n >= 0x80000000u ? 0 : 2, 1);
})");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer indices = makeBuffer(12, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const std::array<uint32_t, 3> values{0x80000000u, 0xFFFFFFFEu, 0xFFFFFFFFu};
    std::memcpy(indices.data, values.data(), sizeof values);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t i = 0; i < 64; ++i) ASSERT_EQ(pixelAt(texels, image, i % 8, i / 8), ~0u) << i;
}

TEST_F(DrawLimitsTest, framebuffersAndViewportsOfTheLargestSizes) {
    ASSERT_GE(limits_.maxViewportDimensions[0], limits_.maxFramebufferWidth);
    ASSERT_GE(limits_.maxViewportDimensions[1], limits_.maxFramebufferHeight);
    for (const VkExtent2D extent :
         {VkExtent2D{limits_.maxFramebufferWidth, 3}, VkExtent2D{3, limits_.maxFramebufferHeight}}) {
        const TestImage image = target(extent);
        const Pass pass = makePass(image);
        PipelineDesc desc;
        desc.vertex = fullScreen();
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
            layout(location = 0) out vec4 color;
            void main() { uvec2 at = uvec2(gl_FragCoord.xy); color = vec4(at & 255u, at >> 8) / 255.0; })");
        desc.extent = extent;
        drawTriangle(pass, makePipeline(pass.pass, desc));
        const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        const uint32_t x = extent.width - 1, y = extent.height - 1;
        EXPECT_EQ(pixelAt(texels, image, x, y), (x & 255) | (y & 255) << 8 | x >> 8 << 16 | y >> 8 << 24);
    }
}

// A viewport at the end of its bounds: what lies inside the framebuffer is where it should be.
TEST_F(DrawLimitsTest, viewportsAtTheEndsOfTheirBounds) {
    const TestImage image = target({8, 8});
    for (const float x : {limits_.viewportBoundsRange[0], -8.0f}) {
        const Pass pass = makePass(image);
        PipelineDesc desc;
        desc.vertex = fullScreen();
        desc.fragment = constantColor("1");
        desc.extent = image.extent;
        const float width = x == -8.0f ? 16.0f : static_cast<float>(limits_.maxViewportDimensions[0]);
        const VkViewport viewport{x, x, width, width, 0, 1};
        desc.change = [&](const PipelineStates& states) { states.viewport.pViewports = &viewport; };
        drawTriangle(pass, makePipeline(pass.pass, desc));
        const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        EXPECT_EQ(pixelAt(texels, image, 4, 4), x == -8.0f ? ~0u : 0u);
    }
}

TEST_F(DrawLimitsTest, framebuffersOfAllLayers) {
    const TestImage image = target({2, 2}, limits_.maxFramebufferLayers);
    Pass pass = makePass(image, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, limits_.maxFramebufferLayers);
    pass.clears[0].color = {.float32 = {1, 0, 0, 1}};
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdEndRenderPass(commands);
    submit(commands);
    const std::vector<uint8_t> texels =
        readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4, limits_.maxFramebufferLayers - 1);
    EXPECT_EQ(pixelAt(texels, image, 1, 1), 0xFF0000FFu);
}

TEST_F(DrawLimitsTest, pointsAndLinesOfTheLargestSize) {
    const auto point = static_cast<uint32_t>(limits_.pointSizeRange[1]);
    const std::string size = std::to_string(limits_.pointSizeRange[1]);
    EXPECT_EQ(whitePixels(VK_PRIMITIVE_TOPOLOGY_POINT_LIST,
                          "gl_Position = vec4(0, 0, 0, 1); gl_PointSize = " + size + ";", 1, 1),
              point * point);
    EXPECT_EQ(whitePixels(VK_PRIMITIVE_TOPOLOGY_POINT_LIST,
                          "gl_Position = vec4(0.1 / 150.0, 0.1 / 150.0, 0, 1); gl_PointSize = " +
                              std::to_string(limits_.pointSizeRange[0]) + ";",
                          1, 1),
              1u);
    const std::string line = "gl_Position = vec4(gl_VertexIndex == 0 ? -0.5 : 0.5, 0, 0, 1);";
    const float width = limits_.lineWidthRange[1];
    EXPECT_EQ(whitePixels(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, line, 2, width), static_cast<uint32_t>(150 * width));
    // Strict lines are rectangles, to a granularity finer than a pixel: half a pixel more is another row, or none.
    const float finer = width / 2 + limits_.lineWidthGranularity;
    EXPECT_NEAR(static_cast<float>(whitePixels(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, line, 2, finer)), 150 * finer, 151);
    EXPECT_EQ(limits_.strictLines, VkBool32{VK_TRUE});
}

TEST_F(DrawLimitsTest, offsetsAtTheirEnds) {
    const TestImage image = makeImage(VK_FORMAT_R32_UINT, {32, 32}, VK_IMAGE_USAGE_SAMPLED_BIT);
    const TestBuffer texels = makeBuffer(32 * 32 * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    for (uint32_t i = 0; i < 32 * 32; ++i) words(texels)[i] = i;
    const VkCommandBuffer commands = begin();
    toGeneral(commands, image);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {32, 32, 1};
    vkCmdCopyBufferToImage(commands, texels.buffer, image.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    makeVisible(commands);
    submit(commands);
    auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    const TestBuffer out = makeStorage(4);
    const auto pair = [](int32_t low, uint32_t high) {
        return "ivec2(" + std::to_string(low) + ", " + std::to_string(high) + ")";
    };
    const std::string ends = pair(limits_.minTexelOffset, limits_.maxTexelOffset);
    const std::string gatherEnds = pair(limits_.minTexelGatherOffset, limits_.maxTexelGatherOffset);
    run(makeCompute("#version 450\nlayout(set = 0, binding = 0) buffer Out { uint values[4]; };\n"
                    "layout(set = 0, binding = 1) uniform usampler2D image;\nvoid main() {\n"
                    "vec2 at = vec2(16.5) / 32;\nvalues[0] = textureLodOffset(image, at, 0, " +
                        ends + ").x;\nvalues[1] = texelFetchOffset(image, ivec2(16), 0, " + ends +
                        ").x;\nvalues[2] = textureGatherOffset(image, vec2(16.25) / 32, " + gatherEnds + ").y;\n}",
                    {storageBuffer(out), sampledImage(image.view, sampler)}),
        1);
    const auto texel = [](int32_t x, int32_t y) { return static_cast<uint32_t>(32 * (16 + y) + 16 + x); };
    EXPECT_EQ(words(out)[0], texel(limits_.minTexelOffset, static_cast<int32_t>(limits_.maxTexelOffset)));
    EXPECT_EQ(words(out)[1], words(out)[0]);
    EXPECT_EQ(words(out)[2], texel(limits_.minTexelGatherOffset, static_cast<int32_t>(limits_.maxTexelGatherOffset)));
}

// The place of a pixel's value, asked for at the ends of the range and one step of the smallest size inside.
TEST_F(DrawLimitsTest, interpolationOffsetsAtTheirEnds) {
    const TestImage image = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
        layout(location = 0) out vec2 place;
        void main() {
            vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
            gl_Position = vec4(p, 0, 1);
            place = (p + 1) * 2;
        })");
    const float step = 1.0f / static_cast<float>(1u << limits_.subPixelInterpolationOffsetBits);
    const std::string low = std::to_string(limits_.minInterpolationOffset);
    const std::string high = std::to_string(limits_.maxInterpolationOffset);
    desc.fragment =
        makeShader(VK_SHADER_STAGE_FRAGMENT_BIT,
                   "#version 450\nlayout(location = 0) in vec2 place;\nlayout(location = 0) out vec4 color;\n"
                   "void main() { color = vec4(interpolateAtOffset(place, vec2(" +
                       low + ", " + high + ")), interpolateAtOffset(place, vec2(" + std::to_string(step) + ", 0))); }");
    desc.extent = image.extent;
    drawTriangle(pass, makePipeline(pass.pass, desc));
    const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 16);
    float found[4];
    std::memcpy(found, texels.data() + 16 * (4 * 2 + 1), sizeof found);  // pixel (1, 2)
    EXPECT_NEAR(found[0], 1.5f + limits_.minInterpolationOffset, 1e-5f);
    EXPECT_NEAR(found[1], 2.5f + limits_.maxInterpolationOffset, 1e-5f);
    EXPECT_NEAR(found[2], 1.5f + step, 1e-5f);
    EXPECT_NEAR(found[3], 2.5f, 1e-5f);
}

}  // namespace
}  // namespace vernier::test
