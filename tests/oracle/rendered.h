// Images made from the oracle's own answers, for testing the checks without a driver.
#pragma once

#include "conformance/oracle/encode.h"
#include "conformance/oracle/oracle.h"
#include "conformance/oracle/quantise.h"

namespace vernier::conformance {

/// The oracle's nominal values as a driver would hand them back: each in its nearest code.
inline RenderedImage renderedFrom(const OracleImage& image) {
    const exact::PixelFormat& format = *exact::findPixelFormat(image.format);
    RenderedImage result{image.format, image.extent, Bytes(image.pixels.size() * format.bytes)};
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        for (const exact::Component& c : format.all()) {
            const double value = image.pixels[i].value[c.channel];
            const uint64_t code = exact::encode(c, exact::rational(value)).nearest;
            exact::insertBits(result.texels.data() + i * format.bytes, c.offset, c.bits, code);
        }
    }
    return result;
}

/// What comparing an image with the oracle's ranges comes to.
struct Comparison {
    size_t outside = 0;  // pixels with a channel outside low..high
    size_t edges = 0, unknown = 0;
};

inline Comparison compareWithOracle(const OracleImage& oracle, const RenderedImage& image) {
    const exact::PixelFormat& format = *exact::findPixelFormat(image.format);
    Comparison result;
    for (size_t i = 0; i < oracle.pixels.size(); ++i) {
        const OraclePixel& p = oracle.pixels[i];
        result.edges += (p.flags & kOracleEdge) != 0;
        result.unknown += (p.flags & kOracleUnknown) != 0;
        const auto texel = exact::decodeTexel(format, image.texels.data() + i * format.bytes);
        bool inside = true;
        for (const exact::Component& c : format.all()) {
            const double v = texel[c.channel], slack = 1e-7 * (1 + std::abs(v));
            inside = inside && v >= p.low[c.channel] - slack && v <= p.high[c.channel] + slack;
        }
        result.outside += !inside && !(p.flags & kOracleUnknown);
    }
    return result;
}

}  // namespace vernier::conformance
