// Pointers as values: variable pointers, and addresses of physical storage buffers.
#include <gtest/gtest.h>

#include <random>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/shader_run.h"

namespace vernier::test {
namespace {

constexpr const char* kHead = R"(
OpCapability Shader
OpCapability VariablePointers
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %lane %o %a %b %p
OpExecutionMode %main OriginUpperLeft
OpDecorate %lane Location 0
OpDecorate %lane Flat
OpDecorate %o Location 0
OpDecorate %array ArrayStride 4
OpDecorate %ptr ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpMemberDecorate %block 1 Offset 16
OpDecorate %a DescriptorSet 0
OpDecorate %a Binding 0
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 1
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%int = OpTypeInt 32 1
%v4 = OpTypeVector %int 4
%array = OpTypeRuntimeArray %int
%block = OpTypeStruct %v4 %array
%pin = OpTypePointer Input %int
%pout = OpTypePointer Output %int
%pblock = OpTypePointer StorageBuffer %block
%parray = OpTypePointer StorageBuffer %array
%ptr = OpTypePointer StorageBuffer %int
%pptr = OpTypePointer Private %ptr
%lane = OpVariable %pin Input
%o = OpVariable %pout Output
%a = OpVariable %pblock StorageBuffer
%b = OpVariable %pblock StorageBuffer
%p = OpVariable %pptr Private
%null = OpConstantNull %ptr
%c0 = OpConstant %int 0
%c1 = OpConstant %int 1
%c2 = OpConstant %int 2
%c3 = OpConstant %int 3
%c5 = OpConstant %int 5
%c7 = OpConstant %int 7
%c100 = OpConstant %int 100
%choose = OpTypeFunction %ptr %bool %ptr %ptr
)";

struct TwoBuffers {
    TwoBuffers() {
        for (int k = 0; k < 132; ++k) a.push_back(1000 + k), b.push_back(5000 + k);
    }
    std::vector<int32_t> a, b;
};

// A pointer from a select between two buffers, from a function, from a private variable, from a phi in a loop that
// counts it on.
TEST(VariablePointers, BetweenBuffers) {
    ShaderRun shader;
    shader.words = assemble(std::string(kHead) + R"(
%pick = OpFunction %ptr None %choose
%cond = OpFunctionParameter %bool
%x = OpFunctionParameter %ptr
%y = OpFunctionParameter %ptr
%pe = OpLabel
OpSelectionMerge %pm None
OpBranchConditional %cond %pt %pm
%pt = OpLabel
OpReturnValue %x
%pm = OpLabel
OpReturnValue %y
OpFunctionEnd
%main = OpFunction %void None %fn
%entry = OpLabel
%n = OpLoad %int %lane
%bit = OpBitwiseAnd %int %n %c1
%odd = OpINotEqual %bool %bit %c0
%pa = OpAccessChain %ptr %a %c1 %n
%pb = OpAccessChain %ptr %b %c1 %n
%sel = OpSelect %ptr %odd %pa %pb
OpStore %p %sel
%called = OpFunctionCall %ptr %pick %odd %pb %pa
%v0 = OpLoad %int %called
%held = OpLoad %ptr %p
%next = OpPtrAccessChain %ptr %held %c1
OpBranch %head
%head = OpLabel
%cursor = OpPhi %ptr %next %entry %step %body
%i = OpPhi %int %c0 %entry %i1 %body
%total = OpPhi %int %v0 %entry %t1 %body
%go = OpSLessThan %bool %i %c3
OpLoopMerge %done %body None
OpBranchConditional %go %body %done
%body = OpLabel
%v = OpLoad %int %cursor
%t1 = OpIAdd %int %total %v
%step = OpPtrAccessChain %ptr %cursor %c5
%i1 = OpIAdd %int %i %c1
OpBranch %head
%done = OpLabel
OpStore %o %total
%pv = OpAccessChain %ptr %a %c0 %c1
%one = OpIEqual %bool %n %c7
%out = OpSelect %ptr %one %pv %null
OpStore %out %total
%nothing = OpLoad %int %out
%same = OpPtrEqual %bool %out %null
%differs = OpPtrDiff %int %cursor %next
%extra = OpSelect %int %same %differs %nothing
%final = OpIAdd %int %total %extra
OpStore %o %final
OpReturn
OpFunctionEnd
)",
                            5);
    for (const Isa isa : isas()) {
        const TwoBuffers start;
        shader.buffers[0] = bytesOf(start.a);
        shader.buffers[1] = bytesOf(start.b);
        ASSERT_TRUE(shader.run(isa));
        std::vector<int32_t> a = start.a;
        for (int lane = 0; lane < 64; ++lane) {
            const std::vector<int32_t>& mine = lane % 2 != 0 ? start.a : start.b;
            const std::vector<int32_t>& other = lane % 2 != 0 ? start.b : start.a;
            const auto at = [&](const std::vector<int32_t>& buffer, int index) {
                return buffer[static_cast<size_t>(4 + index)];
            };
            const int total = at(other, lane) + at(mine, lane + 1) + at(mine, lane + 6) + at(mine, lane + 11);
            // The pointer went 15 elements on; lane 7 reads back what it has stored.
            EXPECT_EQ(static_cast<int>(shader.output(0, static_cast<uint32_t>(lane))), total + (lane == 7 ? total : 15))
                << lane;
            if (lane == 7) a[1] = total;
        }
        EXPECT_EQ(valuesOf<int32_t>(shader.buffers[0]), a);
        EXPECT_EQ(valuesOf<int32_t>(shader.buffers[1]), start.b);
    }
}

// Within one buffer the resource is known while lowering; an atomic and a length go through the pointer as well.
TEST(VariablePointers, WithinOneBuffer) {
    ShaderRun shader;
    shader.words = assemble(std::string(kHead) + R"(
%main = OpFunction %void None %fn
%entry = OpLabel
%n = OpLoad %int %lane
%bit = OpBitwiseAnd %int %n %c1
%odd = OpINotEqual %bool %bit %c0
%pa = OpAccessChain %ptr %a %c1 %c2
%pb = OpAccessChain %ptr %a %c1 %c100
%sel = OpSelect %ptr %odd %pa %pb
%old = OpAtomicIAdd %int %sel %c1 %c0 %n
OpStore %o %old
OpReturn
OpFunctionEnd
)",
                            5);
    for (const Isa isa : isas()) {
        const TwoBuffers start;
        shader.buffers[0] = bytesOf(start.a);
        shader.buffers[1] = bytesOf(start.b);
        ASSERT_TRUE(shader.run(isa));
        EXPECT_EQ(shader.program.resources.size(), 1u);
        std::vector<int32_t> a = start.a;
        for (int lane = 0; lane < 64; ++lane) {
            int32_t& word = a[lane % 2 != 0 ? 6 : 104];
            EXPECT_EQ(static_cast<int>(shader.output(0, static_cast<uint32_t>(lane))), word);
            word += lane;
        }
        EXPECT_EQ(valuesOf<int32_t>(shader.buffers[0]), a);
    }
}

/// Device memory for tests: two ranges with a hole between them.
struct DeviceMemory {
    static constexpr uint64_t kFirst = 0x7000'0000'1000, kSecond = 0x7000'0001'0000;
    std::vector<uint64_t> first = std::vector<uint64_t>(64), second = std::vector<uint64_t>(256);
    uint32_t calls = 0;

    static AddressRange find(void* self, uint64_t address) {
        auto* memory = static_cast<DeviceMemory*>(self);
        ++memory->calls;
        const auto range = [&](uint64_t base, std::vector<uint64_t>& words) {
            return AddressRange{reinterpret_cast<std::byte*>(words.data()), base, words.size() * 8};
        };
        if (address >= kFirst && address < kFirst + 64 * 8) return range(kFirst, memory->first);
        if (address >= kSecond && address < kSecond + 256 * 8) return range(kSecond, memory->second);
        return {};
    }
    AddressResolver resolver() { return {this, find}; }
};

// A linked list through two ranges; what lies outside reads as 0 and cannot be written.
TEST(PhysicalStorageBuffers, ListsAndHoles) {
    ShaderRun shader;
    shader.words = laneShader(
        "#extension GL_EXT_buffer_reference : require\n#extension GL_EXT_buffer_reference_uvec2 : require\n"
        "#extension GL_EXT_buffer_reference2 : require\n"
        "#extension GL_EXT_shader_explicit_arithmetic_types : require\n#extension GL_EXT_shader_atomic_int64 : "
        "require\n"
        "#extension GL_EXT_shader_16bit_storage : require\n#extension GL_EXT_shader_8bit_storage : require\n",
        R"(
layout(buffer_reference) buffer Node;
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Node { Node next; int value; uint16_t factor; uint8_t bytes[2]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Ints { int v[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer One { int v; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Matrices { mat2x3 m; layout(row_major) mat3x2 r; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Counter { uint64_t n; uint k; };
layout(push_constant) uniform P { Node list; Counter counter; Matrices matrices; uvec2 bare; Node spare; };
layout(location = 0) out ivec4 o;
layout(location = 1) out vec2 w;
)",
        R"(
int sum = 0;
Node at = list;
for (int i = 0; i < 20 && uint64_t(at) != 0ul; ++i) {
    sum += at.value * (int(at.factor) + int(at.bytes[1]));
    at = at.next;
}
Ints ints = Ints(bare);
ints.v[lane * 3 - 2] = lane + 7;
One later = One(bare) + 1;
o = ivec4(sum, ints.v[lane * 3 - 2], ints.v[1000000], later.v);
uint64_t before = atomicAdd(counter.n, 1ul << 32);
atomicMax(counter.k, uint(lane));
if (lane == 3) { at = spare; at.bytes[0] = uint8_t(0xAB); at.factor = uint16_t(at.factor + uint16_t(1)); }
w = matrices.r * matrices.m[1];
)");
    DeviceMemory memory;
    shader.addresses = memory.resolver();
    const auto put = [](std::vector<uint64_t>& words, size_t at, uint64_t next, int value, uint16_t half, uint8_t b0,
                        uint8_t b1) {
        words[at] = next;
        words[at + 1] = static_cast<uint32_t>(value) | static_cast<uint64_t>(half) << 32 |
                        static_cast<uint64_t>(b0) << 48 | static_cast<uint64_t>(b1) << 56;
    };
    for (const Isa isa : isas()) {
        memory = {};
        put(memory.first, 0, DeviceMemory::kSecond + 16, 10, 100, 1, 2);
        put(memory.second, 2, DeviceMemory::kFirst + 32, -3, 1000, 3, 4);
        put(memory.second, 10, 0, -3, 1000, 3, 4);
        put(memory.first, 4, 0xDEAD'0000, 5, 60000, 5, 6);
        // The third node's next lies outside: all its members read as 0, so the list ends there.
        const float m[16] = {0, 0, 0, 0, 1, 2, 3, 0, 10, 20, 30, 0, 40, 50, 60, 0};
        std::memcpy(&memory.first[16], m, sizeof m);
        memory.first[40] = 5;
        const struct {
            uint64_t list, counter, matrices, bare, spare;
        } push = {DeviceMemory::kFirst, DeviceMemory::kFirst + 320, DeviceMemory::kFirst + 128,
                  DeviceMemory::kSecond + 1024, DeviceMemory::kSecond + 80};
        shader.push.resize(sizeof push);
        std::memcpy(shader.push.data(), &push, sizeof push);
        ASSERT_TRUE(shader.run(isa));
        const int sum = 10 * 102 - 3 * 1004 + 5 * 60006;
        std::vector<int32_t> ints(512);
        std::memcpy(ints.data(), memory.second.data(), 2048);
        for (uint32_t lane = 0; lane < 64; ++lane) {
            EXPECT_EQ(static_cast<int>(shader.output(0, lane)), sum) << lane;
            EXPECT_EQ(shader.output(1, lane), lane + 7);
            EXPECT_EQ(shader.output(2, lane), 0u);
            if (lane == 1) {
                EXPECT_EQ(shader.output(3, lane), 8u);  // what it has stored itself
            }
            EXPECT_EQ(ints[256 + lane * 3 - 2], static_cast<int>(lane) + 7);
            EXPECT_EQ(std::bit_cast<float>(shader.output(4, lane)), 10.0f * 1 + 20.0f * 2 + 30.0f * 3);
            EXPECT_EQ(std::bit_cast<float>(shader.output(5, lane)), 40.0f * 1 + 50.0f * 2 + 60.0f * 3);
        }
        EXPECT_EQ(memory.first[40], 5 + (uint64_t{64} << 32));
        EXPECT_EQ(memory.first[41], 63u);
        const uint64_t second =
            static_cast<uint32_t>(-3) | uint64_t{1001} << 32 | uint64_t{0xAB} << 48 | uint64_t{4} << 56;
        EXPECT_EQ(memory.second[11], second);
        EXPECT_LT(memory.calls, 3000u);
    }
}

// Values of 64 bits at any word; one that is only half in memory is outside as a whole.
TEST(PhysicalStorageBuffers, WideValuesAtAnyWord) {
    ShaderRun shader;
    shader.words = laneShader(
        "#extension GL_EXT_buffer_reference : require\n#extension GL_EXT_shader_explicit_arithmetic_types : require\n",
        R"(
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Long { uint64_t v; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Double { double v; };
layout(push_constant) uniform P { uint64_t middle, end; };
layout(location = 0) out uvec4 o;
)",
        R"(
// Lanes 0 .. 7: the last word but one, and on across the end, a word at a time; then whole values from an odd word.
uint64_t at = lane < 8 ? end + 4ul * uint64_t(lane) - 16ul : middle + 8ul * uint64_t(lane);
uint64_t before = Long(at).v;
Long(at).v = before + (1ul << 32);
Double(at).v = Double(at).v * 2.0lf;
if (lane >= 8) o = uvec4(unpackUint2x32(before), unpackUint2x32(doubleBitsToUint64(Double(at).v)));
else o = uvec4(unpackUint2x32(before), 0, 0);
)");
    DeviceMemory memory;
    shader.addresses = memory.resolver();
    const uint64_t push[2] = {DeviceMemory::kSecond + 4, DeviceMemory::kFirst + 64 * 8};
    shader.push.resize(sizeof push);
    std::memcpy(shader.push.data(), push, sizeof push);
    const auto wordsOf = [](std::vector<uint64_t>& longs) { return reinterpret_cast<uint32_t*>(longs.data()); };
    for (const Isa isa : isas()) {
        memory = {};
        for (uint32_t k = 0; k < 512; ++k) wordsOf(memory.second)[k] = 0x3FF00000u + k;
        for (uint32_t k = 0; k < 128; ++k) wordsOf(memory.first)[k] = 0x3FE00000u + k;
        DeviceMemory expected = memory;
        ASSERT_TRUE(shader.run(isa));
        const auto change = [](uint32_t* words) {
            uint64_t value = 0;
            std::memcpy(&value, words, sizeof value);
            const double doubled = std::bit_cast<double>(value + (uint64_t{1} << 32)) * 2;
            std::memcpy(words, &doubled, sizeof doubled);
        };
        for (uint32_t lane = 8; lane < 64; ++lane) {
            uint32_t* words = wordsOf(expected.second) + 1 + 2 * lane;
            EXPECT_EQ(shader.output(0, lane), words[0]) << lane;
            EXPECT_EQ(shader.output(1, lane), words[1]);
            change(words);
            EXPECT_EQ(shader.output(2, lane), words[0]) << lane;
            EXPECT_EQ(shader.output(3, lane), words[1]);
        }
        // The last words that hold a value are two before the end; from one before it, reads give 0.
        for (uint32_t lane = 3; lane < 8; ++lane) {
            EXPECT_EQ(shader.output(0, lane), 0u) << lane;
            EXPECT_EQ(shader.output(1, lane), 0u) << lane;
        }
        EXPECT_EQ(shader.output(0, 2), 0x3FE00000u + 126);
        EXPECT_EQ(memory.second, expected.second);
        EXPECT_TRUE(std::equal(memory.first.begin(), memory.first.begin() + 62, expected.first.begin()));
    }
}

// Without a resolver there is no memory at all.
TEST(PhysicalStorageBuffers, NoMemory) {
    ShaderRun shader;
    shader.words = laneShader("#extension GL_EXT_buffer_reference : require\n",
                              "layout(buffer_reference) buffer B { int v; }; layout(push_constant) uniform P { B b; };"
                              "layout(location = 0) out int o;",
                              "b.v = 5; o = b.v + atomicAdd(b.v, 3);");
    shader.push = Bytes(8, std::byte{0x77});
    for (const Isa isa : isas()) {
        ASSERT_TRUE(shader.run(isa));
        for (uint32_t lane = 0; lane < 64; ++lane) EXPECT_EQ(shader.output(0, lane), 0u);
    }
}

}  // namespace
}  // namespace vernier::test
