// docs/precision.md: written from measurements, and read back to hold new measurements against it.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conformance/precision/measure.h"

namespace vernier::precision {

struct ReportText {
    std::string sample;  // how the operands were chosen
    std::string driver;  // name of the driver measured beside; empty: none
};

/// Functions that were not measured keep their rows of the `earlier` page.
std::string writeReport(std::span<const Measurement> measurements, const ReportText& text, const std::string& earlier);

/// The greatest errors in ULP that a report states, by function and tier.
using StatedErrors = std::map<std::pair<std::string, std::string>, double>;
StatedErrors readReport(const std::string& markdown);

/// What is wrong with a measurement, one line each: promises and Vulkan's limits that are not kept.
std::vector<std::string> violations(const Measurement& measurement);

}  // namespace vernier::precision
