// The axes of the dial, and the choice of a profile by a budget.
#include <vernier/vernier_accuracy.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "api/mini/context.h"

using namespace vernier;

namespace {

class ProfileSearch {
  public:
    explicit ProfileSearch(const VnBudgetDesc& desc) : desc_(desc), values_(desc.valueCount) {}

    VnResult choose(VnBudgetResult& result) {
        if (boundsError()) {
            exact_.resize(desc_.valueCount);
            if (VnResult drawn = desc_.draw(desc_.user, VN_PROFILE_REFERENCE)) return drawn;
            if (VnResult read = desc_.read(desc_.user, exact_.data(), exact_.size())) return read;
        }
        bool found = false, measured = false;
        for (int profile = VN_PROFILE_REFERENCE; profile >= VN_PROFILE_DRAFT; --profile) {
            if (!desc_.belowVulkan && isBelowVulkan(static_cast<VnProfile>(profile))) continue;
            VnBudgetResult tried{static_cast<VnProfile>(profile), 0, 0};
            if (VnResult failed = measure(tried)) return failed;
            const bool fits = keepsBounds(tried);
            const bool better =
                !measured || (fits && !found) || (fits == found && tried.milliseconds < result.milliseconds);
            if (better) result = tried;
            measured = true;
            found = found || fits;
            if (found && boundsTime()) break;  // the most exact one: what follows is less exact
        }
        return found ? VN_SUCCESS : VN_ERROR_UNSUPPORTED;
    }

  private:
    bool boundsTime() const { return desc_.maxMilliseconds > 0; }
    bool boundsError() const { return desc_.maxError > 0; }
    bool keepsBounds(const VnBudgetResult& tried) const {
        return (!boundsTime() || tried.milliseconds <= desc_.maxMilliseconds) &&
               (!boundsError() || tried.error <= desc_.maxError);
    }

    static bool isBelowVulkan(VnProfile profile) {
        const Accuracy accuracy = accuracyOf(kProfiles[profile - VN_PROFILE_DRAFT]);
        return std::any_of(axes().begin(), axes().end(),
                           [&](const Axis& axis) { return axis.get(accuracy) < axis.lowestForVulkan; });
    }

    double now() const {
        if (desc_.clock) return desc_.clock(desc_.user);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    VnResult measure(VnBudgetResult& tried) {
        if (VnResult drawn = desc_.draw(desc_.user, tried.profile)) return drawn;
        std::array<double, 5> times;
        for (double& time : times) {
            const double start = now();
            if (VnResult drawn = desc_.draw(desc_.user, tried.profile)) return drawn;
            time = now() - start;
        }
        std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
        tried.milliseconds = times[times.size() / 2];
        if (!boundsError()) return VN_SUCCESS;
        if (VnResult read = desc_.read(desc_.user, values_.data(), values_.size())) return read;
        for (size_t i = 0; i < values_.size(); ++i) {
            const double error = values_[i] == exact_[i] ? 0 : std::abs(values_[i] - exact_[i]);
            tried.error = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(tried.error, error);
        }
        return VN_SUCCESS;
    }

    const VnBudgetDesc& desc_;
    std::vector<double> values_, exact_;
};

bool isComplete(const VnBudgetDesc& desc) {
    if (desc._start != 0 || desc._end != 0 || !desc.draw) return false;
    const bool boundsTime = desc.maxMilliseconds > 0, boundsError = desc.maxError > 0;
    if (!boundsTime && !boundsError) return false;
    return !boundsError || (desc.read && desc.valueCount > 0);
}

}  // namespace

VnResult vnGetAxis(uint32_t index, VnAxisInfo* info) {
    if (!info || index >= axes().size()) return VN_ERROR_INVALID_ARGUMENT;
    const Axis& axis = axes()[index];
    *info = {axis.name, axis.meaning, axis.positions.data(), static_cast<uint32_t>(axis.positions.size()),
             static_cast<uint32_t>(axis.lowestForVulkan)};
    return VN_SUCCESS;
}

VnResult vnGetAxisPosition(uint32_t index, VnProfile profile, uint32_t* position) {
    if (!position || index >= axes().size()) return VN_ERROR_INVALID_ARGUMENT;
    const Result<Accuracy> accuracy = mini::accuracyFrom(profile, nullptr, accuracyOf(Profile::standard));
    if (!accuracy) return VN_ERROR_INVALID_ARGUMENT;
    *position = static_cast<uint32_t>(axes()[index].get(*accuracy));
    return VN_SUCCESS;
}

VnResult vnChooseProfile(const VnBudgetDesc* desc, VnBudgetResult* result) {
    if (!desc || !result || !isComplete(*desc)) return VN_ERROR_INVALID_ARGUMENT;
    try {
        return ProfileSearch(*desc).choose(*result);
    } catch (...) {  // std::bad_alloc and std::length_error of the values; callbacks are C
        return VN_ERROR_OUT_OF_MEMORY;
    }
}
