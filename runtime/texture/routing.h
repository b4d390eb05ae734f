// Component substitution and swizzle: which converted component, or which constant, each output takes.
#pragma once

#include <bit>
#include <cstdint>

#include "runtime/texture/texture.h"

namespace vernier {

/// Index of a component of the format, or one of the constants.
enum class Route : uint8_t { r, g, b, a, zero, one };

/// "Component swizzle" of the Vulkan specification for output component 0..3.
inline Route routeOf(const VkComponentMapping& swizzle, uint32_t output) {
    const VkComponentSwizzle all[4] = {swizzle.r, swizzle.g, swizzle.b, swizzle.a};
    switch (all[output]) {
        case VK_COMPONENT_SWIZZLE_ZERO:
            return Route::zero;
        case VK_COMPONENT_SWIZZLE_ONE:
            return Route::one;
        case VK_COMPONENT_SWIZZLE_R:
            return Route::r;
        case VK_COMPONENT_SWIZZLE_G:
            return Route::g;
        case VK_COMPONENT_SWIZZLE_B:
            return Route::b;
        case VK_COMPONENT_SWIZZLE_A:
            return Route::a;
        default:
            return static_cast<Route>(output);
    }
}

/// The bits of Route::zero and Route::one, and of the components that a format lacks.
inline uint32_t constantBits(const TexelLayout& layout, bool one) {
    if (!one) return 0;
    return layout.type == ValueType::floating ? std::bit_cast<uint32_t>(1.0f) : 1u;
}

}  // namespace vernier
