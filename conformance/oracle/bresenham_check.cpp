#include "conformance/oracle/bresenham_check.h"

#include <algorithm>
#include <cstdlib>
#include <map>

namespace vernier::conformance::exact {
namespace {

std::string text(const PixelIndex& p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}

}  // namespace

std::string checkBresenham(std::span<const PixelIndex> exactly, std::span<const PixelIndex> observed, bool xMajor,
                           size_t segments) {
    const std::string column = xMajor ? "column" : "row";
    std::map<int64_t, PixelIndex> seen;
    for (const PixelIndex& p : observed) {
        const bool near = std::ranges::any_of(
            exactly, [&p](const PixelIndex& e) { return std::abs(e.x - p.x) <= 1 && std::abs(e.y - p.y) <= 1; });
        if (!near) return "condition 1: fragment " + text(p) + " is more than one pixel from those of the rule";
        const auto [known, fresh] = seen.emplace(xMajor ? p.x : p.y, p);
        if (!fresh) {
            return "condition 3: fragments " + text(known->second) + " and " + text(p) + " in one " + column;
        }
    }
    const size_t apart = std::max(observed.size(), exactly.size()) - std::min(observed.size(), exactly.size());
    if (apart > segments) {
        return "condition 2: " + std::to_string(observed.size()) + " fragments, the rule has " +
               std::to_string(exactly.size());
    }
    if (segments < 2 || seen.empty()) return {};
    for (int64_t at = seen.begin()->first; at < seen.rbegin()->first; ++at) {
        if (!seen.contains(at)) return "condition 4: " + column + " " + std::to_string(at) + " is left out";
    }
    return {};
}

}  // namespace vernier::conformance::exact
