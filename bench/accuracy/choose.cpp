#include "bench/accuracy/choose.h"

#include <algorithm>
#include <set>

namespace vernier::bench {
namespace {

struct Candidate {
    const AccuracyPosition* position;
    const AccuracyFigures* figures;
    double error;
};

/// Vernier's positions that were measured.
std::vector<Candidate> candidates(const AccuracyRun& run, const MeasuredScene& scene) {
    std::vector<Candidate> result;
    for (const AccuracyPosition& position : run.positions) {
        const AccuracyFigures& figures = scene.figures.at(position.label);
        if (position.driver == "api" && figures.failure.empty())
            result.push_back({&position, &figures, rankedError(scene, figures)});
    }
    return result;
}

}  // namespace

double rankedError(const MeasuredScene& scene, const AccuracyFigures& figures) {
    const auto pixels = static_cast<double>(scene.oracle.pixels.size());
    return figures.mean + (pixels > 0 ? static_cast<double>(figures.misplaced) / pixels : 0) * 255;
}

std::vector<std::string> paretoFront(const AccuracyRun& run, const MeasuredScene& scene, double tolerance) {
    const std::vector<Candidate> all = candidates(run, scene);
    std::vector<Candidate> front;
    for (const Candidate& one : all) {
        const bool beaten = std::any_of(all.begin(), all.end(), [&](const Candidate& other) {
            const bool noSlower = other.figures->frame <= one.figures->frame * (1 + tolerance);
            const bool clearlyFaster = other.figures->frame < one.figures->frame * (1 - tolerance);
            return noSlower && (other.error < one.error || (other.error == one.error && clearlyFaster));
        });
        if (!beaten) front.push_back(one);
    }
    std::stable_sort(front.begin(), front.end(),
                     [](const Candidate& a, const Candidate& b) { return a.figures->frame < b.figures->frame; });
    std::vector<std::string> labels;
    for (const Candidate& one : front) labels.push_back(one.position->label);
    return labels;
}

std::vector<std::string> neverOnFront(const AccuracyRun& run, double tolerance) {
    std::set<std::string> axes;
    for (const AccuracyPosition& position : run.positions)
        if (!position.axis.empty()) axes.insert(position.axis);
    const auto isOf = [](const AccuracyPosition& position, const std::string& axis) {
        return position.axis == axis || position.label == kBaseProfile;
    };
    // Whether the scene has a use for a position: no other one of the axis is as good in both ways.
    const auto uses = [&](const MeasuredScene& scene, const std::string& axis, const AccuracyPosition& position) {
        const AccuracyFigures& own = scene.figures.at(position.label);
        if (!own.failure.empty()) return false;
        const std::vector<Candidate> all = candidates(run, scene);
        return std::none_of(all.begin(), all.end(), [&](const Candidate& other) {
            return isOf(*other.position, axis) && other.position->label != position.label &&
                   other.figures->frame <= own.frame * (1 + tolerance) && other.error <= rankedError(scene, own);
        });
    };
    std::vector<std::string> never;
    for (const std::string& axis : axes)
        for (const AccuracyPosition& position : run.positions) {
            if (!isOf(position, axis)) continue;
            if (std::any_of(run.scenes.begin(), run.scenes.end(),
                            [&](const MeasuredScene& scene) { return uses(scene, axis, position); }))
                continue;
            never.push_back(position.label == kBaseProfile ? axis + " of " + kBaseProfile : position.label);
        }
    return never;
}

std::string mostExactWithin(const AccuracyRun& run, const MeasuredScene& scene, double milliseconds) {
    const Candidate* best = nullptr;
    const std::vector<Candidate> all = candidates(run, scene);
    for (const Candidate& one : all)
        if (!one.position->belowVulkan && one.figures->frame <= milliseconds && (!best || one.error < best->error))
            best = &one;
    return best ? best->position->label : "";
}

std::string fastestWithin(const AccuracyRun& run, const MeasuredScene& scene, double error) {
    const Candidate* best = nullptr;
    const std::vector<Candidate> all = candidates(run, scene);
    for (const Candidate& one : all)
        if (one.figures->worst <= error && (!best || one.figures->frame < best->figures->frame)) best = &one;
    return best ? best->position->label : "";
}

std::vector<std::pair<std::string, double>> errorByAxis(const AccuracyRun& run, const MeasuredScene& scene) {
    std::vector<std::pair<std::string, double>> parts;
    const AccuracyFigures& base = scene.figures.at(kBaseProfile);
    if (!base.failure.empty()) return parts;
    const auto removed = [&](const std::string& label) {
        const AccuracyFigures& exact = scene.figures.at(label);
        return exact.failure.empty() ? rankedError(scene, base) - rankedError(scene, exact) : 0;
    };
    for (const AccuracyPosition& position : run.positions)
        if (position.exactest) parts.emplace_back(position.axis, removed(position.label));
    parts.emplace_back("all", removed("reference"));
    return parts;
}

}  // namespace vernier::bench
