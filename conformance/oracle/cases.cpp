#include "conformance/oracle/cases.h"

#include "conformance/oracle/case_list.h"

#include <algorithm>
#include <array>

namespace vernier::conformance {

namespace {

constexpr auto kCases = std::to_array<NumericCase>({
#define VERNIER_CASE_ENTRY(name, description) {#name, description, &cases::build##name, &cases::check##name},
    VERNIER_NUMERIC_CASES(VERNIER_CASE_ENTRY)
#undef VERNIER_CASE_ENTRY
});

}  // namespace

std::span<const NumericCase> numericCases() {
    return kCases;
}

const NumericCase* findNumericCase(std::string_view name) {
    const auto found = std::ranges::find(kCases, name, &NumericCase::name);
    return found == kCases.end() ? nullptr : &*found;
}

}  // namespace vernier::conformance
