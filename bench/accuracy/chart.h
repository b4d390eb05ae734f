// The charts of the accuracy page, as SVG documents.
#pragma once

#include <string>

#include "bench/accuracy/measure.h"

namespace vernier::bench {

/// Error over time of one scene: the front connected, what it beats as hollow dots, other drivers as squares. Errors
/// below 1e-7 of 1/255, and zero, are drawn there.
std::string paretoSvg(const AccuracyRun& run, const MeasuredScene& scene);

/// Small multiples: for each axis, the time of each of its positions as a bar and the error as a dot.
std::string axesSvg(const AccuracyRun& run, const MeasuredScene& scene);

/// A bar of the error of `standard`, by the axis that causes it.
std::string errorBarSvg(const AccuracyRun& run, const MeasuredScene& scene);

}  // namespace vernier::bench
