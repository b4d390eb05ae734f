// Creating and destroying the objects behind handles, through the application's allocation callbacks where it
// gives some. Nothing thrown leaves the driver: guarded() turns exceptions into result codes.
#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <utility>

#include "api/vulkan/handle.h"
#include "api/vulkan/private_data.h"

namespace vernier::vulkan {

/// nullptr when out of memory.
void* allocateHost(const VkAllocationCallbacks* callbacks, size_t bytes, size_t alignment,
                   VkSystemAllocationScope scope);
void freeHost(const VkAllocationCallbacks* callbacks, void* memory, size_t alignment);

/// Runs the body of an entry point. What it throws becomes a result: std::bad_alloc
/// VK_ERROR_OUT_OF_HOST_MEMORY, anything else VK_ERROR_UNKNOWN.
template <class Body>
VkResult guarded(Body&& body) noexcept {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    } catch (...) {
        return VK_ERROR_UNKNOWN;
    }
}

/// Where an object lies in its allocation: behind its header.
template <class T>
inline constexpr size_t kObjectAlignment = std::max(alignof(T), alignof(ObjectHeader));
template <class T>
inline constexpr size_t kObjectOffset = std::max(alignof(T), sizeof(ObjectHeader));

/// Constructs a T in memory from the callbacks; nullptr when there is none. Exceptions of the constructor
/// pass through.
template <class T, class... Args>
T* newObject(const VkAllocationCallbacks* callbacks, VkSystemAllocationScope scope, Args&&... args) {
    void* memory = allocateHost(callbacks, kObjectOffset<T> + sizeof(T), kObjectAlignment<T>, scope);
    if (memory == nullptr) return nullptr;
    std::byte* const place = static_cast<std::byte*>(memory) + kObjectOffset<T>;
    new (place - sizeof(ObjectHeader)) ObjectHeader;
    try {
        return new (place) T(std::forward<Args>(args)...);
    } catch (...) {
        freeHost(callbacks, memory, kObjectAlignment<T>);
        throw;
    }
}

template <class T>
void deleteObject(const VkAllocationCallbacks* callbacks, T* object) {
    if (object == nullptr) return;
    auto* const place = reinterpret_cast<std::byte*>(object);
    const auto* header = reinterpret_cast<const ObjectHeader*>(place - sizeof(ObjectHeader));
    if (PrivateData* data = header->data) data->forgetObject(object);
    object->~T();
    freeHost(callbacks, place - kObjectOffset<T>, kObjectAlignment<T>);
}

/// Makes the object of a non-dispatchable or dispatchable handle and stores the handle in `out`.
template <class Handle, class... Args>
VkResult createHandle(const VkAllocationCallbacks* callbacks, Handle* out, Args&&... args) {
    return guarded([&] {
        auto* made =
            newObject<ObjectOf<Handle>>(callbacks, VK_SYSTEM_ALLOCATION_SCOPE_OBJECT, std::forward<Args>(args)...);
        if (made == nullptr) return VK_ERROR_OUT_OF_HOST_MEMORY;
        *out = handleOf<Handle>(made);
        return VK_SUCCESS;
    });
}

/// VK_NULL_HANDLE is allowed.
template <class Handle>
void destroyHandle(const VkAllocationCallbacks* callbacks, Handle handle) {
    deleteObject(callbacks, object(handle));
}

}  // namespace vernier::vulkan
