#include "tests/reference/reference_support.h"

#include <vernier/vernier_glsl.h>

#include <spirv-tools/libspirv.hpp>

namespace vernier::reference::test {
namespace {

/// Keeps the compiler's tables between the many small compilations of the tests.
struct CompilerReference {
    CompilerReference() { vnRetainGlslCompiler(); }
    ~CompilerReference() { vnReleaseGlslCompiler(); }
};

Words compile(VkShaderStageFlagBits stage, std::string_view source, int vulkanMinor, bool names) {
    static const CompilerReference kReference;
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = source.data();
    desc.sourceLength = source.size();
    desc.target = static_cast<VnGlslTarget>(VN_GLSL_TARGET_VULKAN_1_0 + vulkanMinor);
    desc.debugInfo = names ? 1 : 0;
    VnGlslOutput* output = nullptr;
    Words words;
    if (vnCompileGlsl(&desc, &output) == VN_GLSL_SUCCESS)
        words.assign(output->words, output->words + output->wordCount);
    else
        ADD_FAILURE() << (output ? output->log : "out of memory") << "\n" << source;
    vnFreeGlslOutput(output);
    return words;
}

}  // namespace

Words compileVertex(std::string_view source, int vulkanMinor) {
    return compile(VK_SHADER_STAGE_VERTEX_BIT, source, vulkanMinor, false);
}
Words compileFragment(std::string_view source, int vulkanMinor, bool names) {
    return compile(VK_SHADER_STAGE_FRAGMENT_BIT, source, vulkanMinor, names);
}
Words compileControl(std::string_view source) {
    return compile(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, source, 1, false);
}
Words compileEvaluation(std::string_view source) {
    return compile(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, source, 1, false);
}

Words assemble(std::string_view source) {
    spvtools::SpirvTools tools(SPV_ENV_UNIVERSAL_1_5);
    tools.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t& at, const char* message) {
        ADD_FAILURE() << "line " << at.line << ": " << message;
    });
    Words words;
    EXPECT_TRUE(tools.Assemble(source.data(), source.size(), &words));
    return words;
}

std::string fragmentSource(std::string_view declarations, std::string_view body) {
    std::string source = R"(#version 450
layout(location = 0) in vec4 v;
layout(location = 1) flat in ivec4 i;
layout(location = 2) flat in uvec4 u;
layout(location = 0) out vec4 r;
layout(location = 1) out ivec4 ri;
)";
    source += declarations;
    source += "\nvoid main() {\n";
    source += body;
    source += "\n}\n";
    return source;
}

}  // namespace vernier::reference::test
