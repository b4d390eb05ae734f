// Device memory as an object, and the checks shared by buffers and images when memory is bound.
#pragma once

#include <memory>
#include <string>

#include "api/vulkan/handle.h"
#include "base/result.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {

struct DeviceMemory {
    explicit DeviceMemory(std::unique_ptr<Memory> made) : memory(std::move(made)) {}
    std::unique_ptr<Memory> memory;
    bool mapped = false;  // externally synchronised, as the mapping is
};

/// The requirements of something of `size` bytes: one memory type, and whole cache lines.
VkMemoryRequirements memoryRequirements(VkDeviceSize size);

/// Fills the structures that may hang on VkMemoryRequirements2.
void fillRequirementChain(void* chain);

/// Whether a resource of `size` bytes fits at `offset`.
Status checkBinding(const DeviceMemory* memory, VkDeviceSize offset, VkDeviceSize size);

}  // namespace vernier::vulkan
