// Compute programs and dispatches through vernier.h: what they compute, and what is refused.
#include <array>
#include <cstring>
#include <numeric>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::Each;
using testing::HasSubstr;

constexpr const char* kScale = R"(#version 450
layout(local_size_x = 64) in;
layout(constant_id = 3) const uint kFactor = 2;
layout(push_constant) uniform Push { uint offset; };
layout(set = 0, binding = 0) readonly buffer In { uint numbers[]; };
layout(set = 1, binding = 2) buffer Out { uint results[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < results.length()) results[i] = numbers[i] * kFactor + offset;
})";

class Compute : public ApiTest {
  protected:
    VnProgram computeProgram(const std::string& source, const std::vector<VnSpecialization>& specializations = {}) {
        VnProgramDesc desc{};
        desc.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, source, specializations);
        VnProgram result{};
        EXPECT_EQ(vnCreateProgram(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
    std::vector<uint32_t> readWords(VnBuffer from, size_t count) {
        std::vector<uint32_t> words(count);
        EXPECT_EQ(vnReadBuffer(context_, from, 0, words.data(), count * 4), VN_SUCCESS) << lastError();
        return words;
    }
    void bindAndPush(VnProgram program, VnBuffer in, VnBuffer out, uint32_t offset) {
        EXPECT_EQ(vnBindProgram(context_, program), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindBuffer(context_, 0, 0, 0, in, 0, 0), VN_SUCCESS);
        EXPECT_EQ(vnBindBuffer(context_, 1, 2, 0, out, 0, 0), VN_SUCCESS);
        EXPECT_EQ(vnPushConstants(context_, 0, &offset, 4), VN_SUCCESS);
    }
    void expect(VnResult actual, VnResult expected, const std::string& text) {
        EXPECT_EQ(actual, expected);
        EXPECT_THAT(lastError(), HasSubstr(text));
    }
};

TEST_F(Compute, TexelBuffersPassFromDispatchToDispatch) {
    constexpr uint32_t kTexels = 4096, kRounds = 200;
    const VnProgram step = computeProgram(R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform usamplerBuffer from;
layout(set = 0, binding = 1, r32ui) writeonly uniform uimageBuffer to;
void main() {
    int i = int(gl_GlobalInvocationID.x);
    imageStore(to, i, texelFetch(from, (i + 1000) % 4096) + 1u);
})");
    std::vector<uint32_t> texels(kTexels);
    const VnBuffer buffers[] = {buffer(texels.data(), kTexels * 4), buffer(nullptr, kTexels * 4)};
    ASSERT_EQ(vnBindProgram(context_, step), VN_SUCCESS) << lastError();
    for (uint32_t round = 0; round < kRounds; ++round) {
        for (const uint32_t side : {0u, 1u})
            ASSERT_EQ(vnBindTexelBuffer(context_, 0, side, 0, buffers[(round + side) % 2], VK_FORMAT_R32_UINT, 0, 0),
                      VN_SUCCESS)
                << lastError();
        ASSERT_EQ(vnDispatch(context_, kTexels / 64, 1, 1), VN_SUCCESS) << lastError();
    }
    EXPECT_THAT(readWords(buffers[kRounds % 2], kTexels), Each(kRounds));
}

TEST_F(Compute, DispatchesRunInOrderAndSeeEachOther) {
    std::vector<uint32_t> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 0u);
    const VnBuffer in = buffer(numbers.data(), 4000), middle = buffer(nullptr, 4000), out = buffer(nullptr, 4000);
    const VnProgram twice = computeProgram(kScale), thrice = computeProgram(kScale, {{3, 3}});
    bindAndPush(twice, in, middle, 1);
    ASSERT_EQ(vnDispatch(context_, 16, 1, 1), VN_SUCCESS) << lastError();
    bindAndPush(thrice, middle, out, 5);
    ASSERT_EQ(vnDispatch(context_, 16, 1, 1), VN_SUCCESS) << lastError();
    const std::vector<uint32_t> results = readWords(out, 1000);
    for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(results[i], (i * 2 + 1) * 3 + 5) << i;
    VnStatistics statistics{};
    ASSERT_EQ(vnGetStatistics(context_, &statistics), VN_SUCCESS);
    EXPECT_EQ(statistics.dispatches, 2u);
    EXPECT_EQ(statistics.computeInvocations, 2048u);
    EXPECT_EQ(statistics.draws, 0u);
}

TEST_F(Compute, CountsComeFromABuffer) {
    const std::array<uint32_t, 5> arguments{9, 9, 2, 1, 1};
    std::vector<uint32_t> numbers(256, 7);
    const VnBuffer in = buffer(numbers.data(), 1024), out = buffer(nullptr, 1024);
    bindAndPush(computeProgram(kScale), in, out, 0);
    ASSERT_EQ(vnDispatchIndirect(context_, buffer(arguments.data(), sizeof arguments), 8), VN_SUCCESS) << lastError();
    const std::vector<uint32_t> results = readWords(out, 256);
    for (uint32_t i = 0; i < 256; ++i) ASSERT_EQ(results[i], i < 128 ? 14u : 0u) << i;
}

TEST_F(Compute, ImagesAreWrittenAndThenDrawnWith) {
    const VnImage picture = image(VK_FORMAT_R8G8B8A8_UNORM, 32, 16), target = image(VK_FORMAT_R8G8B8A8_UNORM, 32, 16);
    const VnProgram paint = computeProgram(R"(#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D picture;
void main() {
    imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(vec2(gl_GlobalInvocationID.xy) / 255.0, 0.0, 1.0));
})");
    const VnProgram show = program(kFullScreenVertex, R"(#version 450
layout(set = 0, binding = 1) uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).yxzw; })");
    VnSamplerDesc samplerDesc{};
    VnSampler sampler{};
    ASSERT_EQ(vnCreateSampler(device_, &samplerDesc, &sampler), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, paint), VN_SUCCESS);
    ASSERT_EQ(vnBindTexture(context_, 0, 1, 0, view(picture), sampler), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnDispatch(context_, 4, 2, 1), VN_SUCCESS) << lastError();
    const std::vector<uint32_t> pixels = drawFullScreen(target, 32, 16, show);
    for (uint32_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i], 0xFF000000u | i % 32 << 8 | i / 32) << i;
}

// Faces and layers of storage images, one texel behind the other, each with the number of its own.
TEST_F(Compute, StorageImagesOfAllKindsFindTheirSlices) {
    struct Kind {
        const char *type, *place;
        uint32_t dimensions, layers, depth;
        int cube, array;
    };
    constexpr Kind kKinds[] = {
        {"imageCubeArray", "ivec3(at.xy, at.z)", 2, 12, 0, 1, 0}, {"imageCube", "ivec3(at.xy, at.z)", 2, 6, 0, 1, 0},
        {"image2DArray", "ivec3(at.xy, at.z)", 2, 12, 0, 0, 1},   {"image3D", "ivec3(at.xy, at.z)", 3, 0, 12, 0, 0},
        {"image1DArray", "ivec2(at.x, at.z)", 1, 12, 0, 0, 1},
    };
    for (const Kind& kind : kKinds) {
        const uint32_t slices = std::max(kind.layers, kind.depth), rows = kind.dimensions == 1 ? 1 : 4;
        VnImageDesc desc{};
        desc.format = VK_FORMAT_R32_UINT;
        desc.dimensions = kind.dimensions;
        desc.width = 4;
        desc.height = rows;
        desc.layers = kind.layers;
        desc.depth = kind.depth;
        desc.cube = kind.cube;
        VnImage picture{};
        ASSERT_EQ(vnCreateImage(device_, &desc, &picture), VN_SUCCESS) << lastError();
        const std::string head = "#version 450\nlayout(local_size_x = 4, local_size_y = " + std::to_string(rows) +
                                 ") in;\nlayout(set = 0, binding = 1, r32ui) uniform u" + kind.type +
                                 " picture;\nlayout(set = 0, binding = 0) buffer R { uint seen[]; };\n"
                                 "void main() { ivec3 at = ivec3(gl_GlobalInvocationID);"
                                 "uint n = uint(at.x + at.y * 4 + at.z * 16);";
        const std::string place = kind.place;
        const std::string write =
            head + "imageStore(picture, " + place + ", uvec4(n)); imageAtomicAdd(picture, " + place + ", 5u); }";
        const std::string look = head + "seen[n] = imageLoad(picture, " + place + ").x; }";
        const std::vector<uint32_t> nothing(16 * slices, 0);
        const VnBuffer seen = buffer(nothing.data(), nothing.size() * 4);
        for (const std::string* source : {&write, &look}) {
            ASSERT_EQ(vnBindProgram(context_, computeProgram(source->c_str())), VN_SUCCESS) << lastError();
            ASSERT_EQ(vnBindTexture(context_, 0, 1, 0, view(picture), VnSampler{}), VN_SUCCESS) << lastError();
            ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, seen, 0, 0), VN_SUCCESS) << lastError();
            ASSERT_EQ(vnDispatch(context_, 1, 1, slices), VN_SUCCESS) << lastError();
        }
        const std::vector<uint32_t> found = readWords(seen, 16 * slices);
        for (uint32_t n = 0; n < found.size(); ++n)
            ASSERT_EQ(found[n], n % 16 / 4 < rows ? n + 5 : 0) << kind.type << " " << n;
    }
}

TEST_F(Compute, BoundBesideTheProgramForDraws) {
    std::vector<uint32_t> numbers(64, 1);
    const VnBuffer in = buffer(numbers.data(), 256), out = buffer(nullptr, 256);
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    ASSERT_EQ(vnBindProgram(context_, program(kFullScreenVertex, kWhiteFragment)), VN_SUCCESS);
    bindAndPush(computeProgram(kScale), in, out, 0);
    const VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    ASSERT_EQ(vnDispatch(context_, 1, 1, 1), VN_SUCCESS) << lastError();
    EXPECT_THAT(read(target, 8, 8), Each(0xFFFFFFFFu));
    EXPECT_THAT(readWords(out, 64), Each(2u));
}

TEST_F(Compute, WorksAfterEveryFlushAndWithoutGroups) {
    std::vector<uint32_t> numbers(64, 4);
    const VnBuffer in = buffer(numbers.data(), 256), out = buffer(nullptr, 256);
    bindAndPush(computeProgram(kScale), in, out, 1);
    ASSERT_EQ(vnDispatch(context_, 0, 5, 5), VN_SUCCESS);
    EXPECT_THAT(readWords(out, 64), Each(0u));
    ASSERT_EQ(vnDispatch(context_, 1, 1, 1), VN_SUCCESS);  // a new recording: everything is bound anew
    EXPECT_THAT(readWords(out, 64), Each(9u));
}

TEST_F(Compute, ExplainTellsWhatADispatchRuns) {
    ASSERT_EQ(vnBindProgram(context_, computeProgram(R"(#version 450
layout(local_size_x = 32, local_size_y = 2) in;
layout(set = 0, binding = 0) buffer Out { float results[]; };
shared float memory[64];
void main() {
    memory[gl_LocalInvocationIndex] = results[gl_LocalInvocationIndex];
    barrier();
    results[gl_LocalInvocationIndex] = memory[63 - gl_LocalInvocationIndex];
})")),
              VN_SUCCESS);
    std::string text(4096, '\0');
    size_t length = 0;
    ASSERT_EQ(vnExplain(context_, VN_EXPLAIN_TEXT, text.data(), text.size(), &length), VN_SUCCESS) << lastError();
    text.resize(length);
    EXPECT_THAT(text, HasSubstr("work-groups of 32 x 2 x 1"));
    EXPECT_THAT(text, HasSubstr("256 bytes"));
}

TEST_F(Compute, WrongUseIsRefusedByName) {
    const VnBuffer small = buffer(nullptr, 16);
    expect(vnDispatch(context_, 1, 1, 1), VN_ERROR_INVALID_STATE, "no compute program is bound");
    ASSERT_EQ(vnBindProgram(context_, computeProgram(kScale)), VN_SUCCESS);
    expect(vnDispatch(context_, 1, 1, 1), VN_ERROR_INVALID_STATE, "nothing of its type is bound there");
    ASSERT_EQ(vnBindBuffer(context_, 1, 2, 0, small, 0, 0), VN_SUCCESS);
    expect(vnDispatch(context_, 1, 1, 1), VN_ERROR_INVALID_STATE, "set 0, binding 0");
    ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, small, 0, 0), VN_SUCCESS);
    expect(vnDispatch(context_, 1, 1, 65536), VN_ERROR_INVALID_ARGUMENT, "work-groups in z is 65536");
    expect(vnDispatchIndirect(context_, small, 8), VN_ERROR_INVALID_ARGUMENT, "offset 8 are not inside");
    expect(vnDispatchIndirect(context_, small, 2), VN_ERROR_INVALID_ARGUMENT, "no multiple of 4");
    expect(vnDispatchIndirect(context_, {}, 0), VN_ERROR_INVALID_HANDLE, "buffer");
    const VnPassDesc pass = passOn(image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8));
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    expect(vnDispatch(context_, 1, 1, 1), VN_ERROR_INVALID_STATE, "a pass is open");
    expect(vnDraw(context_, 3, 1, 0, 0), VN_ERROR_INVALID_STATE, "no program is bound");
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, {}), VN_SUCCESS);
    expect(vnDispatch(context_, 1, 1, 1), VN_ERROR_INVALID_STATE, "no compute program is bound");
    EXPECT_EQ(vnDispatch(nullptr, 1, 1, 1), VN_ERROR_INVALID_HANDLE);
}

TEST_F(Compute, WrongProgramsAreRefusedByName) {
    const VnShader compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, kScale);
    const VnShader vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, kFullScreenVertex);
    VnProgram program{};
    VnProgramDesc desc{};
    desc.compute = compute;
    desc.vertex = vertex;
    expect(vnCreateProgram(device_, &desc, &program), VN_ERROR_INVALID_ARGUMENT, "must stand alone");
    desc = {};
    desc.compute = vertex;
    expect(vnCreateProgram(device_, &desc, &program), VN_ERROR_INVALID_HANDLE, "compute shader");
    desc = {};
    desc.vertex = compute;
    expect(vnCreateProgram(device_, &desc, &program), VN_ERROR_INVALID_HANDLE, "vertex shader");
    desc = {};
    desc.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(#version 450
layout(local_size_z_id = 0) in;
void main() {})",
                          {{0, 128}});
    expect(vnCreateProgram(device_, &desc, &program), VN_ERROR_SHADER, "size in z is 128");
    EXPECT_EQ(program.id, 0u);
}

TEST_F(Compute, EndlessLoopLosesTheDevice) {
    const VnBuffer out = buffer(nullptr, 16);
    ASSERT_EQ(vnBindProgram(context_, computeProgram(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint value; };
void main() {
    uint i = value | 1;
    while (i != 0) i += 2;
    value = i;
})")),
              VN_SUCCESS);
    ASSERT_EQ(vnBindBuffer(context_, 0, 0, 0, out, 0, 0), VN_SUCCESS);
    ASSERT_EQ(vnDispatch(context_, 1, 1, 1), VN_SUCCESS) << lastError();
    expect(vnFinish(context_), VN_ERROR_DEVICE_LOST, "looped beyond the budget");
}

}  // namespace
}  // namespace vernier::test
