// Numeric hard cases: small scenes whose right answer is known exactly, for any driver. Names follow the
// catalogue of the project's design notes: E coverage, C clipping, W homogeneous coordinates, I
// interpolation, D depth, B formats.
//
// Two ways to judge: `legal` accepts whatever the specification leaves open (snapping, tie rule, either
// neighbouring code); `declared` asks for Vernier's own promise: snapping to nearest even on 8 sub-pixel
// bits, top-left ties, nearest codes.
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <span>
#include <string_view>
#include <vector>

namespace vernier::conformance {

enum class Strictness : uint8_t { legal, declared };

/// The outputs of each of a case's scenes, in the order of build().
using CaseImages = std::vector<std::vector<RenderedImage>>;

struct NumericCase {
    std::string_view name;
    std::string_view description;
    Result<std::vector<Scene>> (*build)();
    /// An error names the first wrong pixel, its exact value and the cause.
    Status (*check)(const CaseImages& images, Strictness strictness);
};

/// All cases in the order of the catalogue.
std::span<const NumericCase> numericCases();

/// The case called `name`, or nullptr.
const NumericCase* findNumericCase(std::string_view name);

}  // namespace vernier::conformance
