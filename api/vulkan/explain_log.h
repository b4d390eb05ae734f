// VERNIER_EXPLAIN: every pipeline that is created is explained, and every submission that has run, on stderr or in a
// file.
#pragma once

#include <cstdint>
#include <cstdio>
#include <mutex>
#include <span>
#include <string>

#include "base/result.h"
#include "runtime/plan/fact.h"

namespace vernier::vulkan {

/// Thread-safe but for open().
class ExplainLog {
  public:
    ExplainLog() = default;
    ~ExplainLog();
    ExplainLog(const ExplainLog&) = delete;
    ExplainLog& operator=(const ExplainLog&) = delete;

    /// "": nothing is written. "stderr": text goes there. Otherwise the name of a file, which is appended to: text, or,
    /// where the name ends in ".json", an object a line. The error names a file that cannot be written.
    Status open(const std::string& target);

    bool enabled() const { return file_ != nullptr; }
    /// `kind`: "graphics" or "compute".
    void pipeline(const char* kind, std::span<const Fact> facts);
    /// What a submission ran and left out, by what it counted.
    void submission(std::span<const Fact> facts);

  private:
    /// `json`: the members of the object before its facts.
    void write(const std::string& title, const std::string& json, std::span<const Fact> facts);

    std::mutex mutex_;
    std::FILE* file_ = nullptr;
    bool json_ = false;
    uint64_t pipelines_ = 0, submissions_ = 0;
};

}  // namespace vernier::vulkan
