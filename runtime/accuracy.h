// The accuracy dial: one ordered setting that sets every axis, and each axis alone. Watertightness, order, determinism
// and safety are no axes: they hold at every position.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "spirv_interp/program.h"

namespace vernier {

enum class Profile : uint8_t { draft, fast, standard, fine, reference };
inline constexpr Profile kProfiles[] = {Profile::draft, Profile::fast, Profile::standard, Profile::fine,
                                        Profile::reference};

enum class InterpolationArithmetic : uint8_t {
    singleFloat,  // float barycentrics, anchored at the primitive
    doubleFloat,  // double barycentrics and attributes, rounded once at the end
};

enum class ShadingRate : uint8_t {
    twoByTwo,  // a fragment program runs once for 2x2 pixels where it can: Plan::coarse
    pixel,
};

struct Accuracy {
    uint32_t subPixelBits = 8;  // 4, 8, 12 or 16
    InterpolationArithmetic interpolation = InterpolationArithmetic::singleFloat;
    MathTier math = MathTier::standard;
    uint32_t anisotropy = 16;  // 1, 2, 4, 8 or 16: at most so many samples of an anisotropic filter
    ShadingRate shading = ShadingRate::pixel;
    bool operator==(const Accuracy&) const = default;
};

/// The axes at one position of the dial.
Accuracy accuracyOf(Profile profile);

std::string_view profileName(Profile profile);
std::optional<Profile> profileFromName(std::string_view name);

/// One axis, which can be set apart from the others.
struct Axis {
    const char* name;                        // "subpixel"
    const char* meaning;                     // a sentence
    std::span<const char* const> positions;  // from cheap to exact: "4", "8", "12", "16"
    size_t lowestForVulkan;                  // index of the first position that meets what Vulkan asks for
    size_t (*get)(const Accuracy&);          // index into positions
    void (*set)(Accuracy&, size_t position);
};
std::span<const Axis> axes();

/// Sets axes of `accuracy` as `text` says: "axis=position" once or several times, with spaces or commas between, e.g.
/// "subpixel=12 math=fine". The error names what is unknown and what is allowed; `accuracy` is then as before.
Status setAxes(Accuracy& accuracy, std::string_view text);

/// All axes, in the form that setAxes() reads.
std::string axesText(const Accuracy& accuracy);

}  // namespace vernier
