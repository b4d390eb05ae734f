// What is known to fail, as data: each gap with its reason and its size. A gap that no longer shows fails the
// run too, so that the list stays true.
#pragma once

#include "base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::conformance {

/// Something that failed in a run: a number of pixels of a failing class, or 1 of kNotRendered.
struct Finding {
    std::string scene;
    std::string driver;   // whose fault it would be: "api", "icd"
    std::string against;  // "lavapipe", "swiftshader", "oracle", ...; empty for kNotRendered
    std::string kind;     // name of a PixelClass, or kNotRendered
    uint64_t count = 0;
};
inline constexpr std::string_view kNotRendered = "notRendered";
// Against the same driver with nothing left out (runtime/skips.h).
inline constexpr std::string_view kLeavingOutChangesBits = "leavingOutChangesBits";

struct KnownGap {
    std::string scene, driver;
    std::string against;  // empty: any
    std::string kind;
    uint64_t maxCount = 0;
    std::string reason;
};

/// Reads {"gaps": [{"scene", "driver", "against" (optional), "class", "max", "reason"}, ...]}. Every field is
/// checked: an unknown class, a zero max or an empty reason is an error that names the entry.
Result<std::vector<KnownGap>> parseKnownGaps(std::string_view json);

struct GapJudgement {
    std::vector<std::string> violations;  // findings that no gap covers, in words
    std::vector<std::string> stale;       // gaps that no finding needs, in words
    std::vector<std::string> covered;     // findings with the reason of their gap
    bool passed() const { return violations.empty() && stale.empty(); }
};

/// What a run consists of: gaps of scenes or drivers that were not part of it are not stale.
struct RunExtent {
    std::vector<std::string> scenes;
    std::vector<std::string> drivers;  // all that were tried
};

GapJudgement judgeFindings(std::span<const Finding> findings, std::span<const KnownGap> gaps, const RunExtent& run);

}  // namespace vernier::conformance
