// How much memory this process may use.
#include <sys/sysinfo.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <string>

#include "api/vulkan/physical_device.h"

namespace vernier::vulkan {
namespace {

constexpr VkDeviceSize kNoLimit = ~VkDeviceSize{0};

/// A limit file of cgroup version 2: a number, or "max".
VkDeviceSize readLimit(const std::string& path) {
    std::ifstream file(path);
    std::string text;
    VkDeviceSize value = kNoLimit;
    if (!(file >> text)) return kNoLimit;
    if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc()) return kNoLimit;
    return value;
}

/// The lowest memory.max from the process's control group up to the root.
VkDeviceSize controlGroupLimit() {
    std::ifstream file("/proc/self/cgroup");
    VkDeviceSize limit = kNoLimit;
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("0::", 0) != 0) continue;
        std::string group = line.substr(3);
        for (;;) {
            limit = std::min(limit, readLimit("/sys/fs/cgroup" + group + "/memory.max"));
            const size_t slash = group.rfind('/');
            if (slash == std::string::npos || group.empty()) break;
            group.resize(slash);
        }
    }
    return limit;
}

}  // namespace

VkDeviceSize heapSize() {
    struct sysinfo info {};
    VkDeviceSize total = VkDeviceSize{1} << 30;
    if (sysinfo(&info) == 0) total = VkDeviceSize{info.totalram} * info.mem_unit;
    return std::min(total, controlGroupLimit()) / 4 * 3;
}

}  // namespace vernier::vulkan
