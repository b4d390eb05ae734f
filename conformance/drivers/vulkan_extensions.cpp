#include "conformance/drivers/vulkan_extensions.h"

#include "conformance/drivers/vulkan_context.h"

#include <algorithm>
#include <cstring>

namespace vernier::conformance {

Status VulkanExtensions::query(VkPhysicalDevice device, PFN_vkGetPhysicalDeviceFeatures2KHR getFeatures) {
    uint32_t count = 0;
    VERNIER_TRY_VK(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> present(count);
    VERNIER_TRY_VK(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, present.data()));
    const auto has = [&](const char* name) {
        return std::any_of(present.begin(), present.end(), [&](const VkExtensionProperties& each) {
            return std::strcmp(each.extensionName, name) == 0;
        });
    };
    const auto enable = [&](const char* name) {
        const bool found = has(name);
        if (found) names_.push_back(name);
        return found;
    };
#define VERNIER_ENABLE(name, extension) name = enable(extension);
    VERNIER_PLAIN_EXTENSIONS(VERNIER_ENABLE)
#undef VERNIER_ENABLE
    if (getFeatures == nullptr) return {};
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
#define VERNIER_CHAIN(name, extension, Struct, type) \
    if (enable(extension)) {                         \
        name.sType = type;                           \
        name.pNext = chain_;                         \
        chain_ = &name;                              \
    }
    VERNIER_FEATURE_EXTENSIONS(VERNIER_CHAIN)
#undef VERNIER_CHAIN
    features.pNext = chain_;
    getFeatures(device, &features);
    return {};
}

}  // namespace vernier::conformance
