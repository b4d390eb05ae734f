// What small shaders become: the text of whole programs, interfaces, resources and image operations, and modules
// written in assembly that no GLSL compiler produces.
#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include "spirv_interp/ir/print.h"
#include "spirv_interp/program.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {
namespace {

class Lowering : public testing::Test {
  protected:
    static void SetUpTestSuite() { vnRetainGlslCompiler(); }
    static void TearDownTestSuite() { vnReleaseGlslCompiler(); }
};

ir::Program load(const Words& words, ir::Stage stage, bool contract = false) {
    ShaderSource source;
    source.words = words;
    source.stage = stage;
    source.contract = contract;
    Result<ir::Program> program = loadShader(source);
    EXPECT_TRUE(program.ok()) << (program.ok() ? "" : program.error().message);
    return program.ok() ? *program : ir::Program{};
}

ir::Program fragment(const std::string& text, bool debug = false, bool contract = false) {
    return load(compileGlsl(ir::Stage::fragment, "#version 450\n" + text, debug), ir::Stage::fragment, contract);
}

ir::Program vertex(const std::string& text) {
    return load(compileGlsl(ir::Stage::vertex, "#version 450\n" + text), ir::Stage::vertex);
}

/// The lines of a program's text that begin with `word`.
std::string linesOf(const ir::Program& program, const std::string& word) {
    const std::string text = ir::print(program);
    std::string result;
    for (size_t at = 0; at < text.size();) {
        const size_t end = text.find('\n', at);
        const std::string line = text.substr(at, end - at);
        if (line.starts_with(word)) result += line + "\n";
        at = end + 1;
    }
    return result;
}

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

TEST_F(Lowering, VertexInterface) {
    const ir::Program program = vertex(R"(
layout(location=0) in mat2x3 m; layout(location=2, component=1) in vec2 v; layout(location=4) in dvec3 d;
layout(location=0) out Block { vec2 a; float b[2]; } block; layout(location=9, component=2) flat out ivec2 k;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2]; };
void main() {
  gl_Position = vec4(m[1], v.y); gl_PointSize = float(d.z); gl_ClipDistance[1] = v.x;
  block.a = m[0].xy; block.b[1] = float(gl_VertexIndex + gl_InstanceIndex); k = ivec2(d.xy);
})");
    EXPECT_EQ(linesOf(program, "input"), R"(input 0 f32 user 0.0
input 1 f32 user 0.1
input 2 f32 user 1.0
input 3 f32 user 1.1
input 4 f32 user 1.2
input 5 f32 user 2.1
input 6 f32 user 2.2
input 7 i32 user 4.0
input 8 i32 user 4.1
input 9 i32 user 4.2
input 10 i32 user 4.3
input 11 i32 user 5.0
input 12 i32 user 5.1
input 13 i32 vertexIndex 0.0
input 14 i32 instanceIndex 0.0
)");
    // What is never written is left out: block.b[0] and gl_ClipDistance[0].
    EXPECT_EQ(linesOf(program, "output"), R"(output 0 f32 position 0.0
output 1 f32 position 0.1
output 2 f32 position 0.2
output 3 f32 position 0.3
output 4 f32 pointSize 0.0
output 5 f32 clipDistance 0.1
output 6 f32 user 0.0
output 7 f32 user 0.1
output 8 f32 user 2.0
output 9 i32 user 9.2
output 10 i32 user 9.3
)");
}

TEST_F(Lowering, FragmentInterface) {
    const ir::Program program = fragment(R"(
layout(location=1) centroid noperspective in vec2 w; layout(location=3) sample in float z; layout(location=4) flat in uint f;
layout(location=0, index=1) out float o; layout(depth_any) out float gl_FragDepth;
layout(early_fragment_tests) in;
void main() {
  o = w.y + z + float(f) + gl_FragCoord.w + float(gl_PrimitiveID + gl_SampleID) + gl_PointCoord.y + (gl_FrontFacing ? 1.0 : 0.5) + gl_SamplePosition.x;
  gl_FragDepth = o; gl_SampleMask[0] = gl_SampleMaskIn[0];
})");
    EXPECT_EQ(linesOf(program, "input"), R"(input 0 f32 user 1.1 noPerspective centroid
input 1 f32 user 3.0 smooth sample
input 2 i32 user 4.0 flat center
input 3 f32 fragCoord 0.3 smooth center
input 4 i32 primitiveId 0.0 flat center
input 5 i32 sampleId 0.0 flat center
input 6 f32 pointCoord 0.1 smooth center
input 7 b1 frontFacing 0.0 smooth center
input 8 f32 samplePosition 0.0 smooth center
input 9 i32 sampleMaskIn 0.0 flat center
)");
    EXPECT_EQ(linesOf(program, "output"),
              "output 0 f32 user 0.0.1\noutput 1 f32 fragDepth 0.0\noutput 2 i32 sampleMask 0.0\n");
    EXPECT_TRUE(program.earlyFragmentTests && program.writesDepth && program.writesSampleMask && program.perSample);
    EXPECT_FALSE(program.usesQuads || program.canDiscard || program.hasSideEffects);
}

constexpr const char* kImages = R"(
layout(location=0) in vec3 c; layout(location=1) in flat ivec2 k; layout(location=0) out vec4 o;
layout(set=1,binding=2) uniform sampler2D tex; layout(set=1,binding=3) uniform texture2DArray ta[4];
layout(set=1,binding=4) uniform sampler sm; layout(set=1,binding=5) uniform sampler2DShadow sh;
layout(set=1,binding=6,rgba8) uniform image2D im; layout(set=1,binding=7,r32ui) uniform uimage3D ui;
layout(set=1,binding=8) uniform samplerBuffer tb; layout(set=1,binding=9) uniform sampler2DMS ms;
layout(input_attachment_index=0,set=1,binding=10) uniform subpassInput sp;
layout(set=1,binding=11) uniform samplerCubeArray ca;
void main() { )";

/// The image operations and the instructions that use them.
std::string imagesOf(const std::string& body) {
    const ir::Program program = fragment(kImages + body + "}");
    return linesOf(program, "imageOp") + linesOf(program, "resource");
}

TEST_F(Lowering, ImageOperations) {
    const auto one = [](const std::string& body) {
        const ir::Program program = fragment(kImages + body + "}");
        EXPECT_EQ(program.imageOps.size(), 1u);
        const std::string line = linesOf(program, "imageOp 0 ");
        return line.substr(10, line.size() - 11);
    };
    EXPECT_EQ(one("o = texture(tex, c.xy, 0.5);"), "sampleImplicit d2 image 0 sampler 0 coords 2 bias");
    EXPECT_EQ(one("o = textureLod(tex, c.xy, 2.0);"), "sampleLod d2 image 0 sampler 0 coords 2 lod");
    EXPECT_EQ(one("o = textureGrad(tex, c.xy, c.yz, c.zx);"), "sampleGrad d2 image 0 sampler 0 coords 2 gradients 4");
    EXPECT_EQ(one("o = textureOffset(tex, c.xy, ivec2(1, -2));"),
              "sampleImplicit d2 image 0 sampler 0 coords 2 offsets 2");
    EXPECT_EQ(one("o = textureProj(tex, c);"), "sampleImplicit d2 image 0 sampler 0 coords 2");
    EXPECT_EQ(one("o = vec4(texture(sh, c));"), "sampleImplicit d2 image 0 sampler 0 coords 2 depthCompare");
    EXPECT_EQ(one("o = texture(ca, c.xyzx);"), "sampleImplicit cube image 0 sampler 0 coords 4 arrayed");
    EXPECT_EQ(one("o = textureGather(tex, c.xy, 2);"), "gather d2 image 0 sampler 0 coords 2 component 2");
    EXPECT_EQ(one("o = textureGather(sh, c.xy, 0.5);"), "gather d2 image 0 sampler 0 coords 2 depthCompare");
    EXPECT_EQ(one("o = texelFetch(tex, k, 1);"), "fetch d2 image 0 coords 2 lod");
    EXPECT_EQ(one("o = texelFetch(ms, k, 3);"), "fetch d2 image 0 coords 2 multisampled sample");
    EXPECT_EQ(one("o = texelFetch(tb, k.x);"), "fetch buffer image 0 coords 1");
    EXPECT_EQ(one("o = imageLoad(im, k);"), "read d2 image 0 coords 2");
    EXPECT_EQ(one("o = subpassLoad(sp);"), "read subpass image 0 coords 3 arrayed");
    EXPECT_EQ(one("imageStore(im, k, c.xyzz); o = c.xxxx;"), "store d2 image 0 coords 2");
    EXPECT_EQ(one("o = vec4(imageAtomicCompSwap(ui, k.xyx, 7u, 8u));"), "atomic d3 image 0 coords 3 compareExchange");
    EXPECT_EQ(one("o = vec4(textureSize(tex, 1), 0, 0);"), "querySize d2 image 0 lod");
    EXPECT_EQ(one("o = vec4(textureQueryLevels(tex));"), "queryLevels d2 image 0");
    EXPECT_EQ(one("o = vec4(textureQueryLod(ca, c), 0, 0);"), "queryLod cube image 0 sampler 0 coords 3 arrayed");
}

TEST_F(Lowering, ImageOperandsAndDescriptors) {
    // The image's descriptor, then the sampler's, which is another resource.
    EXPECT_EQ(ir::print(fragment(std::string(kImages) + "o = texture(sampler2DArray(ta[k.x + k.y], sm), c); }")),
              R"(program fragment "main"
input 0 i32 user 1.0 flat center
input 1 i32 user 1.1 flat center
input 2 f32 user 0.0 smooth center
input 3 f32 user 0.1 smooth center
input 4 f32 user 0.2 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
output 2 f32 user 0.2
output 3 f32 user 0.3
resource 0 sampledImage 1.3 x4 read
resource 1 sampler 1.4 x1 read
imageOp 0 sampleImplicit d2 image 0 sampler 1 coords 3 arrayed
facts usesQuads
b0:
  %0 i32 = constant 0x0
  %1 i32 = input #0
  %2 i32 = input #1
  %3 i32 = iadd %1 %2
  %4 f32 = input #2
  %5 f32 = input #3
  %6 f32 = input #4
  %7..%10 f32 = image #0 %3 %0 %4 %5 %6
  storeOutput #0 %7
  storeOutput #1 %8
  storeOutput #2 %9
  storeOutput #3 %10
  ret
)");
    // textureGatherOffsets: four gathers, the last value of each.
    EXPECT_EQ(imagesOf("const ivec2 f[4] = ivec2[4](ivec2(0), ivec2(1), ivec2(2), ivec2(3)); "
                       "o = textureGatherOffsets(tex, c.xy, f, 1);"),
              "imageOp 0 gather d2 image 0 sampler 0 coords 2 offsets 2 component 1\n"
              "imageOp 1 gather d2 image 0 sampler 0 coords 2 offsets 2 component 1\n"
              "imageOp 2 gather d2 image 0 sampler 0 coords 2 offsets 2 component 1\n"
              "imageOp 3 gather d2 image 0 sampler 0 coords 2 offsets 2 component 1\n"
              "resource 0 combinedImageSampler 1.2 x1 read\n");
}

TEST_F(Lowering, Resources) {
    const ir::Program program = fragment(R"(
layout(location=0) out vec4 o; layout(location=0) flat in int k;
layout(push_constant) uniform P { layout(offset=16) mat3 m; float f; } pc;
layout(set=2,binding=1) uniform U { vec4 v; } us[3];
layout(set=2,binding=2) readonly buffer R { vec4 v[]; } r;
layout(set=2,binding=3) buffer W { uint n; } w;
layout(set=2,binding=3) buffer Same { float n; } same;
void main() { o = us[k].v + r.v[k] * pc.f + same.n; w.n = 3u; })");
    EXPECT_EQ(linesOf(program, "resource"), R"(resource 0 uniformBuffer 2.1 x3 read
resource 1 storageBuffer 2.2 x1 read
resource 2 pushConstants 0.0 x1 bytes 68 read
resource 3 storageBuffer 2.3 x1
)");
    EXPECT_TRUE(program.hasSideEffects);
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
