// What processors do in ways of their own, other than SIMD (base/simd.h).
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace vernier {

#if defined(__x86_64__)

/// A thread's floating-point control word: MXCSR (Intel SDM, volume 1, 10.2.3).
using FloatControl = uint32_t;
/// Rounding to nearest, denormals kept, nothing trapped.
inline constexpr FloatControl kDefaultFloatControl = 0x1F80;
/// What makes denormals zero: those that operations take (DAZ) and those that they give (FTZ).
inline constexpr FloatControl kDenormalsAreZero = 0x8040;

inline FloatControl floatControl() {
    return _mm_getcsr();
}
inline void setFloatControl(FloatControl value) {
    _mm_setcsr(value);
}

/// For loops that wait awake: some 20 to 70 nanoseconds.
inline void pauseBriefly() {
    _mm_pause();
}

/// A counter that goes up at a steady rate of the processor's own.
inline uint64_t ticks() {
    return __rdtsc();
}

#elif defined(__aarch64__)

/// A thread's floating-point control word: FPCR (Arm ARM, C5.2.7).
using FloatControl = uint64_t;
/// Rounding to nearest, denormals kept, NaNs handed on, nothing trapped.
inline constexpr FloatControl kDefaultFloatControl = 0;
/// What makes denormals zero (FZ).
inline constexpr FloatControl kDenormalsAreZero = 1 << 24;

inline FloatControl floatControl() {
    FloatControl value;
    asm volatile("mrs %0, fpcr" : "=r"(value));
    return value;
}
inline void setFloatControl(FloatControl value) {
    asm volatile("msr fpcr, %0" : : "r"(value) : "memory");
}

/// For loops that wait awake. Emptying the pipeline takes about as long as a pause of x86; "yield" does nothing on most
/// processors.
inline void pauseBriefly() {
    asm volatile("isb" : : : "memory");
}

/// A counter that goes up at a steady rate of the processor's own.
inline uint64_t ticks() {
    uint64_t value;
    asm volatile("mrs %0, cntvct_el0" : "=r"(value));
    return value;
}

#else
#error "processors known are x86-64 and 64-bit Arm"
#endif

}  // namespace vernier
