// Executed instructions as text: values by name and source line.
#pragma once

#include <string>

#include "spirv_interp/reference/interpreter.h"

namespace vernier::tool {

/// "name" or "%12"; ids that hide variables show them as they are called in the source.
std::string idName(const reference::Module& module, uint32_t id);

/// The opcode's name; for an OpExtInst that of the GLSL.std.450 function.
std::string operationName(const reference::Step& step);

/// The scalars of a step in brackets: "(0.5, 1)", or one without.
std::string valueText(const reference::Step& step);

/// "line 12  %31 = OpFMul uv %14    (0.5, 1)"
std::string stepText(const reference::Module& module, const reference::Step& step);

}  // namespace vernier::tool
