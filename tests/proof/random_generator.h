// Grows random programs: depth and cost are bounded, everything else is luck.
#pragma once

#include <map>
#include <random>

#include "tests/proof/operations.h"
#include "tests/proof/random_module.h"

namespace vernier::proof {

class Generator {
  public:
    using Kind = Expression::Kind;

    explicit Generator(uint64_t seed) : random_(seed) {}

    RandomProgram run();

  private:
    uint32_t below(uint32_t n) { return n == 0 ? 0 : static_cast<uint32_t>(random_() % n); }
    bool chance(uint32_t percent) { return below(100) < percent; }
    template <class T, size_t n>
    const T& pick(const T (&list)[n]) {
        return list[below(n)];
    }

    Base anyBase() {
        constexpr Base kNarrow[] = {Base::i8, Base::u8, Base::i16, Base::u16, Base::f16, Base::f16};
        if (narrow_ && chance(20)) return pick(kNarrow);
        if (wide_ && chance(20)) return chance(50) ? Base::i64 : Base::f64;
        constexpr Base kBases[] = {Base::f32, Base::f32, Base::f32, Base::i32, Base::u32, Base::i32, Base::boolean};
        return pick(kBases);
    }
    ValueType anyType();
    uint32_t addVariable(const Variable& variable) {
        program_.variables.push_back(variable);
        return static_cast<uint32_t>(program_.variables.size() - 1);
    }

    void function(uint32_t index);

    static std::shared_ptr<Statement> statement(Statement::Kind kind, std::vector<ExpressionPtr> args,
                                                std::vector<Statements> bodies = {});

    Statements statements(uint32_t count, uint32_t depth) {
        Statements list;
        for (uint32_t k = 0; k < count; ++k) list.push_back(anyStatement(depth));
        return list;
    }

    std::shared_ptr<Statement> assignment(uint32_t variable, uint32_t depth);

    std::shared_ptr<Statement> anyStatement(uint32_t depth);

    std::shared_ptr<Statement> choice(uint32_t depth);

    std::shared_ptr<Statement> loop(uint32_t depth);

    // --- expressions

    static ExpressionPtr make(Kind kind, ValueType type, std::vector<ExpressionPtr> args = {});
    static ExpressionPtr operation(const Operation& o, ValueType type, std::vector<ExpressionPtr> args) {
        ExpressionPtr e = make(o.extended ? Kind::extended : Kind::op, type, std::move(args));
        e->op = o.op;
        return e;
    }
    ExpressionPtr constant(ValueType type);
    /// Below n, a power of two or not.
    ExpressionPtr masked(const ExpressionPtr& e, uint32_t n) {
        ExpressionPtr limit = make(Kind::constant, e->type);
        limit->literal = n;
        return operation({e->type.base == Base::i32 ? spv::OpSMod : spv::OpUMod, 2}, e->type, {e, limit});
    }
    /// Below n, unless `robust` allows to try what lies outside (of buffers: elsewhere it is left open).
    ExpressionPtr index(uint32_t n, bool robust = false);

    ExpressionPtr leaf(ValueType type);

    /// A vector of the type's base from outside, cut down to the type.
    ExpressionPtr taken(ValueType type);
    static ExpressionPtr extract(ExpressionPtr e, uint32_t component);
    ExpressionPtr shuffle(ExpressionPtr a, ExpressionPtr b, ValueType type);

    ExpressionPtr expression(ValueType type, uint32_t depth);

    ExpressionPtr apply(const Operation& o, ValueType type, uint32_t d) {
        std::vector<ExpressionPtr> args;
        for (uint32_t k = 0; k < o.operands; ++k) args.push_back(expression(type, d));
        return operation(o, type, std::move(args));
    }

    ExpressionPtr truth(ValueType type, uint32_t d);

    ExpressionPtr number(ValueType type, uint32_t d);

    ExpressionPtr geometric(ValueType type, uint32_t d);

    ExpressionPtr matrix(ValueType type, uint32_t d);

    ExpressionPtr integer(ValueType type, uint32_t d);
    /// Of a type of 8 or 16 bits.
    ExpressionPtr narrow(ValueType type, uint32_t d);
    /// nullptr if there is none of the type.
    ExpressionPtr subgroup(ValueType type, uint32_t d);
    ExpressionPtr texel(ValueType type, uint32_t d);

    /// Of a function behind the current one whose result can be made into the type.
    ExpressionPtr call(ValueType type, uint32_t d);
    /// A local variable of the current function that the callee's pointer fits.
    uint32_t pointerFor(uint32_t function);

    std::mt19937_64 random_;
    RandomProgram program_;
    std::vector<uint32_t> privates_, visible_;
    uint32_t current_ = 0, loops_ = 0, breakable_ = 0;
    uint32_t indices_ = 0;  // of indices of indices
    uint64_t weight_ = 1, cost_ = 0;
    std::map<uint32_t, uint64_t> costs_;
    bool wide_ = false;       // 64-bit types occur
    bool narrow_ = false;     // types of 8 and 16 bits occur
    bool subgroups_ = false;  // subgroup operations occur
    bool images_ = false;     // images are read
    bool straight_ = false;   // main's body has no early end: barriers and derivatives are allowed at its top level
};

}  // namespace vernier::proof
