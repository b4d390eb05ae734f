// What the tests of spirv_interp/front and spirv_interp/ir share: shaders from text, and a machine that runs a program
// for one invocation.
#pragma once

#include <vernier/vernier_glsl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::test {

using Words = std::vector<uint32_t>;

/// SPIR-V of a GLSL source; fails the test with the compiler's messages. `debug`: with OpName and OpLine.
Words compileGlsl(ir::Stage stage, std::string_view source, bool debug = false,
                  VnGlslTarget target = VN_GLSL_TARGET_DEFAULT);

/// SPIR-V of an assembly source (SPIRV-Tools). `minor`: version 1.minor of SPIR-V, 3, 5 or 6.
Words assemble(std::string_view source, uint32_t minor = 3);

/// The module after spirv-opt -O: phis, selects and flattened control flow that no GLSL compiler writes by itself.
Words optimised(const Words& words);

/// One invocation's surroundings and what becomes of it.
struct Machine {
    std::vector<uint32_t> inputs;                 // by slot of the program
    std::vector<std::vector<std::byte>> buffers;  // by resource
    /// Four words for an image operation with its operands' bits.
    std::function<std::array<uint32_t, 4>(const ir::ImageOp&, std::span<const uint64_t>)> image;
    // Results.
    std::vector<uint32_t> outputs;  // by slot
    std::vector<bool> written;
    bool killed = false, demoted = false;

    /// False when the program takes more than a million instructions.
    bool run(const ir::Program& program);
};

}  // namespace vernier::test
