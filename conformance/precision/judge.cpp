#include "conformance/precision/judge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

namespace vernier::precision {
namespace {

using reference::Real;

/// The C library's double functions are good to a few 2^-53: this many ULP of float, with room to spare. Closer calls
/// are MPFR's.
constexpr double kDoubt = 0x1p-22;

bool isDenormal(Word word, double x) {
    return x != 0 && std::fabs(x) < leastNormalOf(resultFormat(word));
}

uint64_t bitsOf(const Results& results, Word word, size_t i) {
    const uint64_t low = std::bit_cast<uint32_t>(results[0][i]);
    return wordsOf(word) == 1 ? low : low | uint64_t{std::bit_cast<uint32_t>(results[1][i])} << 32;
}

/// The number that bits stand for; `word` is no float16.
Real numberOf(Word word, uint64_t bits) {
    if (word == Word::int64) return static_cast<int64_t>(bits);
    return word == Word::uint64 ? Real(bits) : Real(operandValue(word, bits));
}

Real exactly(const Function& function, const std::array<uint64_t, kMaxOperands>& bits) {
    Real operands[kMaxOperands];
    for (uint32_t k = 0; k < function.operands; ++k) {
        const Word word = function.operand;
        operands[k] = word == Word::float16 ? Real(operandValue(word, bits[k])) : numberOf(word, bits[k]);
    }
    return function.exact(operands);
}

void raise(Worst& worst, double value, const std::array<uint64_t, kMaxOperands>& operands) {
    if (value > worst.value) worst = {value, operands};
}

}  // namespace

Judge::Judge(const Function& function, size_t tier, bool flushes)
    : function_(function),
      promise_(flushes ? Promise{} : function.promises[tier]),
      flushes_(flushes),
      overflow_(overflowOf(function.result)) {}

void Judge::add(const Chunk& chunk, const Results& results, Figures& figures) {
    values_.resize(chunk.size());
    // One loop for each format, without a choice inside.
    const auto decode = [&](auto word) {
        for (size_t i = 0; i < chunk.size(); ++i) {
            const double value = resultValue(word, bitsOf(results, word, i));
            values_[i] = value > overflow_ ? overflow_ : value < -overflow_ ? -overflow_ : value;
        }
    };
    switch (function_.result) {
#define VERNIER_DECODE(word)                                \
    case Word::word:                                        \
        decode(std::integral_constant<Word, Word::word>()); \
        break;
        VERNIER_DECODE(float32)
        VERNIER_DECODE(float16)
        VERNIER_DECODE(int32)
        VERNIER_DECODE(uint32)
        VERNIER_DECODE(float64)
        VERNIER_DECODE(int64)
        VERNIER_DECODE(uint64)
#undef VERNIER_DECODE
    }
    if (function_.cancels || flushes_) {
        suspect_.assign(chunk.size(), 1);
    } else {
        screen(chunk, figures);
    }
    for (size_t i = 0; i < chunk.size(); ++i)
        if (suspect_[i] != 0 && !leftOut(chunk, i)) addOne(chunk, results, i, figures);
}

void Judge::screen(const Chunk& chunk, Figures& figures) {
    const size_t count = chunk.size();
    suspect_.resize(count);
    const double most = figures.ulp.value - kDoubt, mostAbsolute = figures.absolute.value;
    const double mostLimit = figures.limit.value, mostPromise = figures.promise.value;
    // Promises of less than nothing are none.
    const double promised = promise_.ulp >= 0 ? promise_.ulp : kUnknown, promisedAbsolute = promise_.absolute;
    double sum = 0;
    uint64_t correct = 0, judged = 0;
    for (size_t i = 0; i < count; ++i) {
        const double value = values_[i], bounded = chunk.bounded[i];
        const double error = std::fabs(value - bounded), ulps = error * chunk.inverseUlp[i];
        const double promise = chunk.scale[i] * std::max(promised * chunk.ulp[i], promisedAbsolute);
        const bool number = error == error;
        const bool same = (error <= 0) | ((value != value) & (bounded != bounded));
        sum += number ? ulps : 0;
        judged += number ? 1 : 0;
        correct += ulps <= 0.5 ? 1 : 0;
        const bool within = (ulps <= most) & (error <= mostAbsolute) & !(error > mostLimit * chunk.permitted[i]) &
                            !(error > mostPromise * promise);
        suspect_[i] = (within | same) ? 0 : 1;
    }
    figures.ulpSum += sum;
    figures.calls += judged;
    figures.correct += correct;
}

bool Judge::leftOut(const Chunk& chunk, size_t i) const {
    if (!flushes_) return false;
    bool denormal = isDenormal(function_.result, chunk.approximate[i]);
    for (uint32_t k = 0; k < function_.operands; ++k) {
        denormal = denormal || isDenormal(function_.operand, chunk.values[k][i]);
    }
    return denormal || std::isnan(chunk.approximate[i]);
}

void Judge::addOne(const Chunk& chunk, const Results& results, size_t i, Figures& figures) const {
    const auto operands = chunk.callBits(function_, i);
    double exact = chunk.bounded[i], ulp = chunk.ulp[i];
    double error = std::fabs(values_[i] - exact), ulps = error / ulp;
    const bool screened = !function_.cancels && !flushes_;
    // A maximum that doubles raise already, within their doubt, is MPFR's to decide.
    const bool close = error > 0 && error + kDoubt * ulp > figures.ulp.value * ulp;
    if (function_.exact != nullptr && (function_.cancels || close)) {
        const Real overflow = ldexp(Real(1), overflowExponentOf(function_.result));
        const auto bounded = [&](const Real& x) { return x > overflow ? overflow : x < -overflow ? -overflow : x; };
        const Real number = exactly(function_, operands);
        const Word format = resultFormat(function_.result);
        const Real got = bounded(numberOf(format, bitsOf(results, format, i))), wanted = bounded(number);
        exact = static_cast<double>(wanted);
        ulp = ulpOf(function_.result, exact);
        error = static_cast<double>(fabs(wanted - got));
        ulps = static_cast<double>(fabs(wanted - got) / Real(ulp));
    }
    const bool none = std::isnan(exact);
    if (none || std::isnan(values_[i])) {
        if (none != std::isnan(values_[i])) ++figures.wrongNaNs;
        return;
    }
    if (!screened) {
        ++figures.calls;
        figures.ulpSum += ulps;
        if (ulps <= 0.5) ++figures.correct;
    }
    raise(figures.ulp, ulps, operands);
    raise(figures.absolute, error, operands);
    if (error > 0) raise(figures.limit, error / chunk.permitted[i], operands);
    if (promise_.ulp >= 0 && ulps > 0) {
        // In ULP, for those of doubles may be too small for a double.
        const double promised = std::max(promise_.ulp, promise_.absolute / ulp);
        raise(figures.promise, ulps / (chunk.scale[i] * promised), operands);
    }
}

}  // namespace vernier::precision
