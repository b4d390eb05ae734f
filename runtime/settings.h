// Settings written as text: "name=value name=value", with spaces or commas between.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.h"

namespace vernier {

/// Calls set(name, value) for each; stops at the first error.
template <class Set>
Status forEachSetting(std::string_view text, const char* form, const Set& set) {
    constexpr std::string_view kSeparators = " ,";
    while (true) {
        const size_t start = text.find_first_not_of(kSeparators);
        if (start == std::string_view::npos) return {};
        text.remove_prefix(start);
        const std::string_view setting = text.substr(0, text.find_first_of(kSeparators));
        const size_t equals = setting.find('=');
        if (equals == std::string_view::npos)
            return invalidArgument("\"" + std::string(setting) + "\" is not of the form " + form);
        if (Status status = set(setting.substr(0, equals), setting.substr(equals + 1)); !status) return status;
        text.remove_prefix(setting.size());
    }
}

/// "a, b, c", for messages.
inline std::string listOf(std::span<const char* const> names) {
    std::string text;
    for (const char* const name : names) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
}

}  // namespace vernier
