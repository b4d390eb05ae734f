#include "conformance/oracle/shader_runs.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

namespace vernier::conformance::exact {

namespace {

using reference::InterfaceVariable;
using Values = reference::InterfaceValues<double>;

constexpr double kRoundingFactor = 8;

// The nominal number of an output component and what other runs made of it.
class Spread {
  public:
    explicit Spread(double nominal) : nominal_(nominal) {}

    /// Deviations of one kind, given as the extremes seen so far in this kind.
    void see(double other) {
        below_ = std::max(below_, nominal_ - other);
        above_ = std::max(above_, other - nominal_);
        varies_ = varies_ || (open_ && other != nominal_);
        if (std::isnan(other)) below_ = above_ = HUGE_VAL;
    }
    void endKind(double factor = 1, bool symmetric = false) {
        if (symmetric) below_ = above_ = std::max(below_, above_);
        totalBelow_ += below_ * factor;
        totalAbove_ += above_ * factor;
        below_ = above_ = 0;
    }
    /// Kinds seen later (rounding alone) do not count as variation with the inputs.
    void closeVariation() { open_ = false; }
    bool varies() const { return varies_; }
    Interval range(double slack) const {
        return {nominal_, nominal_ - totalBelow_ - slack, nominal_ + totalAbove_ + slack};
    }

  private:
    double nominal_;
    double below_ = 0, above_ = 0, totalBelow_ = 0, totalAbove_ = 0;
    bool varies_ = false, open_ = true;
};

template <class Read>
std::optional<Spread> spreadOf(const ShaderRuns& runs, size_t lane, Read read) {
    const std::optional<double> nominal = read(runs.nominal[lane].outputs);
    if (!nominal) return std::nullopt;
    Spread spread(*nominal);
    const auto kind = [&](const auto& list, double factor, bool symmetric) {
        for (const auto& run : list) {
            if (run[lane].discarded != runs.nominal[lane].discarded) continue;
            spread.see(read(run[lane].outputs).value_or(*nominal));
        }
        spread.endKind(factor, symmetric);
    };
    kind(runs.shifted, 1, false);
    for (const auto& list : runs.moved) kind(list, 1, false);
    kind(runs.filtered, 1, false);
    kind(runs.coarse, 1, true);
    spread.closeVariation();
    kind(runs.rounded, kRoundingFactor, true);
    return spread;
}

double numberOf(const reference::Scalar<double>& scalar, const InterfaceVariable& variable) {
    if (!isIntegerVariable(variable)) return scalar.number;
    const auto bits = static_cast<uint32_t>(scalar.bits);
    return variable.kind == reference::ScalarKind::int32 ? static_cast<double>(static_cast<int32_t>(bits))
                                                         : static_cast<double>(bits);
}

// The perturbed quads, of whatever kind.
template <class Visit>
void forEachPerturbed(const ShaderRuns& runs, Visit visit) {
    const auto all = [&visit](const std::vector<ShaderRuns::Quad>& list) {
        for (const ShaderRuns::Quad& quad : list) visit(quad);
    };
    for (const auto* list : {&runs.shifted, &runs.filtered, &runs.coarse, &runs.rounded}) all(*list);
    for (const auto& list : runs.moved) all(list);
}

// What to report for a fragment that is discarded nominally but kept by others: the outputs of one that kept
// it.
ShaderRuns withKeptOutputs(const ShaderRuns& runs, size_t lane) {
    ShaderRuns result = runs;
    forEachPerturbed(runs, [&](const ShaderRuns::Quad& quad) {
        if (!quad[lane].discarded) result.nominal[lane].outputs = quad[lane].outputs;
    });
    return result;
}

const PixelFormat* formatOf(const SceneBinding& binding, const Memory& memory) {
    return binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ? &memory.images[binding.image].format()
                                                            : findPixelFormat(binding.texelFormat);
}

/// A texel as a shader hands it over, in numbers.
Color numbersOf(const reference::Texel<double>& texel, const PixelFormat* format) {
    Color color{};
    if (format == nullptr) return color;  // refused when it is applied
    for (size_t c = 0; c < 4; ++c) {
        const auto bits = static_cast<uint32_t>(texel[c].bits);
        color[c] = !format->isInteger()                               ? texel[c].number
                   : format->components[0].encoding == Encoding::sint ? static_cast<double>(static_cast<int32_t>(bits))
                                                                      : static_cast<double>(bits);
    }
    return color;
}

template <class Read>
std::optional<Interval> rangeOf(const ShaderRuns& runs, size_t lane, const InterfaceVariable& v,
                                const ValueError& error, Read read) {
    const auto spread = spreadOf(runs, lane, read);
    if (!spread) return std::nullopt;
    const Interval bare = spread->range(0);
    if (isIntegerVariable(v)) return bare;
    return spread->range(error.of(bare.value, spread->varies()));
}

}  // namespace

bool isIntegerVariable(const InterfaceVariable& variable) {
    return !isFloating(variable.kind);
}

std::vector<TexelWrite> combineWrites(std::span<const std::vector<RunWrite>> runs, uint32_t lane, const Memory& memory,
                                      const ValueError& error, OracleFlags flags) {
    const auto ofLane = [lane](const std::vector<RunWrite>& run) {
        std::vector<RunWrite> result;
        std::ranges::copy_if(run, std::back_inserter(result),
                             [lane](const RunWrite& w) { return w.invocation == lane; });
        return result;
    };
    std::vector<TexelWrite> result;
    for (const RunWrite& write : ofLane(runs[0])) {
        const Color color = numbersOf(write.value, formatOf(*write.binding, memory));
        result.push_back({write.binding, write.at, color, flags, false});
    }
    std::vector<bool> varies(result.size());
    for (size_t run = 1; run < runs.size(); ++run) {
        const std::vector<RunWrite> others = ofLane(runs[run]);
        for (size_t i = 0; i < result.size(); ++i) {
            const bool same = others.size() == result.size() && others[i].binding == result[i].binding &&
                              others[i].at == result[i].at;
            if (!same) {
                result[i].flags |= kOracleUnknown;
                continue;
            }
            const Color there = numbersOf(others[i].value, formatOf(*result[i].binding, memory));
            const bool rounded = run + 1 == runs.size();
            varies[i] = varies[i] || (!rounded && there != numbersOf(ofLane(runs[0])[i].value,
                                                                     formatOf(*result[i].binding, memory)));
            for (size_t c = 0; c < 4; ++c) result[i].color[c] = result[i].color[c].united(there[c]);
        }
    }
    for (size_t i = 0; i < result.size(); ++i) {
        TexelWrite& write = result[i];
        const PixelFormat* format = formatOf(*write.binding, memory);
        if (format == nullptr || format->isInteger()) continue;
        for (Interval& c : write.color) c = c.widened(error.of(c.value, varies[i]));
    }
    std::vector<TexelWrite> last;
    for (const TexelWrite& write : result) {
        std::erase_if(last, [&](const TexelWrite& w) { return w.binding == write.binding && w.at == write.at; });
        last.push_back(write);
    }
    return last;
}

FragmentResult combineRuns(const ShaderRuns& runs, size_t lane, std::span<const InterfaceVariable> outputs,
                           const ValueError& error, size_t colorCount) {
    FragmentResult result;
    result.discarded = runs.nominal[lane].discarded;
    forEachPerturbed(runs, [&](const ShaderRuns::Quad& quad) {
        result.discardOpen = result.discardOpen || quad[lane].discarded != result.discarded;
    });
    if (result.discarded && !result.discardOpen) return result;
    if (result.discarded) {
        ShaderRuns kept = withKeptOutputs(runs, lane);
        kept.nominal[lane].discarded = false;
        FragmentResult ranges = combineRuns(kept, lane, outputs, error, colorCount);
        ranges.discarded = ranges.discardOpen = true;
        return ranges;
    }
    const Interval missing(std::numeric_limits<double>::quiet_NaN());
    for (size_t i = 0; i < colorCount; ++i) result.colors[i].fill(missing);
    for (const InterfaceVariable& v : outputs) {
        if (v.isBuiltin) {
            if (v.builtin != spv::BuiltInFragDepth) continue;
            result.depth = rangeOf(runs, lane, v, error, [](const Values& values) -> std::optional<double> {
                const auto found = values.builtins.find(spv::BuiltInFragDepth);
                if (found == values.builtins.end() || found->second.empty()) return std::nullopt;
                return found->second[0].number;
            });
            continue;
        }
        for (uint32_t k = 0; k < v.locations; ++k) {
            const size_t target = v.location + k;
            if (target >= colorCount) continue;
            if (v.index == 1 && !result.source1) result.source1.emplace().fill(missing);
            Color& color = v.index == 1 ? *result.source1 : result.colors[target];
            for (size_t c = v.component; c < std::min<size_t>(4, v.component + v.components); ++c) {
                const auto range = rangeOf(runs, lane, v, error, [&](const Values& values) -> std::optional<double> {
                    const auto found = values.locations.find({v.location + k, v.index});
                    if (found == values.locations.end()) return std::nullopt;
                    return numberOf(found->second[c], v);
                });
                if (range) color[c] = *range;
            }
        }
    }
    return result;
}

}  // namespace vernier::conformance::exact
