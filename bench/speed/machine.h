// On what machine was measured.
#pragma once

#include <string>

namespace vernier::bench {

/// "4 usable CPUs (AMD EPYC ...), avx512".
std::string machineText();

}  // namespace vernier::bench
