// Colours of whole blocks into attachments of four 8-bit components, with the blend equations that are used most: one
// routine from planes of colours to stored texels. The same bits as outputColors(), which does everything else.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/simd.h"
#include "runtime/plan/plan.h"
#include "runtime/raster/fragment_batch.h"

namespace vernier {

struct BlockColorInput {
    const ColorPlan* plan;
    std::byte* texels;  // of the first pixel of the rectangle, in the sample that is written
    size_t rowPitch;
    LaneOrder order;  // rows or quads
    uint32_t lanes;   // a multiple of 16
    const float* source[4];
    const uint32_t* mask;  // per lane: ~0: written, 0: not; nullptr: all are
};

using BlockColorFn = void (*)(const BlockColorInput& input);

/// The routine for a plan; nullptr when there is none.
BlockColorFn blockColorFunction(const ColorPlan& plan, Isa isa);

}  // namespace vernier
