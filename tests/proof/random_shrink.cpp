// Makes a failing program smaller.
#include "tests/proof/random_module.h"

namespace vernier::proof {

namespace {

RandomProgram copyOf(const RandomProgram& program);

ExpressionPtr copyOf(const ExpressionPtr& e) {
    auto copy = std::make_shared<Expression>(*e);
    for (ExpressionPtr& arg : copy->args) arg = copyOf(arg);
    return copy;
}
Statements copyOf(const Statements& list) {
    Statements copies;
    for (const auto& s : list) {
        auto copy = std::make_shared<Statement>(*s);
        for (ExpressionPtr& arg : copy->args) arg = copyOf(arg);
        for (Statements& body : copy->bodies) body = copyOf(body);
        copies.push_back(copy);
    }
    return copies;
}
RandomProgram copyOf(const RandomProgram& program) {
    RandomProgram copy = program;
    for (RandomFunction& f : copy.functions) f.body = copyOf(f.body);
    return copy;
}

/// Visits every list of statements and every expression; stops where `place` runs out.
struct Editor {
    size_t place;
    bool done = false;

    void lists(Statements& list) {
        for (size_t k = 0; k < list.size() && !done; ++k) {
            if (place-- == 0) {
                list.erase(list.begin() + static_cast<ptrdiff_t>(k));
                done = true;
                return;
            }
            for (Statements& body : list[k]->bodies) lists(body);
        }
    }
    void expressions(Statements& list) {
        for (auto& s : list) {
            for (ExpressionPtr& arg : s->args) expression(arg);
            for (Statements& body : s->bodies) expressions(body);
        }
    }
    void expression(ExpressionPtr& e) {
        if (done) return;
        // A child of the same type stands in for the whole, or else a constant.
        for (const ExpressionPtr& arg : e->args) {
            if (!(arg->type == e->type)) continue;
            if (place-- == 0) {
                e = arg;
                done = true;
                return;
            }
        }
        if (e->kind != Expression::Kind::constant && place-- == 0) {
            auto constant = std::make_shared<Expression>();
            constant->type = e->type;
            constant->literal = e->type.base == Base::f32 ? 0x3F800000u : 1;
            e = constant;
            done = true;
            return;
        }
        for (ExpressionPtr& arg : e->args) expression(arg);
    }
};

}  // namespace

RandomProgram shrink(RandomProgram program, const std::function<bool(const RandomProgram&)>& fails, size_t attempts) {
    for (const bool ofStatements : {true, false, true}) {
        for (size_t place = 0; attempts > 0;) {
            RandomProgram smaller = copyOf(program);
            Editor editor{place};
            for (RandomFunction& f : smaller.functions) {
                if (editor.done) break;
                if (ofStatements) {
                    editor.lists(f.body);
                } else {
                    editor.expressions(f.body);
                }
            }
            if (!editor.done) break;
            --attempts;
            if (fails(smaller)) {
                program = std::move(smaller);
            } else {
                ++place;
            }
        }
    }
    return program;
}

}  // namespace vernier::proof
