#include "runtime/raster/color_output.h"

#include <cstring>

namespace vernier {
namespace {

// One texel size, and for whole rows of a block one length, known at compile time make each copy a few moves.

template <uint32_t kBytes>
void copyTexels(std::byte* to, const std::byte* from, uint32_t count) {
    if (count == static_cast<uint32_t>(kBlockSize)) {
        std::memcpy(to, from, kBytes * kBlockSize);
    } else {
        for (uint32_t n = 0; n < count; ++n) std::memcpy(to + n * kBytes, from + n * kBytes, kBytes);
    }
}

/// Calls function(x, y, first, count) for the runs of pixels of a batch.
template <class Function>
void forEachRun(const FragmentBatch& batch, const Function& function) {
    switch (batch.order) {
        case LaneOrder::spans:
            for (uint32_t s = 0; s < batch.spanCount; ++s) {
                const FragmentSpan& span = batch.spans[s];
                function(span.x, span.y, span.first, span.count);
            }
            return;
        case LaneOrder::rows:
            for (uint32_t lane = 0; lane < batch.count; lane += kBlockSize)
                function(batch.originX, batch.originY + static_cast<int32_t>(rowOf(LaneOrder::rows, lane)), lane,
                         static_cast<uint32_t>(kBlockSize));
            return;
        case LaneOrder::quads:
            for (uint32_t lane = 0; lane < batch.count; lane += 2)
                function(batch.originX + static_cast<int32_t>(columnOf(LaneOrder::quads, lane)),
                         batch.originY + static_cast<int32_t>(rowOf(LaneOrder::quads, lane)), lane, 2u);
            return;
    }
}

/// Lanes by themselves. What says where they lie is copied: texels are bytes, whose stores could change anything that
/// is read through a pointer.
template <uint32_t kBytes>
struct Lanes {
    explicit Lanes(const ColorOutputInput& in)
        : count(in.batch->count),
          mask(in.mask),
          x(in.batch->x.data()),
          y(in.batch->y.data()),
          origin(texelAddress(in, 0, 0)),
          rowPitch(in.target->rowPitch) {}
    std::byte* texel(uint32_t n) const {
        return origin + static_cast<size_t>(y[n]) * rowPitch + static_cast<size_t>(x[n]) * kBytes;
    }

    uint32_t count;
    const uint32_t* mask;
    const int32_t *x, *y;
    std::byte* origin;
    size_t rowPitch;
};

template <uint32_t kBytes>
void gather(const ColorOutputInput& in, std::byte* texels) {
    if (in.batch->order == LaneOrder::spans && in.batch->apart) {
        const Lanes<kBytes> lanes(in);
        for (uint32_t n = 0; n < lanes.count; ++n) std::memcpy(texels + n * kBytes, lanes.texel(n), kBytes);
        return;
    }
    forEachRun(*in.batch, [&](int32_t x, int32_t y, uint32_t first, uint32_t count) {
        copyTexels<kBytes>(texels + first * kBytes, texelAddress(in, x, y), count);
    });
}

template <uint32_t kBytes>
void scatter(const ColorOutputInput& in, const std::byte* texels) {
    if (in.batch->order == LaneOrder::spans && in.batch->apart) {
        const Lanes<kBytes> lanes(in);
        for (uint32_t n = 0; n < lanes.count; ++n)
            if (lanes.mask == nullptr || lanes.mask[n] != 0) std::memcpy(lanes.texel(n), texels + n * kBytes, kBytes);
        return;
    }
    forEachRun(*in.batch, [&](int32_t x, int32_t y, uint32_t first, uint32_t count) {
        std::byte* place = texelAddress(in, x, y);
        const std::byte* from = texels + first * kBytes;
        if (in.mask == nullptr) {
            copyTexels<kBytes>(place, from, count);
            return;
        }
        // At edges a branch would go either way: what is not written goes elsewhere.
        std::byte unwritten[kBytes * kBlockSize];
        std::byte* const places[] = {unwritten, place};
        for (uint32_t n = 0; n < count; ++n)
            std::memcpy(places[in.mask[first + n] & 1] + n * kBytes, from + n * kBytes, kBytes);
    });
}

template <class Function>
void withTexelSize(uint32_t bytes, const Function& function) {
    switch (bytes) {
        case 1:
            return function(std::integral_constant<uint32_t, 1>());
        case 2:
            return function(std::integral_constant<uint32_t, 2>());
        case 4:
            return function(std::integral_constant<uint32_t, 4>());
        case 8:
            return function(std::integral_constant<uint32_t, 8>());
        default:
            return function(std::integral_constant<uint32_t, 16>());
    }
}

uint8_t logicOp(VkLogicOp op, uint8_t s, uint8_t d) {
    // The operations are numbered by their truth table: bit 0 is the result for s = d = 1, bit 1 for s = 1, d
    // = 0, bit 2 for s = 0, d = 1, bit 3 for s = d = 0 (specification, "Logical Operations").
    const auto table = static_cast<uint32_t>(op);
    uint32_t result = 0;
    if ((table & 1) != 0) result |= s & d;
    if ((table & 2) != 0) result |= s & ~d;
    if ((table & 4) != 0) result |= ~s & d;
    if ((table & 8) != 0) result |= ~s & ~d;
    return static_cast<uint8_t>(result);
}

void applyLogicOp(VkLogicOp op, const std::byte* before, std::byte* after, uint32_t bytes) {
    for (uint32_t n = 0; n < bytes; ++n)
        after[n] = static_cast<std::byte>(logicOp(op, static_cast<uint8_t>(after[n]), static_cast<uint8_t>(before[n])));
}

/// Bits outside the write mask keep what they had.
void keepMasked(const ColorPlan& plan, const std::byte* before, std::byte* after, uint32_t count) {
    for (uint32_t n = 0; n < count; ++n) {
        for (uint32_t b = 0; b < plan.texelBytes; ++b) {
            const size_t at = n * plan.texelBytes + b;
            after[at] = (after[at] & plan.writeBits[b]) | (before[at] & ~plan.writeBits[b]);
        }
    }
}

}  // namespace

uint32_t writtenLanes(const ColorOutputInput& in) {
    uint32_t lanes = in.batch->count;
    for (uint32_t n = 0; in.mask != nullptr && n < in.batch->count; ++n) lanes -= 1 - (in.mask[n] & 1);
    return lanes;
}

void gatherTexels(const ColorOutputInput& in, std::byte* texels) {
    withTexelSize(in.plan->texelBytes, [&](auto bytes) { gather<bytes()>(in, texels); });
}

void scatterTexels(const ColorOutputInput& in, const std::byte* texels) {
    withTexelSize(in.plan->texelBytes, [&](auto bytes) { scatter<bytes()>(in, texels); });
}

uint32_t outputColors(const ColorOutputInput& in, ColorScratch& scratch) {
    const ColorPlan& plan = *in.plan;
    const uint32_t count = in.batch->count;
    const void* planes[4] = {in.source[0], in.source[1], in.source[2], in.source[3]};
    uint32_t reads = 0;
    if (plan.readsDestination) {
        gatherTexels(in, scratch.before.data());
        reads = writtenLanes(in);
    }
    if (plan.path == ColorPath::blend) {
        BlendInput blend{};
        blend.plan = &plan;
        blend.constants = in.constants;
        blend.count = count;
        void* destination[4];
        for (uint32_t c = 0; c < 4; ++c) {
            blend.source[c] = in.source[c];
            blend.secondSource[c] = in.second[c];
            blend.destination[c] = blend.result[c] = scratch.destination[c].data();
            destination[c] = scratch.destination[c].data();
            planes[c] = destination[c];
        }
        plan.ops.unpack(scratch.before.data(), count, destination);
        in.blend(blend);
    }
    if (!in.packed) plan.ops.pack(planes, count, scratch.after.data());
    if (plan.path == ColorPath::logic)
        applyLogicOp(plan.logicOp, scratch.before.data(), scratch.after.data(), count * plan.texelBytes);
    if (plan.partialMask) keepMasked(plan, scratch.before.data(), scratch.after.data(), count);
    scatterTexels(in, scratch.after.data());
    return reads;
}

}  // namespace vernier
