#include "api/vulkan/configuration.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "runtime/command/thread_limit.h"

namespace vernier::vulkan {
namespace {

/// Empty when unset. Not read in set-user-id programs.
std::string_view variable(const char* name) {
    const char* text = secure_getenv(name);
    return text != nullptr ? text : "";
}

Error badValue(const char* name, std::string_view value, std::string_view allowed) {
    return invalidArgument(std::string(name) + " is \"" + std::string(value) + "\"; allowed: " + std::string(allowed));
}

/// "VERNIER_AXIS_SUBPIXEL" of the axis "subpixel".
std::string axisVariable(const Axis& axis) {
    std::string name = axis.name;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return "VERNIER_AXIS_" + name;
}

Status readAccuracies(std::vector<DeviceAccuracy>& accuracies) {
    std::string changes;
    Accuracy scratch;
    for (const Axis& axis : axes()) {
        const std::string name = axisVariable(axis);
        const auto text = variable(name.c_str());
        if (text.empty()) continue;
        const std::string change = std::string(axis.name) + "=" + std::string(text);
        if (Status status = setAxes(scratch, change); !status)
            return invalidArgument(name + ": " + status.error().message);
        changes += ", " + change;
    }
    std::string_view names = variable("VERNIER_PROFILE");
    if (names.empty()) names = profileName(Profile::standard);
    while (true) {
        const std::string_view name = names.substr(0, names.find(','));
        const auto profile = profileFromName(name);
        if (!profile) return badValue("VERNIER_PROFILE", name, "draft, fast, standard, fine, reference");
        DeviceAccuracy& made =
            accuracies.emplace_back(DeviceAccuracy{std::string(name) + changes, accuracyOf(*profile)});
        if (Status status = setAxes(made.accuracy, changes); !status) return status.error();
        if (name.size() == names.size()) return {};
        names.remove_prefix(name.size() + 1);
    }
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
constexpr uint32_t kMaxRefreshRate = 1000;

/// Leaves `number` alone when the variable is unset.
Status readNumber(const char* name, uint32_t largest, const char* zero, uint32_t& number) {
    const auto text = variable(name);
    if (text.empty()) return {};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    if (!whole || number > largest)
        return badValue(name, text, std::string("0 (") + zero + ") to " + std::to_string(largest));
    return {};
}

}  // namespace

Result<Configuration> readConfiguration() {
    Configuration result;
    if (Status status = readAccuracies(result.accuracies); !status) return status.error();
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
    if (Status s = readNumber("VERNIER_THREADS", kMaxThreads, "as many as CPUs", result.threads); !s) {
        return s.error();
    }
    if (Status s = readNumber("VERNIER_REFRESH", kMaxRefreshRate, "at once", result.refreshRate); !s) {
        return s.error();
    }
    if (const auto text = variable("VERNIER_ISA"); !text.empty()) {
        const auto isa = isaFromName(text);
        if (!isa) return badValue("VERNIER_ISA", text, isaNames());
        result.maxIsa = *isa;
    }
    Result<Skips> skips = skipsFrom(variable("VERNIER_SKIP"));
    if (!skips) return invalidArgument("VERNIER_SKIP: " + skips.error().message);
    result.skips = *skips;
    result.explain = variable("VERNIER_EXPLAIN");
    const auto isSet = [](const char* name) {
        const auto text = variable(name);
        return !text.empty() && text != "0";
    };
    result.validate = isSet("VERNIER_VALIDATE");
    result.log = result.validate || isSet("VERNIER_LOG");
    return result;
}

}  // namespace vernier::vulkan
