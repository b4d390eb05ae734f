// Source lines, from OpLine and from NonSemantic.Shader.DebugInfo.100 (its specification is in the SPIR-V registry);
// they go to the instructions of the IR and into messages.
#include <algorithm>

#include "spirv_interp/front/lowering.h"

namespace vernier {
namespace {

// Numbers of the extended instruction set.
constexpr uint32_t kDebugSource = 35, kDebugLine = 103, kDebugNoLine = 104;

}  // namespace

void Lowering::lowerLine(const Instruction& inst) {
    if (inst.op == spv::Op::OpLine) {
        emitter_.setLine(inst[2], fileIndex(inst[1]));
    } else {
        emitter_.setLine(0);
    }
}

void Lowering::lowerDebugInstruction(const Instruction& inst) {
    if (module_.extendedSet(inst[3]) != "NonSemantic.Shader.DebugInfo.100") return;
    if (inst[4] == kDebugNoLine) emitter_.setLine(0);
    if (inst[4] != kDebugLine) return;
    // Source, then the first line: a constant, as all numbers are.
    const Instruction source = module_.definition(inst[5]), line = module_.definition(inst[6]);
    const bool known = source.op == spv::Op::OpExtInst && source[4] == kDebugSource;
    if (line.op == spv::Op::OpConstant) emitter_.setLine(line[3], known ? fileIndex(source[5]) : 0);
}

/// The index in Program::files of the file an OpString names.
uint32_t Lowering::fileIndex(uint32_t stringId) {
    const Instruction string = module_.definition(stringId);
    if (string.op != spv::Op::OpString) return 0;
    if (fileOfId_.empty()) fileOfId_.resize(module_.bound());
    uint32_t& index = fileOfId_[stringId];
    if (index != 0) return index;
    std::string name = Module::literalString(string, 2);
    // The text form of the IR keeps names on one line, in quotes.
    std::replace_if(
        name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == '"' || c == ';'; },
        '?');
    if (name.empty()) return 0;
    program_.files.push_back(std::move(name));
    return index = static_cast<uint32_t>(program_.files.size() - 1);
}

/// ", file:line" of the instruction being lowered, as far as it is known.
std::string Lowering::where() const {
    if (emitter_.line() == 0) return "";
    const std::string line = std::to_string(emitter_.line());
    return emitter_.file() == 0 ? ", line " + line : ", " + program_.files[emitter_.file()] + ":" + line;
}

}  // namespace vernier
