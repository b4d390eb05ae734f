// What BatchProgram::compile makes, for BatchContext.
#pragma once

#include <string>
#include <vector>

#include "spirv_interp/batch/allocate.h"
#include "spirv_interp/batch/lower.h"
#include "spirv_interp/program.h"

namespace vernier::batch {

/// One piece of code, ready to run on `lanes` lanes.
struct Code {
    std::vector<Inst> insts;
    uint32_t lanes = 0;
    uint32_t rows = 0;
    uint32_t masks = 0;
    uint32_t instructions = 0;
    std::vector<uint32_t> inputs, outputs;  // byte offset of the row by interface slot, or kNone
    std::vector<ImageSite> imageSites;
    std::vector<uint32_t> indexedRows;
    std::string listing;
};

/// Encodes machine code for a batch of `lanes` lanes.
Code encode(const MachineCode& machine, const Allocation& allocation, const ScalarFile& scalars,
            const HandlerTable& handlers, uint32_t lanes);

class CompiledProgram final : public BatchProgram {
  public:
    CompiledProgram(const ir::Program& source, LoweredProgram lowered, const BatchOptions& options, bool packed);

    const BatchStatistics& statistics() const override { return statistics_; }
    std::string disassemble() const override;

    const ir::Program& source() const { return source_; }
    const Code& batch() const { return batch_; }
    const Code& workGroup() const { return workGroup_; }
    const Code& draw() const { return draw_; }
    const std::vector<uint32_t>& scalars() const { return scalars_; }
    /// By Program::inputs: the scalar that is its value, or kNone.
    const std::vector<uint32_t>& inputScalars() const { return inputScalars_; }
    /// A batch holds several work-groups if it has room for them.
    bool packed() const { return packed_; }
    const MaskFunctions& masks() const { return masks_; }

  private:
    ir::Program source_;
    Code batch_, workGroup_, draw_;
    std::vector<uint32_t> scalars_, inputScalars_;
    bool packed_ = false;
    MaskFunctions masks_;
    BatchStatistics statistics_;
};

}  // namespace vernier::batch
