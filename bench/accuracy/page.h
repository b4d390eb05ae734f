// One self-contained HTML page of what accuracy costs.
#pragma once

#include <string>

#include "base/result.h"
#include "bench/accuracy/measure.h"

namespace vernier::bench {

Result<std::string> accuracyPage(const AccuracyRun& run);

}  // namespace vernier::bench
