#include "runtime/plan/program_facts.h"

#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/rates.h"

namespace vernier {

std::vector<RateShare> rateShares(const BatchProgram& program) {
    std::vector<RateShare> shares;
    const auto counts = ir::countByRate(program.source()), costs = ir::costByRate(program.source());
    for (size_t rate = 0; rate < ir::kRateCount; ++rate)
        if (counts[rate] != 0)
            shares.push_back({std::string(ir::rateName(static_cast<ir::Rate>(rate))), counts[rate], costs[rate]});
    return shares;
}

std::optional<Fact> rateFact(const std::string& stage, const BatchProgram& program) {
    Fact fact;
    fact.rates = rateShares(program);
    if (fact.rates.empty()) return std::nullopt;
    std::string text;
    for (const RateShare& share : fact.rates)
        text += (text.empty() ? "" : ", ") + share.rate + " " + std::to_string(share.operations) + " (cost " +
                std::to_string(share.cost) + ")";
    fact.instructions = program.statistics().instructions;
    fact.lanes = program.statistics().lanes;
    fact.what = "operations of the " + stage + " by rate, " + text;
    fact.why = "a rate is how often values can change, costs are in additions; " + std::to_string(fact.instructions) +
               (fact.instructions == 1 ? " instruction per " : " instructions per ") + std::to_string(fact.lanes) +
               " lanes";
    return fact;
}

std::string irText(const BatchProgram& program) {
    return ir::print(program.source());
}

}  // namespace vernier
