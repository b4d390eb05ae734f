#include "spirv_interp/front/module.h"

#include <algorithm>

namespace vernier {
namespace {

// "Universal limits" of the SPIR-V specification, section 2.17.
constexpr uint32_t kMaxBound = 0x3FFFFF;

}  // namespace

Result<Module> Module::read(std::span<const uint32_t> words) {
    if (words.size() < kFirstInstruction) return invalidArgument("SPIR-V: the module is shorter than its header");
    if (words[0] != spv::MagicNumber) return invalidArgument("SPIR-V: the magic number is missing");
    if (words.size() > (1u << 28)) return invalidArgument("SPIR-V: the module is longer than 1 GiB");
    Module module;
    module.words_ = words;
    module.bound_ = words[3];
    if (module.bound_ > kMaxBound) {
        return invalidArgument("SPIR-V: id bound " + std::to_string(module.bound_) + " is above the limit of 4194303");
    }
    module.definitions_.assign(module.bound_, 0);
    module.firstDecoration_.assign(module.bound_, 0);
    std::string error;
    if (!module.scan(error)) return invalidArgument("SPIR-V: " + error);
    return module;
}

Instruction Module::next(uint32_t& offset) const {
    Instruction inst;
    inst.words = words_.data() + offset;
    inst.op = static_cast<spv::Op>(*inst.words & 0xFFFF);
    inst.count = *inst.words >> 16;
    offset += inst.count;
    return inst;
}

Instruction Module::definition(uint32_t id) const {
    if (id >= bound_ || definitions_[id] == 0) return {};
    uint32_t offset = definitions_[id];
    return next(offset);
}

bool Module::scan(std::string& error) {
    uint32_t offset = kFirstInstruction;
    Function* current = nullptr;
    while (offset < words_.size()) {
        const uint32_t start = offset;
        const uint32_t count = words_[offset] >> 16;
        if (count == 0 || count > words_.size() - offset) {
            error = "the instruction at word " + std::to_string(start) + " leaves the module";
            return false;
        }
        const Instruction inst = next(offset);
        bool hasResult = false, hasType = false;
        spv::HasResultAndType(inst.op, &hasResult, &hasType);
        if (hasResult) {
            const uint32_t id = inst[hasType ? 2 : 1];
            if (id == 0 || id >= bound_) {
                error = "the result id at word " + std::to_string(start) + " is out of bounds";
                return false;
            }
            if (definitions_[id] != 0) {
                error = "%" + std::to_string(id) + " is defined twice";
                return false;
            }
            definitions_[id] = start;
        }
        switch (inst.op) {
            case spv::Op::OpFunction:
                if (globalsEnd_ == 0) globalsEnd_ = start;
                functionOfId_[inst[2]] = static_cast<uint32_t>(functions_.size());
                current = &functions_.emplace_back();
                current->id = inst[2];
                current->resultType = inst[1];
                break;
            case spv::Op::OpFunctionEnd:
                current = nullptr;
                break;
            case spv::Op::OpFunctionParameter:
                if (current != nullptr) current->parameters.push_back(inst[2]);
                break;
            case spv::Op::OpLabel:
                if (current != nullptr) {
                    current->blockOfLabel[inst[1]] = static_cast<uint32_t>(current->blocks.size());
                    current->blocks.push_back({inst[1], offset, offset});
                }
                break;
            default:
                if (current == nullptr) scanAnnotation(inst);
                break;
        }
        if (current != nullptr && !current->blocks.empty()) current->blocks.back().end = offset;
    }
    if (globalsEnd_ == 0) globalsEnd_ = static_cast<uint32_t>(words_.size());
    expandGroups();
    return true;
}

void Module::scanAnnotation(const Instruction& inst) {
    const auto offset = static_cast<uint32_t>(inst.words - words_.data());
    switch (inst.op) {
        case spv::Op::OpDecorate:
            addDecoration(inst[1], {Decoration::kNoMember, static_cast<spv::Decoration>(inst[2]), inst[3], 0});
            break;
        case spv::Op::OpMemberDecorate:
            addDecoration(inst[1], {inst[2], static_cast<spv::Decoration>(inst[3]), inst[4], 0});
            break;
        case spv::Op::OpGroupDecorate:
        case spv::Op::OpGroupMemberDecorate:
            groups_.push_back(offset);
            break;
        case spv::Op::OpEntryPoint: {
            EntryPoint& entry = entryPoints_.emplace_back();
            entry.model = static_cast<spv::ExecutionModel>(inst[1]);
            entry.function = inst[2];
            entry.name = literalString(inst, 3);
            for (auto word = static_cast<uint32_t>(3 + entry.name.size() / 4 + 1); word < inst.count; ++word) {
                entry.interface.push_back(inst[word]);
            }
            break;
        }
        case spv::Op::OpExecutionMode:
        case spv::Op::OpExecutionModeId:
            executionModes_.push_back(offset);
            break;
        case spv::Op::OpExtInstImport:
            extendedSets_.emplace_back(inst[1], literalString(inst, 2));
            break;
        default:
            break;
    }
}

void Module::addDecoration(uint32_t target, const Decoration& decoration) {
    if (target >= bound_) return;
    decorations_.push_back(decoration);
    decorations_.back().next = firstDecoration_[target];
    firstDecoration_[target] = static_cast<uint32_t>(decorations_.size() - 1);
}

void Module::expandGroups() {
    for (uint32_t offset : groups_) {
        const Instruction inst = next(offset);
        const bool members = inst.op == spv::Op::OpGroupMemberDecorate;
        if (inst[1] >= bound_) continue;
        for (uint32_t word = 2; word < inst.count; word += members ? 2 : 1) {
            for (uint32_t d = firstDecoration_[inst[1]]; d != 0; d = decorations_[d].next) {
                Decoration copy = decorations_[d];
                if (members) copy.member = inst[word + 1];
                if (inst[word] != inst[1]) addDecoration(inst[word], copy);
            }
        }
    }
}

const Decoration* Module::findDecoration(uint32_t id, spv::Decoration kind, uint32_t member) const {
    if (id >= bound_) return nullptr;
    for (uint32_t d = firstDecoration_[id]; d != 0; d = decorations_[d].next) {
        if (decorations_[d].kind == kind && decorations_[d].member == member) return &decorations_[d];
    }
    return nullptr;
}

uint32_t Module::decorationOr(uint32_t id, spv::Decoration kind, uint32_t member, uint32_t otherwise) const {
    const Decoration* found = findDecoration(id, kind, member);
    return found != nullptr ? found->value : otherwise;
}

const Function* Module::function(uint32_t id) const {
    const auto found = functionOfId_.find(id);
    return found == functionOfId_.end() ? nullptr : &functions_[found->second];
}

std::string_view Module::extendedSet(uint32_t id) const {
    for (const auto& [set, name] : extendedSets_) {
        if (set == id) return name;
    }
    return {};
}

std::string Module::nameOf(uint32_t id) const {
    std::string result = "%" + std::to_string(id);
    for (uint32_t offset = kFirstInstruction; offset < globalsEnd_;) {
        const Instruction inst = next(offset);
        if (inst.op == spv::Op::OpName && inst[1] == id) {
            const std::string name = literalString(inst, 2);
            if (!name.empty()) result += " (" + name + ")";
            break;
        }
    }
    return result;
}

std::string Module::literalString(const Instruction& inst, uint32_t word) {
    std::string text;
    for (; word < inst.count; ++word) {
        for (uint32_t byte = 0; byte < 4; ++byte) {
            const char c = static_cast<char>(inst.words[word] >> (8 * byte) & 0xFF);
            if (c == '\0') return text;
            text.push_back(c);
        }
    }
    return text;
}

}  // namespace vernier
