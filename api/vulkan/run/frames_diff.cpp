// vernier-frames-diff FOLDER FOLDER: compares the frames that VK_LAYER_VERNIER_frames wrote, in the order in which they
// were presented. A line for each pair that differs, and a last one for all. 0: all are alike, for drivers may differ
// along edges and by roundings; 1: some are not, or there are not as many; 2: nothing to compare.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace {

struct Frame {
    uint32_t width = 0, height = 0;
    std::vector<char> texels;
};

bool read(const std::string& folder, uint32_t number, Frame& frame) {
    char name[32];
    std::snprintf(name, sizeof name, "/frame-%04u.ppm", number);
    std::ifstream file(folder + name, std::ios::binary);
    std::string magic;
    uint32_t most = 0;
    if (!(file >> magic >> frame.width >> frame.height >> most) || magic != "P6" || most != 255) return false;
    file.get();
    frame.texels.resize(size_t{3} * frame.width * frame.height);
    return static_cast<bool>(file.read(frame.texels.data(), static_cast<std::streamsize>(frame.texels.size())));
}

/// Decibels from which on two frames are the same picture.
constexpr double kAlike = 30;

struct Difference {
    uint64_t pixels = 0;  // that differ
    int most = 0;         // of 255
    double psnr = 0;      // decibels
};

Difference compare(const Frame& a, const Frame& b) {
    Difference result;
    double squares = 0;
    for (size_t pixel = 0; pixel < a.texels.size(); pixel += 3) {
        int worst = 0;
        for (size_t c = pixel; c < pixel + 3; ++c) {
            const int difference = std::abs(static_cast<uint8_t>(a.texels[c]) - static_cast<uint8_t>(b.texels[c]));
            worst = std::max(worst, difference);
            squares += static_cast<double>(difference) * difference;
        }
        if (worst > 0) ++result.pixels;
        result.most = std::max(result.most, worst);
    }
    const double mean = squares / static_cast<double>(std::max<size_t>(a.texels.size(), 1));
    result.psnr = mean > 0 ? 10 * std::log10(255.0 * 255.0 / mean) : INFINITY;
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: vernier-frames-diff FOLDER FOLDER\n");
        return 64;
    }
    uint32_t count = 0, equal = 0, alike = 0;
    bool sameCount = true;
    for (Frame a, b;; ++count) {
        const bool first = read(argv[1], count, a), second = read(argv[2], count, b);
        sameCount = first == second;
        if (!first || !second) break;
        if (a.width != b.width || a.height != b.height) {
            std::printf("frame %u: %u x %u and %u x %u\n", count, a.width, a.height, b.width, b.height);
            continue;
        }
        const Difference difference = compare(a, b);
        if (difference.most == 0) ++equal;
        if (difference.psnr >= kAlike) ++alike;
        if (difference.most == 0) continue;
        std::printf("frame %u: %llu of %llu pixels differ, by %d of 255 at most, PSNR %.1f dB\n", count,
                    static_cast<unsigned long long>(difference.pixels),
                    static_cast<unsigned long long>(a.texels.size() / 3), difference.most, difference.psnr);
    }
    if (count == 0) {
        std::printf("there are no frames to compare\n");
        return 2;
    }
    std::printf("%u frames: %u equal, %u more alike, %u not%s\n", count, equal, alike - equal, count - alike,
                sameCount ? "" : "; one run had more frames");
    return alike == count && sameCount ? 0 : 1;
}
