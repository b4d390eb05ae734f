// The extensions the driver has, as an enum and a table, and sets of them.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vernier::vulkan {

/// Core Vulkan as far as this driver goes.
inline constexpr uint32_t kApiVersion = VK_MAKE_API_VERSION(0, 1, VERNIER_VK_MINOR_VERSION, VK_HEADER_VERSION);

enum class Extension : uint32_t {
#define VERNIER_EXTENSION(name) name,
#include "api/vulkan/extensions.def"
#undef VERNIER_EXTENSION
    count
};

class ExtensionSet {
  public:
    constexpr ExtensionSet() = default;
    constexpr ExtensionSet(Extension one) { word(one) = mask(one); }

    constexpr ExtensionSet& operator|=(const ExtensionSet& other) {
        for (size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
        return *this;
    }
    friend constexpr ExtensionSet operator|(ExtensionSet one, const ExtensionSet& other) { return one |= other; }
    constexpr bool intersects(const ExtensionSet& other) const {
        for (size_t i = 0; i < words_.size(); ++i) {
            if ((words_[i] & other.words_[i]) != 0) return true;
        }
        return false;
    }

  private:
    static constexpr size_t kWordBits = 64;
    static constexpr uint64_t mask(Extension one) { return uint64_t{1} << static_cast<size_t>(one) % kWordBits; }
    constexpr uint64_t& word(Extension one) { return words_[static_cast<size_t>(one) / kWordBits]; }

    std::array<uint64_t, (static_cast<size_t>(Extension::count) + kWordBits - 1) / kWordBits> words_{};
};

enum class ExtensionScope : uint8_t { instance, device };

/// Writes the extensions of a scope as vkEnumerate*ExtensionProperties does.
VkResult enumerateExtensions(ExtensionScope scope, uint32_t* count, VkExtensionProperties* properties);

/// Adds the named extensions to `set`. VK_ERROR_EXTENSION_NOT_PRESENT when one is not ours; `missing` then
/// names it.
VkResult selectExtensions(ExtensionScope scope, std::span<const char* const> names, ExtensionSet& set,
                          const char*& missing);

}  // namespace vernier::vulkan
