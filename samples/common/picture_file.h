// Pictures in files, through stb.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace samples {

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> texels;  // RGBA8, row by row from the top
};

/// PNG, TGA, BMP and JPEG. A file that cannot be read ends the program with a message.
Picture loadPicture(const std::string& path);
/// The format by the end of the name: .bmp, .tga, else PNG. False when the file cannot be written.
bool savePicture(const std::string& path, const Picture& picture);

}  // namespace samples
