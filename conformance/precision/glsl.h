// GLSL to SPIR-V for the shaders made here.
#pragma once

#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "base/result.h"
#include "conformance/precision/function.h"

namespace vernier::precision {

/// The extensions that calls of functions need.
inline constexpr const char* kGlslExtensions = "#extension GL_EXT_shader_explicit_arithmetic_types : enable\n";

/// Statements that call a function on the operands' words in the vectors u and v, and put those of the result into the
/// floats `low` and `high`.
std::string callText(const Function& function);

Result<std::vector<uint32_t>> compileGlsl(VkShaderStageFlagBits stage, const std::string& source);

}  // namespace vernier::precision
