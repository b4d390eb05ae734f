// Scenes about sampling, and about copying between images.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <cmath>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;

constexpr std::array kAddressModes{VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
                                   VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER};

PipelineRecorder texturedPipeline(SceneRecorder& record, const char* fragmentGlsl = kTexturedFragmentGlsl) {
    return record.pipeline(record.vertex(kTexturedVertexGlsl), record.fragment(fragmentGlsl))
        .binding(sizeof(TexturedVertex))
        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(TexturedVertex, position))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(TexturedVertex, uv));
}

std::vector<TexturedVertex> quad(const TexturedVertex& a, const TexturedVertex& b, const TexturedVertex& c,
                                 const TexturedVertex& d) {
    return {a, b, c, c, b, d};
}

/// The four address modes in four views of a quad whose coordinates leave [0, 1] on all sides.
Result<Scene> addressModes(SceneRecorder record, uint32_t texture, VkFilter filter, VkBorderColor border) {
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t pipeline = texturedPipeline(record);
    // A slightly turned square; the coordinates are odd enough to keep texel borders off pixel centres.
    const uint32_t vertices = record.vertexBuffer(
        "quad", quad({{-0.93f, -0.81f, 0, 1}, {-0.713f, -0.631f}}, {{0.87f, -0.95f, 0, 1}, {1.671f, -0.749f}},
                     {{-0.83f, 0.93f, 0, 1}, {-0.617f, 1.583f}}, {{0.95f, 0.83f, 0, 1}, {1.739f, 1.467f}}));
    record.pass(kSceneExtent).color(target, {0.13f, 0.15f, 0.2f, 1});
    for (uint32_t i = 0; i < kAddressModes.size(); ++i) {
        SceneSampler state;
        state.magFilter = state.minFilter = filter;
        state.addressModeU = kAddressModes[i];
        state.addressModeV = kAddressModes[(i + i / 2) % 4];
        state.borderColor = border;
        state.maxLod = 0;
        record.draw(pipeline, 6)
            .vertices(vertices)
            .texture(0, texture, record.sampler(state))
            .viewport(static_cast<float>(128 * (i % 2)), static_cast<float>(128 * (i / 2)), 128, 128);
    }
    record.output(target);
    return record.finish();
}

constexpr VkImageSubresourceLayers kColorLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

SceneBlitImage spriteBlit(uint32_t sprite, uint32_t target, VkOffset2D from0, VkOffset2D from1, VkOffset2D to0,
                          VkOffset2D to1, VkFilter filter) {
    VkImageBlit region{kColorLayer,
                       {{from0.x, from0.y, 0}, {from1.x, from1.y, 1}},
                       kColorLayer,
                       {{to0.x, to0.y, 0}, {to1.x, to1.y, 1}}};
    return {sprite, target, region, filter};
}

}  // namespace

Result<Scene> texture_nearest() {
    SceneRecorder record("texture_nearest",
                         "A 12 x 12 sprite magnified without filtering under the four address modes.");
    const uint32_t texture = record.texture("sprite", kRgba8, kSpriteExtent, {spritePicture()});
    return addressModes(std::move(record), texture, VK_FILTER_NEAREST, VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK);
}

Result<Scene> texture_bilinear() {
    SceneRecorder record("texture_bilinear",
                         "Random texels, 5 x 7, magnified with a linear filter under the four address modes.");
    const uint32_t texture = record.texture("noise", kRgba8, {5, 7}, {noisePicture({5, 7}, 11)});
    return addressModes(std::move(record), texture, VK_FILTER_LINEAR, VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE);
}

Result<Scene> texture_cubic() {
    SceneRecorder record("texture_cubic",
                         "Random texels, 5 x 7, magnified with a cubic filter under the four address modes.");
    const uint32_t texture = record.texture("noise", kRgba8, {5, 7}, {noisePicture({5, 7}, 11)});
    return addressModes(std::move(record), texture, VK_FILTER_CUBIC_EXT, VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE);
}

Result<Scene> texture_lod() {
    SceneRecorder record("texture_lod",
                         "Explicit levels of detail from -1 to 6 over levels of six colours: nearest level "
                         "above, blended levels "
                         "in the middle, biased and clamped levels below.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const std::array<glm::u8vec4, 6> colors{{{231, 111, 81, 255},
                                             {244, 162, 97, 255},
                                             {233, 196, 106, 255},
                                             {138, 177, 125, 255},
                                             {42, 157, 143, 255},
                                             {38, 70, 83, 255}}};
    std::vector<Bytes> levels;
    for (uint32_t level = 0; level < colors.size(); ++level) {
        const VkExtent2D extent{32u >> level, 32u >> level};
        const glm::u8vec4 dark = colors[level] / glm::u8vec4(2, 2, 2, 1);
        levels.push_back(checkerPicture(extent, std::max(1u, extent.width / 4), colors[level], dark));
    }
    const uint32_t texture = record.texture("levels", kRgba8, {32, 32}, std::move(levels));
    const uint32_t pipeline = texturedPipeline(record, R"(#version 450
layout(binding = 0) uniform sampler2D picture;
layout(location = 0) in vec2 vUv;
layout(location = 0) out vec4 color;
void main() {
    float lod = (gl_FragCoord.x - 36.0) * (1.0 / 32.0);
    color = textureLod(picture, vUv, lod);
}
)");
    const uint32_t vertices =
        record.vertexBuffer("quad", quad({{-1, -1, 0, 1}, {0.013f, 0.017f}}, {{1, -1, 0, 1}, {8.013f, 0.017f}},
                                         {{-1, 1, 0, 1}, {0.013f, 2.517f}}, {{1, 1, 0, 1}, {8.013f, 2.517f}}));
    SceneSampler state;
    state.magFilter = state.minFilter = VK_FILTER_NEAREST;
    std::array<SceneSampler, 3> samplers{state, state, state};
    samplers[1].mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    samplers[1].minFilter = samplers[1].magFilter = VK_FILTER_LINEAR;
    samplers[2].mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    samplers[2].mipLodBias = 1.25f;
    samplers[2].minLod = 1.5f;
    samplers[2].maxLod = 4.25f;
    record.pass(kSceneExtent).color(target, {0.94f, 0.94f, 0.92f, 1});
    for (uint32_t i = 0; i < samplers.size(); ++i) {
        record.draw(pipeline, 6)
            .vertices(vertices)
            .texture(0, texture, record.sampler(samplers[i]))
            .viewport(4, 4 + 84 * static_cast<float>(i), 248, 80);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> texture_trilinear() {
    SceneRecorder record(
        "texture_trilinear",
        "A checkered floor to the horizon through generated mip levels with a trilinear filter, and a wall "
        "that picks the nearest level.");
    const uint32_t texture = record.mipmappedTexture(
        "checker", kRgba8, {128, 128}, checkerPicture({128, 128}, 16, {236, 226, 208, 255}, {62, 76, 110, 255}));
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    SceneSampler state;
    state.magFilter = state.minFilter = VK_FILTER_LINEAR;
    state.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const uint32_t trilinear = record.sampler(state);
    state.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    const uint32_t nearestLevel = record.sampler(state);
    const glm::mat4 camera = cameraMatrix({0.3, 1.0, 3.2}, {-0.4, 0.35, -3}, 60, 1, 0.2, 100);
    const auto at = [&](glm::vec3 position, glm::vec2 uv) {
        return TexturedVertex{camera * glm::vec4(position, 1), uv};
    };
    std::vector<TexturedVertex> vertices = quad(at({-12, 0, 3.1f}, {0, 0}), at({12, 0, 3.1f}, {12, 0}),
                                                at({-12, 0, -32}, {0, 17.5f}), at({12, 0, -32}, {12, 17.5f}));
    const auto wall = quad(at({-2.6f, 1.9f, 1.2f}, {0, 0}), at({-2.0f, 1.9f, -24}, {12, 0}),
                           at({-2.6f, 0, 1.2f}, {0, 1}), at({-2.0f, 0, -24}, {12, 1}));
    vertices.insert(vertices.end(), wall.begin(), wall.end());
    const uint32_t pipeline = texturedPipeline(record);
    const uint32_t buffer = record.vertexBuffer("floor and wall", vertices);
    record.pass(kSceneExtent).color(target, {0.55f, 0.71f, 0.86f, 1});
    record.draw(pipeline, 6).vertices(buffer).texture(0, texture, trilinear);
    record.draw(pipeline, 6).first(6).vertices(buffer).texture(0, texture, nearestLevel);
    record.output(target);
    return record.finish();
}

Result<Scene> copy_and_blit() {
    SceneRecorder record(
        "copy_and_blit",
        "A sprite scaled up by nearest and by linear blits, scaled down, and copied; then copied onward from "
        "the target itself.");
    const uint32_t sprite = record.texture("sprite", kRgba8, kSpriteExtent, {spritePicture()});
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t result = record.colorTarget("result", kRgba8, kSceneExtent);
    record.pass(kSceneExtent).color(target, {0.17f, 0.24f, 0.31f, 1});
    record.pass(kSceneExtent).color(result, {0.86f, 0.92f, 0.94f, 1});
    const auto copy = [&](uint32_t from, uint32_t to, VkOffset3D at, VkOffset3D destination, VkExtent3D extent) {
        record.copy({from, to, {kColorLayer, at, kColorLayer, destination, extent}});
    };
    record.blit(spriteBlit(sprite, target, {0, 0}, {12, 12}, {8, 8}, {116, 116}, VK_FILTER_NEAREST));
    record.blit(spriteBlit(sprite, target, {0, 0}, {12, 12}, {124, 8}, {248, 116}, VK_FILTER_LINEAR));
    record.blit(spriteBlit(sprite, target, {2, 1}, {9, 8}, {8, 124}, {93, 209}, VK_FILTER_NEAREST));
    record.blit(spriteBlit(sprite, target, {2, 1}, {11, 10}, {101, 124}, {248, 209}, VK_FILTER_LINEAR));
    record.blit(spriteBlit(sprite, target, {0, 0}, {12, 12}, {8, 217}, {15, 224}, VK_FILTER_LINEAR));
    for (int i = 0; i < 15; ++i) copy(sprite, target, {0, 0, 0}, {20 + 15 * i, 220 + i, 0}, {12, 12, 1});
    copy(target, result, {0, 0, 0}, {0, 128, 0}, {256, 128, 1});
    copy(target, result, {0, 120, 0}, {0, 0, 0}, {256, 120, 1});
    record.output(result);
    return record.finish();
}

Result<Scene> blit_mirrored() {
    SceneRecorder record("blit_mirrored",
                         "Blits that turn the picture over, across, down and both, nearest and linear.");
    const uint32_t sprite = record.texture("sprite", kRgba8, kSpriteExtent, {spritePicture()});
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    record.pass(kSceneExtent).color(target, {0.17f, 0.24f, 0.31f, 1});
    record.blit(spriteBlit(sprite, target, {12, 0}, {0, 12}, {8, 8}, {121, 121}, VK_FILTER_NEAREST));
    record.blit(spriteBlit(sprite, target, {0, 12}, {12, 0}, {129, 8}, {248, 121}, VK_FILTER_LINEAR));
    record.blit(spriteBlit(sprite, target, {0, 0}, {12, 12}, {121, 248}, {8, 129}, VK_FILTER_LINEAR));
    record.blit(spriteBlit(sprite, target, {11, 2}, {1, 12}, {248, 129}, {129, 248}, VK_FILTER_NEAREST));
    record.output(target);
    return record.finish();
}

Result<Scene> blit_cubic() {
    SceneRecorder record("blit_cubic", "The picture blitted with a cubic filter: larger, turned over, and smaller.");
    const uint32_t sprite = record.texture("sprite", kRgba8, kSpriteExtent, {spritePicture()});
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    record.pass(kSceneExtent).color(target, {0.17f, 0.24f, 0.31f, 1});
    record.blit(spriteBlit(sprite, target, {0, 0}, {12, 12}, {8, 8}, {121, 121}, VK_FILTER_CUBIC_EXT));
    record.blit(spriteBlit(sprite, target, {12, 12}, {0, 0}, {129, 8}, {248, 121}, VK_FILTER_CUBIC_EXT));
    record.blit(spriteBlit(sprite, target, {2, 1}, {9, 11}, {8, 129}, {121, 248}, VK_FILTER_CUBIC_EXT));
    record.blit(spriteBlit(sprite, target, {0, 0}, {12, 12}, {160, 160}, {169, 169}, VK_FILTER_CUBIC_EXT));
    record.output(target);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
