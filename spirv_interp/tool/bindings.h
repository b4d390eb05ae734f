// The descriptors of a program over the buffers and images of an invocation, for the batch engine.
#pragma once

#include <vector>

#include "spirv_interp/ir/ir.h"
#include "spirv_interp/resources.h"
#include "spirv_interp/tool/invocation.h"

namespace vernier::tool {

/// Points into the invocation, which is written to and stays where it is. What is not there reads as zero.
class Bindings {
  public:
    Bindings(const ir::Program& program, Invocation& invocation);
    ResourceBindings get() const;

  private:
    BufferBinding bufferOf(const ir::Resource& resource, Invocation& invocation) const;

    std::vector<BufferBinding> buffers_;
    std::vector<ImageBinding> images_;
    std::vector<const void*> samplers_;
    std::vector<uint32_t> base_, count_;
};

}  // namespace vernier::tool
