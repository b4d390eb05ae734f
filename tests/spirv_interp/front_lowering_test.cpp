// What small shaders become: the text of whole programs, and modules written in assembly that no GLSL compiler
// produces.
#include "tests/spirv_interp/lowering_fixture.h"

namespace vernier::test {
namespace {

TEST_F(Lowering, CarriesLinesAndDecorations) {
    EXPECT_EQ(
        ir::print(fragment("layout(location=0) in vec2 a;\nlayout(location=0) out float o;\nvoid main() {\n"
                           "  precise float t = a.x * a.y;\n  mediump float m = a.x + 2.0;\n  o = t + m * m;\n}\n",
                           true)),
        R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
output 0 f32 user 0.0
b0:
  %0 f32 = constant 0x40000000
  %1 f32 = input #0 @5
  %2 f32 = input #1 @5
  %3 f32 = fmul %1 %2 !noContraction @5
  %4 f32 = fadd %0 %1 @6
  %5 f32 = fmul %4 %4 !relaxed @7
  %6 f32 = fadd %3 %5 @7
  storeOutput #0 %6
  ret
)");
}

TEST_F(Lowering, LoopsAndCalls) {
    EXPECT_EQ(ir::print(fragment(R"(
layout(location=0) in vec2 a;
layout(location=0) out float o;
layout(binding=0) uniform U { int n; layout(row_major) mat2 m[3]; } u;
float f(float x, inout float y) { if (x > 9.0) return y; y += sin(x); return y * x; }
void main() {
  float s = a.y;
  for (int k = 0; k < u.n; ++k) s = f(u.m[k][1].x, s);
  o = s;
})")),
              R"(program fragment "main"
input 0 f32 user 0.1 smooth center
output 0 f32 user 0.0
resource 0 uniformBuffer 0.0 x1 read
b0:
  %0 i32 = constant 0x5
  %1 f32 = constant 0x41100000
  %2 i32 = constant 0x1
  %3 i32 = constant 0x0
  %4 i32 = constant 0x3ffffff
  %5 i32 = constant 0x14
  %6 f32 = input #0
  %7 i32 = loadBuffer #0 %3 %3
  jump b1
b1 loop b5 <- b0 b4:
  %8 i32 = phi %3 %20
  %9 f32 = phi %6 %19
  %10 b1 = slt.i32 %8 %7
  branch %10 b2 b5
b2 <- b1:
  %11 i32 = umin %8 %4
  %12 i32 = shl %11 %0
  %13 i32 = iadd %12 %5
  %14 f32 = loadBuffer #0 %3 %13
  %15 b1 = folt.f32 %1 %14
  branch %15 b4 b3
b3 <- b2:
  %16 f32 = fsin %14
  %17 f32 = fadd %9 %16
  %18 f32 = fmul %14 %17
  jump b4
b4 <- b3 b2:
  %19 f32 = phi %18 %9
  %20 i32 = iadd %2 %8
  jump b1
b5 <- b1:
  %21 f32 = phi %9
  storeOutput #0 %21
  ret
)");
}

TEST_F(Lowering, ContractsOnlyWhenAsked) {
    const std::string text =
        "layout(location=0) in vec3 a; layout(location=0) out float o; void main() { o = a.x * a.y + a.z; }";
    EXPECT_EQ(linesOf(fragment(text), "  %4"), "  %4 f32 = fadd %2 %3\n");
    EXPECT_EQ(linesOf(fragment(text, false, true), "  %3"), "  %3 f32 = ffma %0 %1 %2\n");
}

TEST_F(Lowering, SmallTablesStayOutOfMemory) {
    const ir::Program program = vertex(
        "vec2 t[3] = vec2[](vec2(0, -1), vec2(1, 1), vec2(-1, 1)); void main() { gl_Position = vec4(t[gl_VertexIndex], "
        "0, 1); }");
    EXPECT_EQ(program.localWords, 0u);
    EXPECT_EQ(linesOf(program, "  storeLocal"), "");
}

// --- assembly
// -----------------------------------------------------------------------------------------------------------

constexpr const char* kAssemblyHead = R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %a %o
OpExecutionMode %main OriginUpperLeft
OpDecorate %a Location 0
OpDecorate %a Flat
OpDecorate %o Location 0
%void = OpTypeVoid
%bool = OpTypeBool
%int = OpTypeInt 32 1
%fn = OpTypeFunction %void
%in = OpTypePointer Input %int
%out = OpTypePointer Output %int
%local = OpTypePointer Function %int
%a = OpVariable %in Input
%o = OpVariable %out Output
%c0 = OpConstant %int 0
%c1 = OpConstant %int 1
%c9 = OpConstant %int 9
%main = OpFunction %void None %fn
%entry = OpLabel
)";

/// The value of output 0 for input 0, of a module's main() in assembly.
int32_t evaluate(const std::string& body, int32_t input) {
    const Words words = assemble(kAssemblyHead + body + "OpFunctionEnd\n");
    const Status valid = checkModule(words);
    EXPECT_TRUE(valid.ok()) << valid.error().message;
    const ir::Program program = load(words, ir::Stage::fragment);
    if (program.blocks.empty()) return 0;
    Machine machine;
    machine.inputs.assign(program.inputs.size(), static_cast<uint32_t>(input));
    EXPECT_TRUE(machine.run(program));
    return machine.outputs.empty() ? 0 : static_cast<int32_t>(machine.outputs[0]);
}

TEST_F(Lowering, PhisThatSwap) {
    const std::string body = R"(
%x = OpLoad %int %a
OpBranch %loop
%loop = OpLabel
%n = OpPhi %int %c0 %entry %n2 %latch
%p = OpPhi %int %c1 %entry %q %latch
%q = OpPhi %int %c9 %entry %p %latch
%go = OpSLessThan %bool %n %x
OpLoopMerge %done %latch None
OpBranchConditional %go %latch %done
%latch = OpLabel
%n2 = OpIAdd %int %n %c1
OpBranch %loop
%done = OpLabel
OpStore %o %p
OpReturn
)";
    EXPECT_EQ(evaluate(body, 0), 1);
    EXPECT_EQ(evaluate(body, 1), 9);
    EXPECT_EQ(evaluate(body, 6), 1);
}

TEST_F(Lowering, ConditionInTheContinueBlock) {
    const std::string body = R"(
%x = OpLoad %int %a
OpBranch %loop
%loop = OpLabel
%n = OpPhi %int %c0 %entry %n2 %loop
%n2 = OpIAdd %int %n %c1
%go = OpSLessThan %bool %n2 %x
OpLoopMerge %done %loop None
OpBranchConditional %go %loop %done
%done = OpLabel
OpStore %o %n2
OpReturn
)";
    EXPECT_EQ(evaluate(body, -4), 1);
    EXPECT_EQ(evaluate(body, 17), 17);
}

TEST_F(Lowering, InfiniteLoopWithoutExit) {
    const Words words = assemble(std::string(kAssemblyHead) + R"(
OpBranch %loop
%loop = OpLabel
OpLoopMerge %done %latch None
OpBranch %latch
%latch = OpLabel
OpBranch %loop
%done = OpLabel
OpUnreachable
OpFunctionEnd
)");
    const ir::Program program = load(words, ir::Stage::fragment);
    Machine machine;
    EXPECT_FALSE(machine.run(program));
}

TEST_F(Lowering, CopyMemoryAndObjects) {
    EXPECT_EQ(evaluate(R"(
%v = OpVariable %local Function %c9
OpCopyMemory %o %v
OpCopyMemory %v %a
%x = OpLoad %int %v
%y = OpCopyObject %int %x
%z = OpLoad %int %o
%w = OpIAdd %int %y %z
OpStore %o %w
OpReturn
)",
                       33),
              42);
}

/// Loads from one buffer before and after a store to another; `decorations` of %from and %to.
std::string aliasing(const std::string& decorations) {
    return R"(
OpCapability Shader
OpExtension "SPV_KHR_storage_buffer_storage_class"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main"
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %words ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %from DescriptorSet 0
OpDecorate %from Binding 0
OpDecorate %to DescriptorSet 0
OpDecorate %to Binding 1
)" + decorations +
           R"(
%void = OpTypeVoid
%fn = OpTypeFunction %void
%uint = OpTypeInt 32 0
%zero = OpConstant %uint 0
%one = OpConstant %uint 1
%words = OpTypeRuntimeArray %uint
%block = OpTypeStruct %words
%pointer = OpTypePointer StorageBuffer %block
%word = OpTypePointer StorageBuffer %uint
%from = OpVariable %pointer StorageBuffer
%to = OpVariable %pointer StorageBuffer
%main = OpFunction %void None %fn
%entry = OpLabel
%source = OpAccessChain %word %from %zero %zero
%target = OpAccessChain %word %to %zero %zero
%next = OpAccessChain %word %to %zero %one
%before = OpLoad %uint %source
%more = OpIAdd %uint %before %one
OpStore %target %more
%after = OpLoad %uint %source
OpStore %next %after
OpReturn
OpFunctionEnd
)";
}

TEST_F(Lowering, StoresReachAliasedBuffers) {
    const auto loads = [](const std::string& decorations) {
        const std::string text = ir::print(load(assemble(aliasing(decorations)), ir::Stage::compute));
        size_t count = 0;
        for (size_t at = text.find("loadBuffer"); at != std::string::npos; at = text.find("loadBuffer", at + 1))
            ++count;
        return count;
    };
    EXPECT_EQ(loads(""), 1u);
    EXPECT_EQ(loads("OpDecorate %from Aliased\n"), 1u);
    EXPECT_EQ(loads("OpDecorate %from Aliased\nOpDecorate %to Aliased\n"), 2u);
}

TEST_F(Lowering, RefusesOtherRoundingModes) {
    const Words words = assemble(R"(
OpCapability Shader
OpCapability RoundingModeRTZ
OpExtension "SPV_KHR_float_controls"
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main"
OpExecutionMode %main OriginUpperLeft
%void = OpTypeVoid
%fn = OpTypeFunction %void
%main = OpFunction %void None %fn
%entry = OpLabel
OpReturn
OpFunctionEnd
)");
    ShaderSource source;
    source.words = words;
    source.stage = ir::Stage::fragment;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().code, ErrorCode::unsupported);
    EXPECT_EQ(program.error().message, "SPIR-V: capability RoundingModeRTZ is not supported");
}

}  // namespace
}  // namespace vernier::test
