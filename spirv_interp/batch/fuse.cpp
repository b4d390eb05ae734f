#include "spirv_interp/batch/fuse.h"

#include <algorithm>
#include <functional>

namespace vernier::batch {
namespace {

using Definitions = std::vector<const ir::Inst*>;

struct Matcher {
    const ir::Program& program;
    const Definitions& definition;
    const std::vector<bool>& scalar;
    std::function<bool(ir::ValueId)> isInner;  // may disappear into its user

    /// The inner product, sum or shift that defines a value.
    const ir::Inst* inner(ir::ValueId value, ir::Op op, ir::Type type = ir::Type::f32) const {
        const ir::Inst* inst = definition[value];
        return inst != nullptr && inst->op == op && inst->type == type && isInner(value) ? inst : nullptr;
    }

    /// The terms of ((p0 + p1) + p2) + p3, all inner products; empty when the sum is not of this form or
    /// longer.
    std::vector<const ir::Inst*> terms(const ir::Inst& sum) const {
        std::vector<const ir::Inst*> reversed;
        for (const ir::Inst* at = &sum; reversed.size() < 3;) {
            const auto operands = program.operandsOf(*at);
            const ir::Inst* right = inner(operands[1], ir::Op::fmul);
            if (right == nullptr) return {};
            reversed.push_back(right);
            if (const ir::Inst* left = inner(operands[0], ir::Op::fmul)) {
                reversed.push_back(left);
                return {reversed.rbegin(), reversed.rend()};
            }
            at = inner(operands[0], ir::Op::fadd);
            if (at == nullptr) return {};
        }
        return {};
    }

    std::optional<Fusion> dot(const ir::Inst& sum) const {
        const auto products = terms(sum);
        if (products.empty()) return std::nullopt;
        constexpr Op kRows[] = {Op::dot2, Op::dot3, Op::dot4};
        constexpr Op kScalars[] = {Op::dot2Scalar, Op::dot3Scalar, Op::dot4Scalar};
        Fusion fusion;
        size_t scalars = 0;
        for (const ir::Inst* product : products) {
            auto a = program.operandsOf(*product)[0], b = program.operandsOf(*product)[1];
            if (scalar[a]) std::swap(a, b);
            scalars += scalar[b] ? 1 : 0;
            fusion.operands.insert(fusion.operands.end(), {a, b});
        }
        if (scalars != 0 && scalars != products.size()) return std::nullopt;
        fusion.op = (scalars != 0 ? kScalars : kRows)[products.size() - 2];
        return fusion;
    }

    /// A shift and what masks or mixes it.
    std::optional<Fusion> shifted(const ir::Inst& inst) const {
        const auto operands = program.operandsOf(inst);
        const bool masks = inst.op == ir::Op::iand;
        for (const size_t k : {0, 1}) {
            const auto fusion = [&](Op op, const ir::Inst& shift) {
                const auto parts = program.operandsOf(shift);
                return Fusion{op, {parts[0], parts[1], operands[1 - k]}};
            };
            if (const ir::Inst* shift = inner(operands[k], ir::Op::lshr, ir::Type::i32)) {
                return fusion(masks ? Op::shiftRightAnd : Op::shiftRightXor, *shift);
            }
            if (masks) continue;
            if (const ir::Inst* shift = inner(operands[k], ir::Op::shl, ir::Type::i32)) {
                return fusion(Op::shiftLeftXor, *shift);
            }
        }
        return std::nullopt;
    }

    std::optional<Fusion> match(const ir::Inst& inst) const {
        if (inst.type == ir::Type::i32 && (inst.op == ir::Op::iand || inst.op == ir::Op::ixor)) return shifted(inst);
        if (inst.type != ir::Type::f32 || (inst.op != ir::Op::fadd && inst.op != ir::Op::fsub)) return std::nullopt;
        if (inst.op == ir::Op::fadd) {
            if (auto fusion = dot(inst)) return fusion;
        }
        const auto operands = program.operandsOf(inst);
        const bool adds = inst.op == ir::Op::fadd;
        if (const ir::Inst* left = inner(operands[0], ir::Op::fmul)) {
            const auto factors = program.operandsOf(*left);
            return Fusion{adds ? Op::multiplyAdd : Op::multiplySubtract, {factors[0], factors[1], operands[1]}};
        }
        if (const ir::Inst* right = inner(operands[1], ir::Op::fmul)) {
            const auto factors = program.operandsOf(*right);
            return Fusion{adds ? Op::multiplyAdd : Op::subtractMultiply, {factors[0], factors[1], operands[0]}};
        }
        return std::nullopt;
    }
};

}  // namespace

std::vector<bool> fusedValues(const ir::Program& program, const Definitions& definition,
                              const std::vector<uint32_t>& uses, const std::vector<bool>& scalar) {
    std::vector<bool> fused(program.valueTypes.size());
    std::vector<bool> here(program.valueTypes.size());  // defined in the block at hand
    for (const ir::Block& block : program.blocks) {
        for (const ir::Inst& inst : block.insts) {
            if (inst.result != ir::kNoValue) here[inst.result] = true;
        }
        const Matcher matcher{program, definition, scalar,
                              [&](ir::ValueId v) { return here[v] && uses[v] == 1 && !scalar[v]; }};
        // From the last instruction up, so that a sum is seen before the sums inside it.
        for (size_t k = block.insts.size(); k-- > 0;) {
            const ir::Inst& inst = block.insts[k];
            if (inst.result == ir::kNoValue || scalar[inst.result] || fused[inst.result]) continue;
            const auto fusion = matcher.match(inst);
            if (!fusion) continue;
            // What lies between the root and the fusion's operands disappears.
            std::vector<const ir::Inst*> open{&inst};
            while (!open.empty()) {
                const ir::Inst* at = open.back();
                open.pop_back();
                for (const ir::ValueId value : program.operandsOf(*at)) {
                    if (std::find(fusion->operands.begin(), fusion->operands.end(), value) != fusion->operands.end()) {
                        continue;
                    }
                    fused[value] = true;
                    open.push_back(definition[value]);
                }
            }
        }
        for (const ir::Inst& inst : block.insts) {
            if (inst.result != ir::kNoValue) here[inst.result] = false;
        }
    }
    return fused;
}

std::optional<Fusion> findFusion(const ir::Program& program, const Definitions& definition,
                                 const std::vector<bool>& fused, const std::vector<bool>& scalar,
                                 const ir::Inst& inst) {
    if (fused.empty()) return std::nullopt;
    const Matcher matcher{program, definition, scalar, [&](ir::ValueId v) { return fused[v]; }};
    return matcher.match(inst);
}

}  // namespace vernier::batch
