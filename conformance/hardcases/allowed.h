// Why Vernier's answer at `standard` is permitted in a case, but not the declared or nearest one everywhere.
#pragma once

#include <span>
#include <string_view>

namespace vernier::conformance::hardcases {

struct AllowedReason {
    std::string_view what;  // is not nearest
    std::string_view why;   // that is right, and where it is exact
    std::span<const std::string_view> cases;
};

/// Every case that is allowed at `standard` has one of them, and no other case: hardcases_test.
std::span<const AllowedReason> allowedReasons();

/// The reason of a case, or nullptr.
const AllowedReason* whyAllowed(std::string_view id);

}  // namespace vernier::conformance::hardcases
