// One dispatch gives one result: the same words with any number of threads and on every instruction set.
#include "base/simd.h"
#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

/// Loops that end at different times, transcendental functions, work-group memory and barriers.
constexpr const char* kMixture = R"(#version 450
layout(local_size_x = 24, local_size_y = 3) in;
layout(set = 0, binding = 0) buffer Out { vec4 results[]; };
layout(set = 0, binding = 1) buffer Counts { uint counts[64]; };
shared float row[72];
void main() {
    uvec2 size = gl_NumWorkGroups.xy * gl_WorkGroupSize.xy, at = gl_GlobalInvocationID.xy;
    vec2 p = vec2(at) / vec2(size) * 3.0 - 1.5;
    vec2 z = p;
    int steps = 0;
    while (steps < 200 && dot(z, z) < 16.0) {
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + vec2(-0.4, 0.6);
        ++steps;
    }
    row[gl_LocalInvocationIndex] = sin(p.x * 7.0) * exp2(p.y) + pow(abs(p.x) + 0.1, 1.7);
    barrier();
    float sum = 0.0;
    for (uint i = 0; i <= gl_LocalInvocationID.x; ++i) sum += row[gl_LocalInvocationID.y * 24 + i];
    results[at.y * size.x + at.x] = vec4(sum, float(steps), atan(z.y, z.x), inversesqrt(dot(p, p) + 0.01));
    atomicAdd(counts[steps & 63], 1u);
})";

constexpr uint32_t kGroupsX = 13, kGroupsY = 17, kWords = kGroupsX * 24 * kGroupsY * 3 * 4 + 64;

std::vector<uint32_t> compute(uint32_t threads, Isa isa, const std::vector<uint32_t>& spirv) {
    VnDeviceDesc deviceDesc{};
    deviceDesc.threads = threads;
    deviceDesc.maxIsa = isaName(isa).data();
    VnDevice device = nullptr;
    EXPECT_EQ(vnCreateDevice(&deviceDesc, &device), VN_SUCCESS);
    VnContext context = nullptr;
    EXPECT_EQ(vnCreateContext(device, nullptr, &context), VN_SUCCESS);
    VnShaderDesc shaderDesc{};
    shaderDesc.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    shaderDesc.words = spirv.data();
    shaderDesc.wordCount = spirv.size();
    VnProgramDesc programDesc{};
    EXPECT_EQ(vnCreateShader(device, &shaderDesc, &programDesc.compute), VN_SUCCESS);
    VnProgram program{};
    EXPECT_EQ(vnCreateProgram(device, &programDesc, &program), VN_SUCCESS);
    VnBufferDesc bufferDesc{};
    bufferDesc.size = uint64_t{kWords} * 4;
    VnBuffer buffer{};
    EXPECT_EQ(vnCreateBuffer(device, &bufferDesc, &buffer), VN_SUCCESS);
    const uint64_t countsAt = uint64_t{kWords - 64} * 4;
    EXPECT_EQ(vnBindProgram(context, program), VN_SUCCESS);
    EXPECT_EQ(vnBindBuffer(context, 0, 0, 0, buffer, 0, countsAt), VN_SUCCESS);
    EXPECT_EQ(vnBindBuffer(context, 0, 1, 0, buffer, countsAt, 0), VN_SUCCESS);
    EXPECT_EQ(vnDispatch(context, kGroupsX, kGroupsY, 1), VN_SUCCESS);
    std::vector<uint32_t> words(kWords);
    EXPECT_EQ(vnReadBuffer(context, buffer, 0, words.data(), uint64_t{kWords} * 4), VN_SUCCESS);
    vnDestroyDevice(device);
    return words;
}

TEST(ComputeSameBits, WithAnyThreadsAndInstructionSet) {
    const std::vector<uint32_t> spirv = compileGlsl(VK_SHADER_STAGE_COMPUTE_BIT, kMixture);
    const std::vector<uint32_t> expected = compute(1, kLowestIsa, spirv);
    uint32_t counted = 0;
    for (uint32_t i = kWords - 64; i < kWords; ++i) counted += expected[i];
    EXPECT_EQ(counted, (kWords - 64) / 4);
    for (const uint32_t threads : {1u, 2u, 5u})
        for (const Isa isa : availableIsas())
            EXPECT_TRUE(compute(threads, isa, spirv) == expected) << threads << " threads on " << isaName(isa);
}

}  // namespace
}  // namespace vernier::test
