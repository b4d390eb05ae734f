// What both fuzz targets do with words: everything that a driver does with a module, on a small scale.
#pragma once

#include <cstdint>
#include <span>

#include "base/result.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::proof {

inline constexpr ir::Stage kStages[] = {ir::Stage::vertex,   ir::Stage::control,  ir::Stage::evaluation,
                                        ir::Stage::geometry, ir::Stage::fragment, ir::Stage::compute};

/// Parses, validates, lowers, compiles and runs whatever the words hold for every stage; what is not valid is lowered
/// all the same. Returns normally whatever they hold; anything else is a finding. Thread-safe.
void exercise(std::span<const uint32_t> words);

/// The front end's tables alone, of words that nobody has validated.
void readModule(std::span<const uint32_t> words);

/// A program of words that nobody has validated, after the passes. Ends the process when it is not well-formed.
Result<ir::Program> lowerUnvalidated(std::span<const uint32_t> words, ir::Stage stage);

}  // namespace vernier::proof
