// Buffers, atomics, local memory, indexed inputs, images, derivatives and interpolation.
#include <algorithm>
#include <bit>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "tests/spirv_interp/atomic_model.h"
#include "tests/spirv_interp/batch_harness.h"

namespace vernier {
namespace {

constexpr uint32_t kLanes = 64;

/// Buffers of one resource, each in an allocation of its own so that a sanitizer sees a step outside.
class Buffers {
  public:
    explicit Buffers(const std::vector<uint32_t>& sizes) {
        for (const uint32_t words : sizes) {
            storage_.emplace_back(new uint32_t[words]);
            for (uint32_t k = 0; k < words; ++k) storage_.back()[k] = 1000 * static_cast<uint32_t>(storage_.size()) + k;
            bindings_.push_back({reinterpret_cast<std::byte*>(storage_.back().get()), words * 4});
        }
        count_ = static_cast<uint32_t>(sizes.size());
        resources.buffers = bindings_.data();
        resources.base = &base_;
        resources.count = &count_;
    }
    uint32_t* words(size_t buffer) { return storage_[buffer].get(); }
    void setBytes(size_t buffer, uint32_t size) { bindings_[buffer].size = size; }
    void unbind(size_t buffer) { bindings_[buffer] = {}; }

    ResourceBindings resources;

  private:
    std::vector<std::unique_ptr<uint32_t[]>> storage_;
    std::vector<BufferBinding> bindings_;
    uint32_t base_ = 0, count_ = 0;
};

std::vector<uint32_t> ramp(uint32_t first, uint32_t step) {
    std::vector<uint32_t> words(kLanes);
    for (uint32_t k = 0; k < kLanes; ++k) words[k] = first + k * step;
    return words;
}

TEST(BatchMemory, LoadsAreBounded) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 i32 user 0.1 flat center
output 0 i32 user 0.0
output 1 i32 user 0.1
output 2 i32 user 0.2
output 3 i32 user 0.3
resource 0 storageBuffer 0.0 x3
b0:
  %0 i32 = input #0
  %1 i32 = input #1
  %2 i32 = constant 0
  %3 i32 = constant 8
  %4 i32 = loadBuffer #0 %2 %0
  %5 i32 = loadBuffer #0 %1 %0
  %6 i32 = loadBuffer #0 %1 %3
  %7 i32 = bufferSize #0 %1
  storeOutput #0 %4
  storeOutput #1 %5
  storeOutput #2 %6
  storeOutput #3 %7
  ret
)");
    std::mt19937 random(1);
    const uint32_t odd[] = {0xFFFFFFFFu, 0xFFFFFFFCu, 0x80000000u, 0x7FFFFFFCu, 40, 36, 37, 0, 3, 4};
    for (const Isa isa : test::isas()) {
        for (int round = 0; round < 50; ++round) {
            Buffers buffers({10, 3, 1});
            if (round % 5 == 1) buffers.unbind(0);
            if (round % 5 == 2) buffers.setBytes(0, 3);
            if (round % 5 == 3) buffers.setBytes(1, 11);
            std::vector<uint32_t> offsets(kLanes), descriptors(kLanes);
            for (uint32_t& o : offsets) o = random() % 3 == 0 ? odd[random() % std::size(odd)] : random() % 48;
            for (uint32_t& d : descriptors) d = random() % 5;
            if (round % 2 == 0) descriptors.assign(kLanes, random() % 4);
            test::RunSetup setup;
            setup.isa = isa;
            setup.bindings = buffers.resources;
            const test::RunResult run = test::runBatch(program, {offsets, descriptors}, setup);
            const auto expected = [&](uint32_t descriptor, uint32_t offset) -> uint32_t {
                if (descriptor >= 3) return 0;
                const uint64_t word = offset / 4, size = buffers.resources.buffers[descriptor].size;
                return word * 4 + 4 <= size ? buffers.words(descriptor)[word] : 0;
            };
            for (uint32_t lane = 0; lane < kLanes; ++lane) {
                ASSERT_EQ(run.outputs[0][lane], expected(0, offsets[lane])) << offsets[lane];
                ASSERT_EQ(run.outputs[1][lane], expected(descriptors[lane], offsets[lane])) << offsets[lane];
                ASSERT_EQ(run.outputs[2][lane], expected(descriptors[lane], 8));
                ASSERT_EQ(run.outputs[3][lane],
                          descriptors[lane] < 3 ? buffers.resources.buffers[descriptors[lane]].size : 0);
            }
        }
    }
}

TEST(BatchMemory, StoresAreBoundedMaskedAndInLaneOrder) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 i32 user 0.1 flat center
resource 0 storageBuffer 0.0 x1
b0:
  %0 i32 = input #0
  %1 i32 = input #1
  %2 i32 = constant 0
  storeBuffer #0 %2 %0 %1
  ret
)");
    std::mt19937 random(2);
    for (const Isa isa : test::isas()) {
        for (int round = 0; round < 30; ++round) {
            Buffers buffers({16});
            std::vector<uint32_t> offsets(kLanes), expected(buffers.words(0), buffers.words(0) + 16);
            for (uint32_t& o : offsets) o = random() % 8 == 0 ? static_cast<uint32_t>(random()) : (random() % 20) * 4;
            const std::vector<uint32_t> values = ramp(7, 3);
            test::RunSetup setup;
            setup.isa = isa;
            setup.bindings = buffers.resources;
            setup.exec.resize(kLanes);
            setup.store.resize(kLanes);
            for (uint32_t lane = 0; lane < kLanes; ++lane) {
                setup.exec[lane] = random() % 4 != 0 ? ~0u : 0u;
                setup.store[lane] = random() % 4 != 0 ? ~0u : 0u;
                if ((setup.exec[lane] & setup.store[lane]) != 0 && offsets[lane] / 4 < 16) {
                    expected[offsets[lane] / 4] = values[lane];
                }
            }
            (void)test::runBatch(program, {offsets, values}, setup);
            for (uint32_t k = 0; k < 16; ++k) ASSERT_EQ(buffers.words(0)[k], expected[k]) << k;
        }
    }
}

TEST(BatchMemory, StoresOfVectorsAreBoundedAndMasked) {
    constexpr uint32_t kWords = 4 * kLanes;
    for (uint32_t count = 2; count <= 4; ++count) {
        std::string text = R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 i32 user 0.1 flat center
resource 0 storageBuffer 0.0 x1
b0:
  %0 i32 = input #0
  %1 i32 = input #1
  %2 i32 = constant 0
  storeBuffer #0 %2 %0 %1
)";
        for (uint32_t k = 1; k < count; ++k) {
            const auto name = [&](uint32_t n) { return "%" + std::to_string(10 * k + n); };
            text += name(0) + " i32 = constant " + std::to_string(4 * k) + "\n" + name(1) + " i32 = iadd %0 " +
                    name(0) + "\n" + name(2) + " i32 = iadd %1 " + name(0) + "\nstoreBuffer #0 %2 " + name(1) + " " +
                    name(2) + "\n";
        }
        const ir::Program program = test::parseProgram(text + "ret\n");
        std::mt19937 random(count);
        for (const Isa isa : test::isas()) {
            for (int round = 0; round < 30; ++round) {
                Buffers buffers({kWords});
                std::vector<uint32_t> offsets = ramp(0, 16), expected(buffers.words(0), buffers.words(0) + kWords);
                std::shuffle(offsets.begin(), offsets.end(), random);
                // Some over the end, in one round of three; the last words of these wrap around to the beginning.
                if (round % 3 == 0)
                    for (const uint32_t past : {kWords * 4 - 8, kWords * 4, ~7u}) offsets[random() % kLanes] = past;
                const std::vector<uint32_t> values = ramp(7, 3);
                test::RunSetup setup;
                setup.isa = isa;
                setup.bindings = buffers.resources;
                setup.exec.resize(kLanes);
                setup.store.resize(kLanes);
                for (uint32_t lane = 0; lane < kLanes; ++lane) {
                    setup.exec[lane] = round % 2 == 0 || random() % 4 != 0 ? ~0u : 0u;
                    setup.store[lane] = round % 2 == 0 || random() % 4 != 0 ? ~0u : 0u;
                    if ((setup.exec[lane] & setup.store[lane]) == 0) continue;
                    for (uint32_t k = 0; k < count; ++k) {
                        const uint32_t place = offsets[lane] + 4 * k;
                        if (place < kWords * 4) expected[place / 4] = values[lane] + 4 * k;
                    }
                }
                (void)test::runBatch(program, {offsets, values}, setup);
                for (uint32_t k = 0; k < kWords; ++k) ASSERT_EQ(buffers.words(0)[k], expected[k]) << k;
            }
        }
    }
}

TEST(BatchMemory, AtomicsWorkInLaneOrder) {
    std::mt19937 random(3);
    for (uint32_t op = 0; op <= static_cast<uint32_t>(ir::AtomicOp::store); ++op) {
        const auto atomicOp = static_cast<ir::AtomicOp>(op);
        const bool compares = atomicOp == ir::AtomicOp::compareExchange, loads = atomicOp == ir::AtomicOp::load;
        const ir::Program program = test::parseProgram(
            "program fragment \"main\"\ninput 0 i32 user 0.0 flat center\ninput 1 i32 user 0.1 flat center\n"
            "input 2 i32 user 0.2 flat center\noutput 0 i32 user 0.0\nresource 0 storageBuffer 0.0 x1\nb0:\n"
            "  %0 i32 = input #0\n  %1 i32 = input #1\n  %2 i32 = input #2\n  %3 i32 = constant 0\n"
            "  %4 i32 = atomicBuffer #0:" +
            std::to_string(op) + " %3 %0" + (loads ? "" : " %1") + (compares ? " %2" : "") +
            "\n  storeOutput #0 %4\n  ret\n");
        for (const Isa isa : test::isas()) {
            Buffers buffers({4});
            std::vector<uint32_t> offsets(kLanes), values(kLanes), comparators(kLanes);
            for (uint32_t& o : offsets) o = random() % 6 * 4;
            for (uint32_t& v : values) v = static_cast<uint32_t>(random());
            std::vector<uint32_t> memory(buffers.words(0), buffers.words(0) + 4), expected(kLanes);
            for (uint32_t lane = 0; lane < kLanes; ++lane) {
                const uint32_t word = offsets[lane] / 4;
                comparators[lane] = word < 4 && random() % 2 == 0 ? memory[word] : 12345;
                if (word >= 4) continue;
                expected[lane] = atomicOp == ir::AtomicOp::store ? 0 : memory[word];
                memory[word] = test::atomicResult(atomicOp, memory[word], values[lane], comparators[lane]);
            }
            test::RunSetup setup;
            setup.isa = isa;
            setup.bindings = buffers.resources;
            const test::RunResult run = test::runBatch(program, {offsets, values, comparators}, setup);
            for (uint32_t k = 0; k < 4; ++k) ASSERT_EQ(buffers.words(0)[k], memory[k]) << op;
            if (atomicOp == ir::AtomicOp::store) continue;
            for (uint32_t lane = 0; lane < kLanes; ++lane) ASSERT_EQ(run.outputs[0][lane], expected[lane]) << op;
        }
    }
}

TEST(BatchMemory, AtomicsOfSeveralThreadsAddUp) {
    const ir::Program program = test::parseProgram(R"(program compute "main"
resource 0 storageBuffer 0.0 x1
b0:
  %0 i32 = constant 0
  %1 i32 = constant 1
  %2 i32 = atomicBuffer #0:0 %0 %0 %1
  ret
)");
    Buffers buffers({1});
    buffers.words(0)[0] = 0;
    const auto compiled = BatchProgram::compile(program, {bestIsa(), MathTier::standard, 64});
    ASSERT_TRUE(compiled.ok());
    const uint32_t lanes = (*compiled)->lanes();
    const auto work = [&] {
        BatchContext context(*compiled);
        context.beginDraw(buffers.resources);
        const std::vector<uint32_t> mask(lanes, ~0u);
        for (int k = 0; k < 200; ++k) (void)context.run(lanes, mask.data(), mask.data());
    };
    std::thread other(work);
    work();
    other.join();
    EXPECT_EQ(buffers.words(0)[0], 2 * 200 * lanes);
}

TEST(BatchMemory, IndexedInputsClamp) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 i32 user 1.0 flat center
input 2 i32 user 2.0 flat center
input 3 i32 user 3.0 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  %1 i32 = inputIndexed #1:3 %0
  storeOutput #0 %1
  ret
)");
    for (const Isa isa : test::isas()) {
        test::RunSetup setup;
        setup.isa = isa;
        std::vector<uint32_t> index(kLanes);
        for (uint32_t k = 0; k < kLanes; ++k) index[k] = k - 2;
        const test::RunResult run = test::runBatch(program, {index, ramp(100, 1), ramp(200, 1), ramp(300, 1)}, setup);
        for (uint32_t k = 0; k < kLanes; ++k) {
            const uint32_t wanted = k < 2 ? 0 : std::min(k - 2, 2u);
            EXPECT_EQ(run.outputs[0][k], 100 * (wanted + 1) + k);
        }
    }
}

/// An image whose texel is its number times 1000, plus the coordinate, plus the lane's quad.
void sampleTest(const ImageBinding& binding, const ImageCall& call) {
    const auto number = static_cast<float>(reinterpret_cast<uintptr_t>(binding.image));
    for (uint32_t lane = 0; lane < call.lanes; ++lane) {
        for (uint32_t k = 0; k < 4; ++k) {
            if (call.result[k] == nullptr) continue;
            // Lanes that are not asked for get rubbish, which must not come through.
            const float value =
                number * 1000 + std::bit_cast<float>(call.coord[0][lane]) + static_cast<float>(k) * 0.25f;
            call.result[k][lane] =
                call.mask == nullptr || call.mask[lane] != 0 ? std::bit_cast<uint32_t>(value) : 0xDEADBEEFu;
        }
    }
}

TEST(BatchImages, DescriptorsThatVaryAreSplit) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 f32 user 1.0 smooth center
input 2 f32 user 1.1 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
resource 0 combinedImageSampler 0.0 x4
imageOp 0 sampleImplicit d2 image 0 sampler 0 coords 2
b0:
  %0 i32 = input #0
  %1 f32 = input #1
  %2 f32 = input #2
  %3 f32 = image #0 %0 %1 %2
  storeOutput #0 %3
  storeOutput #1 %6
  ret
)");
    const auto image = [](uintptr_t number) { return reinterpret_cast<const void*>(number); };
    const ImageBinding images[] = {
        {image(1), nullptr, sampleTest}, {image(2), nullptr, sampleTest}, {}, {image(4), nullptr, sampleTest}};
    const uint32_t base = 0, count = 4;
    ResourceBindings resources;
    resources.images = images;
    resources.base = &base;
    resources.count = &count;
    for (const Isa isa : test::isas()) {
        for (const uint32_t kinds : {1u, 2u, 6u}) {
            test::RunSetup setup;
            setup.isa = isa;
            setup.bindings = resources;
            std::vector<uint32_t> index(kLanes), x(kLanes);
            for (uint32_t k = 0; k < kLanes; ++k) {
                index[k] = k % kinds;
                x[k] = std::bit_cast<uint32_t>(static_cast<float>(k));
            }
            const test::RunResult run = test::runBatch(program, {index, x, x}, setup);
            for (uint32_t k = 0; k < kLanes; ++k) {
                const bool bound = index[k] < 4 && index[k] != 2;
                const float expected = bound ? static_cast<float>(1000 * (index[k] + 1) + k) : 0.0f;
                EXPECT_EQ(std::bit_cast<float>(run.outputs[0][k]), expected) << k;
                EXPECT_EQ(std::bit_cast<float>(run.outputs[1][k]), bound ? expected + 0.75f : 0.0f) << k;
            }
        }
    }
}

TEST(BatchQuads, Derivatives) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
output 2 f32 user 0.2
output 3 f32 user 0.3
b0:
  %0 f32 = input #0
  %1 f32 = ddxFine %0
  %2 f32 = ddyFine %0
  %3 f32 = ddxCoarse %0
  %4 f32 = ddyCoarse %0
  storeOutput #0 %1
  storeOutput #1 %2
  storeOutput #2 %3
  storeOutput #3 %4
  ret
)");
    std::mt19937 random(4);
    for (const Isa isa : test::isas()) {
        std::vector<uint32_t> words(kLanes);
        for (uint32_t& w : words) w = std::bit_cast<uint32_t>(static_cast<float>(random() % 1000) * 0.37f);
        test::RunSetup setup;
        setup.isa = isa;
        const test::RunResult run = test::runBatch(program, {words}, setup);
        for (uint32_t lane = 0; lane < kLanes; ++lane) {
            const uint32_t quad = lane & ~3u;
            const auto at = [&](uint32_t k) { return std::bit_cast<float>(words[quad + k]); };
            const auto got = [&](uint32_t k) { return std::bit_cast<float>(run.outputs[k][lane]); };
            EXPECT_EQ(got(0), lane & 2 ? at(3) - at(2) : at(1) - at(0));
            EXPECT_EQ(got(1), lane & 1 ? at(3) - at(1) : at(2) - at(0));
            EXPECT_EQ(got(2), at(1) - at(0));
            EXPECT_EQ(got(3), at(2) - at(0));
        }
    }
}

TEST(BatchQuads, InterpolationAsksItsOwner) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = constant 0x3e800000
  %1 f32 = input #0
  %2 f32 = interpolateAtOffset #0 %1 %0
  %3 f32 = interpolateAtCentroid #0
  storeOutput #0 %2
  storeOutput #1 %3
  ret
)");
    BatchContext::Interpolator interpolator;
    interpolator.at = [](void*, uint32_t slot, uint32_t where, uint32_t lanes, const float* a, const float* b,
                         float* result) {
        for (uint32_t k = 0; k < lanes; ++k) result[k] = static_cast<float>(slot) + (where == 2 ? a[k] + b[k] : -1.0f);
    };
    test::RunSetup setup;
    setup.interpolator = interpolator;
    std::vector<uint32_t> x(kLanes);
    for (uint32_t k = 0; k < kLanes; ++k) x[k] = std::bit_cast<uint32_t>(static_cast<float>(k));
    const test::RunResult run = test::runBatch(program, {x}, setup);
    for (uint32_t k = 0; k < kLanes; ++k) {
        EXPECT_EQ(std::bit_cast<float>(run.outputs[0][k]), static_cast<float>(k) + 0.25f);
        EXPECT_EQ(std::bit_cast<float>(run.outputs[1][k]), -1.0f);
    }
}

}  // namespace
}  // namespace vernier
