// The table of effects as a page for docs/, and as a chart.
#pragma once

#include <span>
#include <string>

#include "bench/effects/effect_row.h"

namespace vernier::bench {

/// In Markdown. `noise`: by what fraction the time of one scene differed between rounds, in the middle.
std::string effectsPage(std::span<const EffectRow> rows, const std::string& machine, double noise);

/// In SVG: a bar for each effect that can be needed, of its instructions against those without it.
std::string effectsChart(std::span<const EffectRow> rows);

}  // namespace vernier::bench
