#include "conformance/report/heat_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vernier::conformance {

Rgb8 heatColor(int32_t codes, bool dimmed) {
    constexpr Rgb8 kEqual{14, 16, 22};
    if (codes == 0) return kEqual;
    // Step 1 for one code, 8 for 128 and more.
    const auto magnitude = static_cast<uint32_t>(std::abs(int64_t{codes}));
    const int step = std::min<int>(static_cast<int>(std::bit_width(magnitude)), 8);
    double strength = 0.3 + 0.7 * (step - 1) / 7.0;
    if (dimmed) strength /= 3;
    const auto mix = [&](uint8_t from, int to) {
        return static_cast<uint8_t>(std::lround(from + (to - from) * strength));
    };
    return codes > 0 ? Rgb8{mix(kEqual.r, 255), mix(kEqual.g, 84), mix(kEqual.b, 56)}
                     : Rgb8{mix(kEqual.r, 70), mix(kEqual.g, 150), mix(kEqual.b, 255)};
}

Rgb8 classColor(PixelClass pixelClass) {
    switch (pixelClass) {
        case PixelClass::equal:
            return {38, 43, 54};
        case PixelClass::rounding:
            return {72, 120, 96};
        case PixelClass::weights:
            return {110, 180, 110};
        case PixelClass::level:
            return {60, 160, 170};
        case PixelClass::interpolation:
            return {86, 170, 140};
        case PixelClass::tie:
            return {120, 150, 230};
        case PixelClass::snap:
            return {90, 130, 200};
        case PixelClass::sequence:
        case PixelClass::order:
            return {70, 100, 170};
        case PixelClass::pattern:
            return {150, 130, 200};
        case PixelClass::undefined:
            return {130, 130, 130};
        case PixelClass::otherWrong:
            return {178, 132, 214};
        case PixelClass::undecided:
            return {235, 190, 70};
        case PixelClass::oursWrong:
            return {240, 130, 50};
        case PixelClass::unexplained:
            return {230, 50, 70};
    }
    return {};
}

Picture heatMap(const ImageDiff& diff, uint32_t spread) {
    Picture picture(diff.extent.width, diff.extent.height);
    const auto weight = [](const PixelDiff& pixel) { return std::abs(int64_t{pixel.error}); };
    for (uint32_t y = 0; y < picture.height; ++y) {
        for (uint32_t x = 0; x < picture.width; ++x) {
            PixelDiff shown = diff.pixels[size_t{y} * picture.width + x];
            for (uint32_t v = y - std::min(y, spread); v <= std::min(y + spread, picture.height - 1); ++v) {
                for (uint32_t u = x - std::min(x, spread); u <= std::min(x + spread, picture.width - 1); ++u) {
                    const PixelDiff& near = diff.pixels[size_t{v} * picture.width + u];
                    if (weight(near) > weight(shown)) shown = near;
                }
            }
            picture.at(x, y) =
                heatColor(shown.error, shown.pixelClass >= PixelClass::tie && shown.pixelClass <= PixelClass::pattern);
        }
    }
    return picture;
}

Picture classMap(const ImageDiff& diff) {
    Picture picture(diff.extent.width, diff.extent.height);
    for (size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = classColor(diff.pixels[i].pixelClass);
    return picture;
}

}  // namespace vernier::conformance
