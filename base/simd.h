// The instruction sets Vernier is compiled for, and the few operations on top of Highway that keep results the same on
// all of them.
//
// A source file that wants SIMD is compiled once per instruction set through Highway's foreach_target.h:
//
//     #undef HWY_TARGET_INCLUDE
//     #define HWY_TARGET_INCLUDE "runtime/raster/coverage.cpp"   // this file
//     #include "base/simd_targets.h"                             // before any other Highway include; the blank
//                                                                // line keeps clang-format from sorting it down
//     #include <hwy/foreach_target.h>
//     #include <hwy/highway.h>
//     #include "base/simd-inl.h"                                 // operations common to all targets
//     HWY_BEFORE_NAMESPACE();
//     namespace vernier::HWY_NAMESPACE { void coverRow(...) { ... } }
//     HWY_AFTER_NAMESPACE();
//     #if HWY_ONCE
//     namespace vernier { CoverRowFn coverRow(Isa isa) { VERNIER_SELECT_ISA(isa, coverRow) } }
//     #endif
//
// The choice is made once, when a device is created, and handed down as an Isa: nothing here keeps global state, and
// Highway's shared library is not needed.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace vernier {

/// Instruction sets in rising order; a CPU that has one has all before it.
enum class Isa : uint8_t { sse4, avx2, avx512 };

/// The best instruction set of this CPU that Vernier was compiled for. Thread-safe; reads CPUID.
Isa bestIsa();

/// The best instruction set not above `limit`. Used to compare results between instruction sets.
Isa bestIsaUpTo(Isa limit);

std::string_view isaName(Isa isa);

/// "sse4", "avx2", "avx512"; nothing for any other text.
std::optional<Isa> isaFromName(std::string_view name);

}  // namespace vernier

/// Returns the compilation of `function` for `isa` from the current function. Use under HWY_ONCE.
#define VERNIER_SELECT_ISA(isa, function) \
    switch (isa) {                        \
        case ::vernier::Isa::avx512:      \
            return N_AVX3::function;      \
        case ::vernier::Isa::avx2:        \
            return N_AVX2::function;      \
        case ::vernier::Isa::sse4:        \
            break;                        \
    }                                     \
    return N_SSE4::function;
