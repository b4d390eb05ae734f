// Every elementwise operation against the plain evaluator, with rows and scalars as operands, on every
// instruction set.
#include <bit>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "spirv_interp/ir/builder.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"
#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/ir_evaluator.h"

namespace vernier {
namespace {

using ir::Op;
using ir::Type;

constexpr uint32_t kLanes = 64;

/// Values that arithmetic stumbles over, and random ones.
uint64_t interesting(Type type, std::mt19937_64& random) {
    static const float kFloats[] = {
        0.0f,  -0.0f,         1.0f,           -1.0f,         0.5f,          -0.5f,       1.5f,      2.5f,
        -2.5f, INFINITY,      -INFINITY,      NAN,           1e-40f,        -1e-42f,     0x1p-126f, 0x1.fffffep127f,
        3.0f,  2147483648.0f, -2147483648.0f, 4294967296.0f, 4294967040.0f, 0.99999994f, -1e-9f,    8388609.0f};
    static const int64_t kIntegers[] = {0,  1,   -1,        2,         31,        32,        33, 63, 64,
                                        65, 127, INT32_MIN, INT32_MAX, INT64_MIN, INT64_MAX, 7,  -7};
    const uint64_t raw = random();
    const uint64_t kind = random() % 4;
    switch (type) {
        case Type::b1:
            return raw & 1 ? 0xFFFFFFFFu : 0;
        case Type::f32:
            if (kind == 0) return std::bit_cast<uint32_t>(kFloats[raw % std::size(kFloats)]);
            if (kind == 1) return static_cast<uint32_t>(raw);
            return std::bit_cast<uint32_t>(static_cast<float>(static_cast<int64_t>(raw)) * 0x1p-58f);
        case Type::f64:
            if (kind == 0) return std::bit_cast<uint64_t>(static_cast<double>(kFloats[raw % std::size(kFloats)]));
            if (kind == 1) return raw;
            return std::bit_cast<uint64_t>(static_cast<double>(static_cast<int64_t>(raw)) * 0x1p-58);
        case Type::i32:
            return static_cast<uint32_t>(kind < 2 ? kIntegers[raw % std::size(kIntegers)] : static_cast<int64_t>(raw));
        default:
            return kind < 2 ? static_cast<uint64_t>(kIntegers[raw % std::size(kIntegers)]) : raw;
    }
}

bool isNan(Type type, uint64_t bits) {
    if (type == Type::f32) return std::isnan(std::bit_cast<float>(static_cast<uint32_t>(bits)));
    return type == Type::f64 && std::isnan(std::bit_cast<double>(bits));
}

constexpr Type kTypes[] = {Type::b1, Type::i32, Type::f32, Type::i64, Type::f64};

/// Builds programs of one operation with given operand types; `constants` bit k makes operand k a constant.
struct OpCase {
    Op op;
    Type result;
    std::vector<Type> operands;
};

/// Where the operation stands: alone between rows, or in a chain of operations, where operands and results go through
/// the accumulator.
struct Chain {
    static constexpr uint32_t kNoOperand = ~0u;
    uint32_t operand = kNoOperand;  // computed right before the operation
    bool same = false;              // operands of its type are the same value
    bool result = false;            // used by another operation right behind
};

class OpRun {
  public:
    OpRun(const OpCase& c, uint32_t constants, const Chain& chain, std::mt19937_64& random) : case_(c) {
        ir::Builder builder(program_);
        program_.stage = ir::Stage::fragment;
        builder.setBlock(builder.newBlock());
        std::vector<ir::ValueId> operands;
        for (size_t k = 0; k < c.operands.size(); ++k) {
            const Type type = c.operands[k];
            std::vector<uint64_t> bits(kLanes);
            for (uint64_t& b : bits) b = interesting(type, random);
            if (constants >> k & 1) bits.assign(kLanes, bits[0]);
            const bool chained = k == chain.operand && (constants >> k & 1) == 0 && !ir::isWide(type);
            operands.push_back(constants >> k & 1 ? builder.constant(type, bits[0])
                                                  : input(builder, chained ? inverted(type) : type, bits, chained));
            values_.push_back(std::move(bits));
        }
        if (const uint32_t k = chain.operand; k < operands.size() && (constants >> k & 1) == 0) {
            const Type type = c.operands[k];
            if (!ir::isWide(type)) operands[k] = invert(builder, operands[k], inverted(type), type);
            for (size_t j = 0; j < operands.size(); ++j) {
                if (!chain.same || c.operands[j] != type || (constants >> j & 1) != 0) continue;
                operands[j] = operands[k];
                values_[j] = values_[k];
            }
        }
        uint64_t imm = 0;
        if (ir::immKind(c.op) == ir::ImmKind::type) imm = static_cast<uint64_t>(c.operands[0]);
        ir::ValueId result = builder.append(c.op, c.result, operands, imm);
        if (ir::isWide(c.result)) {
            output(builder, builder.append(Op::lowWord, Type::i32, {result}), Type::i32);
            output(builder, builder.append(Op::highWord, Type::i32, {result}), Type::i32);
        } else if (chain.result) {
            invertedResult_ = true;
            output(builder, invert(builder, result, c.result, inverted(c.result)), inverted(c.result));
        } else {
            output(builder, result, c.result);
        }
        builder.ret();
    }

    bool isValid() const { return ir::verify(program_).ok(); }

    void check(Isa isa, uint32_t capacity, uint32_t lanes) const {
        test::RunSetup setup;
        setup.isa = isa;
        setup.capacity = capacity;
        setup.lanes = lanes;
        const test::RunResult run = test::runBatch(program_, inputs_, setup);
        for (uint32_t lane = 0; lane < lanes; ++lane) {
            std::vector<uint64_t> bits;
            for (const auto& operand : values_) bits.push_back(operand[lane]);
            const size_t typed = case_.op == Op::select ? 1 : 0;
            const uint64_t expected = test::evaluateOp(case_.op, case_.result, case_.operands[typed], bits, 0);
            uint64_t actual = run.outputs[0][lane];
            if (ir::isWide(case_.result)) actual |= uint64_t{run.outputs[1][lane]} << 32;
            if (invertedResult_) actual = ~actual & 0xFFFFFFFFu;
            if (isNan(case_.result, expected) && isNan(case_.result, actual)) continue;
            ASSERT_EQ(actual, expected) << ir::print(program_) << isaName(isa) << " lane " << lane << " operands "
                                        << std::hex << bits[0] << " " << (bits.size() > 1 ? bits[1] : 0) << " "
                                        << (bits.size() > 2 ? bits[2] : 0);
        }
    }

  private:
    ir::ValueId row(ir::Builder& builder, Type type, std::vector<uint32_t> words) {
        ir::InterfaceSlot slot;
        slot.location = static_cast<uint16_t>(program_.inputs.size());
        slot.type = type;
        program_.inputs.push_back(slot);
        inputs_.push_back(std::move(words));
        return builder.append(Op::input, type, {}, program_.inputs.size() - 1);
    }
    /// A value and its complement, by an operation that keeps the accumulator.
    static Type inverted(Type type) { return type == Type::b1 ? Type::b1 : Type::i32; }
    static ir::ValueId invert(ir::Builder& builder, ir::ValueId value, Type from, Type to) {
        if (from == Type::b1) return builder.append(Op::bnot, to, {value});
        if (from == Type::f32) value = builder.append(Op::bitcast, Type::i32, {value});
        value = builder.append(Op::inot, Type::i32, {value});
        return to == Type::f32 ? builder.append(Op::bitcast, to, {value}) : value;
    }
    ir::ValueId input(ir::Builder& builder, Type type, const std::vector<uint64_t>& bits, bool complement) {
        std::vector<uint32_t> low(bits.begin(), bits.end()), high;
        for (uint32_t& word : low) word = complement ? ~word : word;
        if (!ir::isWide(type)) return row(builder, type, low);
        for (const uint64_t b : bits) high.push_back(static_cast<uint32_t>(b >> 32));
        const ir::ValueId words[] = {row(builder, Type::i32, low), row(builder, Type::i32, high)};
        return builder.append(Op::makeWide, type, words);
    }
    void output(ir::Builder& builder, ir::ValueId value, Type type) {
        ir::InterfaceSlot slot;
        slot.location = static_cast<uint16_t>(program_.outputs.size());
        slot.type = type;
        program_.outputs.push_back(slot);
        builder.append(Op::storeOutput, Type::none, {value}, program_.outputs.size() - 1);
    }

    OpCase case_;
    ir::Program program_;
    std::vector<std::vector<uint32_t>> inputs_;
    std::vector<std::vector<uint64_t>> values_;
    bool invertedResult_ = false;
};

/// Typings of an operation; the verifier tells which of them there are.
std::vector<OpCase> casesOf(Op op) {
    std::vector<OpCase> cases;
    ir::Program program;
    const uint32_t count = ir::opInfo(op).operands;
    for (const Type result : kTypes) {
        if ((ir::resultTypes(op) >> static_cast<int>(result) & 1) == 0) continue;
        if (op == Op::finverseSqrt && result == Type::f32) continue;  // follows the tier: batch_math_test
        for (const Type first : kTypes) {
            const bool typed = ir::immKind(op) == ir::ImmKind::type;
            if (!typed && first != kTypes[0]) break;
            ir::Inst inst;
            inst.op = op;
            inst.type = result;
            inst.operandCount = static_cast<uint16_t>(count);
            inst.imm = static_cast<uint64_t>(first);
            // Operations with several possible operand types (lowWord, bitcast) are tried with each.
            std::vector<OpCase> partial{{op, result, {}}};
            for (uint32_t k = 0; k < count; ++k) {
                const uint32_t allowed = ir::operandTypes(program, inst, k);
                std::vector<OpCase> longer;
                for (const OpCase& c : partial) {
                    for (const Type type : kTypes) {
                        if ((allowed >> static_cast<int>(type) & 1) == 0) continue;
                        longer.push_back(c);
                        longer.back().operands.push_back(type);
                    }
                }
                partial = std::move(longer);
            }
            cases.insert(cases.end(), partial.begin(), partial.end());
        }
    }
    return cases;
}

class EveryOp : public testing::TestWithParam<Op> {};

TEST_P(EveryOp, MatchesTheEvaluator) {
    std::mt19937_64 random(static_cast<uint64_t>(GetParam()));
    const std::vector<OpCase> cases = casesOf(GetParam());
    uint32_t valid = 0;
    for (const OpCase& c : cases) {
        for (uint32_t constants = 0; constants < 1u << c.operands.size(); ++constants) {
            for (int repeat = 0; repeat < 8; ++repeat) {
                Chain chain;
                if (repeat % 4 != 3) chain.operand = static_cast<uint32_t>(repeat) % 4;
                chain.same = repeat == 4;
                chain.result = repeat >= 3;
                const OpRun run(c, constants, chain, random);
                if (!run.isValid()) continue;
                ++valid;
                for (const Isa isa : test::isas()) {
                    run.check(isa, 64, 64);
                    run.check(isa, repeat % 2 == 0 ? 32 : 16, 4 + 4 * static_cast<uint32_t>(repeat));
                    if (HasFatalFailure()) return;
                }
            }
        }
    }
    EXPECT_GT(valid, 0u);
}

std::vector<Op> evaluatedOps() {
    std::vector<Op> ops;
    for (uint32_t k = 0; k <= static_cast<uint32_t>(Op::kill); ++k) {
        if (test::isEvaluated(static_cast<Op>(k))) ops.push_back(static_cast<Op>(k));
    }
    return ops;
}

INSTANTIATE_TEST_SUITE_P(BatchOps, EveryOp, testing::ValuesIn(evaluatedOps()),
                         [](const auto& instance) { return std::string(ir::opInfo(instance.param).name); });

/// IEEE binary16, straight from its definition.
double halfValue(uint32_t half) {
    const double sign = half & 0x8000 ? -1.0 : 1.0;
    const int exponent = static_cast<int>(half >> 10 & 31), mantissa = static_cast<int>(half & 1023);
    if (exponent == 31) return mantissa != 0 ? NAN : sign * INFINITY;
    return sign * (exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25));
}

TEST(BatchHalf, UnpacksEveryHalf) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
output 0 f32 user 0.0
output 1 f32 user 1.0
b0:
  %0 i32 = input #0
  %1 f32 = unpackHalfLow %0
  %2 f32 = unpackHalfHigh %0
  storeOutput #0 %1
  storeOutput #1 %2
  ret
)");
    for (const Isa isa : test::isas()) {
        for (uint32_t first = 0; first < 65536; first += 64) {
            std::vector<uint32_t> words(64);
            for (uint32_t k = 0; k < 64; ++k) words[k] = (first + k) | (65535 - first - k) << 16;
            test::RunSetup setup;
            setup.isa = isa;
            const test::RunResult run = test::runBatch(program, {words}, setup);
            for (uint32_t k = 0; k < 64; ++k) {
                const double low = halfValue(words[k] & 0xFFFF), high = halfValue(words[k] >> 16);
                const float gotLow = std::bit_cast<float>(run.outputs[0][k]),
                            gotHigh = std::bit_cast<float>(run.outputs[1][k]);
                ASSERT_TRUE(std::isnan(low) ? std::isnan(gotLow) : gotLow == low) << words[k];
                ASSERT_TRUE(std::isnan(high) ? std::isnan(gotHigh) : gotHigh == high) << words[k];
            }
        }
    }
}

TEST(BatchHalf, PacksToTheNearest) {
    std::mt19937 random(2);
    std::vector<float> xs;
    for (uint32_t half = 0; half < 0x7C00; half += 3) {
        // A half, its midpoint to the next, and the floats on both sides of that.
        const auto here = static_cast<float>(halfValue(half));
        const auto middle =
            static_cast<float>((halfValue(half) + (half == 0x7BFF ? 65536.0 : halfValue(half + 1))) / 2);
        for (const float x : {here, middle, std::nextafter(middle, 0.0f), std::nextafter(middle, 1e9f)}) {
            xs.push_back(random() & 1 ? x : -x);
        }
    }
    xs.insert(xs.end(), {65519.0f, 65520.0f, -65536.0f, INFINITY, -INFINITY, 1e-9f, 0.0f, -0.0f});
    while (xs.size() % 64 != 0) xs.push_back(1.0f);
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 f32 user 0.0 flat center
output 0 i32 user 0.0
output 1 f32 user 1.0
b0:
  %0 f32 = input #0
  %1 i32 = packHalf %0 %0
  %2 f32 = quantizeF16 %0
  storeOutput #0 %1
  storeOutput #1 %2
  ret
)");
    for (size_t first = 0; first < xs.size(); first += 64) {
        std::vector<uint32_t> words;
        for (size_t k = 0; k < 64; ++k) words.push_back(std::bit_cast<uint32_t>(xs[first + k]));
        const test::RunResult run = test::runBatch(program, {words}, {});
        for (size_t k = 0; k < 64; ++k) {
            const float x = xs[first + k];
            const uint32_t packed = run.outputs[0][k], half = packed & 0xFFFF;
            ASSERT_EQ(half, packed >> 16);
            ASSERT_EQ(std::signbit(x), (half & 0x8000) != 0);
            // No half is nearer, and of two equally near ones the even one was taken.
            const double got = std::fabs(halfValue(half)), wanted = std::fabs(x);
            if (wanted >= 65520) {
                ASSERT_TRUE(std::isinf(got)) << x;
                continue;
            }
            const uint32_t magnitude = half & 0x7FFF;
            const double error = std::fabs(got - wanted);
            for (const uint32_t other : {magnitude - 1, magnitude + 1}) {
                if (other > 0x7BFF) continue;
                const double otherError = std::fabs(halfValue(other) - wanted);
                ASSERT_TRUE(error < otherError || (error == otherError && magnitude % 2 == 0)) << x;
            }
            const float quantized = std::bit_cast<float>(run.outputs[1][k]);
            ASSERT_EQ(quantized, magnitude < 0x400 ? 0.0f : std::copysign(static_cast<float>(got), x));
        }
    }
}

}  // namespace
}  // namespace vernier
