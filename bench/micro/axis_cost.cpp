// What cheaper arithmetic would save where the dial offers none: pairs of kernels, one as the renderer computes and one
// as a less exact axis would, over the same numbers. Nanoseconds per pixel and the largest difference. The table of
// docs/accuracy.md.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/micro/axis_cost.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/texture/texels-inl.h"

#ifndef VERNIER_AXIS_COST_DATA
#define VERNIER_AXIS_COST_DATA
namespace vernier::bench {
namespace {

constexpr size_t kPixels = 2048;

/// Numbers as a frame has them.
struct AxisData {
    alignas(64) float w[kPixels];             // 1/w, or squared scale factors
    alignas(64) float weight[2][kPixels];     // of taps, or of vertices
    alignas(64) uint32_t texels[4][kPixels];  // RGBA8
    alignas(64) float source[4][kPixels];     // colours in [0, 1]
    alignas(64) float result[4][kPixels];     // what a kernel computes
    alignas(64) uint32_t blended[kPixels];    // likewise
};

struct AxisKernel {
    const char *axis, *exact, *cheap;
    void (*runExact)(AxisData&);
    void (*runCheap)(AxisData&);
    bool words;      // the result is in `blended`, as bytes; else in `result`
    double unit;     // of the difference, e.g. 1/255
    const char* of;  // what the unit is called
};

}  // namespace
}  // namespace vernier::bench
#endif

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

using bench::AxisData;
using bench::AxisKernel;
using bench::kPixels;

constexpr size_t kStep = hn::MaxLanes(F32());

HWY_INLINE VF at(const float* plane, size_t n) {
    return hn::Load(F32(), plane + n);
}

/// Perspective: both weights of vertices times w.
template <bool kExact>
void perspective(AxisData& data) {
    for (size_t n = 0; n < kPixels; n += kStep) {
        const VF inverse = at(data.w, n);
        VF w = hn::ApproximateReciprocal(inverse);
        if constexpr (kExact) {
            w = hn::Div(splatFloat(1.0f), inverse);
        } else {  // one step of Newton
            w = hn::Mul(w, hn::NegMulAdd(w, inverse, splatFloat(2.0f)));
        }
        hn::Store(hn::Mul(at(data.weight[0], n), w), F32(), data.result[0] + n);
        hn::Store(hn::Mul(at(data.weight[1], n), w), F32(), data.result[1] + n);
    }
}

/// Level of detail: one logarithm per quad, for all its pixels.
template <bool kExact>
void level(AxisData& data) {
    for (size_t n = 0; n < kPixels; n += 4 * kStep) {
        VF lambda;
        if constexpr (kExact) {
            lambda = log2V(at(data.w, n));
        } else {  // the exponent, and the mantissa as its fraction
            const VF bits = hn::ConvertTo(F32(), hn::BitCast(I32(), at(data.w, n)));
            lambda = hn::Sub(hn::Mul(bits, splatFloat(0x1p-23f)), splatFloat(127.0f));
        }
        for (size_t k = 0; k < 4; ++k)
            hn::Store(hn::Mul(lambda, splatFloat(0.5f)), F32(), data.result[0] + n + k * kStep);
    }
}

/// Linear filter of four RGBA8 texels to four floats.
void filterFloat(AxisData& data) {
    for (size_t n = 0; n < kPixels; n += kStep) {
        const VF x = at(data.weight[0], n), y = at(data.weight[1], n);
        VU words[4];
        unrolled<4>([&](auto k) VERNIER_INLINE_LAMBDA { words[k] = hn::Load(U32(), data.texels[k] + n); });
        unrolled<4>([&](auto c) VERNIER_INLINE_LAMBDA {
            const auto tap = [&](auto k) VERNIER_INLINE_LAMBDA {
                return toFloatV(hn::And(hn::ShiftRight<8 * c>(words[k]), splatBits(0xFF)));
            };
            const VF top = lerpFinite(tap(std::integral_constant<int, 0>()), tap(std::integral_constant<int, 1>()), x);
            const VF bottom =
                lerpFinite(tap(std::integral_constant<int, 2>()), tap(std::integral_constant<int, 3>()), x);
            const VF sum = lerpFinite(top, bottom, y);
            hn::Store(divideExact(sum, splatFloat(255.0f), splatFloat(1.0f / 255)), F32(), data.result[c] + n);
        });
    }
}

/// The same in integers of 16 bits, two components at a time, with weights of 8 bits.
void filterBytes(AxisData& data) {
    using U16 = hn::Repartition<uint16_t, U32>;
    const U16 d16;
    const auto half = hn::Set(d16, 128), one = hn::Set(d16, 256);
    const auto pairs = [](VU w) HWY_ATTR { return hn::BitCast(U16(), hn::Or(w, hn::ShiftLeft<16>(w))); };
    const auto lerp = [&](auto a, auto b, auto t) HWY_ATTR {
        const auto sum = hn::Add(hn::Mul(a, hn::Sub(one, t)), hn::Mul(b, t));
        return hn::ShiftRight<8>(hn::Add(sum, half));
    };
    for (size_t n = 0; n < kPixels; n += kStep) {
        const auto weight = [&](int axis) HWY_ATTR {
            return pairs(hn::BitCast(U32(), hn::NearestInt(hn::Mul(at(data.weight[axis], n), splatFloat(256.0f)))));
        };
        const auto x = weight(0), y = weight(1);
        VU low[4], high[4];
        for (int k = 0; k < 4; ++k) {
            const VU word = hn::Load(U32(), data.texels[k] + n);
            low[k] = hn::And(word, splatBits(0x00FF00FF));
            high[k] = hn::And(hn::ShiftRight<8>(word), splatBits(0x00FF00FF));
        }
        const auto filter = [&](const VU* taps) HWY_ATTR {
            const auto tap = [&](int k) HWY_ATTR { return hn::BitCast(d16, taps[k]); };
            return hn::BitCast(U32(), lerp(lerp(tap(0), tap(1), x), lerp(tap(2), tap(3), x), y));
        };
        const VU results[2] = {filter(low), filter(high)};
        for (int c = 0; c < 4; ++c) {
            const VU code = c < 2 ? hn::And(results[c], splatBits(0xFFFF)) : hn::ShiftRight<16>(results[c - 2]);
            hn::Store(hn::Mul(toFloatV(code), splatFloat(1.0f / 255)), F32(), data.result[c] + n);
        }
    }
}

HWY_INLINE VU codeOf(VF value) {
    return hn::BitCast(U32(), roundProduct(value, 255.0f));
}

/// Source alpha over RGBA8: in float, rounded once.
void blendFloat(AxisData& data) {
    for (size_t n = 0; n < kPixels; n += kStep) {
        const VU before = hn::Load(U32(), data.texels[0] + n);
        const VF alpha = at(data.source[3], n), rest = hn::Sub(splatFloat(1.0f), alpha);
        VU after = hn::Zero(U32());
        for (int c = 0; c < 4; ++c) {
            const VF old = decodeUnormV(hn::And(hn::ShiftRightSame(before, 8 * c), splatBits(0xFF)), 8);
            const VF sum = hn::Add(hn::Mul(at(data.source[c], n), alpha), hn::Mul(old, rest));
            after = hn::Or(after, hn::ShiftLeftSame(codeOf(sum), 8 * c));
        }
        hn::Store(after, U32(), data.blended + n);
    }
}

/// In integers of 16 bits: the source rounded to 8 bits first, then (s a + d (255 - a)) / 255, rounded.
void blendBytes(AxisData& data) {
    using U16 = hn::Repartition<uint16_t, U32>;
    const U16 d16;
    const auto half = hn::Set(d16, 128);
    for (size_t n = 0; n < kPixels; n += kStep) {
        const VU before = hn::Load(U32(), data.texels[0] + n);
        VU code[4];
        for (int c = 0; c < 4; ++c) code[c] = codeOf(at(data.source[c], n));
        const auto alpha = hn::BitCast(d16, hn::Or(code[3], hn::ShiftLeft<16>(code[3])));
        const auto rest = hn::Sub(hn::Set(d16, 255), alpha);
        const auto blend = [&](VU source, VU destination) HWY_ATTR {
            const auto sum = hn::Add(
                hn::Add(hn::Mul(hn::BitCast(d16, source), alpha), hn::Mul(hn::BitCast(d16, destination), rest)), half);
            return hn::BitCast(U32(), hn::ShiftRight<8>(hn::Add(sum, hn::ShiftRight<8>(sum))));
        };
        const VU mask = splatBits(0x00FF00FF);
        const VU low = blend(hn::Or(code[0], hn::ShiftLeft<16>(code[2])), hn::And(before, mask));
        const VU high = blend(hn::Or(code[1], hn::ShiftLeft<16>(code[3])), hn::And(hn::ShiftRight<8>(before), mask));
        hn::Store(hn::Or(low, hn::ShiftLeft<8>(high)), U32(), data.blended + n);
    }
}

const AxisKernel* axisKernels() {
    static constexpr AxisKernel kKernels[] = {
        {"perspective division", "a division", "an estimate and a step of Newton", perspective<true>,
         perspective<false>, false, 0x1p-23, "2^-23"},
        {"level of detail", "log2 within 2^-18", "exponent and mantissa", level<true>, level<false>, false, 1.0 / 256,
         "1/256 level"},
        {"filter weights", "float", "8 bits", filterFloat, filterBytes, false, 1.0 / 255, "code"},
        {"blending", "float, rounded once", "8 bits", blendFloat, blendBytes, true, 1, "code"},
        {}};
    return kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::bench {
namespace {

const AxisKernel* kernelsOf(Isa isa) {
    const auto selected = [&]() { VERNIER_SELECT_ISA(isa, axisKernels) }();
    return selected();
}

/// The least time of a call per pixel, in nanoseconds: the rest is somebody else's.
double nanosecondsOf(void (*run)(AxisData&), AxisData& data) {
    using Clock = std::chrono::steady_clock;
    constexpr int kRounds = 60, kCalls = 200;
    double best = 1e9;
    for (int round = 0; round < kRounds; ++round) {
        const auto begin = Clock::now();
        for (int k = 0; k < kCalls; ++k) run(data);
        best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / kCalls);
    }
    return best / kPixels;
}

double largestDifference(const AxisKernel& kernel, const AxisData& exact, const AxisData& cheap) {
    double largest = 0;
    for (size_t n = 0; n < kPixels; ++n)
        for (int c = 0; c < 4; ++c) {
            const double a =
                kernel.words ? static_cast<double>(exact.blended[n] >> 8 * c & 0xFF) : double{exact.result[c][n]};
            const double b =
                kernel.words ? static_cast<double>(cheap.blended[n] >> 8 * c & 0xFF) : double{cheap.result[c][n]};
            const bool relative = kernel.unit == 0x1p-23 && a != 0;
            largest = std::max(largest, std::abs(a - b) / (relative ? std::abs(a) : 1));
        }
    return largest / kernel.unit;
}

int main() {
    const auto data = std::make_unique<AxisData>();
    std::mt19937 random(7);
    const auto unit = [&] { return static_cast<float>(random() % 65537) / 65536; };
    for (size_t n = 0; n < kPixels; ++n) {
        data->w[n] = 0.01f + unit() * 40;
        for (auto& plane : data->weight) plane[n] = unit();
        for (auto& plane : data->texels) plane[n] = static_cast<uint32_t>(random());
        for (auto& plane : data->source) plane[n] = unit();
    }
    const Isa isa = bestIsa();
    std::printf(
        "%s\n| Axis | as computed | ns per pixel | cheaper | ns per pixel | largest difference |\n"
        "| --- | --- | --- | --- | --- | --- |\n",
        std::string(isaName(isa)).c_str());
    for (const AxisKernel* kernel = kernelsOf(isa); kernel->axis != nullptr; ++kernel) {
        const double exactTime = nanosecondsOf(kernel->runExact, *data);
        const auto exact = std::make_unique<AxisData>(*data);
        const double cheapTime = nanosecondsOf(kernel->runCheap, *data);
        std::printf("| %s | %s | %.3f | %s | %.3f | %.2f %s |\n", kernel->axis, kernel->exact, exactTime, kernel->cheap,
                    cheapTime, largestDifference(*kernel, *exact, *data), kernel->of);
    }
    return 0;
}

}  // namespace
}  // namespace vernier::bench

int main() {
    return vernier::bench::main();
}
#endif
