#include "base/cpu_budget.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>

namespace vernier {
namespace {

/// CPUs allowed by one cgroup v2 directory's "cpu.max" ("max 100000" or "QUOTA PERIOD", microseconds), if limited.
std::optional<double> quotaOf(const std::string& directory) {
    std::ifstream file(directory + "/cpu.max");
    std::string quota;
    double period = 0;
    if (!(file >> quota >> period) || quota == "max" || period <= 0) return std::nullopt;
    return std::atof(quota.c_str()) / period;
}

/// The tightest quota from this process's cgroup (v2 line "0::/path" of /proc/self/cgroup) up to the root.
std::optional<double> cgroupQuota() {
    std::ifstream file("/proc/self/cgroup");
    std::string line, path;
    while (std::getline(file, line))
        if (line.starts_with("0::")) path = line.substr(3);
    std::optional<double> tightest;
    while (true) {
        if (const auto quota = quotaOf("/sys/fs/cgroup" + path); quota && (!tightest || *quota < *tightest))
            tightest = quota;
        const size_t slash = path.find_last_of('/');
        if (path.empty() || slash == std::string::npos) return tightest;
        path.resize(slash);
    }
}

}  // namespace

uint32_t usableCpuCount() {
    cpu_set_t set;
    CPU_ZERO(&set);
    int count = sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
    if (const auto quota = cgroupQuota()) count = std::min(count, static_cast<int>(std::ceil(*quota)));
    return static_cast<uint32_t>(std::max(count, 1));
}

}  // namespace vernier
