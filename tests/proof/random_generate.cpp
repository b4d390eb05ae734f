// Random programs: functions and statements.
#include <utility>

#include "tests/proof/random_generator.h"

namespace vernier::proof {

RandomProgram Generator::run() {
    constexpr ir::Stage kStages[] = {ir::Stage::fragment, ir::Stage::vertex, ir::Stage::compute, ir::Stage::fragment};
    program_.stage = kStages[below(4)];
    wide_ = chance(25);
    straight_ = chance(30);
    narrow_ = chance(25);
    subgroups_ = program_.stage == ir::Stage::compute && chance(60);
    images_ = chance(25);
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

ValueType Generator::anyType() {
    const Base base = anyBase();
    if (base == Base::f32 && chance(15))
        return {base, static_cast<uint8_t>(2 + below(3)), static_cast<uint8_t>(2 + below(3))};
    constexpr uint8_t kRows[] = {1, 1, 1, 2, 3, 4};
    return {base, pick(kRows), 1};
}

void Generator::function(uint32_t index) {
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

std::shared_ptr<Statement> Generator::statement(Statement::Kind kind, std::vector<ExpressionPtr> args,
                                                std::vector<Statements> bodies) {
    auto s = std::make_shared<Statement>();
    s->kind = kind;
    s->args = std::move(args);
    s->bodies = std::move(bodies);
    return s;
}

std::shared_ptr<Statement> Generator::assignment(uint32_t variable, uint32_t depth) {
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

std::shared_ptr<Statement> Generator::anyStatement(uint32_t depth) {
    cost_ += weight_ * 10;
    const bool main = current_ == 0, top = main && depth == 0;
    if (depth < 4) {
        if (chance(14))
            return statement(
                Statement::Kind::branch, {expression({Base::boolean, 1, 1}, 2)},
                {statements(1 + below(3), depth + 1), chance(60) ? statements(1 + below(2), depth + 1) : Statements{}});
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

std::shared_ptr<Statement> Generator::choice(uint32_t depth) {
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

std::shared_ptr<Statement> Generator::loop(uint32_t depth) {
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

RandomProgram generateProgram(uint64_t seed) {
    return Generator(seed).run();
}

}  // namespace vernier::proof
