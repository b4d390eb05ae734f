#include "conformance/tool/oracle_file.h"

#include "conformance/tool/rendering.h"

#include <cstring>
#include <string>
#include <type_traits>

namespace vernier::conformance {
namespace {

struct ImageHeader {
    uint32_t format, width, height, pixelBytes;
};
static_assert(std::is_trivially_copyable_v<OraclePixel>);

}  // namespace

Status saveOracle(const std::vector<OracleImage>& images, const std::filesystem::path& path) {
    std::string data;
    for (const OracleImage& image : images) {
        const ImageHeader header{static_cast<uint32_t>(image.format), image.extent.width, image.extent.height,
                                 sizeof(OraclePixel)};
        data.append(reinterpret_cast<const char*>(&header), sizeof header);
        data.append(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size() * sizeof(OraclePixel));
    }
    return writeFile(path, data.data(), data.size());
}

Result<std::vector<OracleImage>> loadOracle(const std::filesystem::path& path) {
    const Result<std::string> data = readFile(path);
    if (!data) return data.error();
    const std::string& text = data.value();
    std::vector<OracleImage> images;
    for (size_t at = 0; at < text.size();) {
        ImageHeader header{};
        if (text.size() - at < sizeof header) return invalidArgument(path.string() + " ends in a header");
        std::memcpy(&header, text.data() + at, sizeof header);
        at += sizeof header;
        OracleImage image{static_cast<VkFormat>(header.format), {header.width, header.height}, {}};
        const size_t pixels = size_t{header.width} * header.height;
        if (header.pixelBytes != sizeof(OraclePixel) || (text.size() - at) / sizeof(OraclePixel) < pixels) {
            return invalidArgument(path.string() + " ends in an image");
        }
        image.pixels.resize(pixels);
        std::memcpy(image.pixels.data(), text.data() + at, pixels * sizeof(OraclePixel));
        at += pixels * sizeof(OraclePixel);
        images.push_back(std::move(image));
    }
    return images;
}

}  // namespace vernier::conformance
