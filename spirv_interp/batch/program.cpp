#include "spirv_interp/program.h"

#include <algorithm>

#include "spirv_interp/batch/compiled.h"
#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/batch/schedule.h"
#include "spirv_interp/ir/verify.h"
#include "spirv_interp/prepare.h"

namespace vernier {
namespace batch {
namespace {

HandlerTables makeTables(Isa isa, MathTier tier) {
    HandlerTables tables;
    addFloatOps(isa, tables);
    addIntegerOps(isa, tables);
    addFusedOps(isa, tables);
    addFlow(isa, tables);
    addLaneOps(isa, tables);
    addWide(isa, tables);
    addMemory(isa, tables);
    addAtomics(isa, tables);
    addMath(isa, tier, tables);
    return tables;
}

template <Isa kIsa, MathTier kTier>
const HandlerTables& tablesFor() {
    static const HandlerTables tables = makeTables(kIsa, kTier);
    return tables;
}

template <Isa kIsa>
const HandlerTables& tablesFor(MathTier tier) {
    switch (tier) {
        case MathTier::fast:
            return tablesFor<kIsa, MathTier::fast>();
        case MathTier::standard:
            return tablesFor<kIsa, MathTier::standard>();
        case MathTier::fine:
            return tablesFor<kIsa, MathTier::fine>();
        case MathTier::reference:
            break;
    }
    return tablesFor<kIsa, MathTier::reference>();
}

uint32_t workGroupSize(const ir::Program& program) {
    return program.localSize[0] * program.localSize[1] * program.localSize[2];
}

/// A batch holds whole subgroups.
uint32_t leastLanes(const ir::Program& program) {
    return program.usesSubgroups ? ir::kSubgroupSize : kLaneGroup;
}

/// Whether work-groups may share a batch: nothing in them looks at other invocations. And there must be room for two.
bool packs(const ir::Program& program, uint32_t lanes) {
    if (program.stage != ir::Stage::compute || program.hasBarriers || program.usesSubgroups) return false;
    const bool shares = std::any_of(program.resources.begin(), program.resources.end(),
                                    [](const ir::Resource& r) { return r.kind == ir::ResourceKind::workgroupMemory; });
    return !shares && workGroupSize(program) * 2 <= lanes;
}

/// Puts a countBlock in front of every block, up to `most` of them.
void countBlocks(MachineCode& code, size_t most) {
    std::vector<bool> begins(code.insts.size() + 1);
    for (const uint32_t label : code.labels) begins[label] = true;
    std::vector<MachineInst> counted;
    std::vector<uint32_t> moved;  // by position: where it is now
    uint32_t blocks = 0;
    bool follows = true;  // a jump, or nothing
    for (size_t k = 0; k < code.insts.size(); ++k) {
        moved.push_back(static_cast<uint32_t>(counted.size()));
        if ((begins[k] || follows) && blocks < most) {
            MachineInst count;
            count.op = Op::countBlock;
            count.operands = {Operand::number(blocks++)};
            counted.push_back(std::move(count));
        }
        MachineInst& inst = code.insts[k];
        follows = std::any_of(inst.operands.begin(), inst.operands.end(),
                              [](const Operand& operand) { return operand.kind == Operand::Kind::label; });
        counted.push_back(std::move(inst));
    }
    moved.push_back(static_cast<uint32_t>(counted.size()));
    for (uint32_t& label : code.labels) label = moved[label];
    code.insts = std::move(counted);
}

/// The lanes of a batch: as many as were asked for and the instruction set has.
uint32_t lanesFor(const BatchOptions& options) {
    const uint32_t full = handlerTables(options.isa, options.tier).fullLanes;
    return options.lanes == 0 ? full : std::min(options.lanes, full);
}

}  // namespace

const HandlerTables& handlerTables(Isa isa, MathTier tier) {
#define VERNIER_TABLES_CASE(name, target, ...) \
    case Isa::name:                            \
        return tablesFor<Isa::name>(tier);
    switch (isa) { VERNIER_ISAS(VERNIER_TABLES_CASE) }
#undef VERNIER_TABLES_CASE
    return tablesFor<kLowestIsa>(tier);
}

CompiledProgram::CompiledProgram(ir::Program source, LoweredProgram lowered, const BatchOptions& options, bool packed,
                                 bool withListing)
    : source_(std::move(source)),
      options_(options),
      handlers_(handlerTables(options.isa, options.tier)),
      packed_(packed),
      masks_(maskFunctions(options.isa)) {
    uint32_t lanes = lanesFor(options);
    if (options.lanes == 0 && source_.stage == ir::Stage::compute && !packed) {
        // No wider than a work-group needs that has its batches for itself.
        while (lanes > leastLanes(source_) && lanes / 2 >= workGroupSize(source_)) lanes /= 2;
    }
    const auto encodePiece = [&](MachineCode& code, uint32_t most) {
        schedule(code);
        const Allocation allocation = allocate(code, handlers_.narrow);
        if (&code == &lowered.batch && !options.blockRuns.empty()) countBlocks(code, options.blockRuns.size());
        return encode(code, allocation, lowered.scalars, handlers_, most, withListing);
    };
    batch_ = encodePiece(lowered.batch, lanes);
    workGroup_ = encodePiece(lowered.workGroup, kLaneGroup);
    draw_ = encodePiece(lowered.draw, kLaneGroup);
    scalars_ = lowered.scalars.initial();
    inputScalars_ = std::move(lowered.inputScalars);
    statistics_ = {batch_.instructions, draw_.instructions - 1, batch_.rows, lanes, workGroup_.instructions - 1};
}

std::string CompiledProgram::disassemble() const {
    // It was lowered before: it can be.
    return CompiledProgram(source_, lower(source_, packed_).value(), options_, packed_, true).text();
}

std::string CompiledProgram::text() const {
    std::string text = "registers " + std::to_string(batch_.rows) + "\n";
    const auto list = [&](const char* name, const std::vector<uint32_t>& rows) {
        for (size_t k = 0; k < rows.size(); ++k) {
            if (rows[k] == kNone) continue;
            text +=
                name + std::to_string(k) + " r" + std::to_string(rows[k] / (batch_.rowLanes * sizeof(uint32_t))) + "\n";
        }
    };
    list("input ", batch_.inputs);
    list("output ", batch_.outputs);
    if (draw_.instructions > 1) text += "draw:\n" + draw_.listing;
    if (workGroup_.instructions > 1) text += "work-group:\n" + workGroup_.listing;
    return text + "batch:\n" + batch_.listing;
}

}  // namespace batch

void prepareBatches(Isa isa, MathTier tier) {
    batch::handlerTables(isa, tier);
}

Result<std::shared_ptr<const BatchProgram>> BatchProgram::compile(ir::Program program, const BatchOptions& options) {
    constexpr uint32_t kLanes[] = {0, 16, 32, 64, 128};
    if (std::find(std::begin(kLanes), std::end(kLanes), options.lanes) == std::end(kLanes)) {
        return invalidArgument("BatchOptions::lanes is " + std::to_string(options.lanes) +
                               "; it must be 0, 16, 32, 64 or 128");
    }
    if (options.lanes != 0 && options.lanes < batch::leastLanes(program)) {
        return invalidArgument("BatchOptions::lanes is " + std::to_string(options.lanes) + "; '" + program.name +
                               "' uses subgroups, which have " + std::to_string(ir::kSubgroupSize) + " invocations");
    }
    if (options.isa > bestIsa()) {
        return unsupported("BatchOptions::isa is " + std::string(isaName(options.isa)) +
                           ", which this CPU does not have");
    }
    if (!options.verified) {
        if (Status status = ir::verify(program); !status.ok()) return status.error();
    }
    const bool packed = batch::packs(program, batch::lanesFor(options));
    auto lowered = batch::lower(program, packed);
    if (!lowered) return lowered.error();
    return std::shared_ptr<const BatchProgram>(
        std::make_shared<batch::CompiledProgram>(std::move(program), std::move(lowered).value(), options, packed));
}

}  // namespace vernier
