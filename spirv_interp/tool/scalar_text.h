// Values as text: scalars by their type, and what a run has changed in its buffers.
#pragma once

#include <string>

#include "spirv_interp/tool/invocation.h"

namespace vernier::tool {

/// `bits` are those of the type, in the low bits; those of a boolean are 0 or not.
std::string scalarText(reference::ScalarKind kind, uint64_t bits);

/// Prints the scalars of buffers that differ, each by its name in the block that the module declares.
void printChanges(const reference::Module& module, const Invocation& before, const Invocation& after);

}  // namespace vernier::tool
