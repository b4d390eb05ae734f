// Quads: derivatives, divergence, helpers, fragment built-ins, interpolation elsewhere.
#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

using Floats = std::array<double, 4>;

template <class Number>
using Outcomes = std::array<Outcome<Number>, 4>;

/// v.x = 1, 3, 10, 20 in the four fragments; i.x = 0, 1, 2, 3.
std::array<InterfaceValues<double>, 4> quadInputs() {
    std::array<InterfaceValues<double>, 4> inputs;
    const double values[] = {1, 3, 10, 20};
    for (int k = 0; k < 4; ++k) {
        inputs[k].setFloat(Location(0), {values[k], -values[k], 0, 1});
        inputs[k].setInt(Location(1), {k, 0, 0, 0});
    }
    return inputs;
}

Outcomes<double> runQuad(std::string_view declarations, std::string_view body, Resources<double>& resources,
                         const Options& options = {}, std::array<bool, 4> helper = {}, int vulkanMinor = 1) {
    const auto module = Module::parse(compileFragment(fragmentSource(declarations, body), vulkanMinor));
    EXPECT_TRUE(module.ok()) << module.error().message;
    if (!module) return {};
    const auto outcome =
        interpreterOf<double>(*module, spv::ExecutionModelFragment, options).runQuad(quadInputs(), helper, resources);
    EXPECT_TRUE(outcome.ok()) << outcome.error().message;
    return outcome ? *outcome : Outcomes<double>{};
}

/// r.x of the four fragments.
Floats runDerivative(std::string_view body, const Options& options = {}) {
    Resources<double> none;
    const auto outcomes = runQuad("", body, none, options);
    return {floatsAt(outcomes[0])[0], floatsAt(outcomes[1])[0], floatsAt(outcomes[2])[0], floatsAt(outcomes[3])[0]};
}

TEST(Quad, AllNineDerivatives) {
    EXPECT_EQ(runDerivative("r = dFdxFine(v);"), (Floats{2, 2, 10, 10}));
    EXPECT_EQ(runDerivative("r = dFdyFine(v);"), (Floats{9, 17, 9, 17}));
    EXPECT_EQ(runDerivative("r = fwidthFine(-v);"), (Floats{11, 19, 19, 27}));
    EXPECT_EQ(runDerivative("r = dFdxCoarse(v);"), (Floats{2, 2, 2, 2}));
    EXPECT_EQ(runDerivative("r = dFdyCoarse(v);"), (Floats{9, 9, 9, 9}));
    EXPECT_EQ(runDerivative("r = fwidthCoarse(v);"), (Floats{11, 11, 11, 11}));
    EXPECT_EQ(runDerivative("r = dFdx(v);"), (Floats{2, 2, 10, 10}));
    EXPECT_EQ(runDerivative("r = dFdy(v);"), (Floats{9, 17, 9, 17}));
    EXPECT_EQ(runDerivative("r = fwidth(v);"), (Floats{11, 19, 19, 27}));
    const Options coarse{.coarseDerivatives = true};
    EXPECT_EQ(runDerivative("r = dFdx(v);", coarse), (Floats{2, 2, 2, 2}));
    EXPECT_EQ(runDerivative("r = dFdy(v);", coarse), (Floats{9, 9, 9, 9}));
    EXPECT_EQ(runDerivative("r = dFdxFine(v);", coarse), (Floats{2, 2, 10, 10}));
}

TEST(Quad, VectorsOfDerivatives) {
    Resources<double> none;
    EXPECT_EQ(floatsAt(runQuad("", "r = vec4(dFdx(v.xy), dFdy(v.yx));", none)[3]), (Floats{10, -10, -17, 17}));
}

TEST(Quad, DivergentDerivativeUsesThosePresent) {
    // Fragment 3 goes elsewhere: its row and column have no partner.
    EXPECT_EQ(runDerivative("r = vec4(-1); if (i.x < 3) r = dFdxFine(v);"), (Floats{2, 2, 0, -1}));
    EXPECT_EQ(runDerivative("r = vec4(-1); if (i.x < 3) r = dFdyCoarse(v);"), (Floats{9, 9, 9, -1}));
    // Both sides of a branch, and together again behind it.
    EXPECT_EQ(runDerivative("float a; if (i.x < 2) a = dFdx(v.x); else a = dFdx(v.x * 2.0); r = vec4(a + dFdy(v.x));"),
              (Floats{2 + 9, 2 + 17, 20 + 9, 20 + 17}));
}

TEST(Quad, DerivativeInUniformLoopAndFunction) {
    EXPECT_EQ(runDerivative("float s = 0.0; for (int k = 1; k < 4; ++k) s += dFdx(v.x * float(k)); r = vec4(s);"),
              (Floats{12, 12, 60, 60}));
    Resources<double> none;
    const auto outcomes = runQuad("float f(float x) { return dFdx(x); }", "r = vec4(f(v.x) + f(v.y * 3.0));", none);
    EXPECT_EQ(floatsAt(outcomes[2])[0], 10 - 30);
}

TEST(Quad, DiscardedInvocationsLeaveDerivatives) {
    Resources<double> none;
    const auto outcomes = runQuad("", "if (i.x == 0) discard; r = vec4(dFdx(v.x));", none);
    EXPECT_TRUE(outcomes[0].discarded);
    EXPECT_FALSE(outcomes[1].discarded);
    EXPECT_EQ(floatsAt(outcomes[1])[0], 0);
    EXPECT_EQ(floatsAt(outcomes[3])[0], 10);
}

TEST(Quad, DemotedInvocationsStayInDerivatives) {
    TestBuffers<double> buffers;
    buffers.buffers[{0, 0, 0}] = bytesOf(std::vector<int32_t>(4));
    const auto outcomes = runQuad(
        "#extension GL_EXT_demote_to_helper_invocation : require\n"
        "layout(std430, set = 0, binding = 0) buffer B { int n[4]; } b;",
        "if (i.x == 0) demote; r = vec4(dFdx(v.x)); b.n[i.x] = 1; atomicAdd(b.n[3], 5);", buffers, {}, {}, 2);
    EXPECT_TRUE(outcomes[0].discarded);
    EXPECT_EQ(floatsAt(outcomes[1])[0], 2);
    // Fragments 1, 2 and 3 run to the end one after the other: 3 stores 1 over the first two sums.
    EXPECT_EQ(valuesOf<int32_t>(buffers.buffers[{0, 0, 0}]), (std::vector<int32_t>{0, 1, 1, 6}));
}

TEST(Quad, HelpersHaveNoEffects) {
    TestBuffers<double> buffers;
    buffers.buffers[{0, 0, 0}] = bytesOf(std::vector<int32_t>(5));
    const auto outcomes = runQuad("layout(std430, set = 0, binding = 0) buffer B { int n[5]; } b;",
                                  "b.n[i.x] = 1; atomicAdd(b.n[4], 1); ri = ivec4(gl_HelperInvocation);", buffers, {},
                                  {false, true, false, true});
    EXPECT_EQ(valuesOf<int32_t>(buffers.buffers[{0, 0, 0}]), (std::vector<int32_t>{1, 0, 1, 0, 2}));
    EXPECT_EQ(intsAt(outcomes[0])[0], 0);
    EXPECT_EQ(intsAt(outcomes[1])[0], 1);
}

TEST(Quad, FragmentBuiltIns) {
    const Words words = compileFragment(R"(#version 450
        layout(location = 0) out vec4 r; layout(location = 1) out ivec4 ri;
        void main() {
            r = gl_FragCoord + vec4(gl_PointCoord, gl_SamplePosition);
            ri = ivec4(gl_FrontFacing, gl_SampleID, gl_SampleMaskIn[0], gl_PrimitiveID);
            gl_FragDepth = 0.25; gl_SampleMask[0] = 6;
        })");
    const auto module = Module::parse(words);
    ASSERT_TRUE(module.ok()) << module.error().message;
    EXPECT_TRUE(module->entryPoints()[0].modes.depthReplacing);
    InterfaceValues<Real> inputs;
    inputs.setFloat(spv::BuiltInFragCoord, {Real(1.5), Real(2.5), Real(0.5), Real(1)});
    inputs.setFloat(spv::BuiltInPointCoord, {Real(0.25), Real(0.5)});
    inputs.setFloat(spv::BuiltInSamplePosition, {Real(0.125), Real(0.75)});
    inputs.setInt(spv::BuiltInFrontFacing, 1);
    inputs.setInt(spv::BuiltInSampleId, 3);
    inputs.setInt(spv::BuiltInSampleMask, 9);
    inputs.setInt(spv::BuiltInPrimitiveId, 44);
    Resources<Real> none;
    const auto outcome = interpreterOf<Real>(*module, spv::ExecutionModelFragment).run(inputs, none);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(floatsAt(*outcome), (Floats{1.75, 3, 0.625, 1.75}));
    EXPECT_EQ(intsAt(*outcome), (std::array<int32_t, 4>{1, 3, 9, 44}));
    EXPECT_EQ(static_cast<double>(outcome->outputs.builtins.at(spv::BuiltInFragDepth)[0].number), 0.25);
    EXPECT_EQ(outcome->outputs.builtins.at(spv::BuiltInSampleMask)[0].bits, 6u);
}

/// Answers with what was asked.
class Interpolator : public Resources<double> {
  public:
    std::optional<Texel<double>> interpolateAt(const InterpolationRequest<double>& request) override {
        const auto number = [](double x) { return Scalar<double>::ofNumber(x); };
        return Texel<double>{number(static_cast<double>(request.place) * 100 + request.location),
                             number(request.sample), number(request.offset[0]), number(request.offset[1])};
    }
};

TEST(Quad, InterpolateAt) {
    Interpolator resources;
    const char* declarations = "layout(location = 4) in vec4 w; layout(location = 5) in mat2 m;";
    EXPECT_EQ(floatsAt(runQuad(declarations, "r = interpolateAtCentroid(w);", resources)[0]), (Floats{4, 0, 0, 0}));
    EXPECT_EQ(floatsAt(runQuad(declarations, "r = interpolateAtSample(w, 2);", resources)[0]), (Floats{104, 2, 0, 0}));
    EXPECT_EQ(floatsAt(runQuad(declarations, "r = interpolateAtOffset(w, vec2(0.25, -0.5));", resources)[0]),
              (Floats{204, 0, 0.25, -0.5}));
    EXPECT_EQ(floatsAt(runQuad(declarations,
                               "r.xy = interpolateAtCentroid(m[1]); r.z = interpolateAtSample(w.y, 3);"
                               "r.w = 1.0;",
                               resources)[0]),
              (Floats{6, 0, 3, 1}));
    Resources<double> plain;
    EXPECT_EQ(floatsAt(runQuad("", "r = interpolateAtCentroid(v);", plain)[1]), (Floats{3, -3, 0, 1}));
}

}  // namespace
}  // namespace vernier::reference::test
