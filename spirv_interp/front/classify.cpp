// Which variables can be SSA values and which need memory: by the indices of the access chains that reach them, also through
// calls. Runs on the words of the module, before types are known.
#include <algorithm>

#include "spirv_interp/front/lowering.h"

namespace vernier {
namespace {

// A choice among n values takes n - 1 compares and selects for each scalar; beyond this many, memory is cheaper.
constexpr uint32_t kMaxChoices = 8;

bool isAccessChain(spv::Op op) { return op == spv::Op::OpAccessChain || op == spv::Op::OpInBoundsAccessChain; }

}  // namespace

bool Lowering::isConstantId(uint32_t id) const {
    const auto op = static_cast<uint32_t>(module_.definition(id).op);
    return op >= static_cast<uint32_t>(spv::Op::OpConstantTrue) && op <= static_cast<uint32_t>(spv::Op::OpSpecConstantOp);
}

/// The variable or parameter that a pointer comes from.
uint32_t Lowering::rootOf(uint32_t id) const {
    for (;;) {
        const Instruction inst = module_.definition(id);
        if (!isAccessChain(inst.op) && inst.op != spv::Op::OpCopyObject) return id;
        id = inst[3];
    }
}

/// What one access chain asks of its variable; the indices of the chains it starts from count too.
Lowering::Indexing Lowering::indexingOf(const Instruction& chain) const {
    Indexing result = Indexing::constant;
    Instruction base = module_.definition(chain[3]);
    while (base.op == spv::Op::OpCopyObject) base = module_.definition(base[3]);
    if (isAccessChain(base.op)) result = indexingOf(base);
    // From the pointer's type down, as the indices go.
    Instruction type = module_.definition(module_.definition(base[1])[3]);
    for (uint32_t word = 4; word < chain.count; ++word) {
        const bool constant = isConstantId(chain[word]);
        uint32_t count = 0;
        if (type.op == spv::Op::OpTypeStruct) {
            type = module_.definition(type[2 + module_.definition(chain[word])[3]]);
            continue;
        }
        if (type.op == spv::Op::OpTypeVector || type.op == spv::Op::OpTypeMatrix) {
            count = type[3];
        } else if (type.op == spv::Op::OpTypeArray && module_.definition(type[3]).op == spv::Op::OpConstant) {
            count = module_.definition(type[3])[3];
        }
        if (!constant) {
            const bool few = count != 0 && count <= kMaxChoices;
            result = result == Indexing::constant && few ? Indexing::choice : Indexing::memory;
        }
        type = module_.definition(type[2]);
    }
    return result;
}

void Lowering::classifyVariables() {
    std::vector<Instruction> calls;
    for (const Function& function : module_.functions()) {
        for (const SpirvBlock& block : function.blocks) {
            for (uint32_t offset = block.first; offset < block.end;) {
                const Instruction inst = module_.next(offset);
                if (inst.op == spv::Op::OpFunctionCall) calls.push_back(inst);
                if (!isAccessChain(inst.op)) continue;
                const uint32_t root = rootOf(inst[3]);
                if (root < indexing_.size()) indexing_[root] = std::max(indexing_[root], indexingOf(inst));
            }
        }
    }
    // From parameters to the arguments, as far as they go. An argument that is itself chosen among parts leaves no room for
    // another choice inside.
    for (bool changed = true; changed;) {
        changed = false;
        for (const Instruction& call : calls) {
            const Function* callee = module_.function(call[3]);
            if (callee == nullptr) continue;
            for (size_t i = 0; i < callee->parameters.size(); ++i) {
                const uint32_t argument = call[static_cast<uint32_t>(4 + i)], root = rootOf(argument);
                if (root >= indexing_.size()) continue;
                Indexing wanted = indexing_[callee->parameters[i]];
                const Instruction chain = module_.definition(argument);
                if (wanted != Indexing::constant && isAccessChain(chain.op) && indexingOf(chain) != Indexing::constant) {
                    wanted = Indexing::memory;
                }
                if (wanted <= indexing_[root]) continue;
                indexing_[root] = wanted;
                changed = true;
            }
        }
    }
}

}  // namespace vernier
