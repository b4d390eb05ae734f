// What an invocation, or the work-groups of a dispatch, is run with, as told on the command line.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "spirv_interp/reference/interpreter.h"

namespace vernier::tool {

struct Invocation {
    std::map<std::string, std::vector<std::string>> inputs;  // by name, "locationN" or built-in ("FragCoord")
    std::map<std::pair<uint32_t, uint32_t>, std::vector<std::byte>> buffers;  // by set and binding
    std::vector<std::byte> pushConstants;
    std::array<uint32_t, 3> groups{1, 1, 1};
};

/// One setting: `name=1,2,3`, `buffer 0.1=f:1,2,3`, `push=f:1,2`, `groups=4,1,1`. Bytes are h:, f: or d: floats of 16,
/// 32 or 64 bits, b:, s:, i: (or u:) or l: integers of 8 to 64 bits, zero:N. Lines of a description file are settings;
/// `#` begins a comment.
Status applySetting(const std::string& setting, Invocation& invocation);
Status readDescription(const std::string& path, Invocation& invocation);

/// The name of an interface variable: the module's, else "locationN" or the built-in's.
std::string variableName(const reference::InterfaceVariable& variable);
std::string builtinName(spv::BuiltIn builtin);

/// The inputs of an entry point. A name that no input has is an error that lists those there are.
template <class Number>
Result<reference::InterfaceValues<Number>> interfaceValues(const Invocation& invocation,
                                                           const reference::Module& module, size_t entryPoint);

/// The buffers of an invocation; images read as zero.
template <class Number>
class InvocationResources final : public reference::Resources<Number> {
  public:
    explicit InvocationResources(Invocation& invocation) : invocation_(invocation) {}
    std::span<std::byte> buffer(reference::BufferKind kind, const reference::Descriptor& descriptor) override {
        if (kind == reference::BufferKind::pushConstants) return invocation_.pushConstants;
        const auto found = invocation_.buffers.find({descriptor.set, descriptor.binding});
        if (found == invocation_.buffers.end()) return {};
        return found->second;
    }

  private:
    Invocation& invocation_;
};

}  // namespace vernier::tool
