#include "bench/speed/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vernier::bench {
namespace {

double geometricMean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += std::log(value);
    return std::exp(sum / static_cast<double>(values.size()));
}

/// The first run may by chance be no slower than a steady one: a ratio needs something above zero.
double atLeastOneMicrosecond(double milliseconds) {
    return std::max(milliseconds, 0.001);
}

}  // namespace

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void Table::printHeader(const std::string& what) const {
    std::printf("%-22s", what.c_str());
    for (const std::string& driver : drivers_)
        std::printf(" %12s %9s %9s %7s", driver.c_str(), "start-up", "modules", "peak");
    for (const std::string& driver : drivers_)
        if (driver != reference_)
            std::printf(" %11s %9s", (driver + "/" + reference_.substr(0, 3)).c_str(), "start-up");
    std::printf("\n%-16s", "");
    for (size_t i = 0; i < drivers_.size(); ++i) std::printf(" %12s %9s %9s %7s", "ms/run", "ms", "ms", "MB");
    std::printf("\n");
}

void Table::printRow(const std::string& name, const std::map<std::string, Measured>& row) {
    std::printf("%-22s", name.c_str());
    for (const std::string& driver : drivers_) {
        const Measured& m = row.at(driver);
        if (m.frame.empty())
            std::printf(" %12s %9s %9s %7s", "failed", "-", "-", "-");
        else
            std::printf(" %12.3f %9.2f %9.2f %7.0f", median(m.frame), median(m.startUp), median(m.modules),
                        median(m.peakMemory) / 1e6);
    }
    note(row);
    const Measured& base = row.at(reference_);
    for (const std::string& driver : drivers_) {
        const Measured& m = row.at(driver);
        if (driver == reference_) continue;
        if (m.frame.empty() || base.frame.empty()) {
            std::printf(" %11s %9s", "-", "-");
            continue;
        }
        const double baseStart = atLeastOneMicrosecond(median(base.startUp));
        const double start = atLeastOneMicrosecond(median(m.startUp));
        Ratios& ratios = ratios_[driver];
        ratios.frame.push_back(median(m.frame) / median(base.frame));
        ratios.startUp.push_back(start / baseStart);
        ratios.withModules.push_back((start + median(m.modules)) / (baseStart + median(base.modules)));
        std::printf(" %11.2f %9.3f", ratios.frame.back(), ratios.startUp.back());
    }
    std::printf("\n");
    std::fflush(stdout);
}

void Table::note(const std::map<std::string, Measured>& row) {
    for (const auto& [driver, measured] : row)
        if (!measured.driver.empty()) noted_[driver] = {{}, {}, {}, {}, {}, measured.libraries, measured.driver, {}};
}

void Table::printDrivers() const {
    for (const auto& [driver, measured] : noted_)
        std::printf("%s: %s; its libraries: %.1f MB\n", driver.c_str(), measured.driver.c_str(),
                    static_cast<double>(measured.libraries) / 1e6);
}

void Table::printSummary() const {
    printDrivers();
    for (const auto& [driver, ratios] : ratios_) {
        std::printf("%s against %s over %zu rows: run time x %.2f (geometric mean), x %.2f (median)\n", driver.c_str(),
                    reference_.c_str(), ratios.frame.size(), geometricMean(ratios.frame), median(ratios.frame));
        std::printf("    start-up x %.4f (median), with module creation x %.4f (median)\n", median(ratios.startUp),
                    median(ratios.withModules));
    }
}

}  // namespace vernier::bench
