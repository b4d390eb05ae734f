// Effects of the pipeline state, each as scenes that differ in nothing else: without it, with it in the state but
// without need, and with need for it. What is not needed must cost nothing.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "conformance/scene/scene.h"

namespace vernier::bench {

struct Effect {
    std::string name;  // file-name safe
    std::string idle;  // what the idle scene has in its state
    // scenes[kOff] and scenes[kIdle] give the same picture; scenes[kNeeded] another one where `visible`.
    static constexpr size_t kOff = 0, kIdle = 1, kNeeded = 2;
    std::vector<conformance::Scene> scenes;
    bool visible = true;
    bool queries = false;     // the idle scene has queries around nothing, the needed one around its pass
    double tolerance = 0.02;  // of instructions, by which idle may exceed off
};

/// All effects, in the order of the table. An error is a bug in a scene.
Result<std::vector<Effect>> makeEffects();

}  // namespace vernier::bench
