#include "bench/speed/machine.h"

#include <algorithm>
#include <fstream>

#include "base/cpu_budget.h"
#include "base/simd.h"

namespace vernier::bench {
namespace {

/// The processor as Linux names it, or nothing.
std::string cpuModel() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
    return {};
}

}  // namespace

std::string machineText() {
    return std::to_string(usableCpuCount()) + " usable CPUs (" + cpuModel() + "), " + std::string(isaName(bestIsa()));
}

}  // namespace vernier::bench
