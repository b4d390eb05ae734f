// How often a value can change: what can be computed once per draw need not be computed per batch.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// From the one that changes least.
///  constant    made of constants
///  draw        and of loads, at draw-rate places, from push constants and from buffers that the program only reads.
///              Such loads may run before any branch: outside a buffer they give 0. In compute also NumWorkgroups: a
///              dispatch is a draw.
///  workGroup   compute: and of WorkgroupId
///  instance    vertex: and of InstanceIndex and what is given per draw command
///  primitive   fragment: and of flat inputs, PrimitiveId, FrontFacing, Layer, ViewportIndex
///  pixel       fragment: and of what interpolation and FragCoord give at the pixel's centre or centroid
///  sample      fragment, in programs that run per sample: and of what differs between a pixel's samples
///  invocation  everything else: other loads, images, phis, derivatives, subgroups; the vertices' own inputs
enum class Rate : uint8_t { constant, draw, workGroup, instance, primitive, pixel, sample, invocation };
inline constexpr size_t kRateCount = 8;
std::string_view rateName(Rate rate);

/// Whether all lanes of a batch have one value, unless it holds several work-groups.
constexpr bool isUniform(Rate rate) {
    return rate <= Rate::workGroup;
}

/// By value, the lowest rate that is safe. Values without a definition are `invocation`.
std::vector<Rate> computeRates(const Program& program);

/// Operations by the rate of their result; constants, inputs, phis and what has no result are not counted.
std::array<uint32_t, kRateCount> countByRate(const Program& program);

/// What they cost, in simple operations, each of them counted once (ir/cost.h); an image is `kImageCost`, another
/// access to memory `kAccessCost`.
std::array<uint32_t, kRateCount> costByRate(const Program& program);
inline constexpr uint32_t kImageCost = 40, kAccessCost = 4;

}  // namespace vernier::ir
