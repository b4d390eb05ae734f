#include "conformance/oracle/blending.h"

#include <algorithm>

namespace vernier::conformance::exact {

namespace {

// Vulkan, Blending: for fixed-point attachments source, destination and blend constants are clamped to the
// format's range.
Rational clampFor(const PixelFormat& format, const Rational& value) {
    switch (format.components[0].encoding) {
        case Encoding::unorm:
        case Encoding::srgb:
            return std::clamp(value, Rational(0), Rational(1));
        case Encoding::snorm:
            return std::clamp(value, Rational(-1), Rational(1));
        default:
            return value;
    }
}

}  // namespace

BlendVerdict blendExactly(const PixelFormat& format, const VkPipelineColorBlendAttachmentState& state,
                          const std::array<Rational, 4>& constants, const std::array<Rational, 4>& source,
                          const Codes& destination) {
    std::array<Rational, 4> s, c, d;
    for (size_t i = 0; i < 4; ++i) {
        s[i] = clampFor(format, source[i]);
        c[i] = clampFor(format, constants[i]);
        // A channel that the format lacks reads as it would from a texture: colour 0, alpha 1.
        d[i] = i == 3 ? 1 : 0;
        if (const Component* component = format.channel(static_cast<uint8_t>(i))) {
            d[i] = decode(*component, destination[i]).value_or(Rational(0));
        }
    }
    BlendVerdict verdict;
    for (size_t i = 0; i < 4; ++i) {
        const Component* component = format.channel(static_cast<uint8_t>(i));
        if (!component || !(state.colorWriteMask & (VK_COLOR_COMPONENT_R_BIT << i))) {
            verdict.permitted[i] = {destination[i], destination[i], destination[i]};
        } else {
            const Rational value = state.blendEnable ? blendComponent(state, i, s, d, c, s) : s[i];
            verdict.permitted[i] = encode(*component, value);
        }
        verdict.nearest[i] = verdict.permitted[i].nearest;
    }
    return verdict;
}

std::string checkBlendChain(const PixelFormat& format, const VkPipelineColorBlendAttachmentState& state,
                            const std::array<Rational, 4>& constants, const Codes& initial,
                            const std::vector<std::array<Rational, 4>>& sources, const std::vector<Codes>& observed) {
    Codes before = initial, exactBefore = initial;
    for (size_t step = 0; step < sources.size() && step < observed.size(); ++step) {
        const BlendVerdict verdict = blendExactly(format, state, constants, sources[step], before);
        const BlendVerdict ideal = blendExactly(format, state, constants, sources[step], exactBefore);
        for (size_t i = 0; i < 4; ++i) {
            const CodeSet& set = verdict.permitted[i];
            if (set.permits(observed[step][i])) continue;
            return "blended write " + std::to_string(step) + ", channel " + "RGBA"[i] + ": code " +
                   std::to_string(observed[step][i]) + ", exact from the observed destination " +
                   std::to_string(before[i]) + " is " + std::to_string(set.below) + " or " + std::to_string(set.above) +
                   " (the ideal chain has " + std::to_string(ideal.nearest[i]) + ")";
        }
        before = observed[step];
        exactBefore = ideal.nearest;
    }
    return {};
}

}  // namespace vernier::conformance::exact
