// W: w near zero, huge and tiny coordinates, NaN and infinities in positions.
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"

#include <cmath>

namespace vernier::conformance::hardcases {
namespace {

using exact::Rational;

constexpr VkExtent2D kTarget{64, 64};

std::vector<ColorVertex> scaledVertices(int exponent) {
    std::vector<ColorVertex> vertices{
        {{-0.8f, -0.9f, 0.2f, 1}, {1, 0, 0, 1}},        {{2.7f, -1.9f, 1.1f, 3}, {0, 1, 0, 1}},
        {{-0.9f, 1.55f, 0.9f, 1.75f}, {0, 0, 1, 1}},    {{0.9f, 0.85f, 0.1f, 1}, {1, 1, 0, 1}},
        {{-0.6f, 0.97f, 0.5f, 1}, {0, 1, 1, 1}},        {{1.9f, -1.3f, 1.5f, 2.5f}, {1, 0, 1, 1}},
        {{0.05f, 0.4f, -0.25f, 0.5f}, {1, 0.5f, 0, 1}}, {{3.5f, 3.9f, 2, 4}, {0.25f, 0.5f, 1, 1}},
        {{-0.2f, 1.9f, 1, 2}, {0, 0.75f, 0.25f, 1}},
    };
    for (ColorVertex& v : vertices) {
        for (float& c : v.position) c = std::ldexp(c, exponent);
    }
    return vertices;
}

// The same picture for every scale; the plain one is judged by the oracle.
void scales(CaseInput& input, std::string_view name, std::initializer_list<int> exponents) {
    const size_t plain = addForOracle(input, colorScene(name, scaledVertices(0), kTarget));
    for (const int exponent : exponents) {
        judgeSame(input, input.scene(colorScene(name, scaledVertices(exponent), kTarget)), plain,
                  "scaling clip coordinates by 2^" + std::to_string(exponent) + " changes no exact result");
    }
}

// Products of two coordinates overflow.
void w06(CaseInput& input) {
    scales(input, "W06", {20, 63, 100, 120, 125});
}
// Products of two coordinates are denormal or 0.
void w07(CaseInput& input) {
    scales(input, "W07", {-30, -63, -100});
}

constexpr std::string_view kTransform = "Vulkan, Coordinate Transformations; the ratio is what counts";

const std::vector<HardCase> kCases{
    {"W06", "Clip coordinates scaled by up to 2^125: products overflow float",
     "A power of two changes no exact result: the same bits.", kTransform, w06},
    {"W07", "Clip coordinates scaled by down to 2^-100: products are denormal",
     "A power of two changes no exact result: the same bits.", kTransform, w07},
};

}  // namespace

std::span<const HardCase> homogeneousCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
