// What the creation of a pipeline is made of: every step from words to a compiled program, over the shaders of the
// compute kernels. `words` counts SPIR-V words.
#include <benchmark/benchmark.h>
#include <vernier/vernier_glsl.h>

#include <cstdio>
#include <cstdlib>

#include "bench/compute/kernel.h"
#include "runtime/plan/compute_pipeline.h"
#include "spirv_interp/front/lower_module.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/verify.h"

namespace vernier::bench {
namespace {

struct Shader {
    std::string name;
    std::vector<uint32_t> words;
};

template <class T>
T orExit(Result<T> result) {
    if (result) return std::move(result).value();
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::exit(2);
}

std::vector<Shader> kernelShaders() {
    std::vector<Shader> shaders;
    for (const Kernel& kernel : kernels())
        for (const KernelPass& pass : kernel.passes) {
            const std::string source = orExit(readKernelSource(pass.files));
            VnGlslDesc desc{};
            desc.stage = VK_SHADER_STAGE_COMPUTE_BIT;
            desc.source = source.c_str();
            VnGlslOutput* output = nullptr;
            if (vnCompileGlsl(&desc, &output) != VN_GLSL_SUCCESS) std::exit(2);
            shaders.push_back({std::string(pass.files[0]), {output->words, output->words + output->wordCount}});
            vnFreeGlslOutput(output);
        }
    return shaders;
}

ShaderSource sourceOf(const Shader& shader) {
    ShaderSource source;
    source.words = shader.words;
    source.stage = ir::Stage::compute;
    return source;
}

ir::Program optimised(const Shader& shader) {
    ir::Program program = orExit(lowerModule(sourceOf(shader)));
    ir::optimise(program);
    return program;
}

void validate(benchmark::State& state, const Shader& shader) {
    for (auto _ : state) benchmark::DoNotOptimize(checkModule(shader.words).ok());
    state.counters["words"] = static_cast<double>(shader.words.size());
}

void lower(benchmark::State& state, const Shader& shader) {
    const ShaderSource source = sourceOf(shader);
    for (auto _ : state) benchmark::DoNotOptimize(lowerModule(source).ok());
}

void optimise(benchmark::State& state, const Shader& shader) {
    const ir::Program lowered = orExit(lowerModule(sourceOf(shader)));
    for (auto _ : state) {
        ir::Program program = lowered;
        ir::optimise(program);
        benchmark::DoNotOptimize(program.blocks.data());
    }
}

void verify(benchmark::State& state, const Shader& shader) {
    const ir::Program program = optimised(shader);
    for (auto _ : state) benchmark::DoNotOptimize(ir::verify(program).ok());
}

void compile(benchmark::State& state, const Shader& shader) {
    const ir::Program program = optimised(shader);
    for (auto _ : state) benchmark::DoNotOptimize(BatchProgram::compile(program, {bestIsa(), MathTier::standard, 0}));
}

void wholePipeline(benchmark::State& state, const Shader& shader) {
    const ValidatedModule module = orExit(ValidatedModule::create(shader.words));
    ShaderSource source;
    source.module = &module;
    source.stage = ir::Stage::compute;
    for (auto _ : state) {
        const ir::Program program = orExit(loadShader(source));
        benchmark::DoNotOptimize(ComputePipeline::create({&program, Accuracy{}, bestIsa()}));
    }
}

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    const std::vector<Shader> shaders = kernelShaders();
    const std::pair<const char*, void (*)(benchmark::State&, const Shader&)> steps[] = {
        {"validate", validate}, {"lower", lower},     {"optimise", optimise},
        {"verify", verify},     {"compile", compile}, {"pipeline", wholePipeline}};
    for (const Shader& shader : shaders)
        for (const auto& [name, step] : steps)
            benchmark::RegisterBenchmark((shader.name + "/" + name).c_str(), step, std::cref(shader))
                ->Unit(benchmark::kMicrosecond);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
    return vernier::bench::main(argc, argv);
}
