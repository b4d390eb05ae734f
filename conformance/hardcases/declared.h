// What a driver declares about itself, by which its answers are judged.
#pragma once

#include "conformance/oracle/oracle.h"
#include "conformance/precision/promise.h"

#include <optional>
#include <string_view>

namespace vernier::conformance::hardcases {

/// What Vernier promises beyond the specification, at a position of its dial (docs/accuracy.md, docs/precision.md).
struct OwnBounds {
    precision::Promise functions, angles;  // errors of elementary functions; of sine and cosine
    double interpolation;                  // of what depends on inputs (OracleRules::interpolationError)
};

struct Declared {
    int subPixelBits = 8;
    std::optional<OwnBounds> own{};  // none: the specification's bounds alone

    /// What the specification permits such a driver.
    OracleRules rules() const;
    /// What it permits itself: vertices on the nearest place of the grid, weights of a filter and levels of detail with
    /// all the bits of a float. Only with bounds of its own.
    OracleRules ownRules() const;
};

/// Vernier's declaration at a profile by its name; empty: standard.
Declared vernierDeclares(int subPixelBits, std::string_view profile);

}  // namespace vernier::conformance::hardcases
