#include "conformance/precision/measure.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <thread>

#include "conformance/drivers/try.h"

namespace vernier::precision {
namespace {

using reference::Real;

constexpr double kTwo128 = 0x1p128;
/// The C library's double functions are good to a few 2^-53: this many ULP of float, with room to spare. Closer calls
/// are MPFR's.
constexpr double kDoubt = 0x1p-22;
constexpr size_t kChunk = 4096;

bool isDenormal(double x) {
    return x != 0 && std::fabs(x) < 0x1p-126;
}

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
uint64_t scrambled(uint64_t n) {
    n += 0x9E3779B97F4A7C15;
    n = (n ^ n >> 30) * 0xBF58476D1CE4E5B9;
    n = (n ^ n >> 27) * 0x94D049BB133111EB;
    return n ^ n >> 31;
}

float operandOf(const Function& function, uint64_t call, uint32_t k, uint64_t stride) {
    if (function.domain == Domain::floats) return std::bit_cast<float>(static_cast<uint32_t>(call * stride));
    const uint64_t random = scrambled(call * kMaxOperands + k);
    const auto bits = static_cast<uint32_t>(random);
    const double unit = static_cast<double>(random >> 32) * 0x1p-32, sign = (bits & 1) != 0 ? -1 : 1;
    const uint64_t stratum = call % 4;
    if (function.domain == Domain::stratified) {
        if (stratum == 0) return std::bit_cast<float>(bits);
        if (stratum == 1 && k == 0) return static_cast<float>(1 + sign * std::exp2(-24 * unit));
        if (stratum == 1) return static_cast<float>(sign * std::exp2(40 * unit - 20));
    }
    if (stratum == 2) return static_cast<float>(sign * std::exp2(20 * unit - 10));
    return stratum == 3 && function.name == "ldexp" && k == 1 ? static_cast<float>(bits % 257) - 128
                                                              : static_cast<float>(16 * unit - 8);
}

/// A result as a number: infinities as the first power of two that float lacks.
double finite(double x) {
    return std::clamp(x, -kTwo128, kTwo128);
}

class Judge {
  public:
    Judge(const Function& function, size_t tier, bool flushes) : function_(function), tier_(tier), flushes_(flushes) {}

    /// `permitted`: the error that Vulkan permits.
    void add(const std::array<float, kMaxOperands>& operands, const double* x, double approximate, double permitted,
             float result, Figures& figures) const {
        double exact = approximate;
        std::optional<Real> real;
        if (function_.cancels) {
            real = exactly(x);
            exact = static_cast<double>(*real);
        }
        if (std::isnan(exact)) {
            // What a function without a result gives is the specification's to leave open, but for ours it is NaN.
            return;
        }
        if (flushes_) {
            bool denormal = isDenormal(exact);
            for (uint32_t k = 0; k < function_.operands; ++k) denormal = denormal || isDenormal(x[k]);
            if (denormal) return;
        }
        ++figures.calls;
        if (std::isnan(result)) {
            ++figures.wrongNaNs;
            return;
        }
        const double ulp = floatUlp(finite(exact));
        double error = std::fabs(finite(result) - finite(exact));
        if (real) error = errorOf(*real, result);
        if (!real && function_.exact != nullptr && error + kDoubt * ulp > figures.ulp.value * ulp && error > 0) {
            error = errorOf(exactly(x), result);
        }
        figures.ulpSum += error / ulp;
        if (error <= 0.5 * ulp || static_cast<float>(exact) == result) ++figures.correct;
        raise(figures.ulp, error / ulp, operands);
        raise(figures.absolute, error, operands);
        // Overflow is no error where the permitted interval reaches it.
        if (error > 0 && permitted < kTwo128 && std::fabs(exact) < kTwo128) {
            raise(figures.limit, error / permitted, operands);
        }
        const Promise& promise = function_.promises[tier_];
        if (promise.ulp >= 0 && !flushes_) {
            const double scale = function_.scale != nullptr ? function_.scale(x) : 1;
            // Half the last digit of a correctly rounded result may be exactly promised.
            raise(figures.promise, error / (scale * std::max(promise.ulp * ulp, promise.absolute)), operands);
        }
    }

  private:
    Real exactly(const double* x) const {
        Real operands[kMaxOperands];
        for (uint32_t k = 0; k < function_.operands; ++k) operands[k] = Real(x[k]);
        return function_.exact(operands);
    }
    static double errorOf(const Real& exact, float result) {
        const Real limit(kTwo128);
        const Real bounded = exact > limit ? limit : exact < -limit ? -limit : exact;
        return static_cast<double>(fabs(bounded - Real(finite(result))));
    }
    static void raise(Worst& worst, double value, const std::array<float, kMaxOperands>& operands) {
        if (value > worst.value) worst = {value, operands};
    }

    const Function& function_;
    size_t tier_;
    bool flushes_;
};

/// A stretch of calls: the operands that the function covers, their results in double, and the errors permitted.
struct Chunk {
    Operands operands;
    std::vector<double> approximate, permitted;

    void fill(const Function& function, uint64_t first, uint64_t count, uint64_t stride) {
        for (auto& row : operands) row.clear();
        approximate.clear();
        permitted.clear();
        for (uint64_t call = first; call < first + count; ++call) {
            double x[kMaxOperands] = {};
            bool usable = true;
            for (uint32_t k = 0; k < function.operands; ++k) {
                x[k] = operandOf(function, call, k, stride);
                usable = usable && (std::isfinite(x[k]) || function.exact == nullptr);
            }
            if (!usable || (function.covers != nullptr && !function.covers(x))) continue;
            for (uint32_t k = 0; k < function.operands; ++k) operands[k].push_back(static_cast<float>(x[k]));
            approximate.push_back(function.approximate(x));
            Bounded arguments[kMaxOperands] = {x[0], x[1], x[2], x[3], x[4], x[5]};
            permitted.push_back(function.permitted != nullptr ? function.permitted(arguments).error : kUnknown);
        }
    }
    template <class F>
    void forEach(const Function& function, F&& visit) const {
        for (size_t i = 0; i < approximate.size(); ++i) {
            std::array<float, kMaxOperands> call{};
            double x[kMaxOperands] = {};
            for (uint32_t k = 0; k < function.operands; ++k) x[k] = call[k] = operands[k][i];
            visit(i, call, x);
        }
    }
};

uint64_t callCount(const Function& function, const MeasureOptions& options) {
    constexpr uint64_t kFloats = uint64_t{1} << 32;
    return function.domain == Domain::floats ? (kFloats + options.stride - 1) / options.stride : options.samples;
}

Result<Figures> measureDriver(const Function& function, const MeasureOptions& options) {
    const uint64_t calls = callCount(function, options);
    // A thinner grid of floats, so that every magnitude is among them.
    const uint64_t thinning =
        function.domain == Domain::floats ? std::max<uint64_t>(1, calls / options.driverSamples) : 1;
    Chunk chunk;
    chunk.fill(function, 0, std::min(calls / thinning, options.driverSamples), options.stride * thinning);
    std::vector<float> results(chunk.approximate.size());
    VERNIER_TRY(options.driver->run(function, chunk.operands, results));
    const Judge judge(function, 0, true);
    Figures figures;
    chunk.forEach(function, [&](size_t i, const auto& call, const double* x) {
        judge.add(call, x, chunk.approximate[i], chunk.permitted[i], results[i], figures);
    });
    return figures;
}

}  // namespace

void Figures::merge(const Figures& other) {
    calls += other.calls;
    for (const auto worst : {&Figures::ulp, &Figures::absolute, &Figures::limit, &Figures::promise})
        if ((other.*worst).value > (this->*worst).value) this->*worst = other.*worst;
    ulpSum += other.ulpSum;
    correct += other.correct;
    wrongNaNs += other.wrongNaNs;
}

Result<Measurement> measure(const Function& function, const MeasureOptions& options) {
    std::vector<BatchFunction> compiled;
    for (const MathTier tier : kTiers) {
        auto batch = BatchFunction::compile(function, tier, options.isa);
        if (!batch) return batch.error();
        compiled.push_back(std::move(*batch));
    }
    const uint64_t calls = callCount(function, options);
    std::atomic<uint64_t> next = 0;
    std::vector<Measurement> parts(options.threads);
    const auto work = [&](Measurement& part) {
        std::vector<BatchRunner> runners;
        std::vector<Judge> judges;
        for (size_t tier = 0; tier < kTiers.size(); ++tier) {
            runners.emplace_back(compiled[tier]);
            judges.emplace_back(function, tier, false);
        }
        Chunk chunk;
        std::vector<float> results;
        for (uint64_t first; (first = next.fetch_add(kChunk)) < calls;) {
            chunk.fill(function, first, std::min<uint64_t>(kChunk, calls - first), options.stride);
            results.resize(chunk.approximate.size());
            for (size_t tier = 0; tier < kTiers.size(); ++tier) {
                runners[tier].run(chunk.operands, results);
                chunk.forEach(function, [&](size_t i, const auto& call, const double* x) {
                    judges[tier].add(call, x, chunk.approximate[i], chunk.permitted[i], results[i], part.tiers[tier]);
                });
            }
        }
    };
    std::vector<std::thread> threads;
    for (uint32_t t = 1; t < options.threads; ++t) threads.emplace_back(work, std::ref(parts[t]));
    work(parts[0]);
    for (std::thread& thread : threads) thread.join();

    Measurement result;
    result.function = &function;
    for (const Measurement& part : parts)
        for (size_t tier = 0; tier < kTiers.size(); ++tier) result.tiers[tier].merge(part.tiers[tier]);
    if (options.driver != nullptr) {
        auto figures = measureDriver(function, options);
        if (!figures) return figures.error();
        result.driver = *figures;
    }
    return result;
}

}  // namespace vernier::precision
