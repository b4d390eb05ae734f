// What was measured of one effect.
#pragma once

#include <string>
#include <vector>

#include "bench/effects/count_effects.h"

namespace vernier::bench {

struct EffectRow {
    const Effect* effect = nullptr;
    std::vector<SceneCost> costs;  // one per scene of the effect; instructions 0: not counted

    bool has(size_t scene) const { return scene < costs.size(); }
    /// Instructions against those without the effect.
    double ratio(size_t scene) const {
        if (!has(scene) || costs[Effect::kOff].instructions == 0) return 0;
        return static_cast<double>(costs[scene].instructions) / static_cast<double>(costs[Effect::kOff].instructions);
    }
    /// Time likewise.
    double timeRatio(size_t scene) const {
        if (!has(scene) || costs[Effect::kOff].milliseconds <= 0) return 0;
        return costs[scene].milliseconds / costs[Effect::kOff].milliseconds;
    }
    /// What is wrong, or nothing.
    std::string complaint() const {
        if (costs[Effect::kIdle].picture != costs[Effect::kOff].picture) return "the picture changes unused";
        const bool same =
            has(Effect::kNeeded) && effect->visible && costs[Effect::kNeeded].picture == costs[Effect::kOff].picture;
        if (same) return "the picture does not change where it should";
        if (ratio(Effect::kIdle) > 1 + effect->tolerance) return "COSTS UNUSED";
        return {};
    }
};

}  // namespace vernier::bench
