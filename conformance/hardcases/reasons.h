// Why Vernier's answer at `standard` is the one it declares in a case, but not the nearest one everywhere.
#pragma once

#include <span>
#include <string_view>

namespace vernier::conformance::hardcases {

struct DeclaredReason {
    std::string_view what;  // is not nearest
    std::string_view why;   // that is right, and where it is exact
    std::span<const std::string_view> cases;
};

/// Every case that is declared at `standard` has one of them, and no other case: hardcases_test.
std::span<const DeclaredReason> declaredReasons();

/// The reason of a case, or nullptr.
const DeclaredReason* whyDeclared(std::string_view id);

}  // namespace vernier::conformance::hardcases
