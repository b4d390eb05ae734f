// The batch interpreter against one fused native loop: a lit fragment of 35 scalar operations (normalise, two
// dot products, a power by squaring, three colour channels), both over rows of the same length. The counter
// is nanoseconds per lane operation.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/micro/interp_bench.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "base/simd.h"

#ifndef VERNIER_INTERP_BENCH_LIT
#define VERNIER_INTERP_BENCH_LIT
namespace vernier::bench {
namespace {
/// Uniforms: light, half vector (3 each), ambient, diffuse, specular.
struct LitUniforms {
    float values[9] = {0.3f, 0.5f, 0.8f, 0.1f, 0.6f, 0.7f, 0.2f, 0.9f, 0.4f};
};
constexpr int kLitOperations = 35;
}  // namespace
}  // namespace vernier::bench
#endif

HWY_BEFORE_NAMESPACE();
namespace vernier::bench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void litNative(const LitUniforms& uniforms, const float* const* in, float* const* out, size_t lanes) {
    const hn::ScalableTag<float> d;
    const auto u = [&](int k) HWY_ATTR { return hn::Set(d, uniforms.values[k]); };
    const auto lx = u(0), ly = u(1), lz = u(2), hx = u(3), hy = u(4), hz = u(5);
    const auto ambient = u(6), diffuse = u(7), specular = u(8), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    for (size_t k = 0; k < lanes; k += hn::Lanes(d)) {
        auto x = hn::Load(d, in[0] + k), y = hn::Load(d, in[1] + k), z = hn::Load(d, in[2] + k);
        const auto length2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
        const auto inverse = hn::Div(one, hn::Sqrt(length2));
        x = hn::Mul(x, inverse);
        y = hn::Mul(y, inverse);
        z = hn::Mul(z, inverse);
        const auto nl = hn::Max(hn::Add(hn::Add(hn::Mul(x, lx), hn::Mul(y, ly)), hn::Mul(z, lz)), zero);
        auto s = hn::Max(hn::Add(hn::Add(hn::Mul(x, hx), hn::Mul(y, hy)), hn::Mul(z, hz)), zero);
        for (int squared = 0; squared < 4; ++squared) s = hn::Mul(s, s);
        const auto light = hn::Add(hn::Mul(nl, diffuse), ambient);
        const auto shine = hn::Mul(s, specular);
        for (int c = 0; c < 3; ++c) {
            hn::Store(hn::Add(hn::Mul(hn::Load(d, in[3 + c] + k), light), shine), d, out[c] + k);
        }
    }
}

}  // namespace vernier::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "spirv_interp/ir/parse.h"
#include "spirv_interp/program.h"

namespace vernier::bench {
namespace {

using Lit = void (*)(const LitUniforms&, const float* const*, float* const*, size_t);
Lit litNative(Isa isa) {
    VERNIER_SELECT_ISA(isa, litNative)
}

constexpr const char* kLitProgram = R"(program fragment "lit"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
input 2 f32 user 0.2 smooth center
input 3 f32 user 1.0 smooth center
input 4 f32 user 1.1 smooth center
input 5 f32 user 1.2 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
output 2 f32 user 0.2
resource 0 uniformBuffer 0.0 x1 read
b0:
  %0 i32 = constant 0
  %1 i32 = constant 4
  %2 i32 = constant 8
  %3 i32 = constant 12
  %4 i32 = constant 16
  %5 i32 = constant 20
  %6 i32 = constant 24
  %7 i32 = constant 28
  %8 i32 = constant 32
  %9 f32 = loadBuffer #0 %0 %0
  %10 f32 = loadBuffer #0 %0 %1
  %11 f32 = loadBuffer #0 %0 %2
  %12 f32 = loadBuffer #0 %0 %3
  %13 f32 = loadBuffer #0 %0 %4
  %14 f32 = loadBuffer #0 %0 %5
  %15 f32 = loadBuffer #0 %0 %6
  %16 f32 = loadBuffer #0 %0 %7
  %17 f32 = loadBuffer #0 %0 %8
  %18 f32 = constant 0
  %20 f32 = input #0
  %21 f32 = input #1
  %22 f32 = input #2
  %23 f32 = fmul %20 %20
  %24 f32 = fmul %21 %21
  %25 f32 = fmul %22 %22
  %26 f32 = fadd %23 %24
  %27 f32 = fadd %26 %25
  %28 f32 = finverseSqrt %27
  %29 f32 = fmul %20 %28
  %30 f32 = fmul %21 %28
  %31 f32 = fmul %22 %28
  %32 f32 = fmul %29 %9
  %33 f32 = fmul %30 %10
  %34 f32 = fmul %31 %11
  %35 f32 = fadd %32 %33
  %36 f32 = fadd %35 %34
  %37 f32 = fmax %36 %18
  %38 f32 = fmul %29 %12
  %39 f32 = fmul %30 %13
  %40 f32 = fmul %31 %14
  %41 f32 = fadd %38 %39
  %42 f32 = fadd %41 %40
  %43 f32 = fmax %42 %18
  %44 f32 = fmul %43 %43
  %45 f32 = fmul %44 %44
  %46 f32 = fmul %45 %45
  %47 f32 = fmul %46 %46
  %48 f32 = fmul %37 %16
  %49 f32 = fadd %48 %15
  %50 f32 = fmul %47 %17
  %51 f32 = input #3
  %52 f32 = input #4
  %53 f32 = input #5
  %54 f32 = fmul %51 %49
  %55 f32 = fadd %54 %50
  %56 f32 = fmul %52 %49
  %57 f32 = fadd %56 %50
  %58 f32 = fmul %53 %49
  %59 f32 = fadd %58 %50
  storeOutput #0 %55
  storeOutput #1 %57
  storeOutput #2 %59
  ret
)";

void report(benchmark::State& state, uint32_t lanes) {
    state.counters["ns/lane-op"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * lanes * kLitOperations * 1e-9,
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// An input row as interpolation would leave it.
void fill(float* row, uint32_t slot, uint32_t lanes) {
    for (uint32_t lane = 0; lane < lanes; ++lane)
        row[lane] = 0.25f + 0.01f * static_cast<float>((lane + slot * 5) % 64);
}

void nativeLit(benchmark::State& state) {
    const auto isa = static_cast<Isa>(state.range(0));
    const auto lanes = static_cast<uint32_t>(state.range(1));
    if (isa > bestIsa()) return state.SkipWithError("not on this CPU");
    std::vector<float> storage(9 * 128 + 16);
    auto* base = storage.data();
    while (reinterpret_cast<uintptr_t>(base) % 64 != 0) ++base;
    const float* in[6];
    float* out[3];
    for (uint32_t k = 0; k < 6; ++k) {
        fill(base + k * 128, k, lanes);
        in[k] = base + k * 128;
    }
    for (uint32_t k = 0; k < 3; ++k) out[k] = base + (6 + k) * 128;
    const Lit lit = litNative(isa);
    const LitUniforms uniforms;
    for (auto _ : state) {
        lit(uniforms, in, out, lanes);
        benchmark::ClobberMemory();
    }
    report(state, lanes);
}

void batchLit(benchmark::State& state) {
    const auto isa = static_cast<Isa>(state.range(0));
    if (isa > bestIsa()) return state.SkipWithError("not on this CPU");
    const auto program = ir::parse(kLitProgram);
    if (!program) return state.SkipWithError(program.error().message.c_str());
    const auto compiled =
        BatchProgram::compile(*program, {isa, MathTier::standard, static_cast<uint32_t>(state.range(1))});
    if (!compiled) return state.SkipWithError(compiled.error().message.c_str());
    const uint32_t lanes = (*compiled)->lanes();
    LitUniforms uniforms;
    const BufferBinding buffer{reinterpret_cast<std::byte*>(uniforms.values), sizeof uniforms.values};
    const uint32_t first = 0, count = 1;
    ResourceBindings bindings;
    bindings.buffers = &buffer;
    bindings.base = &first;
    bindings.count = &count;
    BatchContext context(*compiled);
    context.beginDraw(bindings);
    const std::vector<uint32_t> mask(128, ~0u);
    // Input rows are reused by the run; refilling them is the caller's work and not measured: what they hold
    // between runs is some other value of the program, finite all the same.
    for (uint32_t k = 0; k < 6; ++k) fill(context.input(k), k, lanes);
    for (auto _ : state) {
        if (!context.run(lanes, mask.data(), mask.data())) return state.SkipWithError("lost");
        benchmark::ClobberMemory();
    }
    report(state, lanes);
}

void grid(benchmark::internal::Benchmark* benchmark) {
    benchmark->ArgNames({"isa", "lanes"});
    for (const int isa : {0, 1, 2}) {
        for (const int lanes : {16, 32, 64}) benchmark->Args({isa, lanes});
    }
}
BENCHMARK(nativeLit)->Apply(grid);
BENCHMARK(batchLit)->Apply(grid);

}  // namespace
}  // namespace vernier::bench

BENCHMARK_MAIN();
#endif
