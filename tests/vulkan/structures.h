// Vulkan structures in one expression.
#pragma once

#include <vulkan/vulkan_core.h>

namespace vernier::test {

/// A structure with its sType set, `next` as its chain, and everything else zero.
template <class T>
T make(VkStructureType type, const void* next = nullptr) {
    T result{};
    result.sType = type;
    result.pNext = const_cast<void*>(next);
    return result;
}

}  // namespace vernier::test
