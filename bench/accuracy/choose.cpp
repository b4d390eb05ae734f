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

std::vector<std::string> neverOnFront(const AccuracyRun& run) {
    std::set<std::string> seen;
    for (const MeasuredScene& scene : run.scenes)
        for (const std::string& label : paretoFront(run, scene)) seen.insert(label);
    std::vector<std::string> never;
    for (const AccuracyPosition& position : run.positions)
        if (position.driver == "api" && !seen.contains(position.label)) never.push_back(position.label);
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
