// Small programs for the tests of passes: a common head, and what is left after a pass.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/parse.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"

namespace vernier::ir {

inline constexpr const char* kHead = R"(program fragment "t"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
resource 0 storageBuffer 0.0 x1
resource 1 uniformBuffer 0.1 x1 read
)";

inline Program program(const std::string& body) {
    Result<Program> parsed = parse(kHead + body);
    EXPECT_TRUE(parsed.ok()) << (parsed.ok() ? "" : parsed.error().message);
    const Status status = verify(*parsed);
    EXPECT_TRUE(status.ok()) << status.error().message;
    return *parsed;
}

/// The blocks of a program after a pass, values renumbered.
inline std::string blocksOf(Program& p) {
    compact(p);
    const std::string text = print(p);
    return text.substr(text.find("\nb0:") + 1);
}

/// Two passes in one, both run.
inline auto both(bool (*first)(Program&), bool (*second)(Program&)) {
    return [=](Program& p) {
        const bool changed = first(p);
        return second(p) || changed;
    };
}

template <class Pass>
std::string after(const Pass& pass, const std::string& body) {
    Program p = program(body);
    EXPECT_TRUE(pass(p));
    const std::string text = blocksOf(p);
    EXPECT_FALSE(pass(p)) << "a second run changes something again";
    return text;
}

}  // namespace vernier::ir
