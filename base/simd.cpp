#include "base/simd.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <algorithm>
#include <array>

namespace vernier {
namespace {

#define VERNIER_ISA_NAME(name, target, ...) #name,
constexpr std::array kIsaNames{VERNIER_ISAS(VERNIER_ISA_NAME)};
#undef VERNIER_ISA_NAME
#define VERNIER_ISA_NAME(name, target, ...) ", " #name
constexpr std::string_view kAllNames = VERNIER_ISAS(VERNIER_ISA_NAME);
#undef VERNIER_ISA_NAME
#define VERNIER_ISA_VALUE(name, target, ...) Isa::name,
constexpr std::array kIsas{VERNIER_ISAS(VERNIER_ISA_VALUE)};
#undef VERNIER_ISA_VALUE

#if defined(__x86_64__)
/// F16C, which __builtin_cpu_supports() does not know in every compiler. Asked once: virtual machines answer CPUID
/// slowly.
bool convertsHalves() {
    static const bool has = [] {
        unsigned a = 0, b = 0, c = 0, d = 0;
        return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
    }();
    return has;
}
#endif

}  // namespace

Isa bestIsa() {
#if defined(__x86_64__)
    // The sets Highway's targets of the same name are compiled with.
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("bmi") && convertsHalves();
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd");
    return avx512 ? Isa::avx512 : avx2 ? Isa::avx2 : Isa::sse4;
#else
    return kHighestIsa;
#endif
}

Isa bestIsaUpTo(Isa limit) {
    return std::min(bestIsa(), limit);
}

std::span<const Isa> availableIsas() {
    return std::span(kIsas).first(static_cast<size_t>(bestIsa()) + 1);
}

std::string_view isaName(Isa isa) {
    return kIsaNames[static_cast<size_t>(isa)];
}

std::optional<Isa> isaFromName(std::string_view name) {
    const auto found = std::find(kIsaNames.begin(), kIsaNames.end(), name);
    if (found == kIsaNames.end()) return std::nullopt;
    return static_cast<Isa>(found - kIsaNames.begin());
}

std::string_view isaNames() {
    return kAllNames.substr(2);
}

}  // namespace vernier
