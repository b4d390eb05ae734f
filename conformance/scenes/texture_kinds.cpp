// Scenes about the kinds of textures and filters beyond the plain 2D image: anisotropy, cubes, volumes, lines, borders,
// minima and maxima, compressed blocks.
#include "conformance/scene/scene_format.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;

Bytes randomBytes(size_t count, uint64_t seed) {
    SceneRandom random(seed);
    Bytes bytes(count);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.next() >> 13);
    return bytes;
}

/// A fragment shader with one texture at binding 0; `body` sets `color`.
std::string lookup(const std::string& type, const std::string& body) {
    return "#version 450\nlayout(binding = 0) uniform " + type +
           " picture;\nlayout(location = 0) out vec4 color;\nvoid main() {\n" + body + "\n}\n";
}

/// One scene of one full-screen lookup, of pixels at gl_FragCoord.
Result<Scene> fullScreen(SceneRecorder record, uint32_t texture, const SceneSampler& sampler, const std::string& glsl) {
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(glsl));
    record.pass(kSceneExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 3).texture(0, texture, record.sampler(sampler));
    record.output(target);
    return record.finish();
}

SceneSampler linearSampler(VkSamplerAddressMode mode) {
    SceneSampler sampler;
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = mode;
    return sampler;
}

/// Blocks of BC1 colours for an RGBA8 picture whose sides are multiples of 4: end points at the corners of each block's
/// box of colours, each texel the nearest of the four.
Bytes encodeBc1(const Bytes& picture, VkExtent2D extent) {
    Bytes blocks;
    const auto texel = [&](uint32_t x, uint32_t y, uint32_t c) {
        return std::to_integer<int>(picture[(size_t{y} * extent.width + x) * 4 + c]);
    };
    for (uint32_t by = 0; by < extent.height; by += 4) {
        for (uint32_t bx = 0; bx < extent.width; bx += 4) {
            int low[3] = {255, 255, 255}, high[3] = {};
            for (uint32_t i = 0; i < 16; ++i) {
                for (uint32_t c = 0; c < 3; ++c) {
                    low[c] = std::min(low[c], texel(bx + i % 4, by + i / 4, c));
                    high[c] = std::max(high[c], texel(bx + i % 4, by + i / 4, c));
                }
            }
            const auto packed = [](const int(&rgb)[3]) {
                return static_cast<uint32_t>(rgb[0] >> 3 << 11 | rgb[1] >> 2 << 5 | rgb[2] >> 3);
            };
            const uint32_t ends[2] = {packed(high), packed(low)};
            uint32_t codes = 0;
            for (uint32_t i = 0; i < 16 && ends[0] != ends[1]; ++i) {
                int along = 0, length = 0;
                for (uint32_t c = 0; c < 3; ++c) {
                    along += (high[c] - texel(bx + i % 4, by + i / 4, c)) * (high[c] - low[c]);
                    length += (high[c] - low[c]) * (high[c] - low[c]);
                }
                constexpr uint32_t kCodes[4] = {0, 2, 3, 1};  // from the high end to the low one
                codes |= kCodes[std::clamp((along * 3 + length / 2) / std::max(length, 1), 0, 3)] << 2 * i;
            }
            for (const uint32_t word : {ends[0] | ends[1] << 16, codes}) {
                for (int i = 0; i < 4; ++i) blocks.push_back(static_cast<std::byte>(word >> 8 * i));
            }
        }
    }
    return blocks;
}

/// A sheet of random blocks: a cell of the grid per format, texel by texel; wide values folded into 0 .. 1.
Result<Scene> blockSheet(SceneRecorder record, const std::vector<VkFormat>& formats, uint32_t columns, uint32_t cell,
                         uint32_t first, PipelineRecorder pipeline, uint32_t target) {
    SceneSampler nearest;
    nearest.maxLod = 0;
    const uint32_t sampler = record.sampler(nearest);
    for (uint32_t i = 0; i < formats.size(); ++i) {
        const SceneFormat& format = *sceneFormat(formats[i]);
        const uint32_t texture = record.texture(format.name, formats[i], {cell, cell},
                                                {randomBytes(format.imageBytes(cell, cell), 100 + i)});
        const uint32_t place = first + i;
        record.draw(pipeline, 3)
            .texture(0, texture, sampler)
            .viewport(static_cast<float>(place % columns * (cell + 1)),
                      static_cast<float>(place / columns * (cell + 1)), static_cast<float>(cell),
                      static_cast<float>(cell))
            .push(std::array<float, 2>{static_cast<float>(place % columns * (cell + 1)),
                                       static_cast<float>(place / columns * (cell + 1))});
    }
    record.output(target);
    return record.finish();
}

const char* const kSheetGlsl = R"(#version 450
layout(binding = 0) uniform sampler2D picture;
layout(push_constant) uniform Place { vec2 corner; };
layout(location = 0) out vec4 color;
void main() {
    vec4 texel = texelFetch(picture, ivec2(gl_FragCoord.xy - corner), 0);
    vec3 folded = abs(texel.rgb) / (vec3(1.0) + max(abs(texel.rgb) - vec3(1.0), vec3(0.0)) * 1.001);
    color = vec4(mix(vec3(0.25), folded, 0.25 + 0.75 * texel.a), 1.0);
}
)";

}  // namespace

Result<Scene> texture_anisotropic() {
    SceneRecorder record(
        "texture_anisotropic",
        "A checkered floor to the horizon through a 16 : 1 anisotropic filter on the left and a trilinear "
        "one on the right, and a wall through a 4 : 1 filter.");
    const uint32_t texture = record.mipmappedTexture(
        "checker", kRgba8, {128, 128}, checkerPicture({128, 128}, 16, {236, 226, 208, 255}, {62, 76, 110, 255}));
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    SceneSampler state = linearSampler(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    state.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const uint32_t trilinear = record.sampler(state);
    state.maxAnisotropy = 16;
    const uint32_t sixteen = record.sampler(state);
    state.maxAnisotropy = 4;
    const uint32_t four = record.sampler(state);
    const glm::mat4 camera = cameraMatrix({0.1, 1.0, 3.2}, {-0.1, 0.35, -3}, 60, 1, 0.2, 100);
    const auto at = [&](glm::vec3 position, glm::vec2 uv) {
        return TexturedVertex{camera * glm::vec4(position, 1), uv};
    };
    const std::vector<TexturedVertex> vertices{
        at({-12, 0, 3.1f}, {0, 0}),         at({12, 0, 3.1f}, {12, 0}),         at({-12, 0, -32}, {0, 17.5f}),
        at({12, 0, -32}, {12, 17.5f}),      at({-3.6f, 1.9f, 1.2f}, {0, 0}),    at({-1.2f, 1.9f, -28}, {14, 0}),
        at({-3.6f, 0.1f, 1.2f}, {0, 0.9f}), at({-1.2f, 0.1f, -28}, {14, 0.9f}),
    };
    const uint32_t buffer = record.vertexBuffer("floor and wall", vertices);
    const uint32_t pipeline =
        record.pipeline(record.vertex(kTexturedVertexGlsl), record.fragment(kTexturedFragmentGlsl))
            .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP)
            .binding(sizeof(TexturedVertex))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(TexturedVertex, position))
            .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(TexturedVertex, uv));
    record.pass(kSceneExtent).color(target, {0.55f, 0.71f, 0.86f, 1});
    record.draw(pipeline, 4).vertices(buffer).texture(0, texture, sixteen).scissor(0, 0, 128, 256);
    record.draw(pipeline, 4).vertices(buffer).texture(0, texture, trilinear).scissor(128, 0, 128, 256);
    record.draw(pipeline, 4).first(4).vertices(buffer).texture(0, texture, four);
    record.output(target);
    return record.finish();
}

Result<Scene> cube_seams() {
    SceneRecorder record(
        "cube_seams",
        "A cube map of 4 x 4 texels a face from inside, towards a corner: edges and the corner are filtered "
        "without seams.");
    SceneImage image;
    image.name = "cube";
    image.extent = {4, 4};
    image.arrayLayers = 6;
    image.viewType = VK_IMAGE_VIEW_TYPE_CUBE;
    for (uint32_t face = 0; face < 6; ++face) image.data.push_back(noisePicture({4, 4}, 40 + face));
    const uint32_t texture = record.texture(std::move(image));
    return fullScreen(std::move(record), texture, linearSampler(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE),
                      lookup("samplerCube", R"(
    vec2 p = (gl_FragCoord.xy - 128.0) / 96.0;
    vec3 direction = vec3(1.0, 1.02, 0.98) + p.x * vec3(0.7071, -0.7071, 0.0) + p.y * vec3(0.4082, 0.4082, -0.8165);
    color = textureLod(picture, direction, 0.0);)"));
}

Result<Scene> texture_volume() {
    SceneRecorder record("texture_volume",
                         "A 3D texture of 6 x 5 x 7 random texels, cut along a slanted plane, with a linear filter.");
    SceneImage image;
    image.name = "volume";
    image.extent = {6, 5};
    image.depth = 7;
    image.viewType = VK_IMAGE_VIEW_TYPE_3D;
    image.data = {noisePicture({6, 35}, 51)};
    const uint32_t texture = record.texture(std::move(image));
    SceneSampler sampler = linearSampler(VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT);
    sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    return fullScreen(std::move(record), texture, sampler, lookup("sampler3D", R"(
    vec2 p = gl_FragCoord.xy / 256.0;
    color = textureLod(picture, vec3(p * 1.31, dot(p, vec2(0.83, 0.57)) + 0.011), 0.0);)"));
}

Result<Scene> texture_lines() {
    SceneRecorder record("texture_lines", "A 1D array of seven palettes of nine colours, one above the other.");
    SceneImage image;
    image.name = "palettes";
    image.extent = {9, 1};
    image.arrayLayers = 7;
    image.viewType = VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    for (uint32_t layer = 0; layer < 7; ++layer) image.data.push_back(noisePicture({9, 1}, 60 + layer));
    const uint32_t texture = record.texture(std::move(image));
    return fullScreen(std::move(record), texture, linearSampler(VK_SAMPLER_ADDRESS_MODE_REPEAT),
                      lookup("sampler1DArray", R"(
    color = textureLod(picture, vec2(gl_FragCoord.x / 173.0 - 0.2, floor(gl_FragCoord.y / 37.0)), 0.0);)"));
}

Result<Scene> border_custom() {
    SceneRecorder record("border_custom", "A picture of 5 x 7 texels inside a border of a colour of its own.");
    const uint32_t texture = record.texture("noise", kRgba8, {5, 7}, {noisePicture({5, 7}, 11)});
    SceneSampler sampler = linearSampler(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER);
    sampler.borderColor = VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
    sampler.customBorderColor = {0.9f, 0.45f, 0.1f, 0.75f};
    return fullScreen(std::move(record), texture, sampler, lookup("sampler2D", R"(
    color = textureLod(picture, gl_FragCoord.xy / 151.0 - 0.33, 0.0);)"));
}

Result<Scene> texture_extremes() {
    SceneRecorder record("texture_extremes",
                         "Random texels, 7 x 7, through the minimum, the average and the maximum of a linear filter.");
    const uint32_t texture = record.texture("noise", kRgba8, {7, 7}, {noisePicture({7, 7}, 12)});
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(lookup("sampler2D", R"(
    color = textureLod(picture, gl_FragCoord.xy / 211.0 + 0.003, 0.0);)")));
    record.pass(kSceneExtent).color(target, {0, 0, 0, 1});
    SceneSampler sampler = linearSampler(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    constexpr VkSamplerReductionMode kModes[3] = {
        VK_SAMPLER_REDUCTION_MODE_MIN, VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE, VK_SAMPLER_REDUCTION_MODE_MAX};
    for (int i = 0; i < 3; ++i) {
        sampler.reduction = kModes[i];
        record.draw(pipeline, 3).texture(0, texture, record.sampler(sampler)).scissor(0, 86 * i, 256, 84);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> blocks_bc() {
    SceneRecorder record(
        "blocks_bc",
        "Random blocks of BC1 to BC7, a cell for each format, and a picture in BC1 blocks with a linear filter.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const PipelineRecorder sheet =
        record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(kSheetGlsl)).pushConstants(8);
    const uint32_t plain = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(lookup("sampler2D", R"(
    color = textureLod(picture, (gl_FragCoord.xy - vec2(63.0, 189.0)) / vec2(188.0, 63.0), 0.0);)")));
    const Bytes picture = checkerPicture({64, 32}, 6, {231, 111, 81, 255}, {38, 70, 150, 255});
    const uint32_t texture =
        record.texture("picture", VK_FORMAT_BC1_RGB_UNORM_BLOCK, {64, 32}, {encodeBc1(picture, {64, 32})});
    record.pass(kSceneExtent).color(target, {0.1f, 0.1f, 0.1f, 1});
    record.draw(plain, 3).texture(0, texture, record.sampler(VK_FILTER_LINEAR)).viewport(63, 189, 188, 63);
    return blockSheet(
        std::move(record),
        {VK_FORMAT_BC1_RGB_UNORM_BLOCK, VK_FORMAT_BC1_RGBA_UNORM_BLOCK, VK_FORMAT_BC2_UNORM_BLOCK,
         VK_FORMAT_BC3_UNORM_BLOCK, VK_FORMAT_BC3_SRGB_BLOCK, VK_FORMAT_BC4_UNORM_BLOCK, VK_FORMAT_BC4_SNORM_BLOCK,
         VK_FORMAT_BC5_UNORM_BLOCK, VK_FORMAT_BC5_SNORM_BLOCK, VK_FORMAT_BC6H_UFLOAT_BLOCK, VK_FORMAT_BC6H_SFLOAT_BLOCK,
         VK_FORMAT_BC7_UNORM_BLOCK, VK_FORMAT_BC7_SRGB_BLOCK},
        4, 62, 0, sheet, target);
}

Result<Scene> blocks_etc2() {
    SceneRecorder record("blocks_etc2", "Random blocks of ETC2 and EAC, a cell for each format.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const PipelineRecorder sheet =
        record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(kSheetGlsl)).pushConstants(8);
    record.pass(kSceneExtent).color(target, {0.1f, 0.1f, 0.1f, 1});
    return blockSheet(
        std::move(record),
        {VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK, VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK,
         VK_FORMAT_EAC_R11_UNORM_BLOCK, VK_FORMAT_EAC_R11G11_UNORM_BLOCK},
        3, 84, 0, sheet, target);
}

Result<Scene> blocks_astc() {
    SceneRecorder record("blocks_astc",
                         "Random blocks of ASTC with its fourteen footprints; what is no valid block is magenta.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const PipelineRecorder sheet =
        record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(kSheetGlsl)).pushConstants(8);
    record.pass(kSceneExtent).color(target, {0.1f, 0.1f, 0.1f, 1});
    std::vector<VkFormat> formats;
    for (uint32_t i = 0; i < 14; ++i) {
        formats.push_back(static_cast<VkFormat>(VK_FORMAT_ASTC_4x4_UNORM_BLOCK + 2 * i));
    }
    return blockSheet(std::move(record), formats, 4, 62, 0, sheet, target);
}

}  // namespace vernier::conformance::scenes
