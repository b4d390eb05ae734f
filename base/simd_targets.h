// Include before <hwy/foreach_target.h>: fixes the set of targets to the ones in vernier::Isa, so that every SIMD
// source file defines exactly the namespaces N_SSE4, N_AVX2 and N_AVX3.
#pragma once

// Highway refuses a set without a baseline; SSE4 is ours, and each target's code is compiled with its own attributes.
#define HWY_BASELINE_TARGETS HWY_SSE4
#define HWY_DISABLED_TARGETS (~(HWY_SSE4 | HWY_AVX2 | HWY_AVX3))
// Compile every enabled target even when the compiler's flags already imply a better one.
#define HWY_COMPILE_ALL_ATTAINABLE
