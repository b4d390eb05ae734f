// Fragment programs that run per sample, in two: what all samples of a pixel share, and the rest.
#pragma once

#include <cstdint>
#include <optional>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// `pixel` runs once per pixel, with inputs taken at its centre. `sample` runs once per sample and reads from `pixel`
/// what it needs: user inputs from location kFirstCarried on, flat, are the user outputs of `pixel` at the same
/// location and component. Together they do what the program did, to the bit, if that took its inputs at the centre as
/// well.
struct SplitProgram {
    Program pixel, sample;
    uint32_t operations = 0;  // of `pixel`
};
inline constexpr uint16_t kFirstCarried = 0xFF80;  // behind all that linking makes
constexpr bool isCarried(const InterfaceSlot& slot) {
    return slot.builtin == Builtin::user && slot.location >= kFirstCarried;
}

/// Splits a linked fragment program that asks for samples. What moves: operations whose operands do not differ between
/// samples, loads of what the program only reads, and, where all lanes come by (the first block, before a demotion),
/// derivatives and reads of sampled images. Inputs declared `sample` or `centroid`, SampleId, SamplePosition,
/// SampleMask, FragCoord, PointCoord and HelperInvocation differ, and so does what control flow chooses; what stores or
/// discards stays per sample. Nothing when the program is not per sample, uses subgroups, or would save less than
/// kLeastSplit.
std::optional<SplitProgram> splitSamples(const Program& fragment);

/// In simple operations per pixel of four samples, what carrying values costs subtracted.
inline constexpr uint32_t kLeastSplit = 24;

}  // namespace vernier::ir
