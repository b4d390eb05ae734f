// Depth and stencil tests of blocks against testSample(), one sample at a time: the same samples pass, and the same
// bytes are left.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "runtime/plan/sample_positions.h"
#include "runtime/raster/depth_test.h"

namespace vernier {
namespace {

constexpr uint32_t kSide = 16, kSamples = 2;

struct Attachment {
    std::vector<std::byte> bytes;
    DepthTarget target;

    Attachment(uint32_t texelBytes, const std::vector<std::byte>& contents) : bytes(contents) {
        target.data = bytes.data();
        target.rowPitch = size_t{kSide} * texelBytes;
        target.samplePitch = target.rowPitch * kSide;
        target.texelBytes = texelBytes;
    }
};

void fillAttachment(DepthStorage storage, uint32_t texelBytes, std::mt19937& random, std::vector<std::byte>& bytes) {
    bytes.resize(size_t{kSide} * kSide * kSamples * texelBytes);
    for (size_t at = 0; at < bytes.size(); at += texelBytes) {
        const uint32_t word = random();
        std::memcpy(bytes.data() + at, &word, std::min(texelBytes, 4u));
        if (storage != DepthStorage::d32fs8) continue;
        const float depth = static_cast<float>(word % 17) / 16;
        const uint32_t second = random();
        std::memcpy(bytes.data() + at, &depth, 4);
        std::memcpy(bytes.data() + at + 4, &second, 4);
    }
}

DepthStencilState::Face randomFace(std::mt19937& random) {
    DepthStencilState::Face face;
    const auto op = [&] { return static_cast<VkStencilOp>(random() % 8); };
    face.ops = {op(), op(), op(), static_cast<VkCompareOp>(random() % 8), 0, 0, 0};
    const auto mask = [&] { return random() % 2 == 0 ? 0xFFu : random(); };
    face.values.compareMask = mask();
    face.values.writeMask = mask();
    face.values.reference = random() % 4 == 0 ? random() : random() % 256;
    return face;
}

class StencilBlocksTest : public testing::TestWithParam<Isa> {};

TEST_P(StencilBlocksTest, SameAsOneSampleAtATime) {
    std::mt19937 random(3);
    const struct {
        DepthStorage storage;
        uint32_t texelBytes;
    } formats[] = {{DepthStorage::d24, 4}, {DepthStorage::d32fs8, 8}, {DepthStorage::none, 1}};
    for (int round = 0; round < 3000; ++round) {
        const auto& format = formats[round % 3];
        std::vector<std::byte> contents;
        fillAttachment(format.storage, format.texelBytes, random, contents);
        Attachment one(format.texelBytes, contents), blocks(format.texelBytes, contents);

        DepthPlan plan;
        plan.storage = format.storage;
        plan.hasStencil = plan.stencil = true;
        plan.test = format.storage != DepthStorage::none && random() % 4 != 0;
        plan.write = plan.test && random() % 2 == 0;
        plan.compare = static_cast<uint8_t>(random() % 8);
        Primitive primitive{};
        primitive.front = random() % 2 == 0;
        TrianglePlanes planes{};
        planes.z0 = static_cast<float>(random() % 17) / 16;
        planes.zx = random() % 2 == 0 ? 0.0f : 0.03125f;
        planes.zHigh = 1;
        planes.primitive = &primitive;
        DepthStencilState state;
        state.plan = &plan;
        state.target = one.target;
        state.front = randomFace(random);
        state.back = randomFace(random);

        BlockCoverage block{};
        block.x = 8;
        block.y = 8 * static_cast<int32_t>(random() % 2);
        for (uint32_t s = 0; s < kSamples; ++s)
            block.masks[s] = random() % 3 == 0 ? ~uint64_t{0} : uint64_t{random()} << 32 | random();
        const BlockCoverage before = block;
        const SamplePosition* positions = samplePositions(kSamples);
        // Depths of the fragment program's own, cut to the range; NaN is its lower end.
        constexpr float kExported[] = {-1, 0, 0.25f, 0.5f, 0.96875f, 1, 2, std::numeric_limits<float>::quiet_NaN()};
        std::array<float, 64> exported;
        for (float& z : exported) z = kExported[random() % std::size(kExported)];
        const bool exports = random() % 3 == 0;
        const DepthTestInput input{&plan,     blocks.target,
                                   &planes,   0,
                                   0,         kSamples,
                                   positions, primitive.front ? &state.front : &state.back,
                                   0,         exports ? exported.data() : nullptr};
        const uint32_t kept = stencilTestFunction(GetParam())(input, &block, 1);
        uint64_t any = 0;
        for (uint32_t s = 0; s < kSamples; ++s) {
            uint64_t passed = 0;
            for (int32_t bit = 0; bit < 64; ++bit) {
                if ((before.masks[s] >> bit & 1) == 0) continue;
                const int32_t x = block.x + bit % 8, y = block.y + bit / 8;
                const float own = exported[static_cast<size_t>(bit)];
                const float z = exports ? (own > planes.zLow ? std::min(own, planes.zHigh) : planes.zLow)
                                        : depthAt(planes, x, y, positions[s].x(), positions[s].y());
                if (testSample(state, state.target.texel(x, y, s), z, primitive.front)) passed |= uint64_t{1} << bit;
            }
            ASSERT_EQ(block.masks[s], passed) << "round " << round << " sample " << s;
            any |= passed;
        }
        ASSERT_EQ(kept, any != 0 ? 1u : 0u);
        ASSERT_EQ(one.bytes, blocks.bytes) << "round " << round;
    }
}

INSTANTIATE_TEST_SUITE_P(All, StencilBlocksTest, testing::ValuesIn(availableIsas()),
                         [](const auto& isa) { return std::string(isaName(isa.param)); });

}  // namespace
}  // namespace vernier
