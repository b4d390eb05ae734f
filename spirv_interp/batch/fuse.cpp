#include "spirv_interp/batch/fuse.h"

#include <algorithm>
#include <array>
#include <optional>

#include "spirv_interp/batch/select.h"

namespace vernier::batch {
namespace {

using ir::ValueId;
using Match = std::optional<Fusion>;

/// Finds the superinstruction that ends in an instruction.
struct Matcher {
    const ir::Program& program;
    const std::vector<const ir::Inst*>& definition;
    const std::vector<uint32_t>& uses;
    const std::vector<bool>& scalar;
    std::vector<bool> here;  // by value: defined in the block at hand

    std::array<ValueId, 2> pair(const ir::Inst& inst) const {
        const auto operands = program.operandsOf(inst);
        return {operands[0], operands[1]};
    }

    /// Made in this block for one user alone.
    bool isFresh(ValueId value) const { return here[value] && uses[value] == 1 && !scalar[value]; }

    /// Left in the accumulator by an operation of its own.
    bool isComputed(ValueId value) const {
        if (!isFresh(value)) return false;
        const std::optional<Op> op = elementOp(program, *definition[value]);
        return op && isVectorOp(*op);
    }

    /// The instruction that defines a value, if the value may disappear into its user.
    const ir::Inst* inner(ValueId value, ir::Op op, ir::Type type) const {
        const ir::Inst* inst = definition[value];
        return inst != nullptr && inst->op == op && inst->type == type && isFresh(value) ? inst : nullptr;
    }
    const ir::Inst* innerFloat(ValueId value, ir::Op op) const { return inner(value, op, ir::Type::f32); }
    const ir::Inst* innerInteger(ValueId value, ir::Op op) const { return inner(value, op, ir::Type::i32); }

    // Sums of products.

    /// The terms of ((p0 + p1) + p2) + p3, all inner products; empty when the sum is not of this form or
    /// longer.
    std::vector<const ir::Inst*> terms(const ir::Inst& sum) const {
        std::vector<const ir::Inst*> reversed;
        for (const ir::Inst* at = &sum; reversed.size() < 3;) {
            const auto [left, right] = pair(*at);
            const ir::Inst* last = innerFloat(right, ir::Op::fmul);
            if (last == nullptr) return {};
            reversed.push_back(last);
            if (const ir::Inst* first = innerFloat(left, ir::Op::fmul)) {
                reversed.push_back(first);
                return {reversed.rbegin(), reversed.rend()};
            }
            at = innerFloat(left, ir::Op::fadd);
            if (at == nullptr) return {};
        }
        return {};
    }

    Match dot(const ir::Inst& sum) const {
        const auto products = terms(sum);
        if (products.empty()) return std::nullopt;
        constexpr Op kRows[] = {Op::dot2, Op::dot3, Op::dot4};
        constexpr Op kScalars[] = {Op::dot2Scalar, Op::dot3Scalar, Op::dot4Scalar};
        Fusion fusion;
        size_t scalars = 0, computed = 0;
        for (const ir::Inst* product : products) {
            auto [a, b] = pair(*product);
            if (scalar[a]) std::swap(a, b);
            scalars += scalar[b] ? 1 : 0;
            computed += isComputed(a) || isComputed(b) ? 1 : 0;
            fusion.operands.insert(fusion.operands.end(), {a, b});
        }
        if (scalars != 0 && scalars != products.size()) return std::nullopt;
        // Factors that come one after the other are better used in the accumulator, product by product, than stored
        // for a sum of them all.
        if (computed > 1) return std::nullopt;
        fusion.op = (scalars != 0 ? kScalars : kRows)[products.size() - 2];
        return fusion;
    }

    Match sum(const ir::Inst& inst) const {
        const bool adds = inst.op == ir::Op::fadd;
        if (adds) {
            if (Match fusion = unpackDot(inst)) return fusion;
            if (Match fusion = dot(inst)) return fusion;
        }
        const auto [left, right] = pair(inst);
        if (const ir::Inst* product = innerFloat(left, ir::Op::fmul)) {
            if (Match fusion = converted(*product, adds ? 1 : -1, right)) return fusion;
            const auto [a, b] = pair(*product);
            return Fusion{adds ? Op::multiplyAdd : Op::multiplySubtract, {a, b, right}};
        }
        if (const ir::Inst* product = innerFloat(right, ir::Op::fmul)) {
            if (adds) {
                if (Match fusion = converted(*product, 1, left)) return fusion;
            }
            const auto [a, b] = pair(*product);
            return Fusion{adds ? Op::multiplyAdd : Op::subtractMultiply, {a, b, left}};
        }
        return std::nullopt;
    }

    // Integers to floats.

    /// A product of a converted integer and a scalar; then `last` is added (sign 1) or subtracted (-1).
    Match converted(const ir::Inst& product, int sign, ValueId last) const {
        for (const size_t k : {0, 1}) {
            const auto factors = pair(product);
            const ir::Inst* conversion = innerFloat(factors[k], ir::Op::stof);
            const ValueId scale = factors[1 - k];
            if (conversion == nullptr || !scalar[scale]) continue;
            const ValueId from = program.operandsOf(*conversion)[0];
            if (program.valueTypes[from] != ir::Type::i32) continue;
            if (sign == 0 || scalar[last]) {
                if (Match fusion = unpacked(from, scale, sign, last)) return fusion;
            }
            if (sign == 0) return Fusion{Op::convertMultiply, {from, scale}};
            return Fusion{sign > 0 ? Op::convertMultiplyAdd : Op::convertMultiplySubtract, {from, scale, last}};
        }
        return std::nullopt;
    }

    /// Of an integer that is masked by a scalar.
    Match unpacked(ValueId from, ValueId scale, int sign, ValueId last) const {
        const ir::Inst* masked = innerInteger(from, ir::Op::iand);
        if (masked == nullptr) return std::nullopt;
        auto [word, mask] = pair(*masked);
        if (scalar[word]) std::swap(word, mask);
        if (scalar[word] || !scalar[mask]) return std::nullopt;
        if (sign == 0) return Fusion{Op::unpackMultiply, {word, mask, scale}};
        return Fusion{sign > 0 ? Op::unpackMultiplyAdd : Op::unpackMultiplySubtract, {word, mask, scale, last}};
    }

    /// What is unpacked and scaled, less a scalar, times a factor: the unpacking, with the factor as its last operand.
    Match unpackedTerm(const ir::Inst& product) const {
        const auto factors = pair(product);
        for (const size_t k : {0, 1}) {
            const ir::Inst* difference = innerFloat(factors[k], ir::Op::fsub);
            if (difference == nullptr) continue;
            const auto [scaled, last] = pair(*difference);
            const ir::Inst* scaling = innerFloat(scaled, ir::Op::fmul);
            if (scaling == nullptr || !scalar[last]) continue;
            Match unpack = converted(*scaling, -1, last);
            if (!unpack || unpack->op != Op::unpackMultiplySubtract) continue;
            unpack->operands.push_back(factors[1 - k]);
            return unpack;
        }
        return std::nullopt;
    }

    /// A sum of three such terms, with fields of one word.
    Match unpackDot(const ir::Inst& sum) const {
        const auto outer = pair(sum);
        for (const size_t k : {0, 1}) {
            const ir::Inst* first = innerFloat(outer[k], ir::Op::fadd);
            if (first == nullptr) continue;
            const auto inner = pair(*first);
            std::array<Match, 3> terms;
            const std::array<ValueId, 3> values{inner[0], inner[1], outer[1 - k]};
            for (size_t t = 0; t < terms.size(); ++t) {
                const ir::Inst* product = innerFloat(values[t], ir::Op::fmul);
                if (product != nullptr) terms[t] = unpackedTerm(*product);
            }
            const auto fits = [&](const Match& term) { return term && term->operands[0] == terms[0]->operands[0]; };
            if (!std::all_of(terms.begin(), terms.end(), fits)) continue;
            Fusion fusion{Op::unpackDot3, {terms[0]->operands[0]}, terms.size()};
            for (const size_t part : {4, 1, 2, 3})
                for (const Match& term : terms) fusion.operands.push_back(term->operands[part]);
            return fusion;
        }
        return std::nullopt;
    }

    // Integers.

    /// A shift by a scalar and what masks or mixes it, in either order of operands.
    Match shifted(const ir::Inst& inst, ir::Op shift, Op fused) const {
        const auto operands = pair(inst);
        for (const size_t k : {0, 1}) {
            const ir::Inst* found = innerInteger(operands[k], shift);
            if (found == nullptr) continue;
            const auto [from, by] = pair(*found);
            if (!scalar[by] || scalar[from]) continue;
            return Fusion{fused, {from, by, operands[1 - k]}};
        }
        return std::nullopt;
    }

    /// The shift of a value that the other operand is, by a scalar: x ^ (x >> s).
    Match shiftedSelf(const ir::Inst& inst, ir::Op shift, Op fused) const {
        const Match fusion = shifted(inst, shift, fused);
        if (!fusion || fusion->operands[0] != fusion->operands[2]) return std::nullopt;
        return Fusion{fused, {fusion->operands[0], fusion->operands[1]}};
    }

    /// op(inner(a, b), c)
    Match nested(const ir::Inst& inst, ir::Op innerOp, Op fused) const {
        const auto operands = pair(inst);
        for (const size_t k : {0, 1}) {
            const ir::Inst* found = innerInteger(operands[k], innerOp);
            if (found == nullptr) continue;
            const auto [a, b] = pair(*found);
            return Fusion{fused, {a, b, operands[1 - k]}};
        }
        return std::nullopt;
    }

    Match exclusiveOr(const ir::Inst& inst) const {
        if (Match fusion = shiftedSelf(inst, ir::Op::lshr, Op::xorShiftRight)) return fusion;
        if (Match fusion = shiftedSelf(inst, ir::Op::shl, Op::xorShiftLeft)) return fusion;
        if (Match fusion = shifted(inst, ir::Op::lshr, Op::shiftRightXor)) return fusion;
        if (Match fusion = shifted(inst, ir::Op::shl, Op::shiftLeftXor)) return fusion;
        return nested(inst, ir::Op::ixor, Op::xor3);
    }

    Match inclusiveOr(const ir::Inst& inst) const {
        if (Match fusion = rotation(inst)) return fusion;
        if (Match fusion = nested(inst, ir::Op::iand, Op::andOr)) return fusion;
        return shifted(inst, ir::Op::shl, Op::shiftLeftOr);
    }

    Match rotation(const ir::Inst& inst) const {
        const auto operands = pair(inst);
        for (const size_t k : {0, 1}) {
            const ir::Inst* left = innerInteger(operands[k], ir::Op::shl);
            const ir::Inst* right = innerInteger(operands[1 - k], ir::Op::lshr);
            if (left == nullptr || right == nullptr) continue;
            const auto [a, by] = pair(*left);
            const auto [b, back] = pair(*right);
            const ir::Inst *count = definition[by], *rest = definition[back];
            const auto isConstant = [](const ir::Inst* c) { return c != nullptr && c->op == ir::Op::constant; };
            if (a != b || scalar[a] || !isConstant(count) || !isConstant(rest)) continue;
            if ((count->imm + rest->imm) % 32 == 0) return Fusion{Op::rotateLeft, {a, by}};
        }
        return std::nullopt;
    }

    Match product(const ir::Inst& inst) const {
        const auto operands = pair(inst);
        for (const size_t k : {0, 1}) {
            const ir::Inst* mixed = innerInteger(operands[k], ir::Op::ixor);
            if (mixed == nullptr || !scalar[operands[1 - k]]) continue;
            const Match shift = shiftedSelf(*mixed, ir::Op::lshr, Op::xorShiftRight);
            if (shift) return Fusion{Op::xorShiftMultiply, {shift->operands[0], shift->operands[1], operands[1 - k]}};
            const auto [a, b] = pair(*mixed);
            return Fusion{Op::xorMultiply, {a, b, operands[1 - k]}};
        }
        return std::nullopt;
    }

    Match match(const ir::Inst& inst) const {
        if (inst.type == ir::Type::f32) {
            if (inst.op == ir::Op::fadd || inst.op == ir::Op::fsub) return sum(inst);
            if (inst.op != ir::Op::fmul) return std::nullopt;
            return converted(inst, 0, ir::kNoValue);
        }
        if (inst.type != ir::Type::i32) return std::nullopt;
        switch (inst.op) {
            case ir::Op::iand:
                return shifted(inst, ir::Op::lshr, Op::shiftRightAnd);
            case ir::Op::ixor:
                return exclusiveOr(inst);
            case ir::Op::ior:
                return inclusiveOr(inst);
            case ir::Op::imul:
                return product(inst);
            case ir::Op::iadd:
                if (Match fusion = nested(inst, ir::Op::imul, Op::integerMultiplyAdd)) return fusion;
                return shifted(inst, ir::Op::shl, Op::shiftLeftAdd);
            default:
                return std::nullopt;
        }
    }
};

}  // namespace

Fusions::Fusions(const ir::Program& program, const std::vector<const ir::Inst*>& definition,
                 const std::vector<uint32_t>& uses, const std::vector<bool>& scalar)
    : inner_(program.valueTypes.size()), fusionOf_(program.valueTypes.size(), kNone) {
    Matcher matcher{program, definition, uses, scalar, std::vector<bool>(program.valueTypes.size())};
    for (const ir::Block& block : program.blocks) {
        for (const ir::Inst& inst : block.insts) {
            if (inst.result != ir::kNoValue) matcher.here[inst.result] = true;
        }
        // From the last instruction up, so that a sum is seen before the sums inside it.
        for (size_t k = block.insts.size(); k-- > 0;) {
            const ir::Inst& inst = block.insts[k];
            if (inst.result == ir::kNoValue || scalar[inst.result] || inner_[inst.result]) continue;
            Match fusion = matcher.match(inst);
            if (!fusion) continue;
            // What lies between the root and the fusion's operands disappears.
            std::vector<const ir::Inst*> open{&inst};
            while (!open.empty()) {
                const ir::Inst* at = open.back();
                open.pop_back();
                for (const ValueId value : program.operandsOf(*at)) {
                    if (scalar[value]) continue;
                    if (std::find(fusion->operands.begin(), fusion->operands.end(), value) != fusion->operands.end()) {
                        continue;
                    }
                    inner_[value] = true;
                    open.push_back(definition[value]);
                }
            }
            fusionOf_[inst.result] = static_cast<uint32_t>(fusions_.size());
            fusions_.push_back(*std::move(fusion));
        }
        for (const ir::Inst& inst : block.insts) {
            if (inst.result != ir::kNoValue) matcher.here[inst.result] = false;
        }
    }
}

}  // namespace vernier::batch
