// Which shader modules have been found valid (VK_EXT_validation_cache), so that they are not validated again. A module
// is known by 128 bits of a hash of its words.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <span>

namespace vernier::vulkan {

using ModuleKey = std::array<uint64_t, 2>;
ModuleKey moduleKey(std::span<const uint32_t> words);

/// Thread-safe.
struct ValidationCache {
    /// Data of another driver or version is left alone.
    ValidationCache(const uint8_t (&uuid)[VK_UUID_SIZE], std::span<const std::byte> data);

    bool has(const ModuleKey& key) const;
    void add(const ModuleKey& key);
    void add(const ValidationCache& other);

    /// As vkGetValidationCacheDataEXT does: a header and as many keys as there is room for.
    VkResult write(size_t* size, void* data) const;

  private:
    std::array<uint8_t, VK_UUID_SIZE> uuid_{};
    mutable std::mutex mutex_;
    std::set<ModuleKey> keys_;
};

}  // namespace vernier::vulkan
