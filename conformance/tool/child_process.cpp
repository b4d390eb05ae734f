#include "conformance/tool/child_process.h"

#include "conformance/drivers/stopwatch.h"
#include "conformance/tool/rendering.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

namespace vernier::conformance {
namespace {

/// The last lines a child printed, to go with its failure.
std::string lastWords(const std::filesystem::path& log) {
    constexpr size_t kMost = 600;
    const Result<std::string> text = readFile(log);
    if (!text || text.value().empty()) return {};
    std::string all = text.value();
    while (!all.empty() && all.back() == '\n') all.pop_back();
    return ": " + (all.size() > kMost ? "..." + all.substr(all.size() - kMost) : all);
}

/// What a child of this program says itself on its way out, if that is how it ended.
std::string ownWords(const std::filesystem::path& log) {
    const std::string prefix = ": vernier-conformance: ";
    const std::string words = lastWords(log);
    return words.starts_with(prefix) ? words.substr(prefix.size()) : std::string();
}

}  // namespace

ChildResult runChild(const std::vector<std::string>& arguments, const std::filesystem::path& log,
                     double timeoutSeconds) {
    std::string program = "/proc/self/exe";
    std::vector<std::string> words = arguments;
    words.insert(words.begin(), "vernier-conformance");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t child = -1;
    const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) return {false, std::string("cannot start: ") + std::strerror(error)};

    const Stopwatch watch;
    int status = 0;
    rusage usage{};
    while (true) {
        const pid_t ended = wait4(child, &status, WNOHANG, &usage);
        if (ended == child) break;
        if (ended < 0 || watch.milliseconds() > timeoutSeconds * 1000) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            return {false, "no end after " + std::to_string(static_cast<int>(timeoutSeconds)) + " s" + lastWords(log)};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {true, {}, static_cast<uint64_t>(usage.ru_maxrss) * 1024};
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        return {false, "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")" + lastWords(log)};
    }
    if (const std::string said = ownWords(log); !said.empty()) return {false, said};
    return {false, "exit code " + std::to_string(WEXITSTATUS(status)) + lastWords(log)};
}

}  // namespace vernier::conformance
