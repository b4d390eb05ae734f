#include "spirv_interp/reference/module_data.h"

#include <algorithm>

namespace vernier::reference {
namespace {

struct OpName {
    uint32_t op;
    const char* text;
};

constexpr OpName kOpNames[] = {
#include "spirv_interp/reference/op_names.inc"
};

}  // namespace

void fail(std::string message) {
    throw Failure{invalidArgument("SPIR-V: " + std::move(message))};
}
void failUnsupported(std::string message) {
    throw Failure{unsupported("SPIR-V: not supported by the reference interpreter: " + std::move(message))};
}

std::string name(Id id) {
    return "%" + std::to_string(id);
}

std::string name(spv::Op op) {
    const auto* found = std::find_if(std::begin(kOpNames), std::end(kOpNames),
                                     [op](const OpName& entry) { return entry.op == static_cast<uint32_t>(op); });
    return found != std::end(kOpNames) ? found->text : "opcode " + std::to_string(static_cast<uint32_t>(op));
}

const IdInfo& ModuleData::info(Id id) const {
    if (id >= ids.size() || ids[id].kind == IdKind::none) fail(name(id) + " is used but not defined");
    return ids[id];
}

const Decorations& ModuleData::decorationsOf(Id id) const {
    static const Decorations kNone;
    const auto found = decorations.find(id);
    return found != decorations.end() ? found->second : kNone;
}

const Decorations& ModuleData::decorationsOf(Id structure, uint32_t member) const {
    static const Decorations kNone;
    const auto found = memberDecorations.find({structure, member});
    return found != memberDecorations.end() ? found->second : kNone;
}

uint32_t ModuleData::typeIndex(Id id) const {
    const IdInfo& i = info(id);
    if (i.kind != IdKind::type) fail(name(id) + " is no type");
    return i.index;
}

const Type& ModuleData::valueType(Id id) const {
    const IdInfo& i = info(id);
    if (i.kind != IdKind::constant && i.kind != IdKind::variable && i.kind != IdKind::local)
        fail(name(id) + " is no value");
    return types[i.type];
}

const Constant& ModuleData::constant(Id id) const {
    const IdInfo& i = info(id);
    if (i.kind != IdKind::constant || i.index >= constants.size()) fail(name(id) + " is no constant");
    return constants[i.index];
}

uint64_t ModuleData::constantInteger(Id id) const {
    const Constant& c = constant(id);
    if (types[c.type].kind != TypeKind::integer) fail(name(id) + " is no integer constant");
    return c.scalars[0].bits;
}

}  // namespace vernier::reference
