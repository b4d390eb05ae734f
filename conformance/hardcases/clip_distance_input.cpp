#include "conformance/hardcases/clip_distance_input.h"

#include "conformance/scenes/recorder.h"

namespace vernier::conformance::hardcases {
namespace {

std::string vertexGlsl(DistanceKind kind, uint32_t distances) {
    const std::string array = kind == DistanceKind::clip ? "gl_ClipDistance" : "gl_CullDistance";
    std::string glsl =
        "#version 450\nlayout(location = 0) in vec4 position;\nlayout(location = 1) in vec4 first;\n"
        "layout(location = 2) in vec4 second;\nout gl_PerVertex {\n    vec4 gl_Position;\n    float " +
        array + "[" + std::to_string(distances) + "];\n};\nvoid main() {\n    gl_Position = position;\n";
    for (uint32_t i = 0; i < distances; ++i) {
        glsl += "    " + array + "[" + std::to_string(i) + "] = " + (i < 4 ? "first[" : "second[") +
                std::to_string(i % 4) + "];\n";
    }
    return glsl + "}\n";
}

}  // namespace

Result<Scene> distanceScene(std::string_view name, const std::vector<DistanceVertex>& vertices, DistanceKind kind,
                            uint32_t distances, VkExtent2D extent) {
    SceneRecorder record(name, "Coverage counts with clip or cull distances.");
    const uint32_t target = record.colorTarget("counts", VK_FORMAT_R8G8B8A8_UNORM, extent);
    const uint32_t buffer = record.vertexBuffer("vertices", vertices);
    const uint32_t pipeline =
        record.pipeline(record.vertex(vertexGlsl(kind, distances)), record.fragment(kCountFragmentGlsl))
            .binding(sizeof(DistanceVertex))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition) * 2)
            .blend(countingBlend());
    record.pass(extent).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(buffer);
    record.output(target);
    return record.finish();
}

}  // namespace vernier::conformance::hardcases
