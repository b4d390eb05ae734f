#include "samples/common/picture_file.h"

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace samples {

Picture loadPicture(const std::string& path) {
    int width = 0, height = 0, channels = 0;
    stbi_uc* bytes = stbi_load(path.c_str(), &width, &height, &channels, 4);
    if (!bytes) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), stbi_failure_reason());
        std::exit(1);
    }
    Picture picture{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
    picture.texels.resize(size_t{picture.width} * picture.height);
    std::memcpy(picture.texels.data(), bytes, picture.texels.size() * 4);
    stbi_image_free(bytes);
    return picture;
}

bool savePicture(const std::string& path, const Picture& picture) {
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    const std::string end = path.size() > 4 ? path.substr(path.size() - 4) : "";
    if (end == ".bmp") return stbi_write_bmp(path.c_str(), width, height, 4, picture.texels.data());
    if (end == ".tga") return stbi_write_tga(path.c_str(), width, height, 4, picture.texels.data());
    return stbi_write_png(path.c_str(), width, height, 4, picture.texels.data(), 0);
}

}  // namespace samples
