// Who is right where drivers disagree, and what the other one does instead.
#pragma once

#include "conformance/arbiter/hypotheses.h"
#include "conformance/differ/classify.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vernier::conformance {

/// How many of an implementation's wrong pixels a hypothesis explains.
struct Explanation {
    const Hypothesis* hypothesis = nullptr;
    uint64_t wrong = 0;      // pixels outside of what the specification permits, of all outputs
    uint64_t explained = 0;  // of these, those that are right under the hypothesis
    uint64_t broken = 0;     // pixels that are right by the specification and would be wrong under the hypothesis
    /// All wrong pixels but a few stragglers, without costing as many others.
    bool convinces() const { return wrong != 0 && explained * 20 >= wrong * 19 && broken * 20 <= wrong; }
};

/// The oracle's images of a scene under rules; nothing when it has none in time.
using AskOracle = std::function<std::optional<std::vector<OracleImage>>(const Hypothesis& hypothesis)>;

/// Pixels of an implementation's images that the oracle does not permit.
Result<uint64_t> wrongPixels(const std::vector<RenderedImage>& images, const std::vector<OracleImage>& oracle);

/// Tries the hypotheses that change something in this scene, until one convinces: returns that one, or the one that
/// explains most, or nothing when nothing is wrong or none explains anything.
Result<std::optional<Explanation>> explainWrong(const Scene& scene, const std::vector<RenderedImage>& images,
                                                const std::vector<OracleImage>& oracle, const AskOracle& ask);

/// One sentence: "2 of 83 wrong pixels ...", for the report.
std::string describe(const Explanation& explanation);

}  // namespace vernier::conformance
