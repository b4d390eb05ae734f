// Which settings of the dial are worth having, and which of them to take.
#pragma once

#include <string>
#include <vector>

#include "bench/accuracy/measure.h"

namespace vernier::bench {

/// The error that positions of a scene are ranked by: the mean error of values, in units of 1/255, and one for each
/// misplaced pixel among all pixels, as a misplaced pixel may be wrong by everything.
double rankedError(const MeasuredScene& scene, const AccuracyFigures& figures);

/// The fraction by which times of one and the same drawing differ here: the largest, over Vernier's positions, from the
/// fastest round to the next one, and never below kLeastNoise. Times that differ by no more than that are equal. A
/// position's time is that of its fastest round; what keeps two processes that do the same from being equally fast in
/// their best rounds also keeps two rounds of one position from it.
double timeNoise(const AccuracyRun& run, const MeasuredScene& scene);
inline constexpr double kLeastNoise = 0.01;

/// The labels of Vernier's positions that no other one of its positions beats in both time and error, from fast to
/// exact. Of equal times, as timeNoise() says, the more exact position wins.
std::vector<std::string> paretoFront(const AccuracyRun& run, const MeasuredScene& scene);

/// Where a position stands on the front of its own axis, the other axes as in `standard`; or of the profiles.
struct Standing {
    std::string axis;                 // "subpixel"; "profile" for the whole dial
    std::string position;             // "8"
    bool isStandard = false;          // of an axis: it is what `standard` has
    std::vector<std::string> alone;   // scenes where every other position is slower, or less exact
    std::vector<std::string> shared;  // scenes where none beats it, but others are as fast and as exact
};

/// All of Vernier's positions that were measured, by axis and from cheap to exact. A position that stands nowhere alone
/// is one that the dial does not need.
std::vector<Standing> standings(const AccuracyRun& run);

/// The same as a table: a line for each position, in plain text or as rows of Markdown.
std::string standingsText(const AccuracyRun& run);

/// The most exact of Vernier's positions that Vulkan allows whose frame takes at most `milliseconds`; empty when none
/// does.
std::string mostExactWithin(const AccuracyRun& run, const MeasuredScene& scene, double milliseconds);
/// The fastest whose worst error is at most `error` (1/255); empty when none is.
std::string fastestWithin(const AccuracyRun& run, const MeasuredScene& scene, double error);

/// How much of the mean error of `standard` goes away when one axis alone is as exact as it gets, by axis; last, under
/// "all", when everything is.
std::vector<std::pair<std::string, double>> errorByAxis(const AccuracyRun& run, const MeasuredScene& scene);

}  // namespace vernier::bench
