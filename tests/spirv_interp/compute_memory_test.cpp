// Work-group memory: every type, layouts, initial values, atomics, and pointers to it as arguments.
#include <gtest/gtest.h>

#include <bit>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/compute_harness.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {
namespace {

// Neighbours exchange values of all shapes through variables of one work-group.
TEST(WorkgroupMemory, HoldsEveryType) {
    const ir::Program program = loadCompute(R"(#version 450
#extension GL_ARB_gpu_shader_int64 : require
layout(local_size_x = 40) in;
layout(set = 0, binding = 0) buffer B { uint o[]; };
struct S { vec3 v; bool flag; mat2x3 m; dvec2 d; uint tail[3]; };
shared bool flags[40];
shared S things[40];
shared mat3 matrices[40];
shared uint64_t longs[40];
shared uvec4 single;
void main() {
    uint i = gl_LocalInvocationIndex, n = 39 - i;
    flags[i] = i % 3 == 0;
    S s;
    s.v = vec3(i, i + 1, i + 2); s.flag = i % 2 == 1; s.m = mat2x3(i, 1, 2, 3, 4, i); s.d = dvec2(i + 0.5, 9);
    s.tail = uint[3](i, i * 2, i * 3);
    things[i] = s;
    matrices[i] = mat3(i);
    matrices[i][2][0] = 5;
    longs[i] = (uint64_t(i) << 40) + i;
    if (i == 11) single = uvec4(1, 2, 3, 4);
    if (i == 12) single[3] = 7;
    barrier();
    uint sum = flags[n] ? 1 : 0;
    S t = things[n];
    sum += uint(t.v.x + t.v.y + t.v.z) * 10;
    sum += t.flag ? 1000000 : 0;
    sum += uint(t.m[0].x + t.m[1].z) + uint(things[n].m[i % 2][1]) * 7;
    sum += uint(t.d.x * 2 + t.d.y);
    sum += t.tail[i % 3] + things[n].tail[2];
    sum += uint(matrices[n][i % 3][i % 3] + matrices[n][2][0]) * 3;
    sum += uint(longs[n] >> 40) + uint(longs[n]);
    sum += single.x + single[i % 3] * 11 + single.w;
    o[i] = sum;
}
)");
    const auto o = dispatchEverywhere(program, {}, {{0, std::vector<uint32_t>(40)}})[0];
    for (uint32_t i = 0; i < 40; ++i) {
        const uint32_t n = 39 - i;
        uint32_t sum = n % 3 == 0 ? 1 : 0;
        sum += (3 * n + 3) * 10 + (n % 2 == 1 ? 1000000 : 0);
        sum += 2 * n + (i % 2 == 0 ? 1 : 4) * 7;
        sum += 2 * n + 1 + 9;
        sum += n * (i % 3 + 1) + n * 3;
        sum += (n + 5) * 3 + n + n;
        sum += 1 + (i % 3 + 1) * 11 + 7;
        EXPECT_EQ(o[i], sum) << i;
    }
}

TEST(WorkgroupMemory, IsZeroAtFirst) {
    const ir::Program program = loadCompute(R"(#version 450
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer B { uint o[]; };
shared uint s[100];
void main() {
    uint i = gl_LocalInvocationIndex;
    o[gl_GlobalInvocationID.x] += s[i] + s[99 - i];
    barrier();
    s[i] = s[99 - i] = 5;
}
)");
    const auto o = dispatchEverywhere(program, {{4, 1, 1}, {}}, {{0, std::vector<uint32_t>(128)}})[0];
    EXPECT_EQ(o, std::vector<uint32_t>(128));
}

// Blocks in work-group memory lie one on the other and have the layout their decorations tell.
TEST(WorkgroupMemory, ExplicitLayoutsAlias) {
    const ir::Program program = loadCompute(R"(#version 450
#extension GL_EXT_shared_memory_block : require
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) buffer B { uint o[]; };
shared X { layout(offset = 64) uint words[40]; } x;
shared Y { vec4 first[4]; layout(offset = 64) float floats[40]; } y;
shared Z { layout(offset = 224, row_major) mat2 m; } z;
void main() {
    uint i = gl_LocalInvocationIndex;
    x.words[i] = floatBitsToUint(float(i));
    if (i == 3) z.m = mat2(1, 2, 3, 4);
    barrier();
    o[i] = uint(y.floats[15 - i]) + uint(z.m[1][0]) * 100;
    o[16 + i] = i < 2 ? uint(z.m[i][1]) : 0;
}
)");
    ASSERT_EQ(program.resources.size(), 2u);
    const auto o = dispatchEverywhere(program, {}, {{0, std::vector<uint32_t>(32)}})[0];
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(o[i], 15 - i + 300);
    EXPECT_EQ(o[16], 2u);
    EXPECT_EQ(o[17], 4u);
}

TEST(WorkgroupMemory, Atomics) {
    const ir::Program program = loadCompute(R"(#version 450
layout(local_size_x = 100) in;
layout(set = 0, binding = 0) buffer B { uint o[]; };
shared uint u[8];
shared int low, high;
void main() {
    uint i = gl_LocalInvocationIndex;
    if (i == 0) { u[1] = 0xFFFFFFFFu; u[3] = 1000; }
    barrier();
    atomicAdd(u[0], i);
    atomicAnd(u[1], ~(1u << (i % 7)));
    atomicOr(u[2], 1u << (i % 31));
    atomicMin(u[3], i + 3);
    atomicMax(u[4], i * 2);
    atomicXor(u[5], i);
    if (atomicCompSwap(u[6], i, i + 1) == i) atomicAdd(u[7], 1);
    atomicMin(low, -int(i));
    atomicMax(high, int(i) - 50);
    barrier();
    if (i < 8) o[i] = u[i];
    if (i == 8) o[8] = uint(low);
    if (i == 9) o[9] = uint(high);
    if (i == 10) o[10] = atomicExchange(u[0], 3u);
}
)");
    const auto o = dispatchEverywhere(program, {}, {{0, std::vector<uint32_t>(11)}})[0];
    uint32_t exclusive = 0;
    for (uint32_t i = 0; i < 100; ++i) exclusive ^= i;
    EXPECT_EQ(o, (std::vector<uint32_t>{4950, ~0x7Fu, 0x7FFFFFFFu, 3, 198, exclusive, 100, 100,
                                        static_cast<uint32_t>(-99), 49, 4950}));
}

TEST(WorkgroupMemory, PointersAsArguments) {
    ShaderSource source;
    const Words words = assemble(R"(OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %index
OpExecutionMode %main LocalSize 8 1 1
OpDecorate %index BuiltIn LocalInvocationIndex
OpDecorate %block BufferBlock
OpMemberDecorate %block 0 Offset 0
OpDecorate %words ArrayStride 4
OpDecorate %out DescriptorSet 0
OpDecorate %out Binding 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%uint = OpTypeInt 32 0
%c0 = OpConstant %uint 0
%c1 = OpConstant %uint 1
%c2 = OpConstant %uint 2
%c7 = OpConstant %uint 7
%c8 = OpConstant %uint 8
%semantics = OpConstant %uint 264
%array = OpTypeArray %uint %c8
%words = OpTypeRuntimeArray %uint
%block = OpTypeStruct %words
%pin = OpTypePointer Input %uint
%pshared = OpTypePointer Workgroup %array
%pelement = OpTypePointer Workgroup %uint
%pblock = OpTypePointer Uniform %block
%pword = OpTypePointer Uniform %uint
%index = OpVariable %pin Input
%unused = OpVariable %pshared Workgroup
%first = OpVariable %pshared Workgroup
%second = OpVariable %pshared Workgroup
%out = OpVariable %pblock Uniform
%fill_t = OpTypeFunction %void %pshared %uint %uint
%fill = OpFunction %void None %fill_t
%to = OpFunctionParameter %pshared
%at = OpFunctionParameter %uint
%value = OpFunctionParameter %uint
%fl = OpLabel
%element = OpAccessChain %pelement %to %at
OpStore %element %value
OpReturn
OpFunctionEnd
%main = OpFunction %void None %fn
%ml = OpLabel
%i = OpLoad %uint %index
%twice = OpIMul %uint %i %c2
%r1 = OpFunctionCall %void %fill %first %i %twice
%r2 = OpFunctionCall %void %fill %second %i %i
OpControlBarrier %c2 %c2 %semantics
%n = OpISub %uint %c7 %i
%pa = OpAccessChain %pelement %first %n
%pb = OpAccessChain %pelement %second %n
%a = OpLoad %uint %pa
%b = OpAtomicIAdd %uint %pb %c2 %c0 %c1
%sum = OpIAdd %uint %a %b
%po = OpAccessChain %pword %out %c0 %i
OpStore %po %sum
OpReturn
OpFunctionEnd
)");
    source.words = words;
    source.stage = ir::Stage::compute;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_TRUE(program.ok()) << program.error().message;
    // What is never used takes no room.
    for (const ir::Resource& resource : program->resources) {
        if (resource.kind == ir::ResourceKind::workgroupMemory) {
            EXPECT_EQ(resource.byteSize, 64u);
        }
    }
    const auto o = dispatchEverywhere(*program, {}, {{0, std::vector<uint32_t>(8)}})[0];
    for (uint32_t i = 0; i < 8; ++i) EXPECT_EQ(o[i], 3 * (7 - i));
}

// A pointer from a select between two variables, and one from a phi; loads and stores through both.
TEST(WorkgroupMemory, VariablePointers) {
    ShaderSource source;
    const Words words = assemble(R"(OpCapability Shader
OpCapability VariablePointers
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %index
OpExecutionMode %main LocalSize 8 1 1
OpDecorate %index BuiltIn LocalInvocationIndex
OpDecorate %block BufferBlock
OpMemberDecorate %block 0 Offset 0
OpDecorate %words ArrayStride 4
OpDecorate %out DescriptorSet 0
OpDecorate %out Binding 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%c0 = OpConstant %uint 0
%c1 = OpConstant %uint 1
%c2 = OpConstant %uint 2
%c4 = OpConstant %uint 4
%c7 = OpConstant %uint 7
%c8 = OpConstant %uint 8
%c100 = OpConstant %uint 100
%c1000 = OpConstant %uint 1000
%semantics = OpConstant %uint 264
%array = OpTypeArray %uint %c8
%words = OpTypeRuntimeArray %uint
%block = OpTypeStruct %words
%pin = OpTypePointer Input %uint
%pshared = OpTypePointer Workgroup %array
%pelement = OpTypePointer Workgroup %uint
%pblock = OpTypePointer Uniform %block
%pword = OpTypePointer Uniform %uint
%index = OpVariable %pin Input
%first = OpVariable %pshared Workgroup
%second = OpVariable %pshared Workgroup
%out = OpVariable %pblock Uniform
%main = OpFunction %void None %fn
%ml = OpLabel
%i = OpLoad %uint %index
%ownfirst = OpAccessChain %pelement %first %i
%ownsecond = OpAccessChain %pelement %second %i
%twice = OpIMul %uint %i %c2
%more = OpIAdd %uint %i %c100
OpStore %ownfirst %twice
OpStore %ownsecond %more
OpControlBarrier %c2 %c2 %semantics
%n = OpISub %uint %c7 %i
%pn = OpAccessChain %pelement %first %n
%low = OpBitwiseAnd %uint %i %c1
%odd = OpINotEqual %bool %low %c0
%p = OpSelect %pelement %odd %pn %ownsecond
%v = OpLoad %uint %p
%next = OpIAdd %uint %v %c1
OpStore %p %next
OpControlBarrier %c2 %c2 %semantics
%small = OpULessThan %bool %i %c4
OpSelectionMerge %mm None
OpBranchConditional %small %mt %mf
%mt = OpLabel
OpBranch %mm
%mf = OpLabel
OpBranch %mm
%mm = OpLabel
%q = OpPhi %pelement %ownfirst %mt %ownsecond %mf
%w = OpLoad %uint %q
%thousands = OpIMul %uint %w %c1000
%sum = OpIAdd %uint %thousands %v
%po = OpAccessChain %pword %out %c0 %i
OpStore %po %sum
OpReturn
OpFunctionEnd
)");
    source.words = words;
    source.stage = ir::Stage::compute;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_TRUE(program.ok()) << program.error().message;
    const auto o = dispatchEverywhere(*program, {}, {{0, std::vector<uint32_t>(8)}})[0];
    for (uint32_t i = 0; i < 8; ++i) {
        // Every even element of both has been counted on by one.
        const uint32_t element = (i < 4 ? 2 * i : 100 + i) + (i % 2 == 0 ? 1 : 0);
        EXPECT_EQ(o[i], element * 1000 + (i % 2 != 0 ? 2 * (7 - i) : 100 + i)) << i;
    }
}

// An index beyond a variable stays inside the work-group's memory.
TEST(WorkgroupMemory, IndicesAreBounded) {
    const ir::Program program = loadCompute(R"(#version 450
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint o[]; };
shared uint s[10];
void main() {
    uint i = gl_LocalInvocationIndex;
    s[o[i]] = i;
    barrier();
    o[i] = s[o[i] * 0x10001u];
}
)");
    const auto o =
        dispatchEverywhere(program, {}, {{0, {0, 9, 10, 0x3FFFFFFF, 0x40000000, 0x80000000, 0xFFFFFFFF, 100000}}})[0];
    EXPECT_EQ(o[2], 0u);
    EXPECT_EQ(o[7], 0u);
}

}  // namespace
}  // namespace vernier::test
