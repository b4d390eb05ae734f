#include "api/glsl/glsl_process.h"
#include "vernier/vernier_glsl.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace vernier::glsl {
namespace {

/// The public struct with the memory behind its pointers.
struct Output {
    VnGlslOutput view{};  // first: the public pointer is a pointer to the whole
    std::vector<uint32_t> words;
    std::string log;
};

/// The compiler's own, but for what Vernier has more of.
const TBuiltInResource& limits() {
    static const TBuiltInResource limits = [] {
        TBuiltInResource all = *GetDefaultResources();
        all.maxGeometryOutputVertices = 1024;
        all.maxGeometryTotalOutputComponents = 16384;
        return all;
    }();
    return limits;
}

std::optional<EShLanguage> languageOf(VkShaderStageFlagBits stage) {
    switch (stage) {
        case VK_SHADER_STAGE_VERTEX_BIT:
            return EShLangVertex;
        case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
            return EShLangTessControl;
        case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
            return EShLangTessEvaluation;
        case VK_SHADER_STAGE_GEOMETRY_BIT:
            return EShLangGeometry;
        case VK_SHADER_STAGE_FRAGMENT_BIT:
            return EShLangFragment;
        case VK_SHADER_STAGE_COMPUTE_BIT:
            return EShLangCompute;
        default:
            return std::nullopt;
    }
}

struct Environment {
    glslang::EShTargetClientVersion client;
    glslang::EShTargetLanguageVersion spirv;
};

std::optional<Environment> environmentOf(VnGlslTarget target) {
    switch (target) {
        case VN_GLSL_TARGET_VULKAN_1_0:
            return {{glslang::EShTargetVulkan_1_0, glslang::EShTargetSpv_1_0}};
        case VN_GLSL_TARGET_DEFAULT:
        case VN_GLSL_TARGET_VULKAN_1_1:
            return {{glslang::EShTargetVulkan_1_1, glslang::EShTargetSpv_1_3}};
        case VN_GLSL_TARGET_VULKAN_1_2:
            return {{glslang::EShTargetVulkan_1_2, glslang::EShTargetSpv_1_5}};
        case VN_GLSL_TARGET_VULKAN_1_3:
            return {{glslang::EShTargetVulkan_1_3, glslang::EShTargetSpv_1_6}};
        default:
            return std::nullopt;
    }
}

VnGlslResult refuse(Output& output, std::string message) {
    output.log = "ERROR: " + std::move(message) + "\n";
    return VN_GLSL_ERROR_INVALID_ARGUMENT;
}

VnGlslResult compile(const VnGlslDesc& desc, Output& output) {
    const std::optional<EShLanguage> language = languageOf(desc.stage);
    if (!language) {
        return refuse(output, "VnGlslDesc::stage is " + std::to_string(static_cast<uint32_t>(desc.stage)) +
                                  ", not a single shader stage");
    }
    const std::optional<Environment> environment = environmentOf(desc.target);
    if (!environment) {
        return refuse(output, "VnGlslDesc::target is " + std::to_string(static_cast<int>(desc.target)) +
                                  ", not a value of VnGlslTarget");
    }
    if (desc.source == nullptr) return refuse(output, "VnGlslDesc::source is NULL");
    const size_t length = desc.sourceLength != 0 ? desc.sourceLength : std::strlen(desc.source);
    if (length > static_cast<size_t>(std::numeric_limits<int>::max())) {
        return refuse(output, "VnGlslDesc::sourceLength is " + std::to_string(length) + ", beyond 2^31-1");
    }

    const ProcessReference process;
    if (!process.valid()) throw std::bad_alloc();  // the only way glslang's own set-up fails

    const char* source = desc.source;
    const int sourceLength = static_cast<int>(length);
    const char* name = desc.sourceName != nullptr ? desc.sourceName : "";
    glslang::TShader shader(*language);
    shader.setStringsWithLengthsAndNames(&source, &sourceLength, &name, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, *language, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, environment->client);
    shader.setEnvTarget(glslang::EShTargetSpv, environment->spirv);
    if (desc.entryName != nullptr) {
        shader.setEntryPoint(desc.entryName);
        shader.setSourceEntryPoint("main");
    }
    const bool debugInfo = desc.debugInfo != 0;
    shader.setDebugInfo(debugInfo);
    int flags = EShMsgSpvRules | EShMsgVulkanRules;
    if (debugInfo) flags |= EShMsgDebugInfo;
    const EShMessages messages = static_cast<EShMessages>(flags);
    constexpr int kDefaultVersion = 450;

    const bool parsed = shader.parse(&limits(), kDefaultVersion, false, messages);
    output.log = shader.getInfoLog();
    if (!parsed) return VN_GLSL_ERROR_COMPILE_FAILED;
    glslang::TProgram program;
    program.addShader(&shader);
    const bool linked = program.link(messages);
    output.log += program.getInfoLog();
    if (!linked) return VN_GLSL_ERROR_COMPILE_FAILED;

    glslang::SpvOptions options;
    options.generateDebugInfo = debugInfo;
    options.stripDebugInfo = !debugInfo;
    options.disableOptimizer = true;  // what runs is what was written; the renderer has passes of its own
    spv::SpvBuildLogger logger;
    glslang::GlslangToSpv(*program.getIntermediate(*language), output.words, &logger, &options);
    output.log += logger.getAllMessages();
    return output.words.empty() ? VN_GLSL_ERROR_COMPILE_FAILED : VN_GLSL_SUCCESS;
}

}  // namespace
}  // namespace vernier::glsl

using vernier::glsl::Output;

VnGlslResult vnCompileGlsl(const VnGlslDesc* desc, VnGlslOutput** out) {
    if (out == nullptr) return VN_GLSL_ERROR_INVALID_ARGUMENT;
    *out = nullptr;
    if (desc == nullptr) return VN_GLSL_ERROR_INVALID_ARGUMENT;
    try {
        auto output = std::make_unique<Output>();
        const VnGlslResult result = vernier::glsl::compile(*desc, *output);
        if (result == VN_GLSL_SUCCESS) {
            output->view.words = output->words.data();
            output->view.wordCount = output->words.size();
        }
        output->view.log = output->log.c_str();
        *out = &output.release()->view;
        return result;
    } catch (const std::bad_alloc&) {
        return VN_GLSL_ERROR_OUT_OF_MEMORY;
    }
}

void vnFreeGlslOutput(VnGlslOutput* output) {
    delete reinterpret_cast<Output*>(output);
}

VnGlslResult vnRetainGlslCompiler(void) {
    return vernier::glsl::retainProcess() ? VN_GLSL_SUCCESS : VN_GLSL_ERROR_OUT_OF_MEMORY;
}

void vnReleaseGlslCompiler(void) {
    vernier::glsl::releaseProcess();
}
