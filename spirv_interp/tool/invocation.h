// What an invocation, or the work-groups of a dispatch, is run with, as told on the command line.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "spirv_interp/reference/interpreter.h"
#include "spirv_interp/tool/image.h"

namespace vernier::tool {

struct Invocation {
    std::map<std::string, std::vector<std::string>> inputs;  // by name, "locationN" or built-in ("FragCoord")
    std::map<std::pair<uint32_t, uint32_t>, std::vector<std::byte>> buffers;  // by set and binding
    std::map<std::pair<uint32_t, uint32_t>, Image> images;
    std::vector<std::byte> pushConstants;
    std::array<uint32_t, 3> groups{1, 1, 1};
};

/// One setting: `name=1,2,3`, `buffer 0.1=f:1,2,3`, `image 0.2=4x2:f:1,2,3`, `push=f:1,2`, `groups=4,1,1`. Bytes are
/// h:, f: or d: floats of 16, 32 or 64 bits, b:, s:, i: (or u:) or l: integers of 8 to 64 bits, zero:N; images have
/// four f:, i: or u: for every texel, or zero:. Lines of a description file are settings; `#` begins a comment.
Status applySetting(const std::string& setting, Invocation& invocation);
Status readDescription(const std::string& path, Invocation& invocation);

/// The name of an interface variable: the module's, else "locationN" or the built-in's.
std::string variableName(const reference::InterfaceVariable& variable);
std::string builtinName(spv::BuiltIn builtin);

/// The inputs of an entry point. A name that no input has is an error that lists those there are.
template <class Number>
Result<reference::InterfaceValues<Number>> interfaceValues(const Invocation& invocation,
                                                           const reference::Module& module, size_t entryPoint);

}  // namespace vernier::tool
