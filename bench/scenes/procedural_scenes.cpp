// Scenes whose fragment shaders are those of the compute kernels: bench/compute/kernels.
#include <array>

#include "bench/compute/kernel.h"
#include "bench/scenes/bench_scenes.h"
#include "conformance/scenes/recorder.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr VkExtent2D kExtent{512, 384};

constexpr const char* kQuadVertex = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(uv * 2.0 - 1.0, 0.5, 1.0);
})";

Result<Scene> procedural(const char* name, const char* description, std::string_view file, bool withParameters) {
    const std::array<std::string_view, 2> files{file, "image.frag"};
    const Result<std::string> source = readKernelSource(files);
    if (!source) return source.error();
    SceneRecorder record(name, description);
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
    PipelineRecorder pipeline = record.pipeline(record.vertex(kQuadVertex), record.fragment(*source));
    pipeline.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    if (withParameters) pipeline.pushConstants(sizeof uniformParameters());
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    DrawRecorder draw = record.draw(pipeline, 4);
    if (withParameters) draw.push(uniformParameters());
    record.output(target);
    return record.finish();
}

}  // namespace

Result<Scene> raymarchScene() {
    return procedural("raymarch_fragment", "A field of shapes, sphere-traced.", "raymarch.glsl", false);
}

Result<Scene> noiseScene() {
    return procedural("noise_fragment", "Six octaves of gradient noise.", "noise.glsl", false);
}

Result<Scene> uniformScene() {
    return procedural("uniform_fragment", "Nearly all arithmetic is the same for all pixels.", "uniform.glsl", true);
}

}  // namespace vernier::bench
