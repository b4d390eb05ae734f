// What the tests and scripts/gallery do with pictures:
//   sample_picture hash FILE.png                    prints the hash of size and pixels
//   sample_picture check FILE.png HASH              fails unless the picture has that hash and more than one colour
//   sample_picture thumbnail FILE.png OUT.png       180 texels wide, few colours, so that the file is small
//   sample_picture check-thumbnail FILE.png THUMBNAIL.png    fails unless THUMBNAIL is FILE's
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

Picture load(const std::string& path) {
    Picture picture;
    int channels = 0;
    uint8_t* pixels = stbi_load(path.c_str(), &picture.width, &picture.height, &channels, 3);
    if (!pixels) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), stbi_failure_reason());
        std::exit(1);
    }
    picture.rgb.assign(pixels, pixels + size_t(picture.width) * size_t(picture.height) * 3);
    stbi_image_free(pixels);
    return picture;
}

/// FNV-1a over the size and the pixels: the file's compression does not matter.
std::string hashOf(const Picture& picture) {
    uint64_t hash = 0xCBF29CE484222325u;
    const auto add = [&](uint32_t byte) { hash = (hash ^ byte) * 0x100000001B3u; };
    for (const int side : {picture.width, picture.height})
        for (int shift = 0; shift < 32; shift += 8) add(static_cast<uint32_t>(side) >> shift & 0xFF);
    for (const uint8_t byte : picture.rgb) add(byte);
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

/// The mean of the texels below each, in 32 steps per colour.
Picture thumbnailOf(const Picture& picture) {
    Picture small;
    small.width = 180;
    small.height = std::max(1, picture.height * small.width / picture.width);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            const int left = x * picture.width / small.width, top = y * picture.height / small.height;
            const int right = std::max(left + 1, (x + 1) * picture.width / small.width);
            const int bottom = std::max(top + 1, (y + 1) * picture.height / small.height);
            for (int channel = 0; channel < 3; ++channel) {
                int sum = 0;
                for (int v = top; v < bottom; ++v)
                    for (int u = left; u < right; ++u)
                        sum += picture.rgb[size_t((v * picture.width + u) * 3 + channel)];
                const int mean = sum / ((right - left) * (bottom - top));
                const int step = (mean * 31 + 127) / 255;
                small.rgb.push_back(static_cast<uint8_t>(step * 255 / 31));
            }
        }
    return small;
}

int check(const std::string& path, const std::string& hash) {
    const Picture picture = load(path);
    bool flat = true;
    for (size_t i = 3; i < picture.rgb.size(); ++i) flat = flat && picture.rgb[i] == picture.rgb[i - 3];
    if (flat) {
        std::fprintf(stderr, "%s has one colour\n", path.c_str());
        return 1;
    }
    if (hashOf(picture) == hash) return 0;
    std::fprintf(stderr, "%s has the hash %s, but %s is expected: look at it, then scripts/gallery --update\n",
                 path.c_str(), hashOf(picture).c_str(), hash.c_str());
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.size() == 2 && words[0] == "hash") {
        std::printf("%s\n", hashOf(load(words[1])).c_str());
        return 0;
    }
    if (words.size() == 3 && words[0] == "check") return check(words[1], words[2]);
    if (words.size() == 3 && words[0] == "thumbnail") {
        const Picture small = thumbnailOf(load(words[1]));
        stbi_write_png_compression_level = 20;
        return stbi_write_png(words[2].c_str(), small.width, small.height, 3, small.rgb.data(), 0) ? 0 : 1;
    }
    if (words.size() == 3 && words[0] == "check-thumbnail") {
        if (hashOf(thumbnailOf(load(words[1]))) == hashOf(load(words[2]))) return 0;
        std::fprintf(stderr, "%s is not of %s: scripts/gallery --update\n", words[2].c_str(), words[1].c_str());
        return 1;
    }
    std::fprintf(stderr, "sample_picture hash|check|thumbnail|check-thumbnail FILE.png [...]\n");
    return 2;
}
