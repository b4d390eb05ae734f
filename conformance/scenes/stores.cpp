// Scenes about outputs by other ways than plain colour: logic operations, two sources, images and buffers that shaders
// read and write by texel.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <string>
#include <vector>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkExtent2D kExtent{128, 128};

}  // namespace

Result<Scene> logic_operations() {
    SceneRecorder record("logic_operations",
                         "All sixteen logic operations of a pattern of bits on another, on normalised and on integer "
                         "colours; one write mask.");
    const uint32_t normalised = record.colorTarget("normalised", kRgba8, kExtent);
    const uint32_t integers = record.colorTarget("integers", VK_FORMAT_R8G8B8A8_UINT, kExtent);
    const uint32_t vertex = record.vertex(kCoverVertexGlsl);
    const uint32_t fragment = record.fragment(R"(#version 450
layout(push_constant) uniform Parameters { uint background; };
layout(location = 0) out vec4 normalised;
layout(location = 1) out uvec4 integers;
void main() {
    uvec2 p = uvec2(gl_FragCoord.xy) % 32u;
    uvec4 source = uvec4(p.x * 8u, p.y * 8u, (p.x ^ p.y) * 8u, 255u - p.x * 4u);
    uvec4 stored = uvec4(p.y * 7u, 255u - p.x * 8u, p.x * p.y & 255u, 128u + p.y * 4u);
    integers = background != 0u ? stored : source;
    normalised = vec4(integers) / 255.0;
}
)");
    const auto pipeline = [&] { return record.pipeline(vertex, fragment).targets(2).pushConstants(4); };
    const uint32_t background = pipeline();
    record.pass(kExtent).color(normalised, {}).color(integers, {});
    record.draw(background, 3).push(1u);
    for (int i = 0; i < 16; ++i) {
        PipelineRecorder state = pipeline().logicOp(static_cast<VkLogicOp>(i));
        if (i == 6) state.writeMask(VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_B_BIT).writeMask(0x5, 1);
        record.draw(state, 3).push(0u).scissor(i % 4 * 32, i / 4 * 32, 32, 32);
    }
    record.output(normalised);
    record.output(integers);
    return record.finish();
}

Result<Scene> dual_source() {
    SceneRecorder record("dual_source",
                         "Blending by factors from the fragment shader's second colour, as coloured glass.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t vertex = record.vertex(kCoverVertexGlsl);
    const uint32_t fragment = record.fragment(R"(#version 450
layout(location = 0, index = 0) out vec4 light;
layout(location = 0, index = 1) out vec4 glass;
void main() {
    vec2 p = gl_FragCoord.xy / 128.0;
    light = vec4(0.25 * p.x, 0.1, 0.2 * p.y, 0.5);
    glass = vec4(p.x, 1.0 - p.y, 0.5, 0.25 + 0.5 * p.y);
}
)");
    const uint32_t checker = record.texture("checker", kRgba8, {16, 16},
                                            {checkerPicture({16, 16}, 2, {235, 225, 200, 255}, {60, 90, 130, 255})});
    const uint32_t background = record.pipeline(vertex, record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy) / 8, 0); }
)"));
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(background, 3).texture(0, checker, record.sampler(VK_FILTER_NEAREST));
    constexpr std::array<std::array<VkBlendFactor, 2>, 4> kFactors{
        {{VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_SRC1_COLOR},
         {VK_BLEND_FACTOR_SRC1_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA},
         {VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR},
         {VK_BLEND_FACTOR_SRC1_COLOR, VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR}}};
    for (int i = 0; i < 4; ++i) {
        VkPipelineColorBlendAttachmentState state{};
        state.blendEnable = VK_TRUE;
        state.srcColorBlendFactor = kFactors[static_cast<size_t>(i)][0];
        state.dstColorBlendFactor = kFactors[static_cast<size_t>(i)][1];
        state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA;
        state.colorWriteMask = 0xf;
        record.draw(record.pipeline(vertex, fragment).blend(state), 3).scissor(i % 2 * 64 + 4, i / 2 * 64 + 4, 56, 56);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> storage_images() {
    SceneRecorder record("storage_images",
                         "A fragment shader loads from one image, stores to others of several formats mirrored, and "
                         "stores outside of them, which does nothing.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t source = record.storageImage("source", kRgba8, kExtent, noisePicture(kExtent, 11));
    const Bytes zeros(size_t{kExtent.width} * kExtent.height * 4);
    const uint32_t mirrored = record.storageImage("mirrored", kRgba8, kExtent, zeros);
    const uint32_t number = record.storageImage("numbers", VK_FORMAT_R32_UINT, kExtent, zeros);
    const uint32_t state = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0, rgba8) readonly uniform image2D source;
layout(binding = 1, rgba8) writeonly uniform image2D mirrored;
layout(binding = 2, r32ui) writeonly uniform uimage2D numbers;
layout(location = 0) out vec4 color;
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 here = imageLoad(source, p);
    imageStore(mirrored, ivec2(127 - p.x, p.y), here);
    imageStore(numbers, p, uvec4(uint(p.x * 1000 + p.y)));
    imageStore(numbers, p - 4096, uvec4(7u));
    color = vec4(here.bgr, 1.0);
}
)"));
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(state, 3).storageImage(0, source).storageImage(1, mirrored).storageImage(2, number);
    for (const uint32_t image : {target, mirrored, number}) record.output(image);
    return record.finish();
}

Result<Scene> texel_buffers() {
    SceneRecorder record("texel_buffers",
                         "One pass stores halves of a picture into a texel buffer; the next reads it back beside a "
                         "buffer of bytes.");
    const uint32_t stored = record.colorTarget("stored", kRgba8, kExtent);
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t bytes = record.buffer("bytes", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, noisePicture({64, 64}, 5));
    const uint32_t floats =
        record.buffer("floats", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT,
                      Bytes(size_t{kExtent.width} * kExtent.height * 4));
    const uint32_t vertex = record.vertex(kCoverVertexGlsl);
    const uint32_t write = record.pipeline(vertex, record.fragment(R"(#version 450
layout(binding = 0, r32f) writeonly uniform imageBuffer floats;
layout(binding = 1) uniform samplerBuffer bytes;
layout(location = 0) out vec4 color;
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 texel = texelFetch(bytes, (p.y / 2) * 64 + p.x / 2);
    imageStore(floats, p.y * 128 + p.x, vec4(texel.g * 0.5 + 0.25));
    color = texel;
}
)"));
    const uint32_t read = record.pipeline(vertex, record.fragment(R"(#version 450
layout(binding = 0) uniform samplerBuffer floats;
layout(location = 0) out vec4 color;
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    color = vec4(texelFetch(floats, p.x * 128 + p.y).r, textureSize(floats) == 16384 ? 1.0 : 0.0, 0.5, 1.0);
}
)"));
    record.pass(kExtent).color(stored, {0, 0, 0, 1});
    record.draw(write, 3)
        .texelBuffer(0, floats, VK_FORMAT_R32_SFLOAT, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER)
        .texelBuffer(1, bytes, kRgba8, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(read, 3).texelBuffer(0, floats, VK_FORMAT_R32_SFLOAT, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
    record.output(target);
    record.output(stored);
    return record.finish();
}

Result<Scene> storage_buffers() {
    SceneRecorder record("storage_buffers",
                         "Vertex shaders load and store records; fragment shaders store words and numbers by pixel and "
                         "count, join and compare by atomic operations; a second pass shows it all.");
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t results = record.colorTarget("results", kRgba8, kExtent);
    const std::vector<float> places{-1, -1, 3, -1, -1, 3};
    const uint32_t corners = record.buffer("corners", kStorage, places);
    const uint32_t records = record.buffer("records", kStorage, std::vector<float>(3 * 4));
    const uint32_t pixels = record.buffer("pixels", kStorage, std::vector<uint32_t>(2 * 128 * 128));
    // Eight counters, then: the least, the largest, a sum below zero, bits joined, bits left, bits flipped.
    std::vector<uint32_t> numbers(16);
    numbers[8] = 1000;
    numbers[12] = 0xffffffff;
    const uint32_t counters = record.buffer("counters", kStorage, numbers);
    constexpr const char* kBlocks = R"(
layout(std430, binding = 2) buffer Pixels { uint packed[16384]; float share[16384]; };
layout(std430, binding = 3) buffer Counters { uint histogram[8]; int least; uint most; int sum; uint any; uint all; uint odd; };
)";
    const std::string vertexGlsl = R"(#version 450
layout(std430, binding = 0) readonly buffer Corners { vec2 corners[3]; };
layout(std430, binding = 1) buffer Records { vec4 records[3]; };
void main() {
    vec2 corner = corners[gl_VertexIndex];
    records[gl_VertexIndex] = vec4(corner * 0.25 + 0.25, float(gl_VertexIndex) * 0.25, 1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";
    const std::string storeGlsl = std::string("#version 450\n") + kBlocks + R"(
layout(location = 0) out vec4 color;
void main() {
    uvec2 p = uvec2(gl_FragCoord.xy);
    uint at = p.y * 128u + p.x;
    color = vec4(p.x / 255.0, p.y / 255.0, float((p.x ^ p.y) & 31u) / 31.0, 1.0);
    packed[at] = packUnorm4x8(color.bgra);
    share[at] = gl_FragCoord.x * 0.0049 + gl_FragCoord.y * 0.0028;
    atomicAdd(histogram[(p.x * 3u + p.y) % 8u], 1u + p.x % 2u);
    atomicMin(least, int(p.x) - int(p.y));
    atomicMax(most, p.x * p.y);
    atomicAdd(sum, int(p.y % 3u) - 1);
    atomicOr(any, 1u << (p.x % 11u));
    atomicAnd(all, ~(1u << (p.y % 17u)));
    atomicXor(odd, p.x * 2654435761u ^ p.y);
}
)";
    const std::string countGlsl = std::string("#version 450\n") + kBlocks + R"(
layout(location = 0) out vec4 color;
void main() {
    atomicAdd(histogram[7], 5u);
    color = vec4(0.9, 0.6, 0.2, 1.0);
}
)";
    const std::string showGlsl = std::string("#version 450\n") + kBlocks + R"(
layout(std430, binding = 1) readonly buffer Records { vec4 records[3]; };
layout(location = 0) out vec4 color;
void main() {
    uvec2 p = uvec2(gl_FragCoord.xy);
    uint words[6] = uint[](uint(least + 200), most, uint(sum + 30000), any, all, odd);
    if (p.y < 16u) color = unpackUnorm4x8(histogram[p.x / 16u]);
    else if (p.y < 32u) color = unpackUnorm4x8(words[p.x / 22u]);
    else if (p.y < 48u) color = records[p.x / 43u];
    else if (p.y < 88u) color = unpackUnorm4x8(packed[p.x * 128u + p.y]);
    else color = vec4(share[p.x * 128u + p.y], share[p.y * 128u + p.x], 0.5, 1.0);
}
)";
    const uint32_t vertex = record.vertex(vertexGlsl);
    const auto draw = [&](uint32_t pipeline) {
        return record.draw(pipeline, 3)
            .storageBuffer(0, corners)
            .storageBuffer(1, records)
            .storageBuffer(2, pixels)
            .storageBuffer(3, counters);
    };
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    draw(record.pipeline(vertex, record.fragment(storeGlsl)));
    draw(record.pipeline(vertex, record.fragment(countGlsl))).scissor(20, 31, 57, 40);
    record.pass(kExtent).color(results, {0, 0, 0, 1});
    record.draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(showGlsl)), 3)
        .storageBuffer(1, records)
        .storageBuffer(2, pixels)
        .storageBuffer(3, counters);
    for (const uint32_t image : {results, target}) record.output(image);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
