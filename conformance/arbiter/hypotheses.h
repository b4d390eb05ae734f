// What may be behind wrong pixels: rules other than those of the specification, or states of a scene other than those
// asked for. An implementation whose wrong pixels are all right under one of them follows it.
//
// A hypothesis changes the scene or the rules of the oracle; the oracle's answer to that is then what the
// implementation is compared with. It names a cause, it excuses nothing: wrong stays wrong.
#pragma once

#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

#include <span>
#include <string_view>

namespace vernier::conformance {

struct Hypothesis {
    std::string_view name;  // e.g. "weights7"
    std::string_view text;  // what the implementation would be doing, in words
    /// Changes scene and rules; false when that changes nothing in this scene.
    bool (*apply)(Scene& scene, OracleRules& rules);
};

/// All of them, those that change least first.
std::span<const Hypothesis> allHypotheses();

/// The one called `name`, or nullptr.
const Hypothesis* findHypothesis(std::string_view name);

}  // namespace vernier::conformance
