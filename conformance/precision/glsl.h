// GLSL to SPIR-V for the shaders made here.
#pragma once

#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "base/result.h"

namespace vernier::precision {

Result<std::vector<uint32_t>> compileGlsl(VkShaderStageFlagBits stage, const std::string& source);

}  // namespace vernier::precision
