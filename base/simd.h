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
#include <span>
#include <string_view>

/// The instruction sets of this family of processors that Vernier is compiled for, in rising order: a CPU that has one
/// has all before it. X(name, namespace, ...): the enumerator of Isa, Highway's namespace, and the other arguments.
#if defined(__x86_64__)
#define VERNIER_ISAS(X, ...)     \
    X(sse4, N_SSE4, __VA_ARGS__) \
    X(avx2, N_AVX2, __VA_ARGS__) \
    X(avx512, N_AVX3, __VA_ARGS__)
#elif defined(__aarch64__)
#define VERNIER_ISAS(X, ...) X(neon, N_NEON, __VA_ARGS__)
#else
#error "instruction sets known are those of x86-64 and of 64-bit Arm"
#endif

namespace vernier {

#define VERNIER_ISA_ENUMERATOR(name, target, ...) name,
enum class Isa : uint8_t { VERNIER_ISAS(VERNIER_ISA_ENUMERATOR) };
#undef VERNIER_ISA_ENUMERATOR

/// The one that every CPU of the family has.
inline constexpr Isa kLowestIsa{};
#define VERNIER_ISA_COUNT(name, target, ...) +1
inline constexpr auto kHighestIsa = static_cast<Isa>(VERNIER_ISAS(VERNIER_ISA_COUNT) - 1);
#undef VERNIER_ISA_COUNT

/// The best instruction set of this CPU that Vernier was compiled for. Thread-safe; reads CPUID.
Isa bestIsa();

/// The best instruction set not above `limit`. Used to compare results between instruction sets.
Isa bestIsaUpTo(Isa limit);

/// Those of this CPU, the lowest first.
std::span<const Isa> availableIsas();

/// "sse4", "avx2", "avx512"; "neon".
std::string_view isaName(Isa isa);

/// Nothing for any text that is not the name of one of this family.
std::optional<Isa> isaFromName(std::string_view name);

/// All names of this family, for messages: "sse4, avx2, avx512".
std::string_view isaNames();

}  // namespace vernier

#define VERNIER_ISA_CASE(name, target, function) \
    case ::vernier::Isa::name:                   \
        return target::function;
/// Returns the compilation of `function` for `isa` from the current function. Use under HWY_ONCE.
#define VERNIER_SELECT_ISA(isa, function)                     \
    switch (isa) { VERNIER_ISAS(VERNIER_ISA_CASE, function) } \
    return HWY_STATIC_DISPATCH(function);
