// Buffers, their layouts and bounds, variables, descriptor arrays, atomics.
#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

using Floats = std::array<double, 4>;
using Ints = std::array<int32_t, 4>;

/// 0, 1, 2, ... as floats.
std::vector<std::byte> ramp(size_t count) {
    std::vector<float> values;
    for (size_t k = 0; k < count; ++k) values.push_back(static_cast<float>(k));
    return bytesOf(values);
}

Outcome<float> run(std::string_view declarations, std::string_view body, TestBuffers<float>& buffers) {
    return runFragment<float>(compileFragment(fragmentSource(declarations, body)), standardInputs<float>(), buffers);
}

TEST(Memory, ColumnAndRowMajorMatrices) {
    TestBuffers<float> buffers;
    buffers.buffers[{0, 0, 0}] = ramp(64);
    // std140: every column (row) of 16 bytes.
    const char* declarations = R"(layout(std140, set = 0, binding = 0) uniform B {
        mat3x2 c; layout(row_major) mat3x2 w; layout(row_major) mat2 rows[2]; } b;)";
    // c at 0, stride 16: columns (0,1) (4,5) (8,9). w at 48: rows (12,13,14) (16,17,18). rows[k] at 80 + 32
    // k.
    EXPECT_EQ(floatsAt(run(declarations, "r = vec4(b.c[1], b.c[2].y, b.c[i.x - 7].x);", buffers)),
              (Floats{4, 5, 9, 0}));
    EXPECT_EQ(floatsAt(run(declarations, "r = vec4(b.w[1], b.w[2].y, b.w[i.x - 7][1]);", buffers)),
              (Floats{13, 17, 18, 16}));
    EXPECT_EQ(floatsAt(run(declarations, "mat3x2 m = b.w; r = vec4(m[0], m[2]);", buffers)), (Floats{12, 16, 14, 18}));
    EXPECT_EQ(floatsAt(run(declarations, "mat2 m = b.rows[i.x - 6]; r = vec4(m[0], m[1]);", buffers)),
              (Floats{28, 32, 29, 33}));
}

TEST(Memory, NestedStructsArraysAndPushConstants) {
    TestBuffers<float> buffers;
    buffers.buffers[{1, 3, 0}] = ramp(64);
    buffers.pushConstants = ramp(8);
    const char* declarations = R"(struct In { float a; vec3 b; };
        layout(std430, set = 1, binding = 3) readonly buffer B { float first; In items[2]; vec2 tail[]; } b;
        layout(push_constant) uniform P { layout(offset = 8) vec2 p; float q[2]; } p;)";
    // items at 16, 32 bytes each: a at 0, b at 16; tail at 80.
    EXPECT_EQ(floatsAt(run(declarations, "In x = b.items[i.x - 6]; r = vec4(x.a, x.b);", buffers)),
              (Floats{12, 16, 17, 18}));
    EXPECT_EQ(floatsAt(run(declarations, "r = vec4(b.tail[i.x], b.tail[u.x].y, p.q[i.x - 6]);", buffers)),
              (Floats{34, 35, 31, 5}));
    EXPECT_EQ(intsAt(run(declarations, "ri = ivec4(b.tail.length(), int(p.p.x), 0, 0);", buffers)),
              (Ints{(256 - 80) / 8, 2, 0, 0}));
}

TEST(Memory, OutOfBoundsReadsGiveZeroAndWritesAreDropped) {
    TestBuffers<float> buffers;
    buffers.buffers[{0, 0, 0}] = ramp(6);
    const char* declarations =
        "layout(std430, set = 0, binding = 0) buffer B { float x[]; } b;"
        "layout(std430, set = 0, binding = 1) buffer U { vec4 y; } missing;";
    EXPECT_EQ(floatsAt(run(declarations, R"(
        r = vec4(b.x[i.x - 2], b.x[i.x - 1], b.x[i.y], b.x[i.w]) + missing.y.x;
        b.x[5] = 50; b.x[6] = 60; b.x[i.y] = 70; b.x[u.w] = 80; missing.y = v;)",
                           buffers)),
              (Floats{5, 0, 0, 0}));
    EXPECT_EQ(valuesOf<float>(buffers.buffers[{0, 0, 0}]), (std::vector<float>{0, 1, 2, 3, 4, 50}));
    EXPECT_EQ(
        floatsAt(run("", "float a[3] = float[](1, 2, 3); a[i.x] = 9; a[i.y] = 8; r = vec4(a[0], a[1], a[2], a[i.x]);",
                     buffers)),
        (Floats{1, 2, 3, 0}));
}

TEST(Memory, Stores) {
    TestBuffers<float> buffers;
    buffers.buffers[{0, 0, 0}] = ramp(16);
    run("struct S { vec2 a; float b; };"
        "layout(std430, set = 0, binding = 0) buffer B { layout(row_major) mat2 m; S s[2]; float y; } b;",
        "b.m = mat2(10, 20, 30, 40); b.m[1].y = 41; b.s[i.x - 6] = S(v.zw, 7); b.s[0].a.y = 8; b.y = v.x;", buffers);
    EXPECT_EQ(valuesOf<float>(buffers.buffers[{0, 0, 0}]),
              (std::vector<float>{10, 30, 20, 41, 4, 8, 6, 7, 2, 3, 7, 11, 0.5f, 13, 14, 15}));
}

TEST(Memory, DescriptorArrays) {
    TestBuffers<float> buffers;
    for (uint32_t k = 0; k < 3; ++k) buffers.buffers[{0, 2, k}] = bytesOf(std::vector<float>{k * 10.0f, k * 10.0f + 1});
    EXPECT_EQ(floatsAt(run("layout(set = 0, binding = 2) uniform B { float a, b; } b[3];",
                           "r = vec4(b[i.x - 5].b, b[1].a, b[0].b, b[i.x].a);", buffers)),
              (Floats{21, 10, 1, 0}));
}

TEST(Memory, WholeBlockCopiesBetweenLayouts) {
    TestBuffers<float> buffers;
    buffers.buffers[{0, 0, 0}] = ramp(32);
    buffers.buffers[{0, 1, 0}] = std::vector<std::byte>(64);
    // std140 spreads the array over 16 bytes an element, std430 over 4. From 1.2 on OpCopyLogical is used.
    for (const int vulkanMinor : {0, 2}) {
        const Words words = compileFragment(fragmentSource("struct S { float a[3]; vec2 b; };"
                                                           "layout(std140, set = 0, binding = 0) uniform A { S s; } a;"
                                                           "layout(std430, set = 0, binding = 1) buffer B { S s; } b;",
                                                           "S s = a.s; s.b += 0.5; b.s = s;"),
                                            vulkanMinor);
        runFragment<float>(words, standardInputs<float>(), buffers);
        const auto stored = valuesOf<float>(buffers.buffers[{0, 1, 0}]);
        EXPECT_EQ(std::vector<float>(stored.begin(), stored.begin() + 6),
                  (std::vector<float>{0, 4, 8, 0, 12.5f, 13.5f}));
    }
}

TEST(Memory, Atomics) {
    TestBuffers<float> buffers;
    buffers.buffers[{0, 0, 0}] = bytesOf(std::vector<int32_t>{10, 20, -5, 40, 0x0F, 60, 70, 5, 90});
    const auto outcome = run("layout(std430, set = 0, binding = 0) buffer B { int a[7]; uint u[2]; } b;", R"(
        ri.x = atomicAdd(b.a[0], i.x); ri.y = atomicMin(b.a[1], i.y); ri.z = atomicMax(b.a[2], i.x);
        ri.w = atomicExchange(b.a[3], 1); atomicAnd(b.a[4], 6); atomicXor(b.a[4], 1); atomicOr(b.a[4], 8);
        atomicCompSwap(b.a[5], 60, 61); atomicCompSwap(b.a[6], 60, 61);
        atomicMax(b.u[0], u.w); atomicMin(b.u[1], u.x); atomicAdd(b.a[i.z], 1);)",
                             buffers);
    EXPECT_EQ(intsAt(outcome), (Ints{10, 20, -5, 40}));
    EXPECT_EQ(valuesOf<int32_t>(buffers.buffers[{0, 0, 0}]), (std::vector<int32_t>{17, -3, 7, 1, 15, 61, 70, -1, 5}));
}

TEST(Memory, PrivateInitialisersAndDynamicIndices) {
    TestBuffers<float> buffers;
    EXPECT_EQ(floatsAt(run("const float table[4] = float[](1, 2, 4, 8); vec2 g[2] = vec2[](vec2(5, 6), vec2(7, 8));"
                           "struct S { mat2 m[2]; float f; };",
                           R"(S s; s.m[0] = mat2(1); s.m[1] = mat2(g[0], g[1]); s.f = 3; S t = s; t.m[i.x - 6][1].x = 9;
        g[i.x - 7].y += 0.5; r = vec4(table[i.x - 4], t.m[1][1].x, s.m[i.x - 6][1].x, g[0].y);)",
                           buffers)),
              (Floats{8, 9, 7, 6.5}));
}

TEST(Memory, BlocksBetweenStagesAndVertexBuiltIns) {
    const Words words = compileVertex(R"(#version 450
        #extension GL_ARB_shader_draw_parameters : require
        layout(location = 0) in vec3 position; layout(location = 1) in ivec2 pair; layout(location = 2) in mat2 m;
        layout(location = 5, component = 1) in vec2 packed;
        out gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2]; };
        layout(location = 1) out Varyings { vec2 a; flat int b; mat2 c; float d[2]; } o;
        void main() {
            gl_Position = vec4(position, 1); gl_ClipDistance[1] = position.x;
            o.a = packed; o.c = m; o.d[1] = 9;
            o.b = gl_VertexIndex * 1000 + gl_InstanceIndex * 100 + gl_BaseVertexARB * 10 + gl_DrawIDARB + pair.y;
        })");
    const auto module = Module::parse(words);
    ASSERT_TRUE(module.ok()) << module.error().message;
    InterfaceValues<double> inputs;
    inputs.setFloat(Location(0), {1, 2, 3});
    inputs.setInt(Location(1), {5, -6});
    inputs.setFloat(Location(2), {1, 2});
    inputs.setFloat(Location(3), {3, 4});
    inputs.setFloat(Location(5), {0, 7, 8});
    inputs.setInt(spv::BuiltInVertexIndex, 4);
    inputs.setInt(spv::BuiltInInstanceIndex, 3);
    inputs.setInt(spv::BuiltInBaseVertex, 2);
    inputs.setInt(spv::BuiltInDrawIndex, 1);
    Resources<double> none;
    const auto outcome = interpreterOf<double>(*module, spv::ExecutionModelVertex).run(inputs, none);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    const auto& builtins = outcome->outputs.builtins;
    ASSERT_TRUE(builtins.contains(spv::BuiltInPosition));
    EXPECT_EQ(builtins.at(spv::BuiltInPosition)[2].number, 3);
    EXPECT_FALSE(builtins.contains(spv::BuiltInPointSize)) << "never written";
    EXPECT_EQ(builtins.at(spv::BuiltInClipDistance).size(), 2u);
    EXPECT_EQ(builtins.at(spv::BuiltInClipDistance)[1].number, 1);
    EXPECT_EQ(floatsAt(*outcome, 1), (Floats{7, 8, 0, 0}));
    EXPECT_EQ(intsAt(*outcome, 2)[0], 4321 - 6);
    EXPECT_EQ(floatsAt(*outcome, 3), (Floats{1, 2, 0, 0}));
    EXPECT_EQ(floatsAt(*outcome, 4), (Floats{3, 4, 0, 0}));
    EXPECT_FALSE(outcome->outputs.locations.contains(Location(5)));
    EXPECT_EQ(floatsAt(*outcome, 6), (Floats{9, 0, 0, 0}));
}

}  // namespace
}  // namespace vernier::reference::test
