// Writes SPIR-V modules word by word: sections in the order the specification wants, types and constants once each.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <spirv/unified1/spirv.hpp>

namespace vernier::proof {

using Id = uint32_t;

class ModuleBuilder {
  public:
    enum Section : uint8_t {
        capabilities,
        extensions,
        imports,
        memoryModel,
        entryPoints,
        modes,
        annotations,
        globals,
        functions
    };

    Id newId() { return bound_++; }
    /// Appends an instruction. Equal ones without a result are written again.
    void add(Section section, spv::Op op, std::span<const uint32_t> operands);
    void add(Section section, spv::Op op, std::initializer_list<uint32_t> operands) {
        add(section, op, std::span(operands.begin(), operands.size()));
    }
    /// An instruction in a function with a result type; gives its id.
    Id value(spv::Op op, Id type, std::initializer_list<uint32_t> operands) {
        return value(op, type, std::span(operands.begin(), operands.size()));
    }
    Id value(spv::Op op, Id type, std::span<const uint32_t> operands);
    /// A type: the same id for the same operands.
    Id type(spv::Op op, std::initializer_list<uint32_t> operands);
    Id type(spv::Op op, std::span<const uint32_t> operands);
    Id constant(Id type, std::initializer_list<uint32_t> words);
    Id compositeConstant(Id type, std::span<const Id> parts);
    Id boolConstant(Id type, bool value);
    void capability(spv::Capability capability);
    void decorate(Id id, spv::Decoration decoration, std::initializer_list<uint32_t> operands = {});
    void memberDecorate(Id id, uint32_t member, spv::Decoration decoration, std::initializer_list<uint32_t> operands);
    static std::vector<uint32_t> text(const std::string& text);

    std::vector<uint32_t> words(uint32_t version) const;

  private:
    Id unique(spv::Op op, Id type, std::span<const uint32_t> operands);

    uint32_t bound_ = 1;
    std::array<std::vector<uint32_t>, 9> sections_;
    std::map<std::vector<uint32_t>, Id> known_;
    std::map<uint32_t, bool> capabilities_;
};

}  // namespace vernier::proof
