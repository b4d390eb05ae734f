#include "conformance/hardcases/texture_input.h"

#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <random>

namespace vernier::conformance::hardcases {

Result<Scene> textureScene(std::string_view name, const TextureTable& table) {
    const VkExtent2D extent = extentOf(table);
    SceneRecorder record(name, "Lookups at coordinates from a table.");
    SceneImage image;
    image.name = "picture";
    image.format = table.format;
    image.extent = table.extent;
    image.mipLevels = static_cast<uint32_t>(table.levels.size()) / table.layers;
    image.arrayLayers = table.layers;
    image.viewType = table.viewType;
    image.data = table.levels;
    const uint32_t picture = record.texture(std::move(image));
    const uint32_t coordinates =
        record.texture("coordinates", VK_FORMAT_R32G32B32A32_SFLOAT, extent, {bytesOf(table.coordinates)});
    const uint32_t target = record.colorTarget("color", table.target, extent);
    const std::string glsl = "#version 450\nlayout(binding = 0) uniform " + table.type +
                             " picture;\nlayout(binding = 1) uniform sampler2D coordinates;\n"
                             "layout(location = 0) out vec4 color;\nvoid main() {\n"
                             "    vec4 c = texelFetch(coordinates, ivec2(gl_FragCoord.xy), 0);\n    color = " +
                             table.expression + ";\n}\n";
    record.pass(extent).color(target, {0, 0, 0, 0});
    record.draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(glsl)), 3)
        .texture(0, picture, record.sampler(table.sampler))
        .texture(1, coordinates, record.sampler(VK_FILTER_NEAREST));
    record.output(target);
    return record.finish();
}

SceneSampler filtered(VkFilter filter, VkSamplerAddressMode address) {
    SceneSampler sampler;
    sampler.magFilter = sampler.minFilter = filter;
    sampler.mipmapMode = filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    sampler.addressModeU = sampler.addressModeV = address;
    return sampler;
}

Bytes someTexels(VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    Bytes bytes(size_t{extent.width} * extent.height * 4);
    for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 255);
    return bytes;
}

}  // namespace vernier::conformance::hardcases
