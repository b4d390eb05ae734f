// Bounds of the driver itself, reported by limits.cpp and checked where objects are made.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

#include "runtime/limits.h"

namespace vernier::vulkan {

/// 1, 2, 4, 8, 16: VkSampleCountFlagBits are the counts themselves.
inline constexpr VkSampleCountFlags kSampleCounts = 2 * kMaxSamples - 1;
/// Bits of a view mask.
inline constexpr uint32_t kMaxViews = 32;
inline constexpr uint32_t kMaxDescriptorsPerSet = 1u << 20;
inline constexpr uint32_t kMaxInlineUniformBlockBytes = 4096;
inline constexpr uint32_t kMaxInlineUniformBlocks = 64;
inline constexpr uint32_t kMaxPushDescriptors = 256;
inline constexpr uint32_t kMaxVertexAttributeOffset = 2047;
inline constexpr uint32_t kMaxVertexBindingStride = 2048;
/// Offsets of 32 bits stay inside an allocation's buffer bindings, and sums of sizes far from overflow.
inline constexpr VkDeviceSize kMaxAllocation = VkDeviceSize{1} << 40;

}  // namespace vernier::vulkan
