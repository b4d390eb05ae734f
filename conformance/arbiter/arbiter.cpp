#include "conformance/arbiter/arbiter.h"

#include <algorithm>
#include <cctype>

namespace vernier::conformance {
namespace {

bool isWrong(const PixelDiff& pixel) {
    return pixel.pixelClass == PixelClass::oursWrong || pixel.pixelClass == PixelClass::unexplained;
}

OracleImage decided(OracleImage image) {
    constexpr OracleFlags kStaysOpen = kOracleUnknown | kOracleUndefined | kOraclePattern | kOracleSequence;
    for (OraclePixel& pixel : image.pixels) {
        if ((pixel.flags & kOracleEdge) == 0 || (pixel.flags & kStaysOpen) != 0) continue;
        pixel.low = pixel.high = pixel.value;
        pixel.flags = 0;
    }
    return image;
}

/// The classes of all pixels of all outputs, one after the other.
Result<std::vector<bool>> wrongMap(const std::vector<RenderedImage>& images, const std::vector<OracleImage>& oracle,
                                   HeldTo heldTo) {
    if (images.size() != oracle.size()) {
        return invalidArgument(std::to_string(images.size()) + " images against " + std::to_string(oracle.size()) +
                               " of the oracle");
    }
    std::vector<bool> wrong;
    for (size_t i = 0; i < images.size(); ++i) {
        const Result<ImageDiff> diff =
            compareWithOracle(images[i], heldTo == HeldTo::declaredRules ? decided(oracle[i]) : oracle[i]);
        if (!diff) return diff.error();
        for (const PixelDiff& pixel : diff->pixels) wrong.push_back(isWrong(pixel));
    }
    return wrong;
}

// An implementation has few faults that show in one scene.
constexpr size_t kMostTogether = 3;

int64_t gain(const Explanation& e) {
    return static_cast<int64_t>(e.explained) - static_cast<int64_t>(e.broken);
}

/// All but a few stragglers, which something else may explain.
bool nearlyConvinces(const Explanation& e) {
    return e.explained * 20 >= e.wrong * 19 && e.broken * 20 <= e.wrong;
}

/// "weights7" and "weights6" are answers to one question.
std::string_view questionOf(const Hypothesis& hypothesis) {
    std::string_view name = hypothesis.name;
    while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back())) != 0) name.remove_suffix(1);
    return name;
}

bool answers(const Hypotheses& hypotheses, const Hypothesis& question) {
    return std::ranges::any_of(hypotheses,
                               [&](const Hypothesis* each) { return questionOf(*each) == questionOf(question); });
}

/// Of the pixels that are wrong (`before`), those that hypotheses explain.
class Search {
  public:
    Search(const Scene& scene, const std::vector<RenderedImage>& images, std::vector<bool> before, const AskOracle& ask,
           HeldTo heldTo)
        : scene_(scene), images_(images), before_(std::move(before)), ask_(ask), heldTo_(heldTo) {}

    Result<std::optional<Explanation>> run(const Hypotheses& declared) {
        const auto wrong = static_cast<uint64_t>(std::count(before_.begin(), before_.end(), true));
        std::optional<Explanation> best;
        if (wrong == 0) return best;
        if (!declared.empty()) {
            Explanation promised{declared, wrong, 0, 0};
            const Result<bool> asked = judge(promised);
            if (!asked) return asked.error();
            if (*asked && gain(promised) > 0) best = promised;
            if (promised.convinces()) return best;
        }
        for (size_t together = 0; together < kMostTogether; ++together) {
            const Hypotheses base = best ? best->hypotheses : Hypotheses{};
            std::optional<Explanation> better;
            for (const Hypothesis& hypothesis : allHypotheses()) {
                if (answers(base, hypothesis) || !changes(hypothesis)) continue;
                Explanation explanation{base, wrong, 0, 0};
                explanation.hypotheses.push_back(&hypothesis);
                const Result<bool> asked = judge(explanation);
                if (!asked) return asked.error();
                if (!*asked || gain(explanation) <= (best ? gain(*best) : 0)) continue;
                if (!better || gain(explanation) > gain(*better)) better = explanation;
                if (explanation.convinces() || (!best && nearlyConvinces(explanation))) break;
            }
            if (!better) break;
            best = better;
            if (best->convinces()) break;
        }
        return best;
    }

  private:
    bool changes(const Hypothesis& hypothesis) const {
        Scene changed = scene_;
        OracleRules rules;
        return hypothesis.apply(changed, rules);
    }

    /// Counts what the hypotheses explain; false when the oracle has no answer.
    Result<bool> judge(Explanation& explanation) const {
        const std::optional<std::vector<OracleImage>> answer = ask_(explanation.hypotheses);
        if (!answer) return false;
        const Result<std::vector<bool>> after = wrongMap(images_, *answer, heldTo_);
        if (!after) return after.error();
        for (size_t i = 0; i < before_.size(); ++i) {
            explanation.explained += before_[i] && !(*after)[i];
            explanation.broken += !before_[i] && (*after)[i];
        }
        return true;
    }

    const Scene& scene_;
    const std::vector<RenderedImage>& images_;
    const std::vector<bool> before_;
    const AskOracle& ask_;
    const HeldTo heldTo_;
};

}  // namespace

Hypotheses declaredBy(std::string_view limits) {
    constexpr std::string_view kName = "subPixelPrecisionBits ";
    const size_t at = limits.find(kName);
    if (at == std::string_view::npos) return {};
    const std::string_view rest = limits.substr(at + kName.size());
    size_t digits = 0;
    while (digits < rest.size() && std::isdigit(static_cast<unsigned char>(rest[digits])) != 0) ++digits;
    const Hypothesis* snap = findHypothesis("snap" + std::string(rest.substr(0, digits)));
    return snap == nullptr ? Hypotheses{} : Hypotheses{snap};
}

std::string namesOf(const Hypotheses& hypotheses) {
    std::string names;
    for (const Hypothesis* each : hypotheses) names += (names.empty() ? "" : "+") + std::string(each->name);
    return names;
}

Result<uint64_t> wrongPixels(const std::vector<RenderedImage>& images, const std::vector<OracleImage>& oracle,
                             HeldTo heldTo) {
    const Result<std::vector<bool>> map = wrongMap(images, oracle, heldTo);
    if (!map) return map.error();
    return static_cast<uint64_t>(std::count(map->begin(), map->end(), true));
}

Result<std::optional<Explanation>> explainWrong(const Scene& scene, const std::vector<RenderedImage>& images,
                                                const std::vector<OracleImage>& oracle, const AskOracle& ask,
                                                const Hypotheses& declared, HeldTo heldTo) {
    Result<std::vector<bool>> before = wrongMap(images, oracle, heldTo);
    if (!before) return before.error();
    return Search(scene, images, std::move(before).value(), ask, heldTo).run(declared);
}

std::string describe(const Explanation& explanation) {
    const std::string count =
        explanation.explained == explanation.wrong
            ? "All " + std::to_string(explanation.wrong) + " wrong pixels"
            : std::to_string(explanation.explained) + " of " + std::to_string(explanation.wrong) + " wrong pixels";
    std::string texts;
    for (const Hypothesis* each : explanation.hypotheses)
        texts += (texts.empty() ? "" : ", and ") + std::string(each->text);
    return count + " are right if " + texts + (explanation.convinces() ? "" : " (no hypothesis explains them all)");
}

}  // namespace vernier::conformance
