// Tessellation stages: arrays over vertices, what belongs to a patch, outputs that other invocations read.
#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

using Values = InterfaceValues<double>;

std::vector<double> numbers(const Values& values, spv::BuiltIn builtin) {
    std::vector<double> result;
    if (const auto found = values.builtins.find(builtin); found != values.builtins.end())
        for (const auto& scalar : found->second) result.push_back(scalar.number);
    return result;
}

double numberAt(const Values& values, uint32_t location, uint32_t component = 0) {
    const auto found = values.locations.find(Location(location));
    return found == values.locations.end() ? -1 : found->second[component].number;
}

Result<Values> runControl(std::string_view source, const Values& inputs) {
    const auto module = Module::parse(compileControl(source));
    EXPECT_TRUE(module.ok()) << module.error().message;
    if (!module) return module.error();
    Resources<double> none;
    return interpreterOf<double>(*module, spv::ExecutionModelTessellationControl).runPatch(inputs, none);
}

/// Vertex n: location 0 = (n, 10n, 0, 0), Position = (n, 0, 0, 1).
Values patchOf(uint32_t vertices) {
    Values inputs;
    inputs.setInt(spv::BuiltInPrimitiveId, 7);
    inputs.setInt(spv::BuiltInPatchVertices, static_cast<int32_t>(vertices));
    for (uint32_t n = 0; n < vertices; ++n) {
        Values& vertex = inputs.vertices.emplace_back();
        vertex.setFloat(Location(0), {double(n), 10.0 * n, 0, 0});
        vertex.setFloat(spv::BuiltInPosition, {double(n), 0, 0, 1});
    }
    return inputs;
}

TEST(Patch, InvocationsReadEachOthersOutputs) {
    const auto values = runControl(R"(#version 450
layout(vertices = 3) out;
layout(location = 0) in vec4 a[];
layout(location = 0) out vec4 b[];
layout(location = 2) patch out vec3 sum;
layout(location = 3) out float neighbour[];
void main() {
    b[gl_InvocationID] = a[gl_InvocationID + 1] * 2.0;
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position + vec4(gl_PrimitiveID, gl_PatchVerticesIn, 0, 0);
    barrier();
    neighbour[gl_InvocationID] = b[(gl_InvocationID + 1) % 3].x;
    if (gl_InvocationID == 1) {
        sum = b[0].xyz + b[1].xyz + b[2].xyz;
        gl_TessLevelOuter = float[4](1.0, 2.0, 3.0, 4.0);
        gl_TessLevelInner[1] = 6.0;
    }
}
)",
                                   patchOf(4));
    ASSERT_TRUE(values.ok()) << values.error().message;
    ASSERT_EQ(values->vertices.size(), 3u);
    for (uint32_t n = 0; n < 3; ++n) {
        EXPECT_EQ(numberAt(values->vertices[n], 0), 2.0 * (n + 1));
        EXPECT_EQ(numberAt(values->vertices[n], 0, 1), 20.0 * (n + 1));
        EXPECT_EQ(numberAt(values->vertices[n], 3), 2.0 * ((n + 1) % 3 + 1));
        EXPECT_EQ(numbers(values->vertices[n], spv::BuiltInPosition), (std::vector<double>{n + 7.0, 4, 0, 1}));
    }
    EXPECT_EQ(numberAt(*values, 2), 12);
    EXPECT_EQ(numberAt(*values, 2, 1), 120);
    EXPECT_EQ(numbers(*values, spv::BuiltInTessLevelOuter), (std::vector<double>{1, 2, 3, 4}));
    ASSERT_EQ(numbers(*values, spv::BuiltInTessLevelInner).size(), 2u);
    EXPECT_EQ(numbers(*values, spv::BuiltInTessLevelInner)[1], 6);
}

TEST(Patch, BlocksOfVerticesAndOfThePatch) {
    const auto values = runControl(R"(#version 450
layout(vertices = 2) out;
layout(location = 1) out Each { vec2 x; float y[2]; } each[];
layout(location = 5) patch out Whole { mat2 m; float last; } whole;
void main() {
    each[gl_InvocationID].x = vec2(gl_InvocationID, 5);
    each[gl_InvocationID].y[1] = 8.0 + gl_InvocationID;
    if (gl_InvocationID == 0) { whole.m = mat2(1, 2, 3, 4); whole.last = 9; }
}
)",
                                   patchOf(2));
    ASSERT_TRUE(values.ok()) << values.error().message;
    ASSERT_EQ(values->vertices.size(), 2u);
    for (uint32_t n = 0; n < 2; ++n) {
        EXPECT_EQ(numberAt(values->vertices[n], 1), n);
        EXPECT_EQ(numberAt(values->vertices[n], 1, 1), 5);
        EXPECT_EQ(numberAt(values->vertices[n], 3), 8.0 + n);
        EXPECT_EQ(values->vertices[n].locations.count(Location(2)), 0u);
    }
    EXPECT_EQ(numberAt(*values, 6, 1), 4);
    EXPECT_EQ(numberAt(*values, 7), 9);
}

TEST(Patch, EvaluationReadsVerticesPatchAndCoordinates) {
    const auto module = Module::parse(compileEvaluation(R"(#version 450
layout(triangles, fractional_odd_spacing, cw) in;
layout(location = 0) in vec4 a[];
layout(location = 2) patch in float whole;
layout(location = 1) out vec4 r;
void main() {
    gl_Position = gl_in[0].gl_Position * gl_TessCoord.x + gl_in[1].gl_Position * gl_TessCoord.y +
                  gl_in[2].gl_Position * gl_TessCoord.z;
    r = vec4(a[gl_PrimitiveID - 6].y, whole, gl_TessLevelOuter[2] + gl_TessLevelInner[1], gl_PatchVerticesIn);
}
)"));
    ASSERT_TRUE(module.ok()) << module.error().message;
    Values inputs = patchOf(3);
    inputs.setFloat(Location(2), {42});
    inputs.setFloat(spv::BuiltInTessCoord, {0.25, 0.5, 0.25});
    inputs.setFloat(spv::BuiltInTessLevelOuter, {1, 2, 3, 4});
    inputs.setFloat(spv::BuiltInTessLevelInner, {0.5, 0.75});
    Resources<double> none;
    const auto outcome = interpreterOf<double>(*module, spv::ExecutionModelTessellationEvaluation).run(inputs, none);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(numbers(outcome->outputs, spv::BuiltInPosition), (std::vector<double>{1, 0, 0, 1}));
    EXPECT_EQ(floatsAt(*outcome, 1), (std::array<double, 4>{10, 42, 3.75, 3}));
}

TEST(Patch, NumbersOfVertices) {
    const auto module = Module::parse(compileControl("#version 450\nlayout(vertices = 5) out;\nvoid main() {}\n"));
    ASSERT_TRUE(module.ok());
    EXPECT_EQ(module->entryPoints()[0].modes.outputVertices, 5u);
    const auto tooMany = runControl("#version 450\nlayout(vertices = 32) out;\nvoid main() {}\n", {});
    EXPECT_TRUE(tooMany.ok());
}

TEST(Patch, BarriersThatNotAllReach) {
    const auto module = Module::parse(assemble(R"(
OpCapability Tessellation
OpMemoryModel Logical GLSL450
OpEntryPoint TessellationControl %main "main" %id
OpExecutionMode %main OutputVertices 2
OpDecorate %id BuiltIn InvocationId
%void = OpTypeVoid
%fn = OpTypeFunction %void
%int = OpTypeInt 32 1
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%ptr = OpTypePointer Input %int
%id = OpVariable %ptr Input
%zero = OpConstant %int 0
%two = OpConstant %uint 2
%four = OpConstant %uint 4
%none = OpConstant %uint 0
%main = OpFunction %void None %fn
%entry = OpLabel
%n = OpLoad %int %id
%first = OpIEqual %bool %n %zero
OpSelectionMerge %end None
OpBranchConditional %first %then %else
%then = OpLabel
OpControlBarrier %two %four %none
OpBranch %end
%else = OpLabel
OpControlBarrier %two %four %none
OpBranch %end
%end = OpLabel
OpReturn
OpFunctionEnd
)"));
    ASSERT_TRUE(module.ok()) << module.error().message;
    Resources<float> none;
    const auto result = interpreterOf<float>(*module, spv::ExecutionModelTessellationControl).runPatch({}, none);
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find("not uniform"), std::string::npos);
}

}  // namespace
}  // namespace vernier::reference::test
