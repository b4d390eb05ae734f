// The images of an invocation, and what image instructions find in them. Both engines ask here, with coordinates in
// double, so that they can be compared.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vernier::tool {

using Words4 = std::array<uint32_t, 4>;

/// One level of texels of four 32-bit components, x first, then y, then z. Layers come after the last dimension; of a
/// cube these are its faces, six for each cube of an array.
struct Image {
    std::array<int32_t, 3> extent{1, 1, 1};
    bool floating = true;  // components are floats, else integers
    std::vector<Words4> texels;
};

/// What an image's type says of its coordinates.
struct ImageForm {
    int32_t dimensions = 2;  // 1 to 3 that are filtered over; those of a face for cubes
    bool cube = false, arrayed = false;
    bool subpass = false;  // read at the first texel, wherever the fragment is
};

/// Coordinates as the instruction has them: a cube's direction first, the layer last.
struct ImagePlace {
    std::array<double, 4> coordinates{};
    std::array<int32_t, 3> offset{};
    std::optional<double> dref;
};

/// A texel's coordinate with an offset added, modulo 2^32.
inline int32_t moved(int32_t texel, int32_t offset) {
    return static_cast<int32_t>(static_cast<uint32_t>(texel) + static_cast<uint32_t>(offset));
}

/// Sampled linearly and repeated (nearest for integers; faces of cubes clamped); with dref, 1 for texels not below it.
Words4 sample(const Image& image, const ImageForm& form, const ImagePlace& place);

/// The footprint's component in the order of the specification, "Texel Gathering".
Words4 gather(const Image& image, const ImageForm& form, const ImagePlace& place, uint32_t component);

/// The texel of a fetch, read, write or atomic; nullptr outside the image.
Words4* texelAt(Image& image, const ImageForm& form, const std::array<int32_t, 4>& texel);

/// Sizes in the order of the coordinates, then layers, or cubes.
std::array<int32_t, 4> querySize(const Image& image, const ImageForm& form);

}  // namespace vernier::tool
