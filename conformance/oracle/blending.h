// Blend equations in any number type: Rational for exact checks and replays, Interval for the whole-scene
// oracle.
#pragma once

#include "conformance/oracle/encode.h"
#include "conformance/oracle/exact.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <string>
#include <vector>

namespace vernier::conformance::exact {

template <class T>
T smaller(const T& a, const T& b) {
    return b < a ? b : a;
}
template <class T>
T larger(const T& a, const T& b) {
    return a < b ? b : a;
}

/// Component `channel` of a blend factor (Vulkan, Blend Factors). Dual-source factors take `source1`.
template <class T>
T blendFactor(VkBlendFactor factor, size_t channel, const std::array<T, 4>& source, const std::array<T, 4>& destination,
              const std::array<T, 4>& constants, const std::array<T, 4>& source1) {
    const T one(1);
    switch (factor) {
        case VK_BLEND_FACTOR_ZERO:
            return T(0);
        case VK_BLEND_FACTOR_SRC_COLOR:
            return source[channel];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR:
            return one - source[channel];
        case VK_BLEND_FACTOR_DST_COLOR:
            return destination[channel];
        case VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR:
            return one - destination[channel];
        case VK_BLEND_FACTOR_SRC_ALPHA:
            return source[3];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA:
            return one - source[3];
        case VK_BLEND_FACTOR_DST_ALPHA:
            return destination[3];
        case VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA:
            return one - destination[3];
        case VK_BLEND_FACTOR_CONSTANT_COLOR:
            return constants[channel];
        case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR:
            return one - constants[channel];
        case VK_BLEND_FACTOR_CONSTANT_ALPHA:
            return constants[3];
        case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA:
            return one - constants[3];
        case VK_BLEND_FACTOR_SRC_ALPHA_SATURATE: {
            if (channel == 3) return one;
            const T room = one - destination[3];
            return smaller(source[3], room);
        }
        case VK_BLEND_FACTOR_SRC1_COLOR:
            return source1[channel];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR:
            return one - source1[channel];
        case VK_BLEND_FACTOR_SRC1_ALPHA:
            return source1[3];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA:
            return one - source1[3];
        default:
            return one;  // VK_BLEND_FACTOR_ONE
    }
}

/// One component of the blended result before conversion to the attachment's format.
template <class T>
T blendComponent(const VkPipelineColorBlendAttachmentState& state, size_t channel, const std::array<T, 4>& source,
                 const std::array<T, 4>& destination, const std::array<T, 4>& constants,
                 const std::array<T, 4>& source1) {
    const bool alpha = channel == 3;
    const VkBlendOp op = alpha ? state.alphaBlendOp : state.colorBlendOp;
    const T& s = source[channel];
    const T& d = destination[channel];
    if (op == VK_BLEND_OP_MIN) return smaller(s, d);
    if (op == VK_BLEND_OP_MAX) return larger(s, d);
    const T ws = s * blendFactor(alpha ? state.srcAlphaBlendFactor : state.srcColorBlendFactor, channel, source,
                                 destination, constants, source1);
    const T wd = d * blendFactor(alpha ? state.dstAlphaBlendFactor : state.dstColorBlendFactor, channel, source,
                                 destination, constants, source1);
    switch (op) {
        case VK_BLEND_OP_SUBTRACT:
            return ws - wd;
        case VK_BLEND_OP_REVERSE_SUBTRACT:
            return wd - ws;
        default:
            return ws + wd;
    }
}

/// A pixel of a UNORM, SNORM, sRGB or float format in stored codes, by channel (absent channels 0).
using Codes = std::array<uint64_t, 4>;

/// What one blended write may leave in a pixel.
struct BlendVerdict {
    Codes nearest{};                     // the best stored result
    std::array<CodeSet, 4> permitted{};  // per channel
};

/// One draw over a pixel holding `destination`: clamps source, destination and constants as the format
/// demands, blends in rationals, converts. Channels outside the write mask keep their code.
BlendVerdict blendExactly(const PixelFormat& format, const VkPipelineColorBlendAttachmentState& state,
                          const std::array<Rational, 4>& constants, const std::array<Rational, 4>& source,
                          const Codes& destination);

/// Replays a chain of blended writes. `observed[i]` is the pixel after write i. Every write is judged from
/// the *observed* pixel before it, which separates its own error from the inherited one. Empty text: all
/// legal.
std::string checkBlendChain(const PixelFormat& format, const VkPipelineColorBlendAttachmentState& state,
                            const std::array<Rational, 4>& constants, const Codes& initial,
                            const std::vector<std::array<Rational, 4>>& sources, const std::vector<Codes>& observed);

}  // namespace vernier::conformance::exact
