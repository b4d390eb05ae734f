// Scenes of 16 x 16 pixels from a few vertices, for tests of the whole-scene oracle.
#pragma once

#include "conformance/oracle/oracle.h"
#include "conformance/scenes/recorder.h"
#include "tests/oracle/rendered.h"

#include <gtest/gtest.h>

#include <functional>

namespace vernier::conformance::small_scene {

struct Vertex {
    std::array<float, 4> position;
    std::array<float, 4> color;
};

inline const char* const kVertex = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 smoothColor;
layout(location = 1) flat out vec4 flatColor;
void main() {
    gl_Position = position;
    smoothColor = color;
    flatColor = color;
}
)";
inline const char* const kSmooth = R"(#version 450
layout(location = 0) in vec4 smoothColor;
layout(location = 0) out vec4 color;
void main() { color = smoothColor; }
)";
inline const char* const kFlat = R"(#version 450
layout(location = 1) flat in vec4 flatColor;
layout(location = 0) out vec4 color;
void main() { color = flatColor; }
)";

/// Position in pixels of a 16 x 16 target.
inline Vertex vertex(float x, float y, std::array<float, 4> color, float z = 0.5f) {
    return {{x / 8 - 1, y / 8 - 1, z, 1}, color};
}

inline constexpr std::array<float, 4> kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1}, kBlue{0, 0, 1, 1};
inline constexpr VkExtent2D kExtent{16, 16};

/// Two triangles that cover all that is left of x.
inline std::vector<Vertex> leftOf(float x, std::array<float, 4> color = kRed) {
    return {vertex(-8, -8, color), vertex(x, -8, color), vertex(x, 40, color),
            vertex(-8, -8, color), vertex(x, 40, color), vertex(-8, 40, color)};
}

using Configure = std::function<void(Scene&)>;

inline Scene drawScene(const std::vector<Vertex>& vertices, const char* fragment, const Configure& configure = {}) {
    SceneRecorder record("test", "");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
    const uint32_t buffer = record.vertexBuffer("vertices", vertices);
    const uint32_t pipeline = record.pipeline(record.vertex(kVertex), record.fragment(fragment))
                                  .binding(sizeof(Vertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 16);
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(buffer);
    record.output(target);
    auto scene = record.finish();
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    if (configure) configure(*scene);
    return *scene;
}

inline OracleImage render(const Scene& scene) {
    auto images = renderOracle(scene);
    EXPECT_TRUE(images.ok()) << (images.ok() ? "" : images.error().message);
    return images.ok() ? images->front() : OracleImage{};
}

inline const OraclePixel& at(const OracleImage& image, uint32_t x, uint32_t y) {
    return image.pixels[y * image.extent.width + x];
}

inline ScenePass& passOf(Scene& scene) {
    return std::get<ScenePass>(scene.steps.back());
}

// Ranges are kept per channel: where two colours are permitted, so are their channel-wise mixtures. Faults
// are therefore placed where one colour is.
//
// A faulty rendering is the nominal rendering of a changed scene, judged by the oracle of the right one.
inline Comparison judge(const Scene& right, const Scene& rendered) {
    return compareWithOracle(render(right), renderedFrom(render(rendered)));
}

}  // namespace vernier::conformance::small_scene
