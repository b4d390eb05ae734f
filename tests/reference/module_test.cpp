// Reflection and specialisation.
#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

const InterfaceVariable* find(const Module& module, std::string_view name) {
    for (const InterfaceVariable& variable : module.interfaceVariables(0))
        if (variable.name == name) return &variable;
    return nullptr;
}

TEST(Reflection, Interface) {
    const auto module = Module::parse(compileFragment(R"(#version 450
        layout(early_fragment_tests) in; layout(depth_greater) out float gl_FragDepth;
        layout(location = 0) noperspective centroid in vec3 a;
        layout(location = 1, component = 2) flat in uvec2 b;
        layout(location = 2) sample in mat3x2 c[2];
        layout(location = 8) in Block { vec4 d; flat int e[3]; } block;
        layout(location = 0, index = 1) out vec4 o;
        void main() { o = vec4(a, b.x) + gl_FragCoord + block.d * block.e[1]; o.xy += c[1][0]; gl_FragDepth = 0.5; })",
                                                      1, true));
    ASSERT_TRUE(module.ok()) << module.error().message;
    const EntryPoint& entry = module->entryPoints()[0];
    EXPECT_EQ(entry.name, "main");
    EXPECT_EQ(entry.model, spv::ExecutionModelFragment);
    EXPECT_TRUE(entry.modes.originUpperLeft && entry.modes.earlyFragmentTests && entry.modes.depthReplacing &&
                entry.modes.depthGreater);
    EXPECT_FALSE(entry.modes.depthLess);
    const auto *a = find(*module, "a"), *b = find(*module, "b"), *c = find(*module, "c"), *d = find(*module, "d"),
               *e = find(*module, "e"), *o = find(*module, "o"), *fragCoord = find(*module, "gl_FragCoord");
    ASSERT_TRUE(a && b && c && d && e && o && fragCoord);
    EXPECT_TRUE(a->noPerspective && a->centroid && !a->flat && !a->output);
    EXPECT_EQ(a->components, 3u);
    EXPECT_TRUE(b->flat);
    EXPECT_EQ(b->kind, ScalarKind::uint32);
    EXPECT_EQ(b->component, 2u);
    EXPECT_TRUE(c->sample && c->isArray);
    EXPECT_EQ(c->columns, 3u);
    EXPECT_EQ(c->elements, 2u);
    EXPECT_EQ(c->locations, 6u);
    EXPECT_EQ(d->location, 8u);
    EXPECT_EQ(e->location, 9u);
    EXPECT_EQ(e->elements, 3u);
    EXPECT_TRUE(e->flat);
    EXPECT_TRUE(o->output);
    EXPECT_EQ(o->index, 1u);
    EXPECT_TRUE(fragCoord->isBuiltin);
    EXPECT_EQ(fragCoord->builtin, spv::BuiltInFragCoord);
}

TEST(Reflection, Descriptors) {
    const auto module = Module::parse(compileFragment(fragmentSource(
        R"(
        layout(set = 1, binding = 2) uniform U { vec3 a; float b[3]; } u0[2];
        layout(set = 0, binding = 1) buffer S { int n; vec2 tail[]; } s0;
        layout(set = 0, binding = 3) uniform usampler2DArray t[5];
        layout(set = 0, binding = 4) uniform textureCube cube; layout(set = 0, binding = 5) uniform sampler smp;
        layout(set = 0, binding = 6, r32f) uniform image2D img; layout(set = 0, binding = 7) uniform samplerBuffer tb;
        layout(input_attachment_index = 2, set = 0, binding = 8) uniform subpassInput att;
        layout(push_constant) uniform P { layout(offset = 16) mat2 m; } p;)",
        "r = v * u0[0].b[1] * p.m[0].x * s0.n + texture(samplerCube(cube, smp), v.xyz) + imageLoad(img, i.xy)"
        " + texelFetch(tb, i.x) + subpassLoad(att); ri = ivec4(texture(t[1], v.xyz));")));
    ASSERT_TRUE(module.ok()) << module.error().message;
    EXPECT_EQ(module->pushConstantSize(), 32u);
    std::map<std::pair<uint32_t, uint32_t>, DescriptorBinding> at;
    for (const auto& binding : module->descriptorBindings()) at[{binding.set, binding.binding}] = binding;
    ASSERT_EQ(at.size(), 8u);
    EXPECT_EQ((at[{1, 2}].kind), DescriptorKind::uniformBuffer);
    EXPECT_EQ((at[{1, 2}].count), 2u);
    EXPECT_EQ((at[{1, 2}].byteSize), 16u + 2 * 16 + 4);
    EXPECT_EQ((at[{0, 1}].kind), DescriptorKind::storageBuffer);
    EXPECT_EQ((at[{0, 1}].byteSize), 8u);
    EXPECT_EQ((at[{0, 3}].kind), DescriptorKind::combinedImageSampler);
    EXPECT_TRUE((at[{0, 3}].shape.arrayed && !at[{0, 3}].shape.floating && !at[{0, 3}].shape.signedTexels));
    EXPECT_EQ((at[{0, 4}].kind), DescriptorKind::sampledImage);
    EXPECT_EQ((at[{0, 5}].kind), DescriptorKind::sampler);
    EXPECT_EQ((at[{0, 6}].kind), DescriptorKind::storageImage);
    EXPECT_EQ((at[{0, 7}].kind), DescriptorKind::uniformTexelBuffer);
    EXPECT_EQ((at[{0, 8}].kind), DescriptorKind::inputAttachment);
    EXPECT_EQ((at[{0, 8}].inputAttachmentIndex), 2u);
}

TEST(Specialization, ScalarsExpressionsAndArrayLengths) {
    const Words words = compileFragment(fragmentSource(R"(
        layout(constant_id = 3) const int n = 4; layout(constant_id = 4) const bool flag = false;
        layout(constant_id = 5) const float scale = 1.5; layout(constant_id = 6) const uint mask = 0xF0u;
        const int twice = n * 2 + 1; const ivec2 pair = ivec2(n, twice); const int chosen = flag ? n << 3 : -n;)",
                                                       R"(float a[n]; for (int k = 0; k < a.length(); ++k) a[k] = scale;
        float sum = 0; for (int k = 0; k < n; ++k) sum += a[k];
        r = vec4(sum, scale, flag, 0); ri = ivec4(a.length(), pair.y, chosen, int(mask >> 4 & 3u));)"));
    Resources<double> none;
    auto outcome = runFragment<double>(words, standardInputs<double>(), none);
    EXPECT_EQ(floatsAt(outcome), (std::array<double, 4>{6, 1.5, 0, 0}));
    EXPECT_EQ(intsAt(outcome), (std::array<int32_t, 4>{4, 9, -4, 3}));
    outcome = runFragment<double>(words, standardInputs<double>(), none, {},
                                  {{3, 7}, {4, 1}, {5, std::bit_cast<uint32_t>(0.25f)}, {6, 0x25}, {99, 1}});
    EXPECT_EQ(floatsAt(outcome), (std::array<double, 4>{1.75, 0.25, 1, 0}));
    EXPECT_EQ(intsAt(outcome), (std::array<int32_t, 4>{7, 15, 56, 2}));
}

TEST(Interpreter, RefusesWhatIsNotThere) {
    const auto module = Module::parse(compileFragment(fragmentSource("", "r = v;")));
    ASSERT_TRUE(module.ok());
    EXPECT_FALSE(Interpreter<float>::create(*module, spv::ExecutionModelFragment, "other").ok());
    EXPECT_FALSE(Interpreter<float>::create(*module, spv::ExecutionModelVertex).ok());
    EXPECT_FALSE(Interpreter<float>::create(*module, spv::ExecutionModelGLCompute).ok());
}

}  // namespace
}  // namespace vernier::reference::test
