#include "bench/accuracy/choose.h"

#include <vernier/vernier_accuracy.h>

#include <algorithm>

#include "bench/svg/svg.h"

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

bool noSlower(const Candidate& one, const Candidate& other, double noise) {
    return one.figures->frame <= other.figures->frame * (1 + noise);
}

/// Whether nobody would choose `other`.
bool beats(const Candidate& one, const Candidate& other, double noise) {
    if (one.error == other.error) return other.figures->frame > one.figures->frame * (1 + noise);
    return one.error < other.error && noSlower(one, other, noise);
}

constexpr const char* kProfileAxis = "profile";

/// Whether a measured position is one of that axis: `standard` is one of each.
bool isOf(const AccuracyPosition& position, const std::string& axis) {
    if (axis == kProfileAxis) return position.isProfile();
    return position.axis == axis || position.label == kBaseProfile;
}

bool isAt(const AccuracyPosition& position, const Standing& standing) {
    if (!isOf(position, standing.axis)) return false;
    if (standing.isStandard) return position.label == kBaseProfile;
    return position.label ==
           (standing.axis == kProfileAxis ? standing.position : standing.axis + "=" + standing.position);
}

std::vector<Standing> measuredPositions(const AccuracyRun& run) {
    std::vector<Standing> all;
    const auto isMeasured = [&](const Standing& standing) {
        return std::any_of(run.positions.begin(), run.positions.end(),
                           [&](const AccuracyPosition& position) { return isAt(position, standing); });
    };
    const auto add = [&](const char* axis, const char* position, bool isStandard) {
        const Standing standing{axis, position, isStandard, {}, {}};
        if (isMeasured(standing)) all.push_back(standing);
    };
    for (const char* profile : kProfileNames) add(kProfileAxis, profile, false);
    VnAxisInfo axis{};
    for (uint32_t index = 0; vnGetAxis(index, &axis) == VN_SUCCESS; ++index) {
        uint32_t standard = 0;
        vnGetAxisPosition(index, VN_PROFILE_STANDARD, &standard);
        if (std::none_of(run.positions.begin(), run.positions.end(),
                         [&](const AccuracyPosition& position) { return position.axis == axis.name; }))
            continue;
        for (uint32_t p = 0; p < axis.positionCount; ++p) add(axis.name, axis.positions[p], p == standard);
    }
    return all;
}

}  // namespace

double rankedError(const MeasuredScene& scene, const AccuracyFigures& figures) {
    const auto pixels = static_cast<double>(scene.oracle.pixels.size());
    return figures.mean + (pixels > 0 ? static_cast<double>(figures.misplaced) / pixels : 0) * 255;
}

double timeNoise(const AccuracyRun& run, const MeasuredScene& scene) {
    double noise = kLeastNoise;
    for (const Candidate& one : candidates(run, scene)) {
        std::vector<double> rounds = one.figures->rounds;
        if (rounds.size() < 2) continue;
        std::sort(rounds.begin(), rounds.end());
        if (rounds[0] > 0) noise = std::max(noise, rounds[1] / rounds[0] - 1);
    }
    return noise;
}

std::vector<std::string> paretoFront(const AccuracyRun& run, const MeasuredScene& scene) {
    const std::vector<Candidate> all = candidates(run, scene);
    const double noise = timeNoise(run, scene);
    std::vector<Candidate> front;
    for (const Candidate& one : all)
        if (std::none_of(all.begin(), all.end(), [&](const Candidate& other) { return beats(other, one, noise); }))
            front.push_back(one);
    std::stable_sort(front.begin(), front.end(),
                     [](const Candidate& a, const Candidate& b) { return a.figures->frame < b.figures->frame; });
    std::vector<std::string> labels;
    for (const Candidate& one : front) labels.push_back(one.position->label);
    return labels;
}

std::vector<Standing> standings(const AccuracyRun& run) {
    std::vector<Standing> all = measuredPositions(run);
    for (const MeasuredScene& scene : run.scenes) {
        const double noise = timeNoise(run, scene);
        const std::vector<Candidate> drawn = candidates(run, scene);
        for (Standing& standing : all) {
            const auto own = std::find_if(drawn.begin(), drawn.end(), [&](const Candidate& candidate) {
                return isAt(*candidate.position, standing);
            });
            if (own == drawn.end()) continue;
            bool beaten = false, alone = true;
            for (const Candidate& other : drawn) {
                if (&other == &*own || !isOf(*other.position, standing.axis)) continue;
                beaten = beaten || beats(other, *own, noise);
                alone = alone && !(noSlower(other, *own, noise) && other.error <= own->error);
            }
            if (alone)
                standing.alone.emplace_back(scene.scene->name);
            else if (!beaten)
                standing.shared.emplace_back(scene.scene->name);
        }
    }
    return all;
}

std::string standingsText(const AccuracyRun& run) {
    const bool isRepeated = std::all_of(run.scenes.begin(), run.scenes.end(), [](const MeasuredScene& scene) {
        return std::any_of(scene.figures.begin(), scene.figures.end(),
                           [](const auto& each) { return each.second.rounds.size() > 1; });
    });
    double least = 1, most = 0;
    for (const MeasuredScene& scene : run.scenes) {
        least = std::min(least, timeNoise(run, scene));
        most = std::max(most, timeNoise(run, scene));
    }
    std::string text =
        "| Axis | Position | Alone on the front | Scenes | With others |\n| --- | --- | --- | --- | --- |\n";
    for (const Standing& standing : standings(run)) {
        std::string scenes;
        for (const std::string& name : standing.alone) scenes += (scenes.empty() ? "" : ", ") + name;
        text += "| " + standing.axis + " | " + standing.position + (standing.isStandard ? " (standard)" : "") + " | " +
                std::to_string(standing.alone.size()) + " | " + scenes + " | " +
                std::to_string(standing.shared.size()) + " |\n";
    }
    text += format("\nTimes that differ by less than %.1f to %.1f %%, by scene, are equal", 100 * least, 100 * most);
    return text + (isRepeated ? ".\n" : ", but not all were taken twice: the noise is not known.\n");
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
        const auto exact = scene.figures.find(label);
        if (exact == scene.figures.end() || !exact->second.failure.empty()) return 0.0;
        return rankedError(scene, base) - rankedError(scene, exact->second);
    };
    for (const AccuracyPosition& position : run.positions)
        if (position.exactest) parts.emplace_back(position.axis, removed(position.label));
    parts.emplace_back("all", removed("reference"));
    return parts;
}

}  // namespace vernier::bench
