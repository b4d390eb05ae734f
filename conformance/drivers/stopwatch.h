// Wall time for the drivers' timings.
#pragma once

#include "base/result.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace vernier::conformance {

class Stopwatch {
  public:
    double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct FrameTimes {
    double median = 0;
    uint32_t count = 0;
};

/// Times `frame`, a function returning Status: at least 5 times, at most 60, and in between until 0.3 s have
/// passed.
template <class Frame>
Result<FrameTimes> measureFrames(Frame frame) {
    constexpr size_t kFewest = 5, kMost = 60;
    constexpr double kEnough = 300;
    std::vector<double> times;
    const Stopwatch all;
    while (times.size() < kFewest || (times.size() < kMost && all.milliseconds() < kEnough)) {
        const Stopwatch one;
        if (Status status = frame(); !status) return status.error();
        times.push_back(one.milliseconds());
    }
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return FrameTimes{*middle, static_cast<uint32_t>(times.size())};
}

}  // namespace vernier::conformance
