#include "conformance/differ/classify.h"

#include "conformance/scene/scene_format.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace vernier::conformance {
namespace {

constexpr int64_t kNanError = std::numeric_limits<int32_t>::max();

struct PixelCodes {
    std::array<uint32_t, 4> codes{};
};

PixelCodes codesOf(const SceneFormat& format, const RenderedImage& image, size_t pixel) {
    PixelCodes result;
    const auto texel = std::span(image.texels).subspan(pixel * format.texelBytes, format.texelBytes);
    for (size_t i = 0; i < format.componentCount; ++i) {
        result.codes[i] = componentCode(format.components[i], texel);
    }
    return result;
}

/// Two doubles that are the same value up to how the oracle rounded its exact numbers.
bool same(double a, double b) {
    return a == b || std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
}

/// A code is legal when its value lies in low..high, or when the format cannot represent a bound and the code
/// is the bound's neighbour on the outside: conversion may round either way (Vulkan specification,
/// "Conversion From Floating-Point to Normalized Fixed-Point").
bool isLegal(const FormatComponent& component, uint32_t code, double value, double low, double high) {
    if (isNan(component, code)) return std::isnan(value) || std::isnan(low) || std::isnan(high);
    if (std::isnan(low) || std::isnan(high)) return false;
    const double decoded = decodeComponent(component, code);
    if ((decoded >= low || same(decoded, low)) && (decoded <= high || same(decoded, high))) return true;
    const bool below = decoded < low;
    const std::optional<uint32_t> inward = codeAtPlace(component, codePlace(component, code) + (below ? 1 : -1));
    if (!inward) return true;  // the end of the scale: what lies beyond saturates
    const double next = decodeComponent(component, *inward);
    return below ? next > low && !same(next, low) : next < high && !same(next, high);
}

bool isLegal(const SceneFormat& format, const PixelCodes& pixel, const OraclePixel& oracle) {
    for (size_t i = 0; i < format.componentCount; ++i) {
        if (!isLegal(format.components[i], pixel.codes[i], oracle.value[i], oracle.low[i], oracle.high[i]))
            return false;
    }
    return true;
}

struct Distance {
    std::array<int64_t, 4> error{};  // in codes
    bool nan = false;                // one side only

    int64_t furthest() const {
        int64_t result = 0;
        for (const int64_t each : error) {
            if (std::abs(each) > std::abs(result)) result = each;
        }
        return result;
    }
};

Distance distance(const SceneFormat& format, const PixelCodes& ours, const PixelCodes& other) {
    Distance result;
    for (size_t i = 0; i < format.componentCount; ++i) {
        const FormatComponent& component = format.components[i];
        const bool ourNan = isNan(component, ours.codes[i]), otherNan = isNan(component, other.codes[i]);
        if (ourNan != otherNan) {
            result.nan = true;
            result.error[i] = kNanError;
        } else if (!ourNan) {
            result.error[i] = codePlace(component, ours.codes[i]) - codePlace(component, other.codes[i]);
        }
    }
    return result;
}

/// Why two legal values may be more than a code apart. Several reasons: the one that moves most.
PixelClass causeOf(OracleFlags flags) {
    constexpr std::pair<OracleFlag, PixelClass> kOpen[] = {{kOracleSnap, PixelClass::snap},
                                                           {kOracleTie, PixelClass::tie},
                                                           {kOracleOrder, PixelClass::order},
                                                           {kOracleSequence, PixelClass::sequence},
                                                           {kOraclePattern, PixelClass::pattern}};
    constexpr std::pair<OracleFlag, PixelClass> kRanges[] = {{kOracleLevel, PixelClass::level},
                                                             {kOracleWeights, PixelClass::weights}};
    if ((flags & kOracleEdge) != 0) {
        for (const auto& [flag, cause] : kOpen) {
            if ((flags & flag) != 0) return cause;
        }
        return PixelClass::snap;
    }
    for (const auto& [flag, cause] : kRanges) {
        if ((flags & flag) != 0) return cause;
    }
    return PixelClass::interpolation;
}

PixelClass classifyPair(const Distance& apart, bool oursLegal, bool otherLegal, const OraclePixel* oracle) {
    const int64_t error = std::abs(apart.furthest());
    if (oracle == nullptr) {
        if (error == 0) return PixelClass::equal;
        return error == 1 ? PixelClass::rounding : PixelClass::unexplained;
    }
    if ((oracle->flags & kOracleUnknown) != 0) return error == 0 ? PixelClass::equal : PixelClass::undecided;
    if ((oracle->flags & kOracleUndefined) != 0) return error == 0 ? PixelClass::equal : PixelClass::undefined;
    if (!oursLegal && !otherLegal) return PixelClass::unexplained;
    if (!oursLegal) return PixelClass::oursWrong;
    if (!otherLegal) return PixelClass::otherWrong;
    if (error == 0) return PixelClass::equal;
    if (error == 1) return PixelClass::rounding;
    return causeOf(oracle->flags);
}

void add(ImageDiff& diff, size_t pixel, PixelClass pixelClass, const Distance& apart) {
    const int64_t error = apart.furthest();
    constexpr int64_t kMost = std::numeric_limits<int32_t>::max();
    PixelDiff& entry = diff.pixels[pixel];
    entry = {pixelClass, static_cast<int32_t>(std::clamp(error, -kMost, kMost))};
    ++diff.counts[static_cast<size_t>(pixelClass)];
    if (apart.nan) ++diff.nanPixels;
    for (size_t i = 0; i < apart.error.size(); ++i) {
        if (std::abs(apart.error[i]) > std::abs(diff.worstError[i])) diff.worstError[i] = apart.error[i];
    }
    const PixelDiff& worst = diff.pixels[size_t{diff.worstY} * diff.extent.width + diff.worstX];
    const bool severer = pixelClass > diff.worstClass;
    if (severer || (pixelClass == diff.worstClass && std::abs(int64_t{entry.error}) > std::abs(int64_t{worst.error}))) {
        diff.worstClass = pixelClass;
        diff.worstX = static_cast<uint32_t>(pixel % diff.extent.width);
        diff.worstY = static_cast<uint32_t>(pixel / diff.extent.width);
    }
}

std::string describe(VkFormat format, VkExtent2D extent) {
    return "format " + std::to_string(static_cast<int>(format)) + ", " + std::to_string(extent.width) + " x " +
           std::to_string(extent.height);
}

Result<ImageDiff> start(const RenderedImage& image, VkFormat format, VkExtent2D extent) {
    if (image.format != format || image.extent.width != extent.width || image.extent.height != extent.height) {
        return invalidArgument("images do not match: " + describe(image.format, image.extent) + " against " +
                               describe(format, extent));
    }
    const SceneFormat* description = sceneFormat(format);
    if (description == nullptr) return unsupported("cannot compare images of " + describe(format, extent));
    const size_t pixels = size_t{extent.width} * extent.height;
    if (pixels == 0 || image.texels.size() != pixels * description->texelBytes) {
        return invalidArgument("RenderedImage::texels has " + std::to_string(image.texels.size()) +
                               " bytes, not those of " + describe(format, extent));
    }
    ImageDiff diff;
    diff.extent = extent;
    diff.pixels.resize(pixels);
    return diff;
}

/// The code nearest to a value, by bisection over the places, whose values rise.
uint32_t nearestCode(const FormatComponent& component, double value) {
    const int64_t span = int64_t{1} << component.bits;
    int64_t low = -span, high = span;  // places; tightened to existing ones
    const auto decoded = [&](int64_t place) {
        const std::optional<uint32_t> code = codeAtPlace(component, place);
        if (code) return decodeComponent(component, *code);
        return place < 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
    };
    while (low + 1 < high) {
        const int64_t middle = low + (high - low) / 2;
        (decoded(middle) <= value ? low : high) = middle;
    }
    const bool up =
        !codeAtPlace(component, low) || (codeAtPlace(component, high) && decoded(high) - value < value - decoded(low));
    return codeAtPlace(component, up ? high : low).value_or(0);
}

}  // namespace

std::string_view pixelClassName(PixelClass pixelClass) {
    switch (pixelClass) {
#define VERNIER_NAME(name, text) \
    case PixelClass::name:       \
        return #name;
        VERNIER_PIXEL_CLASSES(VERNIER_NAME)
#undef VERNIER_NAME
    }
    return {};
}

std::string_view pixelClassText(PixelClass pixelClass) {
    switch (pixelClass) {
#define VERNIER_TEXT(name, text) \
    case PixelClass::name:       \
        return text;
        VERNIER_PIXEL_CLASSES(VERNIER_TEXT)
#undef VERNIER_TEXT
    }
    return {};
}

bool isFailure(PixelClass pixelClass) {
    return pixelClass == PixelClass::undecided || pixelClass == PixelClass::oursWrong ||
           pixelClass == PixelClass::unexplained;
}

uint64_t ImageDiff::failures() const {
    return count(PixelClass::undecided) + count(PixelClass::oursWrong) + count(PixelClass::unexplained);
}

Result<ImageDiff> compareImages(const RenderedImage& ours, const RenderedImage& other, const OracleImage* oracle) {
    if (Result<ImageDiff> check = start(other, ours.format, ours.extent); !check) return check.error();
    if (oracle != nullptr) {
        if (Result<ImageDiff> check = start(ours, oracle->format, oracle->extent); !check) return check.error();
    }
    Result<ImageDiff> started = start(ours, ours.format, ours.extent);
    if (!started) return started;
    ImageDiff diff = std::move(started).value();
    diff.hasOracle = oracle != nullptr;
    if (oracle != nullptr && oracle->pixels.size() != diff.pixels.size()) {
        return invalidArgument("OracleImage::pixels has " + std::to_string(oracle->pixels.size()) + " elements, not " +
                               std::to_string(diff.pixels.size()));
    }
    const SceneFormat& format = *sceneFormat(ours.format);
    for (size_t i = 0; i < diff.pixels.size(); ++i) {
        const PixelCodes a = codesOf(format, ours, i), b = codesOf(format, other, i);
        const OraclePixel* judge = oracle != nullptr ? &oracle->pixels[i] : nullptr;
        const Distance apart = distance(format, a, b);
        const bool unknown = judge != nullptr && (judge->flags & kOracleUnknown) != 0;
        if (unknown) ++diff.unknownPixels;
        const bool judged = judge != nullptr && !unknown;
        add(diff, i,
            classifyPair(apart, judged && isLegal(format, a, *judge), judged && isLegal(format, b, *judge), judge),
            apart);
    }
    return diff;
}

Result<ImageDiff> compareWithOracle(const RenderedImage& image, const OracleImage& oracle) {
    Result<ImageDiff> started = start(image, oracle.format, oracle.extent);
    if (!started) return started;
    ImageDiff diff = std::move(started).value();
    diff.hasOracle = true;
    if (oracle.pixels.size() != diff.pixels.size()) {
        return invalidArgument("OracleImage::pixels has " + std::to_string(oracle.pixels.size()) + " elements, not " +
                               std::to_string(diff.pixels.size()));
    }
    const SceneFormat& format = *sceneFormat(image.format);
    for (size_t i = 0; i < diff.pixels.size(); ++i) {
        const OraclePixel& judge = oracle.pixels[i];
        const PixelCodes ours = codesOf(format, image, i);
        PixelCodes exact;
        for (size_t c = 0; c < format.componentCount; ++c) {
            const FormatComponent& component = format.components[c];
            // Where the oracle says NaN, any NaN is its value.
            exact.codes[c] = std::isnan(judge.value[c]) && isNan(component, ours.codes[c])
                                 ? ours.codes[c]
                                 : nearestCode(component, judge.value[c]);
        }
        const Distance apart = distance(format, ours, exact);
        const bool unknown = (judge.flags & kOracleUnknown) != 0;
        if (unknown) ++diff.unknownPixels;
        add(diff, i, classifyPair(apart, !unknown && isLegal(format, ours, judge), true, &judge), apart);
    }
    return diff;
}

}  // namespace vernier::conformance
