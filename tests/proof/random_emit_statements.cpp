// Programs to modules: statements.
#include "tests/proof/random_emitter.h"

namespace vernier::proof {

void Emitter::statements(const Statements& list) {
    for (const auto& s : list) {
        if (ended_) return;  // what follows a jump is never reached
        statement(*s);
    }
}

void Emitter::statement(const Statement& s) {
    switch (s.kind) {
        case Statement::Kind::assign: {
            const Id value = expression(*s.args[0]);
            const Variable& v = program_.variables[s.index];
            const spv::StorageClass storage = v.isPrivate ? spv::StorageClassPrivate : spv::StorageClassFunction;
            std::vector<uint32_t> chain{pointers_[s.index]};
            if (v.length != 0) chain.push_back(expression(*s.args[1]));
            ValueType type = v.type;
            if (s.literal != ~0ull) {
                chain.push_back(constantU32(static_cast<uint32_t>(s.literal)));
                type = type.scalar();
            }
            store(
                chain.size() == 1 ? chain[0] : b_.value(spv::OpAccessChain, pointerType(storage, typeId(type)), chain),
                value);
            return;
        }
        case Statement::Kind::bufferWord: {
            const Id value = expression(*s.args[0]);
            store(wordPointer(expression(*s.args[1])), value);
            return;
        }
        case Statement::Kind::bufferVector: {
            const Id value = expression(*s.args[0]);
            store(vectorPointer(expression(*s.args[1])), value);
            return;
        }
        case Statement::Kind::branch: {
            const Id value = expression(*s.args[0]), yes = b_.newId(), merge = b_.newId();
            const Id no = s.bodies[1].empty() ? merge : b_.newId();
            b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
            condition(value, yes, no);
            label(yes);
            statements(s.bodies[0]);
            jump(merge);
            if (no != merge) {
                label(no);
                statements(s.bodies[1]);
                jump(merge);
            }
            label(merge);
            return;
        }
        case Statement::Kind::choice:
            choice(s);
            return;
        case Statement::Kind::loop:
            loop(s);
            return;
        case Statement::Kind::leave:
            jump(breaks_.back());
            return;
        case Statement::Kind::next:
            jump(continues_.back());
            return;
        case Statement::Kind::giveBack:
            if (result_) {
                const Id value = expression(*s.args[0]);
                end(spv::OpReturnValue, {value});
            } else {
                end(spv::OpReturn);
            }
            return;
        case Statement::Kind::discard:
            end(spv::OpKill);
            return;
        case Statement::Kind::shared: {
            const Id u32 = scalarType(Base::u32), type = pointerType(spv::StorageClassWorkgroup, u32);
            const Id value = expression(*s.args[0]), local = load(u32, local_);
            store(b_.value(spv::OpAccessChain, type, {shared_, local}), value);
            barrier();
            const Id other =
                b_.value(spv::OpBitwiseAnd, u32,
                         {b_.value(spv::OpIAdd, u32, {local, constantU32(static_cast<uint32_t>(s.literal))}),
                          constantU32(kGroupSize - 1)});
            const Id got = load(u32, b_.value(spv::OpAccessChain, type, {shared_, other}));
            barrier();
            const Id component = b_.value(spv::OpAccessChain, pointerType(spv::StorageClassPrivate, u32),
                                          {pointers_[s.index], constantU32(1)});
            store(component, got);
            return;
        }
        case Statement::Kind::derivative: {
            const Id value = expression(*s.args[0]);
            store(pointers_[s.index], b_.value(static_cast<spv::Op>(s.literal), typeId({Base::f32, 4, 1}), {value}));
            return;
        }
    }
}

void Emitter::choice(const Statement& s) {
    const Id selector = expression(*s.args[0]), merge = b_.newId();
    std::vector<Id> labels;
    for (size_t k = 0; k < s.bodies.size(); ++k) labels.push_back(b_.newId());
    if (labels.empty()) labels.push_back(merge);
    b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
    std::vector<uint32_t> words{selector, labels.back()};
    for (uint32_t k = 0; k + 1 < s.bodies.size(); ++k) {
        words.push_back(k);
        words.push_back(labels[k]);
    }
    b_.add(ModuleBuilder::functions, spv::OpSwitch, words);
    ended_ = true;
    breaks_.push_back(merge);
    for (size_t k = 0; k < s.bodies.size(); ++k) {
        label(labels[k]);
        statements(s.bodies[k]);
        const bool through = k + 1 < s.bodies.size() && (s.literal >> k & 1) != 0;
        jump(through ? labels[k + 1] : merge);
    }
    breaks_.pop_back();
    label(merge);
}

void Emitter::loop(const Statement& s) {
    const Id u32 = scalarType(Base::u32), boolean = scalarType(Base::boolean), counter = counters_.at(&s);
    const Id header = b_.newId(), test = b_.newId(), body = b_.newId(), next = b_.newId(), merge = b_.newId();
    const bool testFirst = s.index == 0;
    store(counter, constantU32(0));
    jump(header);
    label(header);
    b_.add(ModuleBuilder::functions, spv::OpLoopMerge, {merge, next, 0});
    jump(testFirst ? test : body);
    const auto goOn = [&] {
        const Id more =
            b_.value(spv::OpULessThan, boolean, {load(u32, counter), constantU32(static_cast<uint32_t>(s.literal))});
        return b_.value(spv::OpLogicalAnd, boolean, {more, expression(*s.args[0])});
    };
    if (testFirst) {
        label(test);
        condition(goOn(), body, merge);
    }
    label(body);
    breaks_.push_back(merge);
    continues_.push_back(next);
    statements(s.bodies[0]);
    jump(next);
    breaks_.pop_back();
    continues_.pop_back();
    label(next);
    store(counter, b_.value(spv::OpIAdd, u32, {load(u32, counter), constantU32(1)}));
    if (testFirst) {
        jump(header);
    } else {
        // The counter is bumped first, so that the loop ends; no branches of the expression's own may stand here.
        const Id more =
            b_.value(spv::OpULessThan, boolean, {load(u32, counter), constantU32(static_cast<uint32_t>(s.literal))});
        condition(more, header, merge);
    }
    label(merge);
}

}  // namespace vernier::proof
