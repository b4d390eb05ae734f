// Tessellation stages in the IR: words of a patch, inputs of its vertices, modes.
#include "spirv_interp/ir/limit_vertices.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/verify.h"
#include "spirv_interp/tessellation.h"
#include "tests/spirv_interp/lowering_fixture.h"

namespace vernier::test {
namespace {

ir::Program control(const std::string& text) {
    return load(compileGlsl(ir::Stage::control, "#version 450\n" + text), ir::Stage::control);
}
ir::Program evaluation(const std::string& text) {
    return load(compileGlsl(ir::Stage::evaluation, "#version 450\n" + text), ir::Stage::evaluation);
}

TessellationModes modesOf(ir::Stage stage, const std::string& text) {
    const Words words = compileGlsl(stage, "#version 450\n" + text);
    ShaderSource source;
    source.words = words;
    source.stage = stage;
    return tessellationModes(source).value();
}

uint32_t count(const ir::Program& program, ir::Op op) {
    uint32_t found = 0;
    for (const ir::Block& block : program.blocks)
        for (const ir::Inst& inst : block.insts) found += inst.op == op ? 1 : 0;
    return found;
}

TEST_F(Lowering, WordsOfAPatch) {
    const ir::Program program = control(R"(
layout(vertices = 3) out;
layout(location = 2) out vec2 a[];
layout(location = 5) patch out float b[2];
void main() {
    a[gl_InvocationID] = vec2(1, gl_PrimitiveID);
    barrier();
    b[1] = a[(gl_InvocationID + 1) % 3].y;
    gl_TessLevelOuter[2] = 4.0;
})");
    // Every word of every output, written or not: their places are their numbers.
    std::vector<std::array<uint32_t, 4>> words;
    uint32_t outer = 0;
    for (const ir::InterfaceSlot& slot : program.outputs) {
        if (slot.builtin == ir::Builtin::user) words.push_back({slot.location, slot.component, slot.index, 0});
        outer += slot.builtin == ir::Builtin::tessLevelOuter ? 1 : 0;
    }
    const std::vector<std::array<uint32_t, 4>> expected{{2, 0, 1, 0}, {2, 1, 1, 0}, {2, 0, 2, 0}, {2, 1, 2, 0},
                                                        {2, 0, 3, 0}, {2, 1, 3, 0}, {5, 0, 0, 0}, {6, 0, 0, 0}};
    EXPECT_EQ(words, expected);
    EXPECT_EQ(outer, 4u);
    EXPECT_EQ(program.localSize, (std::array<uint32_t, 3>{3, 1, 1}));
    ASSERT_EQ(program.resources.size(), 1u);
    EXPECT_EQ(program.resources[0].kind, ir::ResourceKind::stageMemory);
    EXPECT_EQ(program.resources[0].byteSize, program.outputs.size() * 4 * (kPatchLanes / 3));
    // The invocations of a patch run in step.
    EXPECT_EQ(count(program, ir::Op::controlBarrier), 0u);
    EXPECT_EQ(count(program, ir::Op::memoryBarrier), 1u);
    EXPECT_FALSE(program.hasSideEffects);
}

TEST_F(Lowering, VerticesThatAPatchDoesNotHave) {
    const std::string text = R"(
layout(quads) in;
layout(location = 0) in float a[];
layout(location = 1) patch in float b;
void main() { gl_Position = vec4(a[int(gl_TessCoord.x * 3.0)], a[2], a[5], b); })";
    ir::Program program = evaluation(text);
    EXPECT_EQ(program.inputs.size(), 32u + 2u);
    ir::limitVertices(program, 4);
    EXPECT_TRUE(ir::verify(program).ok());
    uint32_t vertices = 0;
    for (const ir::InterfaceSlot& slot : program.inputs) {
        EXPECT_LE(slot.index, 4u);
        vertices += slot.index != 0 ? 1 : 0;
    }
    EXPECT_EQ(vertices, 4u);
    EXPECT_EQ(count(program, ir::Op::inputIndexed), 1u);
}

TEST_F(Lowering, ModesOfBothStages) {
    const TessellationModes a = modesOf(ir::Stage::control, "layout(vertices = 7) out;\nvoid main() {}");
    const TessellationModes b =
        modesOf(ir::Stage::evaluation, "layout(isolines, fractional_even_spacing, cw, point_mode) in;\nvoid main() {}");
    EXPECT_EQ(a, (TessellationModes{.outputVertices = 7}));
    const TessellationModes all = joined(a, b);
    EXPECT_EQ(all, joined(b, a));
    EXPECT_EQ(all, (TessellationModes{TessellationDomain::isolines, TessellationSpacing::fractionalEven,
                                      TessellationOrder::clockwise, true, 7}));
}

TEST_F(Lowering, PatchesThatAreTooLarge) {
    const auto refused = [](const std::string& modes, const std::string& variables) {
        const Words words = assemble(
            "OpCapability Tessellation\nOpMemoryModel Logical GLSL450\n"
            "OpEntryPoint TessellationControl %main \"main\"" +
            std::string(variables.empty() ? "" : " %out") + "\n" + modes +
            "\n%void = OpTypeVoid\n%fn = OpTypeFunction %void\n" + variables +
            "%main = OpFunction %void None %fn\n%entry = OpLabel\nOpReturn\nOpFunctionEnd\n");
        ShaderSource source;
        source.words = words;
        source.stage = ir::Stage::control;
        const Result<ir::Program> program = loadShader(source);
        return program.ok() ? std::string() : program.error().message;
    };
    EXPECT_EQ(refused("OpExecutionMode %main OutputVertices 32", ""), "");
    EXPECT_NE(refused("OpExecutionMode %main OutputVertices 33", "").find("33 output vertices"), std::string::npos);
    EXPECT_NE(refused("OpExecutionMode %main OutputVertices 32\nOpDecorate %out Location 0",
                      "%float = OpTypeFloat 32\n%uint = OpTypeInt 32 0\n%vertices = OpConstant %uint 32\n"
                      "%many = OpConstant %uint 300\n%each = OpTypeArray %float %many\n"
                      "%all = OpTypeArray %each %vertices\n%ptr = OpTypePointer Output %all\n"
                      "%out = OpVariable %ptr Output\n")
                  .find("9600 components"),
              std::string::npos);
}

}  // namespace
}  // namespace vernier::test
