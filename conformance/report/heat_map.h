// Pictures of an ImageDiff.
#pragma once

#include "conformance/differ/classify.h"
#include "conformance/report/picture.h"

namespace vernier::conformance {

/// Signed errors on one fixed scale for all scenes: red where ours is higher, blue where it is lower; the
/// steps of intensity are 1, 2, 4, ... 128 and more codes (or ULP). Equal pixels are near black; pixels legal
/// at an ambiguous edge are drawn at a third of their intensity. With a `spread`, each pixel shows the
/// largest error so many pixels around it, so that a single one survives being scaled down.
Picture heatMap(const ImageDiff& diff, uint32_t spread = 0);

/// Every pixel in the colour of its class.
Picture classMap(const ImageDiff& diff);

/// As used by classMap().
Rgb8 classColor(PixelClass pixelClass);

/// The colour of an error of `codes`, and whether it is dimmed as an edge.
Rgb8 heatColor(int32_t codes, bool dimmed);

}  // namespace vernier::conformance
