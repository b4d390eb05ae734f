// What loadShader refuses, and in which words.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"
#include "spirv_interp/program.h"
#include "tests/spirv_interp/front_snippets.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {
namespace {

std::string errorOf(const Words& words, ir::Stage stage = ir::Stage::fragment,
                    const Specialization& specialization = {}) {
    ShaderSource source;
    source.words = words;
    source.stage = stage;
    source.specialization = specialization;
    const Result<ir::Program> program = loadShader(source);
    return program.ok() ? "" : program.error().message;
}

std::string errorOfGlsl(std::string_view body, std::string_view globals = "", ir::Stage stage = ir::Stage::fragment) {
    const std::string text =
        "#version 450\n" + std::string(globals) + "\nvoid main() {\n" + std::string(body) + "\n}\n";
    return errorOf(compileGlsl(stage, text, true), stage);
}

TEST(Refusal, NamesInstructionIdAndLine) {
    EXPECT_EQ(errorOfGlsl("o = gl_FragSizeEXT.x;",
                          "#extension GL_EXT_fragment_invocation_density : enable\nlayout(location=0) out int o;"),
              "SPIR-V: capability FragmentDensityEXT is not supported");
    const std::string gather =
        errorOfGlsl("o = texture(t, vec2(0));",
                    "layout(set=0,binding=0) uniform sampler2D t; layout(location=0) out vec4 o;", ir::Stage::vertex);
    EXPECT_EQ(gather, "");  // the compiler writes an explicit lod of 0 outside fragment shaders
    EXPECT_NE(errorOfGlsl("o = sparseTextureARB(t, vec2(0), v);",
                          "#extension GL_ARB_sparse_texture2 : enable\nlayout(set=0,binding=0) uniform sampler2D t; "
                          "layout(location=0) out int o; vec4 v;")
                  .find("SparseResidency is not supported"),
              std::string::npos);
}

// Images of 64-bit texels, and with them their atomics.
TEST(Refusal, WideImages) {
    EXPECT_EQ(errorOfGlsl("imageAtomicAdd(i, ivec2(0), 1ul);",
                          "#extension GL_EXT_shader_image_int64 : require\n#extension GL_ARB_gpu_shader_int64 : "
                          "require\nlayout(set=0,binding=0,r64ui) uniform u64image2D i;"),
              "SPIR-V: capability Int64ImageEXT is not supported");
}

// Vulkan has bit operations on 32-bit integers only (VUID-StandaloneSpirv-Base-04781).
TEST(Refusal, BitOperationsOfOtherWidths) {
    struct Width {
        const char *capability, *type;
    };
    const std::string operations[] = {"OpBitCount %t %x", "OpBitReverse %t %x", "OpBitFieldUExtract %t %x %one %one",
                                      "OpBitFieldSExtract %t %x %one %one", "OpBitFieldInsert %t %x %x %one %one"};
    for (const Width& width : {Width{"Shader", "OpTypeInt 32 0"}, Width{"Int8", "OpTypeInt 8 0"},
                               Width{"Int16", "OpTypeInt 16 0"}, Width{"Int64", "OpTypeInt 64 0"}}) {
        for (const std::string& operation : operations) {
            const bool plain = std::string_view(width.capability) == "Shader";
            const Words words = assemble("OpCapability Shader\nOpCapability " + std::string(width.capability) + R"(
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main"
OpExecutionMode %main OriginUpperLeft
%void = OpTypeVoid
%fn = OpTypeFunction %void
%int = OpTypeInt 32 1
%one = OpConstant %int 1
%t = )" + width.type + R"(
%x = OpConstant %t 77
%main = OpFunction %void None %fn
%entry = OpLabel
%r = )" + operation + "\nOpReturn\nOpFunctionEnd\n");
            const std::string error = errorOf(words);
            EXPECT_EQ(error.find("Expected 32-bit int type for Base operand") != std::string::npos, !plain)
                << operation << " " << width.type << ": " << error;
        }
    }
}

TEST(Refusal, EntryPoint) {
    const Words words = compileGlsl(ir::Stage::vertex, "#version 450\nvoid main() {}\n");
    EXPECT_EQ(errorOf(words), "SPIR-V: the module has no fragment entry point named 'main'");
    EXPECT_EQ(errorOf(words, ir::Stage::compute), "SPIR-V: the module has no compute entry point named 'main'");
    ShaderSource source;
    source.words = words;
    source.entryPoint = "other";
    EXPECT_EQ(loadShader(source).error().message, "SPIR-V: the module has no vertex entry point named 'other'");
}

TEST(Refusal, BrokenModules) {
    EXPECT_EQ(errorOf({}), "SPIR-V: the module is shorter than its header");
    EXPECT_FALSE(checkModule({}).ok());
    EXPECT_NE(errorOf({1, 2, 3, 4, 5, 6}).find("not valid"), std::string::npos);
    Words words = compileGlsl(ir::Stage::vertex, "#version 450\nvoid main() { gl_Position = vec4(1); }\n");
    EXPECT_TRUE(checkModule(words).ok());
    words.pop_back();
    EXPECT_FALSE(checkModule(words).ok());
}

TEST(Refusal, Specialisation) {
    const Words words = compileGlsl(
        ir::Stage::fragment,
        "#version 450\nlayout(constant_id=7) const int k = 2; layout(location=0) out int o; void main() { o = k; }");
    const uint32_t value[2] = {5, 6};
    const auto data = std::as_bytes(std::span(value));
    Specialization::Entry entry{7, 4, 4};
    Specialization specialization{{&entry, 1}, data};
    EXPECT_EQ(errorOf(words, ir::Stage::fragment, specialization), "");
    ShaderSource source{words, "main", ir::Stage::fragment, specialization};
    EXPECT_NE(ir::print(*loadShader(source)).find("constant 0x6"), std::string::npos);
    entry.offset = 5;
    EXPECT_EQ(
        errorOf(words, ir::Stage::fragment, specialization),
        "specialisation constant 7: offset 5 and size 4 do not give the 4 bytes of the constant in 8 bytes of data");
    entry = {7, 0, 2};
    EXPECT_EQ(
        errorOf(words, ir::Stage::fragment, specialization),
        "specialisation constant 7: offset 0 and size 2 do not give the 4 bytes of the constant in 8 bytes of data");
    entry = {8, 100, 100};  // of another shader: not looked at
    EXPECT_EQ(errorOf(words, ir::Stage::fragment, specialization), "");
}

// Everything that recurses or grows with the module has a bound.
TEST(Refusal, ExtravagantModules) {
    const std::string head =
        "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint Fragment %main \"main\" %o\n"
        "OpExecutionMode %main OriginUpperLeft\nOpDecorate %o Location 0\n%void = OpTypeVoid\n%fn = OpTypeFunction "
        "%void\n"
        "%int = OpTypeInt 32 0\n%c1 = OpConstant %int 1\n%c2 = OpConstant %int 2\n%out = OpTypePointer Output %int\n"
        "%o = OpVariable %out Output\n";
    const std::string tail = "%main = OpFunction %void None %fn\n%entry = OpLabel\nOpReturn\nOpFunctionEnd\n";
    std::string nested;
    for (int i = 0; i < 3000; ++i) {
        nested +=
            "%t" + std::to_string(i) + " = OpTypeArray " + (i == 0 ? "%int" : "%t" + std::to_string(i - 1)) + " %c1\n";
    }
    EXPECT_NE(errorOf(assemble(head + nested + tail)).find("types are nested deeper than 255"), std::string::npos);

    std::string calls = head;
    for (int i = 0; i < 600; ++i) {
        calls += "%f" + std::to_string(i) + " = OpFunction %void None %fn\n%e" + std::to_string(i) + " = OpLabel\n";
        if (i != 0) calls += "%r" + std::to_string(i) + " = OpFunctionCall %void %f" + std::to_string(i - 1) + "\n";
        calls += "OpReturn\nOpFunctionEnd\n";
    }
    calls +=
        "%main = OpFunction %void None %fn\n%entry = OpLabel\n%r = OpFunctionCall %void "
        "%f599\nOpReturn\nOpFunctionEnd\n";
    EXPECT_NE(errorOf(assemble(calls)).find("is called too deep to be inlined"), std::string::npos);

    // Each function calls the one before it twice: 2^30 calls, of something and of nothing.
    const auto doubling = [&](const std::string& bottom) {
        std::string text = head;
        for (int i = 0; i < 31; ++i) {
            const std::string n = std::to_string(i);
            text += "%f" + n + " = OpFunction %void None %fn\n%e" + n + " = OpLabel\n";
            if (i == 0) text += bottom;
            for (const char* k : {"a", "b"}) {
                if (i != 0) text += "%r" + n + k + " = OpFunctionCall %void %f" + std::to_string(i - 1) + "\n";
            }
            text += "OpReturn\nOpFunctionEnd\n";
        }
        return text +
               "%main = OpFunction %void None %fn\n%entry = OpLabel\n%r = OpFunctionCall %void %f30\n"
               "OpReturn\nOpFunctionEnd\n";
    };
    std::string work = "%v0 = OpLoad %int %o\n";
    for (int i = 1; i < 100; ++i) {
        work += "%v" + std::to_string(i) + " = OpIMul %int %v" + std::to_string(i - 1) + " %v" + std::to_string(i - 1) +
                "\n";
    }
    EXPECT_NE(errorOf(assemble(doubling(work + "OpStore %o %v99\n"))).find("the program is too large"),
              std::string::npos);
    EXPECT_NE(errorOf(assemble(doubling(""))).find("is called when 65536 calls are inlined"), std::string::npos);

    std::string chain = head + "%main = OpFunction %void None %fn\n%entry = OpLabel\n";
    for (int i = 0; i < 20000; ++i) {
        chain +=
            "%p" + std::to_string(i) + " = OpAccessChain %out " + (i == 0 ? "%o" : "%p" + std::to_string(i - 1)) + "\n";
    }
    EXPECT_EQ(errorOf(assemble(chain + "OpStore %p19999 %c2\nOpReturn\nOpFunctionEnd\n")), "");
}

// Damaged modules: most are refused by the validator, the rest lower to something that verifies or are refused with
// words.
TEST(Refusal, DamagedModulesNeverCrash) {
    std::mt19937 random(11);
    for (const char* name : {"loop", "storage", "switchInLoop", "calls", "doubles", "localArrays", "uniforms"}) {
        std::string text = kSnippetPrologue;
        for (const Snippet& snippet : snippets()) {
            if (snippet.name == name)
                text += snippet.functions + "\nvoid main() {\no = vec4(0); p = ivec4(0);\n" + snippet.body + "}";
        }
        const Words words = compileGlsl(ir::Stage::fragment, text);
        for (int i = 0; i < 600; ++i) {
            Words broken = words;
            if (i % 10 == 0) broken.resize(random() % broken.size());
            for (uint32_t k = 0; k <= random() % 3 && !broken.empty(); ++k) {
                uint32_t& word = broken[random() % broken.size()];
                switch (random() % 3) {
                    case 0:
                        word ^= 1u << random() % 32;
                        break;
                    case 1:
                        word = random() % 400;
                        break;
                    default:
                        word = words[random() % words.size()];
                        break;
                }
            }
            ShaderSource source;
            source.words = broken;
            source.stage = ir::Stage::fragment;
            const Result<ir::Program> program = loadShader(source);
            if (!program) {
                EXPECT_FALSE(program.error().message.empty());
                EXPECT_EQ(program.error().message.find("IR of"), std::string::npos) << program.error().message;
            }
        }
    }
}

}  // namespace
}  // namespace vernier::test
