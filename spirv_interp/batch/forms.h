// The forms of elementwise operations: where each operand is read, and whether the result is written to its row.
//
// A chain of elementwise operations hands its latest result on in vector registers, the *accumulator*: the next
// operation may read it there, and when nobody else wants the result it is never written. Which forms exist is
// decided here, for the handler tables and for whoever picks a form.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vernier::batch {

enum class Source : uint8_t { row, scalar, accumulator };

/// Sources of up to three operands and what becomes of the result, as an index into a handler table.
struct Form {
    Source sources[3] = {Source::row, Source::row, Source::row};
    bool stored = true;

    constexpr uint8_t index() const {
        const auto digit = [&](int k) { return static_cast<int>(sources[k]); };
        return static_cast<uint8_t>(digit(0) + 3 * digit(1) + 9 * digit(2) + (stored ? 0 : kUnstored));
    }
    static constexpr Form at(uint8_t index) {
        const int digits = index % kUnstored;
        return {{static_cast<Source>(digits % 3), static_cast<Source>(digits / 3 % 3), static_cast<Source>(digits / 9)},
                index < kUnstored};
    }
    constexpr size_t count(Source source, size_t operands) const {
        size_t n = 0;
        for (size_t k = 0; k < operands; ++k) n += sources[k] == source ? 1 : 0;
        return n;
    }
    static constexpr uint8_t kUnstored = 27;
};
inline constexpr size_t kForms = 2 * size_t{Form::kUnstored};

/// Which forms an elementwise operation has.
enum class FormSet : uint8_t {
    general,
    commutative,  // operands 0 and 1 may change places: fewer forms are needed
    byScalar,     // operand 1 is a scalar and operand 0 is none
    rare,         // rows and scalars only, result stored: keeps the code small
};

/// With scalars alone as operands the result is a scalar too. Where operands may change places, the accumulator comes
/// before rows and rows before scalars.
constexpr bool hasForm(size_t operands, FormSet set, Form form) {
    const auto [a, b, c] = form.sources;
    for (size_t k = operands; k < 3; ++k) {
        if (form.sources[k] != Source::row) return false;
    }
    if (form.count(Source::scalar, operands) == operands) return form.stored;
    const size_t accumulators = form.count(Source::accumulator, operands);
    if (set == FormSet::rare) return accumulators == 0 && form.stored;
    if (set == FormSet::byScalar) return a != Source::scalar && b == Source::scalar && accumulators < 2;
    if (set == FormSet::commutative) {
        const auto rank = [](Source source) {
            return source == Source::accumulator ? 0 : source == Source::row ? 1 : 2;
        };
        if (rank(a) > rank(b) || (a == Source::scalar && b == Source::scalar)) return false;
        // x * x + c is common; the accumulator in a factor and in the summand is not.
        return operands == 2 || a != Source::accumulator || c != Source::accumulator;
    }
    return operands == 2 || accumulators < 2;
}

}  // namespace vernier::batch
