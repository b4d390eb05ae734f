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

std::string irText(const BatchProgram& program) {
    return ir::print(program.source());
}

}  // namespace vernier
