#include "samples/viewer/exporter.h"

#include <cstdio>
#include <filesystem>

#include "samples/common/trigonometry.h"

namespace samples {
namespace {

std::string numbered(const std::string& folder, const char* pattern, int number) {
    char name[64];
    std::snprintf(name, sizeof name, pattern, number);
    return ((folder.empty() ? std::filesystem::path(".") : std::filesystem::path(folder)) / name).string();
}

}  // namespace

Exported exportScreenshot(App& app, const std::string& folder, const std::function<void()>& draw) {
    int number = 1;
    std::error_code ignored;
    while (std::filesystem::exists(numbered(folder, "viewer-%04d.png", number), ignored) && number < 9999) ++number;
    const std::string path = numbered(folder, "viewer-%04d.png", number);
    draw();
    const bool written = app.save(path);
    return {written, path + (written ? " written" : " could not be written")};
}

Exported exportTurntable(App& app, const std::string& folder, int count, const std::function<void(double)>& draw) {
    for (int i = 0; i < count; ++i) {
        draw(2 * kPi * i / count);
        const std::string path = numbered(folder, "turntable-%04d.png", i);
        if (!app.save(path)) return {false, path + " could not be written"};
    }
    return {true, std::to_string(count) + " pictures written to " + (folder.empty() ? "the working folder" : folder)};
}

}  // namespace samples
