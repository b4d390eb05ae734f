#include "api/vulkan/allocation.h"

namespace vernier::vulkan {

void* allocateHost(const VkAllocationCallbacks* callbacks, size_t bytes, size_t alignment,
                   VkSystemAllocationScope scope) {
    if (callbacks != nullptr) return callbacks->pfnAllocation(callbacks->pUserData, bytes, alignment, scope);
    return ::operator new(bytes, std::align_val_t(alignment), std::nothrow);
}

void freeHost(const VkAllocationCallbacks* callbacks, void* memory, size_t alignment) {
    if (callbacks != nullptr) {
        callbacks->pfnFree(callbacks->pUserData, memory);
    } else {
        ::operator delete(memory, std::align_val_t(alignment));
    }
}

}  // namespace vernier::vulkan
