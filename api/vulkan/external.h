// What can be shared with other processes and devices, by which kinds of handles.
#pragma once

#include <vulkan/vulkan_core.h>

#include <memory>

#include "api/vulkan/device.h"
#include "base/result.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {

/// All zero for kinds of handles that cannot be had.
VkExternalMemoryProperties externalMemoryProperties(VkExternalMemoryHandleTypeFlags handleType);

/// Whether something may be bound to memory of all these kinds of handles.
bool areExternalMemoryTypes(VkExternalMemoryHandleTypeFlags handleTypes);

/// The alignment of address and size of host memory that is imported.
VkDeviceSize hostPointerAlignment();

/// Memory as vkAllocateMemory's structures ask for: of the device's own, to be exported, or imported.
/// VK_SUCCESS, or what vkAllocateMemory returns, which has been reported if it needs words.
VkResult makeMemory(const Device& device, const VkMemoryAllocateInfo& info, std::unique_ptr<Memory>& made);

}  // namespace vernier::vulkan
