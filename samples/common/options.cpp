#include "samples/common/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace samples {
namespace {

void add(CLI::App& cli, const Option& option) {
    if (const auto flag = std::get_if<bool*>(&option.target)) {
        cli.add_flag(option.name + ",!--no-" + option.name.substr(2), **flag, option.help);
    } else if (const auto number = std::get_if<int*>(&option.target)) {
        CLI::Option* added = cli.add_option(option.name, **number, option.help);
        if (option.choices.empty()) return;
        std::vector<std::pair<std::string, int>> names;
        for (const std::string& choice : option.choices) names.emplace_back(choice, static_cast<int>(names.size()));
        added->transform(CLI::CheckedTransformer(names));
    } else if (const auto real = std::get_if<double*>(&option.target)) {
        cli.add_option(option.name, **real, option.help);
    } else {
        cli.add_option(option.name, *std::get<std::string*>(option.target), option.help);
    }
}

std::string bareName(const Option& option) {
    return option.name.substr(option.name.find_first_not_of('-'));
}

}  // namespace

AppOptions parseOptions(int argc, char** argv, const std::string& title, const std::vector<Option>& options) {
    AppOptions result;
    result.title = title;
    result.options = options;
    CLI::App cli{title};
    std::string size;
    cli.add_option("--headless", result.headless, "write one picture (.png, .bmp, .tga) instead of opening a window");
    cli.add_option("--size", size, "WIDTHxHEIGHT in pixels (800x600)");
    cli.add_option("--time", result.time, "seconds at which the picture is taken (0)");
    cli.add_flag("--still", result.still, "time stands still");
    cli.add_option("--frames", result.frames, "draw this many frames, 25 a second, and print the time that one takes");
    cli.add_option("--out", result.out, "folder that gets the frames as 0000.png, 0001.png, ...");
    cli.add_option("--threads", result.threads, "threads that draw (0: one per CPU)");
    cli.add_option("--isa", result.isa, "instruction set, at most: sse4, avx2, avx512 (the best there is)");
    for (const Option& option : options) add(cli, option);
    try {
        cli.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(cli.exit(error));
    }
    char rest = 0;
    if (!size.empty() && (std::sscanf(size.c_str(), "%ux%u%c", &result.width, &result.height, &rest) != 2 ||
                          result.width == 0 || result.height == 0 || result.width > 8192 || result.height > 8192)) {
        std::fprintf(stderr, "--size is \"%s\", but must be WIDTHxHEIGHT, each 1 to 8192\n", size.c_str());
        std::exit(1);
    }
    return result;
}

std::string pressKey(const std::vector<Option>& options, int key) {
    for (const Option& option : options) {
        if (option.key == 0 || option.key != key) continue;
        if (const auto flag = std::get_if<bool*>(&option.target)) {
            **flag = !**flag;
            return bareName(option) + (**flag ? ": on" : ": off");
        }
        if (const auto number = std::get_if<int*>(&option.target); number && !option.choices.empty()) {
            **number = (**number + 1) % static_cast<int>(option.choices.size());
            return bareName(option) + ": " + option.choices[static_cast<size_t>(**number)];
        }
    }
    return {};
}

std::string keyHelp(const std::vector<Option>& options) {
    std::string text;
    for (const Option& option : options)
        if (option.key) text += std::string(1, option.key) + "  " + option.help + "\n";
    return text;
}

}  // namespace samples
