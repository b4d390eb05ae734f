#include "samples/common/picture_file.h"

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace samples {

Picture loadPicture(const std::string& path) {
    Picture picture;
    std::string error;
    if (!readPicture(path, picture, error)) {
        std::fprintf(stderr, "%s\n", error.c_str());
        std::exit(1);
    }
    return picture;
}

bool readFile(const std::string& path, std::vector<uint8_t>& bytes) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) return false;
    bytes.clear();
    uint8_t block[65536];
    for (size_t count = 0; (count = std::fread(block, 1, sizeof block, file)) > 0;)
        bytes.insert(bytes.end(), block, block + count);
    const bool read = std::ferror(file) == 0;  // a folder can be opened, but not read
    std::fclose(file);
    return read;
}

bool readPicture(const std::string& path, Picture& picture, std::string& error) {
    std::vector<uint8_t> bytes;
    error = "could not be read";
    if (readFile(path, bytes) && decodePicture(bytes.data(), bytes.size(), picture, error)) return true;
    error = path + ": " + error;
    return false;
}

bool decodePicture(const uint8_t* bytes, size_t size, Picture& picture, std::string& error) {
    int width = 0, height = 0, channels = 0;
    if (size > INT_MAX) {
        error = "more than 2 GB";
        return false;
    }
    stbi_uc* texels = stbi_load_from_memory(bytes, static_cast<int>(size), &width, &height, &channels, 4);
    if (!texels) {
        error = stbi_failure_reason();
        return false;
    }
    picture.width = static_cast<uint32_t>(width);
    picture.height = static_cast<uint32_t>(height);
    picture.texels.resize(size_t{picture.width} * picture.height);
    std::memcpy(picture.texels.data(), texels, picture.texels.size() * 4);
    stbi_image_free(texels);
    return true;
}

bool savePicture(const std::string& path, const Picture& picture) {
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    const std::string end = path.size() > 4 ? path.substr(path.size() - 4) : "";
    if (end == ".bmp") return stbi_write_bmp(path.c_str(), width, height, 4, picture.texels.data());
    if (end == ".tga") return stbi_write_tga(path.c_str(), width, height, 4, picture.texels.data());
    return stbi_write_png(path.c_str(), width, height, 4, picture.texels.data(), 0);
}

}  // namespace samples
