// Random programs: expressions.
#include <bit>

#include "tests/proof/random_generator.h"

namespace vernier::proof {

namespace {

bool isInteger(Base base) {
    return base != Base::boolean && base != Base::f32 && base != Base::f64 && base != Base::f16;
}
bool isFloat(Base base) {
    return base == Base::f32 || base == Base::f64 || base == Base::f16;
}
bool isNarrow(Base base) {
    return base >= Base::i8;
}

}  // namespace

ExpressionPtr Generator::make(Kind kind, ValueType type, std::vector<ExpressionPtr> args) {
    auto e = std::make_shared<Expression>();
    e->kind = kind;
    e->type = type;
    e->args = std::move(args);
    return e;
}

ExpressionPtr Generator::constant(ValueType type) {
    ExpressionPtr e = make(Kind::constant, type);
    const uint32_t word = chance(50) ? specialWord(random_()) : below(9) - 3;
    constexpr float kNumbers[] = {0.0f, 1.0f, -1.0f, 0.5f, 2.0f, 0.1f, 3.25f, -0.75f, 10.0f};
    switch (type.base) {
        case Base::boolean:
            e->literal = below(2);
            break;
        case Base::f32:
            e->literal = chance(15) ? word : std::bit_cast<uint32_t>(pick(kNumbers));
            break;
        case Base::f64:
            e->literal = std::bit_cast<uint64_t>(static_cast<double>(pick(kNumbers)) * 1.1);
            break;
        case Base::i64:
            e->literal =
                chance(50) ? static_cast<uint64_t>(static_cast<int64_t>(static_cast<int32_t>(word))) : random_();
            break;
        case Base::f16:
            e->literal = chance(30) ? word & 0xFFFF : 0x3000u + below(0x1800) + (chance(50) ? 0x8000u : 0);
            break;
        default:
            e->literal = word;
    }
    return e;
}

ExpressionPtr Generator::index(uint32_t n, bool robust) {
    if (robust && indices_ == 0 && chance(10)) {
        ++indices_;
        // Mostly outside, or so far that offsets in bytes do not fit 32 bits.
        ExpressionPtr e = expression({Base::u32, 1, 1}, 1);
        if (chance(50)) e = masked(std::move(e), 1u << 24);
        --indices_;
        return e;
    }
    if (indices_ > 1 || chance(40)) {
        ExpressionPtr e = make(Kind::constant, {Base::u32, 1, 1});
        e->literal = below(n);
        return e;
    }
    ++indices_;
    ExpressionPtr e = masked(expression({Base::u32, 1, 1}, 1), n);
    --indices_;
    return e;
}

ExpressionPtr Generator::leaf(ValueType type) {
    std::vector<uint32_t> fitting;
    for (const uint32_t v : visible_)
        if (program_.variables[v].type == type) fitting.push_back(v);
    if (!fitting.empty() && chance(65)) {
        const uint32_t v = fitting[below(static_cast<uint32_t>(fitting.size()))];
        ExpressionPtr e = make(Kind::variable, type);
        e->index = v;
        if (const uint32_t length = program_.variables[v].length; length != 0) e->args.push_back(index(length));
        return e;
    }
    if (type.isMatrix() || chance(25) || type.base == Base::boolean || type.base == Base::i64 ||
        type.base == Base::f64 || isNarrow(type.base))
        return constant(type);
    return taken(type);
}

ExpressionPtr Generator::taken(ValueType type) {
    const ValueType whole{type.base, 4, 1};
    ExpressionPtr e;
    if (type.base == Base::u32 && type.rows == 1 && chance(30)) {
        return make(Kind::bufferWord, type, {index(8)});
    } else if (type.base == Base::f32 && chance(30)) {
        e = make(Kind::bufferVector, whole, {index(4)});
    } else if (type.base != Base::u32 && chance(40)) {
        e = make(Kind::uniform, whole, {index(8, true)});
        e->index = type.base == Base::f32 ? 0 : 1;
    } else {
        e = make(Kind::input, whole);
        e->index = type.base == Base::f32 ? 0 : type.base == Base::i32 ? 1 : 2;
    }
    if (type.rows == 4) return e;
    if (type.rows == 1) return extract(e, below(4));
    return shuffle(e, e, type);
}

ExpressionPtr Generator::extract(ExpressionPtr e, uint32_t component) {
    const ValueType type = e->type.isMatrix() ? ValueType{e->type.base, e->type.rows, 1} : e->type.scalar();
    ExpressionPtr result = make(Kind::extract, type, {std::move(e)});
    result->index = component;
    return result;
}

ExpressionPtr Generator::shuffle(ExpressionPtr a, ExpressionPtr b, ValueType type) {
    ExpressionPtr e = make(Kind::shuffle, type, {std::move(a), std::move(b)});
    for (uint32_t k = 0; k < type.rows; ++k)
        e->literal |= uint64_t{below(e->args[0]->type.rows + e->args[1]->type.rows)} << (8 * k);
    return e;
}

ExpressionPtr Generator::expression(ValueType type, uint32_t depth) {
    cost_ += weight_;
    if (depth == 0 || chance(15)) return leaf(type);
    const uint32_t d = depth - 1;
    if (type.isMatrix()) return matrix(type, d);
    if (chance(8)) return call(type, d);
    if (subgroups_ && chance(8))
        if (ExpressionPtr e = subgroup(type, d)) return e;
    if (images_ && chance(6))
        if (ExpressionPtr e = texel(type, d)) return e;
    if (chance(7)) {
        if (type.rows == 1 && chance(50))
            return make(Kind::choose, type,
                        {expression({Base::boolean, 1, 1}, d), expression(type, d), expression(type, d)});
        return operation({spv::OpSelect, 3}, type,
                         {expression(type.of(Base::boolean), d), expression(type, d), expression(type, d)});
    }
    if (type.rows > 1 && chance(20)) {
        if (chance(50)) {
            std::vector<ExpressionPtr> parts;
            for (uint32_t k = 0; k < type.rows; ++k) parts.push_back(expression(type.scalar(), d));
            return make(Kind::construct, type, std::move(parts));
        }
        if (chance(30))
            return operation({spv::OpVectorInsertDynamic, 3}, type,
                             {expression(type, d), expression(type.scalar(), d), index(type.rows)});
        const ValueType from{type.base, static_cast<uint8_t>(2 + below(3)), 1};
        return shuffle(expression(from, d), expression(from, d), type);
    }
    if (type.rows == 1 && chance(10)) {
        const ValueType from{type.base, static_cast<uint8_t>(2 + below(3)), 1};
        if (chance(50)) return extract(expression(from, d), below(from.rows));
        return operation({spv::OpVectorExtractDynamic, 2}, type, {expression(from, d), index(from.rows)});
    }
    if (isNarrow(type.base)) return narrow(type, d);
    switch (type.base) {
        case Base::boolean:
            return truth(type, d);
        case Base::f32:
        case Base::f64:
            return number(type, d);
        default:
            return integer(type, d);
    }
}

ExpressionPtr Generator::truth(ValueType type, uint32_t d) {
    if (type.rows == 1 && chance(15)) {
        ExpressionPtr e = make(Kind::both, type, {expression(type, d), expression(type, d)});
        e->literal = below(2);
        return e;
    }
    if (type.rows == 1 && chance(10))
        return operation({chance(50) ? spv::OpAny : spv::OpAll, 1}, type, {expression({Base::boolean, 3, 1}, d)});
    if (chance(10)) return operation({spv::OpLogicalNot, 1}, type, {expression(type, d)});
    if (chance(20)) return operation({pick(kLogicalOps), 2}, type, {expression(type, d), expression(type, d)});
    const Base base = anyBase();
    if (isFloat(base)) {
        const ValueType from = type.of(base);
        if (chance(10)) return operation({chance(50) ? spv::OpIsNan : spv::OpIsInf, 1}, type, {expression(from, d)});
        return operation({pick(kFloatTests), 2}, type, {expression(from, d), expression(from, d)});
    }
    const ValueType from = type.of(isInteger(base) ? base : Base::i32);
    return operation({pick(kIntegerTests), 2}, type, {expression(from, d), expression(from, d)});
}

ExpressionPtr Generator::number(ValueType type, uint32_t d) {
    const bool single = type.base == Base::f32;
    if (narrow_ && single && chance(12))
        return operation({spv::OpFConvert, 1}, type, {expression(type.of(Base::f16), d)});
    if (single && chance(14)) return apply(pick(kElementaryOps), type, d);
    if (chance(8)) {
        const Base from = chance(50) ? Base::i32 : Base::u32;
        return operation({from == Base::i32 ? spv::OpConvertSToF : spv::OpConvertUToF, 1}, type,
                         {expression(type.of(from), d)});
    }
    if (single && chance(4)) return operation({spv::OpBitcast, 1}, type, {expression(type.of(Base::u32), d)});
    if (wide_ && chance(10))
        return operation({spv::OpFConvert, 1}, type, {expression(type.of(single ? Base::f64 : Base::f32), d)});
    if (single && chance(4) && type.rows == 4)
        return operation({chance(50) ? GLSLstd450UnpackUnorm4x8 : GLSLstd450UnpackSnorm4x8, 1, true}, type,
                         {expression({Base::u32, 1, 1}, d)});
    if (single && chance(4) && type.rows == 2)
        return operation({GLSLstd450UnpackHalf2x16, 1, true}, type, {expression({Base::u32, 1, 1}, d)});
    if (single && chance(6)) {
        ExpressionPtr e = make(chance(50) ? Kind::structMember : Kind::extendedMember, type, {expression(type, d)});
        e->kind = Kind::extendedMember;
        e->op = chance(50) ? GLSLstd450ModfStruct : GLSLstd450FrexpStruct;
        e->index = e->op == GLSLstd450ModfStruct ? below(2) : 0;
        return e;
    }
    if (single && chance(4))
        return operation({GLSLstd450Ldexp, 2, true}, type, {expression(type, d), expression(type.of(Base::i32), d)});
    if (single && chance(18)) return geometric(type, d);
    return apply(pick(kFloatOps), type, d);
}

ExpressionPtr Generator::geometric(ValueType type, uint32_t d) {
    const ValueType vector{type.base, static_cast<uint8_t>(2 + below(3)), 1};
    if (type.rows == 1) {
        switch (below(4)) {
            case 0:
                return operation({spv::OpDot, 2}, type, {expression(vector, d), expression(vector, d)});
            case 1:
                return operation({GLSLstd450Length, 1, true}, type, {expression(vector, d)});
            case 2:
                return operation({GLSLstd450Distance, 2, true}, type, {expression(vector, d), expression(vector, d)});
            default: {
                const ValueType square{type.base, vector.rows, vector.rows};
                return operation({GLSLstd450Determinant, 1, true}, type, {expression(square, d)});
            }
        }
    }
    const ValueType other{type.base, vector.rows, 1};
    switch (below(7)) {
        case 0:
            return operation({GLSLstd450Normalize, 1, true}, type, {expression(type, d)});
        case 1:
            return operation({GLSLstd450Reflect, 2, true}, type, {expression(type, d), expression(type, d)});
        case 2:
            return operation({GLSLstd450Refract, 3, true}, type,
                             {expression(type, d), expression(type, d), expression(type.scalar(), d)});
        case 3:
            return operation({GLSLstd450FaceForward, 3, true}, type,
                             {expression(type, d), expression(type, d), expression(type, d)});
        case 4:
            return operation({spv::OpVectorTimesScalar, 2}, type, {expression(type, d), expression(type.scalar(), d)});
        case 5:
            return operation({spv::OpMatrixTimesVector, 2}, type,
                             {expression({type.base, type.rows, other.rows}, d), expression(other, d)});
        default:
            return operation({spv::OpVectorTimesMatrix, 2}, type,
                             {expression(other, d), expression({type.base, other.rows, type.rows}, d)});
    }
}

ExpressionPtr Generator::matrix(ValueType type, uint32_t d) {
    const auto inner = static_cast<uint8_t>(2 + below(3));
    switch (below(7)) {
        case 0:
            return operation({spv::OpMatrixTimesScalar, 2}, type, {expression(type, d), expression(type.scalar(), d)});
        case 1:
            return operation(
                {spv::OpMatrixTimesMatrix, 2}, type,
                {expression({type.base, type.rows, inner}, d), expression({type.base, inner, type.columns}, d)});
        case 2:
            return operation({spv::OpTranspose, 1}, type, {expression({type.base, type.columns, type.rows}, d)});
        case 3:
            return operation({spv::OpOuterProduct, 2}, type,
                             {expression({type.base, type.rows, 1}, d), expression({type.base, type.columns, 1}, d)});
        case 4:
            if (type.rows == type.columns)
                return operation({GLSLstd450MatrixInverse, 1, true}, type, {expression(type, d)});
            [[fallthrough]];
        case 5: {
            if (type.rows == 4 && type.columns == 4) {
                ExpressionPtr e = make(Kind::uniform, type);
                e->index = 2;
                return e;
            }
            [[fallthrough]];
        }
        default: {
            std::vector<ExpressionPtr> columns;
            for (uint32_t c = 0; c < type.columns; ++c) columns.push_back(expression({type.base, type.rows, 1}, d));
            return make(Kind::construct, type, std::move(columns));
        }
    }
}

ExpressionPtr Generator::narrow(ValueType type, uint32_t d) {
    if (type.base == Base::f16) {
        if (chance(30)) return operation({spv::OpFConvert, 1}, type, {expression(type.of(Base::f32), d)});
        if (chance(10)) {
            constexpr Base kFrom[] = {Base::i32, Base::i16, Base::i8};
            return operation({spv::OpConvertSToF, 1}, type, {expression(type.of(pick(kFrom)), d)});
        }
        if (chance(5)) return operation({spv::OpBitcast, 1}, type, {expression(type.of(Base::u16), d)});
        return apply(pick(kFloatOps), type, d);
    }
    const bool isUnsigned = type.base == Base::u8 || type.base == Base::u16;
    const bool bytes = type.base == Base::i8 || type.base == Base::u8;
    if (chance(25)) {
        const Base from = isUnsigned ? (chance(70) ? Base::u32
                                        : bytes    ? Base::u16
                                                   : Base::u8)
                                     : (chance(70) ? Base::i32
                                        : bytes    ? Base::i16
                                                   : Base::i8);
        return operation({isUnsigned ? spv::OpUConvert : spv::OpSConvert, 1}, type, {expression(type.of(from), d)});
    }
    if (chance(8))
        return operation({isUnsigned ? spv::OpConvertFToU : spv::OpConvertFToS, 1}, type,
                         {expression(type.of(chance(50) ? Base::f32 : Base::f16), d)});
    if (chance(8)) {
        const Base other = bytes ? (isUnsigned ? Base::i8 : Base::u8) : isUnsigned ? Base::i16 : Base::u16;
        return operation({spv::OpBitcast, 1}, type, {expression(type.of(other), d)});
    }
    if (isUnsigned && chance(12))
        return operation({chance(50) ? spv::OpUDiv : spv::OpUMod, 2}, type, {expression(type, d), expression(type, d)});
    return apply(pick(kIntegerOps), type, d);
}

ExpressionPtr Generator::integer(ValueType type, uint32_t d) {
    if (type.base == Base::i64) {
        if (chance(15)) return operation({spv::OpSConvert, 1}, type, {expression(type.of(Base::i32), d)});
        if (chance(8)) return operation({spv::OpConvertFToS, 1}, type, {expression(type.of(Base::f32), d)});
        return apply(kIntegerOps[below(std::size(kIntegerOps))], type, d);
    }
    const bool isUnsigned = type.base == Base::u32;
    if (narrow_ && chance(15)) {
        constexpr Base kSigned[] = {Base::i8, Base::i16}, kUnsigned[] = {Base::u8, Base::u16};
        return operation({isUnsigned ? spv::OpUConvert : spv::OpSConvert, 1}, type,
                         {expression(type.of(isUnsigned ? pick(kUnsigned) : pick(kSigned)), d)});
    }
    if (chance(8))
        return operation({isUnsigned ? spv::OpConvertFToU : spv::OpConvertFToS, 1}, type,
                         {expression(type.of(wide_ && chance(30) ? Base::f64 : Base::f32), d)});
    if (chance(10))
        return operation({spv::OpBitcast, 1}, type, {expression(type.of(isUnsigned ? Base::i32 : Base::u32), d)});
    if (wide_ && !isUnsigned && chance(10))
        return operation({spv::OpSConvert, 1}, type, {expression(type.of(Base::i64), d)});
    if (isUnsigned && type.rows == 1 && chance(5))
        return operation({chance(50) ? GLSLstd450PackUnorm4x8 : GLSLstd450PackSnorm4x8, 1, true}, type,
                         {expression({Base::f32, 4, 1}, d)});
    if (chance(5)) {
        // The bits of a number, but not of a NaN: those are nobody's business.
        const ValueType from = type.of(Base::f32);
        ExpressionPtr x = expression(from, d), zero = make(Kind::constant, type);
        return operation({spv::OpSelect, 3}, type,
                         {operation({spv::OpIsNan, 1}, type.of(Base::boolean), {x}), zero,
                          operation({spv::OpBitcast, 1}, type, {x})});
    }
    if (isUnsigned && chance(8)) {
        constexpr uint32_t kExtended[] = {spv::OpIAddCarry, spv::OpISubBorrow, spv::OpUMulExtended};
        ExpressionPtr e = make(Kind::structMember, type, {expression(type, d), expression(type, d)});
        e->op = pick(kExtended);
        e->index = below(2);
        return e;
    }
    if (!isUnsigned && chance(4)) {
        ExpressionPtr e = make(Kind::structMember, type, {expression(type, d), expression(type, d)});
        e->op = spv::OpSMulExtended;
        e->index = below(2);
        return e;
    }
    if (chance(12)) {
        const Operation& o = pick(kBitOps);
        const bool field = !o.extended && o.operands > 1;
        std::vector<ExpressionPtr> args{expression(type, d)};
        if (o.operands == 4) args.push_back(expression(type, d));
        if (field) {
            args.push_back(chance(70) ? index(32) : expression({Base::u32, 1, 1}, 1));
            args.push_back(chance(70) ? index(33) : expression({Base::u32, 1, 1}, 1));
        }
        return operation(o, type, std::move(args));
    }
    if (isUnsigned && chance(12))
        return operation({chance(50) ? spv::OpUDiv : spv::OpUMod, 2}, type, {expression(type, d), expression(type, d)});
    return apply(pick(kIntegerOps), type, d);
}

ExpressionPtr Generator::call(ValueType type, uint32_t d) {
    std::vector<uint32_t> fitting;
    for (uint32_t f = current_ + 1; f < program_.functions.size(); ++f)
        if (program_.functions[f].result == type && weight_ * costs_[f] < 4000 && pointerFor(f) != ~0u)
            fitting.push_back(f);
    if (fitting.empty()) return leaf(type);
    ExpressionPtr e = make(Kind::call, type);
    e->index = fitting[below(static_cast<uint32_t>(fitting.size()))];
    cost_ += weight_ * costs_[e->index];
    for (const uint32_t p : program_.functions[e->index].parameters)
        e->args.push_back(expression(program_.variables[p].type, d));
    e->literal = pointerFor(e->index);
    return e;
}

uint32_t Generator::pointerFor(uint32_t function) {
    const ValueType pointee = program_.variables[program_.functions[function].pointer].type;
    for (const uint32_t v : program_.functions[current_].locals)
        if (program_.variables[v].type == pointee && program_.variables[v].length == 0) return v;
    return ~0u;
}

ExpressionPtr Generator::subgroup(ValueType type, uint32_t d) {
    const auto group = [&](uint32_t op, std::vector<ExpressionPtr> args, uint64_t literal = ~0ull) {
        ExpressionPtr e = make(Kind::subgroup, type, std::move(args));
        e->op = op;
        e->literal = literal;
        return e;
    };
    constexpr ValueType kBool{Base::boolean, 1, 1}, kBallot{Base::u32, 4, 1};
    if (type.isMatrix()) return nullptr;
    if (type == kBool && chance(70)) {
        constexpr uint32_t kVotes[] = {spv::OpGroupNonUniformAll, spv::OpGroupNonUniformAny};
        switch (below(5)) {
            case 0:
                return group(spv::OpGroupNonUniformElect, {});
            case 1:
                return group(spv::OpGroupNonUniformAllEqual, {expression({anyBase(), 1, 1}, d)});
            case 2:
                return group(spv::OpGroupNonUniformInverseBallot, {expression(kBallot, d)});
            default:
                return group(pick(kVotes), {expression(type, d)});
        }
    }
    if (type == kBallot && chance(40)) return group(spv::OpGroupNonUniformBallot, {expression(kBool, d)});
    if (type == kBallot.scalar() && chance(25))
        return group(spv::OpGroupNonUniformBallotBitCount, {expression(kBallot, d)}, below(3));
    if (chance(20)) return group(spv::OpGroupNonUniformBroadcastFirst, {expression(type, d)});
    if (chance(20)) {
        ExpressionPtr mask = make(Kind::constant, {Base::u32, 1, 1});
        mask->literal = below(32);
        return group(spv::OpGroupNonUniformShuffleXor, {expression(type, d), std::move(mask)});
    }
    // All, inclusive, exclusive, or in clusters of so many.
    const uint64_t operation =
        chance(75) ? below(3) : spv::GroupOperationClusteredReduce | uint64_t{1} << (8 + below(6));
    if (type.base == Base::boolean) {
        constexpr uint32_t kOps[] = {spv::OpGroupNonUniformLogicalAnd, spv::OpGroupNonUniformLogicalOr,
                                     spv::OpGroupNonUniformLogicalXor};
        return group(pick(kOps), {expression(type, d)}, operation);
    }
    if (isFloat(type.base)) {
        constexpr uint32_t kOps[] = {spv::OpGroupNonUniformFAdd, spv::OpGroupNonUniformFMul, spv::OpGroupNonUniformFMin,
                                     spv::OpGroupNonUniformFMax};
        return group(pick(kOps), {expression(type, d)}, operation);
    }
    constexpr uint32_t kOps[] = {
        spv::OpGroupNonUniformIAdd,       spv::OpGroupNonUniformIMul,      spv::OpGroupNonUniformSMin,
        spv::OpGroupNonUniformUMin,       spv::OpGroupNonUniformSMax,      spv::OpGroupNonUniformUMax,
        spv::OpGroupNonUniformBitwiseAnd, spv::OpGroupNonUniformBitwiseOr, spv::OpGroupNonUniformBitwiseXor};
    return group(pick(kOps), {expression(type, d)}, operation);
}

/// From an image: outside, the images of the test repeat.
ExpressionPtr Generator::texel(ValueType type, uint32_t d) {
    if (type.rows != 4 || type.isMatrix() || (type.base != Base::f32 && type.base != Base::i32)) return nullptr;
    const bool floats = type.base == Base::f32;
    if (floats && chance(50)) {
        ExpressionPtr at = operation({GLSLstd450Fract, 1, true}, {Base::f32, 2, 1}, {expression({Base::f32, 2, 1}, d)});
        return make(Kind::sample, type, {std::move(at), constant({Base::f32, 1, 1})});
    }
    ExpressionPtr level = make(Kind::constant, {Base::i32, 1, 1});
    level->literal = below(8);
    ExpressionPtr e = make(Kind::fetch, type, {expression({Base::i32, 2, 1}, d), std::move(level)});
    e->index = floats ? 0 : 1;
    return e;
}

}  // namespace vernier::proof
