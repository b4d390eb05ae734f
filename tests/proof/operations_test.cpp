// Every instruction by itself, on operands at the edges of their types and on random ones, by batches and one
// invocation at a time.
#include <gtest/gtest.h>

#include "tests/proof/operations.h"
#include "tests/proof/random_module.h"

namespace vernier::proof {
namespace {

using Kind = Expression::Kind;

ExpressionPtr make(Kind kind, ValueType type, std::vector<ExpressionPtr> args = {}, uint32_t op = 0,
                   uint32_t index = 0) {
    auto e = std::make_shared<Expression>();
    e->kind = kind;
    e->type = type;
    e->args = std::move(args);
    e->op = op;
    e->index = index;
    return e;
}

constexpr ValueType kBool{Base::boolean, 1, 1}, kU32{Base::u32, 1, 1};

/// Operand `k` of an instruction, of any base: words of the inputs, other ones for every operand.
ExpressionPtr operand(Base base, uint32_t k) {
    const auto word = [](uint32_t input, uint32_t component) {
        constexpr Base kBases[] = {Base::f32, Base::i32, Base::u32};
        return make(Kind::extract, {kBases[input], 1, 1}, {make(Kind::input, {kBases[input], 4, 1}, {}, 0, input)}, 0,
                    component);
    };
    switch (base) {
        case Base::f32:
            return word(0, k % 4);
        case Base::i32:
            return word(1, k % 4);
        case Base::u32:
            return word(2, k % 4);
        case Base::boolean:
            return make(Kind::op, kBool, {word(1, k % 4), word(2, k % 4)}, spv::OpSLessThan);
        case Base::i8:
        case Base::i16:
            return make(Kind::op, {base, 1, 1}, {word(1, k % 4)}, spv::OpSConvert);
        case Base::u8:
        case Base::u16:
            return make(Kind::op, {base, 1, 1}, {word(2, k % 4)}, spv::OpUConvert);
        case Base::f16: {
            // The low half of a word, so that every code occurs.
            ExpressionPtr code = make(Kind::op, {Base::u16, 1, 1}, {word(2, k % 4)}, spv::OpUConvert);
            return make(Kind::op, {base, 1, 1}, {std::move(code)}, spv::OpBitcast);
        }
        default: {
            // Two words, so that every bit pattern occurs.
            ExpressionPtr low = word(2, k % 4), high = make(Kind::op, kU32, {word(1, (k + 1) % 4)}, spv::OpBitcast);
            ExpressionPtr pair = make(Kind::construct, {Base::u32, 2, 1}, {std::move(low), std::move(high)});
            return make(Kind::op, {base, 1, 1}, {std::move(pair)}, spv::OpBitcast);
        }
    }
}

std::shared_ptr<Statement> assign(uint32_t variable, ExpressionPtr value, uint64_t component) {
    auto s = std::make_shared<Statement>();
    s->index = variable;
    s->args = {std::move(value)};
    s->literal = component;
    return s;
}

/// A program whose outputs hold the value, bit by bit unless it is a NaN.
RandomProgram programOf(const ExpressionPtr& value) {
    RandomProgram program;
    constexpr Base kBases[] = {Base::f32, Base::i32, Base::u32};
    for (const Base base : kBases) program.variables.push_back({{base, 4, 1}, 0, true});
    program.functions.resize(1);
    Statements& body = program.functions[0].body;
    switch (value->type.base) {
        case Base::f32:
            body.push_back(assign(0, value, 0));
            break;
        case Base::i32:
            body.push_back(assign(1, value, 0));
            break;
        case Base::u32:
            body.push_back(assign(2, value, 0));
            break;
        case Base::f16:
            body.push_back(assign(0, make(Kind::op, {Base::f32, 1, 1}, {value}, spv::OpFConvert), 0));
            break;
        case Base::i8:
        case Base::i16:
            body.push_back(assign(1, make(Kind::op, {Base::i32, 1, 1}, {value}, spv::OpSConvert), 0));
            break;
        case Base::u8:
        case Base::u16:
            body.push_back(assign(2, make(Kind::op, kU32, {value}, spv::OpUConvert), 0));
            break;
        case Base::boolean: {
            ExpressionPtr one = make(Kind::constant, kU32), zero = make(Kind::constant, kU32);
            one->literal = 1;
            body.push_back(assign(2, make(Kind::op, kU32, {value, one, zero}, spv::OpSelect), 0));
            break;
        }
        default: {
            ExpressionPtr whole = value;
            if (value->type.base == Base::f64) {
                ExpressionPtr zero = make(Kind::constant, value->type);
                whole = make(Kind::op, value->type, {make(Kind::op, kBool, {value}, spv::OpIsNan), zero, value},
                             spv::OpSelect);
            }
            const ExpressionPtr pair = make(Kind::op, {Base::u32, 2, 1}, {whole}, spv::OpBitcast);
            for (uint32_t k = 0; k < 2; ++k) body.push_back(assign(2, make(Kind::extract, kU32, {pair}, 0, k), k));
        }
    }
    return program;
}

void prove(const ExpressionPtr& value, const std::string& what) {
    const RandomProgram program = programOf(value);
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Case subject = caseOf(program, seed);
        subject.name = what + ", seed " + std::to_string(seed);
        subject.invocations = 128;
        for (uint32_t location = 0; location < 3; ++location)
            subject.world.inputAt[location] = {Filling::Kind::special, 0, 0};
        ProofOptions options;
        options.lanes = {seed % 2 == 0 ? 16u : 64u};
        options.allShapes = seed == 1;
        const std::string text = differences(subject, options);
        EXPECT_EQ(text, "") << what;
        if (!text.empty()) return;
    }
}

std::string nameOf(const Operation& o, Base base) {
    return (o.extended ? "GLSL.std.450 instruction " : "opcode ") + std::to_string(o.op) + " on base " +
           std::to_string(static_cast<int>(base));
}

void proveOf(const Operation& o, Base base, Base result) {
    std::vector<ExpressionPtr> args;
    for (uint32_t k = 0; k < o.operands; ++k) args.push_back(operand(base, k));
    prove(make(o.extended ? Kind::extended : Kind::op, {result, 1, 1}, std::move(args), o.op), nameOf(o, base));
}

TEST(Operations, OfFloats) {
    for (const Operation& o : kFloatOps)
        for (const Base base : {Base::f32, Base::f64}) proveOf(o, base, base);
    for (const Operation& o : kElementaryOps) proveOf(o, Base::f32, Base::f32);
    for (const uint32_t op : kFloatTests)
        for (const Base base : {Base::f32, Base::f64}) proveOf({op, 2}, base, Base::boolean);
    for (const uint32_t op : {spv::OpIsNan, spv::OpIsInf})
        for (const Base base : {Base::f32, Base::f64}) proveOf({op, 1}, base, Base::boolean);
}

TEST(Operations, OfIntegers) {
    for (const Operation& o : kIntegerOps)
        for (const Base base : {Base::i32, Base::i64}) proveOf(o, base, base);
    for (const Base base : {Base::i32, Base::u32}) {
        for (const Operation& o : kBitOps) proveOf(o, base, base);
        for (const uint32_t op : kIntegerTests) proveOf({op, 2}, base, Base::boolean);
    }
    for (const uint32_t op : kIntegerTests) proveOf({op, 2}, Base::i64, Base::boolean);
    for (const uint32_t op : {spv::OpUDiv, spv::OpUMod}) proveOf({op, 2}, Base::u32, Base::u32);
}

TEST(Operations, OfBooleans) {
    for (const uint32_t op : kLogicalOps) proveOf({op, 2}, Base::boolean, Base::boolean);
    proveOf({spv::OpLogicalNot, 1}, Base::boolean, Base::boolean);
}

TEST(Operations, Conversions) {
    for (const Base integer : {Base::i32, Base::u32, Base::i64}) {
        for (const Base floating : {Base::f32, Base::f64}) {
            const bool isSigned = integer != Base::u32;
            proveOf({isSigned ? spv::OpConvertSToF : spv::OpConvertUToF, 1}, integer, floating);
            proveOf({isSigned ? spv::OpConvertFToS : spv::OpConvertFToU, 1}, floating, integer);
        }
    }
    proveOf({spv::OpFConvert, 1}, Base::f32, Base::f64);
    proveOf({spv::OpFConvert, 1}, Base::f64, Base::f32);
    proveOf({spv::OpSConvert, 1}, Base::i32, Base::i64);
    proveOf({spv::OpSConvert, 1}, Base::i64, Base::i32);
}

constexpr Base kNarrowSigned[] = {Base::i8, Base::i16}, kNarrowUnsigned[] = {Base::u8, Base::u16};

TEST(Operations, OfHalves) {
    for (const Operation& o : kFloatOps) proveOf(o, Base::f16, Base::f16);
    for (const uint32_t op : kFloatTests) proveOf({op, 2}, Base::f16, Base::boolean);
    for (const uint32_t op : {spv::OpIsNan, spv::OpIsInf}) proveOf({op, 1}, Base::f16, Base::boolean);
    for (const Base base : {Base::f32, Base::f64}) {
        proveOf({spv::OpFConvert, 1}, base, Base::f16);
        proveOf({spv::OpFConvert, 1}, Base::f16, base);
    }
    for (const Base base : {Base::i8, Base::i16, Base::i32, Base::i64}) {
        proveOf({spv::OpConvertSToF, 1}, base, Base::f16);
        proveOf({spv::OpConvertFToS, 1}, Base::f16, base);
    }
    for (const Base base : {Base::u8, Base::u16, Base::u32}) {
        proveOf({spv::OpConvertUToF, 1}, base, Base::f16);
        proveOf({spv::OpConvertFToU, 1}, Base::f16, base);
    }
}

TEST(Operations, OfNarrowIntegers) {
    for (const auto& bases : {kNarrowSigned, kNarrowUnsigned}) {
        for (uint32_t k = 0; k < 2; ++k) {
            for (const Operation& o : kIntegerOps) proveOf(o, bases[k], bases[k]);
            for (const uint32_t op : kIntegerTests) proveOf({op, 2}, bases[k], Base::boolean);
        }
    }
    for (const Base base : kNarrowUnsigned) {
        for (const uint32_t op : {spv::OpUDiv, spv::OpUMod}) proveOf({op, 2}, base, base);
        proveOf({spv::OpConvertUToF, 1}, base, Base::f32);
        proveOf({spv::OpConvertFToU, 1}, Base::f32, base);
        for (const Base other : {Base::u8, Base::u16, Base::u32})
            if (other != base) proveOf({spv::OpUConvert, 1}, base, other);
        proveOf({spv::OpBitcast, 1}, base, base == Base::u8 ? Base::i8 : Base::i16);
    }
    for (const Base base : kNarrowSigned) {
        proveOf({spv::OpConvertSToF, 1}, base, Base::f32);
        proveOf({spv::OpConvertFToS, 1}, Base::f32, base);
        for (const Base other : {Base::i8, Base::i16, Base::i32, Base::i64}) {
            if (other == base) continue;
            proveOf({spv::OpSConvert, 1}, base, other);
            proveOf({spv::OpSConvert, 1}, other, base);
        }
    }
}

TEST(Operations, WithTwoResults) {
    const auto pair = [](Kind kind, uint32_t op, Base base, uint32_t operands, uint32_t members) {
        for (uint32_t member = 0; member < members; ++member) {
            std::vector<ExpressionPtr> args;
            for (uint32_t k = 0; k < operands; ++k) args.push_back(operand(base, k));
            prove(make(kind, {base, 1, 1}, std::move(args), op, member),
                  "member " + std::to_string(member) + " of " + std::to_string(op));
        }
    };
    for (const uint32_t op : {spv::OpIAddCarry, spv::OpISubBorrow, spv::OpUMulExtended})
        pair(Kind::structMember, op, Base::u32, 2, 2);
    pair(Kind::structMember, spv::OpSMulExtended, Base::i32, 2, 2);
    pair(Kind::extendedMember, GLSLstd450ModfStruct, Base::f32, 1, 2);
    pair(Kind::extendedMember, GLSLstd450ModfStruct, Base::f64, 1, 2);
    pair(Kind::extendedMember, GLSLstd450FrexpStruct, Base::f32, 1, 1);
}

}  // namespace
}  // namespace vernier::proof
