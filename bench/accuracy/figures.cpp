#include "bench/accuracy/figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "conformance/scene/scene_format.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr double kCodes = 255;

/// The decoded values of pixel `i`; components that the format lacks stay 0.
std::array<double, 4> valuesAt(const RenderedImage& image, const SceneFormat& format, size_t i) {
    std::array<double, 4> values{};
    const std::span<const std::byte> texel(image.texels.data() + i * format.texelBytes, format.texelBytes);
    for (size_t c = 0; c < format.componentCount; ++c)
        values[c] = decodeComponent(format.components[c], componentCode(format.components[c], texel));
    return values;
}

/// In units of 1/255; infinite for NaN.
double signedError(double value, double exact) {
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : (value - exact) * kCodes;
}

/// Whether the pixel shows something else than the geometry has there, rather than the same with an error of its value:
/// farther away than any rounding of values.
bool isOtherSurface(const std::array<double, 4>& values, const OraclePixel& exact, size_t components) {
    constexpr double kOther = 1.0;  // code
    for (size_t c = 0; c < components; ++c)
        if (!(std::abs(signedError(values[c], exact.value[c])) <= kOther)) return true;
    return false;
}

}  // namespace

void judgeImage(const RenderedImage& image, const OracleImage& oracle, const OracleImage& exact,
                AccuracyFigures& figures) {
    const SceneFormat& format = *sceneFormat(image.format);
    double sum = 0;
    uint64_t values = 0;
    for (size_t i = 0; i < oracle.pixels.size(); ++i) {
        const OraclePixel& pixel = oracle.pixels[i];
        const std::array<double, 4> got = valuesAt(image, format, i);
        if (!(exact.pixels[i].flags & kOracleUnknown) && pixel.flags & kOracleEdge &&
            isOtherSurface(got, exact.pixels[i], format.componentCount))
            ++figures.misplaced;
        if (pixel.flags & kOracleUnknown) ++figures.undecided;
        if ((pixel.flags & kOracleOpen) != 0) continue;
        ++figures.judged;
        bool inside = true;
        for (size_t c = 0; c < format.componentCount; ++c) {
            const double error = std::abs(signedError(got[c], pixel.value[c]));
            sum += error;
            ++values;
            inside = inside && got[c] >= pixel.low[c] && got[c] <= pixel.high[c];
            if (error <= figures.worst) continue;
            figures.worst = error;
            figures.worstX = static_cast<uint32_t>(i % image.extent.width);
            figures.worstY = static_cast<uint32_t>(i / image.extent.width);
            figures.worstGot = got;
            figures.worstExact = pixel.value;
        }
        if (!inside) ++figures.outside;
    }
    figures.mean = values ? sum / static_cast<double>(values) : 0;
}

void addRound(double milliseconds, AccuracyFigures& figures) {
    figures.rounds.push_back(milliseconds);
    figures.frame = *std::min_element(figures.rounds.begin(), figures.rounds.end());
}

void countCover(const RenderedImage& image, uint32_t cover, AccuracyFigures& figures) {
    const SceneFormat& format = *sceneFormat(image.format);
    const size_t pixels = size_t{image.extent.width} * image.extent.height;
    for (size_t i = 0; i < pixels; ++i) {
        const double count = valuesAt(image, format, i)[0];
        if (!(count >= cover)) ++figures.holes;
        if (count > cover) ++figures.doubles;
    }
}

std::vector<double> signedErrors(const RenderedImage& image, const OracleImage& oracle) {
    const SceneFormat& format = *sceneFormat(image.format);
    std::vector<double> errors(oracle.pixels.size());
    for (size_t i = 0; i < errors.size(); ++i) {
        if ((oracle.pixels[i].flags & kOracleOpen) != 0) continue;
        const std::array<double, 4> got = valuesAt(image, format, i);
        for (size_t c = 0; c < format.componentCount; ++c) {
            const double error = signedError(got[c], oracle.pixels[i].value[c]);
            if (std::abs(error) > std::abs(errors[i])) errors[i] = error;
        }
    }
    return errors;
}

nlohmann::json figuresJson(const AccuracyFigures& figures) {
    if (!figures.failure.empty()) return {{"failure", figures.failure}};
    return {{"frame_ms", figures.frame},
            {"rounds_ms", figures.rounds},
            {"worst_255", figures.worst},
            {"mean_255", figures.mean},
            {"worst_at", {figures.worstX, figures.worstY}},
            {"worst_got", figures.worstGot},
            {"worst_exact", figures.worstExact},
            {"outside", figures.outside},
            {"judged", figures.judged},
            {"undecided", figures.undecided},
            {"misplaced", figures.misplaced},
            {"holes", figures.holes},
            {"doubles", figures.doubles}};
}

Result<AccuracyFigures> figuresFromJson(const nlohmann::json& json) {
    AccuracyFigures figures;
    try {
        if (json.contains("failure")) {
            figures.failure = json.at("failure").get<std::string>();
            return figures;
        }
        // An infinite error is no number in JSON: null.
        const auto number = [](const nlohmann::json& value) {
            return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
        };
        for (const nlohmann::json& round : json.at("rounds_ms")) addRound(round.get<double>(), figures);
        figures.worst = number(json.at("worst_255"));
        figures.mean = number(json.at("mean_255"));
        figures.worstX = json.at("worst_at").at(0).get<uint32_t>();
        figures.worstY = json.at("worst_at").at(1).get<uint32_t>();
        for (size_t c = 0; c < 4; ++c) {
            figures.worstGot[c] = number(json.at("worst_got").at(c));
            figures.worstExact[c] = number(json.at("worst_exact").at(c));
        }
        for (const auto& [name, member] : {std::pair{"outside", &AccuracyFigures::outside},
                                           {"judged", &AccuracyFigures::judged},
                                           {"undecided", &AccuracyFigures::undecided},
                                           {"misplaced", &AccuracyFigures::misplaced},
                                           {"holes", &AccuracyFigures::holes},
                                           {"doubles", &AccuracyFigures::doubles}})
            figures.*member = json.at(name).get<uint64_t>();
    } catch (const nlohmann::json::exception& exception) {
        return invalidArgument(exception.what());
    }
    return figures;
}

}  // namespace vernier::bench
