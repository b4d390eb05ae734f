// vernier-accuracy as a person runs it: on real scenes, stopped in the middle and begun again, with its budgets.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

std::string contentsOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// The program in a terminal of its own, so that it shows its progress.
class Terminal {
  public:
    explicit Terminal(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), VERNIER_ACCURACY);
        std::vector<char*> argv;
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        child_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
        if (child_ == 0) {
            ::execv(argv[0], argv.data());
            ::_exit(127);
        }
    }
    ~Terminal() {
        if (child_ > 0) kill();
        if (terminal_ >= 0) ::close(terminal_);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    bool started() const { return child_ > 0; }

    /// Reads on until the program has said `text`; false when it ends before that.
    bool waitFor(const std::string& text) {
        while (said_.find(text) == std::string::npos)
            if (!readSome()) return false;
        return true;
    }

    /// The program and what it has started, which share a session; nothing of them gets a chance to tidy up.
    void kill() {
        ::kill(-child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
        child_ = -1;
    }

    /// All that it says until it ends, and how it ended.
    int finish() {
        while (readSome()) {
        }
        int status = 0;
        ::waitpid(child_, &status, 0);
        child_ = -1;
        return status;
    }

    const std::string& said() const { return said_; }

  private:
    bool readSome() {
        char bytes[4096];
        const ssize_t count = ::read(terminal_, bytes, sizeof bytes);
        if (count <= 0) return false;
        said_.append(bytes, static_cast<size_t>(count));
        return true;
    }

    pid_t child_ = -1;
    int terminal_ = -1;
    std::string said_;
};

class AccuracyTool : public ::testing::Test {
  protected:
    AccuracyTool() { fs::remove_all(out_); }
    ~AccuracyTool() override { fs::remove_all(out_); }

    /// Two scenes at three positions, each timed twice.
    std::vector<std::string> arguments(std::vector<std::string> more = {}) const {
        std::vector<std::string> all{"--scene",    "gradient", "--scene",  "specular", "--position", "math=fast",
                                     "--position", "draft",    "--rounds", "2",        "--out",      out_.string()};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    static constexpr size_t kSteps = 2 * 3 * (1 + 2);

    json keptFigures() const { return json::parse(contentsOf(out_ / "kept.json")).at("scenes"); }

    /// When children last wrote each of their files.
    std::map<std::string, fs::file_time_type> writtenAt() const {
        std::map<std::string, fs::file_time_type> times;
        for (const auto& entry : fs::recursive_directory_iterator(out_ / "runs"))
            if (entry.path().extension() == ".json") times[entry.path().string()] = entry.last_write_time();
        return times;
    }

    const fs::path out_ = fs::temp_directory_path() / ("vernier-accuracy-" + std::to_string(::getpid()));
};

TEST_F(AccuracyTool, GoesOnWhereItWasKilledAndDoesNothingTwice) {
    // The steps of the first scene, and the first of the second one.
    const std::string middle = " " + std::to_string(kSteps / 2 + 1) + "/" + std::to_string(kSteps) + " ";
    Terminal first(arguments());
    ASSERT_TRUE(first.started());
    ASSERT_TRUE(first.waitFor(middle)) << first.said();
    first.kill();
    EXPECT_THAT(first.said(), HasSubstr("[##########"));
    EXPECT_THAT(first.said(), HasSubstr("gradient: math=fast"));
    const json before = keptFigures();
    ASSERT_EQ(before.at("gradient").size(), 3u) << before;
    ASSERT_EQ(before.at("specular").size(), 1u) << before;
    const auto written = writtenAt();

    Terminal second(arguments());
    ASSERT_TRUE(second.started());
    EXPECT_EQ(second.finish(), 0) << second.said();
    EXPECT_THAT(second.said(), HasSubstr("[##############################] " + std::to_string(kSteps) + "/" +
                                         std::to_string(kSteps) + " done"));
    const json after = keptFigures();
    EXPECT_EQ(after.at("gradient"), before.at("gradient")) << "what was measured stays, to the last digit of its time";
    EXPECT_EQ(after.at("specular").size(), 3u);
    const auto now = writtenAt();
    size_t kept = 0;
    for (const auto& [file, time] : written) {
        if (file.find("gradient") == std::string::npos) continue;
        EXPECT_EQ(now.at(file), time) << file << " was drawn again";
        ++kept;
    }
    EXPECT_EQ(kept, 9u) << "three positions, each judged, counted and timed";

    // A third run measures nothing: it has the figures of the second one.
    Terminal third(arguments());
    EXPECT_EQ(third.finish(), 0) << third.said();
    EXPECT_EQ(keptFigures(), after);
    EXPECT_EQ(writtenAt(), now);
    // --fresh does it again.
    Terminal again({"--scene", "gradient", "--position", "draft", "--rounds", "1", "--out", out_.string(), "--fresh"});
    EXPECT_EQ(again.finish(), 0) << again.said();
    for (const auto& [file, time] : writtenAt()) {
        const bool isAsked = file.find("gradient") != std::string::npos && file.find("math-fast") == std::string::npos;
        if (isAsked) {
            EXPECT_GT(time, now.at(file)) << file;
        }
    }
}

TEST_F(AccuracyTool, NamesSettingsWithinBudgets) {
    // Nothing takes 10 s; everything here is exact to a code. Draft and fast functions are below what Vulkan asks for.
    Terminal tool(arguments({"--within-ms", "10000", "--within-error", "1.5"}));
    ASSERT_EQ(tool.finish(), 0) << tool.said();
    const json figures = json::parse(contentsOf(out_ / "accuracy.json"));
    for (const char* scene : {"gradient", "specular"}) {
        const json& measured = figures.at("scenes").at(scene);
        std::string fastest;
        for (const char* position : {"draft", "standard", "math=fast"}) {
            const json& one = measured.at(position);
            EXPECT_EQ(one.at("rounds_ms").size(), 2u);
            EXPECT_EQ(one.at("frame_ms"), std::min(one.at("rounds_ms")[0], one.at("rounds_ms")[1]));
            EXPECT_LE(one.at("worst_255").get<double>(), 1.5) << scene << " " << position;
            if (fastest.empty() || one.at("frame_ms") < measured.at(fastest).at("frame_ms")) fastest = position;
        }
        EXPECT_THAT(tool.said(),
                    HasSubstr(std::string(scene) + ": the most exact setting within 10000 ms: standard\r\n"));
        EXPECT_THAT(tool.said(),
                    HasSubstr(std::string(scene) +
                              ": the fastest setting whose worst error is at most 1.5/255: " + fastest + "\r\n"));
    }
    EXPECT_THAT(tool.said(), HasSubstr("| math | fast |"));
    EXPECT_THAT(contentsOf(out_ / "accuracy.html"), HasSubstr("Where each position is needed"));
    EXPECT_THAT(contentsOf(out_ / "accuracy.csv"), HasSubstr("specular,math=fast,api,"));
    EXPECT_THAT(contentsOf(out_ / "specular.svg"), HasSubstr("math=fast"));

    // Bounds that keep nearly everything out.
    Terminal none(arguments({"--within-ms", "0.000001", "--within-error", "0.000001"}));
    ASSERT_EQ(none.finish(), 0) << none.said();
    EXPECT_THAT(none.said(), HasSubstr("specular: the most exact setting within 1e-06 ms: none\r\n"));
    EXPECT_THAT(none.said(),
                HasSubstr("specular: the fastest setting whose worst error is at most 1e-06/255: standard"))
        << "which is exact, and the others are a code off";
}

TEST_F(AccuracyTool, RefusesWhatThereIsNot) {
    Terminal position({"--scene", "gradient", "--position", "subpixel=5", "--out", out_.string()});
    EXPECT_NE(position.finish(), 0);
    EXPECT_THAT(position.said(), HasSubstr("there is no position 'subpixel=5' here"));
    Terminal scene({"--scene", "shoes", "--out", out_.string()});
    EXPECT_NE(scene.finish(), 0);
    EXPECT_THAT(scene.said(), HasSubstr("there is no scene 'shoes'"));
}

}  // namespace
