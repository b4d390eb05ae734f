#include "spirv_interp/program.h"

#include <algorithm>

#include "spirv_interp/batch/compiled.h"
#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/ir/verify.h"

namespace vernier {
namespace batch {
namespace {

/// The registers of a batch should stay under half of the first-level cache.
uint32_t chooseLanes(uint32_t rows) {
    constexpr uint32_t kBytes = 16 * 1024;
    for (const uint32_t lanes : {64u, 32u}) {
        if (rows * lanes * sizeof(uint32_t) <= kBytes) return lanes;
    }
    return kLaneGroup;
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
    constexpr uint32_t kUsual = 64;
    if (program.stage != ir::Stage::compute || program.hasBarriers || program.usesSubgroups) return false;
    const bool shares = std::any_of(program.resources.begin(), program.resources.end(),
                                    [](const ir::Resource& r) { return r.kind == ir::ResourceKind::workgroupMemory; });
    return !shares && workGroupSize(program) * 2 <= (lanes != 0 ? lanes : kUsual);
}

}  // namespace

HandlerTable handlerTable(Isa isa, MathTier tier) {
    HandlerTable table{};
    addArithmetic(isa, table);
    addBarriers(table);
    addSubgroups(table);
    addFlow(isa, table);
    addLaneOps(isa, table);
    addWide(isa, table);
    addMemory(isa, table);
    addAtomics(isa, table);
    addImages(table);
    addMath(isa, tier, table);
    return table;
}

CompiledProgram::CompiledProgram(const ir::Program& source, LoweredProgram lowered, const BatchOptions& options,
                                 bool packed)
    : source_(source), packed_(packed), masks_(maskFunctions(options.isa)) {
    const HandlerTable handlers = handlerTable(options.isa, options.tier);
    const Allocation batchRows = allocate(lowered.batch);
    uint32_t lanes = options.lanes;
    if (lanes == 0) {
        const uint32_t size = workGroupSize(source);
        lanes = std::max(chooseLanes(batchRows.rows), leastLanes(source));
        if (source.stage == ir::Stage::compute && !packed) {
            // No wider than a work-group needs that has its batches for itself.
            while (lanes > leastLanes(source) && lanes / 2 >= size) lanes /= 2;
        }
        while (packed && lanes < size) lanes *= 2;
    }
    const auto encodeStraight = [&](MachineCode& code) {
        return encode(code, allocate(code), lowered.scalars, handlers, kLaneGroup);
    };
    batch_ = encode(lowered.batch, batchRows, lowered.scalars, handlers, lanes);
    workGroup_ = encodeStraight(lowered.workGroup);
    draw_ = encodeStraight(lowered.draw);
    scalars_ = lowered.scalars.initial();
    inputScalars_ = std::move(lowered.inputScalars);
    statistics_ = {batch_.instructions, draw_.instructions - 1, batch_.rows, lanes, workGroup_.instructions - 1};
}

std::string CompiledProgram::disassemble() const {
    std::string text = "registers " + std::to_string(batch_.rows) + "\n";
    const auto list = [&](const char* name, const std::vector<uint32_t>& rows) {
        for (size_t k = 0; k < rows.size(); ++k) {
            if (rows[k] == kNone) continue;
            text +=
                name + std::to_string(k) + " r" + std::to_string(rows[k] / (batch_.lanes * sizeof(uint32_t))) + "\n";
        }
    };
    list("input ", batch_.inputs);
    list("output ", batch_.outputs);
    if (draw_.instructions > 1) text += "draw:\n" + draw_.listing;
    if (workGroup_.instructions > 1) text += "work-group:\n" + workGroup_.listing;
    return text + "batch:\n" + batch_.listing;
}

}  // namespace batch

Result<std::shared_ptr<const BatchProgram>> BatchProgram::compile(const ir::Program& program,
                                                                  const BatchOptions& options) {
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
    if (Status status = ir::verify(program); !status.ok()) return status.error();
    const bool packed = batch::packs(program, options.lanes);
    auto lowered = batch::lower(program, packed);
    if (!lowered) return lowered.error();
    return std::shared_ptr<const BatchProgram>(
        std::make_shared<batch::CompiledProgram>(program, std::move(lowered).value(), options, packed));
}

}  // namespace vernier
