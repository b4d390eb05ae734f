// vernier-precision: the errors of every function and math tier against MPFR, beside what Vulkan permits.
#include <algorithm>
#include <chrono>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "api/include/vernier/vernier_glsl.h"
#include "conformance/precision/report.h"

namespace vernier::precision {
namespace {

struct Options {
    MeasureOptions measure;
    std::vector<std::string> names;
    std::string markdown, against, driver;
};

int fail(const std::string& message) {
    std::fprintf(stderr, "vernier-precision: %s\n", message.c_str());
    return 2;
}

/// Empty if there is none.
std::string readFile(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string sampleText(const MeasureOptions& options) {
    const std::string unary = options.stride == 1
                                  ? std::string("all 2^32 floats")
                                  : "one in " + std::to_string(options.stride) + " of the 2^32 floats, evenly spread";
    return unary + " for functions of one operand (all 2^16 codes of halves); " + std::to_string(options.samples) +
           " calls for the others (a quarter each of random bits, near one, moderate numbers and all magnitudes)";
}

/// Holds measurements against the page that states them.
int compare(const StatedErrors& stated, const std::vector<Measurement>& measurements) {
    int failures = 0;
    for (const Measurement& m : measurements) {
        for (size_t tier = 0; tier < kTiers.size(); ++tier) {
            const auto found = stated.find({m.function->name, kTierNames[tier]});
            if (found == stated.end()) {
                std::printf("%s, %s: not on the page\n", m.function->name.c_str(), kTierNames[tier]);
                ++failures;
            } else if (m.tiers[tier].ulp.value > found->second * (1 + 1e-9)) {
                std::printf("%s, %s: %.6g ULP, the page states %.6g\n", m.function->name.c_str(), kTierNames[tier],
                            m.tiers[tier].ulp.value, found->second);
                ++failures;
            }
        }
    }
    return failures;
}

int run(const Options& options) {
    MeasureOptions measure = options.measure;
    measure.isa = bestIsa();
    VulkanRunner driver;
    if (!options.driver.empty()) {
        // Before the loader is first called.
        setenv("VK_ICD_FILENAMES", options.driver.c_str(), 1);
        setenv("VK_DRIVER_FILES", options.driver.c_str(), 1);
        if (const Status status = driver.create(); !status.ok())
            return fail(options.driver + ": " + status.error().message);
        measure.driver = &driver;
    }
    // The compiler's tables stay between the functions.
    vnRetainGlslCompiler();
    const std::unique_ptr<void, void (*)(void*)> release(&measure, [](void*) { vnReleaseGlslCompiler(); });
    std::vector<Measurement> measurements;
    const std::string earlier = readFile(options.markdown);
    int failures = 0;
    for (const Function& function : functions()) {
        if (!options.names.empty() && std::ranges::find(options.names, function.name) == options.names.end()) continue;
        const auto start = std::chrono::steady_clock::now();
        auto measurement = precision::measure(function, measure);
        if (!measurement) return fail(measurement.error().message);
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        std::printf("%-16s", function.name.c_str());
        for (const Figures& figures : measurement->tiers) {
            std::printf(" %11.5g (%7.2g)", figures.ulp.value, figures.limit.value);
        }
        if (measurement->driver) {
            std::printf(" %11.5g (%7.2g)", measurement->driver->ulp.value, measurement->driver->limit.value);
        }
        std::printf("  %11llu calls %6.1f s\n", static_cast<unsigned long long>(measurement->tiers[0].calls),
                    time.count());
        std::fflush(stdout);
        for (const std::string& violation : violations(*measurement)) {
            std::printf("OUTSIDE: %s\n", violation.c_str());
            ++failures;
        }
        measurements.push_back(std::move(*measurement));
        if (options.markdown.empty()) continue;
        // After every function, for all of them may take hours.
        const ReportText text{sampleText(measure), options.driver.empty() ? "" : driver.name()};
        std::ofstream file(options.markdown);
        file << writeReport(measurements, text, earlier);
        if (!file.flush()) return fail("cannot write " + options.markdown);
    }
    if (measurements.empty()) return fail("no function of that name");
    if (!options.against.empty()) {
        const std::string page = readFile(options.against);
        if (page.empty()) return fail("cannot read " + options.against);
        failures += compare(readReport(page), measurements);
    }
    return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace vernier::precision

int main(int argc, char** argv) {
    using namespace vernier::precision;
    Options options;
    CLI::App app("Measures the errors of every function and math tier; exit code 1 when one is outside its bound");
    app.add_option("--stride", options.measure.stride,
                   "Functions of one operand: every stride-th float; 1 = all 2^32 (minutes per function)")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--samples", options.measure.samples, "Calls of the other functions")->capture_default_str();
    app.add_option("--threads", options.measure.threads, "Threads")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("--driver", options.driver, "Manifest of a Vulkan driver to measure beside");
    app.add_option("--markdown", options.markdown, "Write the results into this page; other functions keep their rows");
    app.add_option("--against", options.against, "Fail where an error is greater than this page states");
    app.add_option("functions", options.names, "Only these");
    CLI11_PARSE(app, argc, argv);
    return run(options);
}
