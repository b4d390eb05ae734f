#include "conformance/tool/rendering.h"

#include <nlohmann/json.hpp>

#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

namespace vernier::conformance {
namespace {

std::filesystem::path rawPath(const std::filesystem::path& directory, const std::string& scene, size_t index) {
    return directory / (scene + "." + std::to_string(index) + ".raw");
}

}  // namespace

Status writeFile(const std::filesystem::path& path, const void* data, size_t size) {
    std::ofstream file(path, std::ios::binary);
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    file.close();
    if (!file) return invalidArgument("cannot write " + path.string());
    return {};
}

Result<std::string> readFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) return invalidArgument("cannot read " + path.string());
    return std::move(text).str();
}

Status saveRendering(const Rendering& rendering, const std::filesystem::path& directory) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error) return invalidArgument("cannot create " + directory.string() + ": " + error.message());
    nlohmann::json images = nlohmann::json::array();
    for (size_t i = 0; i < rendering.images.size(); ++i) {
        const RenderedImage& image = rendering.images[i];
        images.push_back({{"format", image.format}, {"width", image.extent.width}, {"height", image.extent.height}});
        Status status = writeFile(rawPath(directory, rendering.scene, i), image.texels.data(), image.texels.size());
        if (!status) return status;
    }
    const Timing& timing = rendering.timing;
    const nlohmann::json document = {{"scene", rendering.scene},
                                     {"driver", rendering.driver},
                                     {"version", rendering.version},
                                     {"limits", rendering.limits},
                                     {"milliseconds",
                                      {{"startUp", timing.startUp},
                                       {"modules", timing.modules},
                                       {"pipelines", timing.pipelines},
                                       {"firstFrame", timing.firstFrame},
                                       {"warmFrame", timing.warmFrame},
                                       {"firstImage", timing.firstImage},
                                       {"frame", timing.frame}}},
                                     {"frames", timing.frames},
                                     {"libraries", rendering.libraries},
                                     {"notNeeded", rendering.notNeeded},
                                     {"images", images}};
    const std::string text = document.dump(2) + "\n";
    return writeFile(directory / (rendering.scene + ".json"), text.data(), text.size());
}

Result<Rendering> loadRendering(const std::filesystem::path& directory, const std::string& scene) {
    const std::filesystem::path path = directory / (scene + ".json");
    const Result<std::string> text = readFile(path);
    if (!text) return text.error();
    try {
        const nlohmann::json document = nlohmann::json::parse(text.value());
        Rendering rendering;
        rendering.scene = document.at("scene").get<std::string>();
        rendering.driver = document.at("driver").get<std::string>();
        rendering.version = document.at("version").get<std::string>();
        rendering.limits = document.at("limits").get<std::string>();
        rendering.libraries = document.at("libraries").get<uint64_t>();
        rendering.notNeeded = document.at("notNeeded").get<std::vector<std::string>>();
        const nlohmann::json& times = document.at("milliseconds");
        rendering.timing = {.startUp = times.at("startUp"),
                            .modules = times.at("modules"),
                            .pipelines = times.at("pipelines"),
                            .firstFrame = times.at("firstFrame"),
                            .warmFrame = times.at("warmFrame"),
                            .firstImage = times.at("firstImage"),
                            .frame = times.at("frame"),
                            .frames = document.at("frames")};
        for (const nlohmann::json& entry : document.at("images")) {
            RenderedImage image;
            image.format = static_cast<VkFormat>(entry.at("format").get<int>());
            image.extent = {entry.at("width"), entry.at("height")};
            const Result<std::string> texels = readFile(rawPath(directory, scene, rendering.images.size()));
            if (!texels) return texels.error();
            image.texels.resize(texels.value().size());
            std::memcpy(image.texels.data(), texels.value().data(), image.texels.size());
            rendering.images.push_back(std::move(image));
        }
        return rendering;
    } catch (const nlohmann::json::exception& problem) {
        return invalidArgument(path.string() + ": " + problem.what());
    }
}

}  // namespace vernier::conformance
