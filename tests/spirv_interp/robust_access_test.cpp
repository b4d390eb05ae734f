// Places outside of buffers that arithmetic in 32 bits would lead back inside, and values that lie across the end.
#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/shader_run.h"

namespace vernier::test {
namespace {

constexpr uint32_t kLanes = 64;

/// What `expression` of `index`, the lane's word of `indices`, reads of a buffer of `words` words, each of which tells
/// its place.
std::vector<uint32_t> valuesRead(Isa isa, const char* declaration, const char* expression,
                                 const std::vector<uint32_t>& indices, uint32_t words) {
    ShaderRun shader;
    shader.words = laneShader("#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n",
                              "layout(std430, set = 0, binding = 0) buffer B { " + std::string(declaration) +
                                  " };\nlayout(std430, set = 0, binding = 1) readonly buffer I { uint indices[]; };"
                                  "layout(location = 0) out uint o;",
                              "uint index = indices[lane]; o = " + std::string(expression) + ";");
    std::vector<uint32_t> contents(words);
    for (uint32_t k = 0; k < words; ++k) contents[k] = 1000 + k;
    shader.buffers = {{0, bytesOf(contents)}, {1, bytesOf(indices)}};
    EXPECT_TRUE(shader.run(isa));
    std::vector<uint32_t> values;
    for (uint32_t lane = 0; lane < kLanes; ++lane) values.push_back(shader.output(0, lane));
    return values;
}

std::vector<uint32_t> repeated(std::vector<uint32_t> some) {
    const size_t period = some.size();
    for (size_t k = period; k < kLanes; ++k) some.push_back(some[k % period]);
    return some;
}

TEST(RobustAccess, ProductsDoNotWrapAround) {
    const std::vector<uint32_t> indices =
        repeated({0, 1, 0x80000000u, 0x10000000u, 0x20000001u, 0xFFFFFFFFu, 0x40000000u, 2});
    for (const Isa isa : isas()) {
        EXPECT_EQ(valuesRead(isa, "uvec4 b[];", "b[index].y", indices, 64),
                  repeated({1001, 1005, 0, 0, 0, 0, 0, 1009}));
        EXPECT_EQ(valuesRead(isa, "uint b[];", "b[index]", indices, 64), repeated({1000, 1001, 0, 0, 0, 0, 0, 1002}));
        // Before the array there are four words of the same buffer.
        EXPECT_EQ(valuesRead(isa, "uvec4 head; uint b[];", "b[int(index)]", indices, 64),
                  repeated({1004, 1005, 0, 0, 0, 0, 0, 1006}));
        // Two indices whose distances add up to 2^32.
        EXPECT_EQ(valuesRead(isa, "uint b[][4];", "b[index][index]", indices, 64),
                  repeated({1000, 1005, 0, 0, 0, 0, 0, 1010}));
    }
}

// An index of 64 bits whose low word alone would be inside.
TEST(RobustAccess, WideIndicesAreTakenWhole) {
    ShaderRun shader;
    shader.words = assemble(R"(
OpCapability Shader
OpCapability Int64
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %lane %o
OpExecutionMode %main OriginUpperLeft
OpDecorate %lane Location 0
OpDecorate %lane Flat
OpDecorate %o Location 0
OpDecorate %array ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%int = OpTypeInt 32 1
%long = OpTypeInt 64 1
%array = OpTypeRuntimeArray %int
%block = OpTypeStruct %array
%pin = OpTypePointer Input %int
%pout = OpTypePointer Output %int
%pblock = OpTypePointer StorageBuffer %block
%pword = OpTypePointer StorageBuffer %int
%lane = OpVariable %pin Input
%o = OpVariable %pout Output
%b = OpVariable %pblock StorageBuffer
%c0 = OpConstant %int 0
%c31 = OpConstant %int 31
%main = OpFunction %void None %fn
%entry = OpLabel
%n = OpLoad %int %lane
%wide = OpSConvert %long %n
%index = OpShiftLeftLogical %long %wide %c31
%place = OpAccessChain %pword %b %c0 %index
%value = OpLoad %int %place
OpStore %o %value
OpReturn
OpFunctionEnd
)");
    for (const Isa isa : isas()) {
        shader.buffers = {{0, bytesOf(std::vector<uint32_t>(8, 9))}};
        ASSERT_TRUE(shader.run(isa));
        for (uint32_t lane = 0; lane < kLanes; ++lane) EXPECT_EQ(shader.output(0, lane), lane == 0 ? 9u : 0u);
    }
}

TEST(RobustAccess, ConstantPlacesDoNotWrapAround) {
    const std::vector<uint32_t> indices = repeated({0});
    for (const Isa isa : isas()) {
        EXPECT_EQ(valuesRead(isa, "uvec4 b[];", "b[0x10000000].x + b[0x40000001].x", indices, 64), repeated({0}));
        EXPECT_EQ(valuesRead(isa, "uvec4 b[];", "b[3].x", indices, 64), repeated({1012}));
    }
}

// The last 8 bytes of a buffer of 7 words are half outside.
TEST(RobustAccess, WideValuesAreInsideAsAWhole) {
    const std::vector<uint32_t> indices = repeated({0, 2, 3, 0x20000000u});
    for (const Isa isa : isas()) {
        EXPECT_EQ(valuesRead(isa, "uint64_t b[];", "uint(b[index]) + uint(b[index] >> 32)", indices, 7),
                  repeated({2001, 2009, 0, 0}));
        EXPECT_EQ(valuesRead(isa, "uint64_t b[];", "uint(b[3]) + uint(b[2] >> 32)", indices, 7), repeated({1005}));
        ShaderRun shader;
        shader.words = laneShader("#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n",
                                  "layout(std430, set = 0, binding = 0) buffer B { uint64_t b[]; };"
                                  "layout(location = 0) out uint o;",
                                  "b[lane] = 5ul + (6ul << 32); o = 0u;");
        shader.buffers = {{0, bytesOf(std::vector<uint32_t>(7, 9))}};
        ASSERT_TRUE(shader.run(isa));
        EXPECT_EQ(valuesOf<uint32_t>(shader.buffers[0]), (std::vector<uint32_t>{5, 6, 5, 6, 5, 6, 9}));
    }
}

}  // namespace
}  // namespace vernier::test
