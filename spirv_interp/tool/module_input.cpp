#include "spirv_interp/tool/module_input.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>

#include "api/include/vernier/vernier_glsl.h"
#include "spirv_interp/ir/place_vertices.h"
#include "spirv_interp/reference/interpreter.h"

namespace vernier::tool {
namespace {

struct StageName {
    const char* name;
    const char* ending;
    ir::Stage stage;
    VkShaderStageFlagBits bit;
    spv::ExecutionModel model;
};
constexpr StageName kStages[] = {
    {"vertex", ".vert", ir::Stage::vertex, VK_SHADER_STAGE_VERTEX_BIT, spv::ExecutionModelVertex},
    {"control", ".tesc", ir::Stage::control, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
     spv::ExecutionModelTessellationControl},
    {"evaluation", ".tese", ir::Stage::evaluation, VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
     spv::ExecutionModelTessellationEvaluation},
    {"geometry", ".geom", ir::Stage::geometry, VK_SHADER_STAGE_GEOMETRY_BIT, spv::ExecutionModelGeometry},
    {"fragment", ".frag", ir::Stage::fragment, VK_SHADER_STAGE_FRAGMENT_BIT, spv::ExecutionModelFragment},
    {"compute", ".comp", ir::Stage::compute, VK_SHADER_STAGE_COMPUTE_BIT, spv::ExecutionModelGLCompute},
};

Result<std::vector<uint32_t>> compile(const std::string& text, const std::string& name, VkShaderStageFlagBits stage,
                                      bool debugInfo) {
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = text.c_str();
    desc.sourceName = name.c_str();
    desc.target = VN_GLSL_TARGET_VULKAN_1_2;
    desc.debugInfo = debugInfo ? 1 : 0;
    VnGlslOutput* output = nullptr;
    const VnGlslResult result = vnCompileGlsl(&desc, &output);
    const std::unique_ptr<VnGlslOutput, void (*)(VnGlslOutput*)> owner(output, vnFreeGlslOutput);
    if (result != VN_GLSL_SUCCESS) return invalidArgument(output != nullptr ? output->log : "out of memory");
    return std::vector<uint32_t>(output->words, output->words + output->wordCount);
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

}  // namespace

ShaderSource ModuleInput::shader(bool contract) const {
    ShaderSource shader;
    shader.words = words;
    shader.entryPoint = entryPoint;
    shader.stage = stage;
    shader.contract = contract;
    return shader;
}

Result<ir::Program> ModuleInput::program(bool contract) const {
    auto loaded = loadShader(shader(contract));
    if (loaded && stage == ir::Stage::geometry) ir::placeVertices(*loaded);
    return loaded;
}

Status ModuleInput::standsAlone() const {
    if (stage == ir::Stage::vertex || stage == ir::Stage::fragment || stage == ir::Stage::compute) return {};
    return unsupported(path + ": stages that take patches or primitives are not run here");
}

std::string ModuleInput::sourceLine(uint32_t line) const {
    if (line == 0 || line > source.size()) return {};
    const std::string& text = source[line - 1];
    const size_t first = text.find_first_not_of(" \t");
    return first == std::string::npos ? std::string() : text.substr(first);
}

Result<ModuleInput> readModule(const std::string& path, const std::string& stage, const std::string& entryPoint) {
    std::ifstream file(path, std::ios::binary);
    const std::string contents((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (!file) return invalidArgument(path + " cannot be read");
    ModuleInput input;
    input.path = path;
    const StageName* chosen = nullptr;
    for (const StageName& s : kStages) {
        if (stage == s.name || (stage.empty() && path.ends_with(s.ending))) chosen = &s;
    }
    if (!stage.empty() && chosen == nullptr) return invalidArgument("no stage \"" + stage + "\"");
    const bool isBinary = path.ends_with(".spv");
    if (isBinary) {
        if (contents.size() % sizeof(uint32_t) != 0) return invalidArgument(path + " is not made of 32-bit words");
        input.words.resize(contents.size() / sizeof(uint32_t));
        std::memcpy(input.words.data(), contents.data(), contents.size());
    } else {
        if (chosen == nullptr) return invalidArgument(path + ": --stage tells what kind of GLSL this is");
        auto words = compile(contents, path, chosen->bit, true);
        if (!words) return words.error();
        // Source lines can put instructions of glslang's between a merge instruction and its branch.
        if (!checkModule(*words).ok()) words = compile(contents, path, chosen->bit, false);
        if (!words) return words.error();
        input.words = std::move(*words);
        input.source = linesOf(contents);
    }
    if (chosen != nullptr) input.stage = chosen->stage;
    if (!entryPoint.empty()) input.entryPoint = entryPoint;
    if (chosen != nullptr && !entryPoint.empty()) return input;
    // A module that cannot be parsed is still to be validated and disassembled.
    const auto module = reference::Module::parse(input.words);
    if (!module) return input;
    for (const reference::EntryPoint& e : module->entryPoints()) {
        if (!entryPoint.empty() && e.name != entryPoint) continue;
        for (const StageName& s : kStages) {
            if (e.model != s.model || (chosen != nullptr && chosen != &s)) continue;
            input.stage = s.stage;
            input.entryPoint = e.name;
            return input;
        }
    }
    return input;
}

}  // namespace vernier::tool
