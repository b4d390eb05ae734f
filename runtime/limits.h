// Sizes that several rooms of the runtime share. Each bound that an algorithm relies on stands beside that algorithm in
// a static_assert.
#pragma once

#include <cstdint>

namespace vernier {

inline constexpr uint32_t kMaxImageDimension2D = 16384;
inline constexpr uint32_t kMaxImageDimension3D = 2048;
inline constexpr uint32_t kMaxArrayLayers = 2048;
inline constexpr uint32_t kMaxMipLevels = 15;
inline constexpr uint32_t kMaxColorAttachments = 8;
inline constexpr uint32_t kMaxVertexBindings = 32;
inline constexpr uint32_t kMaxVertexAttributes = 32;
inline constexpr uint32_t kMaxViewports = 16;
inline constexpr uint32_t kMaxDescriptorSets = 8;
inline constexpr uint32_t kMaxPushConstantBytes = 256;
inline constexpr uint32_t kMaxInterfaceComponents = 128;  // between vertex and fragment stage
inline constexpr uint32_t kMaxSamples = 16;               // and every power of two below
inline constexpr uint32_t kMaxClipDistances = 8;

// Compute. The memory is what the invocations of one work-group may share, in bytes.
inline constexpr uint32_t kMaxWorkGroupCount[3] = {65535, 65535, 65535};
inline constexpr uint32_t kMaxWorkGroupSize[3] = {1024, 1024, 64};
inline constexpr uint32_t kMaxWorkGroupInvocations = 1024;
inline constexpr uint32_t kMaxWorkGroupMemory = 32768;

constexpr bool isSampleCount(uint32_t samples) {
    return samples != 0 && samples <= kMaxSamples && (samples & (samples - 1)) == 0;
}

/// Window coordinates that reach the rasteriser lie in [kGuardBandMin, kGuardBandMax] pixels; what lies outside is
/// clipped.
inline constexpr int32_t kGuardBandMin = -8192;
inline constexpr int32_t kGuardBandMax = 24575;

}  // namespace vernier
