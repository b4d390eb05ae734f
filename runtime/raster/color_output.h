// Colours of a batch into an attachment: blending, logic operations, write masks, conversion.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/plan/plan.h"
#include "runtime/raster/blend.h"
#include "runtime/raster/fragment_batch.h"
#include "runtime/raster/pass_targets.h"

namespace vernier {

/// Scratch memory of one thread.
struct ColorScratch {
    static constexpr uint32_t kMaxTexelBytes = 16;
    alignas(64) std::array<float, kLaneRoom> destination[4];
    alignas(64) std::array<std::byte, kLaneRoom * kMaxTexelBytes> before, after;
};

struct ColorOutputInput {
    const ColorPlan* plan;
    const RenderTarget* target;
    const FragmentBatch* batch;
    BlendFn blend;
    const float* constants;  // of blending
    const float* source[4];  // planes of kLaneRoom lanes
    const float* second[4];  // nullptr: no second source
    const uint32_t* mask;    // per lane: written; nullptr: all are
    uint32_t sample;
    bool packed;  // the scratch memory has the texels of the batch from another sample; only where texels are stored as
                  // they are
};

/// The texel of a pixel in the sample that is written.
inline std::byte* texelAddress(const ColorOutputInput& input, int32_t x, int32_t y) {
    return input.target->data + static_cast<size_t>(y) * input.target->rowPitch +
           static_cast<size_t>(x) * input.plan->texelBytes + input.sample * input.target->samplePitch;
}

/// Texels of the lanes of a batch, in order, from and to the attachment; only those that the mask lets through are
/// stored. Of two lanes on one pixel the later one stays.
void gatherTexels(const ColorOutputInput& input, std::byte* texels);
void scatterTexels(const ColorOutputInput& input, const std::byte* texels);

/// Lanes that the mask lets through.
uint32_t writtenLanes(const ColorOutputInput& input);

/// Lanes are written in order, so that of two lanes on one pixel the later one stays. With a destination
/// read, no pixel may be there twice. Returns how many pixels were read back.
uint32_t outputColors(const ColorOutputInput& input, ColorScratch& scratch);

}  // namespace vernier
