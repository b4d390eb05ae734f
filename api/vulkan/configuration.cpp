#include "api/vulkan/configuration.h"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

namespace vernier::vulkan {
namespace {

/// Empty when unset. Not read in set-user-id programs.
std::string_view variable(const char* name) {
    const char* text = secure_getenv(name);
    return text != nullptr ? text : "";
}

Error badValue(const char* name, std::string_view value, const char* allowed) {
    return invalidArgument(std::string(name) + " is \"" + std::string(value) + "\"; allowed: " + allowed);
}

struct DeviceTypeName {
    std::string_view name;
    VkPhysicalDeviceType type;
};
constexpr DeviceTypeName kDeviceTypes[] = {
    {"cpu", VK_PHYSICAL_DEVICE_TYPE_CPU},
    {"integrated", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU},
    {"discrete", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU},
    {"virtual", VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU},
    {"other", VK_PHYSICAL_DEVICE_TYPE_OTHER},
};
constexpr uint32_t kMaxThreads = 1024;

}  // namespace

Result<Configuration> readConfiguration() {
    Configuration result;
    if (const auto text = variable("VERNIER_PROFILE"); !text.empty()) {
        const auto profile = profileFromName(text);
        if (!profile) return badValue("VERNIER_PROFILE", text, "draft, fast, standard, fine, reference");
        result.profile = *profile;
    }
    if (const auto text = variable("VERNIER_DEVICE_TYPE"); !text.empty()) {
        bool known = false;
        for (const auto& entry : kDeviceTypes) {
            if (entry.name == text) {
                result.deviceType = entry.type;
                known = true;
            }
        }
        if (!known) return badValue("VERNIER_DEVICE_TYPE", text, "cpu, integrated, discrete, virtual, other");
    }
    if (const auto text = variable("VERNIER_THREADS"); !text.empty()) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result.threads);
        if (error != std::errc() || end != text.data() + text.size() || result.threads > kMaxThreads) {
            return badValue("VERNIER_THREADS", text, "0 (as many as CPUs) to 1024");
        }
    }
    if (const auto text = variable("VERNIER_ISA"); !text.empty()) {
        const auto isa = isaFromName(text);
        if (!isa) return badValue("VERNIER_ISA", text, "sse4, avx2, avx512");
        result.maxIsa = *isa;
    }
    const auto log = variable("VERNIER_LOG");
    result.log = !log.empty() && log != "0";
    return result;
}

}  // namespace vernier::vulkan
