// The routines for whole blocks of four 8-bit components against the general path: the same bytes.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "runtime/raster/color_block.h"
#include "runtime/raster/color_output.h"

namespace vernier {
namespace {

constexpr uint32_t kLanes = 64, kSide = 8;
constexpr VkFormat kFormats[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB,
                                 VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_A8B8G8R8_UNORM_PACK32};

constexpr VkBlendFactor kZero = VK_BLEND_FACTOR_ZERO, kOne = VK_BLEND_FACTOR_ONE, kAlpha = VK_BLEND_FACTOR_SRC_ALPHA,
                        kRest = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;

/// Colour source, colour destination, alpha source, alpha destination; the first stands for no blending.
constexpr std::array<VkBlendFactor, 4> kEquations[] = {
    {kOne, kZero, kOne, kZero},     {kAlpha, kRest, kOne, kRest},
    {kAlpha, kRest, kAlpha, kRest}, {kAlpha, kRest, kOne, kZero},
    {kAlpha, kRest, kZero, kOne},   {kOne, kRest, kOne, kRest},
    {kAlpha, kOne, kAlpha, kOne},   {kAlpha, kOne, kOne, kOne},
    {kAlpha, kOne, kZero, kOne},    {kOne, kOne, kOne, kOne},
    {kOne, kOne, kZero, kOne},      {kAlpha, kRest, VK_BLEND_FACTOR_SRC_COLOR, VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR}};

ColorPlan planOf(VkFormat format, const std::array<VkBlendFactor, 4>& equation, VkColorComponentFlags mask, Isa isa) {
    ColorPlan plan;
    plan.format = format;
    plan.ops = formatOps(format, isa);
    plan.texelBytes = 4;
    plan.clampInputs = true;
    const bool blends = equation != kEquations[0];
    plan.path = blends ? ColorPath::blend : ColorPath::store;
    plan.partialMask = mask != 0xF;
    plan.readsDestination = blends || plan.partialMask;
    componentBits(*findFormat(format), mask, plan.writeBits.data());
    plan.blend.blendEnable = blends ? VK_TRUE : VK_FALSE;
    plan.blend.srcColorBlendFactor = equation[0];
    plan.blend.dstColorBlendFactor = equation[1];
    plan.blend.srcAlphaBlendFactor = equation[2];
    plan.blend.dstAlphaBlendFactor = equation[3];
    plan.blend.colorBlendOp = plan.blend.alphaBlendOp = VK_BLEND_OP_ADD;
    return plan;
}

/// Two attachments of one block with the same texels, and planes to write to them.
struct Fixture {
    std::array<uint32_t, kLanes> general{}, special{};
    alignas(64) std::array<std::array<float, kLaneRoom>, 4> planes{};
    alignas(64) std::array<uint32_t, kLaneRoom> mask{};
    FragmentBatch batch;
    ColorScratch scratch;

    explicit Fixture(LaneOrder order) {
        batch.order = order;
        batch.count = kLanes;
    }

    void run(const ColorPlan& plan, bool masked, Isa isa) {
        RenderTarget target;
        target.format = plan.format;
        target.data = reinterpret_cast<std::byte*>(general.data());
        target.rowPitch = kSide * 4;
        const std::array<float, 4> constants{};
        ColorOutputInput input{};
        input.plan = &plan;
        input.target = &target;
        input.batch = &batch;
        input.blend = blendFunction(isa);
        input.constants = constants.data();
        BlockColorInput block{};
        block.plan = &plan;
        block.texels = reinterpret_cast<std::byte*>(special.data());
        block.rowPitch = target.rowPitch;
        block.order = batch.order;
        block.lanes = kLanes;
        for (uint32_t c = 0; c < 4; ++c) block.source[c] = input.source[c] = planes[c].data();
        if (masked) block.mask = input.mask = mask.data();
        outputColors(input, scratch);
        const BlockColorFn routine = blockColorFunction(plan, isa);
        ASSERT_NE(routine, nullptr);
        routine(block);
    }
};

/// Calls test(isa, format, equation, order).
template <class Test>
void forEachRoutine(const Test& test) {
    for (const Isa isa : availableIsas())
        for (const VkFormat format : kFormats)
            for (const auto& equation : kEquations)
                for (const LaneOrder order : {LaneOrder::rows, LaneOrder::quads}) {
                    SCOPED_TRACE(std::string(isaName(isa)) + ", format " + std::to_string(format) + ", factors " +
                                 std::to_string(equation[0]) + " " + std::to_string(equation[1]) + " " +
                                 std::to_string(equation[2]) + " " + std::to_string(equation[3]) +
                                 (order == LaneOrder::rows ? ", rows" : ", quads"));
                    test(isa, format, equation, order);
                    if (testing::Test::HasFailure()) return;
                }
}

TEST(ColorBlock, RandomColorsAndMasks) {
    forEachRoutine([](Isa isa, VkFormat format, const std::array<VkBlendFactor, 4>& equation, LaneOrder order) {
        const auto fixture = std::make_unique<Fixture>(order);
        std::mt19937 random(17);
        std::uniform_real_distribution<float> uniform(-0.25f, 1.25f);
        constexpr float kSpecial[] = {0.0f,
                                      -0.0f,
                                      1.0f,
                                      0x1.fffffep-1f,
                                      0x1.000002p0f,
                                      std::numeric_limits<float>::infinity(),
                                      -std::numeric_limits<float>::infinity(),
                                      std::numeric_limits<float>::quiet_NaN(),
                                      0x1p-149f,
                                      -0x1p-149f,
                                      0.5f / 255};
        for (int round = 0; round < 64; ++round) {
            for (uint32_t lane = 0; lane < kLanes; ++lane) {
                fixture->general[lane] = random();
                fixture->mask[lane] = random() % 2 == 0 ? ~0u : 0u;
                for (auto& plane : fixture->planes)
                    plane[lane] = random() % 8 == 0 ? kSpecial[random() % std::size(kSpecial)] : uniform(random);
            }
            fixture->special = fixture->general;
            const VkColorComponentFlags components = round % 4 == 3 ? 1 + random() % 14 : 0xF;
            fixture->run(planOf(format, equation, components, isa), round % 2 == 1, isa);
            ASSERT_EQ(fixture->general, fixture->special) << "round " << round;
        }
    });
}

/// Every stored code meets every alpha code, and sources halfway between codes.
TEST(ColorBlock, AllCodes) {
    forEachRoutine([](Isa isa, VkFormat format, const std::array<VkBlendFactor, 4>& equation, LaneOrder order) {
        const auto fixture = std::make_unique<Fixture>(order);
        const ColorPlan plan = planOf(format, equation, 0xF, isa);
        for (uint32_t alpha = 0; alpha < 256; ++alpha) {
            for (uint32_t first = 0; first < 256; first += kLanes) {
                for (uint32_t lane = 0; lane < kLanes; ++lane) {
                    const uint32_t code = first + lane;
                    fixture->general[lane] = code * 0x01010101u;
                    fixture->planes[0][lane] = static_cast<float>(code) / 255;
                    fixture->planes[1][lane] = (static_cast<float>(code) + 0.5f) / 255;
                    fixture->planes[2][lane] = static_cast<float>(255 - code) / 255;
                    fixture->planes[3][lane] = static_cast<float>(alpha) / 255;
                }
                fixture->special = fixture->general;
                fixture->run(plan, false, isa);
                ASSERT_EQ(fixture->general, fixture->special) << "alpha " << alpha << ", codes from " << first;
            }
        }
    });
}

TEST(ColorBlock, LeavesTheRestToTheGeneralPath) {
    const Isa isa = bestIsa();
    ColorPlan plan = planOf(VK_FORMAT_R8G8B8A8_UNORM, kEquations[1], 0xF, isa);
    EXPECT_NE(blockColorFunction(plan, isa), nullptr);
    plan.blend.colorBlendOp = VK_BLEND_OP_SUBTRACT;
    EXPECT_EQ(blockColorFunction(plan, isa), nullptr);
    plan = planOf(VK_FORMAT_R8G8B8A8_UNORM, {VK_BLEND_FACTOR_DST_COLOR, kZero, kOne, kZero}, 0xF, isa);
    EXPECT_EQ(blockColorFunction(plan, isa), nullptr);
    plan = planOf(VK_FORMAT_R8G8B8A8_UNORM, kEquations[0], 0xF, isa);
    plan.path = ColorPath::logic;
    EXPECT_EQ(blockColorFunction(plan, isa), nullptr);
    plan = planOf(VK_FORMAT_A2B10G10R10_UNORM_PACK32, kEquations[0], 0xF, isa);
    EXPECT_EQ(blockColorFunction(plan, isa), nullptr);
}

}  // namespace
}  // namespace vernier
