// GLSL through the front end and the batch interpreter, against the IR machine of the front end's tests
// (which those hold against the reference interpreter): every lane with inputs of its own, on every
// instruction set.
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include "spirv_interp/ir/print.h"
#include "spirv_interp/program.h"
#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/front_snippets.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {
namespace {

constexpr uint32_t kLanes = 64;
constexpr size_t kBufferBytes = 512;

class BatchMeaning : public testing::TestWithParam<Snippet> {
  protected:
    static void SetUpTestSuite() { vnRetainGlslCompiler(); }
    static void TearDownTestSuite() { vnReleaseGlslCompiler(); }
};

float someFloat(std::mt19937& random) {
    const float value = static_cast<float>(random() % 65536) / 8192.0f - 4.0f;
    return random() % 4 == 0 ? std::round(value * 2.0f) * 0.5f : value;
}
uint32_t someWord(ir::Type type, std::mt19937& random) {
    if (type == ir::Type::f32) return std::bit_cast<uint32_t>(someFloat(random));
    return random() % 3 == 0 ? static_cast<uint32_t>(random()) : random() % 64 - 16;
}

bool close(ir::Type type, uint32_t a, uint32_t b, double tolerance) {
    if (a == b) return true;
    if (type != ir::Type::f32) return false;
    const double x = std::bit_cast<float>(a), y = std::bit_cast<float>(b);
    if (std::isnan(x) || std::isnan(y)) return std::isnan(x) && std::isnan(y);
    return x == y || std::fabs(x - y) <= tolerance * std::max({1.0, std::fabs(x), std::fabs(y)});
}

/// The buffers of a program, filled with floats.
struct Memory {
    Memory(const ir::Program& program, std::mt19937& random) {
        for (const ir::Resource& resource : program.resources) {
            const size_t size = resource.kind == ir::ResourceKind::pushConstants ? 32 : kBufferBytes;
            std::vector<std::byte> bytes(size);
            for (size_t word = 0; word < size / 4; ++word) {
                const float value = someFloat(random);
                std::memcpy(bytes.data() + word * 4, &value, 4);
            }
            buffers.push_back(std::move(bytes));
        }
    }
    ResourceBindings bind() {
        bindings.clear();
        for (uint32_t r = 0; r < buffers.size(); ++r) {
            bindings.push_back({buffers[r].data(), static_cast<uint32_t>(buffers[r].size())});
            base.push_back(r);
            count.push_back(1);
        }
        ResourceBindings result;
        result.buffers = bindings.data();
        result.base = base.data();
        result.count = count.data();
        return result;
    }
    std::vector<std::vector<std::byte>> buffers;
    std::vector<BufferBinding> bindings;
    std::vector<uint32_t> base, count;
};

TEST_P(BatchMeaning, IsWhatTheIrSays) {
    const std::string source = std::string(kSnippetPrologue) + GetParam().functions +
                               "\nvoid main() {\no = vec4(0); p = ivec4(0);\n" + GetParam().body + "\n}\n";
    const Words words = compileGlsl(ir::Stage::fragment, source);
    ASSERT_FALSE(words.empty());
    ShaderSource shader;
    shader.words = words;
    shader.stage = ir::Stage::fragment;
    const Result<ir::Program> loaded = loadShader(shader);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    const ir::Program& program = *loaded;
    std::mt19937 random(1);
    for (int round = 0; round < 6; ++round) {
        std::vector<std::vector<uint32_t>> inputs;
        for (const ir::InterfaceSlot& slot : program.inputs) {
            inputs.emplace_back();
            // Alone, an invocation has derivatives of zero: so have quads of equal lanes.
            for (uint32_t lane = 0; lane < kLanes; ++lane) {
                const bool copies = program.usesQuads && lane % 4 != 0;
                inputs.back().push_back(copies ? inputs.back().back() : someWord(slot.type, random));
            }
        }
        const Memory memory(program, random);
        // Lanes of one batch see each other's stores, the machine's invocations do not: then one lane at a
        // time runs.
        const uint32_t runs = program.hasSideEffects ? 4 : 1;
        RunResult first;
        for (const Isa isa : isas()) {
            for (uint32_t run = 0; run < runs; ++run) {
                RunSetup setup;
                setup.isa = isa;
                setup.tier = MathTier::fine;
                setup.exec.assign(kLanes, program.hasSideEffects ? 0 : ~0u);
                if (program.hasSideEffects) setup.exec[run * 13] = ~0u;
                Memory own = memory;
                setup.bindings = own.bind();
                RunResult result = runBatch(program, inputs, setup);
                ASSERT_TRUE(result.ok);
                for (uint32_t lane = 0; lane < kLanes; ++lane) {
                    if (setup.exec[lane] == 0) continue;
                    Machine machine;
                    for (const auto& input : inputs) machine.inputs.push_back(input[lane]);
                    machine.buffers = memory.buffers;
                    ASSERT_TRUE(machine.run(program));
                    const bool discarded = machine.killed || machine.demoted;
                    ASSERT_EQ(result.live[lane], discarded ? 0u : ~0u);
                    if (discarded) {  // arbitrary bits
                        for (std::vector<uint32_t>& output : result.outputs) output[lane] = 0;
                        continue;
                    }
                    for (size_t slot = 0; slot < program.outputs.size(); ++slot) {
                        ASSERT_TRUE(
                            close(program.outputs[slot].type, machine.outputs[slot], result.outputs[slot][lane], 2e-5))
                            << isaName(isa) << " lane " << lane << " output " << slot << ": "
                            << result.outputs[slot][lane] << " instead of " << machine.outputs[slot] << "\n"
                            << ir::print(program);
                    }
                    if (!program.hasSideEffects) continue;
                    for (size_t r = 0; r < own.buffers.size(); ++r) {
                        for (size_t at = 0; at < own.buffers[r].size(); at += 4) {
                            uint32_t a = 0, b = 0;
                            std::memcpy(&a, own.buffers[r].data() + at, 4);
                            std::memcpy(&b, machine.buffers[r].data() + at, 4);
                            ASSERT_TRUE(close(ir::Type::f32, a, b, 2e-5)) << "buffer " << r << " byte " << at;
                        }
                    }
                }
                if (isa == kLowestIsa) first = result;
                if (runs == 1) {
                    ASSERT_TRUE(first == result) << "not the same bits on " << isaName(isa) << "\n"
                                                 << ir::print(program);
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Snippets, BatchMeaning, testing::ValuesIn(snippets()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace vernier::test
