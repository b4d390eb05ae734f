// Scenes whose fragment shaders are those of the compute kernels: bench/compute/kernels.
#include <array>

#include "bench/compute/kernel.h"
#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/full_screen.h"
#include "conformance/scenes/recorder.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr VkExtent2D kExtent{512, 384};

Result<Scene> procedural(const char* name, const char* description, std::string_view file, bool withParameters) {
    const std::array<std::string_view, 2> files{file, "image.frag"};
    const Result<std::string> source = readKernelSource(files);
    if (!source) return source.error();
    SceneRecorder record(name, description);
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
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

namespace speed {

Result<Scene> raymarch_fragment() {
    return procedural("raymarch_fragment", "A field of shapes, sphere-traced.", "raymarch.glsl", false);
}

Result<Scene> noise_fragment() {
    return procedural("noise_fragment", "Six octaves of gradient noise.", "noise.glsl", false);
}

Result<Scene> uniform_fragment() {
    return procedural("uniform_fragment", "Nearly all arithmetic is the same for all pixels.", "uniform.glsl", true);
}

}  // namespace speed
}  // namespace vernier::bench
