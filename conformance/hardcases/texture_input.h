// Texture cases: lookups at coordinates from a table.
#pragma once

#include "conformance/hardcases/hard_case.h"

#include <array>
#include <string>
#include <vector>

namespace vernier::conformance::hardcases {

struct TextureTable {
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkExtent2D extent{};
    std::vector<Bytes>
        levels;  // level 0 has `extent`, each next one half of it; of layers: levels[mip * layers + layer]
    uint32_t layers = 1;
    VkImageViewType viewType = VK_IMAGE_VIEW_TYPE_MAX_ENUM;  // as in SceneImage
    SceneSampler sampler;
    std::vector<std::array<float, 4>> coordinates;              // one pixel each
    std::string expression = "textureLod(picture, c.xy, c.z)";  // a vec4 of `picture` and the coordinates `c`
    std::string type = "sampler2D";
    VkFormat target = VK_FORMAT_R32G32B32A32_SFLOAT;
};

/// Draws one row of pixels.
Result<Scene> textureScene(std::string_view name, const TextureTable& table);

inline VkExtent2D extentOf(const TextureTable& table) {
    return {static_cast<uint32_t>(table.coordinates.size()), 1};
}

/// A sampler with one filter for everything, one address mode, and all levels.
SceneSampler filtered(VkFilter filter, VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);

/// Texels of four bytes that differ in every channel.
Bytes someTexels(VkExtent2D extent, uint32_t seed);

}  // namespace vernier::conformance::hardcases
