// profile: where floats lose their bits. The same invocation in float and in a wider type, compared value by value.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "spirv_interp/tool/reference_run.h"
#include "spirv_interp/tool/tool.h"
#include "spirv_interp/tool/trace.h"

namespace vernier::tool {
namespace {

using reference::Step;

/// Everything that was executed, in order.
class Recorder final : public reference::StepObserver {
  public:
    void executed(const Step& step) override {
        if (steps.size() < kLimit) steps.push_back(step);
    }
    static constexpr size_t kLimit = 2'000'000;
    std::vector<Step> steps;
};

/// Of float's 24 bits, those that are wrong: log2 of the relative error in units of 2^-24, at most 24 for a value that
/// has none right.
double bitsLost(double inFloat, double exact) {
    if (inFloat == exact || (std::isnan(inFloat) && std::isnan(exact))) return 0;
    if (!std::isfinite(inFloat) || !std::isfinite(exact) || exact == 0) return 24;
    const double relative = std::fabs((inFloat - exact) / exact);
    return std::clamp(std::log2(relative) + 24, 0.0, 24.0);
}

struct Place {
    const Step* step = nullptr;
    uint64_t executions = 0;
    double worst = 0;     // bits wrong in the result
    double operands = 0;  // bits wrong in the worst operand of that execution
    double loss = 0;      // greatest difference of the two
    double inFloat = 0, exact = 0;
};

class Comparison {
  public:
    /// False where the two runs take different ways.
    bool add(const Step& a, const Step& b) {
        if (a.op != b.op || a.result != b.result || a.operands.data() != b.operands.data()) return false;
        double operands = 0;
        for (const uint32_t id : a.operands) {
            const auto found = wrong_.find({a.invocation, id});
            if (found != wrong_.end()) operands = std::max(operands, found->second);
        }
        const uint32_t target = a.op == spv::OpStore ? a.operands[0] : a.result;
        if (target == 0 || !a.isFloat) return true;
        double lost = 0;
        size_t component = 0;
        for (size_t k = 0; k < a.numbers.size() && k < b.numbers.size(); ++k) {
            const double here = bitsLost(a.numbers[k], b.numbers[k]);
            if (here > lost) component = k;
            lost = std::max(lost, here);
        }
        wrong_[{a.invocation, target}] = lost;
        // These hand values on, and a call's result was lost inside it.
        if (a.op == spv::OpStore || a.op == spv::OpLoad || a.op == spv::OpFunctionCall || a.numbers.empty())
            return true;
        Place& place = places_[a.result];
        if (place.step == nullptr) place.step = &a;
        ++place.executions;
        place.worst = std::max(place.worst, lost);
        // A rounding alone may cost a bit.
        if (lost - operands > place.loss) {
            place.loss = lost - operands;
            place.operands = operands;
            place.inFloat = a.numbers[component];
            place.exact = b.numbers[component];
            place.step = &a;
        }
        return true;
    }
    std::vector<Place> worstFirst() const {
        std::vector<Place> places;
        for (const auto& [id, place] : places_) places.push_back(place);
        std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.loss > b.loss; });
        return places;
    }

  private:
    std::map<std::pair<uint32_t, uint32_t>, double> wrong_;  // by invocation and id
    std::map<uint32_t, Place> places_;
};

template <class Number>
Result<int> compare(const ModuleInput& input, const Invocation& invocation, const ProfileOptions& options) {
    const auto module = reference::Module::parse(input.words);
    if (!module) return module.error();
    Recorder inFloat, exact;
    reference::Options machine;
    machine.stepwise = true;
    machine.observer = &inFloat;
    Invocation own = invocation;
    const auto first = runReference<float>(input, *module, own, machine);
    if (!first) return first.error();
    machine.observer = &exact;
    machine.stepwise = false;
    own = invocation;
    const auto second = runReference<Number>(input, *module, own, machine);
    if (!second) return second.error();
    Comparison comparison;
    size_t common = 0;
    while (common < inFloat.steps.size() && common < exact.steps.size() &&
           comparison.add(inFloat.steps[common], exact.steps[common])) {
        ++common;
    }
    std::printf("%zu instructions in float and in %s", common, options.mpfr ? "128 bits" : "double");
    if (common < inFloat.steps.size() || common < exact.steps.size()) {
        const Step* last = common > 0 ? &inFloat.steps[common - 1] : nullptr;
        std::printf("; then they part, after line %u", last != nullptr ? last->line : 0);
    }
    std::printf("\n\n%6s %6s %6s %9s  %-16s %-16s %s\n", "loss", "wrong", "before", "times", "float", "exact", "where");
    uint32_t shown = 0;
    for (const Place& place : comparison.worstFirst()) {
        if (shown++ == options.count || place.worst == 0) break;
        std::printf("%6.1f %6.1f %6.1f %9llu  %-16.9g %-16.9g line %u: %s = %s\n", place.loss, place.worst,
                    place.operands, static_cast<unsigned long long>(place.executions), place.inFloat, place.exact,
                    place.step->line, idName(*module, place.step->result).c_str(), operationName(*place.step).c_str());
        const std::string source = input.sourceLine(place.step->line);
        if (!source.empty()) std::printf("%65s %s\n", "", source.c_str());
    }
    return 0;
}

}  // namespace

Result<int> profile(const ModuleInput& input, const Invocation& invocation, const ProfileOptions& options) {
    return options.mpfr ? compare<reference::Real>(input, invocation, options)
                        : compare<double>(input, invocation, options);
}

}  // namespace vernier::tool
