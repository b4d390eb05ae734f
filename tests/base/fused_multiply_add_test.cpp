// The fused multiply-add of base/simd-inl.h gives the bits of fmaf on every instruction set, the emulation on SSE4
// included.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/base/fused_multiply_add_test.cpp"
#include "base/simd_targets.h"
// clang-format off: the order matters
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include "base/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

void fuseAll(const float* a, const float* b, const float* c, float* result, size_t count) {
    const hn::ScalableTag<float> d;
    for (size_t i = 0; i < count; i += hn::Lanes(d))
        hn::StoreU(fusedMulAdd(d, hn::LoadU(d, a + i), hn::LoadU(d, b + i), hn::LoadU(d, c + i)), d, result + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "base/simd.h"

namespace vernier {
namespace {

using FuseFn = void (*)(const float*, const float*, const float*, float*, size_t);
FuseFn fuseFor(Isa isa) {
    VERNIER_SELECT_ISA(isa, fuseAll)
}

void expectFused(const std::vector<float>& a, const std::vector<float>& b, const std::vector<float>& c) {
    std::vector<float> result(a.size());
    for (const Isa isa : availableIsas()) {
        fuseFor(isa)(a.data(), b.data(), c.data(), result.data(), a.size());
        for (size_t i = 0; i < a.size(); ++i) {
            const float exact = std::fmaf(a[i], b[i], c[i]);
            if (std::isnan(exact)) {
                ASSERT_TRUE(std::isnan(result[i]));
                continue;
            }
            ASSERT_EQ(std::bit_cast<uint32_t>(result[i]), std::bit_cast<uint32_t>(exact))
                << isaName(isa) << ": " << a[i] << " * " << b[i] << " + " << c[i];
        }
    }
}

constexpr size_t kCount = 1 << 16;

TEST(FusedMultiplyAdd, EqualsFmafForAllBitPatterns) {
    std::mt19937 random(1);
    std::vector<float> a(kCount), b(kCount), c(kCount);
    for (int round = 0; round < 20; ++round) {
        for (auto* values : {&a, &b, &c})
            for (float& value : *values) value = std::bit_cast<float>(static_cast<uint32_t>(random()));
        expectFused(a, b, c);
    }
}

TEST(FusedMultiplyAdd, EqualsFmafWhereTheSumNearlyCancelsOrTies) {
    std::mt19937 random(2);
    std::vector<float> a(kCount), b(kCount), c(kCount);
    for (int round = 0; round < 20; ++round) {
        for (size_t i = 0; i < kCount; ++i) {
            a[i] = std::bit_cast<float>(static_cast<uint32_t>(0x3F800000u + (random() & 0x7FFFFFu)));
            b[i] = std::bit_cast<float>(static_cast<uint32_t>(0x3F800000u + (random() & 0x7FFFFFu)));
            const int exponent = static_cast<int>(random() % 60) - 30;
            c[i] = std::ldexp(-a[i] * b[i], exponent);
        }
        expectFused(a, b, c);
    }
}

}  // namespace
}  // namespace vernier
#endif
