// Atomics of 64 bits and on floats, on buffers; and switches over 64-bit selectors.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/compute_harness.h"
#include "tests/spirv_interp/shader_run.h"

namespace vernier::test {
namespace {

constexpr const char* kExtensions =
    "#extension GL_EXT_shader_explicit_arithmetic_types : require\n#extension GL_EXT_shader_atomic_int64 : require\n"
    "#extension GL_EXT_shader_atomic_float : require\n#extension GL_EXT_shader_atomic_float2 : require\n";

// Lanes work in their order: what each gets back is what the ones before it have left.
TEST(WideAtomics, Integers) {
    ShaderRun shader;
    shader.words =
        laneShader(kExtensions,
                   "layout(binding=0) buffer A { uint64_t u[8]; int64_t s[4]; };"
                   "layout(binding=1) buffer V { uint64_t v[]; }; layout(binding=2) buffer R { uint64_t r[]; };",
                   R"(
uint64_t x = v[lane];
int n = lane * 12;
r[n] = atomicAdd(u[0], x);
r[n + 1] = atomicMin(u[1], x);
r[n + 2] = atomicMax(u[2], x);
r[n + 3] = atomicAnd(u[3], x | 0xF0F0F0F0F0F0F0F0ul);
r[n + 4] = atomicOr(u[4], x & 0x1000000010000000ul);
r[n + 5] = atomicXor(u[5], x);
r[n + 6] = atomicExchange(u[6], x);
r[n + 7] = atomicCompSwap(u[7], uint64_t(lane) << 33, uint64_t(lane + 1) << 33);
r[n + 8] = uint64_t(atomicMin(s[0], int64_t(x)));
r[n + 9] = uint64_t(atomicMax(s[1], int64_t(x)));
if (lane % 3 == 0) r[n + 10] = uint64_t(atomicAdd(s[2], -int64_t(lane)));
r[n + 11] = atomicAdd(u[lane == 7 ? 100 : 0], 0ul);
)");
    std::mt19937_64 random(4);
    std::vector<uint64_t> v(64), start(12);
    for (uint64_t& x : v) x = random() >> random() % 40;
    for (uint64_t& x : start) x = random();
    start[7] = 0;
    for (const Isa isa : isas()) {
        shader.buffers[0] = bytesOf(start);
        shader.buffers[1] = bytesOf(v);
        shader.buffers[2] = Bytes(64 * 12 * 8);
        ASSERT_TRUE(shader.run(isa));
        const auto r = valuesOf<uint64_t>(shader.buffers[2]), end = valuesOf<uint64_t>(shader.buffers[0]);
        std::vector<uint64_t> u = start;
        for (uint64_t lane = 0; lane < 64; ++lane) {
            const uint64_t x = v[lane];
            const auto step = [&](size_t k, size_t word, uint64_t next) {
                EXPECT_EQ(r[lane * 12 + k], u[word]) << "lane " << lane << " operation " << k;
                u[word] = next;
            };
            const auto s = [](uint64_t bits) { return static_cast<int64_t>(bits); };
            step(0, 0, u[0] + x);
            step(1, 1, std::min(u[1], x));
            step(2, 2, std::max(u[2], x));
            step(3, 3, u[3] & (x | 0xF0F0F0F0F0F0F0F0u));
            step(4, 4, u[4] | (x & 0x1000000010000000u));
            step(5, 5, u[5] ^ x);
            step(6, 6, x);
            step(7, 7, u[7] == lane << 33 ? (lane + 1) << 33 : u[7]);
            step(8, 8, s(u[8]) < s(x) ? u[8] : x);
            step(9, 9, s(u[9]) > s(x) ? u[9] : x);
            if (lane % 3 == 0) step(10, 10, u[10] - lane);
        }
        EXPECT_EQ(r[7 * 12 + 11], 0u);
        EXPECT_EQ(end, u);
    }
}

TEST(WideAtomics, Floats) {
    ShaderRun shader;
    shader.words = laneShader(kExtensions,
                              "layout(binding=0) buffer A { float f[4]; double d[4]; };"
                              "layout(binding=1) buffer V { float v[]; }; layout(binding=2) buffer R { double r[]; };",
                              "float x = v[lane]; int n = lane * 8;"
                              "r[n] = atomicAdd(f[0], x); r[n + 1] = atomicMin(f[1], x); r[n + 2] = atomicMax(f[2], x);"
                              "r[n + 3] = atomicExchange(f[3], x); r[n + 4] = atomicAdd(d[0], double(x));"
                              "r[n + 5] = atomicMin(d[1], double(x)); r[n + 6] = atomicMax(d[2], double(x));"
                              "r[n + 7] = atomicExchange(d[3], double(x));");
    std::mt19937 random(8);
    std::vector<float> v(64);
    for (float& x : v) x = static_cast<float>(static_cast<int>(random() % 2000) - 1000) / 7.0f;
    for (const Isa isa : isas()) {
        shader.buffers[0] = Bytes(16 + 32);
        shader.buffers[1] = bytesOf(v);
        shader.buffers[2] = Bytes(64 * 8 * 8);
        ASSERT_TRUE(shader.run(isa));
        const auto r = valuesOf<double>(shader.buffers[2]);
        float f[4] = {};
        double d[4] = {};
        for (size_t lane = 0; lane < 64; ++lane) {
            for (size_t k = 0; k < 4; ++k) {
                EXPECT_EQ(r[lane * 8 + k], f[k]);
                EXPECT_EQ(r[lane * 8 + 4 + k], d[k]);
            }
            f[0] += v[lane], f[1] = std::min(f[1], v[lane]), f[2] = std::max(f[2], v[lane]), f[3] = v[lane];
            d[0] += v[lane], d[1] = std::min<double>(d[1], v[lane]), d[2] = std::max<double>(d[2], v[lane]),
                             d[3] = v[lane];
        }
        const auto words = valuesOf<float>(shader.buffers[0]);
        for (size_t k = 0; k < 4; ++k) EXPECT_EQ(words[k], f[k]);
    }
}

// In work-group memory 64-bit values may stand at any word, and narrow ones next to each other.
TEST(WideAtomics, WorkgroupMemory) {
    const ir::Program program = loadCompute(R"(#version 450
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_atomic_int64 : require
layout(local_size_x = 40) in;
layout(set = 0, binding = 0) buffer B { uint o[]; };
shared struct { uint first; uint64_t sum; int64_t least; uint8_t bytes[40]; float16_t half1; } s;
shared uint16_t shorts[40];
void main() {
    uint i = gl_LocalInvocationIndex;
    if (i == 0) { s.sum = 5ul; s.least = 0l; s.half1 = 0.25hf; }
    barrier();
    atomicAdd(s.sum, (uint64_t(i) << 32) + 3ul);
    atomicMin(s.least, -int64_t(i) * 10000000000l);
    s.bytes[i] = uint8_t(i * 7u);
    shorts[39 - i] = uint16_t(i * 3000u);
    if (i == 9) s.half1 += 1.5hf;
    barrier();
    o[i * 6] = uint(s.sum); o[i * 6 + 1] = uint(s.sum >> 32);
    o[i * 6 + 2] = uint(s.least / -10000000000l);
    o[i * 6 + 3] = uint(s.bytes[(i + 1u) % 40u]);
    o[i * 6 + 4] = uint(shorts[i]);
    o[i * 6 + 5] = uint(s.half1 * 100.0hf);
}
)");
    const auto o = dispatchEverywhere(program, {}, {{0, std::vector<uint32_t>(240)}})[0];
    for (uint32_t i = 0; i < 40; ++i) {
        EXPECT_EQ(o[i * 6], 5 + 40 * 3u);
        EXPECT_EQ(o[i * 6 + 1], 39 * 20u);
        EXPECT_EQ(o[i * 6 + 2], 39u);
        EXPECT_EQ(o[i * 6 + 3], (i + 1) % 40 * 7 % 256);
        EXPECT_EQ(o[i * 6 + 4], (39 - i) * 3000 % 65536);
        EXPECT_EQ(o[i * 6 + 5], 175u);
    }
}

// Literals of 64 and of 16 bits; a case that falls into the next, which others reach directly.
TEST(Switch, WideAndNarrowSelectors) {
    ShaderRun shader;
    shader.words = assemble(R"(
OpCapability Shader
OpCapability Int64
OpCapability Int16
OpExtension "SPV_KHR_storage_buffer_storage_class"
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %lane %o
OpExecutionMode %main OriginUpperLeft
OpDecorate %lane Location 0
OpDecorate %lane Flat
OpDecorate %o Location 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%int = OpTypeInt 32 1
%long = OpTypeInt 64 1
%short = OpTypeInt 16 1
%pin = OpTypePointer Input %int
%pout = OpTypePointer Output %int
%lane = OpVariable %pin Input
%o = OpVariable %pout Output
%c0 = OpConstant %int 0
%c1 = OpConstant %int 1
%c2 = OpConstant %int 2
%c3 = OpConstant %int 3
%c9 = OpConstant %int 9
%c10 = OpConstant %int 10
%c100 = OpConstant %int 100
%c1000 = OpConstant %int 1000
%big = OpConstant %long 4294967296
%neg = OpConstant %long -1
%k3 = OpConstant %short 3
%main = OpFunction %void None %fn
%entry = OpLabel
%n = OpLoad %int %lane
%wide = OpSConvert %long %n
%low = OpIMul %long %wide %big
%selector = OpIAdd %long %low %neg
OpSelectionMerge %merge None
OpSwitch %selector %other -1 %a 8589934591 %c 4294967295 %b 21474836479 %b
%a = OpLabel
OpBranch %c
%b = OpLabel
OpBranch %merge
%c = OpLabel
%pc = OpPhi %int %c10 %a %c100 %entry
OpBranch %merge
%other = OpLabel
OpBranch %merge
%merge = OpLabel
%first = OpPhi %int %c1 %b %pc %c %c1000 %other
%shorter = OpSConvert %short %n
%narrow = OpISub %short %shorter %k3
OpSelectionMerge %end None
OpSwitch %narrow %other2 -3 %d 0 %e -32768 %d
%d = OpLabel
OpBranch %end
%e = OpLabel
OpBranch %end
%other2 = OpLabel
OpBranch %end
%end = OpLabel
%second = OpPhi %int %c2 %d %c3 %e %c0 %other2
%times = OpIMul %int %first %c10
%sum = OpIAdd %int %times %second
OpStore %o %sum
OpReturn
OpFunctionEnd
)");
    for (const Isa isa : isas()) {
        ASSERT_TRUE(shader.run(isa));
        for (int lane = 0; lane < 64; ++lane) {
            const int first = lane == 0 ? 10 : lane == 1 || lane == 5 ? 1 : lane == 2 ? 100 : 1000;
            const int second = lane == 0 ? 2 : lane == 3 ? 3 : 0;
            EXPECT_EQ(static_cast<int>(shader.output(0, static_cast<uint32_t>(lane))), first * 10 + second) << lane;
        }
    }
}

}  // namespace
}  // namespace vernier::test
