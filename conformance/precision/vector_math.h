// Declares the C library's functions as what they are in glibc 2.35 and later for x86: each has vector forms that a
// vectorising compiler may call, good to 4 ULP of double. Only with VERNIER_PRECISION_ARCH, which says that the
// measuring machine has them (libmvec). To be included before <cmath> declares the same functions plainly.
#pragma once

#ifdef VERNIER_VECTOR_MATH
extern "C" {
#define VERNIER_VECTOR_FUNCTION(name) __attribute__((simd("notinbranch"))) double name(double) noexcept;
VERNIER_VECTOR_FUNCTION(sin)
VERNIER_VECTOR_FUNCTION(cos)
VERNIER_VECTOR_FUNCTION(tan)
VERNIER_VECTOR_FUNCTION(asin)
VERNIER_VECTOR_FUNCTION(acos)
VERNIER_VECTOR_FUNCTION(atan)
VERNIER_VECTOR_FUNCTION(sinh)
VERNIER_VECTOR_FUNCTION(cosh)
VERNIER_VECTOR_FUNCTION(tanh)
VERNIER_VECTOR_FUNCTION(asinh)
VERNIER_VECTOR_FUNCTION(acosh)
VERNIER_VECTOR_FUNCTION(atanh)
VERNIER_VECTOR_FUNCTION(exp)
VERNIER_VECTOR_FUNCTION(exp2)
VERNIER_VECTOR_FUNCTION(expm1)
VERNIER_VECTOR_FUNCTION(log)
VERNIER_VECTOR_FUNCTION(log2)
#undef VERNIER_VECTOR_FUNCTION
}
#endif
