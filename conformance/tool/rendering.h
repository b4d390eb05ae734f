// One scene drawn by one driver, as it travels from the child process that drew it to the one that compares:
// a JSON file with names and times beside one raw file per image.
#pragma once

#include "base/result.h"
#include "conformance/drivers/driver.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vernier::conformance {

struct Rendering {
    std::string scene;
    std::string driver, version, limits;  // as the implementation names itself
    Timing timing;
    uint64_t libraries = 0;   // bytes of the shared libraries that came with the driver: it, and what it needs
    uint64_t peakMemory = 0;  // bytes resident at most in the process that drew; 0: not measured; not saved
    std::vector<std::string> notNeeded;  // Driver::notNeeded()
    std::vector<RenderedImage> images;
};

/// Writes <directory>/<scene>.json and <directory>/<scene>.<n>.raw (texels as in RenderedImage), creating the
/// directory.
Status saveRendering(const Rendering& rendering, const std::filesystem::path& directory);

/// Reads what saveRendering() wrote.
Result<Rendering> loadRendering(const std::filesystem::path& directory, const std::string& scene);

/// Whole files.
Status writeFile(const std::filesystem::path& path, const void* data, size_t size);
Result<std::string> readFile(const std::filesystem::path& path);

}  // namespace vernier::conformance
