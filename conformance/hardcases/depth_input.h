// Depth cases: triangles drawn into a depth buffer alone.
#pragma once

#include "conformance/hardcases/coverage_input.h"

#include <string>
#include <vector>

namespace vernier::conformance::hardcases {

inline constexpr VkExtent2D kDepthExtent{64, 64};

struct DepthDraw {
    VkFormat format = VK_FORMAT_D32_SFLOAT;
    float clear = 0.5f;
    float biasConstant = 0, biasSlope = 0, biasClamp = 0;
    bool bias = false, clamp = false;
    float minDepth = 0, maxDepth = 1;
};

Result<Scene> depthScene(std::string_view name, const std::vector<ClipPosition>& positions, const DepthDraw& how);

/// A triangle around the target whose depth is `z0` at the upper left corner, and z1 and z2 twice the target's size
/// away to the right and down.
std::vector<ClipPosition> depthPlane(float z0, float z1, float z2);

/// Adds two scenes, without the bias and with it, and a judge: the difference of their depths lies in an interval, up
/// to `slack`.
void judgeBias(CaseInput& input, std::string_view name, const std::vector<ClipPosition>& positions, DepthDraw how,
               double low, double high, double slack, const std::string& rule);

/// A covering draw of a fragment shader that writes these bits to FragDepth.
Result<Scene> fragDepthScene(std::string_view name, VkFormat format, uint32_t bits, float clear, VkCompareOp op,
                             bool clamp);

}  // namespace vernier::conformance::hardcases
