// What the borders of small shaders become: inputs and outputs, resources, image operations.
#include <spirv/unified1/spirv.hpp11>

#include "spirv_interp/capture.h"
#include "spirv_interp/ir/names.h"
#include "tests/spirv_interp/lowering_fixture.h"

namespace vernier::test {
namespace {

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

/// "builtin location.component > buffer:offset" of every captured word, then the strides.
std::string captureOf(const Words& words) {
    ShaderSource source;
    source.words = words;
    CaptureLayout layout;
    const Result<ir::Program> program = loadShader(source, layout);
    if (!program.ok()) return program.error().message;
    std::string text;
    for (const CapturedWord& word : layout.words) {
        text += std::string(ir::nameOf(word.output.builtin)) + " " + std::to_string(word.output.location) + "." +
                std::to_string(word.output.component) + " > " + std::to_string(word.buffer) + ":" +
                std::to_string(word.offset) + "\n";
    }
    for (const uint32_t stride : layout.strides) text += std::to_string(stride) + " ";
    return text;
}

std::string captureOf(const std::string& text) {
    return captureOf(compileGlsl(ir::Stage::vertex, "#version 450\n" + text));
}

TEST_F(Lowering, TransformFeedback) {
    EXPECT_EQ(captureOf("layout(location=0) out vec4 v; void main() { v = vec4(1); }"), "0 0 0 0 ");
    // A member without an offset is not captured; a structure with one is, as a whole, wide scalars at their size.
    EXPECT_EQ(captureOf(R"(
struct Odd { float a; dvec2 b; };
layout(xfb_buffer=1, xfb_stride=16) out gl_PerVertex { layout(xfb_offset=12) float gl_PointSize; vec4 gl_Position; };
layout(location=1, xfb_buffer=0, xfb_offset=8, xfb_stride=48) out Odd odd;
layout(location=4, component=1, xfb_buffer=0, xfb_offset=0) out vec2 v[1];
layout(location=5, xfb_buffer=2, xfb_stride=4) out Block { layout(xfb_offset=0) float k; float no; } blocks[2];
void main() { gl_Position = vec4(0); gl_PointSize = 1; odd = Odd(1, dvec2(2)); v[0] = vec2(3); blocks[0].k = blocks[1].k = 4; }
)"),
              R"(pointSize 0.0 > 1:12
user 1.0 > 0:8
user 2.0 > 0:16
user 2.1 > 0:20
user 2.2 > 0:24
user 2.3 > 0:28
user 4.1 > 0:0
user 4.2 > 0:4
user 5.0 > 2:0
user 7.0 > 3:0
48 16 4 4 )");
}

TEST_F(Lowering, TransformFeedbackRefused) {
    const Words words = compileGlsl(ir::Stage::vertex, R"(#version 450
layout(location=0, xfb_buffer=2, xfb_offset=8, xfb_stride=16) out vec2 v;
void main() { v = vec2(1); })");
    EXPECT_EQ(captureOf(words), "user 0.0 > 2:8\nuser 0.1 > 2:12\n0 0 16 0 ");
    const auto with = [&](spv::Decoration kind, uint32_t value) {
        Words changed = words;
        for (size_t at = 5; at < changed.size(); at += changed[at] >> 16)
            if ((changed[at] & 0xFFFF) == static_cast<uint32_t>(spv::Op::OpDecorate) &&
                changed[at + 2] == static_cast<uint32_t>(kind))
                changed[at + 3] = value;
        return captureOf(changed);
    };
    EXPECT_NE(with(spv::Decoration::XfbBuffer, 4).find("captured into buffer 4; there are 4"), std::string::npos);
    EXPECT_NE(with(spv::Decoration::XfbStride, 12).find("captured with a stride of 12 bytes"), std::string::npos);
    EXPECT_NE(with(spv::Decoration::XfbStride, 18).find("no multiple of 4"), std::string::npos);
    EXPECT_NE(with(spv::Decoration::Offset, 0xFFFFFFFC).find("ends before it"), std::string::npos);
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

TEST_F(Lowering, PrimitiveInputs) {
    const ir::Program program = fragment(R"(
#extension GL_EXT_fragment_shader_barycentric : require
layout(location=2) pervertexEXT in vec2 corners[]; layout(location=3) pervertexEXT in Block { uint k; float f; } blocks[3];
layout(location=0) out vec4 o;
void main() {
  o = vec4(gl_BaryCoordEXT.xz, gl_BaryCoordNoPerspEXT.y, corners[0].y + corners[2].x + float(blocks[1].k) + blocks[2].f);
})");
    // Behind a location the number of the vertex, counted from one.
    EXPECT_EQ(linesOf(program, "input"), R"(input 0 f32 baryCoord 0.0 smooth center
input 1 f32 baryCoord 0.2 smooth center
input 2 f32 baryCoordNoPersp 0.1 noPerspective center
input 3 f32 user 2.1.1 flat center
input 4 f32 user 2.0.3 flat center
input 5 i32 user 3.0.2 flat center
input 6 f32 user 4.0.3 flat center
)");
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

}  // namespace
}  // namespace vernier::test
