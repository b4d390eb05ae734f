// Every subgroup operation with all lanes, some, and lanes that went different ways, against a plain model.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/compute_harness.h"
#include "tests/spirv_interp/front_support.h"
#include "tests/spirv_interp/subgroup_cases.h"

namespace vernier::test {
namespace {

constexpr const char* kExtensions = R"(#version 450
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_EXT_shader_subgroup_extended_types_int8 : require
#extension GL_EXT_shader_subgroup_extended_types_int16 : require
#extension GL_EXT_shader_subgroup_extended_types_int64 : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_ARB_gpu_shader_int64 : require
)";

constexpr const char* kPrologue = R"(layout(local_size_x = 80) in;
layout(set = 0, binding = 0) readonly buffer A { uint a[]; };
layout(set = 0, binding = 1) readonly buffer F { float b[]; };
layout(set = 0, binding = 2) buffer O { uint o[]; };
uint fold64(uint64_t x) { return uint(x) ^ uint(x >> 32); }
uint fold64(int64_t x) { return fold64(uint64_t(x)); }
uint fold64(double x) { uvec2 w = unpackDouble2x32(x); return w.x ^ w.y; }
uint fold64(double x, const int lane) { return fold64(subgroupBroadcast(x, 6)); }
void main() {
uint i = gl_LocalInvocationIndex, u = a[i], place = u % 32; float f = b[i];
)";

/// Which lanes run the instruction together with lane `lane` of an invocation.
struct Flow {
    std::string head;  // before the statements
    std::function<bool(uint32_t self, uint32_t other, const std::vector<uint32_t>& a)> together;
};

const std::vector<Flow>& flows() {
    using Words = const std::vector<uint32_t>&;
    static const std::vector<Flow> all = {
        {"{", [](uint32_t, uint32_t, Words) { return true; }},
        {"if (i < 50) {", [](uint32_t, uint32_t other, Words) { return other < 50; }},
        {"if (i % 3 == 1) {", [](uint32_t, uint32_t other, Words) { return other % 3 == 1; }},
        {"if ((u & 4) != 0) {", [](uint32_t, uint32_t other, Words a) { return (a[other] & 4) != 0; }},
        {"if (i == 37) {", [](uint32_t, uint32_t other, Words) { return other == 37; }},
        {"if (i % 2 == 0) o[i] = 1; if (i % 5 == 0) return; {",
         [](uint32_t, uint32_t other, Words) { return other % 5 != 0; }},
        // The last round of an invocation is run together with those that are not done yet.
        {"for (uint k = 0; k <= i % 4; ++k) {",
         [](uint32_t self, uint32_t other, Words) { return other % 4 >= self % 4; }},
    };
    return all;
}

void check(const std::vector<Case>& cases) {
    std::mt19937 random(7);
    std::vector<uint32_t> a(kInvocations);
    for (uint32_t& word : a) word = random();
    std::vector<float> b(kInvocations);
    for (float& value : b) value = static_cast<float>(random() % 2000) / 64.0f - 3.0f;
    for (const Flow& flow : flows()) {
        std::string text = std::string(kExtensions) + kPrologue + flow.head + "\n";
        for (size_t n = 0; n < cases.size(); ++n) {
            text += "o[i + " + std::to_string(n * kInvocations) + "] = " + cases[n].expression + ";\n";
        }
        text += "} }\n";
        const ir::Program program = loadCompute(text);
        EXPECT_TRUE(program.usesSubgroups);
        const auto o = dispatchEverywhere(
            program, {{2, 1, 1}, {}},
            {{0, a}, {1, wordsOf(b)}, {2, std::vector<uint32_t>(cases.size() * kInvocations)}}, {}, kSize)[2];
        for (uint32_t i = 0; i < kInvocations; ++i) {
            Group group;
            for (uint32_t k = 0; k < kSize && i / kSize * kSize + k < kInvocations; ++k) {
                const uint32_t other = i / kSize * kSize + k;
                group.u[k] = a[other];
                group.f[k] = b[other];
                group.active |= (flow.together(i, other, a) ? 1u : 0u) << k;
            }
            if (!group.runs(i % kSize)) continue;
            for (size_t n = 0; n < cases.size(); ++n) {
                ASSERT_EQ(o[n * kInvocations + i], cases[n].model(group, i % kSize))
                    << cases[n].expression << ", invocation " << i << ", " << flow.head;
            }
        }
    }
}

TEST(Subgroup, IntegerArithmetic) {
    check(integerCases());
}

TEST(Subgroup, FloatArithmetic) {
    check(floatCases());
}

TEST(Subgroup, DoubleArithmetic) {
    check(doubleCases());
}

TEST(Subgroup, WideIntegerArithmetic) {
    check(wideIntegerCases());
}

TEST(Subgroup, NarrowIntegerArithmetic) {
    check(narrowIntegerCases());
}

TEST(Subgroup, HalfArithmetic) {
    check(halfCases());
}

TEST(Subgroup, OtherWidths) {
    check(otherWidthCases());
}

TEST(Subgroup, VotesBallotsShufflesAndQuads) {
    check(otherCases());
}

// A sum begins with the first value, and a NaN gives way to a number.
TEST(Subgroup, SpecialFloats) {
    const ir::Program program = loadCompute(std::string(kExtensions) + kPrologue +
                                            "o[i] = floatBitsToUint(subgroupAdd(f)); o[80 + i] = "
                                            "floatBitsToUint(subgroupMin(f)); o[160 + i] = "
                                            "floatBitsToUint(subgroupMax(f)); }");
    std::vector<float> b(kInvocations, -0.0f);
    for (uint32_t i = kSize; i < kInvocations; ++i) b[i] = i % 2 == 0 ? std::nanf("") : static_cast<float>(i);
    const auto o = dispatchEverywhere(
        program, {},
        {{0, std::vector<uint32_t>(kInvocations)}, {1, wordsOf(b)}, {2, std::vector<uint32_t>(3 * kInvocations)}}, {},
        kSize)[2];
    EXPECT_EQ(o[0], 0x80000000u);
    EXPECT_EQ(o[80 + 40], std::bit_cast<uint32_t>(33.0f));
    EXPECT_EQ(o[160 + 40], std::bit_cast<uint32_t>(63.0f));
}

// The older instructions of SPV_KHR_shader_ballot and SPV_KHR_subgroup_vote.
TEST(Subgroup, OlderForms) {
    const Words words = assemble(R"(OpCapability Shader
OpCapability SubgroupBallotKHR
OpCapability SubgroupVoteKHR
OpExtension "SPV_KHR_shader_ballot"
OpExtension "SPV_KHR_subgroup_vote"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %index %lane
OpExecutionMode %main LocalSize 64 1 1
OpDecorate %index BuiltIn LocalInvocationIndex
OpDecorate %lane BuiltIn SubgroupLocalInvocationId
OpDecorate %block BufferBlock
OpMemberDecorate %block 0 Offset 0
OpDecorate %words ArrayStride 4
OpDecorate %out DescriptorSet 0
OpDecorate %out Binding 0
%void = OpTypeVoid
%bool = OpTypeBool
%fn = OpTypeFunction %void
%uint = OpTypeInt 32 0
%uvec4 = OpTypeVector %uint 4
%c0 = OpConstant %uint 0
%c1 = OpConstant %uint 1
%c2 = OpConstant %uint 2
%c4 = OpConstant %uint 4
%c8 = OpConstant %uint 8
%c16 = OpConstant %uint 16
%c20 = OpConstant %uint 20
%c64 = OpConstant %uint 64
%words = OpTypeRuntimeArray %uint
%block = OpTypeStruct %words
%pin = OpTypePointer Input %uint
%pblock = OpTypePointer Uniform %block
%pword = OpTypePointer Uniform %uint
%index = OpVariable %pin Input
%lane = OpVariable %pin Input
%out = OpVariable %pblock Uniform
%main = OpFunction %void None %fn
%ml = OpLabel
%i = OpLoad %uint %index
%l = OpLoad %uint %lane
%low = OpULessThan %bool %l %c20
%small = OpULessThan %bool %l %c64
OpSelectionMerge %end None
OpBranchConditional %low %then %end
%then = OpLabel
%bit = OpBitwiseAnd %uint %l %c2
%cond = OpINotEqual %bool %bit %c0
%ballot = OpSubgroupBallotKHR %uvec4 %cond
%word = OpCompositeExtract %uint %ballot 0
%first = OpSubgroupFirstInvocationKHR %uint %i
%read = OpSubgroupReadInvocationKHR %uint %i %c8
%all = OpSubgroupAllKHR %bool %low
%any = OpSubgroupAnyKHR %bool %cond
%same = OpSubgroupAllEqualKHR %bool %cond
%same2 = OpSubgroupAllEqualKHR %bool %small
%v1 = OpSelect %uint %all %c1 %c0
%v2 = OpSelect %uint %any %c2 %c0
%v3 = OpSelect %uint %same %c4 %c0
%v4 = OpSelect %uint %same2 %c8 %c0
%s1 = OpIAdd %uint %v1 %v2
%s2 = OpIAdd %uint %v3 %v4
%votes = OpIAdd %uint %s1 %s2
%at = OpIMul %uint %i %c4
%at1 = OpIAdd %uint %at %c1
%at2 = OpIAdd %uint %at1 %c1
%at3 = OpIAdd %uint %at2 %c1
%p0 = OpAccessChain %pword %out %c0 %at
%p1 = OpAccessChain %pword %out %c0 %at1
%p2 = OpAccessChain %pword %out %c0 %at2
%p3 = OpAccessChain %pword %out %c0 %at3
OpStore %p0 %word
OpStore %p1 %first
OpStore %p2 %read
OpStore %p3 %votes
OpBranch %end
%end = OpLabel
OpReturn
OpFunctionEnd
)");
    ShaderSource source;
    source.words = words;
    source.stage = ir::Stage::compute;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_TRUE(program.ok()) << program.error().message;
    const auto o = dispatchEverywhere(*program, {}, {{0, std::vector<uint32_t>(256)}}, {}, kSize)[0];
    for (uint32_t i = 0; i < 64; ++i) {
        const bool runs = i % kSize < 20;
        EXPECT_EQ(o[4 * i], runs ? 0x000CCCCCu : 0) << i;
        EXPECT_EQ(o[4 * i + 1], runs ? i / kSize * kSize : 0) << i;
        EXPECT_EQ(o[4 * i + 2], runs ? i / kSize * kSize + 8 : 0) << i;
        EXPECT_EQ(o[4 * i + 3], runs ? 1u + 2 + 8 : 0) << i;
    }
}

// In a fragment program a subgroup is 32 lanes of a batch; helper lanes run, discarded ones do not.
TEST(Subgroup, FragmentPrograms) {
    const Words words = compileGlsl(ir::Stage::fragment, std::string(kExtensions) + R"(
layout(location = 0) flat in uint v;
layout(location = 0) out uint sum;
layout(location = 1) out uint neighbour;
layout(location = 2) out uint place;
void main() {
    neighbour = subgroupQuadSwapHorizontal(v);
    if (v % 5 == 0) discard;
    sum = subgroupAdd(v);
    place = gl_SubgroupInvocationID + gl_SubgroupSize * 100;
}
)");
    ShaderSource source;
    source.words = words;
    source.stage = ir::Stage::fragment;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_TRUE(program->usesQuads);
    std::vector<uint32_t> v(64);
    for (uint32_t i = 0; i < 64; ++i) v[i] = i * i + 1;
    for (const Isa isa : isas()) {
        for (const uint32_t capacity : {32u, 64u}) {
            RunSetup setup;
            setup.isa = isa;
            setup.capacity = capacity;
            setup.lanes = std::min(capacity, 56u);
            setup.store.assign(64, ~0u);
            setup.store[3] = 0;
            const RunResult result = runBatch(*program, {v}, setup);
            const auto output = [&](uint32_t location) {
                for (uint32_t k = 0; k < program->outputs.size(); ++k) {
                    if (program->outputs[k].location == location) return result.outputs[k];
                }
                return std::vector<uint32_t>(setup.lanes);
            };
            for (uint32_t lane = 0; lane < setup.lanes; ++lane) {
                if (v[lane] % 5 == 0) continue;
                uint32_t sum = 0;
                for (uint32_t k = lane / kSize * kSize; k < std::min(lane / kSize * kSize + kSize, setup.lanes); ++k) {
                    sum += v[k] % 5 == 0 ? 0 : v[k];
                }
                EXPECT_EQ(output(0)[lane], sum);
                EXPECT_EQ(output(1)[lane], v[lane ^ 1]);
                EXPECT_EQ(output(2)[lane], lane % kSize + 3200);
            }
        }
    }
}

TEST(Subgroup, NarrowBatchesAreRefused) {
    const ir::Program program = loadCompute(std::string(kExtensions) + kPrologue + "o[i] = subgroupAdd(u); }");
    const auto compiled = BatchProgram::compile(program, {kLowestIsa, MathTier::standard, 16});
    ASSERT_FALSE(compiled.ok());
    EXPECT_EQ(compiled.error().message, "BatchOptions::lanes is 16; 'main' uses subgroups, which have 32 invocations");
}

}  // namespace
}  // namespace vernier::test
