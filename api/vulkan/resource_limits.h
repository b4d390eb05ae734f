// Bounds of the driver itself, reported by limits.cpp and checked where objects are made.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace vernier::vulkan {

inline constexpr uint32_t kMaxDescriptorsPerSet = 1u << 20;
inline constexpr uint32_t kMaxVertexAttributeOffset = 2047;
inline constexpr uint32_t kMaxVertexBindingStride = 2048;
/// Offsets of 32 bits stay inside an allocation's buffer bindings, and sums of sizes far from overflow.
inline constexpr VkDeviceSize kMaxAllocation = VkDeviceSize{1} << 40;

}  // namespace vernier::vulkan
