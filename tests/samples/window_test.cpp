// The samples in windows of an X server: what a window shows is the picture that the same program writes without one,
// keys do what they are for, and a window can be resized. Needs a server: DISPLAY.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "samples/common/picture_file.h"
#include "tests/samples/x_screen.h"

extern char** environ;

namespace samples::test {
namespace {

using Clock = std::chrono::steady_clock;
using Words = std::vector<std::string>;

/// A program that runs beside the test, and no longer.
class Program {
  public:
    explicit Program(const Words& words) {
        std::vector<char*> arguments;
        for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        EXPECT_EQ(posix_spawn(&id_, arguments[0], nullptr, nullptr, arguments.data(), environ), 0) << words[0];
    }
    ~Program() {
        if (!ended_) {
            kill(id_, SIGKILL);
            end();
        }
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    /// Waits for its end; the status, -1 when it was killed.
    int end() {
        int status = 0;
        waitpid(id_, &status, 0);
        ended_ = true;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

  private:
    pid_t id_ = -1;
    bool ended_ = false;
};

class SampleWindow : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(screen.open()) << "no X server with XTEST at DISPLAY";
        folder = std::filesystem::temp_directory_path() / ("sample_window_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    /// What the program writes without a window.
    ScreenPicture headless(Words words) {
        const std::string path = (folder / "headless.png").string();
        words.insert(words.end(), {"--headless", path});
        EXPECT_EQ(Program(words).end(), 0);
        Picture picture;
        std::string error;
        EXPECT_TRUE(readPicture(path, picture, error)) << error;
        ScreenPicture result{picture.width, picture.height, {}};
        for (const uint32_t texel : picture.texels)
            result.pixels.push_back((texel & 0xFF) << 16 | (texel & 0xFF00) | (texel >> 16 & 0xFF));
        return result;
    }
    static bool same(const ScreenPicture& a, const ScreenPicture& b) {
        return a.width == b.width && a.height == b.height && a.pixels == b.pixels;
    }
    /// Looks at the window until it is as wanted, at most half a minute.
    bool becomes(XScreen::WindowId window, const std::function<bool(const ScreenPicture&)>& wanted) {
        for (const auto end = Clock::now() + std::chrono::seconds(30); Clock::now() < end;) {
            seen = screen.look(window);
            if (!seen.pixels.empty() && wanted(seen)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        save(seen);
        return false;
    }
    bool shows(XScreen::WindowId window, const ScreenPicture& picture) {
        return becomes(window, [&](const ScreenPicture& now) { return same(now, picture); });
    }
    bool changesFrom(XScreen::WindowId window, ScreenPicture picture) {
        return becomes(window, [&](const ScreenPicture& now) { return !same(now, picture); });
    }
    /// A picture that was not as wanted stays, to be looked at.
    static void save(const ScreenPicture& seen) {
        Picture picture{seen.width, seen.height, {}};
        for (const uint32_t pixel : seen.pixels)
            picture.texels.push_back(0xFF000000 | (pixel & 0xFF) << 16 | (pixel & 0xFF00) | pixel >> 16);
        if (!picture.texels.empty()) savePicture("window_test_seen.png", picture);
    }

    XScreen screen;
    std::filesystem::path folder;
    ScreenPicture seen;
};

TEST_F(SampleWindow, Gears) {
    const Words words{GEARS, "--still", "--size", "320x240"};
    Program program(words);
    const XScreen::WindowId window = screen.find("Gears");
    ASSERT_NE(window, 0u);
    const ScreenPicture still = headless(words);
    EXPECT_TRUE(shows(window, still));
    screen.resize(window, 433, 311);
    EXPECT_TRUE(shows(window, headless({GEARS, "--size", "433x311"})));
    screen.resize(window, 320, 240);
    EXPECT_TRUE(shows(window, still));
    screen.press(window, "Left");
    EXPECT_TRUE(changesFrom(window, still)) << "arrows turn the gears";
    screen.press(window, "Escape");
    EXPECT_EQ(program.end(), 0);
}

TEST_F(SampleWindow, GearsTurn) {
    const Program program({GEARS, "--size", "320x240"});
    const XScreen::WindowId window = screen.find("Gears");
    ASSERT_NE(window, 0u);
    ASSERT_TRUE(becomes(window, [](const ScreenPicture& now) { return now.pixels[0] == 0; }));
    EXPECT_TRUE(changesFrom(window, seen));
}

TEST_F(SampleWindow, Walker) {
    const Words words{WALKER, "--size", "320x200"};
    Program program(words);
    const XScreen::WindowId window = screen.find("Walker");
    ASSERT_NE(window, 0u);
    const ScreenPicture columns = headless(words);
    EXPECT_TRUE(shows(window, columns)) << "who presses nothing stays where he is";
    screen.press(window, "t");
    EXPECT_TRUE(shows(window, headless({WALKER, "--size", "320x200", "--version", "triangles"})));
    screen.resize(window, 401, 300);
    EXPECT_TRUE(shows(window, headless({WALKER, "--size", "401x300", "--version", "triangles"})));
    screen.hold(window, "w", true);
    EXPECT_TRUE(changesFrom(window, seen)) << "W walks";
    screen.hold(window, "w", false);
    screen.press(window, "Escape");
    EXPECT_EQ(program.end(), 0);
}

TEST_F(SampleWindow, Viewer) {
    Program program({VIEWER, "--size", "480x360", "--hide", "--out", folder.string()});
    const XScreen::WindowId window = screen.find("Vernier viewer");
    ASSERT_NE(window, 0u);
    const auto with = [&](const Words& more) {
        Words words{VIEWER, "--size", "480x360"};
        words.insert(words.end(), more.begin(), more.end());
        return headless(words);
    };
    const ScreenPicture shaded = with({});
    EXPECT_TRUE(shows(window, shaded));
    // The dial: from standard on, fine, reference, draft; then axes of their own.
    for (int i = 0; i < 3; ++i) screen.press(window, "p");
    EXPECT_TRUE(shows(window, with({"--profile", "draft"})));
    screen.press(window, "v");
    EXPECT_TRUE(shows(window, with({"--profile", "draft", "--view", "split"})));
    screen.drag(window, 240, 180, 120, 190);
    EXPECT_TRUE(shows(window, with({"--profile", "draft", "--view", "split", "--divide", "0.25"})));
    screen.press(window, "v");
    EXPECT_TRUE(shows(window, with({"--profile", "draft", "--view", "error"})));
    screen.press(window, "g");
    screen.press(window, "1");
    EXPECT_TRUE(shows(window, with({"--profile", "draft", "--view", "error", "--error", "signed", "--subpixel", "4"})));
    screen.resize(window, 600, 440);
    EXPECT_TRUE(shows(window, headless({VIEWER, "--size", "600x440", "--profile", "draft", "--view", "error", "--error",
                                        "signed", "--subpixel", "4"})));
    screen.press(window, "F12");
    EXPECT_TRUE(becomes(window, [&](const ScreenPicture&) { return exists(folder / "viewer-0001.png"); }));
    screen.press(window, "h");
    EXPECT_TRUE(changesFrom(window, seen)) << "the panel";
    const ScreenPicture panel = seen;
    screen.press(window, "F1");
    EXPECT_TRUE(changesFrom(window, panel)) << "the keys";
    screen.press(window, "Escape");
    EXPECT_EQ(program.end(), 0);
}

TEST_F(SampleWindow, ViewerTakesFiles) {
    const std::string model = (folder / "model.obj").string();
    std::ofstream(model) << "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 1\nf 1 2 3\nf 1 3 4\n";
    const std::string wrong = (folder / "wrong.obj").string();
    std::ofstream(wrong) << "v 0 0 0\nf 1 2 3\n";
    Program program({VIEWER, "--size", "480x360", "--hide"});
    const XScreen::WindowId window = screen.find("Vernier viewer");
    ASSERT_NE(window, 0u);
    ASSERT_TRUE(shows(window, headless({VIEWER, "--size", "480x360"})));
    ASSERT_TRUE(screen.drop(window, model));
    const ScreenPicture dropped = headless({VIEWER, model, "--size", "480x360"});
    EXPECT_TRUE(shows(window, dropped));
    ASSERT_TRUE(screen.drop(window, wrong));
    screen.press(window, "v");
    EXPECT_TRUE(shows(window, headless({VIEWER, model, "--size", "480x360", "--view", "split"})))
        << "a wrong file changes nothing";
    screen.press(window, "Escape");
    EXPECT_EQ(program.end(), 0);
}

}  // namespace
}  // namespace samples::test
