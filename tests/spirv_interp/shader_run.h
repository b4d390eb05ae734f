// Runs shaders that work on storage buffers, from GLSL or assembly, through the front end and the batch interpreter.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "spirv_interp/program.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {

using Bytes = std::vector<std::byte>;

template <class T>
Bytes bytesOf(const std::vector<T>& values) {
    Bytes bytes(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}
template <class T>
std::vector<T> valuesOf(const Bytes& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

/// The surroundings of a run. Every resource is found by its binding; the input of location 0 counts the lanes, and
/// inputs of location n > 0 are inputs[n], lane by lane.
struct ShaderRun {
    Words words;
    ir::Stage stage = ir::Stage::fragment;
    uint32_t lanes = 64;
    std::map<uint32_t, Bytes> buffers;  // by binding
    Bytes push;
    std::map<uint32_t, std::vector<uint32_t>> inputs;  // by 4 * location + component
    Specialization specialization;
    AddressResolver addresses;
    std::vector<uint32_t> exec;  // empty: all
    // Results.
    std::map<uint32_t, std::vector<uint32_t>> outputs;  // by 4 * location + component
    std::vector<uint32_t> live;
    ir::Program program;

    /// Loads, compiles and runs; fails the test and returns false when that does not work.
    bool run(Isa isa);
    /// The lane's word of an output.
    uint32_t output(uint32_t place, uint32_t lane) const;
};

/// A fragment shader of some extensions, declarations and a body; `lane` is the number of the lane, an int.
Words laneShader(std::string_view extensions, std::string_view globals, std::string_view body, bool debug = false);

/// What loadShader says about the module; empty when it takes it.
std::string loadError(const Words& words, ir::Stage stage = ir::Stage::fragment);

}  // namespace vernier::test
