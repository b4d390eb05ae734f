// What BatchProgram::compile makes, for BatchContext.
#pragma once

#include <string>
#include <vector>

#include "spirv_interp/batch/allocate.h"
#include "spirv_interp/batch/lower.h"
#include "spirv_interp/program.h"

namespace vernier::batch {

/// One piece of code, ready to run on up to `lanes` lanes.
struct Code {
    std::vector<Inst> full, narrow;  // for runs of more than one lane group (if `lanes` is more), and of one
    uint32_t lanes = 0;
    uint32_t rowLanes = 0;  // from a row to the next: a full strip, or one lane group
    uint32_t rows = 0;
    uint32_t masks = 0;
    uint32_t instructions = 0;
    std::vector<uint32_t> inputs, outputs;  // byte offset of the row by interface slot, or kNone
    std::vector<ImageSite> imageSites;
    std::vector<uint32_t> indexedRows;
    std::string listing;  // where one was asked for
};

/// Encodes machine code for batches of up to `lanes` lanes. A listing is for disassemble() alone: making it takes time.
Code encode(const MachineCode& machine, const Allocation& allocation, const ScalarFile& scalars,
            const HandlerTables& handlers, uint32_t lanes, bool withListing);

class CompiledProgram final : public BatchProgram {
  public:
    CompiledProgram(ir::Program source, LoweredProgram lowered, const BatchOptions& options, bool packed,
                    bool withListing = false);

    const ir::Program& source() const override { return source_; }
    const BatchStatistics& statistics() const override { return statistics_; }
    /// Compiles once more, with listings.
    std::string disassemble() const override;

    const BatchOptions& options() const { return options_; }
    const Code& batch() const { return batch_; }
    const Code& workGroup() const { return workGroup_; }
    const Code& draw() const { return draw_; }
    const std::vector<uint32_t>& scalars() const { return scalars_; }
    /// By Program::inputs: the scalar that is its value, or kNone.
    const std::vector<uint32_t>& inputScalars() const { return inputScalars_; }
    /// A batch holds several work-groups if it has room for them.
    bool packed() const { return packed_; }
    const MaskFunctions& masks() const { return masks_; }
    uint64_t* blockRuns() const { return options_.blockRuns.data(); }
    /// Where a piece begins for the lanes of a frame, and how it runs from there.
    static const Inst* beginning(const Frame& frame, const Code& code) {
        return frame.lanes > kLaneGroup ? code.full.data() : code.narrow.data();
    }
    void execute(Frame& frame, const Inst* at) const {
        (frame.lanes > kLaneGroup ? handlers_.executeFull : handlers_.executeNarrow)(frame, at);
    }

  private:
    std::string text() const;

    ir::Program source_;
    BatchOptions options_;
    const HandlerTables& handlers_;
    Code batch_, workGroup_, draw_;
    std::vector<uint32_t> scalars_, inputScalars_;
    bool packed_ = false;
    MaskFunctions masks_;
    BatchStatistics statistics_;
};

}  // namespace vernier::batch
