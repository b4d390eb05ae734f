// Texel buffers: fetches, reads, writes, atomics and sizes, through VkBufferView.
#include "tests/vulkan/test_compute.h"

#include <gmock/gmock.h>

namespace vernier::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr VkBufferUsageFlags kTexelUsage =
    VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;

class TexelBufferTest : public ComputeTest {};

TEST_F(TexelBufferTest, fetchesConvertTexels) {
    const TestBuffer bytes = makeBuffer(64, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT), out = makeStorage(128);
    for (uint32_t i = 0; i < 64; ++i) static_cast<uint8_t*>(bytes.data)[i] = static_cast<uint8_t>(i * 4);
    const VkBufferView all = makeTexels(bytes, VK_FORMAT_R8G8B8A8_UNORM);
    const VkBufferView part = makeTexels(bytes, VK_FORMAT_R16_UINT, 16, 8);
    run(makeCompute(R"(#version 450
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) uniform samplerBuffer colors;
layout(set = 0, binding = 1) uniform usamplerBuffer numbers;
layout(set = 0, binding = 2) buffer Out { ivec4 sizes; vec4 values[16]; uvec4 outside[3]; };
void main() {
    int i = int(gl_LocalInvocationIndex);
    values[i] = texelFetch(colors, i);
    if (i == 0) sizes = ivec4(textureSize(colors), textureSize(numbers), 0, 0);
    if (i == 1) {
        outside[0] = uvec4(texelFetch(numbers, 0).r, texelFetch(numbers, 3).r, 0, 0);
        outside[1] = texelFetch(numbers, 4);
        outside[2] = texelFetch(numbers, -1);
    }
})",
                    {texelBuffer(all, false), texelBuffer(part, false), storageBuffer(out)}),
        1);
    EXPECT_EQ(words(out)[0], 16u);
    EXPECT_EQ(words(out)[1], 4u);
    const auto* values = reinterpret_cast<const float*>(words(out) + 4);
    for (uint32_t i = 0; i < 64; ++i) EXPECT_EQ(values[i], static_cast<float>(i * 4) / 255.0f) << i;
    const uint32_t* outside = words(out) + 4 + 64;
    EXPECT_EQ(outside[0], 16u * 4 | 17u * 4 << 8);
    EXPECT_EQ(outside[1], 22u * 4 | 23u * 4 << 8);
    for (const uint32_t at : {4u, 5u, 6u, 8u, 9u, 10u}) EXPECT_EQ(outside[at], 0u) << at;
}

TEST_F(TexelBufferTest, storageTexelsAreReadWrittenAndCounted) {
    const TestBuffer counts = makeBuffer(32, kTexelUsage), colors = makeBuffer(64, kTexelUsage), out = makeStorage(4);
    const VkBufferView countView = makeTexels(counts, VK_FORMAT_R32_UINT);
    const VkBufferView colorView = makeTexels(colors, VK_FORMAT_R8G8B8A8_UNORM, 16, 32);
    std::memset(colors.data, 0xEE, 64);
    run(makeCompute(R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, r32ui) uniform uimageBuffer counts;
layout(set = 0, binding = 1, rgba8) uniform imageBuffer colors;
layout(set = 0, binding = 2) buffer Out { uvec4 sizes; };
void main() {
    int i = int(gl_GlobalInvocationID.x);
    imageAtomicAdd(counts, i % 16, 1u);
    imageStore(colors, i - 4, vec4(float(i), 0.5, 0.25, 1.0));
    if (i == 0) sizes = uvec4(imageSize(counts), imageSize(colors), 0, 0);
})",
                    {texelBuffer(countView, true), texelBuffer(colorView, true), storageBuffer(out)}),
        2);
    for (uint32_t i = 0; i < 8; ++i) EXPECT_EQ(words(counts)[i], 8u) << i;
    EXPECT_EQ(words(out)[0], 8u);
    EXPECT_EQ(words(out)[1], 8u);
    // Writes outside the view are dropped, also where the buffer goes on.
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(words(colors)[i], i < 4 || i >= 12 ? 0xEEEEEEEEu : 0xFF4080FFu) << i;
}

TEST_F(TexelBufferTest, vertexShadersFetchToo) {
    const VkExtent2D extent{8, 8};
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    const TestBuffer positions = makeBuffer(64, kTexelUsage);
    const float corners[3][4] = {{-1, -1, 0.5f, 1}, {3, -1, 0.5f, 1}, {-1, 3, 0.5f, 1}};
    std::memcpy(positions.data, corners, sizeof corners);
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set =
        makeSet({texelBuffer(makeTexels(positions, VK_FORMAT_R32G32B32A32_SFLOAT), false)}, &setLayout);
    PipelineDesc desc;
    desc.extent = extent;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(set = 0, binding = 0) uniform samplerBuffer positions;
void main() { gl_Position = texelFetch(positions, gl_VertexIndex); })");
    desc.fragment = constantColor("0, 0, 1, 1");
    desc.layout = makeLayout({setLayout}, 0);
    drawTriangle(pass, makePipeline(pass.pass, desc), desc.layout, set);
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (const uint32_t at : {0u, 7u}) EXPECT_EQ(pixelAt(texels, color, at, 7 - at), 0xFFFF0000u);
}

TEST_F(TexelBufferTest, wrongViewsAreRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestBuffer buffer = makeBuffer(64, kTexelUsage);
    const auto refused = [&](VkFormat format, VkDeviceSize offset, VkDeviceSize range, const char* message) {
        auto info = make<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
        info.buffer = buffer.buffer;
        info.format = format;
        info.offset = offset;
        info.range = range;
        VkBufferView view = VK_NULL_HANDLE;
        EXPECT_NE(vkCreateBufferView(device, &info, nullptr, &view), VK_SUCCESS);
        EXPECT_THAT(messages, Contains(HasSubstr(message)));
    };
    refused(VK_FORMAT_D16_UNORM, 0, VK_WHOLE_SIZE, "D16_UNORM cannot be that of a texel buffer");
    refused(VK_FORMAT_R32_UINT, 6, VK_WHOLE_SIZE, "offset 6 is outside");
    refused(VK_FORMAT_R32_UINT, 64, VK_WHOLE_SIZE, "offset 64 is outside");
    refused(VK_FORMAT_R32G32_UINT, 0, 12, "range 12 leaves the buffer or is not whole texels of 8");
    refused(VK_FORMAT_R32_UINT, 16, 64, "range 64 leaves");
}

}  // namespace
}  // namespace vernier::test
