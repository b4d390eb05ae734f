// Memory without a descriptor: of a work-group, or of who runs a stage.
#pragma once

#include <vector>

#include "spirv_interp/batch/run_state.h"

namespace vernier::batch {

/// What the resources of a program without descriptors (ir::isOfRunner) stand for, zeroed at first, and the bindings of
/// draws with it among them. It does not move: what bind() gives points into it.
class OwnMemory {
  public:
    explicit OwnMemory(const ir::Program& program);
    OwnMemory(const OwnMemory&) = delete;
    OwnMemory& operator=(const OwnMemory&) = delete;

    uint32_t* words() { return memory_.get(); }
    const uint32_t* words() const { return memory_.get(); }
    uint32_t wordCount() const { return wordCount_; }

    /// Valid until the next call. Those given, if the program has no such memory.
    ResourceBindings bind(const ResourceBindings& given);

  private:
    const ir::Program& program_;
    const uint32_t wordCount_;
    Words memory_;
    std::vector<BufferBinding> buffers_;
    std::vector<uint32_t> bases_, counts_;
};

}  // namespace vernier::batch
