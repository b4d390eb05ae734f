// Walking pNext chains. Structures that nobody looks for are ignored, as the specification asks.
#pragma once

#include <vulkan/vulkan_core.h>

namespace vernier::vulkan {

template <class T>
inline constexpr VkStructureType kStructureType = VK_STRUCTURE_TYPE_MAX_ENUM;
#define VERNIER_STRUCTURE(type, value) \
    template <>                        \
    inline constexpr VkStructureType kStructureType<type> = value;
#include "structures.inc"
#undef VERNIER_STRUCTURE

/// The structure of type T in an input chain, or nullptr.
template <class T>
const T* findInChain(const void* chain) {
    static_assert(kStructureType<T> != VK_STRUCTURE_TYPE_MAX_ENUM);
    for (auto* node = static_cast<const VkBaseInStructure*>(chain); node != nullptr; node = node->pNext) {
        if (node->sType == kStructureType<T>) return reinterpret_cast<const T*>(node);
    }
    return nullptr;
}

/// The structure of type T in an output chain, or nullptr.
template <class T>
T* findInChain(void* chain) {
    return const_cast<T*>(findInChain<T>(static_cast<const void*>(chain)));
}

}  // namespace vernier::vulkan
