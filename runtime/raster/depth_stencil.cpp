#include "runtime/raster/depth_stencil.h"

#include <cstring>

#include "runtime/format/convert.h"

namespace vernier {
namespace {

uint32_t load32(const std::byte* p) {
    uint32_t value;
    std::memcpy(&value, p, 4);
    return value;
}

constexpr uint32_t kMask24 = 0xFFFFFF;

/// VkCompareOp as three bits: less, equal, greater.
template <class T>
bool passes(uint32_t compare, T value, T reference) {
    const bool unequal = (compare & 5) == 5 && value != reference;  // NaN, too: undefined contents may be one
    return unequal || ((compare & 1) != 0 && value < reference) || ((compare & 2) != 0 && value == reference) ||
           ((compare & 4) != 0 && value > reference);
}

/// A depth as the attachment holds it, and as a float for the bounds test.
float storedDepth(DepthStorage storage, const std::byte* texel) {
    switch (storage) {
        case DepthStorage::d16: {
            uint16_t code;
            std::memcpy(&code, texel, 2);
            return decodeUnorm(code, 16);
        }
        case DepthStorage::d24:
            return decodeUnorm(load32(texel) & kMask24, 24);
        case DepthStorage::none:
            return 0;
        default:
            return std::bit_cast<float>(load32(texel));
    }
}

bool depthPasses(DepthStorage storage, uint32_t compare, const std::byte* texel, float z) {
    switch (storage) {
        case DepthStorage::d16: {
            uint16_t code;
            std::memcpy(&code, texel, 2);
            return passes<uint32_t>(compare, encodeUnorm(z, 16), code);
        }
        case DepthStorage::d24:
            return passes<uint32_t>(compare, encodeUnorm(z, 24), load32(texel) & kMask24);
        case DepthStorage::none:
            return true;
        default:
            return passes<float>(compare, z, std::bit_cast<float>(load32(texel)));
    }
}

void storeDepth(DepthStorage storage, std::byte* texel, float z) {
    switch (storage) {
        case DepthStorage::d16: {
            const auto code = static_cast<uint16_t>(encodeUnorm(z, 16));
            std::memcpy(texel, &code, 2);
            return;
        }
        case DepthStorage::d24: {
            const uint32_t merged = (load32(texel) & ~kMask24) | encodeUnorm(z, 24);
            std::memcpy(texel, &merged, 4);
            return;
        }
        case DepthStorage::none:
            return;
        default:
            std::memcpy(texel, &z, 4);
    }
}

uint8_t applyStencilOp(VkStencilOp op, uint8_t stored, uint8_t reference) {
    switch (op) {
        case VK_STENCIL_OP_ZERO:
            return 0;
        case VK_STENCIL_OP_REPLACE:
            return reference;
        case VK_STENCIL_OP_INCREMENT_AND_CLAMP:
            return stored == 255 ? stored : static_cast<uint8_t>(stored + 1);
        case VK_STENCIL_OP_DECREMENT_AND_CLAMP:
            return stored == 0 ? stored : static_cast<uint8_t>(stored - 1);
        case VK_STENCIL_OP_INVERT:
            return static_cast<uint8_t>(~stored);
        case VK_STENCIL_OP_INCREMENT_AND_WRAP:
            return static_cast<uint8_t>(stored + 1);
        case VK_STENCIL_OP_DECREMENT_AND_WRAP:
            return static_cast<uint8_t>(stored - 1);
        default:
            return stored;
    }
}

}  // namespace

size_t stencilOffset(DepthStorage storage) {
    switch (storage) {
        case DepthStorage::d24:
            return 3;
        case DepthStorage::d32fs8:
            return 4;
        default:
            return 0;
    }
}

bool testSample(const DepthStencilState& state, std::byte* texel, float z, bool front,
                const uint32_t* stencilReference) {
    const DepthPlan& plan = *state.plan;
    if (plan.bounds) {
        const float stored = storedDepth(plan.storage, texel);
        if (!(stored >= state.minBounds && stored <= state.maxBounds)) return false;
    }
    const auto depthTest = [&] { return !plan.test || depthPasses(plan.storage, plan.compare, texel, z); };
    if (!plan.stencil) {
        if (!depthTest()) return false;
        if (plan.write) storeDepth(plan.storage, texel, z);
        return true;
    }
    const DepthStencilState::Face& face = front ? state.front : state.back;
    std::byte* byte = texel + stencilOffset(plan.storage);
    const auto stored = static_cast<uint8_t>(*byte);
    const auto reference = static_cast<uint8_t>(stencilReference ? *stencilReference : face.values.reference);
    const uint32_t mask = face.values.compareMask & 0xFF;
    const bool stencilPass = passes<uint32_t>(face.ops.compareOp, reference & mask, stored & mask);
    const bool depthPass = stencilPass && depthTest();
    const VkStencilOp op = !stencilPass ? face.ops.failOp : depthPass ? face.ops.passOp : face.ops.depthFailOp;
    const uint32_t writeMask = face.values.writeMask & 0xFF;
    const uint8_t value = applyStencilOp(op, stored, reference);
    *byte = static_cast<std::byte>((stored & ~writeMask) | (value & writeMask));
    if (depthPass && plan.write) storeDepth(plan.storage, texel, z);
    return depthPass;
}

}  // namespace vernier
