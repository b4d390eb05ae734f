#include "tests/proof/module_builder.h"

namespace vernier::proof {

void ModuleBuilder::add(Section section, spv::Op op, std::span<const uint32_t> operands) {
    auto& words = sections_[section];
    words.push_back(static_cast<uint32_t>(operands.size() + 1) << 16 | static_cast<uint32_t>(op));
    words.insert(words.end(), operands.begin(), operands.end());
}

Id ModuleBuilder::value(spv::Op op, Id type, std::span<const uint32_t> operands) {
    std::vector<uint32_t> words{type, newId()};
    words.insert(words.end(), operands.begin(), operands.end());
    add(functions, op, words);
    return words[1];
}

/// `type` 0: a type instruction, which has no result type.
Id ModuleBuilder::unique(spv::Op op, Id type, std::span<const uint32_t> operands) {
    std::vector<uint32_t> key{static_cast<uint32_t>(op), type};
    key.insert(key.end(), operands.begin(), operands.end());
    const auto [found, isNew] = known_.emplace(std::move(key), 0);
    if (!isNew) return found->second;
    const Id id = newId();
    std::vector<uint32_t> words;
    if (type != 0) words.push_back(type);
    words.push_back(id);
    words.insert(words.end(), operands.begin(), operands.end());
    add(globals, op, words);
    return known_[found->first] = id;
}

Id ModuleBuilder::type(spv::Op op, std::span<const uint32_t> operands) {
    return unique(op, 0, operands);
}
Id ModuleBuilder::type(spv::Op op, std::initializer_list<uint32_t> operands) {
    return unique(op, 0, std::span(operands.begin(), operands.size()));
}
Id ModuleBuilder::constant(Id type, std::initializer_list<uint32_t> words) {
    return unique(spv::OpConstant, type, std::span(words.begin(), words.size()));
}
Id ModuleBuilder::compositeConstant(Id type, std::span<const Id> parts) {
    return unique(spv::OpConstantComposite, type, parts);
}
Id ModuleBuilder::boolConstant(Id type, bool value) {
    return unique(value ? spv::OpConstantTrue : spv::OpConstantFalse, type, {});
}

void ModuleBuilder::capability(spv::Capability capability) {
    if (!capabilities_.emplace(capability, true).second) return;
    add(capabilities, spv::OpCapability, {static_cast<uint32_t>(capability)});
}

void ModuleBuilder::decorate(Id id, spv::Decoration decoration, std::initializer_list<uint32_t> operands) {
    std::vector<uint32_t> words{id, static_cast<uint32_t>(decoration)};
    words.insert(words.end(), operands.begin(), operands.end());
    add(annotations, spv::OpDecorate, words);
}
void ModuleBuilder::memberDecorate(Id id, uint32_t member, spv::Decoration decoration,
                                   std::initializer_list<uint32_t> operands) {
    std::vector<uint32_t> words{id, member, static_cast<uint32_t>(decoration)};
    words.insert(words.end(), operands.begin(), operands.end());
    add(annotations, spv::OpMemberDecorate, words);
}

std::vector<uint32_t> ModuleBuilder::text(const std::string& text) {
    std::vector<uint32_t> words(text.size() / 4 + 1);
    for (size_t k = 0; k < text.size(); ++k)
        words[k / 4] |= static_cast<uint32_t>(static_cast<unsigned char>(text[k])) << (8 * (k % 4));
    return words;
}

std::vector<uint32_t> ModuleBuilder::words(uint32_t version) const {
    std::vector<uint32_t> all{spv::MagicNumber, version, 0, bound_, 0};
    for (const auto& section : sections_) all.insert(all.end(), section.begin(), section.end());
    return all;
}

}  // namespace vernier::proof
