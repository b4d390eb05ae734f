#include "runtime/format/multi_planar.h"

#include <algorithm>

namespace vernier {
namespace {

// X(name, planes, format of plane 0, of planes 1 and 2, divisors of width and height, bits)
#define VERNIER_MULTI_PLANAR(X)                                          \
    X(G8_B8_R8_3PLANE_420_UNORM, 3, R8_UNORM, R8_UNORM, 2, 2, 8)         \
    X(G8_B8R8_2PLANE_420_UNORM, 2, R8_UNORM, R8G8_UNORM, 2, 2, 8)        \
    X(G8_B8_R8_3PLANE_422_UNORM, 3, R8_UNORM, R8_UNORM, 2, 1, 8)         \
    X(G8_B8R8_2PLANE_422_UNORM, 2, R8_UNORM, R8G8_UNORM, 2, 1, 8)        \
    X(G8_B8_R8_3PLANE_444_UNORM, 3, R8_UNORM, R8_UNORM, 1, 1, 8)         \
    X(G16_B16_R16_3PLANE_420_UNORM, 3, R16_UNORM, R16_UNORM, 2, 2, 16)   \
    X(G16_B16R16_2PLANE_420_UNORM, 2, R16_UNORM, R16G16_UNORM, 2, 2, 16) \
    X(G16_B16_R16_3PLANE_422_UNORM, 3, R16_UNORM, R16_UNORM, 2, 1, 16)   \
    X(G16_B16R16_2PLANE_422_UNORM, 2, R16_UNORM, R16G16_UNORM, 2, 1, 16) \
    X(G16_B16_R16_3PLANE_444_UNORM, 3, R16_UNORM, R16_UNORM, 1, 1, 16)

constexpr MultiPlanarFormat kFormats[] = {
#define VERNIER_MULTI_PLANAR_ROW(NAME, COUNT, LUMA, CHROMA, WIDTH, HEIGHT, BITS)                    \
    {VK_FORMAT_##NAME,                                                                              \
     #NAME,                                                                                         \
     COUNT,                                                                                         \
     {VK_FORMAT_##LUMA, VK_FORMAT_##CHROMA, COUNT == 3 ? VK_FORMAT_##CHROMA : VK_FORMAT_UNDEFINED}, \
     WIDTH,                                                                                         \
     HEIGHT,                                                                                        \
     BITS},
    VERNIER_MULTI_PLANAR(VERNIER_MULTI_PLANAR_ROW)
#undef VERNIER_MULTI_PLANAR_ROW
};

}  // namespace

const MultiPlanarFormat* findMultiPlanar(VkFormat format) {
    const auto* found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                     [format](const MultiPlanarFormat& one) { return one.format == format; });
    return found != std::end(kFormats) ? found : nullptr;
}

std::span<const MultiPlanarFormat> multiPlanarFormats() {
    return kFormats;
}

}  // namespace vernier
