// SPIR-V that no GLSL compiler writes: assembled from text.
#pragma once

#include <spirv-tools/libspirv.h>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {

/// A compute shader over two storage buffers of words, %a and %b, at bindings 0 and 1 of set 0. A word is reached by
/// OpAccessChain %pu %a %c0 and its number; %i is the number of the invocation (%gid holds all three), a %uint.
struct TwoBufferModule {
    std::string head;                     // capabilities and extensions besides Shader
    const char* interface = "%a %b %id";  // up to SPIR-V 1.3: "%id"
    uint32_t localSize = 1;
    std::string declarations;  // more decorations
    std::string constants;     // and types, besides %void, %bool, %uint, %v3 and %c0
    std::string body;          // of main, after %gid and %i
    std::string text() const;
};

class AssemblyTest : public ComputeTest {
  protected:
    /// The test fails when the text is no module.
    VkShaderModule makeAssembledShader(const std::string& text, spv_target_env environment);
    Compute makeAssembled(const std::string& text, spv_target_env environment,
                          const std::vector<TestDescriptor>& descriptors);
};

}  // namespace vernier::test
