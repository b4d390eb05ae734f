#include "api/vulkan/extension.h"

#include <string_view>

#include "api/vulkan/enumerate.h"

namespace vernier::vulkan {
namespace {

struct ExtensionInfo {
    Extension extension;
    std::string_view name;
    uint32_t specVersion;
    ExtensionScope scope;
};

constexpr ExtensionInfo kExtensions[] = {
#define VERNIER_EXTENSION_ROW(identifier, name, version, isInstance) \
    {Extension::identifier, name, version, isInstance ? ExtensionScope::instance : ExtensionScope::device},
#include "extensions.inc"
#undef VERNIER_EXTENSION_ROW
};

}  // namespace

VkResult enumerateExtensions(ExtensionScope scope, uint32_t* count, VkExtensionProperties* properties) {
    OutputArray<VkExtensionProperties> output(count, properties);
    for (const ExtensionInfo& info : kExtensions) {
        if (info.scope != scope) continue;
        VkExtensionProperties entry{};
        info.name.copy(entry.extensionName, sizeof entry.extensionName - 1);
        entry.specVersion = info.specVersion;
        output.add(entry);
    }
    return output.result();
}

VkResult selectExtensions(ExtensionScope scope, std::span<const char* const> names, ExtensionSet& set,
                          const char*& missing) {
    for (const char* name : names) {
        bool found = false;
        for (const ExtensionInfo& info : kExtensions) {
            if (info.scope == scope && info.name == name) {
                set |= info.extension;
                found = true;
            }
        }
        if (!found) {
            missing = name;
            return VK_ERROR_EXTENSION_NOT_PRESENT;
        }
    }
    return VK_SUCCESS;
}

}  // namespace vernier::vulkan
