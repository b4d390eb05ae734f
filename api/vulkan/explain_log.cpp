#include "api/vulkan/explain_log.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vernier::vulkan {

ExplainLog::~ExplainLog() {
    if (file_ != nullptr && file_ != stderr) std::fclose(file_);
}

Status ExplainLog::open(const std::string& target) {
    if (target.empty()) return {};
    json_ = target.ends_with(".json");
    file_ = target == "stderr" ? stderr : std::fopen(target.c_str(), "ae");
    if (file_ == nullptr)
        return invalidArgument("VERNIER_EXPLAIN: cannot write " + target + ": " + std::strerror(errno));
    return {};
}

void ExplainLog::pipeline(const char* kind, std::span<const Fact> facts) {
    if (!enabled()) return;
    const std::lock_guard lock(mutex_);
    const std::string number = std::to_string(++pipelines_);
    write("pipeline " + number + ", " + kind, "\"pipeline\": " + number + ", \"kind\": \"" + kind + "\"", facts);
}

void ExplainLog::submission(std::span<const Fact> facts) {
    if (!enabled()) return;
    const std::lock_guard lock(mutex_);
    const std::string number = std::to_string(++submissions_);
    write("submission " + number, "\"submission\": " + number, facts);
}

void ExplainLog::write(const std::string& title, const std::string& json, std::span<const Fact> facts) {
    std::string text;
    if (json_) {
        text = factsJson(facts);
        std::replace(text.begin(), text.end(), '\n', ' ');
        text = "{" + json + ", \"facts\": " + text + "}\n";
    } else {
        text = title + "\n" + factsText(facts) + "\n";
    }
    std::fputs(text.c_str(), file_);
    std::fflush(file_);
}

}  // namespace vernier::vulkan
