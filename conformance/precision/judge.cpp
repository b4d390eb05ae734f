#include "conformance/precision/judge.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vernier::precision {
namespace {

using reference::Real;

/// The C library's double functions are good to a few 2^-53: this many ULP of float, with room to spare. Closer calls
/// are MPFR's.
constexpr double kDoubt = 0x1p-22;

bool isDenormal(double x) {
    return x != 0 && std::fabs(x) < 0x1p-126;
}

Real exactly(const Function& function, const std::array<double, kMaxOperands>& x) {
    Real operands[kMaxOperands];
    for (uint32_t k = 0; k < function.operands; ++k) operands[k] = Real(x[k]);
    return function.exact(operands);
}

void raise(Worst& worst, double value, const std::array<double, kMaxOperands>& operands) {
    if (value > worst.value) worst = {value, operands};
}

}  // namespace

Judge::Judge(const Function& function, size_t tier, bool flushes)
    : function_(function),
      promise_(flushes ? Promise{} : function.promises[tier]),
      flushes_(flushes),
      overflow_(overflowOf(function.result)) {}

void Judge::add(const Chunk& chunk, std::span<const float> results, Figures& figures) {
    values_.resize(chunk.size());
    const auto decode = [&](Word word) {
        for (size_t i = 0; i < chunk.size(); ++i) {
            const double value = resultValue(word, std::bit_cast<uint32_t>(results[i]));
            values_[i] = value > overflow_ ? overflow_ : value < -overflow_ ? -overflow_ : value;
        }
    };
    switch (function_.result) {
        case Word::int32:
            decode(Word::int32);
            break;
        case Word::uint32:
            decode(Word::uint32);
            break;
        default:
            decode(Word::float32);
    }
    if (function_.cancels || flushes_) {
        suspect_.assign(chunk.size(), 1);
    } else {
        screen(chunk, figures);
    }
    for (size_t i = 0; i < chunk.size(); ++i)
        if (suspect_[i] != 0 && !leftOut(chunk, i)) addOne(chunk, i, figures);
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
    bool denormal = isDenormal(chunk.approximate[i]);
    for (uint32_t k = 0; k < function_.operands; ++k) denormal = denormal || isDenormal(chunk.values[k][i]);
    return denormal || std::isnan(chunk.approximate[i]);
}

void Judge::addOne(const Chunk& chunk, size_t i, Figures& figures) const {
    const auto operands = chunk.call(i);
    double exact = chunk.bounded[i], ulp = chunk.ulp[i];
    double error = std::fabs(values_[i] - exact);
    const bool screened = !function_.cancels && !flushes_;
    std::optional<Real> real;
    // A maximum that doubles raise already, within their doubt, is MPFR's to decide.
    const bool close = error > 0 && error + kDoubt * ulp > figures.ulp.value * ulp;
    if (function_.exact != nullptr && (function_.cancels || close)) real = exactly(function_, operands);
    if (real) {
        exact = std::clamp(static_cast<double>(*real), -overflow_, overflow_);
        ulp = ulpOf(function_.result, exact);
        const Real limit(overflow_);
        const Real bounded = *real > limit ? limit : *real < -limit ? -limit : *real;
        error = static_cast<double>(fabs(bounded - Real(values_[i])));
    }
    const bool none = std::isnan(exact);
    if (none || std::isnan(values_[i])) {
        if (none != std::isnan(values_[i])) ++figures.wrongNaNs;
        return;
    }
    if (!screened) {
        ++figures.calls;
        figures.ulpSum += error / ulp;
        if (error <= 0.5 * ulp) ++figures.correct;
    }
    raise(figures.ulp, error / ulp, operands);
    raise(figures.absolute, error, operands);
    if (error > 0) raise(figures.limit, error / chunk.permitted[i], operands);
    if (promise_.ulp >= 0 && error > 0) {
        raise(figures.promise, error / (chunk.scale[i] * std::max(promise_.ulp * ulp, promise_.absolute)), operands);
    }
}

}  // namespace vernier::precision
