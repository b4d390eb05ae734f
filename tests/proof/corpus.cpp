#include "tests/proof/corpus.h"

#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace vernier::proof {
namespace {

/// Keeps the compiler's tables between compilations.
struct CompilerReference {
    CompilerReference() { vnRetainGlslCompiler(); }
    ~CompilerReference() { vnReleaseGlslCompiler(); }
};

Filling fillingOf(std::istream& line) {
    constexpr std::pair<const char*, Filling::Kind> kKinds[] = {
        {"uniform", Filling::Kind::uniform}, {"integer", Filling::Kind::integer}, {"index", Filling::Kind::index},
        {"ramp", Filling::Kind::ramp},       {"special", Filling::Kind::special}, {"zero", Filling::Kind::zero},
    };
    std::string kind;
    Filling filling;
    line >> kind;
    const auto* found =
        std::find_if(std::begin(kKinds), std::end(kKinds), [&](const auto& entry) { return entry.first == kind; });
    if (found == std::end(kKinds)) throw std::runtime_error("unknown filling \"" + kind + "\"");
    filling.kind = found->second;
    if (filling.kind != Filling::Kind::special && filling.kind != Filling::Kind::zero)
        line >> filling.low >> filling.high;
    return filling;
}

void directive(CorpusProgram& program, const std::string& text, int& vulkanMinor) {
    std::istringstream line(text);
    std::string word;
    line >> word;
    Case& subject = program.subject;
    World& world = subject.world;
    if (word == "invocations") {
        line >> subject.invocations;
    } else if (word == "groups") {
        for (uint32_t& n : subject.groups) line >> n;
    } else if (word == "inputs") {
        world.inputs = fillingOf(line);
    } else if (word == "input") {
        uint32_t location = 0;
        line >> location;
        world.inputAt[location] = fillingOf(line);
    } else if (word == "buffer" || word == "push") {
        Slot slot = kPushConstants;
        World::BufferSpec spec;
        if (word == "buffer") {
            slot.element = 0;
            line >> slot.set >> slot.binding;
        }
        line >> spec.bytes;
        spec.filling = fillingOf(line);
        world.bufferAt[slot] = spec;
    } else if (word == "integers") {
        Slot slot;
        line >> slot.set >> slot.binding;
        world.integerImages[slot] = true;
    } else if (word == "spec") {
        SpecConstant constant;
        line >> constant.id >> constant.value;
        subject.specialization.push_back(constant);
    } else if (word == "vulkan") {
        std::string version;
        line >> version;
        vulkanMinor = version.back() - '0';
    } else {
        throw std::runtime_error("unknown directive \"" + word + "\"");
    }
    if (!line) throw std::runtime_error("directive \"" + text + "\" is cut short");
}

}  // namespace

std::vector<std::string> corpusFiles(const std::string& extension) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(VERNIER_CORPUS_FOLDER))
        if (entry.path().extension() == extension) files.push_back(entry.path().filename().string());
    std::sort(files.begin(), files.end());
    return files;
}

Words compileGlsl(ir::Stage stage, const std::string& source, int vulkanMinor) {
    static const CompilerReference kReference;
    constexpr VkShaderStageFlagBits kStages[] = {VK_SHADER_STAGE_VERTEX_BIT,
                                                 VK_SHADER_STAGE_FRAGMENT_BIT,
                                                 VK_SHADER_STAGE_COMPUTE_BIT,
                                                 VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                                                 VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
                                                 VK_SHADER_STAGE_GEOMETRY_BIT};
    VnGlslDesc desc{};
    desc.stage = kStages[static_cast<size_t>(stage)];
    desc.source = source.data();
    desc.sourceLength = source.size();
    desc.target = static_cast<VnGlslTarget>(VN_GLSL_TARGET_VULKAN_1_0 + vulkanMinor);
    VnGlslOutput* output = nullptr;
    Words words;
    std::string log;
    if (vnCompileGlsl(&desc, &output) == VN_GLSL_SUCCESS) {
        words.assign(output->words, output->words + output->wordCount);
    } else {
        log = output != nullptr ? output->log : "out of memory";
    }
    vnFreeGlslOutput(output);
    if (words.empty()) throw std::runtime_error(log);
    return words;
}

CorpusProgram loadCorpusProgram(const std::string& file) {
    CorpusProgram program;
    std::ifstream stream(std::string(VERNIER_CORPUS_FOLDER) + "/" + file);
    if (!stream) throw std::runtime_error("cannot open " + file);
    int vulkanMinor = 0;
    for (std::string line; std::getline(stream, line);) {
        program.source += line + "\n";
        if (line.starts_with("//! ")) directive(program, line.substr(4), vulkanMinor);
    }
    program.subject.name = file;
    program.subject.stage = file.ends_with(".vert")   ? ir::Stage::vertex
                            : file.ends_with(".tesc") ? ir::Stage::control
                            : file.ends_with(".tese") ? ir::Stage::evaluation
                            : file.ends_with(".geom") ? ir::Stage::geometry
                            : file.ends_with(".frag") ? ir::Stage::fragment
                                                      : ir::Stage::compute;
    program.subject.words = compileGlsl(program.subject.stage, program.source, vulkanMinor);
    return program;
}

}  // namespace vernier::proof
