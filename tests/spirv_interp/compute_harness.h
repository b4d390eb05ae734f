// Runs compute shaders from GLSL for tests, in every way they can be run.
#pragma once

#include <vernier/vernier_glsl.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/simd.h"
#include "spirv_interp/program.h"

namespace vernier::test {

/// The program of a compute shader; a failure ends the test.
ir::Program loadCompute(std::string_view glsl, const Specialization& specialization = {},
                        VnGlslTarget target = VN_GLSL_TARGET_VULKAN_1_2);
/// The message with which it is refused; empty if it is not.
std::string refusalOf(std::string_view glsl);

/// By binding of set 0.
using BufferContents = std::map<uint32_t, std::vector<uint32_t>>;

struct DispatchResult {
    BufferContents buffers;
    bool ok = true;
    bool operator==(const DispatchResult&) const = default;
};

/// A failure ends the test. `lanes` as in BatchOptions.
std::shared_ptr<const BatchProgram> compileCompute(const ir::Program& program, Isa isa, uint32_t lanes);

/// `compiled` comes from `program`; `chunk` work-groups per run(), 0 = all at once.
DispatchResult dispatch(const ir::Program& program, const std::shared_ptr<const BatchProgram>& compiled,
                        const WorkGroupContext::Grid& grid, BufferContents buffers, uint32_t chunk = 0,
                        const std::vector<uint32_t>& pushConstants = {});

/// On every instruction set, with every width of batch from `leastLanes` on and work-groups in shares of different
/// size: expects the same bits from all, and returns them.
BufferContents dispatchEverywhere(const ir::Program& program, const WorkGroupContext::Grid& grid,
                                  const BufferContents& buffers, const std::vector<uint32_t>& pushConstants = {},
                                  uint32_t leastLanes = 16);

std::vector<uint32_t> wordsOf(const std::vector<float>& values);
std::vector<float> floatsOf(const std::vector<uint32_t>& words);

}  // namespace vernier::test
