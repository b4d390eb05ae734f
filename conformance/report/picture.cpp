#include "conformance/report/picture.h"

#include "conformance/scene/scene_format.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <limits>

namespace vernier::conformance {
namespace {

using Values = std::array<double, 4>;

Values decodeTexel(const SceneFormat& format, std::span<const std::byte> texel) {
    Values values{};
    for (size_t i = 0; i < format.componentCount; ++i) {
        values[i] = decodeComponent(format.components[i], componentCode(format.components[i], texel));
    }
    return values;
}

std::span<const std::byte> texelAt(const RenderedImage& image, const SceneFormat& format, size_t index) {
    return std::span(image.texels).subspan(index * format.texelBytes, format.texelBytes);
}

bool isSrgb(const SceneFormat& format) {
    return format.components[0].kind == ComponentKind::srgb;
}

/// Whether codes are shown as they are: what a screen would do with a normalised colour image.
bool isDisplayable(const SceneFormat& format) {
    return format.aspects == VK_IMAGE_ASPECT_COLOR_BIT &&
           (format.components[0].kind == ComponentKind::unorm || isSrgb(format));
}

double encodeSrgb(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

uint8_t toByte(double value) {
    return static_cast<uint8_t>(std::lround(std::clamp(std::isnan(value) ? 0.0 : value, 0.0, 1.0) * 255));
}

Rgb8 show(const SceneFormat& format, const Values& values, const Stretch& stretch) {
    Values shown = values;
    if (stretch.active) {
        const double range = stretch.high > stretch.low ? stretch.high - stretch.low : 1;
        for (double& value : shown) value = (value - stretch.low) / range;
    } else if (isSrgb(format)) {
        for (double& value : shown) value = encodeSrgb(std::clamp(value, 0.0, 1.0));
    }
    if (format.componentCount == 1) shown[1] = shown[2] = shown[0];
    return {toByte(shown[0]), toByte(shown[1]), toByte(shown[2])};
}

}  // namespace

Stretch stretchFor(const RenderedImage& image) {
    const SceneFormat* format = sceneFormat(image.format);
    if (format == nullptr || isDisplayable(*format)) return {};
    // The clear value often lies far outside of what was drawn: leave out the single highest value.
    double low = std::numeric_limits<double>::infinity(), high = -low, second = -low;
    for (size_t i = 0; i < image.texels.size() / format->texelBytes; ++i) {
        const Values values = decodeTexel(*format, texelAt(image, *format, i));
        for (size_t c = 0; c < std::min<size_t>(format->componentCount, 3); ++c) {
            if (!std::isfinite(values[c])) continue;
            low = std::min(low, values[c]);
            if (values[c] > high) {
                second = high;
                high = values[c];
            } else if (values[c] < high) {
                second = std::max(second, values[c]);
            }
        }
    }
    if (!(low <= high)) return {true, 0, 1};
    return {true, low, std::isfinite(second) && second > low ? second : high};
}

Picture pictureOf(const RenderedImage& image, const Stretch& stretch) {
    const SceneFormat* format = sceneFormat(image.format);
    Picture picture(image.extent.width, image.extent.height);
    if (format == nullptr || image.texels.size() < picture.pixels.size() * format->texelBytes) return picture;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        picture.pixels[i] = show(*format, decodeTexel(*format, texelAt(image, *format, i)), stretch);
    }
    return picture;
}

Picture pictureOf(const OracleImage& image, const Stretch& stretch) {
    const SceneFormat* format = sceneFormat(image.format);
    Picture picture(image.extent.width, image.extent.height);
    if (format == nullptr || image.pixels.size() != picture.pixels.size()) return picture;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        picture.pixels[i] = show(*format, image.pixels[i].value, stretch);
    }
    return picture;
}

Picture magnified(const Picture& picture, uint32_t x, uint32_t y, uint32_t size, uint32_t scale) {
    constexpr Rgb8 kOutside{128, 128, 128}, kFrame{255, 0, 128}, kInnerFrame{255, 255, 255};
    Picture result(size * scale, size * scale, kOutside);
    for (uint32_t row = 0; row < result.height; ++row) {
        for (uint32_t column = 0; column < result.width; ++column) {
            const int64_t fromX = int64_t{x} + column / scale - size / 2, fromY = int64_t{y} + row / scale - size / 2;
            if (fromX >= 0 && fromY >= 0 && fromX < picture.width && fromY < picture.height) {
                result.at(column, row) = picture.at(static_cast<uint32_t>(fromX), static_cast<uint32_t>(fromY));
            }
            const uint32_t inX = column - size / 2 * scale, inY = row - size / 2 * scale;  // wraps outside
            if (inX < scale && inY < scale) {
                const uint32_t border = std::min({inX, inY, scale - 1 - inX, scale - 1 - inY});
                if (border == 0) result.at(column, row) = kFrame;
                if (border == 1) result.at(column, row) = kInnerFrame;
            }
        }
    }
    return result;
}

Result<std::string> encodePng(const Picture& picture, const std::string& text) {
    std::string file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        png_destroy_write_struct(&png, nullptr);
        return Error{ErrorCode::outOfHostMemory, "libpng: no memory"};
    }
    // Declared before setjmp: a jump back must not skip a destructor.
    std::string comment = text;
    std::string keyword = "Comment";
    png_text entry{};
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return invalidArgument("libpng refuses a picture of " + std::to_string(picture.width) + " x " +
                               std::to_string(picture.height));
    }
    png_set_write_fn(
        png, &file,
        [](png_structp writer, png_bytep data, png_size_t size) {
            static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<const char*>(data), size);
        },
        nullptr);
    png_set_IHDR(png, info, picture.width, picture.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!comment.empty()) {
        entry.compression = PNG_TEXT_COMPRESSION_NONE;
        entry.key = keyword.data();
        entry.text = comment.data();
        png_set_text(png, info, &entry, 1);
    }
    png_write_info(png, info);
    for (uint32_t y = 0; y < picture.height; ++y) {
        png_write_row(png, reinterpret_cast<png_const_bytep>(&picture.at(0, y)));
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

}  // namespace vernier::conformance
