// Holds the results of one implementation of a function against the exact ones.
#pragma once

#include <vector>

#include "conformance/precision/chunk.h"
#include "conformance/precision/measure.h"

namespace vernier::precision {

/// Judges by doubles first, all calls of a chunk in simple loops; only calls that may raise a maximum of the figures
/// are computed in MPFR. Not thread-safe.
class Judge {
  public:
    /// `flushes`: denormal operands and results are not judged.
    Judge(const Function& function, size_t tier, bool flushes);
    /// The results belong to the calls of the chunk.
    void add(const Chunk& chunk, const Results& results, Figures& figures);

  private:
    void screen(const Chunk& chunk, Figures& figures);
    void addOne(const Chunk& chunk, const Results& results, size_t i, Figures& figures) const;
    bool leftOut(const Chunk& chunk, size_t i) const;

    const Function& function_;
    Promise promise_;
    bool flushes_;
    double overflow_;
    std::vector<double> values_;     // of the results
    std::vector<uint64_t> suspect_;  // calls that may raise a maximum
};

}  // namespace vernier::precision
