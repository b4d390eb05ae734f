// Which settings of the dial are worth having, and which of them to take.
#pragma once

#include <string>
#include <vector>

#include "bench/accuracy/measure.h"

namespace vernier::bench {

/// The error that positions of a scene are ranked by: the mean error of values, in units of 1/255, and one for each
/// misplaced pixel among all pixels, as a misplaced pixel may be wrong by everything.
double rankedError(const MeasuredScene& scene, const AccuracyFigures& figures);

/// The labels of Vernier's positions that no other one of its positions beats in both time and error, from fast to
/// exact. Times that differ by less than `tolerance` (a fraction) are equal: the more exact position wins.
std::vector<std::string> paretoFront(const AccuracyRun& run, const MeasuredScene& scene, double tolerance = 0.03);

/// Positions of axes that no scene has a use for: in each, another position of the same axis is as fast within
/// `tolerance` and as exact, too. "AXIS of standard" is the position that axis has there.
std::vector<std::string> neverOnFront(const AccuracyRun& run, double tolerance = 0.03);

/// The most exact of Vernier's positions that Vulkan allows whose frame takes at most `milliseconds`; empty when none
/// does.
std::string mostExactWithin(const AccuracyRun& run, const MeasuredScene& scene, double milliseconds);
/// The fastest whose worst error is at most `error` (1/255); empty when none is.
std::string fastestWithin(const AccuracyRun& run, const MeasuredScene& scene, double error);

/// How much of the mean error of `standard` goes away when one axis alone is as exact as it gets, by axis; last, under
/// "all", when everything is.
std::vector<std::pair<std::string, double>> errorByAxis(const AccuracyRun& run, const MeasuredScene& scene);

}  // namespace vernier::bench
