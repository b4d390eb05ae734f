#include "runtime/accuracy.h"

#include <algorithm>
#include <array>
#include <bit>

#include "runtime/settings.h"

namespace vernier {
namespace {

struct Position {
    std::string_view name;
    Accuracy accuracy;
};

using Interpolation = InterpolationArithmetic;

/// The dial, position by position; in the order of Profile. Fragments for 2x2 pixels are in none: Vulkan has them only
/// when an application asks.
constexpr std::array<Position, 5> kDial{{
    {"draft", {4, Interpolation::singleFloat, MathTier::fast, 2, ShadingRate::pixel}},
    {"fast", {8, Interpolation::singleFloat, MathTier::fast, 4, ShadingRate::pixel}},
    {"standard", {8, Interpolation::singleFloat, MathTier::standard, 16, ShadingRate::pixel}},
    {"fine", {12, Interpolation::doubleFloat, MathTier::fine, 16, ShadingRate::pixel}},
    {"reference", {16, Interpolation::doubleFloat, MathTier::reference, 16, ShadingRate::pixel}},
}};
static_assert(kDial.size() == std::size(kProfiles));

constexpr const char* kSubPixelPositions[] = {"4", "8", "12", "16"};
constexpr const char* kInterpolationPositions[] = {"float", "double"};
constexpr const char* kMathPositions[] = {"fast", "standard", "fine", "reference"};
constexpr const char* kAnisotropyPositions[] = {"1", "2", "4", "8", "16"};
constexpr const char* kShadingPositions[] = {"2x2", "1x1"};

template <class Field, Field Accuracy::*kField>
constexpr Axis enumAxis(const char* name, const char* meaning, std::span<const char* const> positions,
                        size_t lowestForVulkan) {
    return {name,
            meaning,
            positions,
            lowestForVulkan,
            [](const Accuracy& accuracy) { return static_cast<size_t>(accuracy.*kField); },
            [](Accuracy& accuracy, size_t position) { accuracy.*kField = static_cast<Field>(position); }};
}

constexpr Axis kAxes[] = {
    {"subpixel", "bits of a pixel that vertices are snapped to; Vulkan asks for 4", kSubPixelPositions, 0,
     [](const Accuracy& accuracy) -> size_t { return accuracy.subPixelBits / 4 - 1; },
     [](Accuracy& accuracy, size_t position) { accuracy.subPixelBits = static_cast<uint32_t>(position + 1) * 4; }},
    enumAxis<Interpolation, &Accuracy::interpolation>("interpolation", "arithmetic of attributes between vertices",
                                                      kInterpolationPositions, 0),
    enumAxis<MathTier, &Accuracy::math>("math", "tier of the elementary functions of shaders: docs/precision.md",
                                        kMathPositions, 1),
    {"anisotropy", "samples of an anisotropic filter, at most; Vulkan leaves the scheme to implementations",
     kAnisotropyPositions, 0,
     [](const Accuracy& accuracy) { return static_cast<size_t>(std::countr_zero(accuracy.anisotropy)); },
     [](Accuracy& accuracy, size_t position) { accuracy.anisotropy = 1u << position; }},
    enumAxis<ShadingRate, &Accuracy::shading>("shading", "pixels that a fragment program runs for at once",
                                              kShadingPositions, 1),
};

Status setAxis(Accuracy& accuracy, std::string_view name, std::string_view position) {
    const Axis* const axis =
        std::find_if(std::begin(kAxes), std::end(kAxes), [&](const Axis& a) { return a.name == name; });
    if (axis == std::end(kAxes)) {
        std::array<const char*, std::size(kAxes)> names;
        std::transform(std::begin(kAxes), std::end(kAxes), names.begin(), [](const Axis& a) { return a.name; });
        return invalidArgument("\"" + std::string(name) + "\" is no axis of accuracy; there are: " + listOf(names));
    }
    const auto found = std::find_if(axis->positions.begin(), axis->positions.end(),
                                    [&](std::string_view allowed) { return allowed == position; });
    if (found == axis->positions.end())
        return invalidArgument("axis \"" + std::string(name) + "\" is \"" + std::string(position) +
                               "\"; allowed: " + listOf(axis->positions));
    axis->set(accuracy, static_cast<size_t>(found - axis->positions.begin()));
    return {};
}

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

std::span<const Axis> axes() {
    return kAxes;
}

Status setAxes(Accuracy& accuracy, std::string_view text) {
    Accuracy result = accuracy;
    const auto set = [&](std::string_view name, std::string_view value) { return setAxis(result, name, value); };
    if (Status status = forEachSetting(text, "axis=position", set); !status) return status;
    accuracy = result;
    return {};
}

std::string axesText(const Accuracy& accuracy) {
    std::string text;
    for (const Axis& axis : kAxes)
        text +=
            (text.empty() ? "" : " ") + std::string(axis.name) + "=" + std::string(axis.positions[axis.get(accuracy)]);
    return text;
}

}  // namespace vernier
