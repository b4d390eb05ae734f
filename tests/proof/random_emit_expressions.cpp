// Programs to modules: expressions.
#include <spirv/unified1/GLSL.std.450.h>

#include "tests/proof/random_emitter.h"

namespace vernier::proof {

Id Emitter::subgroup(const Expression& e) {
    b_.capability(spv::CapabilityGroupNonUniform);
    if (e.op >= spv::OpGroupNonUniformIAdd && e.op <= spv::OpGroupNonUniformLogicalXor) {
        b_.capability(spv::CapabilityGroupNonUniformArithmetic);
    } else if (e.op >= spv::OpGroupNonUniformQuadBroadcast) {
        b_.capability(spv::CapabilityGroupNonUniformQuad);
    } else if (e.op >= spv::OpGroupNonUniformShuffle) {
        b_.capability(spv::CapabilityGroupNonUniformShuffle);
    } else if (e.op >= spv::OpGroupNonUniformBroadcast) {
        b_.capability(spv::CapabilityGroupNonUniformBallot);
    } else {
        b_.capability(spv::CapabilityGroupNonUniformVote);
    }
    std::vector<uint32_t> words{constantU32(spv::ScopeSubgroup)};
    if (e.literal != ~0ull) words.push_back(static_cast<uint32_t>(e.literal & 0xFF));
    for (const Id id : arguments(e)) words.push_back(id);
    if (e.literal != ~0ull && e.literal >> 8 != 0) {
        b_.capability(spv::CapabilityGroupNonUniformClustered);
        words.push_back(constantU32(static_cast<uint32_t>(e.literal >> 8)));
    }
    return b_.value(static_cast<spv::Op>(e.op), typeId(e.type), words);
}
Id Emitter::image(const Expression& e) {
    const Id at = expression(*e.args[0]), level = expression(*e.args[1]), type = typeId(e.type);
    const Id image = b_.type(spv::OpTypeImage, {scalarType(e.type.base), spv::Dim2D, 0, 0, 0, 1, 0});
    const Id sampled = load(b_.type(spv::OpTypeSampledImage, {image}), images_[e.index]);
    if (e.kind == Expression::Kind::sample)
        return b_.value(spv::OpImageSampleExplicitLod, type, {sampled, at, spv::ImageOperandsLodMask, level});
    return b_.value(spv::OpImageFetch, type,
                    {b_.value(spv::OpImage, image, {sampled}), at, spv::ImageOperandsLodMask, level});
}
Id Emitter::expression(const Expression& e) {
    using Kind = Expression::Kind;
    const Id type = typeId(e.type);
    switch (e.kind) {
        case Kind::constant:
            return constant(e.type, e.literal);
        case Kind::variable: {
            const Variable& v = program_.variables[e.index];
            if (v.length == 0) return load(type, pointers_[e.index]);
            const Id at = expression(*e.args[0]);
            return load(type, b_.value(spv::OpAccessChain, pointerType(spv::StorageClassFunction, type),
                                       {pointers_[e.index], at}));
        }
        case Kind::input:
            return load(type, inputs_[e.index]);
        case Kind::uniform: {
            std::vector<uint32_t> chain{uniforms_, constantU32(e.index)};
            for (const Id id : arguments(e)) chain.push_back(id);
            return load(type, b_.value(spv::OpAccessChain, pointerType(spv::StorageClassUniform, type), chain));
        }
        case Kind::bufferWord:
            return load(type, wordPointer(expression(*e.args[0])));
        case Kind::bufferVector:
            return load(type, vectorPointer(expression(*e.args[0])));
        case Kind::op:
            return b_.value(static_cast<spv::Op>(e.op), type, arguments(e));
        case Kind::extended:
            return extended(e.op, type, arguments(e));
        case Kind::structMember:
            return b_.value(
                spv::OpCompositeExtract, type,
                {b_.value(static_cast<spv::Op>(e.op), b_.type(spv::OpTypeStruct, {type, type}), arguments(e)),
                 e.index});
        case Kind::extendedMember: {
            const Id second = e.op == GLSLstd450FrexpStruct ? typeId(e.type.of(Base::i32)) : type;
            return b_.value(spv::OpCompositeExtract, type,
                            {extended(e.op, b_.type(spv::OpTypeStruct, {type, second}), arguments(e)), e.index});
        }
        case Kind::construct:
            return b_.value(spv::OpCompositeConstruct, type, arguments(e));
        case Kind::extract:
            return b_.value(spv::OpCompositeExtract, type, {expression(*e.args[0]), e.index});
        case Kind::shuffle: {
            std::vector<uint32_t> words = arguments(e);
            for (uint32_t k = 0; k < e.type.rows; ++k)
                words.push_back(static_cast<uint32_t>(e.literal >> (8 * k) & 0xFF));
            return b_.value(spv::OpVectorShuffle, type, words);
        }
        case Kind::call: {
            std::vector<uint32_t> words = arguments(e);
            words.insert(words.begin(), functions_[e.index]);
            words.push_back(pointers_[e.literal]);
            return b_.value(spv::OpFunctionCall, type, words);
        }
        case Kind::both: {
            const Id first = expression(*e.args[0]), from = block_, more = b_.newId(), merge = b_.newId();
            b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
            condition(first, e.literal != 0 ? merge : more, e.literal != 0 ? more : merge);
            label(more);
            const Id second = expression(*e.args[1]), to = block_;
            jump(merge);
            label(merge);
            return b_.value(spv::OpPhi, type, {first, from, second, to});
        }
        case Kind::subgroup:
            return subgroup(e);
        case Kind::fetch:
        case Kind::sample:
            return image(e);
        case Kind::choose: {
            const Id value = expression(*e.args[0]), yes = b_.newId(), no = b_.newId(), merge = b_.newId();
            b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
            condition(value, yes, no);
            label(yes);
            const Id a = expression(*e.args[1]), fromYes = block_;
            jump(merge);
            label(no);
            const Id b = expression(*e.args[2]), fromNo = block_;
            jump(merge);
            label(merge);
            return b_.value(spv::OpPhi, type, {a, fromYes, b, fromNo});
        }
    }
    return 0;
}

}  // namespace vernier::proof
