// Says of every pixel why two drivers' images agree or differ. There is no percentage and no threshold to
// tune: a pixel is explained by the specification, by a fault of one side, or not at all.
#pragma once

#include "base/result.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace vernier::conformance {

/// Why two images are as they are in one pixel. X(name, what the report says); in rising order of severity,
/// the same as the order in which the worst pixel is looked for.
#define VERNIER_PIXEL_CLASSES(X)                                                            \
    X(equal, "the same codes")                                                              \
    X(rounding, "neighbouring codes, both permitted for the exact value")                   \
    X(weights, "weights of a linear filter have as many bits as declared: both are legal")  \
    X(level, "the level of detail is approximated, each in a permitted way")                \
    X(interpolation, "both inside the interval permitted for interpolation and arithmetic") \
    X(tie, "a sample lies exactly on an edge, and belongs to either side")                  \
    X(snap, "snapping to the sub-pixel grid decides coverage, both are legal")              \
    X(order, "two depths are too near to each other to say which is in front")              \
    X(sequence, "the edges of one polygon's outline are drawn in whatever order")           \
    X(pattern, "alpha becomes coverage in whatever pattern")                                \
    X(undefined, "the specification defines no value here")                                 \
    X(otherWrong, "ours is legal, the other driver's value is not")                         \
    X(undecided, "they differ and the oracle could not decide what is legal")               \
    X(oursWrong, "the other driver's value is legal, ours is not")                          \
    X(unexplained, "without an oracle: more than one code apart; with one: neither is legal")

enum class PixelClass : uint8_t {
#define VERNIER_ENUMERATOR(name, text) name,
    VERNIER_PIXEL_CLASSES(VERNIER_ENUMERATOR)
#undef VERNIER_ENUMERATOR
};
inline constexpr size_t kPixelClassCount = static_cast<size_t>(PixelClass::unexplained) + 1;

std::string_view pixelClassName(PixelClass pixelClass);
std::string_view pixelClassText(PixelClass pixelClass);

/// Whether pixels of the class fail the comparison (unless they are a known gap).
bool isFailure(PixelClass pixelClass);

struct PixelDiff {
    PixelClass pixelClass = PixelClass::equal;
    int32_t error = 0;  // ours minus other in codes (ULP for floats), of the component that is furthest off; saturated
};

struct ImageDiff {
    VkExtent2D extent{};
    bool hasOracle = false;
    std::array<uint64_t, kPixelClassCount> counts{};
    uint64_t nanPixels = 0;               // where exactly one side has a NaN
    uint64_t unknownPixels = 0;           // flagged by the oracle as not decided, equal ones included
    std::array<int64_t, 4> worstError{};  // per component, signed: ours minus other, in codes or ULP
    uint32_t worstX = 0, worstY = 0;      // the most severe class, within it the largest error
    PixelClass worstClass = PixelClass::equal;
    std::vector<PixelDiff> pixels;  // row by row

    uint64_t count(PixelClass pixelClass) const { return counts[static_cast<size_t>(pixelClass)]; }
    uint64_t failures() const;
};

/// Compares `ours` with `other`; `oracle` may be nullptr. Refuses images of different formats or sizes,
/// formats scenes may not use, and texel data of the wrong size.
Result<ImageDiff> compareImages(const RenderedImage& ours, const RenderedImage& other, const OracleImage* oracle);

/// How one image stands against the oracle alone: `equal` is the oracle's own value, `rounding` a neighbour,
/// other legal classes say why it may differ, `oursWrong` is outside. Errors are against the oracle's value.
Result<ImageDiff> compareWithOracle(const RenderedImage& image, const OracleImage& oracle);

}  // namespace vernier::conformance
