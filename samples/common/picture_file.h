// Pictures in files, through stb.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace samples {

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> texels;  // RGBA8, row by row from the top
};

/// Everything of a file. False where there is none that can be read.
bool readFile(const std::string& path, std::vector<uint8_t>& bytes);

/// PNG, TGA, BMP and JPEG, from a file or from the bytes of one. False with what is wrong.
bool readPicture(const std::string& path, Picture& picture, std::string& error);
bool decodePicture(const uint8_t* bytes, size_t size, Picture& picture, std::string& error);
/// A file that cannot be read ends the program with a message.
Picture loadPicture(const std::string& path);
/// The format by the end of the name: .bmp, .tga, else PNG. False when the file cannot be written.
bool savePicture(const std::string& path, const Picture& picture);

}  // namespace samples
