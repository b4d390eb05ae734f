// Accuracy of the transcendental functions by tier, against long double: the error in ULP (or absolute where
// the Vulkan specification bounds it so), the exact values and limits, and the same bits on every instruction
// set.
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"

namespace vernier {
namespace {

using Function = long double (*)(long double);

/// The spacing of floats around the exact result: the specification's ULP.
double ulpOf(long double exact) {
    const long double magnitude = std::fabs(exact);
    if (magnitude < 0x1p-126L) return 0x1p-149;
    return static_cast<double>(std::ldexp(1.0L, std::ilogb(magnitude) - 23));
}

struct Case {
    ir::Op op;
    Function exact;
    float low, high;
    bool absolute;     // error measured as a difference, not in ULP
    double limits[3];  // fast, standard; fine and reference
};

constexpr double kTwo = 0x1p-11;

long double inverseSqrt(long double x) {
    return 1 / std::sqrt(x);
}

const Case kCases[] = {
    {ir::Op::fsin, std::sin, -3.14159274f, 3.14159274f, true, {kTwo, 0x1p-22, 0x1p-24}},
    {ir::Op::fsin, std::sin, -3.14159274f, 3.14159274f, false, {1e9, 4, 0.51}},
    {ir::Op::fcos, std::cos, -3.14159274f, 3.14159274f, true, {kTwo, 0x1p-22, 0x1p-24}},
    {ir::Op::fsin, std::sin, -1e4f, 1e4f, true, {kTwo, 0x1p-22, 0x1p-24}},
    {ir::Op::fcos, std::cos, -0x1p30f, 0x1p30f, true, {kTwo, 0x1p-22, 0x1p-24}},
    {ir::Op::ftan, std::tan, -1.5f, 1.5f, false, {1e4, 5, 0.51}},
    {ir::Op::fasin, std::asin, -1.0f, 1.0f, false, {4096, 4, 0.51}},
    {ir::Op::facos, std::acos, -1.0f, 1.0f, false, {1e6, 4, 0.51}},
    {ir::Op::fatan, std::atan, -100.0f, 100.0f, false, {4096, 4, 0.51}},
    {ir::Op::fsinh, std::sinh, -89.0f, 89.0f, false, {2e4, 4, 0.51}},
    {ir::Op::fcosh, std::cosh, -89.0f, 89.0f, false, {2e4, 4, 0.51}},
    {ir::Op::ftanh, std::tanh, -10.0f, 10.0f, false, {2e4, 5, 0.51}},
    {ir::Op::fasinh, std::asinh, -1e6f, 1e6f, false, {2e4, 5, 0.51}},
    {ir::Op::facosh, std::acosh, 1.0f, 1e6f, false, {2e4, 5, 0.51}},
    {ir::Op::fatanh, std::atanh, -0.999f, 0.999f, false, {2e4, 6, 0.51}},
    {ir::Op::fexp, std::exp, -87.0f, 88.0f, false, {2e4, 2, 0.51}},
    {ir::Op::fexp2, std::exp2, -140.0f, 127.9f, false, {2e4, 2, 0.51}},
    {ir::Op::flog, std::log, 0.0f, 100.0f, false, {2e4, 3, 0.51}},
    {ir::Op::flog2, std::log2, 0.0f, 100.0f, false, {2e4, 3, 0.51}},
    {ir::Op::flog2, std::log2, 0.5f, 2.0f, true, {kTwo, 0x1p-22, 0x1p-24}},
    {ir::Op::finverseSqrt, inverseSqrt, 0.0f, 100.0f, false, {256, 1.5, 0.51}},
    {ir::Op::fsin, std::sin, 0x1p19f, 0x1p127f, true, {kTwo, 0x1p-22, 0x1p-24}},
    {ir::Op::fcos, std::cos, -0x1p127f, 0x1p127f, true, {kTwo, 0x1p-22, 0x1p-24}},
    {ir::Op::ftan, std::tan, -0x1p40f, 0x1p40f, false, {8192, 5, 0.51}},
};

constexpr MathTier kTiers[] = {MathTier::fast, MathTier::standard, MathTier::fine, MathTier::reference};

/// Evenly spaced arguments, random ones, and ones near zero.
std::vector<float> samples(float low, float high) {
    constexpr int kCount = 40000;
    std::vector<float> values;
    for (int k = 0; k <= kCount; ++k) {
        values.push_back(static_cast<float>(low + (static_cast<double>(high) - low) * k / kCount));
    }
    std::mt19937 random(7);
    for (int k = 0; k < kCount; ++k) {
        const float tiny =
            std::ldexp(1.0f + static_cast<float>(random() % 8388608) * 0x1p-23f, -(k % 40)) * (k & 1 ? 1.0f : -1.0f);
        if (tiny >= low && tiny <= high) values.push_back(tiny);
        const float near = low + tiny;
        if (near >= low && near <= high) values.push_back(near);
    }
    return values;
}

TEST(BatchMath, AccuracyByTier) {
    std::printf("%-8s %12s %12s  %-4s %12s %12s %12s %12s\n", "function", "from", "to", "in", "fast", "standard",
                "fine", "reference");
    for (const Case& c : kCases) {
        const std::vector<float> xs = samples(c.low, c.high);
        double errors[4];
        for (size_t tier = 0; tier < 4; ++tier) {
            const std::vector<float> ys = test::evaluate(c.op, {xs}, bestIsa(), kTiers[tier]);
            errors[tier] = 0;
            for (size_t k = 0; k < xs.size(); ++k) {
                const long double exact = c.exact(xs[k]);
                if (!std::isfinite(exact)) continue;
                const double error = std::fabs(static_cast<double>(ys[k] - exact)) / (c.absolute ? 1.0 : ulpOf(exact));
                if (!(error <= errors[tier])) errors[tier] = error;
            }
            EXPECT_LE(errors[tier], c.limits[std::min<size_t>(tier, 2)]) << ir::opInfo(c.op).name << " tier " << tier;
        }
        std::printf("%-8s %12g %12g  %-4s %12.4g %12.4g %12.4g %12.4g\n", std::string(ir::opInfo(c.op).name).c_str(),
                    c.low, c.high, c.absolute ? "abs" : "ulp", errors[0], errors[1], errors[2], errors[3]);
    }
}

TEST(BatchMath, PowAndAtan2) {
    std::mt19937 random(3);
    std::vector<float> xs, ys;
    for (int k = 0; k < 60000; ++k) {
        xs.push_back(static_cast<float>(random() % 100000 + 1) / 1000.0f);
        ys.push_back(static_cast<float>(static_cast<int>(random() % 20000) - 10000) / 1000.0f);
    }
    // Vulkan: pow inherits from exp2(y log2 x): an error of 3 ULP in log2 x, times y, through exp2.
    const double tierError[] = {0x1p-11, 0x1p-21, 0x1p-30, 0x1p-45};
    for (size_t tier = 0; tier < 4; ++tier) {
        const std::vector<float> power = test::evaluate(ir::Op::fpow, {xs, ys}, bestIsa(), kTiers[tier]);
        const std::vector<float> angle = test::evaluate(ir::Op::fatan2, {ys, xs}, bestIsa(), kTiers[tier]);
        double worst = 0, worstAngle = 0;
        for (size_t k = 0; k < xs.size(); ++k) {
            const long double exact = std::pow(static_cast<long double>(xs[k]), static_cast<long double>(ys[k]));
            const double error = std::fabs(static_cast<double>((power[k] - exact) / exact));
            const double product = std::fabs(ys[k] * std::log2(static_cast<double>(xs[k])));
            const double allowed = 0x1p-24 + tierError[tier] * (1 + product + std::fabs(ys[k]) * 0.25);
            EXPECT_LE(error, allowed * 1.01) << xs[k] << " ^ " << ys[k] << " tier " << tier;
            worst = std::max(worst, error * 0x1p24);
            const long double exactAngle = std::atan2(static_cast<long double>(ys[k]), static_cast<long double>(xs[k]));
            if (exactAngle == 0) continue;
            worstAngle =
                std::max(worstAngle, std::fabs(static_cast<double>(angle[k] - exactAngle)) / ulpOf(exactAngle));
        }
        std::printf("tier %zu: pow %.4g units of 2^-24, atan2 %.4g ulp\n", tier, worst, worstAngle);
        EXPECT_LE(worstAngle, tier == 0 ? 4096 : tier == 1 ? 4 : 0.51);
    }
}

TEST(BatchMath, ExactValuesAndLimits) {
    const float inf = std::numeric_limits<float>::infinity();
    const auto one = [](ir::Op op, std::vector<std::vector<float>> operands, MathTier tier) {
        return test::evaluate(op, operands, bestIsa(), tier)[0];
    };
    for (const MathTier tier : kTiers) {
        for (int k = -149; k <= 127; ++k) {
            EXPECT_EQ(one(ir::Op::fexp2, {{static_cast<float>(k)}}, tier), std::ldexp(1.0f, k));
            EXPECT_EQ(one(ir::Op::flog2, {{std::ldexp(1.0f, k)}}, tier), static_cast<float>(k));
        }
        EXPECT_EQ(one(ir::Op::fexp2, {{128.0f}}, tier), inf);
        EXPECT_EQ(one(ir::Op::fexp2, {{-160.0f}}, tier), 0.0f);
        EXPECT_EQ(one(ir::Op::fexp, {{-inf}}, tier), 0.0f);
        EXPECT_EQ(one(ir::Op::fexp, {{inf}}, tier), inf);
        EXPECT_EQ(one(ir::Op::fexp, {{0.0f}}, tier), 1.0f);
        EXPECT_EQ(one(ir::Op::flog, {{0.0f}}, tier), -inf);
        EXPECT_EQ(one(ir::Op::flog, {{inf}}, tier), inf);
        EXPECT_TRUE(std::isnan(one(ir::Op::flog, {{-1.0f}}, tier)));
        EXPECT_EQ(one(ir::Op::fpow, {{0.0f}, {0.0f}}, tier), 1.0f);
        EXPECT_EQ(one(ir::Op::fpow, {{0.0f}, {2.0f}}, tier), 0.0f);
        EXPECT_EQ(one(ir::Op::fpow, {{0.0f}, {-2.0f}}, tier), inf);
        EXPECT_EQ(one(ir::Op::fpow, {{1.0f}, {inf}}, tier), 1.0f);
        EXPECT_EQ(one(ir::Op::fpow, {{2.0f}, {10.0f}}, tier), 1024.0f);
        EXPECT_TRUE(std::isnan(one(ir::Op::fpow, {{-2.0f}, {0.5f}}, tier)));
        EXPECT_EQ(one(ir::Op::fsinh, {{100.0f}}, tier), inf);
        EXPECT_EQ(one(ir::Op::ftanh, {{-100.0f}}, tier), -1.0f);
        EXPECT_EQ(one(ir::Op::fatanh, {{1.0f}}, tier), inf);
        EXPECT_TRUE(std::isnan(one(ir::Op::fatanh, {{1.5f}}, tier)));
        for (const float below : {0.5f, -0.5f, -1.0f, -1.5f, -1e9f, -3e38f, -inf})
            EXPECT_TRUE(std::isnan(one(ir::Op::facosh, {{below}}, tier))) << below;
        EXPECT_TRUE(std::isnan(one(ir::Op::fasin, {{1.5f}}, tier)));
        EXPECT_TRUE(std::isnan(one(ir::Op::fsin, {{inf}}, tier)));
        EXPECT_TRUE(std::isnan(one(ir::Op::fexp2, {{NAN}}, tier)));
        EXPECT_TRUE(std::isnan(one(ir::Op::fatan2, {{NAN}, {1.0f}}, tier)));
        // Quadrants and signed zeros of atan2.
        const float pi = 3.14159274f;
        const float angles[][3] = {{0.0f, 1.0f, 0.0f},
                                   {-0.0f, 1.0f, -0.0f},
                                   {0.0f, -1.0f, pi},
                                   {-0.0f, -1.0f, -pi},
                                   {1.0f, 0.0f, pi / 2},
                                   {-1.0f, 0.0f, -pi / 2},
                                   {0.0f, 0.0f, 0.0f},
                                   {-0.0f, -0.0f, -pi},
                                   {inf, inf, pi / 4},
                                   {1.0f, -inf, pi},
                                   {inf, 1.0f, pi / 2},
                                   {3e38f, 3e38f, pi / 4},
                                   {-1e-40f, -1e-40f, -3 * pi / 4}};
        for (const auto& [y, x, expected] : angles) {
            const float angle = one(ir::Op::fatan2, {{y}, {x}}, tier);
            EXPECT_NEAR(angle, expected, tier == MathTier::fast ? 1e-3 : 3e-7) << y << " " << x;
            EXPECT_EQ(std::signbit(angle), std::signbit(expected)) << y << " " << x;
        }
    }
}

TEST(BatchMath, SineStaysInRange) {
    std::mt19937 random(11);
    std::vector<float> xs(200000);
    for (float& x : xs) x = std::bit_cast<float>(static_cast<uint32_t>(random()));
    for (const MathTier tier : kTiers) {
        for (const ir::Op op : {ir::Op::fsin, ir::Op::fcos}) {
            for (const float y : test::evaluate(op, {xs}, bestIsa(), tier)) {
                EXPECT_FALSE(std::fabs(y) > 1.0f);
            }
        }
    }
}

TEST(BatchMath, LogarithmHasTheSignOfItsArgument) {
    std::vector<float> xs;
    for (int k = 1; k <= 20000; ++k) {
        xs.push_back(1.0f + static_cast<float>(k) * 0x1p-23f);
        xs.push_back(1.0f - static_cast<float>(k) * 0x1p-24f);
    }
    for (const MathTier tier : kTiers) {
        const std::vector<float> ys = test::evaluate(ir::Op::flog2, {xs}, bestIsa(), tier);
        for (size_t k = 0; k < xs.size(); ++k) EXPECT_EQ(ys[k] > 0, xs[k] > 1) << xs[k];
    }
}

TEST(BatchMath, SameBitsOnEveryInstructionSet) {
    std::mt19937 random(5);
    std::vector<float> xs(50000), ys(50000);
    for (float& x : xs) x = std::bit_cast<float>(static_cast<uint32_t>(random()));
    for (float& y : ys) y = std::bit_cast<float>(static_cast<uint32_t>(random()));
    for (const MathTier tier : kTiers) {
        for (uint32_t op = static_cast<uint32_t>(ir::Op::finverseSqrt); op <= static_cast<uint32_t>(ir::Op::fpow);
             ++op) {
            const auto irOp = static_cast<ir::Op>(op);
            std::vector<std::vector<float>> operands{xs};
            if (ir::opInfo(irOp).operands == 2) operands.push_back(ys);
            const std::vector<float> first = test::evaluate(irOp, operands, kLowestIsa, tier);
            for (const Isa isa : test::isas()) {
                EXPECT_TRUE(test::sameBits(first, test::evaluate(irOp, operands, isa, tier)))
                    << ir::opInfo(irOp).name << " " << isaName(isa);
            }
        }
    }
}

}  // namespace
}  // namespace vernier
