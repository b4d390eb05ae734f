// Cases about single operations of shaders: an expression on a table of inputs, and what its result may be row by row.
#pragma once

#include "conformance/hardcases/hard_case.h"
#include "conformance/scenes/recorder.h"

#include <array>
#include <bit>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vernier::conformance::hardcases {

/// Judges the 32 bits of a result.
using ValueJudge = std::function<Verdict(uint32_t result, const Declared& declared)>;

/// Inputs by bits, which the compiler cannot see, and the judge of the result.
struct ValueRow {
    std::array<uint32_t, 3> in{};
    ValueJudge judge;
};

/// What the shader has beside its inputs.
struct ValueShader {
    std::string extensions;      // lines of the shader before everything else
    std::string declarations;    // before main, behind u, i, f and row, the number of the row
    std::vector<uint32_t> data;  // of the storage buffer at binding 1, which `declarations` declare; none: no buffer
    std::function<void(std::vector<uint32_t>& words)> edit;  // of the module, for what GLSL cannot say
    bool robust = false;                                     // reaches outside of the buffer
};

/// Adds a scene that computes `expression`, a GLSL uint, for every row, with u(k) the k-th input as uint, i(k) as int
/// and f(k) as float; and the judge of all rows.
void addValues(CaseInput& input, std::string_view name, std::string_view expression, std::vector<ValueRow> rows,
               const ValueShader& shader);
inline void addValues(CaseInput& input, std::string_view name, std::string_view expression, std::vector<ValueRow> rows,
                      std::string_view declarations = "") {
    addValues(input, name, expression, std::move(rows), ValueShader{{}, std::string(declarations), {}, {}, false});
}

inline uint32_t bitsOf(float value) {
    return std::bit_cast<uint32_t>(value);
}

/// How a driver's own bounds of elementary functions apply to a result.
struct OwnTolerance {
    double scale = 1;    // of the promised ULPs
    bool angle = false;  // as OwnBounds::angles says, rather than functions

    /// By how much a driver with these bounds may be off.
    double of(double exactly, const OwnBounds& bounds) const;
};

/// Judges of a float result: exact when it is the float nearest to `exactly`, declared within the driver's own bounds
/// of it, allowed within `tolerance` of it. Denormals may be flushed to 0. Infinities stand for themselves; where
/// `exactly` is NaN nothing is asked.
ValueJudge floatNear(double exactly, double tolerance, OwnTolerance own = {});

/// The same with the tolerance in units in the last place of a float of that size.
ValueJudge floatWithin(double exactly, double ulps);

/// Exact when the bits are the first of these, allowed when they are another one; but declared when they are `own`, the
/// answer of drivers with bounds of their own.
ValueJudge oneOf(std::vector<uint32_t> bits, std::optional<uint32_t> own = std::nullopt);

/// Nothing is asked but that it runs.
ValueJudge anything();

/// The distance between neighbouring floats around a number.
double ulpOf(double value);

}  // namespace vernier::conformance::hardcases
