// What is known of a compiled program: how often what of it runs, and its text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/plan/fact.h"
#include "spirv_interp/program.h"

namespace vernier {

/// By rate, from the rarest; rates without operations are left out.
std::vector<RateShare> rateShares(const BatchProgram& program);

/// rateShares() as a fact about a program of `stage`; nothing if it has no operations.
std::optional<Fact> rateFact(const std::string& stage, const BatchProgram& program);

/// The IR that was compiled, in the form that ir/print.h describes.
std::string irText(const BatchProgram& program);

}  // namespace vernier
