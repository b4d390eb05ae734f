// The corpus: GLSL programs in tests/corpus, each with its surroundings in lines that begin with "//!":
//
//   //! invocations N                      all but compute; a multiple of 4 (64); .tesc: patches
//   //! groups X Y Z                       compute (1 1 1)
//   //! inputs KIND LOW HIGH               inputs at all other locations (ramp -1 1)
//   //! input LOCATION KIND LOW HIGH
//   //! buffer SET BINDING BYTES KIND LOW HIGH
//   //! push BYTES KIND LOW HIGH
//   //! integers SET BINDING               an image of integers
//   //! spec ID VALUE
//   //! vulkan 1.1                         the target environment (1.0)
//
// KIND is uniform, integer, index, ramp, special or zero (Filling::Kind).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/proof/proof.h"

namespace vernier::proof {

struct CorpusProgram {
    Case subject;
    std::string source;
};

/// Names of the files, sorted; `extension` is ".vert", ".tesc", ".tese", ".geom", ".frag" or ".comp".
std::vector<std::string> corpusFiles(const std::string& extension);

/// Throws std::runtime_error with the compiler's messages or the line of a directive that is wrong.
CorpusProgram loadCorpusProgram(const std::string& file);

/// SPIR-V of GLSL; throws std::runtime_error. `vulkanMinor` 0 to 3.
Words compileGlsl(ir::Stage stage, const std::string& source, int vulkanMinor = 0);

}  // namespace vernier::proof
