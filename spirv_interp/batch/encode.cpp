// Machine code to Insts, and to text.
#include <algorithm>
#include <bit>
#include <cstdio>

#include "spirv_interp/batch/accumulate.h"
#include "spirv_interp/batch/compiled.h"
#include "spirv_interp/batch/select.h"

namespace vernier::batch {
namespace {

class Encoder {
  public:
    Encoder(const MachineCode& machine, const Allocation& allocation, const ScalarFile& scalars,
            const HandlerTables& handlers, uint32_t lanes, bool withListing)
        : machine_(machine),
          allocation_(allocation),
          scalars_(scalars),
          handlers_(handlers),
          lanes_(lanes),
          withListing_(withListing),
          rowLanes_(lanes > kLaneGroup ? handlers.fullLanes : kLaneGroup) {}

    Code run() {
        code_.lanes = lanes_;
        code_.rowLanes = rowLanes_;
        code_.rows = allocation_.rows;
        code_.masks = machine_.masks;
        code_.imageSites = machine_.imageSites;
        code_.indexedRows.resize(machine_.indexedRows);
        placeInsts();
        for (const MachineInst& inst : machine_.insts) {
            if (!inst.dead) encodeInst(inst);
        }
        for (const uint32_t reg : machine_.inputs) code_.inputs.push_back(rowOffset(reg));
        for (const uint32_t reg : machine_.outputs) code_.outputs.push_back(rowOffset(reg));
        return std::move(code_);
    }

  private:
    uint32_t rowOffset(uint32_t reg, uint32_t word = 0) const {
        if (reg == kNone || allocation_.row[reg] == kNone) return kNone;
        return (allocation_.row[reg] + word) * rowLanes_ * static_cast<uint32_t>(sizeof(uint32_t));
    }

    /// Where every machine instruction begins; a dead one is where the next begins.
    void placeInsts() {
        uint32_t place = 0;
        for (const MachineInst& inst : machine_.insts) {
            places_.push_back(place);
            if (!inst.dead) place += static_cast<uint32_t>(instsFor(inst.operands.size()));
        }
        places_.push_back(place);
    }

    void encodeInst(const MachineInst& inst) {
        const auto here = static_cast<uint32_t>(code_.narrow.size());
        const size_t count = instsFor(inst.operands.size());
        const size_t form = inst.op != Op::loadBuffer && stripShape(inst) ? formOf(inst).index() : inst.form;
        code_.narrow.resize(here + count);
        code_.narrow[here].handler = handlers_.narrow[static_cast<size_t>(inst.op)][form];
        for (size_t k = 0; k < inst.operands.size(); ++k) {
            code_.narrow[here + k / 4].operand[k % 4] = encodeOperand(inst.operands[k], here);
        }
        if (rowLanes_ > kLaneGroup) {
            code_.full.insert(code_.full.end(), code_.narrow.end() - static_cast<ptrdiff_t>(count), code_.narrow.end());
            code_.full[here].handler = handlers_.full[static_cast<size_t>(inst.op)][form];
        }
        fillSideTable(inst);
        ++code_.instructions;
        if (withListing_) list(inst, here);
    }

    uint32_t encodeOperand(const Operand& operand, uint32_t here) const {
        switch (operand.kind) {
            case Operand::Kind::none:
            case Operand::Kind::accumulator:
                return kNone;
            case Operand::Kind::row:
                return rowOffset(operand.id, operand.word);
            case Operand::Kind::label:
                return places_[machine_.labels[operand.id]] - here;
            case Operand::Kind::scalar:
            case Operand::Kind::mask:
            case Operand::Kind::number:
                break;
        }
        return operand.id;
    }

    void fillSideTable(const MachineInst& inst) {
        size_t k = 0;
        const auto next = [&] {
            const Operand& operand = inst.hidden[k++];
            return operand.isRow() ? rowOffset(operand.id, operand.word) : kNone;
        };
        if (inst.op == Op::image) {
            forEachRow(code_.imageSites[inst.operands[0].id], [&](uint32_t& row) { row = next(); });
        } else if (inst.op == Op::inputIndexed) {
            for (uint32_t row = 0; row < inst.hidden.size(); ++row) {
                code_.indexedRows[inst.operands[2].id + row] = next();
            }
        }
    }

    std::string nameOf(const Operand& operand) const {
        const auto number = [](const char* prefix, uint64_t value) { return prefix + std::to_string(value); };
        switch (operand.kind) {
            case Operand::Kind::none:
                return "-";
            case Operand::Kind::accumulator:
                return "acc";
            case Operand::Kind::row:
                return number("r", allocation_.row[operand.id] + operand.word);
            case Operand::Kind::mask:
                return number("m", operand.id);
            case Operand::Kind::label:
                return number("@", places_[machine_.labels[operand.id]]);
            case Operand::Kind::number:
                return std::to_string(operand.id);
            case Operand::Kind::scalar:
                break;
        }
        if (!scalars_.isConstant(operand.id)) return number("s", operand.id);
        char text[16];
        std::snprintf(text, sizeof text, "0x%08x", scalars_.initial()[operand.id]);
        return text;
    }

    void list(const MachineInst& inst, uint32_t here) {
        char place[16];
        std::snprintf(place, sizeof place, "%5u  ", here);
        code_.listing += place;
        code_.listing += opName(inst.op);
        const char* separator = " ";
        for (const Operand& operand : inst.operands) {
            code_.listing += separator + nameOf(operand);
            separator = ", ";
        }
        if (!inst.hidden.empty()) {
            code_.listing += " (";
            separator = "";
            for (const Operand& operand : inst.hidden) {
                code_.listing += separator + nameOf(operand);
                separator = " ";
            }
            code_.listing += ")";
        }
        code_.listing += '\n';
    }

    const MachineCode& machine_;
    const Allocation& allocation_;
    const ScalarFile& scalars_;
    const HandlerTables& handlers_;
    const uint32_t lanes_;
    const bool withListing_;
    const uint32_t rowLanes_;
    std::vector<uint32_t> places_;
    Code code_;
};

}  // namespace

Code encode(const MachineCode& machine, const Allocation& allocation, const ScalarFile& scalars,
            const HandlerTables& handlers, uint32_t lanes, bool withListing) {
    return Encoder(machine, allocation, scalars, handlers, lanes, withListing).run();
}

}  // namespace vernier::batch
