// Which resources of a program are of the application, and come by descriptors.
#pragma once

#include "spirv_interp/ir/ops.h"
#include "spirv_interp/program.h"

namespace vernier {

/// Push constants come by commands; memory of the runner (work-groups, stages that put out vertices) by whoever runs
/// the program.
inline bool needsDescriptor(const ir::Resource& resource) {
    return resource.kind != ir::ResourceKind::pushConstants && !ir::isOfRunner(resource.kind);
}

}  // namespace vernier
