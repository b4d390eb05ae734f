#include "runtime/accuracy.h"

#include <algorithm>
#include <array>

namespace vernier {
namespace {

struct Position {
    std::string_view name;
    Accuracy accuracy;
};

using Interpolation = InterpolationArithmetic;

/// The dial, position by position; in the order of Profile.
constexpr std::array<Position, 5> kDial{{
    {"draft", {4, Interpolation::singleFloat, MathTier::fast}},
    {"fast", {8, Interpolation::singleFloat, MathTier::fast}},
    {"standard", {8, Interpolation::singleFloat, MathTier::standard}},
    {"fine", {12, Interpolation::doubleFloat, MathTier::fine}},
    {"reference", {16, Interpolation::doubleFloat, MathTier::reference}},
}};
static_assert(kDial.size() == std::size(kProfiles));

}  // namespace

Accuracy accuracyOf(Profile profile) {
    return kDial[static_cast<size_t>(profile)].accuracy;
}

std::string_view profileName(Profile profile) {
    return kDial[static_cast<size_t>(profile)].name;
}

std::optional<Profile> profileFromName(std::string_view name) {
    const auto found = std::find_if(kDial.begin(), kDial.end(), [&](const Position& p) { return p.name == name; });
    if (found == kDial.end()) return std::nullopt;
    return static_cast<Profile>(found - kDial.begin());
}

}  // namespace vernier
