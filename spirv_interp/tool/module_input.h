// The module a command works on: a .spv file, or GLSL compiled with names and source lines kept.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "spirv_interp/program.h"

namespace vernier::tool {

struct ModuleInput {
    std::string path;
    std::vector<uint32_t> words;
    std::vector<std::string> source;  // lines of GLSL; empty for a .spv file
    std::string entryPoint = "main";
    ir::Stage stage = ir::Stage::vertex;

    ShaderSource shader(bool contract = false) const;
    /// As the batch engine runs it: what a geometry stage emits has a place in memory.
    Result<ir::Program> program(bool contract = false) const;
    /// Whether an invocation can be run by itself: not of tessellation and geometry stages.
    Status standsAlone() const;
    /// The source line, without leading blanks; empty if it is not known.
    std::string sourceLine(uint32_t line) const;
};

/// `stage`: "vertex", "control", "evaluation", "geometry", "fragment" or "compute", or empty: that of the file's ending
/// (.vert, .tesc, .tese, .geom, .frag, .comp) or of the module's first entry point. `entryPoint` empty: the first one
/// of the stage.
Result<ModuleInput> readModule(const std::string& path, const std::string& stage, const std::string& entryPoint);

}  // namespace vernier::tool
