#include "spirv_interp/ir/place_vertices.h"

#include <algorithm>

#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/optimise.h"

namespace vernier::ir {
namespace {

class Placer {
  public:
    explicit Placer(Program& program) : program_(program) {}

    void run() {
        const uint32_t words = wordsOfVertex(program_);
        constexpr uint32_t kPitch = kVertexLanes * sizeof(uint32_t);
        resource_ = static_cast<uint32_t>(program_.resources.size());
        Resource& memory = program_.resources.emplace_back();
        memory.kind = ResourceKind::stageMemory;
        memory.byteSize = program_.geometry.outputVertices * words * kPitch;

        std::vector<Inst> first;
        zero_ = leaf(first, Op::constant, 0);
        const ValueId vertexBytes = leaf(first, Op::constant, uint64_t{words} * kPitch);
        std::vector<ValueId> outputOffsets;
        for (uint32_t k = 0; k < words; ++k) outputOffsets.push_back(leaf(first, Op::constant, uint64_t{k} * kPitch));
        InterfaceSlot offset;
        offset.builtin = Builtin::stageOffset;
        offset.type = Type::i32;
        program_.inputs.push_back(offset);
        const ValueId lane = leaf(first, Op::input, program_.inputs.size() - 1);
        program_.blocks[0].insts.insert(program_.blocks[0].insts.begin(), first.begin(), first.end());

        for (Block& block : program_.blocks) {
            std::vector<Inst> insts;
            insts.reserve(block.insts.size());
            for (const Inst& inst : block.insts) {
                if (inst.op != Op::storeVertex) {
                    insts.push_back(inst);
                    continue;
                }
                const ValueId vertex = program_.operandsOf(inst)[0], value = program_.operandsOf(inst)[1];
                const ValueId row = binary(insts, Op::imul, vertex, vertexBytes);
                const ValueId place =
                    binary(insts, Op::iadd, binary(insts, Op::iadd, row, lane), outputOffsets[inst.imm]);
                Inst store = withOperands(Op::storeBuffer, {zero_, place, value});
                store.imm = resource_;
                store.line = inst.line;
                store.file = inst.file;
                insts.push_back(store);
            }
            block.insts = std::move(insts);
        }
    }

  private:
    ValueId leaf(std::vector<Inst>& insts, Op op, uint64_t imm) {
        Inst inst;
        inst.op = op;
        inst.type = Type::i32;
        inst.imm = imm;
        inst.result = program_.newValue(Type::i32);
        insts.push_back(inst);
        return inst.result;
    }
    Inst withOperands(Op op, std::initializer_list<ValueId> operands) {
        Inst inst;
        inst.op = op;
        inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
        inst.operandCount = static_cast<uint16_t>(operands.size());
        program_.operands.insert(program_.operands.end(), operands);
        return inst;
    }
    ValueId binary(std::vector<Inst>& insts, Op op, ValueId a, ValueId b) {
        Inst inst = withOperands(op, {a, b});
        inst.type = Type::i32;
        inst.result = program_.newValue(Type::i32);
        insts.push_back(inst);
        return inst.result;
    }

    Program& program_;
    uint32_t resource_ = 0;
    ValueId zero_ = kNoValue;
};

}  // namespace

void placeVertices(Program& program) {
    Placer(program).run();
    optimise(program);
}

}  // namespace vernier::ir
