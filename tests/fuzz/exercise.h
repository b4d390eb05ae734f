// What both fuzz targets do with words: everything that a driver does with a module, on a small scale.
#pragma once

#include <cstdint>
#include <span>

namespace vernier::proof {

/// Parses, validates, lowers, compiles and runs whatever the words hold for every stage. Returns normally whatever they
/// hold; anything else is a finding. Thread-safe.
void exercise(std::span<const uint32_t> words);

/// The front end's tables alone, of words that nobody has validated.
void readModule(std::span<const uint32_t> words);

}  // namespace vernier::proof
