// Depth and stencil of single samples: the definition of the tests (specification, "Fragment Operations"),
// used where order or state asks for one sample at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/plan/graphics_state.h"
#include "runtime/plan/plan.h"

namespace vernier {

/// Memory of the depth/stencil attachment, layer 0.
struct DepthTarget {
    std::byte* data = nullptr;
    size_t rowPitch = 0, samplePitch = 0;
    uint32_t texelBytes = 0;

    std::byte* texel(int32_t x, int32_t y, uint32_t sample) const {
        return data + static_cast<size_t>(y) * rowPitch + static_cast<size_t>(x) * texelBytes + sample * samplePitch;
    }
};

struct DepthStencilState {
    const DepthPlan* plan = nullptr;
    DepthTarget target;
    float minBounds = 0, maxBounds = 1;
    struct Face {
        VkStencilOpState ops{};
        DynamicState::StencilFace values;
    };
    Face front, back;
};

/// Bytes from the start of a texel to its stencil value.
size_t stencilOffset(DepthStorage storage);

/// Bounds test, stencil test, depth test, and the writes they lead to. Returns whether the sample lives.
/// `stencilReference`: replaces that of the face (FragStencilRefEXT); nullptr: the face's.
bool testSample(const DepthStencilState& state, std::byte* texel, float z, bool front,
                const uint32_t* stencilReference = nullptr);

}  // namespace vernier
