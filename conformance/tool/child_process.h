// Running this program again as a child, so that a crash or a hang costs one row of the report.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vernier::conformance {

struct ChildResult {
    bool ok = false;          // exited with 0
    std::string failure;      // what it said, or "signal 11 (Segmentation fault)", "no end after 60 s" with its
                              // last output
    uint64_t peakMemory = 0;  // bytes resident at most
};

/// Runs this executable with `arguments` and waits at most `timeoutSeconds`; then it is killed. Its output
/// goes to `log`.
ChildResult runChild(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                     double timeoutSeconds);

}  // namespace vernier::conformance
