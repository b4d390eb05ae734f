// The extensions the driver has, as an enum and a table, and sets of them.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>

namespace vernier::vulkan {

/// Core Vulkan as far as this driver goes.
inline constexpr uint32_t kApiVersion = VK_MAKE_API_VERSION(0, 1, 0, VK_HEADER_VERSION);

enum class Extension : uint32_t {
#define VERNIER_EXTENSION(name) name,
#include "api/vulkan/extensions.def"
#undef VERNIER_EXTENSION
    count
};

using ExtensionSet = uint64_t;
static_assert(static_cast<uint32_t>(Extension::count) <= 64);

constexpr ExtensionSet bit(Extension extension) {
    return ExtensionSet{1} << static_cast<uint32_t>(extension);
}

enum class ExtensionScope : uint8_t { instance, device };

/// Writes the extensions of a scope as vkEnumerate*ExtensionProperties does.
VkResult enumerateExtensions(ExtensionScope scope, uint32_t* count, VkExtensionProperties* properties);

/// Adds the named extensions to `set`. VK_ERROR_EXTENSION_NOT_PRESENT when one is not ours; `missing` then
/// names it.
VkResult selectExtensions(ExtensionScope scope, std::span<const char* const> names, ExtensionSet& set,
                          const char*& missing);

}  // namespace vernier::vulkan
