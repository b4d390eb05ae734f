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

}  // namespace

HandlerTable handlerTable(Isa isa, MathTier tier) {
    HandlerTable table{};
    addArithmetic(isa, table);
    addFlow(isa, table);
    addLaneOps(isa, table);
    addWide(isa, table);
    addMemory(isa, table);
    addImages(table);
    addMath(isa, tier, table);
    return table;
}

CompiledProgram::CompiledProgram(const ir::Program& source, LoweredProgram lowered, const BatchOptions& options)
    : source_(source), masks_(maskFunctions(options.isa)) {
    const HandlerTable handlers = handlerTable(options.isa, options.tier);
    const Allocation batchRows = allocate(lowered.batch), drawRows = allocate(lowered.draw);
    const uint32_t lanes = options.lanes != 0 ? options.lanes : chooseLanes(batchRows.rows);
    batch_ = encode(lowered.batch, batchRows, lowered.scalars, handlers, lanes);
    draw_ = encode(lowered.draw, drawRows, lowered.scalars, handlers, kLaneGroup);
    scalars_ = lowered.scalars.initial();
    statistics_ = {batch_.instructions, draw_.instructions - 1, batch_.rows, lanes};
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
    if (options.isa > bestIsa()) {
        return unsupported("BatchOptions::isa is " + std::string(isaName(options.isa)) +
                           ", which this CPU does not have");
    }
    if (Status status = ir::verify(program); !status.ok()) return status.error();
    auto lowered = batch::lower(program);
    if (!lowered) return lowered.error();
    return std::shared_ptr<const BatchProgram>(
        std::make_shared<batch::CompiledProgram>(program, std::move(lowered).value(), options));
}

}  // namespace vernier
