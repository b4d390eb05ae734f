#include "conformance/hardcases/reasons.h"

#include <algorithm>

namespace vernier::conformance::hardcases {
namespace {

constexpr std::string_view kInterpolated[] = {"C10", "W06", "W07", "I05", "I06", "D11"};
constexpr std::string_view kThroughTheEye[] = {"C08", "C13", "I10"};
constexpr std::string_view kFiltered[] = {"L09", "T02", "T03", "T06", "T07", "T15"};
constexpr std::string_view kBlended[] = {"B19"};
constexpr std::string_view kFunctions[] = {"X01", "X02", "X03", "X04", "X05", "X09", "X17"};
constexpr std::string_view kFormulas[] = {"X12", "X13", "X20"};
constexpr std::string_view kPackedFloats[] = {"B12"};
constexpr std::string_view kSignsOfZero[] = {"N08"};

constexpr DeclaredReason kReasons[] = {
    {"interpolated values, by a few units in the last place of the largest vertex value",
     "Vertices are snapped, as they must be, and values are interpolated in float from the snapped ones: what is "
     "declared is a bound (raster_interpolation_test), and the nearest float of the unsnapped plane would be another "
     "rule. "
     "interpolation=double takes the arithmetic's share away and subpixel=16 the snapping's: W06 and W07 are exact at "
     "reference",
     kInterpolated},
    {"values and coverage of triangles that the eye plane or near and far cut, next to the cut",
     "New vertices are snapped like others; the oracle judges the unsnapped plane, and takes pixels within a sub-unit "
     "of an edge as open",
     kThroughTheEye},
    {"filtered texels in float targets, in the last digit of float",
     "Weights have all the bits of float, where 8 are asked for; products are rounded once each. Nearest would be sums "
     "of "
     "exact products",
     kFiltered},
    {"sums of blending in 32-bit float targets, in the last digit",
     "Source and destination terms are rounded before they are added; the specification asks for the target's "
     "precision, "
     "which that is",
     kBlended},
    {"elementary functions, within the bounds of docs/precision.md",
     "The tier math=standard declares bounds, all tighter than Vulkan's. At fine and reference these are exact",
     kFunctions},
    {"formulas that overflow or cancel although the result would not: length of 1e20, sums of 1e8 + 1 - 1e8",
     "Vulkan derives them from sums and products, in order; scaling or sorting would cost every program what these "
     "alone "
     "need, and programs that sum in an order of their own want that order",
     kFormulas},
    {"finite values beyond the largest of 10- and 11-bit floats: they become the largest, never infinity",
     "Either is permitted. A finite colour stays finite, as EXT_packed_float has it; rounding to even would give "
     "infinity",
     kPackedFloats},
    {"which zero an atomic minimum or maximum of -0 and 0 leaves",
     "They compare equal, either may stay: the one that is the same on every instruction set", kSignsOfZero},
};

}  // namespace

std::span<const DeclaredReason> declaredReasons() {
    return kReasons;
}

const DeclaredReason* whyDeclared(std::string_view id) {
    const auto found = std::ranges::find_if(
        kReasons, [&](const DeclaredReason& reason) { return std::ranges::count(reason.cases, id) != 0; });
    return found == std::end(kReasons) ? nullptr : &*found;
}

}  // namespace vernier::conformance::hardcases
