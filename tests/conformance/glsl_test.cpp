#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

extern "C" VnGlslResult compileFromC(const char* source, VnGlslOutput** out);

namespace {

using ::testing::HasSubstr;

constexpr const char* kVertex = "#version 450\nvoid main() { gl_Position = vec4(0); }\n";

struct Compiled {
    VnGlslResult result;
    std::unique_ptr<VnGlslOutput, decltype(&vnFreeGlslOutput)> output;
};

Compiled compile(const VnGlslDesc& desc) {
    VnGlslOutput* output = nullptr;
    const VnGlslResult result = vnCompileGlsl(&desc, &output);
    return {result, {output, &vnFreeGlslOutput}};
}

VnGlslDesc vertexDesc() {
    VnGlslDesc desc{};
    desc.stage = VK_SHADER_STAGE_VERTEX_BIT;
    desc.source = kVertex;
    return desc;
}

// OpEntryPoint: opcode 15; words: execution model, id, name.
std::string entryPointName(const VnGlslOutput& output) {
    for (size_t at = 5; at < output.wordCount; at += output.words[at] >> 16) {
        if ((output.words[at] & 0xffff) == 15) return reinterpret_cast<const char*>(output.words + at + 3);
        if (output.words[at] >> 16 == 0) break;
    }
    return {};
}

bool hasOpcode(const VnGlslOutput& output, uint32_t opcode) {
    for (size_t at = 5; at < output.wordCount && output.words[at] >> 16 != 0; at += output.words[at] >> 16) {
        if ((output.words[at] & 0xffff) == opcode) return true;
    }
    return false;
}

TEST(Glsl, CompilesFromC) {
    VnGlslOutput* output = nullptr;
    ASSERT_EQ(compileFromC(kVertex, &output), VN_GLSL_SUCCESS);
    ASSERT_GT(output->wordCount, 5u);
    EXPECT_EQ(output->words[0], 0x07230203u);
    EXPECT_EQ(output->words[1], 0x00010300u) << "SPIR-V 1.3 is the default";
    EXPECT_EQ(entryPointName(*output), "main");
    EXPECT_STREQ(output->log, "");
    vnFreeGlslOutput(output);
}

TEST(Glsl, EveryTargetHasItsVersion) {
    const std::array<std::pair<VnGlslTarget, uint32_t>, 4> versions{{{VN_GLSL_TARGET_VULKAN_1_0, 0x10000},
                                                                     {VN_GLSL_TARGET_VULKAN_1_1, 0x10300},
                                                                     {VN_GLSL_TARGET_VULKAN_1_2, 0x10500},
                                                                     {VN_GLSL_TARGET_VULKAN_1_3, 0x10600}}};
    for (const auto& [target, version] : versions) {
        VnGlslDesc desc = vertexDesc();
        desc.target = target;
        const Compiled compiled = compile(desc);
        ASSERT_EQ(compiled.result, VN_GLSL_SUCCESS) << compiled.output->log;
        EXPECT_EQ(compiled.output->words[1], version);
    }
}

TEST(Glsl, EveryStageCompiles) {
    const std::array<std::pair<VkShaderStageFlagBits, const char*>, 6> sources{{
        {VK_SHADER_STAGE_VERTEX_BIT, kVertex},
        {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
         "#version 450\nlayout(vertices = 3) out; void main() { gl_TessLevelOuter[0] = 1; }"},
        {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
         "#version 450\nlayout(triangles) in; void main() { gl_Position = vec4(gl_TessCoord, 1); }"},
        {VK_SHADER_STAGE_GEOMETRY_BIT,
         "#version 450\nlayout(points) in; layout(points, max_vertices = 1) out; void main() { EmitVertex(); "
         "}"},
        {VK_SHADER_STAGE_FRAGMENT_BIT, "#version 450\nlayout(location = 0) out vec4 c; void main() { c = vec4(1); }"},
        {VK_SHADER_STAGE_COMPUTE_BIT, "#version 450\nlayout(local_size_x = 8) in; void main() {}"},
    }};
    for (const auto& [stage, source] : sources) {
        VnGlslDesc desc{};
        desc.stage = stage;
        desc.source = source;
        const Compiled compiled = compile(desc);
        EXPECT_EQ(compiled.result, VN_GLSL_SUCCESS) << stage << ": " << compiled.output->log;
    }
}

TEST(Glsl, EntryPointCanBeRenamed) {
    VnGlslDesc desc = vertexDesc();
    desc.entryName = "vertexMain";
    const Compiled compiled = compile(desc);
    ASSERT_EQ(compiled.result, VN_GLSL_SUCCESS) << compiled.output->log;
    EXPECT_EQ(entryPointName(*compiled.output), "vertexMain");
}

TEST(Glsl, DebugInfoIsKeptOnlyOnRequest) {
    constexpr uint32_t kOpName = 5, kOpLine = 8;
    VnGlslDesc desc = vertexDesc();
    Compiled compiled = compile(desc);
    ASSERT_EQ(compiled.result, VN_GLSL_SUCCESS);
    EXPECT_FALSE(hasOpcode(*compiled.output, kOpLine));
    EXPECT_FALSE(hasOpcode(*compiled.output, kOpName));
    desc.debugInfo = 1;
    compiled = compile(desc);
    ASSERT_EQ(compiled.result, VN_GLSL_SUCCESS);
    EXPECT_TRUE(hasOpcode(*compiled.output, kOpLine));
    EXPECT_TRUE(hasOpcode(*compiled.output, kOpName));
}

TEST(Glsl, ErrorsNameSourceAndLine) {
    VnGlslDesc desc = vertexDesc();
    desc.source = "#version 450\nvoid main() {\n  gl_Position = undeclared;\n}\n";
    desc.sourceName = "broken.vert";
    const Compiled compiled = compile(desc);
    EXPECT_EQ(compiled.result, VN_GLSL_ERROR_COMPILE_FAILED);
    ASSERT_NE(compiled.output, nullptr);
    EXPECT_EQ(compiled.output->words, nullptr);
    EXPECT_EQ(compiled.output->wordCount, 0u);
    EXPECT_THAT(compiled.output->log, HasSubstr("broken.vert:3"));
    EXPECT_THAT(compiled.output->log, HasSubstr("undeclared"));
}

TEST(Glsl, LengthEndsTheSource) {
    const std::string source = std::string(kVertex) + "this is no GLSL";
    VnGlslDesc desc = vertexDesc();
    desc.source = source.c_str();
    EXPECT_EQ(compile(desc).result, VN_GLSL_ERROR_COMPILE_FAILED);
    desc.sourceLength = std::strlen(kVertex);
    EXPECT_EQ(compile(desc).result, VN_GLSL_SUCCESS);
}

TEST(Glsl, BadArgumentsAreNamed) {
    VnGlslOutput* output = nullptr;
    EXPECT_EQ(vnCompileGlsl(nullptr, &output), VN_GLSL_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(output, nullptr);
    VnGlslDesc desc = vertexDesc();
    EXPECT_EQ(vnCompileGlsl(&desc, nullptr), VN_GLSL_ERROR_INVALID_ARGUMENT);

    desc.source = nullptr;
    Compiled compiled = compile(desc);
    EXPECT_EQ(compiled.result, VN_GLSL_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(compiled.output->log, HasSubstr("VnGlslDesc::source"));

    desc = vertexDesc();
    desc.stage = VK_SHADER_STAGE_ALL_GRAPHICS;
    compiled = compile(desc);
    EXPECT_EQ(compiled.result, VN_GLSL_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(compiled.output->log, HasSubstr("VnGlslDesc::stage is 31"));

    desc = vertexDesc();
    desc.target = static_cast<VnGlslTarget>(99);
    compiled = compile(desc);
    EXPECT_EQ(compiled.result, VN_GLSL_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(compiled.output->log, HasSubstr("VnGlslDesc::target is 99"));
    vnFreeGlslOutput(nullptr);
}

TEST(Glsl, ThreadsCompileTheSameWordsWhileOthersStartAndStopTheCompiler) {
    const VnGlslDesc desc = vertexDesc();
    const Compiled expected = compile(desc);
    ASSERT_EQ(expected.result, VN_GLSL_SUCCESS);
    std::array<int, 4> wrong{};
    std::vector<std::thread> threads;
    for (int& count : wrong) {
        threads.emplace_back([&] {
            for (int i = 0; i < 8; ++i) {
                const bool retain = i % 2 == 0;
                if (retain && vnRetainGlslCompiler() != VN_GLSL_SUCCESS) ++count;
                const Compiled compiled = compile(desc);
                if (compiled.result != VN_GLSL_SUCCESS || compiled.output->wordCount != expected.output->wordCount ||
                    std::memcmp(compiled.output->words, expected.output->words,
                                expected.output->wordCount * sizeof(uint32_t)) != 0) {
                    ++count;
                }
                if (retain) vnReleaseGlslCompiler();
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(wrong, ::testing::Each(0));
}

TEST(Glsl, ReleaseWithoutRetainDoesNothing) {
    vnReleaseGlslCompiler();
    EXPECT_EQ(compile(vertexDesc()).result, VN_GLSL_SUCCESS);
}

}  // namespace
