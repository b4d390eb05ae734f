// Shaders for the tests of the reference interpreter, and short ways to run them.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spirv_interp/reference/interpreter.h"

namespace vernier::reference::test {

using Words = std::vector<uint32_t>;

/// Empty, with a test failure, when the source does not compile. `vulkanMinor`: 0 to 3. `names`: keep OpName
/// and OpLine.
Words compileVertex(std::string_view source, int vulkanMinor = 1);
Words compileFragment(std::string_view source, int vulkanMinor = 1, bool names = false);
Words compileControl(std::string_view source);
Words compileEvaluation(std::string_view source);
Words assemble(std::string_view source);

/// "#version 450", inputs v (vec4, location 0), i (ivec4, 1), u (uvec4, 2), outputs r (vec4, 0), ri (ivec4,
/// 1), then `declarations` and main() around `body`.
std::string fragmentSource(std::string_view declarations, std::string_view body);

/// v = (0.5, -1.25, 2, 3), i = (7, -3, 100, INT_MIN), u = (5, 12, 0x80000001, 0xFFFFFFFF).
template <class Number>
InterfaceValues<Number> standardInputs() {
    InterfaceValues<Number> inputs;
    inputs.setFloat(Location(0), {Number(0.5f), Number(-1.25f), Number(2.0f), Number(3.0f)});
    inputs.setInt(Location(1), {7, -3, 100, INT32_MIN});
    inputs.setInt(Location(2), {5, 12, static_cast<int32_t>(0x80000001u), -1});
    return inputs;
}

/// Buffers by (set, binding, array index), push constants under their own name.
template <class Number>
class TestBuffers : public Resources<Number> {
  public:
    std::map<Descriptor, std::vector<std::byte>> buffers;
    std::vector<std::byte> pushConstants;

    std::span<std::byte> buffer(BufferKind kind, const Descriptor& descriptor) override {
        if (kind == BufferKind::pushConstants) return pushConstants;
        const auto found = buffers.find(descriptor);
        return found != buffers.end() ? std::span<std::byte>(found->second) : std::span<std::byte>();
    }
};

template <class T>
std::vector<std::byte> bytesOf(const std::vector<T>& values) {
    std::vector<std::byte> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}
template <class T>
std::vector<T> valuesOf(const std::vector<std::byte>& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

template <class Number>
Interpreter<Number> interpreterOf(const Module& module, spv::ExecutionModel model, const Options& options = {}) {
    auto result = Interpreter<Number>::create(module, model, "main", options);
    if (!result) throw std::runtime_error(result.error().message);
    return *result;
}

/// Runs one fragment; a test failure and empty outputs on an error.
template <class Number>
Outcome<Number> runFragment(const Words& words, const InterfaceValues<Number>& inputs, Resources<Number>& resources,
                            const Options& options = {}, const Module::Specialization& specialization = {}) {
    const auto module = Module::parse(words, specialization);
    EXPECT_TRUE(module.ok()) << module.error().message;
    if (!module) return {};
    const auto interpreter = Interpreter<Number>::create(*module, spv::ExecutionModelFragment, "main", options);
    EXPECT_TRUE(interpreter.ok()) << interpreter.error().message;
    if (!interpreter) return {};
    const auto outcome = interpreter->run(inputs, resources);
    EXPECT_TRUE(outcome.ok()) << outcome.error().message;
    return outcome ? *outcome : Outcome<Number>{};
}

/// The bodies' result r, as doubles.
template <class Number>
std::array<double, 4> floatsAt(const Outcome<Number>& outcome, uint32_t location = 0) {
    std::array<double, 4> result{};
    const auto found = outcome.outputs.locations.find(Location(location));
    if (found == outcome.outputs.locations.end()) return result;
    for (size_t k = 0; k < 4; ++k) result[k] = static_cast<double>(found->second[k].number);
    return result;
}
template <class Number>
std::array<int32_t, 4> intsAt(const Outcome<Number>& outcome, uint32_t location = 1) {
    std::array<int32_t, 4> result{};
    const auto found = outcome.outputs.locations.find(Location(location));
    if (found == outcome.outputs.locations.end()) return result;
    for (size_t k = 0; k < 4; ++k) result[k] = static_cast<int32_t>(static_cast<uint32_t>(found->second[k].bits));
    return result;
}

}  // namespace vernier::reference::test
