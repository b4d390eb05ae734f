// What lifting saves (ir/lift.h): pairs of shaders, linked without it, with what gives the same bits, and with linear
// expressions too; nanoseconds per pixel, interpolation included, and per vertex. The table of docs/rates.md.
#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/raster/interpolate.h"
#include "spirv_interp/ir/link.h"
#include "spirv_interp/ir/rates.h"
#include "spirv_interp/program.h"

namespace vernier::bench {
namespace {

/// The least time of a call, in nanoseconds: the rest is somebody else's.
double nanosecondsOf(const std::function<void()>& call) {
    using Clock = std::chrono::steady_clock;
    constexpr int kRounds = 60, kCalls = 2000;
    double best = 1e9;
    for (int round = 0; round < kRounds; ++round) {
        const auto begin = Clock::now();
        for (int k = 0; k < kCalls; ++k) call();
        best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / kCalls);
    }
    return best;
}

struct ShaderPair {
    const char *name, *vertex, *fragment;
};

constexpr ShaderPair kPairs[] = {
    {"a constant factor: 2 n, -n",
     "layout(location = 0) in vec3 a; layout(location = 0) out vec3 n; void main() { n = a; gl_Position = vec4(a, 1); "
     "}",
     "layout(location = 0) in vec3 n; layout(location = 0) out vec4 o;"
     "void main() { vec3 m = -2.0 * n; o = vec4(m * m, m.x * m.y); }"},
    {"texture coordinates, scaled and shifted",
     "layout(location = 0) in vec2 a; layout(location = 0) out vec2 t; void main() { t = a; gl_Position = vec4(a, 0, "
     "1); }",
     "layout(location = 0) in vec2 t; layout(location = 0) out vec4 o; layout(set = 0, binding = 0) uniform U { vec4 "
     "u; };"
     "void main() { vec2 s = t * u.xy + u.zw; o = vec4(fract(s), s * s); }"},
    {"two places from one",
     "layout(location = 0) in vec2 a; layout(location = 0) out vec2 t; void main() { t = a; gl_Position = vec4(a, 0, "
     "1); }",
     "layout(location = 0) in vec2 t; layout(location = 0) out vec4 o;"
     "layout(set = 0, binding = 0) uniform U { vec4 u, v; };"
     "void main() { vec2 s = t * u.xy + u.zw, r = t * v.xy + v.zw; o = vec4(s * r, fract(s + t)); }"},
    {"a normal into another space",
     "layout(location = 0) in vec3 a; layout(location = 0) out vec3 n; void main() { n = a; gl_Position = vec4(a, 1); "
     "}",
     "layout(location = 0) in vec3 n; layout(location = 0) out vec4 o; layout(set = 0, binding = 0) uniform U { mat3 "
     "m; };"
     "void main() { vec3 v = normalize(m * n); o = vec4(v * 0.5 + 0.5, 1); }"},
    {"a place in the space of a light",
     "layout(location = 0) in vec3 a; layout(location = 0) out vec3 p; void main() { p = a; gl_Position = vec4(a, 1); "
     "}",
     "layout(location = 0) in vec3 p; layout(location = 0) out vec4 o; layout(set = 0, binding = 0) uniform U { mat4 "
     "m; };"
     "void main() { vec4 v = m * vec4(p, 1); o = vec4(v.xyz / v.w, dot(p, p)); }"},
    {"a material of flat inputs",
     "layout(location = 0) in vec4 a; layout(location = 0) flat out vec4 c; layout(location = 1) out vec3 n;"
     "void main() { c = a; n = a.xyz; gl_Position = a; }",
     "layout(location = 0) flat in vec4 c; layout(location = 1) in vec3 n; layout(location = 0) out vec4 o;"
     "layout(set = 0, binding = 0) uniform U { vec4 u; };"
     "void main() { vec3 k = pow(c.rgb, vec3(2.2)) * u.rgb * c.a; o = vec4(k * n, c.a); }"},
};

std::vector<uint32_t> wordsOf(const std::string& source, VkShaderStageFlagBits stage) {
    const std::string text = "#version 450\n" + source;
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = text.data();
    desc.sourceLength = text.size();
    VnGlslOutput* output = nullptr;
    std::vector<uint32_t> words;
    if (vnCompileGlsl(&desc, &output) == VN_GLSL_SUCCESS)
        words.assign(output->words, output->words + output->wordCount);
    if (words.empty()) std::fprintf(stderr, "%s\n", output != nullptr ? output->log : "no memory");
    vnFreeGlslOutput(output);
    return words;
}

ir::Program loaded(const std::string& source, ir::Stage stage) {
    const std::vector<uint32_t> words =
        wordsOf(source, stage == ir::Stage::vertex ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT);
    ShaderSource from;
    from.words = words;
    from.stage = stage;
    return loadShader(from).value();
}

/// The uniform buffer of a program, whatever it asks for.
struct Bindings {
    Bindings() : contents(64, 0.75f) {
        buffer = {reinterpret_cast<std::byte*>(contents.data()), static_cast<uint32_t>(contents.size() * 4)};
        bindings.buffers = &buffer;
        bindings.base = &base;
        bindings.count = &count;
    }
    std::vector<float> contents;
    BufferBinding buffer;
    uint32_t base = 0, count = 1;
    ResourceBindings bindings;
};

struct Cost {
    double pixel = 0, vertex = 0;
    uint32_t inputs = 0, operations = 0;
};

Cost costOf(const ShaderPair& pair, const ir::LinkOptions& options) {
    ir::Program vertex = loaded(pair.vertex, ir::Stage::vertex), fragment = loaded(pair.fragment, ir::Stage::fragment);
    if (!ir::linkStages(vertex, fragment, nullptr, options).ok()) return {};
    const auto compile = [](const ir::Program& program) {
        BatchOptions batch;
        batch.isa = bestIsa();
        batch.tier = MathTier::fast;
        return BatchProgram::compile(program, batch).value();
    };
    const Bindings bound;
    BatchContext vertices(compile(vertex)), pixels(compile(fragment));
    vertices.beginDraw(bound.bindings);
    pixels.beginDraw(bound.bindings);

    // A triangle over a block of pixels, seen at an angle: 1/w differs.
    std::vector<float> attributes[3];
    for (int v = 0; v < 3; ++v)
        for (size_t k = 0; k < fragment.inputs.size(); ++k)
            attributes[v].push_back(0.25f + 0.125f * static_cast<float>(v + static_cast<int>(k)));
    TrianglePlanes planes{};
    planes.l1x = 0.01f;
    planes.l2y = 0.01f;
    planes.w0 = 1;
    planes.w1 = 0.5f;
    planes.w2 = 0.25f;
    planes.wScale = 1;
    planes.flat = attributes[0].data();
    for (int v = 0; v < 3; ++v) planes.attributes[v] = attributes[v].data();
    const auto batch = std::make_unique<FragmentBatch>();
    batch->order = LaneOrder::rows;
    batch->count = 64;
    batch->segmentCount = 1;
    batch->segments[0] = {&planes, 0, 64};
    std::vector<VaryingTarget> smooth, flat;
    for (uint32_t k = 0; k < fragment.inputs.size(); ++k) {
        const VaryingTarget target{k, pixels.input(k)};
        (fragment.inputs[k].interpolation == ir::Interpolation::flat ? flat : smooth).push_back(target);
    }
    InterpolationInput input{};
    input.batch = batch.get();
    input.capacity = 64;
    input.perspective = !smooth.empty();
    input.smooth = smooth;
    input.flat = flat;
    const InterpolateFn interpolate = interpolateFunction(bestIsa());
    Cost cost;
    cost.pixel = nanosecondsOf([&] {
                     interpolate(input);
                     pixels.run(64, nullptr, nullptr);
                 }) /
                 64;
    cost.vertex = nanosecondsOf([&] { vertices.run(64, nullptr, nullptr); }) / 64;
    cost.inputs = static_cast<uint32_t>(fragment.inputs.size());
    const auto counts = ir::countByRate(fragment);
    for (size_t rate = static_cast<size_t>(ir::Rate::primitive); rate < ir::kRateCount; ++rate)
        cost.operations += counts[rate];
    return cost;
}

int run() {
    std::printf(
        "| Fragment shader | inputs | operations | ns per pixel | with lifting | ratio | ns more per vertex |\n");
    std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const ShaderPair& pair : kPairs) {
        const Cost without = costOf(pair, {.lift = false}), with = costOf(pair, {.lift = true, .liftLinear = true});
        std::printf("| %s | %u -> %u | %u -> %u | %.3f | %.3f | %.2f | %.3f |\n", pair.name, without.inputs,
                    with.inputs, without.operations, with.operations, without.pixel, with.pixel,
                    with.pixel / without.pixel, with.vertex - without.vertex);
    }
    return 0;
}

}  // namespace
}  // namespace vernier::bench

int main() {
    return vernier::bench::run();
}
