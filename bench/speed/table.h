// The table that vernier-bench prints: a row per scene or kernel, ratios against one driver.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vernier::bench {

double median(std::vector<double> values);

/// What one driver took, a value per round; times in milliseconds.
struct Measured {
    std::vector<double> frame;       // a steady run
    std::vector<double> startUp;     // creating pipelines and the first run, less a steady run
    std::vector<double> modules;     // creating the shader modules
    std::vector<double> firstImage;  // from before the driver was looked for until pixels were in host memory
    std::vector<double> peakMemory;  // bytes resident at most in the process
    uint64_t libraries = 0;          // bytes of the libraries the driver came with
    std::string driver, failure;
};

class Table {
  public:
    Table(std::vector<std::string> drivers, std::string reference)
        : drivers_(std::move(drivers)), reference_(std::move(reference)) {}

    void printHeader(const std::string& what) const;
    void printRow(const std::string& name, const std::map<std::string, Measured>& row);
    /// Keeps what the drivers said of themselves, for printDrivers(); printRow() does so too.
    void note(const std::map<std::string, Measured>& row);
    /// What each driver is, and how large.
    void printDrivers() const;
    /// Geometric means and medians of the ratios over all rows.
    void printSummary() const;

  private:
    struct Ratios {
        std::vector<double> frame, startUp, withModules;
    };

    std::vector<std::string> drivers_;
    std::string reference_;
    std::map<std::string, Ratios> ratios_;
    std::map<std::string, Measured> noted_;  // name and libraries only
};

}  // namespace vernier::bench
