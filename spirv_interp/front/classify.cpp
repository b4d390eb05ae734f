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

/// Whether values of this pointer type may be chosen at run time: pointers into storage buffers and work-group memory.
bool Lowering::isBufferPointer(uint32_t typeId) const {
    const Instruction type = module_.definition(typeId);
    if (type.op != spv::Op::OpTypePointer) return false;
    const auto storage = static_cast<spv::StorageClass>(type[2]);
    return storage == spv::StorageClass::StorageBuffer || storage == spv::StorageClass::Workgroup;
}

/// Pointers that may hold each other's values are put into one class (Steensgaard, "Points-to Analysis in Almost Linear
/// Time", POPL 1996). What a variable holds stands for itself behind the ids: its id plus the bound. So do a function's
/// results.
void Lowering::classifyPointers() {
    const uint32_t bound = module_.bound();
    pointerClass_.resize(2 * size_t{bound});
    for (uint32_t id = 0; id < pointerClass_.size(); ++id) pointerClass_[id] = id;
    const auto find = [this](uint32_t id) {
        while (pointerClass_[id] != id) id = pointerClass_[id] = pointerClass_[pointerClass_[id]];
        return id;
    };
    const auto join = [&](uint32_t a, uint32_t b) {
        if (a < pointerClass_.size() && b < pointerClass_.size()) pointerClass_[find(a)] = find(b);
    };
    // The variable or parameter that a pointer to memory of the invocation's own comes from.
    std::vector<uint32_t> origin(bound);
    const auto contents = [&](uint32_t id) { return bound + (id < bound && origin[id] != 0 ? origin[id] : id); };
    const auto visit = [&](const Instruction& inst, const Function& function) {
        switch (inst.op) {
            case spv::Op::OpAccessChain:
            case spv::Op::OpInBoundsAccessChain:
            case spv::Op::OpPtrAccessChain:
            case spv::Op::OpInBoundsPtrAccessChain:
            case spv::Op::OpCopyObject:
            case spv::Op::OpCopyLogical:
                join(inst[2], inst[3]);
                if (inst[2] < bound && inst[3] < bound)
                    origin[inst[2]] = origin[inst[3]] != 0 ? origin[inst[3]] : inst[3];
                break;
            case spv::Op::OpPhi:
                for (uint32_t word = 3; word + 1 < inst.count; word += 2) join(inst[2], inst[word]);
                break;
            case spv::Op::OpSelect:
                join(inst[2], inst[4]);
                join(inst[2], inst[5]);
                break;
            case spv::Op::OpPtrEqual:
            case spv::Op::OpPtrNotEqual:
            case spv::Op::OpPtrDiff:
                join(inst[3], inst[4]);
                break;
            case spv::Op::OpCompositeConstruct:
                for (uint32_t word = 3; word < inst.count; ++word) join(inst[2], inst[word]);
                break;
            case spv::Op::OpCompositeInsert:
                join(inst[2], inst[4]);
                join(inst[2], inst[3]);
                break;
            case spv::Op::OpCompositeExtract:
                join(inst[2], inst[3]);
                break;
            case spv::Op::OpLoad:
                join(inst[2], contents(inst[3]));
                break;
            case spv::Op::OpStore:
                join(contents(inst[1]), inst[2]);
                break;
            case spv::Op::OpCopyMemory:
                join(contents(inst[1]), contents(inst[2]));
                break;
            case spv::Op::OpReturnValue:
                join(bound + function.id, inst[1]);
                break;
            case spv::Op::OpFunctionCall:
                join(inst[2], bound + inst[3]);
                if (const Function* callee = module_.function(inst[3])) {
                    for (uint32_t i = 0; i < callee->parameters.size(); ++i) {
                        join(callee->parameters[i], inst[4 + i]);
                        join(contents(callee->parameters[i]), contents(inst[4 + i]));
                    }
                }
                break;
            default:
                break;
        }
    };
    for (const Function& function : module_.functions()) {
        for (const SpirvBlock& block : function.blocks) {
            for (uint32_t offset = block.first; offset < block.end;) visit(module_.next(offset), function);
        }
    }
    classVariable_.assign(pointerClass_.size(), 0);
    for (uint32_t id = 0; id < pointerClass_.size(); ++id) pointerClass_[id] = find(id);
    for (uint32_t offset = Module::kFirstInstruction; offset < module_.globalsEnd();) {
        const Instruction inst = module_.next(offset);
        // An initialiser is a constant or a global variable.
        if (inst.op == spv::Op::OpVariable && isBufferPointer(inst[1])) {
            // All variables of work-group memory share one resource: any of them stands for the others.
            const bool shared = static_cast<spv::StorageClass>(inst[3]) == spv::StorageClass::Workgroup;
            uint32_t& variable = classVariable_[pointerClass_[inst[2]]];
            variable = variable == 0 || shared ? inst[2] : kSeveral;
            const Instruction pointer = module_.definition(inst[1]);
            workgroupBlocks_ =
                workgroupBlocks_ || (shared && module_.hasDecoration(pointer[3], spv::Decoration::Block));
        }
    }
}

/// The only buffer variable that pointers of the class point into; kSeveral when there is no such one.
uint32_t Lowering::onlyVariableOf(uint32_t pointer) const {
    const uint32_t variable = classVariable_[pointerClass_[pointer]];
    return variable == 0 ? kSeveral : variable;
}

}  // namespace vernier
