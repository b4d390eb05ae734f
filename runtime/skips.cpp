#include "runtime/skips.h"

#include <algorithm>
#include <array>
#include <string>

#include "runtime/settings.h"

namespace vernier {
namespace {

constexpr SkipRule kRules[] = {
    {"unread_outputs", "vertex outputs that no fragment program reads, colours that no attachment keeps"},
    {"per_vertex_work", "doing per pixel what flat inputs alone decide"},
    {"shared_samples", "doing per sample what all samples of a pixel share"},
    {"idle_state", "tests, blending and logic operations that change nothing"},
    {"unkept_fragments", "fragment programs whose results nobody keeps"},
    {"helper_invocations", "helper invocations of programs that take no derivatives"},
    {"hidden_work", "what later opaque primitives replace, cleared colours included"},
    {"coarse_depth", "depth tests that the bounds of a block's depths decide"},
};
static_assert(std::size(kRules) == static_cast<size_t>(Skip::coarseDepth) + 1);

Status setRule(Skips& skips, std::string_view name, std::string_view value) {
    const auto* const rule =
        std::find_if(std::begin(kRules), std::end(kRules), [&](const SkipRule& each) { return each.name == name; });
    if (rule == std::end(kRules)) {
        std::array<const char*, std::size(kRules)> names;
        std::transform(std::begin(kRules), std::end(kRules), names.begin(), [](const SkipRule& r) { return r.name; });
        return invalidArgument("\"" + std::string(name) +
                               "\" is no rule of what is left out; there are: " + listOf(names));
    }
    if (value != "on" && value != "off")
        return invalidArgument("rule \"" + std::string(name) + "\" is \"" + std::string(value) +
                               "\"; allowed: on, off");
    skips.set(static_cast<Skip>(rule - std::begin(kRules)), value == "on");
    return {};
}

}  // namespace

std::span<const SkipRule> skipRules() {
    return kRules;
}

bool Skips::all() const {
    return *this == Skips{};
}

Result<Skips> skipsFrom(std::string_view text) {
    Skips skips;
    if (text == "on") return skips;
    if (text == "off") {
        for (size_t rule = 0; rule < std::size(kRules); ++rule) skips.set(static_cast<Skip>(rule), false);
        return skips;
    }
    const auto set = [&](std::string_view name, std::string_view value) { return setRule(skips, name, value); };
    if (Status status = forEachSetting(text, "on, off, or rule=off", set); !status) return status.error();
    return skips;
}

}  // namespace vernier
