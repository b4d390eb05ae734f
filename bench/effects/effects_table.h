// The table of effects: what each costs when it is not there, in the state without need, and needed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "conformance/tool/driver_choice.h"

namespace vernier::bench {

struct EffectsOptions {
    std::vector<std::string> names;  // empty: all
    std::filesystem::path out = "out/effects";
    std::string json;
    std::string page;      // Markdown
    std::string chart;     // SVG
    bool counted = false;  // this is the process under Valgrind
};

/// Exit status of a run that could not count, for want of Valgrind.
inline constexpr int kCannotCount = 77;

/// Times the effects in this process and counts their instructions in a second one, under Callgrind, with one thread
/// and AVX2, which Valgrind knows. Prints the table. Returns 0; 1 when an effect costs something unused or changes a
/// picture that it must not change; kCannotCount; 2 for other failures.
int runEffects(const conformance::DriverPaths& paths, const EffectsOptions& options);

}  // namespace vernier::bench
