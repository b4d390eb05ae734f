#include "base/simd.h"

#include <algorithm>
#include <array>

namespace vernier {
namespace {

constexpr std::array<std::string_view, 3> kIsaNames{"sse4", "avx2", "avx512"};

}  // namespace

Isa bestIsa() {
    // The sets Highway's targets of the same name are compiled with.
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("bmi");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd");
    return avx512 ? Isa::avx512 : avx2 ? Isa::avx2 : Isa::sse4;
}

Isa bestIsaUpTo(Isa limit) {
    return std::min(bestIsa(), limit);
}

std::string_view isaName(Isa isa) {
    return kIsaNames[static_cast<size_t>(isa)];
}

std::optional<Isa> isaFromName(std::string_view name) {
    const auto found = std::find(kIsaNames.begin(), kIsaNames.end(), name);
    if (found == kIsaNames.end()) return std::nullopt;
    return static_cast<Isa>(found - kIsaNames.begin());
}

}  // namespace vernier
