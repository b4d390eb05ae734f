// Reads the text form that print.h describes.
#pragma once

#include <string_view>

#include "base/result.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// The program, or an invalidArgument Error naming the line and what was expected. The result has the shape of the
/// text; whether it makes sense is verify()'s to say.
Result<Program> parse(std::string_view text);

}  // namespace vernier::ir
