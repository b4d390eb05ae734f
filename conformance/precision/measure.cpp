#include "conformance/precision/measure.h"

#include <mpfr.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>

#include "conformance/drivers/try.h"
#include "conformance/precision/judge.h"

namespace vernier::precision {
namespace {

constexpr uint64_t kChunk = 4096;

/// All chunks, each once, far from one after the other: a maximum is near its final value soon, and errors that grow
/// from one operand to the next do not raise it (and ask MPFR) at every one.
class ScatteredChunks {
  public:
    explicit ScatteredChunks(uint64_t calls) : calls_(calls), chunks_((calls + kChunk - 1) / kChunk) {
        step_ = static_cast<uint64_t>(static_cast<double>(chunks_) * 0.6180339887) | 1;
        while (std::gcd(step_, chunks_) != 1) ++step_;
    }
    /// Thread-safe.
    bool next(uint64_t& first, uint64_t& count) {
        const uint64_t turn = turn_.fetch_add(1);
        if (turn >= chunks_) return false;
        first = turn * step_ % chunks_ * kChunk;
        count = std::min(kChunk, calls_ - first);
        return true;
    }

  private:
    uint64_t calls_, chunks_, step_ = 1;
    std::atomic<uint64_t> turn_ = 0;
};

Result<Figures> measureDriver(const Function& function, const MeasureOptions& options) {
    const uint64_t calls = callCount(function, options.stride, options.samples);
    // A thinner grid of floats, so that every magnitude is among them.
    const uint64_t thinning =
        function.domain == Domain::floats ? std::max<uint64_t>(1, calls / options.driverSamples) : 1;
    Chunk chunk;
    chunk.fill(function, 0, std::min(calls / thinning, options.driverSamples), options.stride * thinning);
    Results results;
    VERNIER_TRY(options.driver->run(function, chunk.operands, chunk.size(), results));
    Figures figures;
    Judge(function, 0, true).add(chunk, results, figures);
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
    ScatteredChunks chunks(callCount(function, options.stride, options.samples));
    std::vector<Measurement> parts(options.threads);
    const auto work = [&](Measurement& part) {
        // MPFR keeps constants and memory per thread.
        const struct Caches {
            ~Caches() { mpfr_free_cache(); }
        } caches;
        std::vector<BatchRunner> runners;
        std::vector<Judge> judges;
        for (size_t tier = 0; tier < kTiers.size(); ++tier) {
            runners.emplace_back(compiled[tier]);
            judges.emplace_back(function, tier, false);
        }
        Chunk chunk;
        Results results;
        for (uint64_t first, count; chunks.next(first, count);) {
            chunk.fill(function, first, count, options.stride);
            for (size_t tier = 0; tier < kTiers.size(); ++tier) {
                runners[tier].run(chunk.operands, chunk.size(), results);
                judges[tier].add(chunk, results, part.tiers[tier]);
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
    if (options.driver != nullptr && function.operand != Word::float16 && function.result != Word::float16) {
        auto figures = measureDriver(function, options);
        if (!figures) return figures.error();
        result.driver = *figures;
    }
    return result;
}

}  // namespace vernier::precision
