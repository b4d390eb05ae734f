#include "conformance/hardcases/hard_case.h"

#include "conformance/hardcases/groups.h"

#include <algorithm>

namespace vernier::conformance::hardcases {

std::string_view outcomeName(Outcome outcome) {
    constexpr std::string_view kNames[] = {
#define VERNIER_NAME(name, text) #name,
        VERNIER_OUTCOMES(VERNIER_NAME)
#undef VERNIER_NAME
    };
    return kNames[static_cast<size_t>(outcome)];
}

std::string_view outcomeText(Outcome outcome) {
    constexpr std::string_view kTexts[] = {
#define VERNIER_TEXT(name, text) text,
        VERNIER_OUTCOMES(VERNIER_TEXT)
#undef VERNIER_TEXT
    };
    return kTexts[static_cast<size_t>(outcome)];
}

size_t CaseInput::scene(Result<Scene> scene) {
    if (scene) {
        scenes_.push_back(std::move(scene).value());
    } else {
        if (status_.ok()) status_ = scene.error();
        scenes_.emplace_back();
    }
    return scenes_.size() - 1;
}

std::span<const CaseGroup> caseGroups() {
    static const std::vector<CaseGroup> groups{
#define VERNIER_GROUP_ENTRY(letter, function, title) {letter, title, function()},
        VERNIER_CASE_GROUPS(VERNIER_GROUP_ENTRY)
#undef VERNIER_GROUP_ENTRY
    };
    return groups;
}

const HardCase* findCase(std::string_view id) {
    for (const CaseGroup& group : caseGroups()) {
        const auto found = std::ranges::find(group.cases, id, &HardCase::id);
        if (found != group.cases.end()) return &*found;
    }
    return nullptr;
}

}  // namespace vernier::conformance::hardcases
