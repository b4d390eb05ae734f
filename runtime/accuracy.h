// The accuracy dial: one ordered setting that sets every axis, and each axis alone. Watertightness, order, determinism
// and safety are no axes: they hold at every position.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "spirv_interp/program.h"

namespace vernier {

enum class Profile : uint8_t { draft, fast, standard, fine, reference };
inline constexpr Profile kProfiles[] = {Profile::draft, Profile::fast, Profile::standard, Profile::fine,
                                        Profile::reference};

enum class InterpolationArithmetic : uint8_t {
    singleFloat,  // float barycentrics, anchored at the primitive
    doubleFloat,  // double barycentrics and attributes, rounded once at the end
};

struct Accuracy {
    uint32_t subPixelBits = 8;  // 4, 8, 12 or 16
    InterpolationArithmetic interpolation = InterpolationArithmetic::singleFloat;
    MathTier math = MathTier::standard;
    bool operator==(const Accuracy&) const = default;
};

/// The axes at one position of the dial.
Accuracy accuracyOf(Profile profile);

std::string_view profileName(Profile profile);
std::optional<Profile> profileFromName(std::string_view name);

}  // namespace vernier
