// Instructions of SPIR-V that GLSL compilers write seldom or never: operations on specialisation constants, logical
// copies, choices between composites, integer dot products, hints, arrays of arrays of descriptors; and what messages
// say.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/shader_run.h"

namespace vernier::test {
namespace {

std::string module(const std::string& capabilities, const std::string& annotations, const std::string& globals,
                   const std::string& body, const std::string& interface = "", const std::string& variables = "") {
    return "OpCapability Shader\n" + capabilities +
           "OpMemoryModel Logical GLSL450\nOpEntryPoint Fragment %main \"main\" %lane %o " + interface +
           "\nOpExecutionMode %main OriginUpperLeft\nOpModuleProcessed \"by hand\"\nOpDecorate %lane Location 0\n"
           "OpDecorate %lane Flat\nOpDecorate %o Location 0\n" +
           annotations +
           "%void = OpTypeVoid\n%fn = OpTypeFunction %void\n%bool = OpTypeBool\n%int = OpTypeInt 32 1\n%uint = "
           "OpTypeInt 32 0\n"
           "%v4 = OpTypeVector %int 4\n%pin = OpTypePointer Input %int\n%pout = OpTypePointer Output %v4\n"
           "%lane = OpVariable %pin Input\n%o = OpVariable %pout Output\n%c0 = OpConstant %int 0\n%c1 = OpConstant "
           "%int 1\n"
           "%c2 = OpConstant %int 2\n%c3 = OpConstant %int 3\n" +
           globals + "%main = OpFunction %void None %fn\n%entry = OpLabel\n" + variables + "%n = OpLoad %int %lane\n" +
           body + "OpReturn\nOpFunctionEnd\n";
}

TEST(Module, SpecConstantOps) {
    struct Op {
        const char* text;
        int expected;
    };
    // %a = 13, %b = -5, %t = true, %v = (13, -5, 1, 2)
    const Op ops[] = {{"SNegate %a", -13},
                      {"Not %a", ~13},
                      {"IAdd %a %b", 8},
                      {"ISub %a %b", 18},
                      {"IMul %a %b", -65},
                      {"UDiv %b %a", static_cast<int>(static_cast<uint32_t>(-5) / 13)},
                      {"SDiv %a %b", -2},
                      {"UMod %b %a", static_cast<int>(static_cast<uint32_t>(-5) % 13)},
                      {"SRem %a %b", 3},
                      {"SMod %a %b", -2},
                      {"ShiftRightLogical %b %c3", static_cast<int>(static_cast<uint32_t>(-5) >> 3)},
                      {"ShiftRightArithmetic %b %c1", -3},
                      {"ShiftLeftLogical %a %c2", 52},
                      {"BitwiseOr %a %b", 13 | -5},
                      {"BitwiseXor %a %b", 13 ^ -5},
                      {"BitwiseAnd %a %b", 13 & -5},
                      {"Select %t %a %b", 13},
                      {"CompositeExtract %v 1", -5},
                      {"CompositeExtract %shuffled 2", 13},
                      {"CompositeExtract %inserted 3", 13},
                      {"SConvert %short", -5},
                      {"UConvert %ushort", 65531}};
    const char* conditions[] = {"LogicalOr %t %f",      "LogicalAnd %t %f",        "LogicalNot %f",
                                "LogicalEqual %t %f",   "LogicalNotEqual %t %f",   "IEqual %a %b",
                                "INotEqual %a %b",      "ULessThan %a %b",         "SLessThan %a %b",
                                "UGreaterThan %a %b",   "SGreaterThan %a %b",      "ULessThanEqual %a %b",
                                "SLessThanEqual %a %b", "UGreaterThanEqual %a %b", "SGreaterThanEqual %a %b"};
    const bool holds[] = {true,  false, true, false, true,  false, true, true,
                          false, false, true, true,  false, false, true};
    std::string globals =
        "%i16 = OpTypeInt 16 1\n%u16 = OpTypeInt 16 0\n%a = OpSpecConstant %int 13\n%b = OpSpecConstant %int -5\n%t = "
        "OpSpecConstantTrue %bool\n"
        "%f = OpSpecConstantFalse %bool\n%v = OpSpecConstantComposite %v4 %a %b %c1 %c2\n"
        "%shuffled = OpSpecConstantOp %v4 VectorShuffle %v %v 1 2 4 7\n%inserted = OpSpecConstantOp %v4 "
        "CompositeInsert %a %v 3\n"
        "%short = OpSpecConstantOp %i16 SConvert %b\n%ushort = OpSpecConstantOp %u16 UConvert %b\n"
        "%size = OpSpecConstantOp %int ISub %a %c3\n%array = OpTypeArray %int %size\n%parray = OpTypePointer Function "
        "%array\n"
        "%pint = OpTypePointer Function %int\n";
    std::string body =
        "%at = OpAccessChain %pint %var %c2\nOpStore %at %n\n%back = OpLoad %int "
        "%at\n";
    std::string sum = "%back";
    uint32_t expected = 0;  // wraps around
    int next = 0;
    const auto addTo = [&](const std::string& value, int worth) {
        const std::string id = std::to_string(next++);
        body += "%w" + id + " = OpIMul %int " + value + " %k" + id + "\n%s" + id + " = OpIAdd %int " + sum + " %w" +
                id + "\n";
        globals += "%k" + id + " = OpConstant %int " + std::to_string(next * 7919) + "\n";
        sum = "%s" + id;
        expected += static_cast<uint32_t>(worth) * static_cast<uint32_t>(next * 7919);
    };
    for (size_t k = 0; k < std::size(ops); ++k) {
        globals += "%op" + std::to_string(k) + " = OpSpecConstantOp %int " + ops[k].text + "\n";
        addTo("%op" + std::to_string(k), ops[k].expected);
    }
    for (size_t k = 0; k < std::size(conditions); ++k) {
        globals += "%cond" + std::to_string(k) + " = OpSpecConstantOp %bool " + conditions[k] + "\n%pick" +
                   std::to_string(k) + " = OpSpecConstantOp %int Select %cond" + std::to_string(k) + " %c3 %c2\n";
        addTo("%pick" + std::to_string(k), holds[k] ? 3 : 2);
    }
    body += "%out = OpCompositeConstruct %v4 " + sum + " %op0 %op1 %op2\nOpStore %o %out\n";
    ShaderRun shader;
    shader.words = assemble(module("OpCapability Int16\n", "OpDecorate %a SpecId 1\n", globals, body, "",
                                   "%var = OpVariable %parray Function\n"),
                            5);
    for (const Isa isa : isas()) {
        ASSERT_TRUE(shader.run(isa));
        for (uint32_t lane = 0; lane < 64; ++lane) {
            EXPECT_EQ(shader.output(0, lane), expected + lane);
            EXPECT_EQ(static_cast<int>(shader.output(2, lane)), ~13);
        }
    }
}

// OpCopyLogical between structs that differ in their layout only, OpSelect on a struct, OpExpectKHR and
// OpAssumeTrueKHR.
TEST(Module, CopiesChoicesAndHints) {
    ShaderRun shader;
    shader.words = assemble(
        module("OpCapability ExpectAssumeKHR\nOpExtension \"SPV_KHR_expect_assume\"\n",
               "OpDecorate %block Block\nOpMemberDecorate %block 0 Offset 0\nOpMemberDecorate %laid 0 Offset 0\n"
               "OpMemberDecorate %laid 1 Offset 32\nOpDecorate %laidarray ArrayStride 16\nOpDecorate %buffer "
               "DescriptorSet 0\nOpDecorate %buffer Binding 0\n",
               "%len = OpConstant %uint 2\n%bare = OpTypeArray %int %len\n%laidarray = OpTypeArray %int %len\n"
               "%plain = OpTypeStruct %bare %int\n%laid = OpTypeStruct %laidarray %int\n%block = OpTypeStruct %laid\n"
               "%pblock = OpTypePointer StorageBuffer %block\n%plaid = OpTypePointer StorageBuffer %laid\n"
               "%buffer = OpVariable %pblock StorageBuffer\n%uc0 = OpConstant %uint 0\n",
               "%p = OpAccessChain %plaid %buffer %c0\n%whole = OpLoad %laid %p\n%copy = OpCopyLogical %plain %whole\n"
               "%arr = OpCompositeConstruct %bare %n %c3\n%other = OpCompositeConstruct %plain %arr %c2\n"
               "%bit = OpBitwiseAnd %int %n %c1\n%odd = OpINotEqual %bool %bit %c0\n%likely = OpExpectKHR %bool %odd "
               "%odd\nOpAssumeTrueKHR %odd\n"
               "%chosen = OpSelect %plain %likely %other %copy\n%x = OpCompositeExtract %int %chosen 0 0\n"
               "%y = OpCompositeExtract %int %chosen 0 1\n%z = OpCompositeExtract %int %chosen 1\n"
               "%out = OpCompositeConstruct %v4 %x %y %z %n\nOpStore %o %out\n",
               "%buffer"),
        5);
    shader.buffers[0] = bytesOf(std::vector<int32_t>{50, 0, 0, 0, 60, 0, 0, 0, 70});
    for (const Isa isa : isas()) {
        ASSERT_TRUE(shader.run(isa));
        for (uint32_t lane = 0; lane < 64; ++lane) {
            EXPECT_EQ(shader.output(0, lane), lane % 2 != 0 ? lane : 50);
            EXPECT_EQ(shader.output(1, lane), lane % 2 != 0 ? 3u : 60u);
            EXPECT_EQ(shader.output(2, lane), lane % 2 != 0 ? 2u : 70u);
        }
    }
}

TEST(Module, IntegerDotProducts) {
    ShaderRun shader;
    shader.words = assemble(
        module(
            "OpCapability DotProduct\nOpCapability DotProductInputAll\nOpCapability DotProductInput4x8Bit\n"
            "OpCapability DotProductInput4x8BitPacked\nOpCapability Int8\nOpCapability Int16\nOpExtension "
            "\"SPV_KHR_integer_dot_product\"\n",
            "OpDecorate %array ArrayStride 4\nOpDecorate %block Block\nOpMemberDecorate %block 0 Offset 0\nOpDecorate "
            "%in DescriptorSet 0\n"
            "OpDecorate %in Binding 0\nOpDecorate %res DescriptorSet 0\nOpDecorate %res Binding 1\n",
            "%array = OpTypeRuntimeArray %uint\n%block = OpTypeStruct %array\n%pblock = OpTypePointer StorageBuffer "
            "%block\n"
            "%pu = OpTypePointer StorageBuffer %uint\n%in = OpVariable %pblock StorageBuffer\n%res = OpVariable "
            "%pblock StorageBuffer\n"
            "%i8 = OpTypeInt 8 1\n%u8 = OpTypeInt 8 0\n%i16 = OpTypeInt 16 1\n%b4 = OpTypeVector %i8 4\n%ub4 = "
            "OpTypeVector %u8 4\n"
            "%v2 = OpTypeVector %int 2\n%c64 = OpConstant %int 64\n%c8 = OpConstant %int 8\n%zero = OpConstant %int 0\n"
            "%c4 = OpConstant %int 4\n%c5 = OpConstant %int 5\n%c6 = OpConstant %int 6\n%c7 = OpConstant %int 7\n",
            [] {
                std::string body =
                    "%pa = OpAccessChain %pu %in %c0 %n\n%a = OpLoad %uint %pa\n%nb = OpIAdd %int %n %c64\n%pb = "
                    "OpAccessChain %pu %in %c0 %nb\n"
                    "%b = OpLoad %uint %pb\n%va = OpBitcast %b4 %a\n%vb = OpBitcast %b4 %b\n%ua = OpBitcast %ub4 "
                    "%a\n%ub = OpBitcast %ub4 %b\n"
                    "%ia = OpBitcast %int %a\n%ib = OpBitcast %int %b\n%w2a = OpCompositeConstruct %v2 %ia %ib\n%w2b = "
                    "OpCompositeConstruct %v2 %ib %ia\n"
                    "%r0 = OpSDot %int %a %b PackedVectorFormat4x8Bit\n%r1 = OpUDot %uint %a %b "
                    "PackedVectorFormat4x8Bit\n"
                    "%r2 = OpSUDot %int %va %ub\n%r3 = OpSDot %int %w2a %w2b\n%r4 = OpSDotAccSat %int %va %vb %ia\n"
                    "%r5 = OpUDotAccSat %uint %ua %ub %a\n%r6n = OpSDot %i16 %va %vb\n%r6 = OpSConvert %int %r6n\n"
                    "%r7 = OpSUDotAccSat %int %a %b %ib PackedVectorFormat4x8Bit\n%base = OpIMul %int %n %c8\n";
                for (int k = 0; k < 8; ++k) {
                    const std::string i = std::to_string(k);
                    const bool isUnsigned = k == 1 || k == 5;
                    body += "%at" + i + " = OpIAdd %int %base %c" + i + "\n%pr" + i +
                            " = OpAccessChain %pu %res %c0 %at" + i + "\n";
                    body += (isUnsigned ? "%bits" + i + " = OpCopyObject %uint %r" + i
                                        : "%bits" + i + " = OpBitcast %uint %r" + i) +
                            "\nOpStore %pr" + i + " %bits" + i + "\n";
                }
                return body + "%out = OpCompositeConstruct %v4 %n %n %n %n\nOpStore %o %out\n";
            }(),
            "%in %res"),
        5);
    std::mt19937 random(2);
    std::vector<uint32_t> in(128);
    for (uint32_t& x : in) x = static_cast<uint32_t>(random()) | (random() % 4 == 0 ? 0x7F000000u : 0);
    shader.buffers[0] = bytesOf(in);
    for (const Isa isa : isas()) {
        shader.buffers[1] = Bytes(64 * 32);
        ASSERT_TRUE(shader.run(isa));
        const auto r = valuesOf<uint32_t>(shader.buffers[1]);
        for (size_t lane = 0; lane < 64; ++lane) {
            const uint32_t a = in[lane], b = in[lane + 64];
            int64_t ss = 0, uu = 0, su = 0;
            for (int k = 0; k < 4; ++k) {
                const auto sa = static_cast<int8_t>(a >> 8 * k), sb = static_cast<int8_t>(b >> 8 * k);
                const auto ua = static_cast<uint8_t>(a >> 8 * k), ub = static_cast<uint8_t>(b >> 8 * k);
                ss += sa * sb;
                uu += ua * ub;
                su += sa * ub;
            }
            const auto saturated = [](int64_t x) {
                return static_cast<uint32_t>(std::clamp<int64_t>(x, INT32_MIN, INT32_MAX));
            };
            const uint32_t expected[8] = {static_cast<uint32_t>(ss),
                                          static_cast<uint32_t>(uu),
                                          static_cast<uint32_t>(su),
                                          2 * a * b,
                                          saturated(ss + static_cast<int32_t>(a)),
                                          static_cast<uint32_t>(std::min<int64_t>(uu + a, UINT32_MAX)),
                                          static_cast<uint32_t>(static_cast<int16_t>(ss)),
                                          saturated(su + static_cast<int32_t>(b))};
            for (size_t k = 0; k < 8; ++k)
                EXPECT_EQ(r[lane * 8 + k], expected[k]) << "lane " << lane << " result " << k;
        }
    }
}

TEST(Module, DescriptorsThatVary) {
    ShaderRun shader;
    shader.words = laneShader("#extension GL_EXT_nonuniform_qualifier : require\n",
                              "layout(binding=0) buffer B { int v; int rest[]; } b[6]; layout(location=0) out ivec2 o;",
                              "int i = lane % 2 * 3 + lane % 3; o = ivec2(b[nonuniformEXT(i)].v,"
                              "b[nonuniformEXT(i)].rest.length());");
    for (uint32_t k = 0; k < 6; ++k) {
        shader.buffers[k] = bytesOf(std::vector<int32_t>(3 + k, static_cast<int32_t>(100 * k)));
    }
    for (const Isa isa : isas()) {
        ASSERT_TRUE(shader.run(isa));
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const uint32_t which = lane % 2 * 3 + lane % 3;
            EXPECT_EQ(shader.output(0, lane), 100 * which);
            EXPECT_EQ(shader.output(1, lane), which + 2);
        }
    }
}

// Interpolation of an input chosen at run time, at an offset.
TEST(Module, InterpolationOfIndexedInputs) {
    ShaderRun shader;
    shader.words = laneShader("", "layout(location=1) in vec2 v[3]; layout(location=0) out vec2 o;",
                              "o = interpolateAtOffset(v[lane % 3], vec2(0.25, 0.5));");
    ShaderSource source;
    source.words = shader.words;
    source.stage = ir::Stage::fragment;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_TRUE(program.ok()) << program.error().message;
    std::vector<std::vector<uint32_t>> rows(program->inputs.size(), std::vector<uint32_t>(64));
    for (size_t slot = 0; slot < rows.size(); ++slot) {
        for (uint32_t lane = 0; lane < 64 && program->inputs[slot].location == 0; ++lane) rows[slot][lane] = lane;
    }
    for (const Isa isa : isas()) {
        RunSetup setup;
        setup.isa = isa;
        // A plane whose value tells the slot and the place.
        setup.interpolator.at = [](void*, uint32_t slot, uint32_t where, uint32_t lanes, const float* a, const float* b,
                                   float* result) {
            for (uint32_t lane = 0; lane < lanes; ++lane) {
                result[lane] = static_cast<float>(slot * 100 + where * 10) + a[lane] + b[lane];
            }
        };
        const RunResult result = runBatch(*program, rows, setup);
        for (uint32_t lane = 0; lane < 64; ++lane) {
            for (uint32_t c = 0; c < 2; ++c) {
                uint32_t slot = 0;
                while (program->inputs[slot].location != 1 + lane % 3 || program->inputs[slot].component != c) ++slot;
                EXPECT_EQ(std::bit_cast<float>(result.outputs[c][lane]), static_cast<float>(slot * 100 + 20) + 0.75f);
            }
        }
    }
}

TEST(Messages, NamesInWords) {
    EXPECT_NE(
        loadError(
            assemble(module("OpCapability DenormFlushToZero\nOpExtension \"SPV_KHR_float_controls\"\n", "", "", ""), 5))
            .find("capability DenormFlushToZero is not supported"),
        std::string::npos);
    EXPECT_NE(
        loadError(assemble(module("OpCapability RoundingModeRTZ\n", "", "", ""), 5)).find("capability RoundingModeRTZ"),
        std::string::npos);
    EXPECT_NE(loadError(assemble(module("OpCapability SampledRect\n", "", "", ""), 5)).find("SampledRect"),
              std::string::npos);
    EXPECT_NE(
        loadError(
            assemble(
                module("OpCapability FragmentDensityEXT\nOpExtension \"SPV_EXT_fragment_invocation_density\"\n",
                       "OpDecorate %size BuiltIn FragSizeEXT\nOpDecorate %size Flat\n",
                       "%v2 = OpTypeVector %int 2\n%pv2 = OpTypePointer Input %v2\n%size = OpVariable %pv2 Input\n", "",
                       "%size"),
                5))
            .find("FragmentDensityEXT"),
        std::string::npos);
}

// Lines of OpLine and of NonSemantic.Shader.DebugInfo.100 reach the IR; messages tell them.
TEST(Messages, SourceLines) {
    const auto withLine = [&](const std::string& strings, const std::string& before, const std::string& extra = "") {
        return "OpCapability Shader\n" + extra +
               "OpMemoryModel Logical GLSL450\nOpEntryPoint Fragment %main \"main\" %o\n"
               "OpExecutionMode %main OriginUpperLeft\n" +
               strings +
               "OpDecorate %o Location 0\n%void = OpTypeVoid\n%fn = OpTypeFunction %void\n%int = OpTypeInt 32 0\n%c12 "
               "= OpConstant %int 12\n"
               "%c0 = OpConstant %int 0\n%float = OpTypeFloat 32\n%half = OpConstant %float 0.5\n%pout = OpTypePointer "
               "Output %float\n%o = OpVariable %pout Output\n" +
               before;
    };
    const std::string body =
        "%x = OpLoad %float %o\n%y = OpFAdd %float %x %half\nOpStore %o %y\nOpReturn\nOpFunctionEnd\n";
    const std::string open = "%main = OpFunction %void None %fn\n%entry = OpLabel\n";
    const auto lineOfAdd = [](const Words& words) {
        ShaderSource source;
        source.words = words;
        source.stage = ir::Stage::fragment;
        const Result<ir::Program> program = loadShader(source);
        EXPECT_TRUE(program.ok()) << program.error().message;
        for (const ir::Block& block : program->blocks) {
            for (const ir::Inst& inst : block.insts) {
                if (inst.op == ir::Op::fadd) return program->files[inst.file] + ":" + std::to_string(inst.line);
            }
        }
        return std::string("no addition");
    };
    EXPECT_EQ(
        lineOfAdd(assemble(withLine("%file = OpString \"water.frag\"\n", "") + open + "OpLine %file 31 0\n" + body)),
        "water.frag:31");
    const std::string debug = "%source = OpExtInst %void %set DebugSource %file\n";
    const std::string line = "%l = OpExtInst %void %set DebugLine %source %c12 %c12 %c0 %c0\n";
    EXPECT_EQ(lineOfAdd(assemble(withLine("%file = OpString \"sky.hlsl\"\n", debug,
                                          "OpExtension \"SPV_KHR_non_semantic_info\"\n%set = OpExtInstImport "
                                          "\"NonSemantic.Shader.DebugInfo.100\"\n") +
                                 open + line + body)),
              "sky.hlsl:12");
    // A message tells the place: here of a variable that is too large to be indexed at run time.
    const std::string refused = loadError(assemble(
        withLine(
            "%file = OpString \"water.frag\"\n",
            "%many = OpConstant %int 70000\n%array = OpTypeArray %int %many\n%parray = OpTypePointer Function %array\n"
            "%pint = OpTypePointer Function %int\n") +
        open +
        "OpLine %file 7 3\n%big = OpVariable %parray Function\n%x = OpLoad %float %o\n%i = OpConvertFToU %int %x\n"
        "%at = OpAccessChain %pint %big %i\nOpStore %at %i\nOpReturn\nOpFunctionEnd\n"));
    EXPECT_NE(refused.find(", water.frag:7: variables indexed at run time take more than"), std::string::npos)
        << refused;
}

}  // namespace
}  // namespace vernier::test
