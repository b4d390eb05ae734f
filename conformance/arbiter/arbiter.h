// Who is right where drivers disagree, and what the other one does instead.
#pragma once

#include "conformance/arbiter/hypotheses.h"
#include "conformance/differ/classify.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::conformance {

/// Hypotheses that hold together.
using Hypotheses = std::vector<const Hypothesis*>;

/// What an implementation promises no better than by its limits, as Driver::limits() tells them.
Hypotheses declaredBy(std::string_view limits);

/// Their names, joined by '+'.
std::string namesOf(const Hypotheses& hypotheses);

/// How many of an implementation's wrong pixels hypotheses explain.
struct Explanation {
    Hypotheses hypotheses;
    uint64_t wrong = 0;      // pixels outside of what the specification permits, of all outputs
    uint64_t explained = 0;  // of these, those that are right under the hypotheses
    uint64_t broken = 0;     // pixels that are right by the specification and would be wrong under the hypotheses
    /// Every wrong pixel, and not by making others wrong instead.
    bool convinces() const { return wrong != 0 && explained == wrong && broken * 20 <= wrong; }
};

/// The oracle's images of a scene under hypotheses; nothing when it has none in time.
using AskOracle = std::function<std::optional<std::vector<OracleImage>>(const Hypotheses& hypotheses)>;

/// What an implementation is held to.
enum class HeldTo : uint8_t {
    specification,
    /// The rules that Vernier declares: where snapping, ties or the order of near depths leave a pixel open, it has the
    /// declared value.
    declaredRules,
};

/// Pixels of an implementation's images that the oracle does not permit.
Result<uint64_t> wrongPixels(const std::vector<RenderedImage>& images, const std::vector<OracleImage>& oracle,
                             HeldTo heldTo = HeldTo::specification);

/// Tries the hypotheses that change something in this scene, one by one and then added to the best of them, until what
/// holds together convinces: returns that, or what explains most, or nothing when nothing is wrong or nothing is
/// explained. Begins with what the implementation declares.
Result<std::optional<Explanation>> explainWrong(const Scene& scene, const std::vector<RenderedImage>& images,
                                                const std::vector<OracleImage>& oracle, const AskOracle& ask,
                                                const Hypotheses& declared = {}, HeldTo heldTo = HeldTo::specification);

/// One sentence: "2 of 83 wrong pixels ...", for the report.
std::string describe(const Explanation& explanation);

}  // namespace vernier::conformance
