// Exact ends: the last byte of buffers, the largest offsets, images of one texel, passes on part of an image.
#include <array>
#include <cstring>
#include <limits>
#include <thread>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::Each;
using testing::ElementsAreArray;

class Edges : public ApiTest {
  protected:
    VnProgram compute(const std::string& body) {
        VnProgramDesc desc{};
        desc.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, "#version 450\n" + body);
        VnProgram result{};
        EXPECT_EQ(vnCreateProgram(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
    std::vector<uint32_t> words(VnBuffer from, size_t count) {
        std::vector<uint32_t> result(count);
        EXPECT_EQ(vnReadBuffer(context_, from, 0, result.data(), count * 4), VN_SUCCESS) << lastError();
        return result;
    }
    void run(VnProgram with, uint32_t groups = 1) {
        ASSERT_EQ(vnBindProgram(context_, with), VN_SUCCESS);
        ASSERT_EQ(vnDispatch(context_, groups, 1, 1), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnFinish(context_), VN_SUCCESS) << lastError();
    }
};

// Buffers are ranges of memory of exactly their size (ASan watches what lies behind).
TEST_F(Edges, StorageBuffersOfEverySmallSize) {
    const VnProgram reads = compute(R"(
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) buffer A { uint8_t bytes[]; };
layout(set = 0, binding = 0, std430) buffer B { uint16_t halves[]; };
layout(set = 0, binding = 0, std430) buffer C { uint words[]; };
layout(set = 0, binding = 0, std430) buffer D { uint64_t longs[]; };
layout(set = 0, binding = 1, std430) buffer R { uint result[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    result[i * 4] = uint(bytes[i]);
    result[i * 4 + 1] = uint(halves[i]);
    result[i * 4 + 2] = words[i];
    result[i * 4 + 3] = uint(longs[i]) ^ uint(longs[i] >> 32);
})");
    std::array<uint8_t, 40> data{};
    for (size_t i = 0; i < data.size(); ++i) data[i] = static_cast<uint8_t>(i * 7 + 1);
    for (const uint64_t size : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 15, 16, 17, 31, 33}) {
        const VnBuffer source = buffer(data.data(), size), result = buffer(nullptr, 64 * 16);
        ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, source, 0, 0), VN_SUCCESS);
        ASSERT_EQ(vnBindBuffer(context_, 0, 1, 0, result, 0, 0), VN_SUCCESS);
        run(reads);
        const std::vector<uint32_t> seen = words(result, 256);
        const auto at = [&](uint64_t offset, uint32_t bytes) {
            uint64_t value = 0;
            if (offset + bytes <= size) std::memcpy(&value, data.data() + offset, bytes);
            return value;
        };
        for (uint32_t i = 0; i < 64; ++i) {
            EXPECT_EQ(seen[i * 4], at(i, 1)) << size << " bytes, byte " << i;
            EXPECT_EQ(seen[i * 4 + 1], at(i * 2, 2)) << size << " bytes, half " << i;
            EXPECT_EQ(seen[i * 4 + 2], at(i * 4, 4)) << size << " bytes, word " << i;
            const uint64_t whole = at(i * 8, 8);
            EXPECT_EQ(seen[i * 4 + 3], uint32_t(whole) ^ uint32_t(whole >> 32)) << size << " bytes, long " << i;
        }
    }
}

TEST_F(Edges, WritesBehindTheEndAreDropped) {
    const VnProgram writes = compute(R"(
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) buffer A { uint8_t bytes[]; };
layout(set = 0, binding = 0, std430) buffer B { uint16_t halves[]; };
layout(set = 0, binding = 0, std430) buffer C { uvec4 vectors[]; };
layout(set = 0, binding = 0, std430) buffer D { uint words[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    bytes[i + 13] = uint8_t(1);
    halves[i + 7] = uint16_t(2);
    vectors[i + 1] = uvec4(3);
    atomicAdd(words[i + 4], 5u);
    words[i * 0x1000001u | 0x20000000u] = 6u;
})");
    // A range inside a larger buffer: what lies around it is not touched.
    std::vector<uint32_t> filled(32, 0xABABABAB);
    const VnBuffer around = buffer(filled.data(), 128);
    ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, around, 48, 13), VN_SUCCESS) << lastError();
    run(writes);
    EXPECT_THAT(words(around, 32), ElementsAreArray(filled));
}

TEST_F(Edges, UniformBuffersBoundAtTheirEnd) {
    const VnProgram reads = compute(R"(
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform Block { vec4 a; mat4 m; uvec4 tail[4]; };
layout(set = 0, binding = 1, std430) buffer R { uint result[]; };
void main() {
    result[0] = floatBitsToUint(a.w);
    result[1] = floatBitsToUint(m[3].w);
    result[2] = tail[3].w;
    result[3] = tail[gl_LocalInvocationIndex + 3].z;
})");
    std::vector<uint32_t> data(64, 0x3F800000);
    const VnBuffer source = buffer(data.data(), 256), result = buffer(nullptr, 16);
    ASSERT_EQ(vnBindBuffer(context_, 0, 1, 0, result, 0, 0), VN_SUCCESS);
    for (const uint64_t offset : {0, 4, 112, 116, 240, 252, 256}) {
        ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, source, offset, 0), VN_SUCCESS) << lastError();
        run(reads);
        const std::vector<uint32_t> seen = words(result, 4);
        const auto one = [&](uint64_t at) { return offset + at + 4 <= 256 ? 0x3F800000u : 0u; };
        EXPECT_EQ(seen[0], one(12)) << offset;
        EXPECT_EQ(seen[1], one(16 + 60)) << offset;
        EXPECT_EQ(seen[2], one(80 + 60)) << offset;
        EXPECT_EQ(seen[3], one(80 + 56)) << offset;
    }
}

class VertexEdges : public Edges {
  protected:
    /// One point per vertex, at the pixel of its number in the draw, coloured by its attribute.
    void SetUp() override {
        Edges::SetUp();
        program_ = program(R"(#version 450
layout(location = 0) in uint value;
layout(location = 0) flat out uint seen;
layout(push_constant) uniform Push { int base; };
void main() {
    seen = value;
    gl_PointSize = 1.0;
    gl_Position = vec4((float(gl_VertexIndex - base) + 0.5) / 8.0 - 1.0, 0.0, 0.0, 1.0);
})",
                           R"(#version 450
layout(location = 0) flat in uint seen;
layout(location = 0) out uint color;
void main() { color = seen; })");
        target_ = image(VK_FORMAT_R32_UINT, 16, 1);
    }
    VnVertexLayout layout(VkFormat format, uint32_t stride, uint32_t offset) {
        const VnVertexAttribute attribute{0, 0, format, offset};
        const VnVertexBinding binding{stride, 0};
        VnVertexLayoutDesc desc{};
        desc.attributes = &attribute;
        desc.attributeCount = 1;
        desc.bindings = &binding;
        desc.bindingCount = 1;
        VnVertexLayout made{};
        EXPECT_EQ(vnCreateVertexLayout(device_, &desc, &made), VN_SUCCESS) << lastError();
        return made;
    }
    void begin(int32_t base) {
        const VnPassDesc pass = passOn(target_);
        ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnBindProgram(context_, program_), VN_SUCCESS);
        ASSERT_EQ(vnSetTopology(context_, VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 0), VN_SUCCESS);
        ASSERT_EQ(vnPushConstants(context_, 0, &base, 4), VN_SUCCESS);
    }
    std::vector<uint32_t> end() {
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
        return read(target_, 16, 1);
    }
    VnProgram program_{};
    VnImage target_{};
};

TEST_F(VertexEdges, FetchesOfEveryWidthAtTheBuffersEnd) {
    std::array<uint8_t, 64> data{};
    for (size_t i = 0; i < data.size(); ++i) data[i] = static_cast<uint8_t>(i + 1);
    const struct {
        VkFormat format;
        uint32_t bytes;
    } formats[] = {{VK_FORMAT_R8_UINT, 1}, {VK_FORMAT_R16_UINT, 2}, {VK_FORMAT_R32_UINT, 4}};
    for (const auto& [format, bytes] : formats) {
        for (const uint64_t size : {1, 3, 4, 5, 7, 13, 16}) {
            for (const uint32_t stride : {0u, 1u, 3u, 4u}) {
                for (const uint64_t offset : {uint64_t{0}, uint64_t{1}, size - 1, size}) {
                    ASSERT_EQ(vnBindVertexBuffer(context_, 0, buffer(data.data(), size), offset), VN_SUCCESS);
                    ASSERT_EQ(vnBindVertexLayout(context_, layout(format, stride, 1)), VN_SUCCESS);
                    begin(0);
                    ASSERT_EQ(vnDraw(context_, 16, 1, 0, 0), VN_SUCCESS) << lastError();
                    const std::vector<uint32_t> pixels = end();
                    for (uint32_t i = 0; i < 16; ++i) {
                        uint32_t expected = 0;
                        const uint64_t at = offset + i * stride + 1;
                        if (at + bytes <= size) std::memcpy(&expected, data.data() + at, bytes);
                        ASSERT_EQ(pixels[i], expected) << bytes << " bytes at " << offset << " of " << size
                                                       << ", stride " << stride << ", vertex " << i;
                    }
                }
            }
        }
    }
}

TEST_F(VertexEdges, HugeStridesAndOffsetsReadZeros) {
    const uint32_t data[4] = {1, 2, 3, 4};
    for (const uint32_t stride : {0u, 0x7FFFFFFFu, 0xFFFFFFFCu, 0xFFFFFFFFu}) {
        for (const uint32_t offset : {0u, 13u, 16u, 0x80000000u, 0xFFFFFFFFu}) {
            ASSERT_EQ(vnBindVertexBuffer(context_, 0, buffer(data, 16), 0), VN_SUCCESS);
            ASSERT_EQ(vnBindVertexLayout(context_, layout(VK_FORMAT_R32_UINT, stride, offset)), VN_SUCCESS);
            for (const uint32_t first : {0u, 0x80000000u, 0xFFFFFFFFu}) {
                begin(static_cast<int32_t>(first));
                ASSERT_EQ(vnDraw(context_, 16, 1, first, 0xFFFFFFFF), VN_SUCCESS) << lastError();
                const std::vector<uint32_t> pixels = end();
                for (uint32_t i = 0; i < 16; ++i) {
                    const bool inside = offset == 0 && (stride == 0 || first + i == 0);  // modulo 2^32
                    EXPECT_EQ(pixels[i], inside ? data[offset / 4] : 0) << stride << " " << offset << " " << i;
                }
            }
        }
    }
}

TEST_F(VertexEdges, BaseVerticesMayBeNegativeAndIndicesEndExactly) {
    const uint32_t data[16] = {10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25};
    const uint16_t indices[5] = {100, 101, 102, 103, 104};
    ASSERT_EQ(vnBindVertexBuffer(context_, 0, buffer(data, sizeof data), 0), VN_SUCCESS);
    ASSERT_EQ(vnBindVertexLayout(context_, layout(VK_FORMAT_R32_UINT, 4, 0)), VN_SUCCESS);
    ASSERT_EQ(vnBindIndexBuffer(context_, buffer(indices, 10), 2, VK_INDEX_TYPE_UINT16), VN_SUCCESS);
    begin(0);
    ASSERT_EQ(vnDrawIndexed(context_, 4, 1, 0, -100, 0), VN_SUCCESS);
    const std::vector<uint32_t> pixels = end();
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(pixels[i], i >= 1 && i <= 4 ? 10 + i : 0) << i;
    // Behind the end an index is 0; the largest first index and count overflow nothing.
    begin(0);
    ASSERT_EQ(vnDrawIndexed(context_, 9, 1, 3, 5, 0), VN_SUCCESS);           // 104 + 5, then 0 + 5
    ASSERT_EQ(vnDrawIndexed(context_, 9, 1, 0xFFFFFFFF, 7, 0), VN_SUCCESS);  // 0 + 7
    ASSERT_EQ(vnDrawIndexed(context_, 3, 1, 0, std::numeric_limits<int32_t>::min(), 0), VN_SUCCESS);
    const std::vector<uint32_t> beyond = end();
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(beyond[i], i == 5 || i == 7 ? 10 + i : 0) << i;
}

TEST_F(VertexEdges, IndirectArgumentsEndExactly) {
    const uint32_t data[16] = {10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25};
    ASSERT_EQ(vnBindVertexBuffer(context_, 0, buffer(data, sizeof data), 0), VN_SUCCESS);
    ASSERT_EQ(vnBindVertexLayout(context_, layout(VK_FORMAT_R32_UINT, 4, 0)), VN_SUCCESS);
    const uint32_t arguments[9] = {0, 0, 0, 0, 0, 2, 1, 3, 0};
    const VnBuffer indirect = buffer(arguments, sizeof arguments);
    begin(0);
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 20, 1, 0), VN_SUCCESS) << lastError();
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 4, 2, 16), VN_SUCCESS) << lastError();
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 36, 0, 0), VN_SUCCESS) << lastError();
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 24, 1, 0), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 0, 0xFFFFFFFF, 0), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 0, 2, 0xFFFFFFFC), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 0xFFFFFFFFFFFFFFFC, 1, 0), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnDrawIndirect(context_, indirect, 0, 1, 12), VN_ERROR_INVALID_ARGUMENT);
    const std::vector<uint32_t> pixels = end();
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(pixels[i], i == 3 || i == 4 ? 10 + i : 0) << i;
}

TEST_F(Edges, ImagesOfOneTexelAndOddMips) {
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {13u, 1u}, {5u, 3u}, {65u, 63u}}) {
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, width, height, VN_ALL_MIPS);
        uint32_t w = width, h = height, mip = 0;
        for (;; ++mip) {
            VnViewDesc desc{};
            desc.image = target;
            desc.baseMip = mip;
            desc.mipCount = 1;
            VnPassDesc pass{};
            ASSERT_EQ(vnCreateView(device_, &desc, &pass.colors[0].view), VN_SUCCESS) << lastError();
            ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
            ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
            ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
            ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
            VnRegion region{};
            region.mip = mip;
            std::vector<uint32_t> pixels(size_t{w} * h);
            ASSERT_EQ(vnReadImage(context_, target, &region, pixels.data(), pixels.size() * 4), VN_SUCCESS)
                << lastError();
            EXPECT_THAT(pixels, Each(0xFFFFFFFFu)) << width << " x " << height << ", level " << mip;
            if (w == 1 && h == 1) break;
            w = std::max(1u, w / 2), h = std::max(1u, h / 2);
        }
        ASSERT_EQ(vnGenerateMips(context_, target), VN_SUCCESS);
        VnRegion last{};
        last.mip = mip;
        uint32_t texel = 0;
        ASSERT_EQ(vnReadImage(context_, target, &last, &texel, 4), VN_SUCCESS);
        EXPECT_EQ(texel, 0xFFFFFFFFu);
    }
}

TEST_F(Edges, AttachmentsOfDifferentSizesAndWithGaps) {
    const VnProgram both = program(kFullScreenVertex, R"(#version 450
layout(location = 1) out vec4 first;
layout(location = 6) out vec4 second;
void main() { first = vec4(1.0, 0.0, 0.0, 1.0); second = vec4(0.0, 1.0, 0.0, 1.0); })");
    const VnImage small = image(VK_FORMAT_R8G8B8A8_UNORM, 5, 9), large = image(VK_FORMAT_R8G8B8A8_UNORM, 70, 3);
    VnPassDesc pass{};
    pass.colors[1].view = view(small);
    pass.colors[6].view = view(large);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, both), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    const std::vector<uint32_t> a = read(small, 5, 9), b = read(large, 70, 3);
    for (uint32_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i], i / 5 < 3 ? 0xFF0000FFu : 0u) << i;
    for (uint32_t i = 0; i < b.size(); ++i) EXPECT_EQ(b[i], i % 70 < 5 ? 0xFF00FF00u : 0u) << i;
}

TEST_F(Edges, ThreadsRecordWhileOthersCreateAndDestroy) {
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    std::vector<std::thread> threads;
    std::array<bool, 4> good{};
    for (size_t n = 0; n < good.size(); ++n) {
        threads.emplace_back([&, n] {
            VnContext own = nullptr;
            bool fine = vnCreateContext(device_, nullptr, &own) == VN_SUCCESS;
            for (int frame = 0; frame < 20; ++frame) {
                VnImageDesc desc{};
                desc.width = desc.height = 9;
                VnImage target{};
                VnPassDesc pass{};
                fine &= vnCreateImage(device_, &desc, &target) == VN_SUCCESS;
                fine &= vnGetImageView(device_, target, &pass.colors[0].view) == VN_SUCCESS;
                VnBlendStateDesc blendDesc{};
                blendDesc.attachments[0].writeMaskOff = static_cast<VkColorComponentFlags>(n);
                VnBlendState blend{};
                fine &= vnCreateBlendState(device_, &blendDesc, &blend) == VN_SUCCESS;
                fine &= vnBeginPass(own, &pass) == VN_SUCCESS;
                fine &= vnBindProgram(own, white) == VN_SUCCESS;
                fine &= vnBindBlendState(own, blend) == VN_SUCCESS;
                fine &= vnDraw(own, 3, 1, 0, 0) == VN_SUCCESS;
                fine &= vnEndPass(own) == VN_SUCCESS;
                fine &= vnDestroyBlendState(device_, blend) == VN_SUCCESS;
                fine &= vnDestroyView(device_, pass.colors[0].view) == VN_SUCCESS;
                uint32_t pixels[81] = {};
                fine &= vnReadImage(own, target, nullptr, pixels, sizeof pixels) == VN_SUCCESS;
                const uint32_t expected = ~((n & 1 ? 0xFFu : 0) | (n & 2 ? 0xFF00u : 0));
                for (const uint32_t pixel : pixels) fine &= pixel == expected;
                fine &= vnDestroyImage(device_, target) == VN_SUCCESS;
            }
            vnDestroyContext(own);
            good[n] = fine;
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(good, Each(true));
}

}  // namespace
}  // namespace vernier::test
