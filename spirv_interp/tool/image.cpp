#include "spirv_interp/tool/image.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vernier::tool {
namespace {

/// The texels that a coordinate falls between, and how far it is from the first to the second.
struct Span {
    std::array<int32_t, 2> texel{};
    double fraction = 0;
};

/// Where a place is in an image: a span for each dimension, those beyond the filtered ones of one texel.
using Footprint = std::array<Span, 3>;

int32_t wrapped(int64_t texel, int32_t extent, bool clamp) {
    if (clamp) return static_cast<int32_t>(std::clamp<int64_t>(texel, 0, extent - 1));
    const int64_t rest = texel % extent;
    return static_cast<int32_t>(rest < 0 ? rest + extent : rest);
}

/// Far coordinates and NaN end at texels that integers can hold.
double bounded(double texels) {
    return std::isnan(texels) ? 0 : std::clamp(texels, -0x1p30, 0x1p30);
}

struct FacePlace {
    int32_t face = 0;
    double s = 0, t = 0;
};

/// Vulkan specification, "Cube Map Face Selection" and "Cube Map Coordinate Transformation".
FacePlace onCube(double x, double y, double z) {
    const double ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
    FacePlace place;
    double sc = 0, tc = 0, major = 0;
    if (az >= ax && az >= ay) {
        place.face = z < 0 ? 5 : 4;
        sc = z < 0 ? -x : x;
        tc = -y;
        major = az;
    } else if (ay >= ax) {
        place.face = y < 0 ? 3 : 2;
        sc = x;
        tc = y < 0 ? -z : z;
        major = ay;
    } else {
        place.face = x < 0 ? 1 : 0;
        sc = x < 0 ? z : -z;
        tc = -y;
        major = ax;
    }
    place.s = 0.5 * (sc / major + 1);
    place.t = 0.5 * (tc / major + 1);
    return place;
}

/// Vulkan specification, "Layer Selection" of array images: to the nearest, even at halves, and clamped.
int32_t layerOf(double layer, int32_t layers) {
    return static_cast<int32_t>(std::clamp(std::nearbyint(bounded(layer)), 0.0, layers - 1.0));
}

Footprint footprintOf(const Image& image, const ImageForm& form, const ImagePlace& place, bool linear) {
    std::array<double, 3> at{place.coordinates[0], place.coordinates[1], place.coordinates[2]};
    Footprint footprint{};
    const auto dimensions = static_cast<size_t>(form.dimensions);
    int32_t layer = form.arrayed ? layerOf(place.coordinates[form.cube ? 3 : dimensions],
                                           image.extent[dimensions % 3] / (form.cube ? 6 : 1))
                                 : 0;
    if (form.cube) {
        const FacePlace face = onCube(at[0], at[1], at[2]);
        at = {face.s, face.t, 0};
        layer = layer * 6 + face.face;
    }
    if (dimensions < 3) footprint[dimensions].texel.fill(std::clamp(layer, 0, image.extent[dimensions] - 1));
    for (size_t k = 0; k < dimensions; ++k) {
        const double position = bounded(at[k] * image.extent[k] - (linear ? 0.5 : 0.0));
        const double first = std::floor(position);
        const auto texel = static_cast<int64_t>(first) + place.offset[k];
        footprint[k].texel = {wrapped(texel, image.extent[k], form.cube),
                              wrapped(texel + 1, image.extent[k], form.cube)};
        footprint[k].fraction = linear ? position - first : 0;
    }
    return footprint;
}

size_t indexOf(const Image& image, int32_t x, int32_t y, int32_t z) {
    return static_cast<size_t>((int64_t{z} * image.extent[1] + y) * image.extent[0] + x);
}

/// A component, or what its comparison with dref gives (VK_COMPARE_OP_LESS_OR_EQUAL).
double component(const Words4& texel, size_t k, const std::optional<double>& dref) {
    const auto value = static_cast<double>(std::bit_cast<float>(texel[k]));
    if (!dref) return value;
    return *dref <= value ? 1.0 : 0.0;
}

uint32_t floatBits(double value) {
    return std::bit_cast<uint32_t>(static_cast<float>(value));
}

}  // namespace

Words4 sample(const Image& image, const ImageForm& form, const ImagePlace& place) {
    const Footprint at = footprintOf(image, form, place, image.floating);
    if (!image.floating) return image.texels[indexOf(image, at[0].texel[0], at[1].texel[0], at[2].texel[0])];
    std::array<double, 4> sum{};
    for (size_t corner = 0; corner < 8; ++corner) {
        const std::array<size_t, 3> side{corner & 1, corner >> 1 & 1, corner >> 2};
        double weight = 1;
        for (size_t k = 0; k < 3; ++k) weight *= side[k] != 0 ? at[k].fraction : 1 - at[k].fraction;
        if (weight == 0) continue;
        const Words4& texel =
            image.texels[indexOf(image, at[0].texel[side[0]], at[1].texel[side[1]], at[2].texel[side[2]])];
        for (size_t k = 0; k < 4; ++k) sum[k] += weight * component(texel, k, place.dref);
    }
    return {floatBits(sum[0]), floatBits(sum[1]), floatBits(sum[2]), floatBits(sum[3])};
}

Words4 gather(const Image& image, const ImageForm& form, const ImagePlace& place, uint32_t component) {
    const Footprint at = footprintOf(image, form, place, true);
    constexpr std::array<std::array<size_t, 2>, 4> kOrder{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    Words4 result{};
    for (size_t k = 0; k < 4; ++k) {
        const Words4& texel =
            image.texels[indexOf(image, at[0].texel[kOrder[k][0]], at[1].texel[kOrder[k][1]], at[2].texel[0])];
        result[k] = place.dref ? floatBits(tool::component(texel, 0, place.dref)) : texel[component & 3];
    }
    return result;
}

Words4* texelAt(Image& image, const ImageForm& form, const std::array<int32_t, 4>& texel) {
    std::array<int32_t, 3> at{};
    // Cubes are read and written as arrays of their faces.
    const int32_t coordinates = form.subpass ? 0 : form.dimensions + (form.arrayed || form.cube ? 1 : 0);
    for (int32_t k = 0; k < std::min(coordinates, 3); ++k) at[static_cast<size_t>(k)] = texel[static_cast<size_t>(k)];
    for (size_t k = 0; k < 3; ++k)
        if (at[k] < 0 || at[k] >= image.extent[k]) return nullptr;
    return &image.texels[indexOf(image, at[0], at[1], at[2])];
}

std::array<int32_t, 4> querySize(const Image& image, const ImageForm& form) {
    std::array<int32_t, 4> size{image.extent[0], image.extent[1], image.extent[2], 0};
    const auto dimensions = static_cast<size_t>(form.dimensions);
    if (form.cube) size[2] /= 6;
    for (size_t k = dimensions + (form.arrayed ? 1 : 0); k < 3; ++k) size[k] = 0;
    return size;
}

}  // namespace vernier::tool
