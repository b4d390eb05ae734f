// Which variables can be SSA values and which need memory: by the indices of the access chains that reach them, also
// through calls. Runs on the words of the module, before types are known.
#include <algorithm>

#include "spirv_interp/front/lowering.h"

namespace vernier {
namespace {

// A choice among n values takes n - 1 compares and selects for each scalar; beyond this many, memory is cheaper.
constexpr uint32_t kMaxChoices = 8;

bool isAccessChain(spv::Op op) {
    return op == spv::Op::OpAccessChain || op == spv::Op::OpInBoundsAccessChain;
}

}  // namespace

bool Lowering::isConstantId(uint32_t id) const {
    const auto op = static_cast<uint32_t>(module_.definition(id).op);
    return op >= static_cast<uint32_t>(spv::Op::OpConstantTrue) &&
           op <= static_cast<uint32_t>(spv::Op::OpSpecConstantOp);
}

/// What one access chain asks of its variable, beyond what the pointer it starts from has asked already.
Lowering::Indexing Lowering::indexingOf(const Instruction& chain, Indexing before) const {
    Indexing result = before;
    // From the pointer's type down, as the indices go.
    Instruction type = module_.definition(module_.definition(module_.definition(chain[3])[1])[3]);
    for (uint32_t word = 4; word < chain.count; ++word) {
        if (type.op == spv::Op::OpTypeStruct) {
            type = module_.definition(type[2 + module_.definition(chain[word])[3]]);
            continue;
        }
        uint32_t count = 0;
        if (type.op == spv::Op::OpTypeVector || type.op == spv::Op::OpTypeMatrix) {
            count = type[3];
        } else if (type.op == spv::Op::OpTypeArray && module_.definition(type[3]).op == spv::Op::OpConstant) {
            count = module_.definition(type[3])[3];
        }
        if (!isConstantId(chain[word])) {
            const bool few = count != 0 && count <= kMaxChoices;
            result = result == Indexing::constant && few ? Indexing::choice : Indexing::memory;
        }
        type = module_.definition(type[2]);
    }
    return result;
}

void Lowering::classifyVariables() {
    // By id of a pointer: the variable or parameter it comes from, and how it was indexed on the way. A pointer's
    // definition stands before its uses in the module.
    struct Origin {
        uint32_t root = 0;
        Indexing indexing = Indexing::constant;
    };
    std::vector<Origin> origins(module_.bound());
    const auto originOf = [&](uint32_t id) {
        return id < origins.size() && origins[id].root != 0 ? origins[id] : Origin{id, Indexing::constant};
    };
    std::vector<Instruction> calls;
    for (const Function& function : module_.functions()) {
        for (const SpirvBlock& block : function.blocks) {
            for (uint32_t offset = block.first; offset < block.end;) {
                const Instruction inst = module_.next(offset);
                if (inst.op == spv::Op::OpFunctionCall) calls.push_back(inst);
                if (!isAccessChain(inst.op) && inst.op != spv::Op::OpCopyObject) continue;
                Origin origin = originOf(inst[3]);
                if (isAccessChain(inst.op)) origin.indexing = indexingOf(inst, origin.indexing);
                origins[inst[2]] = origin;
                if (origin.root < indexing_.size()) {
                    indexing_[origin.root] = std::max(indexing_[origin.root], origin.indexing);
                }
            }
        }
    }
    // From parameters to the arguments, as far as they go. An argument that is itself chosen among parts leaves no room
    // for another choice inside.
    for (bool changed = true; changed;) {
        changed = false;
        for (const Instruction& call : calls) {
            const Function* callee = module_.function(call[3]);
            if (callee == nullptr) continue;
            for (size_t i = 0; i < callee->parameters.size(); ++i) {
                const Origin origin = originOf(call[static_cast<uint32_t>(4 + i)]);
                Indexing wanted = indexing_[callee->parameters[i]];
                if (wanted != Indexing::constant && origin.indexing != Indexing::constant) wanted = Indexing::memory;
                if (origin.root >= indexing_.size() || wanted <= indexing_[origin.root]) continue;
                indexing_[origin.root] = wanted;
                changed = true;
            }
        }
    }
}

}  // namespace vernier
