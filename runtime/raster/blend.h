// Blend equations (specification, "Blend Equations") in float, on planes of values.
#pragma once

#include <cstdint>

#include "base/simd.h"
#include "runtime/plan/plan.h"

namespace vernier {

struct BlendInput {
    const ColorPlan* plan;
    const float* constants;        // 4
    const float* source[4];        // planes
    const float* secondSource[4];  // dual source; nullptr: none
    const float* destination[4];
    float* result[4];  // may be the destination
    uint32_t count;    // planes have room for a multiple of 16
};

using BlendFn = void (*)(const BlendInput& input);
BlendFn blendFunction(Isa isa);

}  // namespace vernier
