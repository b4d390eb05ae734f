// What a sample is told on its command line and by keys: one list of options serves both.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace samples {

/// One thing that can be chosen. A bool is a flag, an int with `choices` is one of them by name, other targets take a
/// value. `key` toggles a bool and steps through choices while a window is open.
struct Option {
    std::string name;  // "--wireframe"; without dashes: an argument by position
    std::string help;
    std::variant<bool*, int*, double*, std::string*> target;
    char key = 0;  // lower case; 0: none
    std::vector<std::string> choices{};
};

struct AppOptions {
    std::string title;
    uint32_t width = 800, height = 600;
    std::string headless;  // path of a PNG, BMP or TGA; empty: a window
    double time = 0;       // seconds at which the headless picture is taken, and at which a window starts
    bool still = false;    // time stands still at that
    uint32_t frames = 0;   // not 0: that many pictures, 25 a second from `time` on, without a window
    std::string out;       // folder for those; empty: they are only timed
    uint32_t threads = 0;  // 0: one per CPU
    std::string isa;       // "sse4", "avx2", "avx512"; empty: the best there is
    std::vector<Option> options;

    bool window() const { return headless.empty() && frames == 0; }
};

/// Reads --headless OUT.png, --size WxH, --time SECONDS, --still, --frames N, --out DIR,
/// --threads N, --isa NAME and the options of the sample; prints help and exits when asked to or when something is
/// wrong.
AppOptions parseOptions(int argc, char** argv, const std::string& title, const std::vector<Option>& options = {});

/// Toggles or steps what `key` stands for. Returns what it is now ("shading: phong"), "" if no option has the key.
std::string pressKey(const std::vector<Option>& options, int key);

/// A line for each option with a key.
std::string keyHelp(const std::vector<Option>& options);

}  // namespace samples
