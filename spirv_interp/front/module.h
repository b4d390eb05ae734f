// A SPIR-V module read into tables: where each id is defined, decorations, entry points, functions and their blocks.
// Nothing is interpreted here; the words have passed validation, and yet every read stays inside them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#define SPV_ENABLE_UTILITY_CODE  // spv::HasResultAndType
#include <spirv/unified1/spirv.hpp11>

#include "base/result.h"

namespace vernier {

/// One instruction. Words beyond its end read as 0.
struct Instruction {
    spv::Op op = spv::Op::OpNop;
    uint32_t count = 0;  // words
    const uint32_t* words = nullptr;

    uint32_t operator[](uint32_t index) const { return index < count ? words[index] : 0; }
};

struct Decoration {
    static constexpr uint32_t kNoMember = ~0u;
    uint32_t member = kNoMember;
    spv::Decoration kind{};
    uint32_t value = 0;  // first literal
    uint32_t next = 0;   // index of the target's next decoration; 0 = none
};

struct SpirvBlock {
    uint32_t label = 0;
    uint32_t first = 0, end = 0;  // words: the first instruction after the label, and one past the terminator
};

struct Function {
    uint32_t id = 0, resultType = 0;
    std::vector<uint32_t> parameters;
    std::vector<SpirvBlock> blocks;
    std::unordered_map<uint32_t, uint32_t> blockOfLabel;
};

struct EntryPoint {
    spv::ExecutionModel model{};
    uint32_t function = 0;
    std::string name;
    std::vector<uint32_t> interface;
};

class Module {
  public:
    /// `words` must outlive the module. Errors: a broken header or an instruction that leaves the words.
    static Result<Module> read(std::span<const uint32_t> words);

    uint32_t bound() const { return bound_; }
    uint32_t version() const { return words_[1]; }

    /// The instruction at a word offset; moves the offset to the next.
    Instruction next(uint32_t& offset) const;
    /// The instruction that defines `id`; OpNop for an id that has none.
    Instruction definition(uint32_t id) const;
    /// All instructions before the first function.
    uint32_t globalsEnd() const { return globalsEnd_; }
    static constexpr uint32_t kFirstInstruction = 5;

    const Decoration* findDecoration(uint32_t id, spv::Decoration kind, uint32_t member = Decoration::kNoMember) const;
    bool hasDecoration(uint32_t id, spv::Decoration kind, uint32_t member = Decoration::kNoMember) const {
        return findDecoration(id, kind, member) != nullptr;
    }
    /// The literal of a decoration, or `otherwise` when it is not there.
    uint32_t decorationOr(uint32_t id, spv::Decoration kind, uint32_t member, uint32_t otherwise) const;

    const std::vector<EntryPoint>& entryPoints() const { return entryPoints_; }
    /// Word offsets of OpExecutionMode and OpExecutionModeId instructions.
    const std::vector<uint32_t>& executionModes() const { return executionModes_; }
    const Function* function(uint32_t id) const;
    const std::vector<Function>& functions() const { return functions_; }
    /// "GLSL.std.450" and the like by the id of the import.
    std::string_view extendedSet(uint32_t id) const;

    /// `%12`, with the OpName where the module has one. For messages: searches.
    std::string nameOf(uint32_t id) const;
    /// A literal string that begins at `word` of an instruction.
    static std::string literalString(const Instruction& inst, uint32_t word);

  private:
    bool scan(std::string& error);
    void scanAnnotation(const Instruction& inst);
    void addDecoration(uint32_t target, const Decoration& decoration);
    void expandGroups();

    std::span<const uint32_t> words_;
    uint32_t bound_ = 0;
    uint32_t globalsEnd_ = 0;
    std::vector<uint32_t> definitions_;      // word offset by id, 0 = none
    std::vector<uint32_t> firstDecoration_;  // by id, index into decorations_, 0 = none
    std::vector<Decoration> decorations_{Decoration{}};
    std::vector<uint32_t> groups_;  // word offsets of OpGroupDecorate and OpGroupMemberDecorate
    std::vector<EntryPoint> entryPoints_;
    std::vector<uint32_t> executionModes_;
    std::vector<std::pair<uint32_t, std::string>> extendedSets_;
    std::vector<Function> functions_;
    std::unordered_map<uint32_t, uint32_t> functionOfId_;
};

}  // namespace vernier
