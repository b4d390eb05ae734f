// Compute shaders: built-in variables, work-groups of every size, barriers, and the classic programs that use them.
#include <algorithm>
#include <numeric>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/compute_harness.h"

namespace vernier::test {
namespace {

using Grid = WorkGroupContext::Grid;

std::string shader(const std::string& localSize, const std::string& globals, const std::string& body) {
    return "#version 450\nlayout(" + localSize + ") in;\n" + globals + "\nvoid main() {\n" + body + "\n}\n";
}

std::vector<uint32_t> randomWords(size_t count, uint32_t seed, uint32_t below = 0) {
    std::mt19937 random(seed);
    std::vector<uint32_t> words(count);
    for (uint32_t& word : words) word = below == 0 ? random() : random() % below;
    return words;
}

std::vector<float> randomFloats(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random() % 2000) / 7.0f - 100.0f;
    return values;
}

struct Size {
    uint32_t x, y, z;
};

// Every built-in variable, for work-groups that are packed, that fill a batch and that take several.
TEST(Compute, BuiltinVariables) {
    for (const Size size : {Size{1, 1, 1},
                            {5, 1, 1},
                            {1, 7, 1},
                            {1, 1, 3},
                            {4, 2, 2},
                            {32, 1, 1},
                            {8, 8, 1},
                            {3, 5, 7},
                            {16, 16, 1},
                            {64, 2, 4}}) {
        const std::string text = "local_size_x=" + std::to_string(size.x) + ",local_size_y=" + std::to_string(size.y) +
                                 ",local_size_z=" + std::to_string(size.z);
        const ir::Program program = loadCompute(
            shader(
                text, "layout(set=0,binding=0) buffer B { uint o[]; };",
                "uvec3 extent = gl_NumWorkGroups * gl_WorkGroupSize;\n"
                "uvec3 at = gl_GlobalInvocationID - pc.base * gl_WorkGroupSize;\n"
                "uint i = 16 * (at.x + extent.x * (at.y + extent.y * at.z));\n"
                "for (int k = 0; k < 3; ++k) { o[i + k] = gl_NumWorkGroups[k]; o[i + 3 + k] = gl_WorkGroupID[k];\n"
                "o[i + 6 + k] = gl_LocalInvocationID[k]; o[i + 9 + k] = gl_GlobalInvocationID[k]; }\n"
                "o[i + 12] = gl_LocalInvocationIndex; o[i + 13] = gl_WorkGroupSize.x; o[i + 14] = gl_WorkGroupSize.y;\n"
                "o[i + 15] += 1;")
                .insert(13, "layout(push_constant) uniform P { uvec3 base; } pc;\n"));
        const Grid grid{{3, 2, 5}, {7, 0, 100}};
        const uint32_t invocations = size.x * size.y * size.z * 30;
        const auto o = dispatchEverywhere(program, grid, {{0, std::vector<uint32_t>(16 * invocations)}},
                                          {grid.base[0], grid.base[1], grid.base[2]})[0];
        const uint32_t sizes[3] = {size.x, size.y, size.z};
        for (uint32_t n = 0; n < invocations; ++n) {
            const uint32_t extent[3] = {3 * size.x, 2 * size.y, 5 * size.z};
            const uint32_t at[3] = {n % extent[0], n / extent[0] % extent[1], n / extent[0] / extent[1]};
            std::vector<uint32_t> wanted(16);
            for (uint32_t k = 0; k < 3; ++k) {
                wanted[k] = grid.count[k];
                wanted[3 + k] = grid.base[k] + at[k] / sizes[k];
                wanted[6 + k] = at[k] % sizes[k];
                wanted[9 + k] = grid.base[k] * sizes[k] + at[k];
            }
            wanted[12] = wanted[6] + size.x * (wanted[7] + size.y * wanted[8]);
            wanted[13] = size.x, wanted[14] = size.y, wanted[15] = 1;
            ASSERT_EQ(std::vector<uint32_t>(o.begin() + 16 * n, o.begin() + 16 * n + 16), wanted) << text << " " << n;
        }
    }
}

TEST(Compute, LocalSizeFromSpecialisationConstants) {
    const std::string text =
        shader("local_size_x_id=3,local_size_y=2,local_size_z_id=4", "layout(set=0,binding=0) buffer B { uint o[]; };",
               "o[gl_LocalInvocationIndex] = gl_WorkGroupSize.x * 100 + gl_WorkGroupSize.z;");
    const uint32_t values[2] = {6, 5};
    const Specialization::Entry entries[2] = {{3, 0, 4}, {4, 4, 4}};
    const Specialization specialization{entries, std::as_bytes(std::span(values))};
    // By the built-in constant WorkgroupSize, and by the execution mode LocalSizeId.
    for (const VnGlslTarget target : {VN_GLSL_TARGET_VULKAN_1_1, VN_GLSL_TARGET_VULKAN_1_3}) {
        EXPECT_EQ(loadCompute(text, {}, target).localSize, (std::array<uint32_t, 3>{1, 2, 1}));
        const ir::Program program = loadCompute(text, specialization, target);
        EXPECT_EQ(program.localSize, (std::array<uint32_t, 3>{6, 2, 5}));
        const auto o = dispatchEverywhere(program, {{2, 1, 1}, {}}, {{0, std::vector<uint32_t>(64)}})[0];
        EXPECT_EQ(std::count(o.begin(), o.end(), 605u), 60);
    }
}

TEST(Compute, PrefixSum) {
    const ir::Program program = loadCompute(shader(
        "local_size_x=256", "layout(set=0,binding=0) buffer B { uint v[]; }; shared uint s[256];",
        "uint i = gl_LocalInvocationIndex; s[i] = v[gl_GlobalInvocationID.x]; barrier();\n"
        "for (uint step = 1; step < 256; step *= 2) { uint t = i >= step ? s[i - step] : 0; barrier(); s[i] += t;\n"
        "barrier(); }\nv[gl_GlobalInvocationID.x] = s[i];"));
    EXPECT_TRUE(program.hasBarriers);
    const auto in = randomWords(4 * 256, 1);
    const auto out = dispatchEverywhere(program, {{4, 1, 1}, {}}, {{0, in}})[0];
    for (uint32_t group = 0; group < 4; ++group) {
        std::vector<uint32_t> wanted(in.begin() + group * 256, in.begin() + group * 256 + 256);
        std::partial_sum(wanted.begin(), wanted.end(), wanted.begin());
        EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), out.begin() + group * 256));
    }
}

TEST(Compute, BitonicSort) {
    const ir::Program program = loadCompute(
        shader("local_size_x=128", "layout(set=0,binding=0) buffer B { float v[]; }; shared float s[256];",
               "uint i = gl_LocalInvocationID.x, first = gl_WorkGroupID.x * 256; s[i] = v[first + i];\n"
               "s[i + 128] = v[first + i + 128];\n"
               "for (uint size = 2; size <= 256; size *= 2) for (uint stride = size / 2; stride > 0; stride /= 2) {\n"
               "barrier(); uint a = 2 * i - (i & (stride - 1)); uint b = a + stride; bool up = (a & size) == 0;\n"
               "float x = s[a], y = s[b]; if ((x > y) == up) { s[a] = y; s[b] = x; } }\n"
               "barrier(); v[first + i] = s[i]; v[first + i + 128] = s[i + 128];"));
    const auto in = randomFloats(3 * 256, 2);
    const auto out = floatsOf(dispatchEverywhere(program, {{3, 1, 1}, {}}, {{0, wordsOf(in)}})[0]);
    for (uint32_t group = 0; group < 3; ++group) {
        std::vector<float> wanted(in.begin() + group * 256, in.begin() + group * 256 + 256);
        std::sort(wanted.begin(), wanted.end());
        EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), out.begin() + group * 256));
    }
}

TEST(Compute, MatrixProduct) {
    constexpr uint32_t kSize = 48;
    const ir::Program program = loadCompute(shader(
        "local_size_x=16,local_size_y=16",
        "layout(set=0,binding=0) readonly buffer A { float a[]; }; layout(set=0,binding=1) readonly buffer B { float "
        "b[]; };\nlayout(set=0,binding=2) buffer C { float c[]; }; shared float ta[16][16]; shared float tb[16][17];",
        "const uint n = 48; uvec2 l = gl_LocalInvocationID.xy, g = gl_GlobalInvocationID.xy; float sum = 0;\n"
        "for (uint t = 0; t < n; t += 16) { ta[l.y][l.x] = a[g.y * n + t + l.x]; tb[l.y][l.x] = b[(t + l.y) * n + "
        "g.x];\n"
        "barrier(); for (uint k = 0; k < 16; ++k) { precise float p = ta[l.y][k] * tb[k][l.x]; sum += p; } barrier(); "
        "}\nc[g.y * n + g.x] = sum;"));
    const auto a = randomFloats(kSize * kSize, 3), b = randomFloats(kSize * kSize, 4);
    const auto c = floatsOf(dispatchEverywhere(
        program, {{3, 3, 1}, {}}, {{0, wordsOf(a)}, {1, wordsOf(b)}, {2, std::vector<uint32_t>(kSize * kSize)}})[2]);
    for (uint32_t y = 0; y < kSize; ++y) {
        for (uint32_t x = 0; x < kSize; ++x) {
            float sum = 0;
            for (uint32_t k = 0; k < kSize; ++k) {
                const float product = a[y * kSize + k] * b[k * kSize + x];
                sum += product;
            }
            ASSERT_EQ(c[y * kSize + x], sum) << x << " " << y;
        }
    }
}

// Invocations drop out step by step: the barrier stands outside the condition.
TEST(Compute, Reduction) {
    const ir::Program program = loadCompute(
        shader("local_size_x=512", "layout(set=0,binding=0) buffer B { float v[]; }; shared float s[512];",
               "uint i = gl_LocalInvocationIndex; s[i] = v[gl_GlobalInvocationID.x]; barrier();\n"
               "for (uint half_ = 256; half_ > 0; half_ /= 2) { if (i < half_) s[i] += s[i + half_]; barrier(); }\n"
               "if (i == 0) v[gl_GlobalInvocationID.x] = s[0];"));
    const auto in = randomFloats(2 * 512, 5);
    const auto out = floatsOf(dispatchEverywhere(program, {{2, 1, 1}, {}}, {{0, wordsOf(in)}})[0]);
    for (uint32_t group = 0; group < 2; ++group) {
        std::vector<float> s(in.begin() + group * 512, in.begin() + group * 512 + 512);
        for (uint32_t half = 256; half > 0; half /= 2) {
            for (uint32_t i = 0; i < half; ++i) s[i] += s[i + half];
        }
        EXPECT_EQ(out[group * 512], s[0]);
    }
}

TEST(Compute, Histogram) {
    const ir::Program program = loadCompute(shader(
        "local_size_x=96",
        "layout(set=0,binding=0) readonly buffer B { uint v[]; }; layout(set=0,binding=1) buffer H { uint h[]; };\n"
        "shared uint bins[64];",
        "uint i = gl_LocalInvocationIndex; barrier();\n"
        "for (uint k = 0; k < 8; ++k) atomicAdd(bins[v[gl_WorkGroupID.x * 768 + k * 96 + i]], 1u);\n"
        "barrier(); if (i < 64) atomicAdd(h[i], bins[i]);"));
    const auto in = randomWords(5 * 768, 6, 64);
    const auto h = dispatchEverywhere(program, {{5, 1, 1}, {}}, {{0, in}, {1, std::vector<uint32_t>(64)}})[1];
    std::vector<uint32_t> wanted(64);
    for (const uint32_t v : in) ++wanted[v];
    EXPECT_EQ(h, wanted);
}

TEST(Compute, Transpose) {
    const ir::Program program = loadCompute(shader(
        "local_size_x=32,local_size_y=8",
        "layout(set=0,binding=0) readonly buffer A { uint a[]; }; layout(set=0,binding=1) writeonly buffer B { uint "
        "b[]; };\n"
        "shared uint tile[32][33];",
        "uvec2 l = gl_LocalInvocationID.xy, from = gl_WorkGroupID.xy * 32, to = from.yx;\n"
        "for (uint k = 0; k < 32; k += 8) tile[l.y + k][l.x] = a[(from.y + l.y + k) * 96 + from.x + l.x];\n"
        "barrier();\n"
        "for (uint k = 0; k < 32; k += 8) b[(to.y + l.y + k) * 64 + to.x + l.x] = tile[l.x][l.y + k];"));
    const auto in = randomWords(96 * 64, 7);
    const auto out = dispatchEverywhere(program, {{3, 2, 1}, {}}, {{0, in}, {1, std::vector<uint32_t>(96 * 64)}})[1];
    for (uint32_t y = 0; y < 64; ++y) {
        for (uint32_t x = 0; x < 96; ++x) ASSERT_EQ(out[x * 64 + y], in[y * 96 + x]);
    }
}

// Undefined in Vulkan; here it must end and do no harm.
TEST(Compute, BarriersInDivergentFlow) {
    const ir::Program program =
        loadCompute(shader("local_size_x=200", "layout(set=0,binding=0) buffer B { uint v[]; }; shared uint s[200];",
                           "uint i = gl_LocalInvocationIndex; if (i < 5) { s[i] = 1; barrier(); s[i + 1] = 2; }\n"
                           "for (uint k = 0; k < i / 20; ++k) { atomicAdd(s[i], k); barrier(); }\n"
                           "if (i % 3 == 0) return; barrier(); v[i] = 7;"));
    for (const Isa isa : isas()) {
        for (const uint32_t lanes : {16u, 32u, 64u}) {
            const auto result = dispatch(program, compileCompute(program, isa, lanes), {{2, 1, 1}, {}},
                                         {{0, std::vector<uint32_t>(200)}});
            EXPECT_TRUE(result.ok);
            const auto& v = result.buffers.at(0);
            for (uint32_t i = 0; i < 200; ++i) EXPECT_EQ(v[i], i % 3 == 0 ? 0u : 7u);
        }
    }
}

/// BatchOptions::backEdges is how often a lane may go round.
TEST(Compute, TheBackEdgeBudgetEndsLoops) {
    const std::string text = shader("local_size_x=16", "layout(set=0,binding=0) buffer B { uint v[]; };",
                                    "uint n = 0; while (n < v[0]) n += v[1]; v[2] = n;");
    const ir::Program program = loadCompute(text);
    BatchOptions options{bestIsa(), MathTier::standard, 16};
    options.backEdges = 100;
    const auto compiled = BatchProgram::compile(program, options);
    ASSERT_TRUE(compiled.ok());
    std::vector<uint32_t> words{90, 1, 0};
    const BufferBinding buffer{reinterpret_cast<std::byte*>(words.data()), 12};
    const uint32_t base[2] = {0, 0}, count[2] = {1, 1};
    ResourceBindings bindings;
    bindings.buffers = &buffer;
    bindings.base = base;
    bindings.count = count;
    WorkGroupContext context(*compiled);
    for (const auto& [rounds, ends] : {std::pair{90u, true}, {110u, false}, {90u, true}}) {
        words = {rounds, 1, 0};
        context.beginDispatch(bindings, {{1, 1, 1}, {}});
        EXPECT_EQ(context.run(0, 1), ends) << rounds;
        EXPECT_EQ(words[2], ends ? rounds : 0u);
    }
}

TEST(Compute, EndlessLoopIsLost) {
    const std::string text = shader("local_size_x=80", "layout(set=0,binding=0) buffer B { uint v[]; }; shared uint s;",
                                    "while (v[0] == 0) { if (gl_LocalInvocationIndex == 70) barrier(); }");
    const ir::Program program = loadCompute(text);
    const auto compiled = BatchProgram::compile(program, {bestIsa(), MathTier::standard, 64});
    ASSERT_TRUE(compiled.ok());
    std::vector<uint32_t> words(1);
    const BufferBinding buffer{reinterpret_cast<std::byte*>(words.data()), 4};
    const uint32_t base[2] = {0, 0}, count[2] = {1, 1};
    ResourceBindings bindings;
    bindings.buffers = &buffer;
    bindings.base = base;
    bindings.count = count;
    WorkGroupContext context(*compiled);
    context.beginDispatch(bindings, {{3, 1, 1}, {}});
    EXPECT_FALSE(context.run(0, 3));
    // The context can be used again.
    words[0] = 1;
    context.beginDispatch(bindings, {{3, 1, 1}, {}});
    EXPECT_TRUE(context.run(0, 3));
}

// Storage buffers are shared between threads: atomics add up, and the last work-group sees what all have written.
TEST(Compute, ThreadsShareStorageBuffers) {
    const ir::Program program = loadCompute(shader(
        "local_size_x=64",
        "layout(set=0,binding=0) coherent buffer B { uint sum; uint done; uint total; uint part[]; }; shared bool "
        "last;",
        "uint g = gl_WorkGroupID.x; atomicAdd(sum, gl_LocalInvocationIndex);\n"
        "if (gl_LocalInvocationIndex == 0) { part[g] = g + 1; memoryBarrierBuffer();\n"
        "last = atomicAdd(done, 1u) == gl_NumWorkGroups.x - 1; }\n"
        "barrier(); if (last && gl_LocalInvocationIndex == 0) { memoryBarrierBuffer(); uint t = 0;\n"
        "for (uint k = 0; k < gl_NumWorkGroups.x; ++k) t += part[k]; total = t; }"));
    constexpr uint32_t kGroups = 4000;
    const auto compiled = BatchProgram::compile(program, {bestIsa(), MathTier::standard, 0});
    ASSERT_TRUE(compiled.ok());
    std::vector<uint32_t> words(3 + kGroups);
    std::vector<BufferBinding> buffers(2, {reinterpret_cast<std::byte*>(words.data()), (3 + kGroups) * 4});
    const uint32_t base[2] = {0, 1}, count[2] = {1, 1};
    ResourceBindings bindings;
    bindings.buffers = buffers.data();
    bindings.base = base;
    bindings.count = count;
    std::vector<std::thread> threads;
    for (uint32_t t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            WorkGroupContext context(*compiled);
            context.beginDispatch(bindings, {{kGroups, 1, 1}, {}});
            for (uint32_t g = t; g < kGroups; g += 4) EXPECT_TRUE(context.run(g, 1));
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(words[0], kGroups * (63 * 64 / 2));
    EXPECT_EQ(words[1], kGroups);
    EXPECT_EQ(words[2], kGroups * (kGroups + 1) / 2);
}

// What is the same for a whole work-group is computed once for it, in scalars; unless work-groups share batches.
TEST(Compute, WorkGroupRate) {
    const auto statisticsOf = [](const std::string& size) {
        const ir::Program program = loadCompute(
            shader(size, "layout(set=0,binding=0) buffer B { uint v[]; }; layout(push_constant) uniform P { uint k; };",
                   "uint g = gl_WorkGroupID.x * k + gl_WorkGroupID.y; g = g * g + k; v[g + gl_LocalInvocationIndex] = "
                   "g;"));
        return (*BatchProgram::compile(program, {kLowestIsa, MathTier::standard, 64}))->statistics();
    };
    const BatchStatistics whole = statisticsOf("local_size_x=64"), packed = statisticsOf("local_size_x=8");
    EXPECT_GE(whole.workGroupRateInstructions, 4u);
    EXPECT_EQ(packed.workGroupRateInstructions, 0u);
    EXPECT_LT(whole.instructions, packed.instructions);
}

TEST(Compute, AGridMayBeEmpty) {
    const ir::Program program = loadCompute(
        shader("local_size_x=4", "layout(set=0,binding=0) buffer B { uint v[]; };", "v[gl_WorkGroupID.x] = 1;"));
    WorkGroupContext context(compileCompute(program, bestIsa(), 0));
    context.beginDispatch({}, {{3, 0, 5}, {}});
    EXPECT_TRUE(context.run(0, 0));
    // Nothing is bound: stores are dropped.
    context.beginDispatch({}, {{3, 1, 5}, {}});
    EXPECT_TRUE(context.run(0, 15));
}

TEST(Compute, Refusals) {
    EXPECT_EQ(refusalOf(shader("local_size_x=1024,local_size_y=2", "", "")),
              "SPIR-V: entry point 'main': work-groups of 1024 x 2 x 1 invocations; from 1 to 1024 are supported");
    EXPECT_NE(refusalOf(shader("local_size_x=1", "layout(set=0,binding=0) buffer B { uint v[]; }; shared uint s[9000];",
                               "s[v[0]] = 1; barrier(); v[1] = s[v[2]];"))
                  .find("makes the work-group's memory 36000 bytes large; the limit is 32768"),
              std::string::npos);
}

}  // namespace
}  // namespace vernier::test
