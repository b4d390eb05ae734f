// Grows random programs: depth and cost are bounded, everything else is luck.
#include <bit>
#include <map>
#include <random>
#include <utility>

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp>

#include "tests/proof/operations.h"
#include "tests/proof/random_module.h"

namespace vernier::proof {
namespace {

using Kind = Expression::Kind;

bool isInteger(Base base) {
    return base == Base::i32 || base == Base::u32 || base == Base::i64;
}
bool isFloat(Base base) {
    return base == Base::f32 || base == Base::f64;
}

class Generator {
  public:
    explicit Generator(uint64_t seed) : random_(seed) {}

    RandomProgram run() {
        constexpr ir::Stage kStages[] = {ir::Stage::fragment, ir::Stage::vertex, ir::Stage::compute,
                                         ir::Stage::fragment};
        program_.stage = kStages[below(4)];
        wide_ = chance(25);
        straight_ = chance(30);
        for (uint32_t k = 0; k < 3 + below(3); ++k) {
            // The first three are the results.
            ValueType type = k == 0   ? ValueType{Base::f32, 4, 1}
                             : k == 1 ? ValueType{Base::i32, 4, 1}
                             : k == 2 ? ValueType{Base::u32, 4, 1}
                                      : anyType();
            privates_.push_back(addVariable({type, 0, true}));
        }
        const uint32_t functions = 1 + below(4);
        program_.functions.resize(functions);
        // From the last to the first: a function calls those behind it.
        for (uint32_t f = functions; f-- > 0;) function(f);
        return std::move(program_);
    }

  private:
    uint32_t below(uint32_t n) { return n == 0 ? 0 : static_cast<uint32_t>(random_() % n); }
    bool chance(uint32_t percent) { return below(100) < percent; }
    template <class T, size_t n>
    const T& pick(const T (&list)[n]) {
        return list[below(n)];
    }

    Base anyBase() {
        if (wide_ && chance(20)) return chance(50) ? Base::i64 : Base::f64;
        constexpr Base kBases[] = {Base::f32, Base::f32, Base::f32, Base::i32, Base::u32, Base::i32, Base::boolean};
        return pick(kBases);
    }
    ValueType anyType() {
        const Base base = anyBase();
        if (base == Base::f32 && chance(15))
            return {base, static_cast<uint8_t>(2 + below(3)), static_cast<uint8_t>(2 + below(3))};
        constexpr uint8_t kRows[] = {1, 1, 1, 2, 3, 4};
        return {base, pick(kRows), 1};
    }
    uint32_t addVariable(const Variable& variable) {
        program_.variables.push_back(variable);
        return static_cast<uint32_t>(program_.variables.size() - 1);
    }

    void function(uint32_t index) {
        RandomFunction& f = program_.functions[index];
        current_ = index;
        f.result = anyType();
        cost_ = 0;
        if (index != 0) {
            for (uint32_t k = 0; k < 1 + below(2); ++k) f.parameters.push_back(addVariable({anyType(), 0, false}));
            f.locals = f.parameters;
            f.pointer = addVariable({anyType(), 0, false});
        }
        for (uint32_t k = 0; k < 3 + below(4); ++k) {
            f.locals.push_back(addVariable({anyType(), chance(30) ? 2 + below(6) : 0, false}));
        }
        visible_ = privates_;
        visible_.insert(visible_.end(), f.locals.begin(), f.locals.end());
        if (f.pointer != ~0u) visible_.push_back(f.pointer);
        loops_ = breakable_ = 0;
        weight_ = 1;
        f.body = statements(index == 0 ? 6 + below(6) : 2 + below(3), 0);
        if (index == 0) {
            // Every result gets something of its own at the end, or early returns would leave little to see.
            for (uint32_t k = 0; k < 3; ++k) f.body.push_back(assignment(k, 3));
        } else {
            f.body.push_back(statement(Statement::Kind::giveBack, {expression(f.result, 3)}));
        }
        costs_[index] = cost_;
    }

    static std::shared_ptr<Statement> statement(Statement::Kind kind, std::vector<ExpressionPtr> args,
                                                std::vector<Statements> bodies = {}) {
        auto s = std::make_shared<Statement>();
        s->kind = kind;
        s->args = std::move(args);
        s->bodies = std::move(bodies);
        return s;
    }

    Statements statements(uint32_t count, uint32_t depth) {
        Statements list;
        for (uint32_t k = 0; k < count; ++k) list.push_back(anyStatement(depth));
        return list;
    }

    std::shared_ptr<Statement> assignment(uint32_t variable, uint32_t depth) {
        const Variable v = program_.variables[variable];
        ValueType type = v.type;
        uint64_t component = ~0ull;
        if (type.rows > 1 && !type.isMatrix() && chance(25)) {
            component = below(type.rows);
            type = type.scalar();
        }
        auto s = statement(Statement::Kind::assign, {expression(type, depth)});
        if (v.length != 0) s->args.push_back(index(v.length));
        s->index = variable;
        s->literal = component;
        return s;
    }

    std::shared_ptr<Statement> anyStatement(uint32_t depth) {
        cost_ += weight_ * 10;
        const bool main = current_ == 0, top = main && depth == 0;
        if (depth < 4) {
            if (chance(14))
                return statement(Statement::Kind::branch, {expression({Base::boolean, 1, 1}, 2)},
                                 {statements(1 + below(3), depth + 1),
                                  chance(60) ? statements(1 + below(2), depth + 1) : Statements{}});
            if (chance(8)) return choice(depth);
            if (chance(12) && loops_ < 3 && weight_ < 40) return loop(depth);
        }
        if (depth > 0 && loops_ > 0 && chance(7)) return statement(Statement::Kind::next, {});
        if (depth > 0 && breakable_ > 0 && chance(8)) return statement(Statement::Kind::leave, {});
        if (depth > 0 && !straight_ && chance(4)) {
            if (main) return statement(Statement::Kind::giveBack, {});
            return statement(Statement::Kind::giveBack, {expression(program_.functions[current_].result, 2)});
        }
        if (depth > 0 && !straight_ && program_.stage == ir::Stage::fragment && chance(2))
            return statement(Statement::Kind::discard, {});
        if (chance(6)) return statement(Statement::Kind::bufferWord, {expression({Base::u32, 1, 1}, 3), index(8)});
        if (chance(5)) return statement(Statement::Kind::bufferVector, {expression({Base::f32, 4, 1}, 3), index(4)});
        if (top && straight_ && program_.stage == ir::Stage::compute && chance(30)) {
            auto s = statement(Statement::Kind::shared, {expression({Base::u32, 1, 1}, 2)});
            s->index = 2;
            s->literal = 1 + below(63);
            return s;
        }
        if (top && straight_ && program_.stage == ir::Stage::fragment && chance(20)) {
            constexpr uint32_t kDerivatives[] = {spv::OpDPdx, spv::OpDPdy, spv::OpFwidth};
            auto s = statement(Statement::Kind::derivative, {expression({Base::f32, 4, 1}, 2)});
            s->index = 0;
            s->literal = pick(kDerivatives);
            return s;
        }
        return assignment(visible_[below(static_cast<uint32_t>(visible_.size()))], 4);
    }

    std::shared_ptr<Statement> choice(uint32_t depth) {
        auto s = statement(Statement::Kind::choice, {expression({chance(50) ? Base::i32 : Base::u32, 1, 1}, 2)});
        s->literal = random_();
        // SPIRV-Tools does not know all ways in which a case may go on with a loop around the switch.
        const uint32_t loops = std::exchange(loops_, 0);
        const uint64_t weight = weight_;
        weight_ = loops >= 3 ? 40 : weight_;  // no loop in here then
        ++breakable_;
        for (uint32_t k = 0; k < 2 + below(4); ++k) s->bodies.push_back(statements(1 + below(2), depth + 1));
        --breakable_;
        loops_ = loops;
        weight_ = weight;
        // A selector that the cases are likely to meet.
        s->args[0] = masked(s->args[0], static_cast<uint32_t>(s->bodies.size()));
        return s;
    }

    std::shared_ptr<Statement> loop(uint32_t depth) {
        auto s = statement(Statement::Kind::loop, {});
        s->literal = 1 + below(loops_ == 0 ? 8 : 4);
        s->index = below(2);
        const uint64_t before = weight_;
        weight_ *= s->literal;
        ++loops_;
        ++breakable_;
        s->args.push_back(expression({Base::boolean, 1, 1}, 2));
        s->bodies.push_back(statements(1 + below(4), depth + 1));
        --loops_;
        --breakable_;
        weight_ = before;
        return s;
    }

    // --- expressions

    static ExpressionPtr make(Kind kind, ValueType type, std::vector<ExpressionPtr> args = {}) {
        auto e = std::make_shared<Expression>();
        e->kind = kind;
        e->type = type;
        e->args = std::move(args);
        return e;
    }
    static ExpressionPtr operation(const Operation& o, ValueType type, std::vector<ExpressionPtr> args) {
        ExpressionPtr e = make(o.extended ? Kind::extended : Kind::op, type, std::move(args));
        e->op = o.op;
        return e;
    }
    ExpressionPtr constant(ValueType type) {
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
            default:
                e->literal = word;
        }
        return e;
    }
    /// Below n, a power of two or not.
    ExpressionPtr masked(const ExpressionPtr& e, uint32_t n) {
        ExpressionPtr limit = make(Kind::constant, e->type);
        limit->literal = n;
        return operation({e->type.base == Base::i32 ? spv::OpSMod : spv::OpUMod, 2}, e->type, {e, limit});
    }
    ExpressionPtr index(uint32_t n) {
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

    ExpressionPtr leaf(ValueType type) {
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
            type.base == Base::f64)
            return constant(type);
        return taken(type);
    }

    /// A vector of the type's base from outside, cut down to the type.
    ExpressionPtr taken(ValueType type) {
        const ValueType whole{type.base, 4, 1};
        ExpressionPtr e;
        if (type.base == Base::u32 && type.rows == 1 && chance(30)) {
            return make(Kind::bufferWord, type, {index(8)});
        } else if (type.base == Base::f32 && chance(30)) {
            e = make(Kind::bufferVector, whole, {index(4)});
        } else if (type.base != Base::u32 && chance(40)) {
            e = make(Kind::uniform, whole, {index(8)});
            e->index = type.base == Base::f32 ? 0 : 1;
        } else {
            e = make(Kind::input, whole);
            e->index = type.base == Base::f32 ? 0 : type.base == Base::i32 ? 1 : 2;
        }
        if (type.rows == 4) return e;
        if (type.rows == 1) return extract(e, below(4));
        return shuffle(e, e, type);
    }
    static ExpressionPtr extract(ExpressionPtr e, uint32_t component) {
        const ValueType type = e->type.isMatrix() ? ValueType{e->type.base, e->type.rows, 1} : e->type.scalar();
        ExpressionPtr result = make(Kind::extract, type, {std::move(e)});
        result->index = component;
        return result;
    }
    ExpressionPtr shuffle(ExpressionPtr a, ExpressionPtr b, ValueType type) {
        ExpressionPtr e = make(Kind::shuffle, type, {std::move(a), std::move(b)});
        for (uint32_t k = 0; k < type.rows; ++k)
            e->literal |= uint64_t{below(e->args[0]->type.rows + e->args[1]->type.rows)} << (8 * k);
        return e;
    }

    ExpressionPtr expression(ValueType type, uint32_t depth) {
        cost_ += weight_;
        if (depth == 0 || chance(15)) return leaf(type);
        const uint32_t d = depth - 1;
        if (type.isMatrix()) return matrix(type, d);
        if (chance(8)) return call(type, d);
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

    ExpressionPtr apply(const Operation& o, ValueType type, uint32_t d) {
        std::vector<ExpressionPtr> args;
        for (uint32_t k = 0; k < o.operands; ++k) args.push_back(expression(type, d));
        return operation(o, type, std::move(args));
    }

    ExpressionPtr truth(ValueType type, uint32_t d) {
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
            if (chance(10))
                return operation({chance(50) ? spv::OpIsNan : spv::OpIsInf, 1}, type, {expression(from, d)});
            return operation({pick(kFloatTests), 2}, type, {expression(from, d), expression(from, d)});
        }
        const ValueType from = type.of(isInteger(base) ? base : Base::i32);
        return operation({pick(kIntegerTests), 2}, type, {expression(from, d), expression(from, d)});
    }

    ExpressionPtr number(ValueType type, uint32_t d) {
        const bool single = type.base == Base::f32;
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
            return operation({GLSLstd450Ldexp, 2, true}, type,
                             {expression(type, d), expression(type.of(Base::i32), d)});
        if (single && chance(18)) return geometric(type, d);
        return apply(pick(kFloatOps), type, d);
    }

    ExpressionPtr geometric(ValueType type, uint32_t d) {
        const ValueType vector{type.base, static_cast<uint8_t>(2 + below(3)), 1};
        if (type.rows == 1) {
            switch (below(4)) {
                case 0:
                    return operation({spv::OpDot, 2}, type, {expression(vector, d), expression(vector, d)});
                case 1:
                    return operation({GLSLstd450Length, 1, true}, type, {expression(vector, d)});
                case 2:
                    return operation({GLSLstd450Distance, 2, true}, type,
                                     {expression(vector, d), expression(vector, d)});
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
                return operation({spv::OpVectorTimesScalar, 2}, type,
                                 {expression(type, d), expression(type.scalar(), d)});
            case 5:
                return operation({spv::OpMatrixTimesVector, 2}, type,
                                 {expression({type.base, type.rows, other.rows}, d), expression(other, d)});
            default:
                return operation({spv::OpVectorTimesMatrix, 2}, type,
                                 {expression(other, d), expression({type.base, other.rows, type.rows}, d)});
        }
    }

    ExpressionPtr matrix(ValueType type, uint32_t d) {
        const auto inner = static_cast<uint8_t>(2 + below(3));
        switch (below(7)) {
            case 0:
                return operation({spv::OpMatrixTimesScalar, 2}, type,
                                 {expression(type, d), expression(type.scalar(), d)});
            case 1:
                return operation(
                    {spv::OpMatrixTimesMatrix, 2}, type,
                    {expression({type.base, type.rows, inner}, d), expression({type.base, inner, type.columns}, d)});
            case 2:
                return operation({spv::OpTranspose, 1}, type, {expression({type.base, type.columns, type.rows}, d)});
            case 3:
                return operation(
                    {spv::OpOuterProduct, 2}, type,
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

    ExpressionPtr integer(ValueType type, uint32_t d) {
        if (type.base == Base::i64) {
            if (chance(15)) return operation({spv::OpSConvert, 1}, type, {expression(type.of(Base::i32), d)});
            if (chance(8)) return operation({spv::OpConvertFToS, 1}, type, {expression(type.of(Base::f32), d)});
            return apply(kIntegerOps[below(std::size(kIntegerOps))], type, d);
        }
        const bool isUnsigned = type.base == Base::u32;
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
            return operation({chance(50) ? spv::OpUDiv : spv::OpUMod, 2}, type,
                             {expression(type, d), expression(type, d)});
        return apply(pick(kIntegerOps), type, d);
    }

    /// Of a function behind the current one whose result can be made into the type.
    ExpressionPtr call(ValueType type, uint32_t d) {
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
    /// A local variable of the current function that the callee's pointer fits.
    uint32_t pointerFor(uint32_t function) {
        const ValueType pointee = program_.variables[program_.functions[function].pointer].type;
        for (const uint32_t v : program_.functions[current_].locals)
            if (program_.variables[v].type == pointee && program_.variables[v].length == 0) return v;
        return ~0u;
    }

    std::mt19937_64 random_;
    RandomProgram program_;
    std::vector<uint32_t> privates_, visible_;
    uint32_t current_ = 0, loops_ = 0, breakable_ = 0;
    uint32_t indices_ = 0;  // of indices of indices
    uint64_t weight_ = 1, cost_ = 0;
    std::map<uint32_t, uint64_t> costs_;
    bool wide_ = false;      // 64-bit types occur
    bool straight_ = false;  // main's body has no early end: barriers and derivatives are allowed at its top level
};

}  // namespace

RandomProgram generateProgram(uint64_t seed) {
    return Generator(seed).run();
}

}  // namespace vernier::proof
