// Include before <hwy/foreach_target.h>: fixes the set of targets to the ones in vernier::Isa, so that every SIMD
// source file defines exactly the namespaces that VERNIER_ISAS names.
#pragma once

// Highway refuses a set without a baseline: it is the lowest of ours. On x86 each target's code is compiled with its
// own attributes. NEON is what every 64-bit Arm CPU has: it needs none, and Highway's would ask for the cryptographic
// extension, which not every CPU has, unless told that targets cannot be told apart at run time.
#if defined(__x86_64__)
#define HWY_BASELINE_TARGETS HWY_SSE4
#define HWY_DISABLED_TARGETS (~(HWY_SSE4 | HWY_AVX2 | HWY_AVX3))
#else
#define HWY_BASELINE_TARGETS HWY_NEON
#define HWY_DISABLED_TARGETS (~HWY_NEON)
#define TOOLCHAIN_MISS_SYS_AUXV_H
#endif
// Compile every enabled target even when the compiler's flags already imply a better one.
#define HWY_COMPILE_ALL_ATTAINABLE
