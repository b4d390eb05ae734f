#include "api/vulkan/validation_cache.h"

#include <algorithm>
#include <cstring>

#include "api/vulkan/allocation.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {
namespace {

/// "Layout for validation cache header version VK_VALIDATION_CACHE_HEADER_VERSION_ONE_EXT" in the specification.
struct Header {
    uint32_t size = sizeof(Header);
    uint32_t version = VK_VALIDATION_CACHE_HEADER_VERSION_ONE_EXT;
    std::array<uint8_t, VK_UUID_SIZE> uuid;

    bool operator==(const Header&) const = default;
};
static_assert(sizeof(Header) == 8 + VK_UUID_SIZE);

/// The finalizer of MurmurHash3 (Appleby, public domain): every bit of the result depends on every bit of the number.
uint64_t mixed(uint64_t number) {
    number = (number ^ number >> 33) * 0xFF51AFD7ED558CCDu;
    number = (number ^ number >> 33) * 0xC4CEB9FE1A85EC53u;
    return number ^ number >> 33;
}

}  // namespace

ModuleKey moduleKey(std::span<const uint32_t> words) {
    // Golden ratio and square root of two: two hashes that have nothing to do with each other.
    ModuleKey key{0x9E3779B97F4A7C15u, 0x6A09E667F3BCC909u};
    for (uint64_t& hash : key) {
        const uint64_t seed = hash;
        hash = mixed(seed + words.size());
        for (const uint32_t word : words) hash = mixed((hash ^ word) + seed);
    }
    return key;
}

ValidationCache::ValidationCache(const uint8_t (&uuid)[VK_UUID_SIZE], std::span<const std::byte> data) {
    std::ranges::copy(uuid, uuid_.begin());
    Header header;
    if (data.size() < sizeof header) return;
    std::memcpy(&header, data.data(), sizeof header);
    if (header != Header{.uuid = uuid_}) return;
    for (data = data.subspan(sizeof header); data.size() >= sizeof(ModuleKey); data = data.subspan(sizeof(ModuleKey))) {
        ModuleKey key;
        std::memcpy(&key, data.data(), sizeof key);
        keys_.insert(key);
    }
}

bool ValidationCache::has(const ModuleKey& key) const {
    const std::lock_guard lock(mutex_);
    return keys_.contains(key);
}

void ValidationCache::add(const ModuleKey& key) {
    const std::lock_guard lock(mutex_);
    keys_.insert(key);
}

void ValidationCache::add(const ValidationCache& other) {
    if (&other == this) return;
    const std::scoped_lock lock(mutex_, other.mutex_);
    keys_.insert(other.keys_.begin(), other.keys_.end());
}

VkResult ValidationCache::write(size_t* size, void* data) const {
    const std::lock_guard lock(mutex_);
    const size_t all = sizeof(Header) + keys_.size() * sizeof(ModuleKey);
    if (data == nullptr) {
        *size = all;
        return VK_SUCCESS;
    }
    if (*size < sizeof(Header)) {
        *size = 0;
        return VK_INCOMPLETE;
    }
    const Header header{.uuid = uuid_};
    auto* to = static_cast<std::byte*>(data);
    std::memcpy(to, &header, sizeof header);
    size_t written = sizeof header;
    for (const ModuleKey& key : keys_) {
        if (*size - written < sizeof key) break;
        std::memcpy(to + written, &key, sizeof key);
        written += sizeof key;
    }
    *size = written;
    return written == all ? VK_SUCCESS : VK_INCOMPLETE;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateValidationCacheEXT(VkDevice device,
                                                        const VkValidationCacheCreateInfoEXT* pCreateInfo,
                                                        const VkAllocationCallbacks* pAllocator,
                                                        VkValidationCacheEXT* pValidationCache) {
    const std::span data(static_cast<const std::byte*>(pCreateInfo->pInitialData), pCreateInfo->initialDataSize);
    return createHandle(pAllocator, pValidationCache, object(device)->physicalDevice.properties.pipelineCacheUUID,
                        data);
}

VKAPI_ATTR void VKAPI_CALL DestroyValidationCacheEXT(VkDevice, VkValidationCacheEXT validationCache,
                                                     const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, validationCache);
}

VKAPI_ATTR VkResult VKAPI_CALL MergeValidationCachesEXT(VkDevice, VkValidationCacheEXT dstCache, uint32_t srcCacheCount,
                                                        const VkValidationCacheEXT* pSrcCaches) {
    return guarded([&] {
        for (uint32_t i = 0; i < srcCacheCount; ++i) object(dstCache)->add(*object(pSrcCaches[i]));
        return VK_SUCCESS;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetValidationCacheDataEXT(VkDevice, VkValidationCacheEXT validationCache,
                                                         size_t* pDataSize, void* pData) {
    return object(validationCache)->write(pDataSize, pData);
}

}  // namespace vernier::vulkan
