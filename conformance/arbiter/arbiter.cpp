#include "conformance/arbiter/arbiter.h"

#include <algorithm>

namespace vernier::conformance {
namespace {

bool isWrong(const PixelDiff& pixel) {
    return pixel.pixelClass == PixelClass::oursWrong || pixel.pixelClass == PixelClass::unexplained;
}

/// The classes of all pixels of all outputs, one after the other.
Result<std::vector<bool>> wrongMap(const std::vector<RenderedImage>& images, const std::vector<OracleImage>& oracle) {
    if (images.size() != oracle.size()) {
        return invalidArgument(std::to_string(images.size()) + " images against " + std::to_string(oracle.size()) +
                               " of the oracle");
    }
    std::vector<bool> wrong;
    for (size_t i = 0; i < images.size(); ++i) {
        const Result<ImageDiff> diff = compareWithOracle(images[i], oracle[i]);
        if (!diff) return diff.error();
        for (const PixelDiff& pixel : diff->pixels) wrong.push_back(isWrong(pixel));
    }
    return wrong;
}

}  // namespace

Result<uint64_t> wrongPixels(const std::vector<RenderedImage>& images, const std::vector<OracleImage>& oracle) {
    const Result<std::vector<bool>> map = wrongMap(images, oracle);
    if (!map) return map.error();
    return static_cast<uint64_t>(std::count(map->begin(), map->end(), true));
}

Result<std::optional<Explanation>> explainWrong(const Scene& scene, const std::vector<RenderedImage>& images,
                                                const std::vector<OracleImage>& oracle, const AskOracle& ask) {
    const Result<std::vector<bool>> before = wrongMap(images, oracle);
    if (!before) return before.error();
    const auto wrong = static_cast<uint64_t>(std::count(before->begin(), before->end(), true));
    std::optional<Explanation> best;
    if (wrong == 0) return best;
    for (const Hypothesis& hypothesis : allHypotheses()) {
        Scene changed = scene;
        OracleRules rules;
        if (!hypothesis.apply(changed, rules)) continue;
        const std::optional<std::vector<OracleImage>> answer = ask(hypothesis);
        if (!answer) continue;
        const Result<std::vector<bool>> after = wrongMap(images, *answer);
        if (!after) return after.error();
        Explanation explanation{&hypothesis, wrong, 0, 0};
        for (size_t i = 0; i < before->size(); ++i) {
            explanation.explained += (*before)[i] && !(*after)[i];
            explanation.broken += !(*before)[i] && (*after)[i];
        }
        const auto gain = [](const Explanation& e) {
            return static_cast<int64_t>(e.explained) - static_cast<int64_t>(e.broken);
        };
        if (gain(explanation) > 0 && (!best || gain(explanation) > gain(*best))) best = explanation;
        if (explanation.convinces()) return best = explanation;
    }
    return best;
}

std::string describe(const Explanation& explanation) {
    const std::string count =
        explanation.explained == explanation.wrong
            ? "All " + std::to_string(explanation.wrong) + " wrong pixels"
            : std::to_string(explanation.explained) + " of " + std::to_string(explanation.wrong) + " wrong pixels";
    return count + " are right if " + std::string(explanation.hypothesis->text) +
           (explanation.convinces() ? "" : " (no hypothesis explains them all)");
}

}  // namespace vernier::conformance
